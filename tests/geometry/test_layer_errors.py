"""Layers, bare cores and data sheets that cannot be: one sentence that names file and key or part."""

from pathlib import Path

import pytest

from geometry import GeometryError, SpecError, cable_files, read_cable

SEA = cable_files()["sea-three-core"].read_text(encoding="utf-8")
STRAND = cable_files()["strand-1x7-steel"].read_text(encoding="utf-8")
SPIRAL = cable_files()["spiral-strand-120"].read_text(encoding="utf-8")


def write(folder: Path, text: str, old: str, new: str, count: int = 1) -> Path:
    assert old in text, old
    path = folder / "mine.toml"
    path.write_text(text.replace(old, new, count), encoding="utf-8")
    return path


WRONG_ENTRY = {
    "unit missing": ('wire_diameter = { value = "4.0 mm"', "wire_diameter = { value = 4.0", r"layers\.2\.wire_diameter: .* no unit"),
    "zero": ('wire_diameter = { value = "4.0 mm"', 'wire_diameter = { value = "0 mm"', r"layers\.2\.wire_diameter: .* positive"),
    "negative": ('wire_diameter = { value = "4.0 mm"', 'wire_diameter = { value = "-4 mm"', r"layers\.2\.wire_diameter: .* positive"),
    "no wires": ("wires = { value = 55", "wires = { value = 0", r"layers\.2\.wires: .* not a count"),
    "half a wire": ("wires = { value = 55", "wires = { value = 54.5", r"layers\.2\.wires: .* not a count"),
    "too many to count": ("wires = { value = 55", "wires = { value = 1000000000", r"layers\.2\.wires: .* not a count"),
    "hand": ('hand = "S"', 'hand = "left"', r"layers\.2\.hand: 'left' is not possible; expected 'Z' or 'S'"),
    "kind": ('kind = "bedding"', 'kind = "paint"', r"layers\.3\.kind: 'paint' is not possible; expected 'bedding', 'tape'"),
    "kind missing": ('kind = "bedding"\n', "", r"layers\.3\.kind: this entry is missing"),
    "wall of wires": ('kind = "bedding"', 'kind = "armour"', r"layers\.3\.(wall: this key is not known|wires: this entry is missing)"),
    "unknown key": ('name = "inner armour"', 'name = "inner armour"\ncolour = "grey"', r"layers\.2\.colour: this key is not known"),
    "unknown material": ('material = "bedding"', 'material = "jute"', r'layers\.bedding\.material: there is no "jute" in \[materials\]'),
    "unknown filler": ('hand = "S"', 'hand = "S"\nfiller = "bitumen"', r'layers\.inner armour\.filler: there is no "bitumen"'),
    "names twice": ('name = "outer armour"', 'name = "inner armour"', r'two parts of the cable are named "inner armour wire 1"'),
    "insulation without material": (
        'insulation_material = "insulation"\n', "", r"cores\.power\.insulation_material: .* the insulation needs both"
    ),
    "sheet without source": ("[data-sheet]\nsource", "[data-sheet]\norigin", r"data-sheet\.source: this entry is missing"),
    "sheet outside its range": ('value = "101 mm"', 'value = "103 mm"', r"data-sheet\.outer_diameter: .* outside its own range"),
    "sheet with another unit": ('value = "101 mm"', 'value = "101 kg"', r'data-sheet\.outer_diameter: "101 kg" cannot be read in m'),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG_ENTRY)
def test_one_wrong_entry_is_named(case, tmp_path):
    old, new, expected = WRONG_ENTRY[case]
    with pytest.raises(SpecError, match=expected) as caught:
        read_cable(write(tmp_path, SEA, old, new))
    message = str(caught.value)
    assert message.startswith("mine.toml: ") and "\n" not in message and "pydantic" not in message


DOES_NOT_FIT = {
    "one wire too many": (
        SEA, "wires = { value = 55", "wires = { value = 59",
        r"inner armour: its 59 wires of 4 mm overlap .* radius 39.467 mm at a lay of 677.95 mm \(20.1 deg\): "
        r"lengthen the lay to at least 771.6 mm, or take at most 58 wires",
    ),
    "more than a straight layer holds": (
        SEA, "wires = { value = 55", "wires = { value = 500", r"inner armour: its 500 wires .* at any lay: take at most 58 wires",
    ),
    "lay past the locking limit": (
        SEA, 'value = "677.95 mm"', 'value = "400 mm"',
        r"inner armour: .*\(31.8 deg\): lengthen the lay to at least \d+\.\d mm, or take at most 52",
    ),
    "lay of a micrometre": (SEA, 'value = "677.95 mm"', 'value = "1 um"', r"inner armour: its 55 wires of 4 mm overlap"),
    "wires that cut the sheath": (
        SEA, 'hand = "S"', 'hand = "S"\nradius = { value = "39 mm", status = "computed", source = "test" }',
        r"inner armour: its wires lie on a radius of 39 mm and cut inner sheath below them by 0.467 mm: enlarge the radius to 39.467 mm",
    ),
    "published wires of the spiral strand": (
        SPIRAL, 'value = "3.13 mm"', 'value = "3.2 mm"', r"layer 3: its 17 wires of 3.2 mm overlap by 0.0694 mm",
    ),
    "bare wires": (
        STRAND, 'value = "115 mm"', 'value = "80 mm"',
        r"wire \d and wire \d overlap by .* along the lay, although .* enlarge the centre .* or lengthen the lay from 80 mm",
    ),
    "seven wires round one": (
        STRAND, 'cores = ["wire",', 'cores = ["wire", "wire",', r"wire \d and wire \d overlap by .* enlarge the centre",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", DOES_NOT_FIT)
def test_what_does_not_fit_is_named_with_what_would(case, tmp_path):
    text, old, new, expected = DOES_NOT_FIT[case]
    path = write(tmp_path, text.replace('range = ["79 mm", "149 mm"]', 'range = ["1 mm", "149 mm"]'), old, new)
    with pytest.raises(GeometryError, match=expected) as caught:
        read_cable(path)
    assert str(caught.value).startswith("mine.toml: ") and "\n" not in str(caught.value)


def test_a_cable_of_nothing_is_refused(tmp_path):
    path = write(tmp_path, STRAND, 'cores = ["wire", "wire", "wire", "wire", "wire", "wire"]', "cores = []")
    path.write_text(path.read_text(encoding="utf-8").replace('[centre]\nconductor = "core"\n', ""), encoding="utf-8")
    with pytest.raises(SpecError, match="at least one core or a centre"):
        read_cable(path)

"""Whatever is wrong with a cable file, the answer is one sentence that names the file and the key."""

from pathlib import Path

import pytest

from geometry import GeometryError, InputError, SpecError, cable_files, read_cable

TEXT = cable_files()["mcpt-1.9-3.3-3x35"].read_text(encoding="utf-8")
EXAMPLE = cable_files()["example-three-core"].read_text(encoding="utf-8")


def write(folder: Path, text: str | bytes) -> Path:
    path = folder / "mine.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def changed(folder: Path, old: str, new: str) -> Path:
    assert old in TEXT, old
    return write(folder, TEXT.replace(old, new, 1))


SPECIMEN = """[specimen]
length = { value = "170 mm", status = "assumed", range = ["120 mm", "400 mm"], source = "not published" }
"""
CHANGES = {
    "specimen without length": (
        "[data-sheet]",
        '[specimen]\nheld = "fixed"\n[data-sheet]',
        r"specimen\.length: this entry is missing",
    ),
    "specimen of no length": (
        "[data-sheet]",
        SPECIMEN.replace("170 mm", "-170 mm") + "[data-sheet]",
        r"specimen\.length: .* must be positive",
    ),
    "specimen, unknown end": (
        "[data-sheet]",
        SPECIMEN + 'loaded = "glue"\n[data-sheet]',
        r"specimen\.loaded: 'glue' is not known; choose one of uniform",
    ),
    "specimen, unknown hold": ("[data-sheet]", SPECIMEN + "held = 3\n[data-sheet]", r"specimen\.held: 3 is not known"),
    "specimen, unknown key": (
        "[data-sheet]",
        SPECIMEN + "clamp = 3\n[data-sheet]",
        r"specimen\.clamp: this key is not known",
    ),
    "unknown key": (
        'wall = { value = "6.00 mm"',
        'colour = "black"\nwall = { value = "6.00 mm"',
        r"sheath\.colour: this key is not known",
    ),
    "unit missing": ('value = "6.00 mm"', "value = 6.0", r"sheath\.wall: the number 6.0 has no unit"),
    "wrong dimension": ('value = "6.00 mm"', 'value = "6.00 kg"', r'sheath\.wall: "6.00 kg" cannot be read in m'),
    "unknown unit": ('value = "6.00 mm"', 'value = "6.00 blorks"', r"sheath\.wall: .* not a quantity"),
    "bare number": (
        'wall = { value = "6.00 mm", status = "published", source = "MCP-0.66/1.14 3x35 type A, MT 818.2-2009" }',
        'wall = "6 mm"',
        r"sheath\.wall: '6 mm' has no mark",
    ),
    "negative": ('value = "6.00 mm"', 'value = "-6.00 mm"', r"sheath\.wall: .* must be positive"),
    "zero": ('value = "6.00 mm"', 'value = "0 mm"', r"sheath\.wall: .* must be positive"),
    "not finite": ('value = "6.00 mm"', 'value = "inf mm"', r"sheath\.wall"),
    "nan": ('value = "6.00 mm"', 'value = "nan mm"', r"sheath\.wall"),
    "status": (
        'value = "6.00 mm", status = "published"',
        'value = "6.00 mm", status = "guessed"',
        "published, deduced, assumed, computed",
    ),
    "source": ('source = "usual tape"', 'source = " "', r"wrap\.wall: the source is missing"),
    "range missing": (', range = ["0.2 mm", "0.5 mm"]', "", r"wrap\.wall: an assumed number needs a range"),
    "range of a pure number missing": (
        'nu = { value = 0.34, status = "assumed", range = [0.30, 0.36], source = "solid copper" }',
        'nu = { value = 0.34, status = "assumed", source = "solid copper" }',
        r"nu: an assumed number needs a range",
    ),
    "range of a count": ("wires = { value = 133,", "wires = { value = 133, range = [1, 2],", "a count has no range"),
    "range of three": ('range = ["0.2 mm", "0.5 mm"]', 'range = ["0.2 mm", "0.5 mm", "1 mm"]', "expected two values"),
    "outside its range": (
        'range = ["0.2 mm", "0.5 mm"]',
        'range = ["0.4 mm", "0.5 mm"]',
        r"wrap\.wall: .* outside its own range",
    ),
    "unknown mark key": ('source = "usual tape"', 'source = "usual tape", page = 3', r'wrap\.wall: the key "page"'),
    "half a wire": ("value = [3, 9, 15]", "value = [3, 9.5, 15]", r"strands\.power\.layers: .* not a count"),
    "no wires": ("value = [3, 9, 15]", "value = []", r"strands\.power\.layers: .* not a count"),
    "negative count": ("value = 133", "value = -133", r"conductors\.control\.wires: .* not a count"),
    "true is no count": ("value = 133", "value = true", r"conductors\.control\.wires: .* not a count"),
    "absurd count": ("value = 133", "value = 1000000", r"conductors\.control\.wires: .* not a count"),
    "fill above one": ("value = 0.6788", "value = 1.6788", r"conductors\.control\.fill: .* between 0 and 1"),
    "poisson": ("value = 0.40,", "value = 0.50,", r"materials\.wrap tape\.nu: .* between -1 and 0.5"),
    "hand": ('hand = "Z"   # assumed', 'hand = "R"', r"lay-up\.hand: 'R' is not possible; expected 'Z' or 'S'"),
    "no sheath": ("[sheath]", "[coat]", r"coat: this key is not known|sheath: this entry is missing"),
    "unknown material": (
        'material = "wrap tape"',
        'material = "paper"',
        r'wrap\.material: there is no "paper" in \[materials\]; known are',
    ),
    "unknown core": ('"power", "control"]', '"power", "pilot"]', r'lay-up\.cores: there is no "pilot" in \[cores\]'),
    "unknown strand": ('strand = "power"', 'strand = "thin"', r'conductors\.power\.strand: there is no "thin"'),
    "half a screen": ('screen_material = "screen"', "", r"cores\.power\.screen_material: this entry is missing"),
    "cylinder does not agree": (
        'value = "5.46 mm"',
        'value = "6.46 mm"',
        r"conductors\.control: .* leave one of them out",
    ),
    "cores is text": ('cores = ["power", "power", "power", "control"]', 'cores = "power"', r"lay-up\.cores"),
    "table is a number": ("[interstices]", "interstices = 3\n[other]", r"interstices|other"),
}


@pytest.mark.parametrize("case", CHANGES)
def test_one_wrong_entry_is_named(case, tmp_path):
    old, new, expected = CHANGES[case]
    with pytest.raises(SpecError, match=expected) as caught:
        read_cable(changed(tmp_path, old, new))
    message = str(caught.value)
    assert message.startswith("mine.toml: ") and "\n" not in message and "pydantic" not in message


BROKEN = {
    "empty": b"",
    "not toml": b"name = \n[[[",
    "not utf-8": b'name = "\xff\xfe"',
    "zeros": b"\x00" * 100,
    "deep": b"a = " + b"[" * 3000 + b"]" * 3000,
    "a list": b"x = [1, 2]",
    "huge": b"#" * 1_100_000,
}


@pytest.mark.parametrize("case", BROKEN)
def test_broken_file_is_a_sentence(case, tmp_path):
    with pytest.raises(SpecError, match=r"mine.toml"):
        read_cable(write(tmp_path, BROKEN[case]))


def test_missing_file_folder_and_odd_names(tmp_path):
    for name in (tmp_path / "none.toml", tmp_path, "", "a\x00b", "x" * 5000):
        with pytest.raises(SpecError):
            read_cable(name)


@pytest.mark.parametrize("cut", range(0, 100, 7))
def test_a_truncated_file_never_gives_a_traceback(cut, tmp_path):
    """Any prefix of a good file is either a cable or an InputError."""
    try:
        read_cable(write(tmp_path, TEXT[: len(TEXT) * cut // 100]))
    except InputError as error:
        assert "mine.toml" in str(error)


def test_thin_earth_cover_makes_the_cores_overlap(tmp_path):
    """Earth over cover 7.0 mm at lay 234 mm: neighbours cut by 0.042 mm although their circles clear by 0.34 mm."""
    thin = changed(
        tmp_path,
        'value = "0.50 mm", status = "assumed", range = ["0.4 mm", "0.65 mm"]',
        'value = "0.25 mm", status = "assumed", range = ["0.2 mm", "0.65 mm"]',
    )
    with pytest.raises(
        GeometryError,
        match=r"power core \d and .* overlap by 0\.042 mm along the lay, although .* enlarge the centre .* lengthen the lay",
    ):
        read_cable(thin)


def test_short_lay_is_refused(tmp_path):
    for lay in ("60 mm", "20 mm", "1 um"):
        with pytest.raises(GeometryError, match=r"lay|lengthen"):
            read_cable(changed(tmp_path, 'value = "234 mm"', f'value = "{lay}"'))


def test_strand_that_does_not_fit(tmp_path):
    with pytest.raises(GeometryError, match=r"mine.toml: strand power: a layer of 19"):
        read_cable(changed(tmp_path, "value = [3, 9, 15]", "value = [3, 9, 19]"))


def test_fill_scales_the_filler_and_zero_leaves_it_out(tmp_path):
    half = read_cable(changed(tmp_path, "fill = { value = 1.0", "fill = { value = 0.5"))
    full = read_cable("mcpt-1.9-3.3-3x35")
    assert half.part("interstices").material.density == pytest.approx(0.5 * full.part("interstices").material.density)
    none = read_cable(changed(tmp_path, "fill = { value = 1.0", "fill = { value = 0.0"))
    assert "interstices" not in {part.name for part in none.parts}


def test_straight_single_core_and_bare_centre(tmp_path):
    """No lay, one core: everything is coaxial, no interstices."""
    text = EXAMPLE.replace('cores = ["core", "core", "core"]', 'cores = ["core"]')
    text = "\n".join(line for line in text.splitlines() if not line.startswith("lay = "))
    cable = read_cable(write(tmp_path, text))
    assert [part.name for part in cable.parts] == ["core conductor", "core insulation", "sheath"]
    assert cable.twist_rate == 0 and cable.lay_ratio is None


def test_names_that_collide_are_refused(tmp_path):
    text = EXAMPLE.replace("[lay-up]", '[centre]\nconductor = "core"\n\n[lay-up]', 1).replace(
        'cores = ["core", "core", "core"]', 'cores = ["core"]'
    )
    with pytest.raises(SpecError, match="rename"):
        read_cable(write(tmp_path, text))

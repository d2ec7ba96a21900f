"""`helicable effects`: all of them, one in full, its picture, and the same for machines."""

import json

import pytest

from effects import library
from helicable import screen
from helicable.commands.effects import effect_record
from helicable.main import main


@pytest.fixture
def wide(monkeypatch):
    monkeypatch.setattr(screen.console, "width", 200)


def test_every_effect_has_its_line_with_kind_title_and_needs(wide, capsys):
    assert main(["effects"]) == 0
    lines = capsys.readouterr().out.splitlines()
    for effect in library():
        line = next(line for line in lines if line.startswith(effect.name + " "))
        assert effect.kind in line and effect.title[1:30] in line and effect.needs[:20] in line


def test_in_a_narrow_terminal_names_stay_whole(monkeypatch, capsys):
    monkeypatch.setattr(screen.console, "width", 80)
    assert main(["effects"]) == 0
    out = capsys.readouterr().out
    assert all(f"\n{e.name} " in out for e in library()) and max(map(len, out.splitlines()[1:-2])) <= 80


@pytest.mark.parametrize("effect", library(), ids=lambda e: e.name)
def test_one_effect_in_full(effect, wide, capsys):
    """Every sentence, form and parameter is there, brackets of formulas and units included."""
    assert main(["effects", effect.name]) == 0
    out = " ".join(capsys.readouterr().out.split())
    for text in (effect.title, effect.equation, effect.source, effect.needs[1:], effect.signature[1:]):
        assert " ".join(text.split()) in out
    for form in effect.forms:
        assert form.name in out
        for p in form.shape:
            assert p.name in out and p.meaning[1:] in out and p.unit_for(effect.kinds[0]) in out


def test_json_has_every_parameter_with_units_and_ranges(tmp_path):
    file = tmp_path / "e.json"
    assert main(["effects", "backlash", "--json", str(file)]) == 0
    record = json.loads(file.read_text())
    assert record["schema"] == 1 and [e["name"] for e in record["effects"]] == ["backlash"]
    play = record["effects"][0]["forms"][0]["shape"][0]
    assert play["unit"] == {"tension": "m", "torsion": "rad", "bending": "rad", "shear": "m"}
    assert play["bounds"] == [0.0, None] and play["plausible"] == [0.0, 0.05] and play["source"]
    assert main(["effects", "--json", str(file)]) == 0
    assert json.loads(file.read_text())["effects"] == [effect_record(e) for e in library()]


def test_picture_is_drawn_into_the_folder(tmp_path, capsys):
    assert main(["effects", "sensor-lag", "--out", str(tmp_path / "pictures")]) == 0
    assert (tmp_path / "pictures" / "sensor-lag.png").read_bytes()[:4] == b"\x89PNG"
    assert "sensor-lag.png" in capsys.readouterr().out.replace("\n", "")


def test_a_name_that_is_not_there_is_a_sentence(capsys):
    assert main(["effects", "friction"]) == 2
    said = capsys.readouterr()
    assert 'no effect "friction"' in said.err and "interlayer-friction" in said.err and said.out == ""

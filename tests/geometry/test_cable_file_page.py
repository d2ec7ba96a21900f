"""The page on the cable file: its examples can be read, and its sentences are those of real runs."""

import re
import tomllib
from pathlib import Path

import pytest

from geometry import InputError, MeshError, cable_files, cross_section_mesh, read_cable

PAGE = Path(__file__).resolve().parents[2] / "docs" / "cable-file.md"
TEXT = PAGE.read_text(encoding="utf-8")
BLOCKS = re.findall(r"```toml\n(.*?)```", TEXT, flags=re.S)
FLAT = " ".join(line.removeprefix("> ") for line in TEXT.splitlines())


def test_the_complete_example_is_a_cable(tmp_path):
    path = tmp_path / "my-cable.toml"
    path.write_text(next(block for block in BLOCKS if block.startswith("name =")), encoding="utf-8")
    assert [part.kind for part in read_cable(path).parts].count("insulation") == 3


@pytest.mark.parametrize("block", range(len(BLOCKS)))
def test_every_block_is_toml(block):
    assert tomllib.loads(BLOCKS[block])


def test_the_blocks_on_wires_and_sheet_fit_into_the_cables_they_name(tmp_path):
    """Put in place of the shipped tables, they give the same cable."""
    for name, table in (
        ("strand-1x7-steel", "conductors"),
        ("sea-three-core", "layers"),
        ("mcpt-1.9-3.3-3x35", "data-sheet"),
    ):
        assert any(table in tomllib.loads(block) for block in BLOCKS)
        whole = tomllib.loads(cable_files()[name].read_text(encoding="utf-8"))
        parsed = [
            tomllib.loads(block) for block in BLOCKS if not block.startswith("name =") and table in tomllib.loads(block)
        ]
        for shown in parsed:
            if table == "layers":
                values = [
                    {k: v["value"] if isinstance(v, dict) else v for k, v in layer.items()} for layer in whole[table]
                ]
                for layer in shown[table]:
                    assert {k: v["value"] if isinstance(v, dict) else v for k, v in layer.items()} in values
            elif table == "conductors":
                assert shown[table]["wire"]["wire_diameter"]["value"] == whole[table]["wire"]["wire_diameter"]["value"]
            else:
                assert shown[table]["outer_diameter"] == whole[table]["outer_diameter"]


def test_sentences_of_the_page_are_those_of_real_runs(tmp_path):
    sea = cable_files()["sea-three-core"].read_text(encoding="utf-8")
    path = tmp_path / "mine.toml"
    path.write_text(sea.replace('value = "677.95 mm"', 'value = "400 mm"'), encoding="utf-8")
    with pytest.raises(InputError) as locked:
        read_cable(path)
    assert str(locked.value) in FLAT
    with pytest.raises(MeshError) as several:
        cross_section_mesh(read_cable("sea-three-core"))
    assert str(several.value) in FLAT


def test_every_shipped_cable_is_named_on_the_page():
    for name in cable_files():
        assert f"`{name}`" in TEXT

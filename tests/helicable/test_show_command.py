"""`helicable show` and `cables` on every cable that ships: short tables, the data sheet, records for machines."""

import json

import pytest

from geometry import cable_files, read_cable
from helicable.commands.show import clearance_rows, part_rows, sheet_rows
from helicable.main import main


@pytest.mark.parametrize("name", sorted(cable_files()))
def test_every_cable_is_shown_on_a_page_or_two(name, tmp_path, capsys):
    assert main(["show", name, "--json", str(tmp_path / "s.json")]) == 0
    out = capsys.readouterr().out
    assert name in out and len(out.splitlines()) < 150
    record = json.loads((tmp_path / "s.json").read_text())
    cable = read_cable(name)
    assert len(record["parts"]) == len(cable.parts)
    assert sum(part["mass_per_length"] for part in record["parts"]) == pytest.approx(cable.mass_per_length)
    assert len(record["clearances"]) < 40


def test_wires_of_a_layer_share_a_row():
    """120 wires: one row for the centre and one for each of six layers; the masses of the rows add up."""
    cable = read_cable("spiral-strand-120")
    rows = part_rows(cable)
    assert len(rows) == 7 and rows[1][0] == "layer 2: 7 wires" and rows[-1][0] == "layer 7: 33 wires"
    assert sum(float(row[-1]) for row in rows) == pytest.approx(1e3 * cable.mass_per_length, abs=0.4)
    assert len(clearance_rows(cable)) == 12


def test_sea_cable_has_rows_for_its_armour():
    names = [row[0] for row in part_rows(read_cable("sea-three-core"))]
    assert "inner armour: 55 wires" in names and "outer armour: 63 wires" in names and len(names) == 15


def test_pairs_that_are_alike_share_a_row_in_long_lists(tmp_path):
    """Twelve cores round a thick centre: 24 pairs, two rows."""
    text = cable_files()["strand-1x7-steel"].read_text(encoding="utf-8")
    text = text.replace('value = "3.94 mm"', 'value = "14 mm"').replace(
        'cores = ["wire", "wire", "wire", "wire", "wire", "wire"]', f"cores = {['wire'] * 12}"
    )
    text = text.replace('value = "115 mm"', 'value = "140 mm"')
    path = tmp_path / "twelve.toml"
    path.write_text(text, encoding="utf-8")
    rows = dict(clearance_rows(read_cable(path)))
    assert rows["core - wire (12 times)"] == "0.000"
    assert "wire - wire (12 times)" in rows and len(rows) == 2


def test_data_sheet_is_compared(tmp_path, capsys):
    """Computed, stated, difference in per cent, range; in the record for machines in SI."""
    assert sheet_rows(read_cable("sea-three-core")) == [
        ("outer diameter", "101.13 mm", "101.00 mm", "+0.1 %", "inside 100 .. 102 mm")
    ]
    text = cable_files()["mcpt-1.9-3.3-3x35"].read_text(encoding="utf-8")
    sheet = 'mass_per_length = { value = "3.5 kg/m", status = "published", range = ["3.4 kg/m", "3600 g/m"], source = "test" }'
    path = tmp_path / "mine.toml"
    path.write_text(text.replace("[data-sheet]\n", f"[data-sheet]\n{sheet}\n"), encoding="utf-8")
    assert main(["show", str(path), "--json", str(tmp_path / "s.json")]) == 0
    assert "OUTSIDE 3.4 .. 3.6 kg/m" in capsys.readouterr().out
    found = {row["name"]: row for row in json.loads((tmp_path / "s.json").read_text())["data_sheet"]}
    assert found["mass per length"]["inside"] is False and found["outer diameter"]["inside"] is True
    assert found["mass per length"]["difference"] == pytest.approx(4.047 - 3.5, abs=0.001)
    assert found["outer diameter"]["low"] == pytest.approx(0.0472)


def test_several_lays_are_refused_by_the_2d_cell_in_one_sentence(capsys):
    assert main(["homogenize", "spiral-strand-120"]) == 2
    said = capsys.readouterr().err
    assert "layers of several lays" in said and "one layer at a time" in said and "Traceback" not in said

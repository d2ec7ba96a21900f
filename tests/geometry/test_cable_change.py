"""A cable file with numbers changed: the rest stays as it was, letter by letter, and the file is read as any other."""

import pytest

from geometry import read_cable
from geometry.cable_change import ChangedNumber, changed_cable_text
from geometry.cable_file import cable_files
from geometry.errors import SpecError

CABLE = "mcpt-1.9-3.3-3x35"


def test_changed_number_is_read_back(tmp_path):
    text = cable_files()[CABLE].read_text(encoding="utf-8")
    change = ChangedNumber("250 mm", "computed", "calibrated to E", ("195 mm", "468 mm"))
    rubber = ChangedNumber("71 MPa", "computed", "calibrated to E", ("4 MPa", "110 MPa"))
    new = changed_cable_text(text, {"lay-up.lay": change, "materials.EPR insulation.E": rubber})
    different = [(a, b) for a, b in zip(text.split("\n"), new.split("\n"), strict=True) if a != b]
    assert len(different) == 2
    path = tmp_path / "changed.toml"
    path.write_text(new, encoding="utf-8")
    cable, before = read_cable(path), read_cable(CABLE)
    assert cable.outer_diameter == pytest.approx(before.outer_diameter, rel=0.02)
    assert 'source = "calibrated to E"' in new and 'range = ["4 MPa", "110 MPa"]' in new


def test_key_that_is_not_there_is_a_sentence():
    with pytest.raises(SpecError, match=r'no entry "materials.felt.E"'):
        changed_cable_text("[sheath]\nwall = 1", {"materials.felt.E": ChangedNumber("1 MPa", "computed", "x")})

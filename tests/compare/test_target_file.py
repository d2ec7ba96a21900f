"""The target file: the published numbers are read in SI, and bad files are sentences."""

import pytest

from compare.target_file import InputParameter, read_targets
from geometry.errors import SpecError

GOOD = """
title = "made up"
[[targets]]
name = "E"
value = "142 MPa"
error = 0.03
load = "tension 2000 N"
source = "made up"
[[parameters]]
name = "sheath"
moves = ["materials.rubber.E"]
range = ["3 MPa", "12 MPa"]
status = "assumed"
reason = "made up"
"""


def test_published_numbers():
    """Ge et al. 2023; u_x and u_y are the half-sums of +X, -X and +Y, -Y."""
    file = read_targets("published")
    wanted = {
        "E": 142e6,
        "G_yoz": 53e6,
        "G_xoz": 45e6,
        "u_z": 4.1e-3,
        "u_x": (6.95e-3 + 7.96e-3) / 2,
        "u_y": (7.71e-3 + 7.02e-3) / 2,
    }
    assert {t.name: t.value for t in file.targets} == pytest.approx(wanted, rel=1e-12)
    ranges = {p.name: (p.low, p.high) for p in file.parameters}
    assert ranges["sheath"] == pytest.approx((3e6, 12e6)) and ranges["insulation"] == pytest.approx((4e6, 110e6))
    assert all(p.start is not None and p.low <= p.start <= p.high for p in file.parameters)


def test_value_never_leaves_the_range():
    side = InputParameter("a", ("a",), 2.0, 8.0, "m", "assumed", "x")
    assert side.value(sum(side.bounds) / 2) == pytest.approx(4.0)  # middle of the logarithms
    assert side.value(100.0) == 8.0 and side.value(-100.0) == 2.0


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('"142 MPa"', "142", "has no unit"),
        ('"142 MPa"', '"142 mm"', "cannot be read in Pa"),
        ('"142 MPa"', '"-142 MPa"', "not positive"),
        ("0.03", "3", "between 0 and 1"),
        ('name = "E"', 'name = "G_yox"', "G_yoz"),
        ('source = "made up"', "", "source is missing"),
        ('["3 MPa", "12 MPa"]', '["12 MPa", "3 MPa"]', "is empty"),
        ('["3 MPa", "12 MPa"]', '["0 MPa", "3 MPa"]', "must be positive"),
        ('"assumed"', '"guessed"', "status must be one of"),
        ('reason = "made up"', 'start = "1 MPa"\nreason = "made up"', "outside the range"),
        ("[[parameters]]", "[[parameter]]", "parameter"),
        ("title =", "title", "not valid TOML"),
    ],
)
def test_bad_files_are_sentences(tmp_path, old, new, sentence):
    assert old in GOOD
    path = tmp_path / "targets.toml"
    path.write_text(GOOD.replace(old, new, 1))
    with pytest.raises(SpecError, match=r"targets\.toml") as found:
        read_targets(path)
    assert sentence in str(found.value)


def test_same_key_moved_twice(tmp_path):
    path = tmp_path / "targets.toml"
    path.write_text(GOOD + GOOD[GOOD.index("[[parameters]]") :].replace('"sheath"', '"other"'))
    with pytest.raises(SpecError, match="moved by 2 parameters"):
        read_targets(path)
    path.write_text(GOOD)
    assert len(read_targets(path).parameters) == 1

"""`helicable specimen` on contacts that open: the whole route from the cable file to table and record; bad laws are one sentence."""

import json

import pytest

from helicable.main import main
from helicable.opening_words import read_opening

CABLE = """
name = "one-core"
title = "One core off the axis of a rubber hose"
notes = ["A test case, not a product."]

[conductors.rod]
wires = { value = 1, status = "computed", source = "test" }
wire_diameter = { value = "6 mm", status = "computed", source = "test" }
wire_density = { value = "7850 kg/m^3", status = "computed", source = "test" }
fill = { value = 1.0, status = "computed", source = "test" }
E = { value = "100 MPa", status = "computed", source = "test" }
nu = { value = 0.30, status = "computed", source = "test" }

[cores.rod]
conductor = "rod"

[lay-up]
cores = ["rod"]
pitch_circle_radius = { value = "2 mm", status = "computed", source = "test" }
lay = { value = "150 mm", status = "computed", source = "test" }
hand = "Z"

[interstices]
material = "rubber"

[sheath]
wall = { value = "3 mm", status = "computed", source = "test" }
material = "rubber"

[materials.rubber]
E = { value = "4 MPa", status = "computed", source = "test" }
nu = { value = 0.45, status = "computed", source = "test" }
density = { value = "1400 kg/m^3", status = "computed", source = "test" }
"""


@pytest.fixture(scope="module")
def cable(tmp_path_factory):
    path = tmp_path_factory.mktemp("one_core") / "one-core.toml"
    path.write_text(CABLE, encoding="utf-8")
    return str(path)


def test_the_whole_route(cable, tmp_path, capsys):
    """A core with an interference, both signs of a shear: displacements of the size of a rubber cantilever's (E between that of the
    hose and of the core), the two signs differ, the parts open, friction takes work, forces balance; all of it in table and record."""
    record = tmp_path / "found.json"
    words = ["--length", "20 mm", "--load", "shear:x,shear:-x", "--force", "3 N", "--steps", "2"]
    law = "core-filler=opening:-0.02 mm+coulomb:0.3"
    assert main(["specimen", cable, *words, "--interface", law, "--json", str(record)]) == 0
    found = json.loads(record.read_text(encoding="utf-8"))
    assert found["interface"] == "core-filler contact that opens, friction 0.3, interference 2e-05 m"
    plus, minus = (found["loads"][f"shear {sign}x"] for sign in "+-")
    assert plus["size"] == 3.0 and minus["size"] == -3.0
    for one in (plus, minus):
        assert len(one["curve"]["stress"]) == 3
        assert 2e-4 < one["u_mean"] < one["u_max"] < 2e-3
    assert abs(plus["u_max"] - minus["u_max"]) > 2e-6
    notes = " ".join(found["notes"])
    assert "an interference was let go" in notes and "rubbed away" in notes and "+x against -x" in notes
    assert "in balance" in notes
    printed = capsys.readouterr().out
    assert "shear +x" in printed and "even part" in printed


@pytest.mark.parametrize(
    ("law", "sentence"),
    [
        ("core-filler=opening+grip:-5 kPa", "a grip presses the parts together"),
        ("core-filler=opening+coulomb:5", "coefficient of friction of 5; give one from 0 to 2"),
        ("core-filler=opening+coulomb:-0.1", "coefficient of friction of -0.1"),
        ("core-filler=opening+coulomb:0.3+coulomb:0.2", "which is not known"),
        ("core-filler=opening:0.1 mm+grip:5 kPa", "with a gap between them cannot be gripped"),
        ("core-glass=opening", 'no part is "glass"'),
        ("=opening", "a law without a pair"),
    ],
)
def test_bad_laws(cable, law, sentence, capsys):
    assert main(["specimen", cable, "--interface", law]) == 2
    error = capsys.readouterr().err
    assert sentence in error and "Traceback" not in error


def test_grip_in_words():
    law = read_opening("core-filler=opening+grip:20 kPa+coulomb:0.3").laws["core-filler"]
    assert (law.friction, law.grip, law.gap) == (0.3, 20e3, 0.0)

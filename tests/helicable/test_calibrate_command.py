"""`helicable calibrate` on one small real specimen: what made the targets is found again, and the file says so."""

import json
import tomllib

import pytest

from geometry import read_cable
from helicable.main import main
from homogenize import Elastic, Interfaces
from homogenize.specimen import Specimen, solve_specimen
from homogenize.specimen.specimen_mesh import specimen_mesh
from homogenize.specimen.unit_response import UNIT_LOADS, unit_response

CABLE = """
name = "disc"
title = "A rod in rubber"
notes = [
    "made up",
]

[conductors.rod]
wires = { value = 1, status = "assumed", source = "made up" }
wire_diameter = { value = "20 mm", status = "assumed", range = ["10 mm", "25 mm"], source = "made up" }
wire_density = { value = "6343 kg/m^3", status = "published", source = "made up" }
fill = { value = 1.0, status = "computed", source = "solid" }
E = { value = "400 MPa", status = "assumed", range = ["100 MPa", "1000 MPa"], source = "made up" }
nu = { value = 0.3, status = "assumed", range = [0.2, 0.4], source = "made up" }

[centre]
conductor = "rod"

[sheath]
wall = { value = "10 mm", status = "assumed", range = ["5 mm", "20 mm"], source = "made up" }
material = "rubber"

[materials.rubber]
E = { value = "5 MPa", status = "assumed", range = ["2 MPa", "20 MPa"], source = "made up" }
nu = { value = 0.45, status = "assumed", range = [0.3, 0.49], source = "made up" }
density = { value = "1400 kg/m^3", status = "assumed", range = ["1300 kg/m^3", "1500 kg/m^3"], source = "made up" }
"""
TARGETS = """
title = "a rod of 250 MPa in rubber of 8 MPa"
{targets}
[[parameters]]
name = "length"
moves = ["length"]
range = ["90 mm", "110 mm"]
status = "assumed"
reason = "made up"
[[parameters]]
name = "rubber"
moves = ["materials.rubber.E"]
range = ["4 MPa", "12 MPa"]
status = "assumed"
reason = "made up"
[[parameters]]
name = "rod"
moves = ["conductors.rod.E"]
range = ["150 MPa", "600 MPa"]
status = "assumed"
reason = "made up"
"""
INTERFACE = """
title = "an interface of 0.2 MPa/mm"
{targets}
[[parameters]]
name = "length"
moves = ["length"]
range = ["98 mm", "102 mm"]
status = "assumed"
reason = "made up"
[[parameters]]
name = "grip"
moves = ["interface.conductor-sheath"]
range = ["0.01 MPa/mm", "10 MPa/mm"]
status = "assumed"
reason = "made up"
"""
TARGET = '[[targets]]\nname = "{}"\nvalue = "{} {}"\nerror = 0.01\nload = "x"\nsource = "made up"\n'
RUN = ("--size", "11 mm", "--coarse", "14 mm", "--snapshots", "3", "--starts", "1", "--runs", "4")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Folder with a cable, targets from its full model at known inputs, and the calibration of `helicable calibrate`."""
    folder = tmp_path_factory.mktemp("calibrate")
    (folder / "disc.toml").write_text(CABLE)
    (folder / "truth.toml").write_text(
        CABLE.replace('"400 MPa"', '"250 MPa"').replace('"5 MPa", status', '"8 MPa", status')
    )
    mesh = specimen_mesh(read_cable(folder / "truth.toml"), 11e-3)
    truth = unit_response(solve_specimen(Specimen(0.1), mesh, UNIT_LOADS, tolerance=1e-4)).outputs(2000.0, 500.0)
    units = {"E": "Pa", "u_z": "m", "u_x": "m"}
    targets = "".join(TARGET.format(name, float(truth[name]), unit) for name, unit in units.items())
    (folder / "targets.toml").write_text(TARGETS.format(targets=targets))
    arguments = ["calibrate", str(folder / "disc.toml"), "--targets", str(folder / "targets.toml"), *RUN]
    assert main([*arguments, "--out", str(folder / "out")]) == 0
    return folder, arguments, json.loads((folder / "out" / "calibration.json").read_text())


def test_targets_are_met_by_the_full_model(made):
    """Three targets, three inputs that they see: every ratio is one within what cheap and full model were asked to agree."""
    _, _, record = made
    assert record["agreed"]
    assert record["ratios"] == pytest.approx({"E": 1.0, "u_z": 1.0, "u_x": 1.0}, rel=0.01)


def test_inputs_that_made_the_targets_are_found_again(made):
    """Within three of their own standard errors, which come from targets that are known to 1 %."""
    found = {p["name"]: p for p in made[2]["inputs"]}
    for name, true in (("length", 0.1), ("rubber", 8e6), ("rod", 250e6)):
        assert found[name]["range"][0] <= found[name]["value"] <= found[name]["range"][1]
        assert abs(found[name]["value"] / true - 1) < 3 * found[name]["standard_error"], name


def test_calibrated_file_says_where_its_numbers_come_from(made):
    """It is a cable file; changed values are marked, inside their range, and the others are as they were."""
    path = made[0] / "out" / "disc-calibrated.toml"
    table = tomllib.loads(path.read_text())
    rubber = table["materials"]["rubber"]["E"]
    assert rubber["source"].startswith("calibrated to E, u_z, u_x of a rod of 250 MPa") and rubber["range"] == [
        "4 MPa",
        "12 MPa",
    ]
    assert (
        table["specimen"]["length"]["source"].startswith("calibrated to")
        and table["sheath"]["wall"]["source"] == "made up"
    )
    cable = read_cable(path)
    assert cable.outer_diameter == pytest.approx(0.04)
    assert cable.specimen is not None
    assert cable.specimen.length == pytest.approx(
        next(p["value"] for p in made[2]["inputs"] if p["name"] == "length"), rel=1e-6
    )


def test_resumed_run_solves_no_full_model_again(made, capsys):
    """All full runs are found by the hash of their inputs, and the result is the same."""
    folder, arguments, record = made
    runs = folder / "out" / "finished-runs.jsonl"
    before = runs.read_text()
    assert main([*arguments, "--out", str(folder / "out")]) == 2
    assert "--resume" in capsys.readouterr().err
    assert main([*arguments, "--out", str(folder / "out"), "--resume"]) == 0
    assert runs.read_text() == before
    assert json.loads((folder / "out" / "calibration.json").read_text())["ratios"] == record["ratios"]


def test_stiffness_of_an_interface_is_found_again(tmp_path):
    """0.2 MPa/mm, of the order of the rubber's own G / wall, where E and the deflection see it; the file says the interface."""
    (tmp_path / "disc.toml").write_text(CABLE)
    mesh = specimen_mesh(read_cable(tmp_path / "disc.toml"), 14e-3)
    held = Specimen(0.1, interface=Interfaces({"conductor-sheath": Elastic(2e8)}))
    truth = unit_response(solve_specimen(held, mesh, UNIT_LOADS, tolerance=1e-3)).outputs(2000.0, 500.0)
    targets = "".join(TARGET.format(n, float(truth[n]), u) for n, u in (("E", "Pa"), ("u_x", "m")))
    (tmp_path / "targets.toml").write_text(INTERFACE.format(targets=targets))
    words = [
        "calibrate",
        str(tmp_path / "disc.toml"),
        "--targets",
        str(tmp_path / "targets.toml"),
        "--size",
        "14 mm",
        "--coarse",
        "14 mm",
    ]
    assert main([*words, "--snapshots", "1", "--starts", "1", "--runs", "4", "--out", str(tmp_path / "out")]) == 0
    record = json.loads((tmp_path / "out" / "calibration.json").read_text())
    grip = next(p for p in record["inputs"] if p["name"] == "grip")
    assert record["agreed"] and grip["unit"] == "Pa/m"
    assert grip["value"] == pytest.approx(2e8, rel=0.05)  # one sigma of targets known to 1 %
    cable = read_cable(tmp_path / "out" / "disc-calibrated.toml")
    assert cable.specimen is not None and cable.specimen.interface.startswith("conductor-sheath=elastic:")


def test_bad_requests_are_sentences(made, tmp_path, capsys):
    folder = made[0]
    targets = (folder / "targets.toml").read_text()
    wall, no_length, apart = (tmp_path / f"{name}.toml" for name in ("wall", "no_length", "apart"))
    apart.write_text(
        INTERFACE.format(targets=TARGET.format("E", 1.0, "Pa")).replace("conductor-sheath", "conductor-conductor")
    )
    wall.write_text(
        targets.replace('"materials.rubber.E"', '"materials.rubber.E", "sheath.wall"').replace(
            '["4 MPa", "12 MPa"]', '["9 mm", "11 mm"]'
        )
    )
    start = targets.index("[[parameters]]")
    no_length.write_text(targets[:start] + targets[targets.index("[[parameters]]", start + 1) :])
    disc = str(folder / "disc.toml")
    for words, sentence in (
        (["no-such-cable"], "no-such-cable"),
        ([disc, "--targets", str(tmp_path / "none.toml")], "no such file"),
        ([disc, "--targets", "published"], "no entry"),
        ([disc, "--targets", str(wall)], "cannot be read in"),
        ([disc, "--targets", str(no_length)], "length"),
        ([disc, "--targets", str(apart)], "do not touch"),
        ([disc, "--resume"], "--out"),
        ([disc, "--runs", "0"], "--runs"),
    ):
        assert main(["calibrate", *words]) == 2
        assert sentence in capsys.readouterr().err

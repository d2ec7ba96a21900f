"""`helicable loop`, and interfaces by pairs in `helicable homogenize`: slopes between two limits, area = heat, sentences."""

import csv
import json

import numpy as np
import pytest

from geometry import cross_section_mesh, read_cable
from geometry.errors import SpecError
from helicable.interface_words import read_interface, read_laws
from helicable.main import main
from homogenize import Coulomb, Elastic, Frictionless, Unilateral, axial_friction, grip_per_tension

CABLE = "example-three-core"
COARSE = ("--size", "2.5 mm")


def run(folder, *arguments):
    """The record of a loop."""
    assert main(["loop", CABLE, *COARSE, *arguments, "--out", str(folder)]) == 0
    return json.loads((folder / "loop.json").read_text())


def homogenized(file, interface):
    assert main(["homogenize", CABLE, *COARSE, "--interface", interface, "--json", str(file)]) == 0
    return json.loads(file.read_text())


@pytest.fixture(scope="module")
def sections(tmp_path_factory):
    """The section with several interfaces, from `helicable homogenize`."""
    folder = tmp_path_factory.mktemp("sections")
    words = {
        "bonded": "bonded",
        "conductors": "conductor-insulation=frictionless",
        "stiff": "conductor-insulation=elastic:1e17 Pa/m",
        "soft": "conductor-insulation=elastic:1 Pa/m",
        "cores": "core-filler=frictionless",
        "both": "conductor-insulation=frictionless,core-filler=frictionless",
    }
    return {name: homogenized(folder / f"{name}.json", word) for name, word in words.items()}


@pytest.fixture(scope="module")
def tension(tmp_path_factory):
    """A tension loop far beyond the onset of slip, and its folder."""
    folder = tmp_path_factory.mktemp("tension")
    arguments = ("--load", "tension", "--amplitude", "0.002", "--grip", "0.1 MPa", "--steps", "200")
    return run(folder, *arguments), folder


def test_first_slope_is_bonded_and_last_is_frictionless(tension, sections):
    """The limits of the loop are the sections of `helicable homogenize`; the loop starts and ends on them."""
    slopes = tension[0]["slopes"]
    assert slopes["bonded"] == pytest.approx(sections["bonded"]["section"]["EA_blocked_twist"], rel=1e-8)
    assert slopes["frictionless"] == pytest.approx(sections["conductors"]["section"]["EA_blocked_twist"], rel=1e-8)
    gap = slopes["bonded"] - slopes["frictionless"]
    assert gap > 0.1 * slopes["bonded"]
    assert slopes["first_step"] == pytest.approx(slopes["bonded"], rel=1e-6)
    assert 0 <= slopes["last_step"] - slopes["frictionless"] < 1e-3 * gap


def test_area_is_heat_and_damping_is_their_share(tension):
    """The area of the loop, by the trapezoids of the written path, is the heat; zeta = W / (2 pi F e)."""
    record, _ = tension
    strain, force, heat = (np.array(record["loop"][key]) for key in ("strain", "force", "dissipated"))
    last = slice(len(strain) - 161, None)
    area = np.trapezoid(force[last], strain[last])
    assert record["area"] == pytest.approx(area, rel=1e-9)
    assert record["dissipated"] == pytest.approx(heat[-1] - heat[-161], rel=1e-9)
    assert record["area"] == pytest.approx(record["dissipated"], rel=2e-3)  # steps of a fortieth of the amplitude
    zeta = record["dissipated"] / (2 * np.pi * np.ptp(force[last]) / 2 * np.ptp(strain[last]) / 2)
    assert record["damping_ratio"] == pytest.approx(zeta, rel=1e-12) and 0 < zeta < 2 / np.pi
    assert record["cone_violation"] < 1e-4
    assert strain[-161] == strain[-1] == strain.max() == 0.002 and strain.min() == -0.002


def test_table_and_picture_are_written(tension):
    """The CSV holds the path of the JSON; the picture is there."""
    record, folder = tension
    with (folder / "loop.csv").open() as file:
        head, *rows = csv.reader(file)
    assert head == ["stretch [1]", "tension [N]", "heat [J/m]"]
    np.testing.assert_allclose(np.array(rows, dtype=float)[:, 1], record["loop"]["force"], rtol=1e-8, atol=1e-12)
    assert (folder / "loop.png").stat().st_size > 30_000


def test_a_strong_grip_leaves_the_section_bonded(tmp_path, capsys):
    record = run(tmp_path, "--load", "torsion", "--amplitude", "1 deg/m", "--grip", "100 MPa", "--steps", "20")
    assert record["slid"] == 0 and record["dissipated"] == 0
    assert record["slopes"]["last_step"] == pytest.approx(record["slopes"]["bonded"], rel=1e-9)
    assert "nothing slid" in capsys.readouterr().out


def test_bending_lies_between_the_limits(tmp_path, sections):
    """EI of the homogenized sections, bonded and sliding, bound the slopes of the loop."""
    arguments = ("--load", "bending", "--amplitude", "2 1/m", "--harmonics", "1", "--steps", "40")
    slopes = run(tmp_path, *arguments)["slopes"]
    assert slopes["bonded"] == pytest.approx(sections["bonded"]["section"]["EI_x"], rel=1e-6)
    assert slopes["frictionless"] == pytest.approx(sections["conductors"]["section"]["EI_x"], rel=1e-6)
    assert slopes["frictionless"] < slopes["last_step"] < slopes["first_step"] <= slopes["bonded"] * (1 + 1e-6)


def test_tension_grips_the_conductors(tmp_path):
    """The grip is that of the pulled section, place by place, zero where the parts are pulled apart; it adds to the torque."""
    arguments = ("--load", "torsion", "--amplitude", "20 deg/m", "--steps", "10", "--grip", "1 kPa")
    loose, pulled = run(tmp_path / "a", *arguments), run(tmp_path / "b", *arguments, "--tension", "300 N")
    mesh, rubs = cross_section_mesh(read_cable(CABLE), size=2.5e-3), read_laws("conductor-insulation", friction=0.3)
    pressure = np.maximum(1e3 + 300.0 * grip_per_tension(mesh, rubs), 0.0)
    surface = axial_friction(mesh, rubs).surface
    assert pulled["mean_grip"] == pytest.approx(pressure @ surface / surface.sum(), rel=1e-9)
    assert loose["mean_grip"] == pytest.approx(1e3, rel=1e-12)
    assert pulled["peak_force"] > loose["peak_force"]


def test_pairs_go_from_bonded_to_sliding(sections):
    """Stiff springs are a bond, soft ones slide; each pair that slides lowers EA, GJ and EI."""
    for key in ("EA_blocked_twist", "GJ", "EI_x"):
        value = {name: record["section"][key] for name, record in sections.items()}
        assert value["stiff"] == pytest.approx(value["bonded"], rel=1e-4), key
        assert value["soft"] == pytest.approx(value["conductors"], rel=1e-4), key
        assert value["both"] < min(value["conductors"], value["cores"]) < value["bonded"], key


def test_the_file_says_which_interfaces_and_which_motions(sections, tmp_path, capsys):
    assert sections["bonded"]["interface"] == "bonded" and sections["bonded"]["free_motions"] == []
    assert sections["soft"]["interface"] == "conductor-insulation elastic, 1 Pa/m"
    assert sections["soft"]["free_motions"] == []
    assert sections["conductors"]["free_motions"] == [f"core {i} conductor slides along its helix" for i in (1, 2, 3)]
    homogenized(tmp_path / "again.json", "conductor-insulation=frictionless")
    assert "core 2 conductor slides along its helix" in " ".join(capsys.readouterr().out.split())


def test_words_become_laws():
    """Units are read at the border; a pair without a law rubs, if a coefficient is given."""
    found = read_laws("core-filler = elastic: 2e9 N/m^3, sheath-filler=frictionless,conductor-insulation", friction=0.2)
    assert found.laws == {
        "core-filler": Elastic(2e9),
        "sheath-filler": Frictionless(),
        "conductor-insulation": Coulomb(0.2),
    }
    assert read_interface(" frictionless ") == "frictionless"
    with pytest.raises(SpecError, match="needs a law"):
        read_laws("core-filler,a=frictionless")


BAD_PAIRS = [
    ("core-filler", "name pairs of parts with a law each"),
    ("core-filler=glue", '"glue", which is not known'),
    ("core-filler=bonded", "pairs that are not named are bonded"),
    ("core-filler=elastic", "elastic:STIFFNESS"),
    ("core-filler=elastic:1e9", "cannot be read in Pa/m"),
    ("core-filler=elastic:1e9 N/m", "cannot be read in Pa/m"),
    ("core-filler=elastic:-1 Pa/m", "zero or a positive number"),
    ("core-filler=frictionless,core-filler=elastic:1 Pa/m", 'names "core-filler" twice'),
    (",core-filler=frictionless", "without the name of a pair"),
    ("armour-sheath=frictionless", 'no part is "armour"'),
    ("conductor-sheath=frictionless", "do not touch"),
    ("conductor-insulation=coulomb:0.3", "`helicable loop CABLE --interface"),
    ("core-filler=opening", "close it here with frictionless"),
    ("core-filler=opening:1 N", "cannot be read in m"),
]


@pytest.mark.parametrize(("interface", "words"), BAD_PAIRS, ids=[pair for pair, _ in BAD_PAIRS])
def test_bad_pairs_are_one_sentence(interface, words, capsys):
    assert main(["homogenize", CABLE, *COARSE, "--interface", interface]) == 2
    err = " ".join(capsys.readouterr().err.split())
    assert words in err and "Traceback" not in err


BAD_LOOPS = [
    (["--amplitude", "1"], "--amplitude"),
    ([], "--amplitude is missing"),
    (["--load", "shear", "--amplitude", "1 1/m"], "tension, torsion, bending"),
    (["--amplitude", "-1 1/m"], "between 0 and 1"),
    (["--amplitude", "1000 1/m"], "between 0 and 1"),
    (["--amplitude", "1 1/m", "--grip", "100"], "--grip"),
    (["--amplitude", "1 1/m", "--grip", "-1 Pa"], "pressed together"),
    (["--amplitude", "1 1/m", "--friction", "-0.1"], "zero or positive"),
    (["--amplitude", "1 1/m", "--steps", "5"], "do not fit"),
    (["--amplitude", "1 1/m", "--cycles", "0"], "at least one cycle"),
    (["--amplitude", "1 1/m", "--harmonics", "0"], "at least one harmonic"),
    (["--amplitude", "1 1/m", "--free-twist"], "--load tension"),
    (["--load", "tension", "--amplitude", "0.001", "--tension", "5 N"], "--tension-grips"),
    (["--amplitude", "1 1/m", "--interface", "conductor-insulation=frictionless"], "names no pair that rubs or opens"),
    (["--amplitude", "1 1/m", "--interface", "conductor-sheath"], "do not touch"),
    (["--amplitude", "1 1/m", "--control", "speed"], "choose strain or force"),
    (["--control", "force"], 'such as "5 N m"'),
    (["--amplitude", "1 1/m", "--control", "force"], "--amplitude"),
    (["--amplitude", "-1 N m", "--control", "force"], "above zero"),
    (["--load", "tension", "--amplitude", "1 GN", "--control", "force"], "where nothing rubs"),
    (["--amplitude", "1 1/m", "--tension-grips"], "--tension-grips belongs to --load tension"),
    (["--amplitude", "1 1/m", "--interface", "armour-sheath"], 'no part is "armour"'),
]


@pytest.mark.parametrize(("arguments", "words"), BAD_LOOPS, ids=[" ".join(a) for a, _ in BAD_LOOPS])
def test_a_loop_that_cannot_be_is_one_sentence(arguments, words, capsys):
    assert main(["loop", CABLE, *COARSE, *arguments]) == 2
    err = " ".join(capsys.readouterr().err.split())
    assert words in err and "Traceback" not in err


OPENING = ("--interface", "core-filler=opening", "--grip", "0 Pa", "--size", "4 mm")


def test_parts_that_open_are_counted(tmp_path, capsys):
    """Without grip cores part in compression: softer than in tension, where they are pressed; share and gap are printed and kept."""
    record = run(tmp_path, "--load", "tension", "--amplitude", "0.002", "--steps", "10", *OPENING)
    strain, force = (np.array(record["loop"][key]) for key in ("strain", "force"))
    share, gap = (np.array(record["loop"][key]) for key in ("open_share", "largest_gap"))
    assert force[strain == -0.002].max() > -0.5 * force[strain == 0.002].min()
    assert record["slopes"]["open"] < record["slopes"]["last_step"] < record["slopes"]["frictionless"]
    assert 0 < share.max() < 1 and share[0] == gap[0] == 0 and strain[gap.argmax()] == -0.002
    out = " ".join(capsys.readouterr().out.split())
    assert (
        f"{100 * share.max():.1f} %" in out and f"{1e3 * gap.max():.4g} mm" in out and "largest gap is between" in out
    )
    with (tmp_path / "loop.csv").open() as file:
        head, *rows = csv.reader(file)
    assert head[3:] == ["open share [1]", "largest gap [m]"] and len(rows) == len(strain)
    assert (tmp_path / "loop.png").stat().st_size > 30_000


def test_a_gap_must_close_first(tmp_path):
    """With a gap far above the motions all stays open: the slope is that of the open section throughout."""
    arguments = ("--interface", "conductor-insulation=opening:5 mm+coulomb:0.3", "--grip", "0 Pa", "--size", "4 mm")
    record = run(tmp_path, "--load", "torsion", "--amplitude", "1 deg/m", "--steps", "10", *arguments)
    assert record["slopes"]["last_step"] == pytest.approx(record["slopes"]["open"], rel=1e-6)
    assert min(record["loop"]["open_share"]) > 0.999 and record["dissipated"] < 1e-12


def test_given_force_returns_the_loop_of_the_given_strain(tmp_path, tension):
    """The tension that the strain loop reached, prescribed: the same stretch at the turn, the same first slope, the heat within 1 %."""
    given = tension[0]
    arguments = ("--load", "tension", "--grip", "0.1 MPa", "--steps", "100", "--control", "force")
    found = run(tmp_path, *arguments, "--amplitude", f"{given['peak_force']} N")
    assert max(found["loop"]["strain"]) == pytest.approx(0.002, rel=1e-4)  # another path of the steps
    assert found["slopes"]["first_step"] == pytest.approx(
        given["slopes"]["bonded"], rel=2e-3
    )  # twice the step: some slip
    assert found["dissipated"] == pytest.approx(given["dissipated"], rel=1e-2)


def test_grip_follows_the_tension(tmp_path):
    """Under tension the conductors are gripped and the bonded slope lasts longer than on the way back under compression."""
    arguments = (
        "--load",
        "tension",
        "--amplitude",
        "0.002",
        "--steps",
        "10",
        "--grip",
        "1 kPa",
        "--free-twist",
        "--size",
        "4 mm",
    )
    loose, gripped = run(tmp_path / "a", *arguments), run(tmp_path / "b", *arguments, "--tension-grips")
    assert gripped["mean_grip"] > loose["mean_grip"] == pytest.approx(1e3)
    assert gripped["peak_force"] > loose["peak_force"] * 1.001
    assert gripped["cone_violation"] < 1e-4
    low = [min(record["loop"]["force"]) for record in (loose, gripped)]
    assert abs(low[1]) < gripped["peak_force"]


def test_bending_of_parts_that_open_under_a_tension(tmp_path):
    """The tension acts: it presses the cores; the loop starts when it is on, and both slopes stay between open and bonded."""
    arguments = (
        "--load",
        "bending",
        "--amplitude",
        "0.5 1/m",
        "--steps",
        "10",
        "--harmonics",
        "1",
        "--tension",
        "200 N",
    )
    opens = ("--interface", "conductor-insulation=opening", "--grip", "0 Pa", "--size", "4 mm")
    record = run(tmp_path, *arguments, *opens)
    assert record["first_step"] > 0 and record["loop"]["strain"][record["first_step"]] == 0
    slopes = record["slopes"]
    for key in ("first_step", "last_step"):
        assert slopes["open"] < slopes[key] < slopes["bonded"] * (1 + 1e-6)
    assert 0 < max(record["loop"]["open_share"]) < 1


def test_opening_words():
    assert read_laws("core-filler=opening").laws == {"core-filler": Unilateral()}
    assert read_laws("core-filler = opening : 0.05 mm + coulomb:0.2").laws == {"core-filler": Unilateral(5e-5, 0.2)}
    with pytest.raises(SpecError, match="coulomb:COEFFICIENT only"):
        read_laws("core-filler=opening+frictionless")
    with pytest.raises(SpecError, match="cannot be read in m"):
        read_laws("core-filler=opening:3 N")

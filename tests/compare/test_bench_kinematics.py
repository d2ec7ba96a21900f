"""The linear section on the bench: N = EA u/L, M_z = GJ tau, M = EI kappa, u = F (L^3/3EI + L/GA), and their inverses."""

from __future__ import annotations

import numpy as np
import pytest

from compare import BenchModel, Campaign, NominalSection
from geometry.errors import InputError
from homogenize.section_stiffness import SectionStiffness

EA, GA_X, GA_Y, EI_X, EI_Y, GJ, B = 4.0e5, 1.6e5, 1.2e5, 95.0, 140.0, 60.0, 900.0
C = np.diag([GA_X, GA_Y, EA, EI_X, EI_Y, GJ])
C[2, 5] = C[5, 2] = B
SECTION = SectionStiffness(C, area=2e-3)
X = np.array([0.0, 1e-3, 2e-3, -1e-3])
ZERO = np.ones(4)


def experiment(campaign_of, kind, table, **row):
    full = {"id": "e", "kind": kind, "specimen length [m]": 2.0, **row}
    return Campaign.read(campaign_of([full], {"e": table}))["e"]


@pytest.mark.parametrize(
    ("kind", "table", "expected"),
    [
        (
            "tension",
            {"extension [m]": X, "force [N]": ZERO, "torque [N m]": ZERO},
            {"force": EA * X / 2, "torque": B * X / 2},
        ),
        ("tension", {"strain [-]": X, "force [N]": ZERO}, {"force": EA * X}),
        (
            "torsion",
            {"rotation [rad]": X, "torque [N m]": ZERO, "force [N]": ZERO},
            {"torque": GJ * X / 2, "force": B * X / 2},
        ),
        ("torsion", {"twist [rad/m]": X, "torque [N m]": ZERO}, {"torque": GJ * X}),
        ("bending", {"curvature [1/m]": X, "moment [N m]": ZERO}, {"moment": 2 / (1 / EI_X + 1 / EI_Y) * X}),
    ],
)
def test_section_law(campaign_of, kind, table, expected):
    predicted = BenchModel(SECTION).predict(experiment(campaign_of, kind, table))
    assert set(predicted) == set(expected)
    for channel, values in expected.items():
        np.testing.assert_allclose(predicted[channel], values, rtol=1e-12)  # arithmetic only


@pytest.mark.parametrize(("direction", "EI", "GA"), [("x+", EI_Y, GA_X), ("x-", EI_Y, GA_X), ("y+", EI_X, GA_Y)])
def test_cantilever_bends_and_shears_in_the_plane_of_its_direction(campaign_of, direction, EI, GA):
    # a section with couplings has other compliances than 1/C: here x and y are uncoupled, so EI_y = C[4, 4]
    cantilever = experiment(campaign_of, "shear", {"deflection [m]": X, "force [N]": ZERO}, direction=direction)
    force = BenchModel(SECTION).predict(cantilever)["force"]
    np.testing.assert_allclose(force * (2.0**3 / (3 * EI) + 2.0 / GA), X, rtol=1e-12, atol=1e-18)


@pytest.mark.parametrize(
    ("kind", "path", "load"),
    [
        ("tension", "extension [m]", "force [N]"),
        ("torsion", "rotation [rad]", "torque [N m]"),
        ("bending", "curvature [1/m]", "moment [N m]"),
        ("shear", "deflection [m]", "force [N]"),
    ],
)
def test_prescribed_load_is_the_inverse_of_the_prescribed_path(campaign_of, kind, path, load):
    row = {"direction": "y-"} if kind == "shear" else {}
    by_path = experiment(campaign_of, kind, {path: X, load: ZERO}, **row)
    loads = BenchModel(SECTION).predict(by_path)[load.split(" [")[0]]
    by_load = experiment(campaign_of, kind, {path: ZERO, load: loads}, control=load.split(" [")[0], **row)
    assert by_load.record.prescribed == load.split(" [")[0]
    np.testing.assert_allclose(BenchModel(SECTION).predict(by_load)[path.split(" [")[0]], X, rtol=1e-12, atol=1e-18)


def test_torque_of_a_pull_with_prescribed_force(campaign_of):
    pull = experiment(
        campaign_of, "tension", {"extension [m]": ZERO, "force [N]": 1e3 * X, "torque [N m]": ZERO}, control="force"
    )
    np.testing.assert_allclose(BenchModel(SECTION).predict(pull)["torque"], B / EA * 1e3 * X, rtol=1e-12)


def test_stated_section_wins_over_the_cable_and_the_cable_fills_the_gaps():
    section = NominalSection({"EI": 50.0}).completed_by(SECTION)
    assert (section.EI_x, section.EI_y, section.GJ, section.coupling) == (50.0, 50.0, SECTION.GJ, B)
    assert section.EA_free_twist == pytest.approx(EA - B**2 / SECTION.GJ, rel=1e-14)


def test_missing_stiffness_is_a_sentence(campaign_of):
    pull = experiment(campaign_of, "tension", {"strain [-]": X, "force [N]": ZERO})
    with pytest.raises(InputError, match=r"\[section\]: EA is needed and not given"):
        BenchModel(NominalSection({"EI": 95.0})).predict(pull)


def test_free_parameters_are_the_stiffnesses_that_are_seen(campaign_of):
    pull = experiment(campaign_of, "tension", {"strain [-]": X, "force [N]": ZERO, "torque [N m]": ZERO})
    assert [p.name for p in BenchModel(SECTION).free_parameters([pull])] == ["EA", "coupling"]
    uncoupled = NominalSection({"EA": EA, "EI": EI_X, "GA": GA_X})
    assert [p.name for p in BenchModel(uncoupled).free_parameters([pull])] == ["EA"], "its coupling would be an effect"
    cantilever = experiment(campaign_of, "shear", {"deflection [m]": X, "force [N]": ZERO}, direction="x+")
    assert [p.moves for p in BenchModel(uncoupled).free_parameters([cantilever])] == [("EI", "GA")]

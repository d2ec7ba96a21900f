"""Contact that opens and rubs (Signorini and Coulomb) in tension, torsion and bending: its limits, Lame's onset of slip, heat."""

import dataclasses

import numpy as np
import pytest
from section_meshes import rings
from wire_in_rod import wire_in_rod

from geometry.errors import ConvergenceError, SpecError
from geometry.material import Material
from homogenize import contact_step
from homogenize.coaxial_cylinder import CoaxialCylinder
from homogenize.coulomb_interface import Coulomb
from homogenize.friction_loop import friction_loop
from homogenize.interface_choice import Interfaces
from homogenize.opening_contact import Unilateral, opening_path, opening_section
from homogenize.rubbing_section import axial_friction, bending_friction, contact_section
from homogenize.sliding_interface import Frictionless

PAIR = "conductor-insulation"
MU, BETA = 0.3, np.radians(9.2)
PATH = np.array([[0.01, 0.0], [-0.01, 0.0], [0.0, 0.1], [0.0, -0.1], [0.01, 0.03], [-0.02, 0.05]])
RADII = (0.5, 1.0)
SHRINKS = ((2.0, 0.45), (1.0, 0.1))
"""A core that shrinks away from its tube under tension."""


def opens(gap=0.0, friction=0.0):
    return Interfaces({PAIR: Unilateral(gap, friction)})


def rubs(friction=MU):
    return Interfaces({PAIR: Coulomb(friction)})


def cycle(amplitude, steps, columns=2, column=0):
    first, down = np.linspace(0, amplitude, steps + 1), np.linspace(amplitude, -amplitude, 2 * steps + 1)
    path = np.zeros((5 * steps + 1, columns))
    path[:, column] = np.concatenate([first, down[1:], down[::-1][1:]])
    return path


@pytest.fixture(scope="module")
def steep():
    return wire_in_rod(beta=np.radians(30.0))


@pytest.fixture(scope="module")
def slack():
    return wire_in_rod(a=0.5, r=3.0, beta=BETA, wire=10.0)


@pytest.fixture(scope="module")
def rubbing(steep):
    return contact_section(steep, opens(friction=MU))


def test_without_friction_the_loop_is_the_exact_contact(steep):
    """mu = 0: forces and gaps of the active-set solution, whatever the order of the rows."""
    exact = opening_path(opening_section(steep, opens()), PATH)
    found = friction_loop(contact_section(steep, opens()), PATH)
    np.testing.assert_allclose(found.force[1:], exact.force, atol=1e-8 * np.abs(exact.force).max())
    np.testing.assert_allclose(found.gap[1:, 0], exact.gap, atol=1e-5 * exact.gap.max())
    assert found.dissipation[-1] == 0.0


def test_always_closed_under_high_grip_is_the_bonded_section(steep, rubbing):
    """A grip far above the load neither opens nor slides."""
    found = friction_loop(rubbing, cycle(0.01, 3), 100.0)
    np.testing.assert_allclose(found.force, found.strain @ rubbing.bonded, rtol=1e-7, atol=1e-9)
    assert not found.is_open.any() and found.dissipation[-1] == 0.0
    np.testing.assert_allclose(rubbing.bonded, axial_friction(steep, rubs()).bonded, rtol=1e-8)


def test_under_a_grip_that_hardly_changes_it_is_the_loop_of_given_grip(steep):
    """mu p with mu -> 0, p -> infinity at one product: contact pressures of the load no longer count."""
    grip, factor = 2e-3, 1e4
    closed = friction_loop(axial_friction(steep, rubs()), cycle(0.1, 5), grip)
    found = friction_loop(contact_section(steep, opens(friction=MU / factor)), cycle(0.1, 5), grip * factor)
    friction = closed.force - closed.strain @ closed.section.frictionless
    np.testing.assert_allclose(found.force, closed.force, atol=2e-3 * np.abs(friction).max())
    assert not found.is_open.any()


def test_high_friction_sticks_wherever_it_is_pressed(steep):
    """mu large under a first load: hardly anything slides where there is pressure; force between open and bonded."""
    section = contact_section(steep, opens(friction=20.0))
    found = friction_loop(section, np.array([[0.01, 0.0]]))
    pressed = found.pressure[1, 0] > 0.05 * found.pressure.max()
    assert 2 < pressed.sum() < len(pressed)
    slip = np.linalg.norm(found.slip[1, 0], axis=-1)
    assert slip[pressed].max() < 1e-3 * slip.max()
    assert section.open[0, 0] < found.slope(1) < section.bonded[0, 0]


def coaxial(core, tube):
    mesh = rings(RADII, core, tube, per_ring=3, around=24)
    return dataclasses.replace(mesh, regions=(mesh.regions[0], dataclasses.replace(mesh.regions[1], kind="sheath")))


def test_a_core_that_shrinks_in_its_tube_opens_at_the_strain_of_lame():
    """p_0 + k e = 0; friction does nothing in a coaxial section: bonded slope before, sum of E A behind, pressure by Lame."""
    exact = CoaxialCylinder(*(Material("m", *c, 1.0) for c in SHRINKS), *RADII)
    onset = 1e-3 / exact.stress(RADII[0])[0]
    section = contact_section(coaxial(*SHRINKS), opens(friction=MU))
    path = onset * np.array([[0.0, 0.0], [0.5, 0.0], [0.97, 0.1], [1.03, 0.1], [2.0, 0.0], [3.0, 0.0]])
    found = friction_loop(section, path, 1e-3)
    np.testing.assert_allclose(found.open_share, [0, 0, 0, 1, 1, 1], rtol=1e-12)
    w = section.surface
    assert found.pressure[1, 0] @ w / w.sum() == pytest.approx(0.5e-3, rel=2e-3)  # 24 edges
    areas = np.pi * np.array([RADII[0] ** 2, RADII[1] ** 2 - RADII[0] ** 2])
    assert found.slope(1) == pytest.approx(exact.EA(), rel=2e-5)  # area of 24 curved edges
    assert found.slope(5) == pytest.approx(areas @ [E for E, _ in SHRINKS], rel=2e-5)


def test_slip_starts_where_the_bonded_fields_leave_the_cone(steep, rubbing):
    """Under a grip p_0 the bonded section has traction t e and pressure p_0 + p e: first slip at min mu p_0 / (|t| - mu p)."""
    grip = 2e-3
    still = friction_loop(rubbing, np.array([[1e-6, 0.0]]), grip)
    t = np.linalg.norm(still.traction[1, 0], axis=-1) / 1e-6
    p = (still.pressure[1, 0] - grip) / 1e-6
    onset = float((MU * grip / np.maximum(t - MU * p, 1e-9)).min())
    found = friction_loop(rubbing, onset * np.array([[0.99, 0.0], [1.01, 0.0]]), grip)
    assert not found.sliding[1].any() and 0 < found.sliding[2].sum() <= 2


def test_pressure_closes_the_cone_step_by_step(rubbing):
    """|t| <= mu p with the pressure of the step, gap >= 0, pressure >= 0 and one of them zero; slip against the traction."""
    found = friction_loop(rubbing, cycle(0.01, 10))
    assert 0.1 < found.open_share[1:].max() < 0.95
    assert found.gap.min() >= 0.0 and found.pressure.min() >= 0.0
    assert (found.gap * found.pressure).max() < 1e-5 * found.gap.max() * found.pressure.max()
    np.testing.assert_allclose(found.cap[:, :, rubbing.rubs], MU * found.pressure[:, :, rubbing.rubs], atol=1e-12)
    length = np.linalg.norm(found.traction, axis=-1)
    assert (length - found.cap).max() < 1e-5 * found.cap.max()
    moved = np.diff(found.slip, axis=0)
    size = np.linalg.norm(moved, axis=-1)
    slid = (size > 1e-2 * size.max()) & (found.cap[1:] > 1e-2 * found.cap.max())
    along = (found.traction[1:] * moved).sum(axis=-1)[slid] / size[slid]
    np.testing.assert_allclose(along, -found.cap[1:][slid], rtol=1e-3)


def test_area_is_heat_and_never_negative(rubbing):
    """Dissipation grows; over a closed cycle it is the area, with an error that falls with the step."""
    error = []
    for steps in (5, 20):
        found = friction_loop(rubbing, cycle(0.01, steps))
        heat = found.dissipation[-1] - found.dissipation[steps]
        assert heat > 0 and (np.diff(found.dissipation) >= 0).all()
        error.append(abs(found.work(steps) / heat - 1))
    assert error[1] < 1e-2 and error[1] < 0.5 * error[0]


def test_loops_scale_with_the_load(rubbing):
    """No grip, no gap: twice the strain is twice the force, at any friction."""
    one, two = (friction_loop(rubbing, k * PATH) for k in (1.0, 2.0))
    np.testing.assert_allclose(two.force, 2 * one.force, atol=1e-6 * np.abs(two.force).max())


def test_given_forces_return_the_given_strains(rubbing):
    """Tension and torque of a strain path, prescribed: the same strains come back; so for one strain and one force."""
    given = friction_loop(rubbing, cycle(0.01, 5))
    for drives in (("N", "M_z"), ("N", "twist"), ("stretch", "M_z")):
        forced = [name in rubbing.forces for name in drives]
        found = friction_loop(rubbing, np.where(forced, given.force, given.strain), drives=drives)
        np.testing.assert_allclose(found.strain, given.strain, atol=1e-6 * 0.01)
        np.testing.assert_allclose(found.force, given.force, atol=1e-6 * np.abs(given.force).max())


@pytest.fixture(scope="module")
def bent(slack):
    return contact_section(slack, opens(), harmonics=3)


def test_bending_under_a_grip_never_opens_and_is_the_sliding_section(slack, bent):
    """M = EI kappa with EI of the section that slides closed, from the condensation in odd harmonics."""
    found = friction_loop(bent, np.array([[0, 0, 0.02, 0], [0, 0, 0, 0.02]]), 10.0)
    EI = bending_friction(slack, rubs(), 2).frictionless[0, 0]
    np.testing.assert_allclose(found.force[1:, 2:], 0.02 * EI * np.eye(2), rtol=1e-6, atol=1e-9)
    assert not found.is_open.any()


def test_bending_without_grip_lies_between_open_and_sliding(bent):
    """A wire that just fits opens on one side: open EI < M / kappa < closed EI, the same about any axis, no heat."""
    path = 0.02 * np.array([[0, 0, 1, 0], [0, 0, 0.6, 0.8], [0, 0, 2, 0]])
    found = friction_loop(bent, path)
    moment = np.hypot(*found.force[1:, 2:].T) / np.hypot(*path[:, 2:].T)
    assert bent.open[2, 2] < moment[0] < bent.frictionless[2, 2]
    np.testing.assert_allclose(moment, moment[0], rtol=1e-5)  # seven stations
    assert 0.2 < found.open_share[1] < 0.8 and found.dissipation[-1] == 0.0


def test_bending_far_below_the_friction_is_bonded(slack):
    """Grip and friction: first slope bonded, area = heat, and with mu p of one product the loop of the closed interface."""
    section = contact_section(slack, opens(friction=MU), harmonics=2)
    still = friction_loop(section, cycle(0.004, 2, 4, 2), 0.1)
    np.testing.assert_allclose(still.force[:, 2], still.strain[:, 2] * section.bonded[2, 2], rtol=1e-6, atol=1e-9)
    kappa, grip, factor = 0.004, 1e-3, 1e3
    loop = friction_loop(contact_section(slack, opens(friction=MU / factor), 3), cycle(kappa, 5, 4, 2), grip * factor)
    closed = friction_loop(bending_friction(slack, rubs(), 3), cycle(kappa, 5), grip)
    friction = np.abs(closed.force[:, 0] - closed.strain[:, 0] * closed.section.frictionless[0, 0]).max()
    # 7 stations of a pitch against 12: an error of order K^-2
    np.testing.assert_allclose(loop.force[:, 2], closed.force[:, 0], atol=0.05 * friction)
    heat = loop.dissipation[-1] - loop.dissipation[5]
    assert heat == pytest.approx(closed.dissipation[-1] - closed.dissipation[5], rel=0.05)


def test_what_does_not_settle_says_where(rubbing, monkeypatch):
    monkeypatch.setattr(contact_step, "MOST_ITERATIONS", 5)
    with pytest.raises(
        ConvergenceError, match=r"step 1 of 6, worst between wire conductor and filler: .* out of balance by"
    ):
        friction_loop(rubbing, PATH)


def test_what_cannot_be_is_refused(steep, slack, rubbing):
    with pytest.raises(SpecError, match="no interface can open"):
        contact_section(steep, Interfaces({PAIR: Frictionless()}))
    with pytest.raises(SpecError, match="needs a lay"):
        contact_section(wire_in_rod(straight=True), opens(), 1)
    with pytest.raises(SpecError, match="zero or positive"):
        Unilateral(0.0, -0.1)
    with pytest.raises(SpecError, match="history of the load"):
        opening_section(steep, opens(friction=MU))
    with pytest.raises(SpecError, match="stretch or N, twist or M_z"):
        friction_loop(rubbing, PATH, drives=("N", "M_x"))
    with pytest.raises(SpecError, match="driven alike"):
        friction_loop(contact_section(slack, opens(), 1), np.zeros((1, 4)), drives=("N", "M_z", "M_x", "kappa_y"))
    with pytest.raises(SpecError, match="not in equilibrium"):
        straight = contact_section(wire_in_rod(straight=True), opens())
        friction_loop(straight, np.zeros((1, 2)), np.where(straight.position[0] > 3.0, 1e-3, 0.0))

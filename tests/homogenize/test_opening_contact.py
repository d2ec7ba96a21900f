"""Contact that can open: no tension and no shear across it; gap >= 0, pressure >= 0, their product 0; piecewise linear answers."""

import dataclasses

import numpy as np
import pytest
from section_meshes import rings
from wire_in_rod import wire_in_rod

from geometry.errors import SpecError
from geometry.material import Material
from homogenize import solve_helical_cell
from homogenize.coaxial_cylinder import CoaxialCylinder
from homogenize.coulomb_interface import Coulomb
from homogenize.interface_choice import Interfaces
from homogenize.opening_contact import Unilateral, opening_path, opening_section
from homogenize.rubbing_section import axial_friction
from homogenize.sliding_interface import Frictionless

OPENS = Interfaces({"conductor-insulation": Unilateral()})
RADII = (0.5, 1.0)
STIFF, SOFT = 2.0, 1.0
SHRINKS = ((STIFF, 0.45), (SOFT, 0.1))
"""A core that shrinks away from its tube under tension."""
GRIPPED = ((STIFF, 0.1), (SOFT, 0.45))
"""A core that the tube grips under tension."""
ALONE = np.pi * (RADII[0] ** 2 * STIFF + (RADII[1] ** 2 - RADII[0] ** 2) * SOFT)
"""Sum of E A."""
MESH_AREA = 2e-5
"""24 quadratic edges leave 1e-5 of a circle's area out."""


def coaxial(core, tube, twist_rate=0.0, finer=1):
    mesh = rings(RADII, core, tube, per_ring=3 * finer, around=24 * finer, twist_rate=twist_rate)
    inner, outer = mesh.regions
    return dataclasses.replace(
        mesh, regions=(dataclasses.replace(inner, name="core"), dataclasses.replace(outer, kind="sheath"))
    )


def lame(core: tuple[float, float], tube: tuple[float, float]) -> tuple[float, float]:
    """EA [N] and the pressure at the interface per stretch [Pa] of the bonded cylinder; it has no shear there."""
    exact = CoaxialCylinder(Material("core", *core, 1.0), Material("tube", *tube, 1.0), *RADII)
    return exact.EA(), -exact.stress(RADII[0])[0]


def stretches(*values):
    return np.array([[value, 0.0] for value in values])


@pytest.fixture(scope="module")
def wire():
    """Off the axis, steep lay: it opens on a part of its circumference only."""
    return opening_section(wire_in_rod(beta=np.radians(30.0)), OPENS)


WIRE_PATH = np.array([[0.01, 0.0], [-0.01, 0.0], [0.0, 0.1], [0.0, -0.1], [0.01, 0.03], [-0.02, 0.05]])


@pytest.fixture(scope="module")
def answer(wire):
    return opening_path(wire, WIRE_PATH)


@pytest.mark.parametrize("twist_rate", [0.0, 0.7])
def test_a_core_that_shrinks_away_opens_at_once(twist_rate):
    """nu of the core above that of the tube: tension N = (sum E A) eps with the gap (nu_1 - nu_2) a eps; compression keeps it closed."""
    found = opening_path(opening_section(coaxial(*SHRINKS, twist_rate), OPENS), stretches(1e-6, 0.01, -0.01))
    np.testing.assert_allclose(found.force[:2, 0], ALONE * np.array([1e-6, 0.01]), rtol=MESH_AREA)
    np.testing.assert_allclose(found.gap[1], (0.45 - 0.1) * RADII[0] * 0.01, rtol=1e-6)
    np.testing.assert_array_equal(found.open_share, [1.0, 1.0, 0.0])
    assert found.force[2, 0] == pytest.approx(-0.01 * lame(*SHRINKS)[0], rel=MESH_AREA)


@pytest.mark.parametrize("twist_rate", [0.0, 0.7])
def test_a_core_that_is_gripped_stays_closed(twist_rate):
    """nu of the core below that of the tube: EA and the pressure are Lame's of the bonded cylinder; the torque is that of two shafts."""
    EA, pressure = lame(*GRIPPED)
    path = np.array([[0.01, 0.0], [0.01, 0.2], [0.0, 0.2]])
    found = opening_path(opening_section(coaxial(*GRIPPED, twist_rate), OPENS), path)
    np.testing.assert_allclose(found.force[:2, 0], 0.01 * EA, rtol=MESH_AREA)
    assert found.open_share[0] == 0.0
    np.testing.assert_allclose(found.pressure[0], 0.01 * pressure, rtol=3e-2)  # corners and middles of the edges differ
    w = found.section.surface
    assert found.pressure[0] @ w / w.sum() == pytest.approx(0.01 * pressure, rel=2e-3)  # 24 edges; converges, below
    G = [E / (2 * (1 + nu)) for E, nu in GRIPPED]
    polar = np.pi / 2 * np.array([RADII[0] ** 4, RADII[1] ** 4 - RADII[0] ** 4])
    assert found.force[2, 1] == pytest.approx(0.2 * float(polar @ G), rel=2 * MESH_AREA)


def test_a_grip_opens_at_the_strain_that_lame_predicts():
    """p_0 + k eps = 0: slope EA of the bonded cylinder below that strain, sum of E A above it."""
    EA, per_strain = lame(*SHRINKS)
    grip = 1e-3
    onset = grip / -per_strain
    error = []
    for finer in (1, 2):
        section = opening_section(coaxial(*SHRINKS, finer=finer), OPENS)
        far = 4 * onset
        drop = section.open[0, 0] * far - opening_path(section, stretches(far), grip).force[0, 0]
        error.append(abs(drop / (section.open - section.closed)[0, 0] / onset - 1))  # where the two branches cross
    assert error[1] < 1e-4 and error[0] / error[1] > 4  # pressure lumped at the nodes of curved edges
    path = stretches(*(onset * np.array([0.0, 0.5, 0.97, 1.03, 2.0, 4.0])))
    found = opening_path(section, path, grip)
    np.testing.assert_array_equal(found.open_share, [0, 0, 0, 1, 1, 1])
    assert found.slope(1) == pytest.approx(EA, rel=MESH_AREA)
    assert found.slope(5) == pytest.approx(ALONE, rel=MESH_AREA)
    np.testing.assert_allclose(found.pressure[0], grip, rtol=1e-12)
    np.testing.assert_allclose(found.gap[:3], 0.0, atol=1e-18)


def test_a_clearance_closes_at_the_strain_of_the_two_contractions():
    """The gap is used up at g_0 / (a (nu_2 - nu_1)); before that the parts know nothing of each other."""
    clearance = 1e-3
    onset = clearance / (RADII[0] * (0.45 - 0.1))
    section = opening_section(coaxial(*GRIPPED), Interfaces({"conductor-insulation": Unilateral(clearance)}))
    found = opening_path(section, stretches(*(onset * np.array([0.0, 0.5, 0.999, 1.001, 2.0, 3.0]))))
    np.testing.assert_array_equal(found.open_share, [1, 1, 1, 0, 0, 0])
    assert found.slope(1) == pytest.approx(ALONE, rel=MESH_AREA)
    assert found.slope(5) == pytest.approx(lame(*GRIPPED)[0], rel=MESH_AREA)


def test_interference_is_a_shrink_fit():
    """delta / a = p [(1 + nu1)(1 - 2 nu1)/E1 + (1 + nu2)((1 - 2 nu2) a^2 + b^2)/(E2 (b^2 - a^2))], plane strain; Lame."""
    delta, (a, b) = 1e-3, RADII
    (E1, n1), (E2, n2) = SHRINKS
    flexibility = (1 + n1) * (1 - 2 * n1) / E1
    flexibility += (1 + n2) * ((1 - 2 * n2) * a**2 + b**2) / (E2 * (b**2 - a**2))
    section = opening_section(coaxial(*SHRINKS), Interfaces({"conductor-insulation": Unilateral(-delta)}))
    found = opening_path(section, stretches(0.0))
    w = section.surface
    assert found.pressure[0] @ w / w.sum() == pytest.approx(delta / (a * flexibility), rel=1e-3)
    assert found.energy[0] == pytest.approx(0.5 * delta * found.pressure[0] @ w, rel=1e-9)


def test_complementarity(wire, answer):
    """Gaps and pressures are not negative, never both there, and the pressure is the force A e + S s of the condensed section."""
    share = answer.open_share
    assert ((share > 0.1) & (share < 0.9)).all()
    assert answer.gap.min() >= 0 and answer.pressure.min() >= 0
    assert not ((answer.gap > 0) & (answer.pressure > 0)).any()
    force = WIRE_PATH @ wire.harmonic.A.T + answer.gap @ wire.harmonic.S
    np.testing.assert_allclose(answer.pressure * wire.surface, force, atol=1e-11 * np.abs(force).max())


def test_no_other_state_has_less_energy(wire, answer):
    """The convex minimum: random admissible gaps near the answer store more."""
    rng = np.random.default_rng(1)
    for i, e in enumerate(WIRE_PATH):
        load, base = wire.harmonic.A @ e, 0.5 * e @ wire.closed @ e
        for _ in range(20):
            g = np.maximum(answer.gap[i] + rng.normal(scale=0.1 * answer.gap[i].max(), size=answer.gap.shape[1]), 0.0)
            assert base + g @ load + 0.5 * g @ wire.harmonic.S @ g > answer.energy[i]


def test_homogeneous_of_degree_one(wire, answer):
    """Parts that just touch: twice the strain, twice the force and the gap, the same contact; half the force is the energy."""
    double = opening_path(wire, 2 * WIRE_PATH)
    np.testing.assert_allclose(double.force, 2 * answer.force, rtol=1e-9)
    np.testing.assert_array_equal(double.is_open, answer.is_open)
    np.testing.assert_allclose(answer.energy, 0.5 * (answer.force * WIRE_PATH).sum(axis=1), rtol=1e-9)


def test_unlaying_and_tightening_differ(answer):
    """The wire sits elsewhere in its hole under either hand of the twist."""
    unlay, tighten = answer.energy[3], answer.energy[2]
    assert abs(tighten / unlay - 1) > 1e-3
    assert np.abs(answer.is_open[2].astype(int) - answer.is_open[3]).sum() > 2


def test_mirror_image():
    """Left lay under the opposite twist: the same tension, the opposite torque."""
    other = dataclasses.replace(wire_in_rod(beta=np.radians(-30.0)))
    right = opening_path(opening_section(wire_in_rod(beta=np.radians(30.0)), OPENS), WIRE_PATH).force
    left = opening_path(opening_section(other, OPENS), WIRE_PATH * [1, -1]).force
    np.testing.assert_allclose(left, right * [1, -1], rtol=1e-8)


def test_between_open_and_bonded(wire, answer):
    """Energy: everything open <= contact <= closed without friction <= bonded, in every direction."""
    keep = np.ix_([2, 5], [2, 5])
    bonded = np.linalg.inv(solve_helical_cell(wire.mesh).stiffness.compliance[keep])
    frictionless = np.linalg.inv(solve_helical_cell(wire.mesh, "frictionless").stiffness.compliance[keep])
    np.testing.assert_allclose(wire.closed, frictionless, rtol=1e-8)
    energies = [0.5 * np.einsum("np,pq,nq->n", WIRE_PATH, C, WIRE_PATH) for C in (wire.open, wire.closed, bonded)]
    assert (energies[0] > 0).all() and (energies[0] < answer.energy).all()
    assert (answer.energy < energies[1]).all() and (energies[1] <= energies[2]).all()


def test_forces_are_the_slope_of_the_energy(wire):
    """dW/de = F, by central differences of a gripped path that opens gradually."""
    path = np.array([[e, 0.4 * e] for e in np.linspace(-0.01, 0.01, 41)])
    found = opening_path(wire, path, 2e-3)
    work = ((found.force[1:] + found.force[:-1]) / 2 * np.diff(path, axis=0)).sum(axis=1)
    assert 0 < found.open_share.max() < 1 and found.open_share[20] == 0
    # the trapezoid is exact but in steps in which a node changes
    np.testing.assert_allclose(np.diff(found.energy), work, atol=2e-4 * found.energy.max())
    unchanged = (found.is_open[1:] == found.is_open[:-1]).all(axis=1)
    assert unchanged.any()
    np.testing.assert_allclose(np.diff(found.energy)[unchanged], work[unchanged], rtol=1e-9)


def test_free_twist_is_the_twist_of_no_torque(wire):
    """The stretch alone gives the tension of the pair (stretch, twist) whose torque vanishes."""
    free = opening_section(wire.mesh, OPENS, free_twist=True)
    tension = opening_path(free, np.array([[0.01]])).force[0, 0]
    twist = np.linspace(-0.01, 0.01, 3)
    for _ in range(40):  # bisection: the torque grows with the twist
        twist[1] = 0.5 * (twist[0] + twist[2])
        twist[0 if opening_path(wire, np.array([[0.01, twist[1]]])).force[0, 1] < 0 else 2] = twist[1]
    assert opening_path(wire, np.array([[0.01, twist[1]]])).force[0, 0] == pytest.approx(tension, rel=1e-6)


def test_parts_that_can_fly_away_are_named():
    """An open straight core can be anywhere in its hole; it is put in the middle. A closed one is held across."""
    section = opening_section(coaxial(*SHRINKS), OPENS)
    assert section.closed_motions == ("core slides along the cable", "core turns about the cable axis")
    found = opening_path(section, stretches(0.01, -0.01, 0.0))
    assert found.loose == (("core moves across the cable",), (), ())
    assert np.ptp(found.gap[0]) < 1e-9 * found.gap[0].max()


def test_only_the_interface_that_is_named_opens():
    """Two interfaces, one frictionless: the tube that shrinks away from the wire sheath opens, the other one holds tension."""
    mesh = rings((0.3, 0.6, 1.0), (1.0, 0.45), (1.0, 0.1), (1.0, 0.1), per_ring=2, around=24)
    kinds = ("conductor", "insulation", "sheath")
    mesh = dataclasses.replace(
        mesh, regions=tuple(dataclasses.replace(r, name=k, kind=k) for r, k in zip(mesh.regions, kinds, strict=True))
    )
    both = Interfaces({"conductor-insulation": Frictionless(), "insulation-sheath": Unilateral()})
    found = opening_path(opening_section(mesh, both), stretches(0.01, -0.01))
    assert set(found.section.parts) <= {("insulation", "sheath"), ("sheath", "insulation")}
    assert sorted(found.open_share) == [0.0, 1.0]


def test_what_cannot_open_is_refused(wire):
    mesh = wire.mesh
    with pytest.raises(SpecError, match="no interface can open"):
        opening_section(mesh, Interfaces({"conductor-insulation": Frictionless()}))
    with pytest.raises(SpecError, match="finite length"):
        Unilateral(float("nan"))
    with pytest.raises(SpecError, match="load path"):
        opening_path(wire, np.zeros((3, 1)))
    with pytest.raises(SpecError, match="grip must be"):
        opening_path(wire, np.zeros((3, 2)), -1.0)
    with pytest.raises(SpecError, match="can open, its stiffness depends on the load"):
        solve_helical_cell(mesh, OPENS)
    with pytest.raises(SpecError, match="no interface rubs"):
        axial_friction(mesh, OPENS)
    three = rings((0.3, 0.6, 1.0), (1.0, 0.45), (1.0, 0.1), (1.0, 0.1), per_ring=1, around=12)
    kinds = ("conductor", "insulation", "sheath")
    three = dataclasses.replace(
        three, regions=tuple(dataclasses.replace(r, name=k, kind=k) for r, k in zip(three.regions, kinds, strict=True))
    )
    rubs = Interfaces({"conductor-insulation": Coulomb(0.3), "insulation-sheath": Unilateral()})
    for call in (opening_section, axial_friction):
        with pytest.raises(SpecError, match=r"friction beside|can open"):
            call(three, rubs)


def test_a_grip_that_pushes_a_part_out_is_refused():
    """On one half of a straight core only, a pressure is not in equilibrium."""
    section = opening_section(coaxial(*SHRINKS), OPENS)
    with pytest.raises(SpecError, match="core moves across the cable"):
        opening_path(section, stretches(0.0), np.where(section.position[0] > 0, 1e-3, 0.0))

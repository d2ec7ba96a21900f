"""A specimen whose parts open and rub: limits, Lame's shrink fit, a core that leaves its hole, friction takes energy."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import nnls
from section_meshes import rings

from geometry.errors import ConvergenceError, SpecError
from homogenize.interface_choice import Interfaces
from homogenize.sliding_interface import Frictionless
from homogenize.specimen import AxialGrading, Held, LoadCase, Plate, Specimen, solve_specimen
from homogenize.specimen.axial_basis import AxialBasis
from homogenize.specimen.contact_condensation import contact_specimen, imbalance
from homogenize.specimen.frictional_contact import ContactConstants, FrictionalContact, at_rest, contact_law
from homogenize.specimen.opening_specimen import contact_path, even_and_odd, initial_state

NAME = "part 0-part 1"
RADII = (0.006, 0.012)
LENGTH = 0.05
GRADING = AxialGrading(end_size=0.15, largest=1.0, growth=2.0, degree=2)
LOADS = [LoadCase("tension", 20.0), LoadCase("shear", 1.0)]


def specimen(interface):
    return Specimen(LENGTH, interface=interface, grading=GRADING)


def section(inner=(60e6, 0.3), outer=(4e6, 0.45), lay: float | None = 0.2):
    return rings(RADII, inner, outer, around=8, per_ring=1, twist_rate=2 * np.pi / lay if lay else 0.0)


def contact(mesh, **law):
    return contact_specimen(specimen(Interfaces({NAME: FrictionalContact(**law)})), mesh, LOADS)


def with_law(condensed, friction, grip=0.0, gap: float | np.ndarray = 0.0):
    """The same condensed specimen with other constants."""
    one = np.ones(len(condensed.area))
    c = condensed.constants
    return replace(condensed, constants=ContactConstants(friction * one, grip * one, gap * one, c.normal, c.tangential))


@pytest.fixture(scope="module")
def condensed():
    """Rubber around a stiff core, hard interface."""
    return contact(section(), friction=0.3, normal=1e12, tangential=1e12)


def mean_end(condensed, step):
    return condensed.face_weight @ step.face / condensed.face_weight.sum()


def test_pressed_and_rough_is_bonded(condensed):
    """Grip and friction beyond any load. rtol 2e-3: the interface yields by 1e-12 m/Pa."""
    bonded = solve_specimen(specimen("bonded"), condensed.mesh, LOADS, tolerance=1e-7)
    held = with_law(condensed, 10.0, 1e9)
    for k, axis in ((0, 2), (1, 0)):
        found = mean_end(condensed, contact_path(held, k, [1.0])[-1])[axis]
        weight = bonded.F[:, -1, k] / abs(LOADS[k].size)
        assert found == pytest.approx(weight @ bonded.U[:, -1, k], rel=2e-3)


def test_pressed_and_smooth_slides_without_opening(condensed):
    """Grip beyond any load, no friction: the sliding interface of the linear specimen."""
    free = solve_specimen(specimen(Interfaces({NAME: Frictionless()})), condensed.mesh, LOADS, tolerance=1e-7)
    smooth = with_law(condensed, 0.0, 1e9)
    for k, axis in ((0, 2), (1, 0)):
        step = contact_path(smooth, k, [1.0])[-1]
        assert step.open_share(condensed.area) == 0.0
        nodal = step.face[:, axis]
        np.testing.assert_allclose(nodal, free.displacement[:, axis, -1, k], atol=5e-3 * np.abs(nodal).max())


def test_a_shrink_fit_has_the_pressure_of_lame():
    """nu = 0: p = d / (b / E_o (c^2 + b^2) / (c^2 - b^2) + b / E_i + 1 / k_n) away from the held end. rtol 2 %: one element across."""
    E_i, E_o, d = 20e6, 5e6, 2e-5
    shrunk = contact(section((E_i, 0.0), (E_o, 0.0), lay=None), friction=0.0, gap=-d)
    step = initial_state(shrunk)
    b, c = RADII
    lame = d / (b / E_o * (c**2 + b**2) / (c**2 - b**2) + b / E_i + 1 / 1e11)
    free = shrunk.place[:, 2] > 0.5 * LENGTH
    weight = shrunk.area[free]
    assert weight @ step.state.pressure[free] / weight.sum() == pytest.approx(lame, rel=2e-2)


def test_a_core_that_contracts_leaves_its_hole():
    """Equal stress on both, Poisson's ratio of the core only: the gap is nu s b / E far from the held end, nowhere a pressure."""
    E, nu = 20e6, 0.4
    loose = contact(section((E, nu), (E, 0.0), lay=None), friction=0.3)
    step = contact_path(loose, 0, [0.5, 1.0])[-1]
    stress = 20.0 / (np.pi * RADII[1] ** 2)
    free = loose.place[:, 2] > 0.6 * LENGTH
    np.testing.assert_allclose(
        step.state.jump[free, 0], nu * stress / E * RADII[0], rtol=3e-2
    )  # area of the polygon of the sheath
    assert step.open_share(loose.area) == 1.0


@pytest.fixture(scope="module")
def loop(condensed):
    """Shear there and back twice, under a grip that lets a part of the interface slip."""
    rubbing = with_law(condensed, 0.3, 1e4)
    there = np.linspace(0, 1, 7)[1:]
    shares = [*there, *(1 - 2 * there), *(-1 + 2 * there)]
    return shares, contact_path(rubbing, 1, shares)


def test_friction_only_takes_energy(loop):
    """Dissipation never falls, and is above zero."""
    lost = np.array([step.dissipated for step in loop[1]])
    assert (np.diff(lost) >= -1e-12 * lost[-1]).all()
    assert lost[-1] > 0


def test_the_area_of_a_loop_is_the_heat(loop, condensed):
    """Work of the load around the loop against friction's. rtol 6 %: work by trapezoids over six steps a side."""
    shares, steps = loop
    u = np.array([mean_end(condensed, step)[0] for step in steps])[5:]
    force = np.array(shares)[5:] * LOADS[1].size
    work = np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(u))
    assert work == pytest.approx(steps[-1].dissipated - steps[5].dissipated, rel=6e-2)
    assert abs(u[0] - u[-1]) < 2e-2 * np.ptp(u)  # closed


def test_an_interference_that_holds_adds_the_same_to_both_directions(condensed):
    """Nothing opens or slips: u(+F) + u(-F) is twice the initial displacement, everywhere."""
    rough = with_law(condensed, 10.0, 1e9, np.where(condensed.place[:, 0] > 0, -1e-5, 0.0))
    start = initial_state(rough)
    plus, minus = (contact_path(rough, 1, [s], start)[-1].face for s in (1.0, -1.0))
    assert np.abs(start.face).max() > 1e-6
    np.testing.assert_allclose(plus + minus, 2 * start.face, atol=1e-9 * np.abs(plus).max())


def test_without_an_initial_state_a_straight_symmetric_specimen_has_no_even_part():
    """A half turn about the axis swaps +F and -F."""
    plain = contact(section(lay=None), friction=0.3)
    plus, minus = (mean_end(plain, contact_path(plain, 1, [s])[-1])[0] for s in (1.0, -1.0))
    even, odd = even_and_odd(plus, minus)
    assert abs(even) < 1e-6 * odd


def test_the_law_returns_to_the_cone():
    """Shear never above mu p, against the slip's direction; open points carry nothing; the derivative is that of the force."""
    rng = np.random.default_rng(3)
    p = 200
    one = np.ones(p)
    constants = ContactConstants(0.4 * one, 2e3 * one, 0 * one, 1e9 * one, 5e8 * one)
    jump = 1e-5 * rng.normal(size=(p, 3))
    old = at_rest(constants)
    state, force, tangent = contact_law(jump, old, constants)
    assert (np.linalg.norm(state.shear, axis=1) <= 0.4 * state.pressure * (1 + 1e-12)).all()
    assert not state.shear[state.open()].any()
    h = 1e-12
    for i in range(3):
        moved = jump + h * np.eye(3)[i]
        slope = (contact_law(moved, old, constants)[1] - force) / h
        np.testing.assert_allclose(slope, tangent[:, :, i], atol=1e-3 * 1e9)


def test_what_is_not_a_contact_is_refused():
    """Another law, another end, constants that cannot be."""
    with pytest.raises(SpecError, match="FrictionalContact"):
        contact_specimen(specimen(Interfaces({NAME: Frictionless()})), section(), LOADS)
    with pytest.raises(SpecError, match="gripped"):
        FrictionalContact(0.3, grip=1e5, gap=1e-5)
    with pytest.raises(SpecError, match="positive"):
        FrictionalContact(-0.1)
    with pytest.raises(SpecError, match="at least one load"):
        contact_specimen(specimen(Interfaces({NAME: FrictionalContact(0.3)})), section(), [])


def test_forces_balance_whatever_opens(condensed):
    """Reactions against the load, open or not; the imbalance is that of the layers, below the limit of the linear specimen."""
    for k in (0, 1):
        step = contact_path(condensed, k, [1.0])[-1]
        assert step.open_share(condensed.area) > 0.05
        assert imbalance(step.resultants, LENGTH) < 1e-2
        np.testing.assert_allclose(step.resultants[6:9], LOADS[k].size * LOADS[k].direction, atol=1e-9 * LOADS[k].size)


class ThickLayers:
    """One quadratic layer as long as the specimen: a grading of its own, which the lay does not thin."""

    def basis(self, length, diameter):
        return AxialBasis(np.array([0.0, length]), 2)


def test_layers_too_thick_for_the_lay_are_refused():
    """How much is missing, why, and what to try."""
    thick = replace(specimen(Interfaces({NAME: FrictionalContact(0.3)})), grading=ThickLayers())
    with pytest.raises(ConvergenceError, match=r"out of balance by .* turns by 1.6 rad.*take layers of .* or degree 3"):
        contact_specimen(thick, section(), LOADS)


@pytest.mark.parametrize(
    "ends", [{"loaded": Plate(twist=False)}, {"held": Held(("part 0", "part 1"))}], ids=["plate", "held parts"]
)
def test_pressed_and_rough_is_bonded_at_other_ends(ends):
    """A plate that meets reactions; an end held by the names of its parts. rtol 2e-3: the interface yields by 1e-12 m/Pa."""
    law = FrictionalContact(10.0, grip=1e9, normal=1e12, tangential=1e12)
    held = contact_specimen(replace(specimen(Interfaces({NAME: law})), **ends), section(), LOADS)
    bonded = solve_specimen(replace(specimen("bonded"), **ends), section(), LOADS, tolerance=1e-7)
    for k, axis in ((0, 2), (1, 0)):
        weight = bonded.F[:, -1, k] / abs(LOADS[k].size)
        found = mean_end(held, contact_path(held, k, [1.0])[-1])[axis]
        assert found == pytest.approx(weight @ bonded.U[:, -1, k], rel=2e-3)


def test_a_body_that_nothing_holds_is_refused():
    """Only the core is held, and it may leave its hole."""
    loose = replace(specimen(Interfaces({NAME: FrictionalContact(0.3)})), held=Held(("part 0",)))
    with pytest.raises(SpecError, match="part 1 is held by nothing"):
        contact_specimen(loose, section(), LOADS)


def test_smooth_contact_that_opens_has_the_forces_of_least_energy(condensed):
    """No grip, no friction: pressures p a >= 0 that minimise p.G p / 2 + p.g_f, G = F + 1 / k a, g_f the opening of bodies without contact.

    Found apart by non-negative least squares on the Cholesky factor of G. rtol 1e-5 of the largest: 1e-7 of a jump, hard springs.
    """
    springs = condensed.springs()
    give = condensed.flexibility[::3, ::3] + np.diag(1 / springs[::3])
    held = condensed.jump[:, 1]
    apart = (held + condensed.flexibility @ (springs * held))[::3]
    factor = np.linalg.cholesky(give)
    forces, _ = nnls(factor.T, -np.linalg.solve(factor, apart), maxiter=10000)
    step = contact_path(with_law(condensed, 0.0), 1, [1.0])[-1]
    found = step.state.pressure * condensed.area
    assert 0.3 < (forces == 0).mean() < 0.7
    np.testing.assert_allclose(found, forces, atol=1e-5 * forces.max())


@pytest.fixture(scope="module")
def rough(condensed):
    """No grip, friction 1, across: half the points open and most others slip."""
    law = with_law(condensed, 1.0)
    return law, contact_path(law, 1, [1.0])[-1]


def test_rough_contact_that_opens_settles(rough):
    """Jumps are those of the bodies apart under the forces; shear within the cone, and against the slip where it is at its edge.

    atol 1e-6 of the largest jump: 1e-7 of a holding one, which are a hundred times smaller, by forces on far softer bodies.
    """
    law, step = rough
    state, springs, held = step.state, law.springs(), law.jump[:, 1]
    forces = law.area[:, None] * np.column_stack([-state.pressure, state.shear])
    jump = held + law.flexibility @ (springs * held - forces.ravel())
    np.testing.assert_allclose(state.jump.ravel(), jump, atol=1e-6 * np.abs(jump).max())
    assert 0.3 < step.open_share(law.area) < 0.7
    size = np.linalg.norm(state.shear, axis=1)
    slips = ~state.open() & (size > (1 - 1e-9) * state.pressure)
    assert (size <= state.pressure * (1 + 1e-9)).all() and not size[state.open()].any()
    assert slips.sum() > 0.5 * (~state.open()).sum()
    along = (state.shear * state.jump[:, 1:]).sum(axis=1)[slips]
    np.testing.assert_allclose(along, size[slips] * np.linalg.norm(state.jump[slips, 1:], axis=1), rtol=1e-9)


def test_without_grip_or_gap_displacements_are_proportional_to_the_load(rough):
    """Contact and Coulomb's law know no length and no stress: thirty times the load opens the same points. rtol 1e-5: 1e-7 of a jump."""
    law, step = rough
    larger = contact_path(law, 1, [30.0])[-1]
    np.testing.assert_allclose(larger.face, 30 * step.face, atol=1e-5 * np.abs(larger.face).max())
    assert (larger.state.open() == step.state.open()).all()

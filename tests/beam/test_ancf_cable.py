"""The ANCF cable: rigid motions, exact cases at rest and in motion, friction, and the rod with a stiff shear beside it."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from beam import read_scenario, tow
from beam.ancf_cable import AncfCable
from beam.benchmark_ancf_cable import ancf_cable_cases, cantilever, half_circle, limp_section
from beam.benchmark_dynamics import advanced, axial_wave, pendulum, swing
from beam.benchmark_friction import capstan, stick_slip
from beam.benchmark_statics import catenary
from beam.motion import Turn
from beam.rod import Rod
from beam.rod_model import Blocks, RodModel, Support
from beam.section_law import DampingTimes
from beam.shape import straight, strands_and_arcs
from beam.statics import equilibrium
from geometry.errors import SpecError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

INERTIA = SectionInertia(1.0, 1e-3, 1e-3, 2e-3)


def bent_in_space(damping: DampingTimes | None = None) -> tuple[RodModel, np.ndarray]:
    """A cable of unequal elements, stretched and bent out of the plane."""
    cable = AncfCable.build(np.array([0.3, 0.5, 0.4]), limp_section(2.0, 1e3, 1e3), INERTIA, damping)
    q = strands_and_arcs(cable.s, [(1.2, 1.5)])
    q[:, :6] += 0.05 * np.random.default_rng(3).normal(size=(4, 6))
    return RodModel(cable, q), q[:, :6].copy()


def force(model: RodModel, q: np.ndarray, v: np.ndarray | None = None) -> np.ndarray:
    return model.forces(0.0, q, np.zeros_like(q) if v is None else v, []).F


@pytest.mark.parametrize("case", ancf_cable_cases(), ids=str)
def test_exact_arc_elastica_and_another_code(case):
    """Orders near 4, no parasitic tension; pendulum of Exudyn's cable up to 0.6 s, the whipping one to 6e-4 m (n 32 against 64)."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]


@pytest.mark.parametrize(
    "case", [catenary, axial_wave, stick_slip, *(lambda kind, b=b: capstan(0.3, b, kind) for b in (np.pi, np.pi / 2))]
)
def test_cases_of_the_rod(case):
    """Catenary, speed of an axial wave, stick-slip on a floor, capstan of a half and a quarter turn: same tolerances."""
    assert not [b.sentence() for b in case(kind=AncfCable) if not b.passed]


@pytest.mark.parametrize("vector", [(0.4, -1.1, 0.7), (0.0, 3.0, 0.0), (6.0, 5.0, -4.0)])
def test_rigid_motion_strains_nothing(vector):
    """Bent or not, the internal force turns with the cable and strains stay, to round-off (the rod: to 1e-4)."""
    model, q = bent_in_space()
    turn = Rotation.from_rotvec(vector)
    moved = np.hstack([turn.apply(q[:, :3]) + np.array([1.0, -2.0, 0.5]), turn.apply(q[:, 3:])])
    F = force(model, q)
    expected = np.hstack([turn.apply(F[:, :3]), turn.apply(F[:, 3:])])
    assert np.abs(F).max() > 1.0
    np.testing.assert_allclose(force(model, moved), expected, rtol=0, atol=1e-11 * np.abs(F).max())
    flat = straight(model.rod.s)[:, :6]
    gone = np.hstack([turn.apply(flat[:, :3]), turn.apply(flat[:, 3:])])
    assert np.abs(force(model, gone)).max() < 1e-11


def test_a_stretched_cable_passes_the_patch_test():
    """Unequal elements under a pull: N everywhere, the exact law N = EA (|r'| - 1), nothing bends."""
    cable = AncfCable.build(np.array([0.3, 0.5, 0.1, 0.4]), limp_section(2.0, 1e3, 1e3), INERTIA)
    load = np.zeros((5, 12))
    load[-1, 0] = 300.0
    result = equilibrium(RodModel(cable, straight(cable.s), [Support(0)], load=load))
    np.testing.assert_allclose(result.q[:, 0], 1.3 * cable.s, rtol=0, atol=1e-8)
    np.testing.assert_allclose(result.forces.S[:, :, 0], 300.0, rtol=1e-7)
    assert np.abs(result.forces.S[:, :, 1:]).max() < 1e-9


def test_force_is_the_gradient_of_the_energy():
    """dU/dq by central differences, 1e-7 of the largest entry; bent, stretched and out of the plane."""
    model, q = bent_in_space()

    def energy(shift: np.ndarray) -> float:
        here = q + shift
        return model.forces(0.0, here, np.zeros_like(q), []).elastic

    steps = 1e-6 * np.eye(q.size).reshape(q.size, *q.shape)
    slopes = [(energy(d) - energy(-d)) / 2e-6 for d in steps]
    F = force(model, q).ravel()
    np.testing.assert_allclose(F, slopes, rtol=0, atol=1e-7 * np.abs(F).max())


def test_tangent_is_the_derivative_of_the_force():
    """dF/dq + f dF/dv by central differences, damping on, 1e-6 of the largest entry (both are differences)."""
    model, q = bent_in_space(DampingTimes(2e-3, 3e-2))
    v = np.random.default_rng(4).normal(size=q.shape)
    n, factor, step = q.size, 50.0, 1e-6
    blocks = Blocks.zeros(4, 6)
    model.forces(0.0, q, v, [], blocks=blocks, factor=factor)
    A = np.zeros((4, 6, 4, 6))
    for i in range(4):
        A[i, :, i] = blocks.D[i]
        if i < 3:
            A[i, :, i + 1], A[i + 1, :, i] = blocks.U[i], blocks.L[i]
    columns = []
    for k in range(n):
        d = step * np.eye(n)[k].reshape(q.shape)
        columns.append((force(model, q + d, v + factor * d) - force(model, q - d, v - factor * d)).ravel() / (2 * step))
    B = np.array(columns).T
    np.testing.assert_allclose(A.reshape(n, n), B, rtol=0, atol=1e-6 * np.abs(B).max())


def test_damping_takes_power_and_no_statics():
    """The force of damping does negative work F_d . v = -power; at rest it is absent."""
    model, q = bent_in_space(DampingTimes(2e-3, 3e-2))
    plain, _ = bent_in_space()
    v = np.random.default_rng(5).normal(size=q.shape)
    found = model.forces(0.0, q, v, [])
    np.testing.assert_allclose(np.vdot(found.F - force(plain, q), v), found.damping_power, rtol=1e-12)
    assert found.damping_power > 0
    np.testing.assert_array_equal(force(model, q), force(plain, q))


def test_tension_of_a_bend_does_not_oscillate():
    """In the half circle EA (|r'| - 1) at other points is 0.4 N, at those of the rule 100 times less (but at the loaded end)."""
    result = half_circle(8)
    q = result.q
    x = 0.5 - np.sqrt(1 / 12)
    d = (
        6 * (x - x * x) * (q[1:, :3] - q[:-1, :3]) * 8
        + (1 - 4 * x + 3 * x * x) * q[:-1, 3:]
        + (3 * x * x - 2 * x) * q[1:, 3:]
    )
    between = np.abs(np.linalg.norm(d, axis=1) - 1).max() * 1e4
    assert 0.3 < between < 0.6
    assert between > 100 * np.abs(result.forces.S[:-2, :, 0]).max()


def test_cantilever_as_the_rod_without_shear():
    """Shape to 2e-6 of the length; N to 0.5 %, M to 0.1 %, Q, which is of first order, to 1.5 % of the largest; n 32."""
    cable, rod = cantilever(AncfCable, 32), cantilever(Rod, 32)
    np.testing.assert_allclose(cable.q[:, :3], rod.q[:, :3], rtol=0, atol=2e-6)
    section = limp_section(2.0, 1e4, 1e7)
    kinds = [kind.straight(1.0, 32, section, INERTIA) for kind in (AncfCable, Rod)]
    theta, local, turned = kinds[0].sections(cable.q, cable.forces.S)
    theta_rod, local_rod, _ = kinds[1].sections(rod.q, rod.forces.S)
    np.testing.assert_allclose(theta, theta_rod, rtol=0, atol=2e-5)
    for k, size in ((0, 0.1), (1, 0.3), (5, 9e-3)):
        np.testing.assert_allclose(local[1:-1, k], local_rod[1:-1, k], rtol=0, atol=size)
    np.testing.assert_allclose(turned[1:-1, :2], np.tile([0.0, -20.0], (31, 1)), rtol=0, atol=0.15)
    np.testing.assert_allclose(kinds[0].moment(cable.q[0], cable.forces.F[0])[2], 20.0 * cable.q[-1, 0], rtol=1e-6)
    E, S = kinds[0].strains(cable.q), kinds[0].in_section_axes(cable.q, cable.forces.S)
    np.testing.assert_allclose(S[..., [0, 5]], E[..., [0, 5]] * [1e4, 2.0], rtol=1e-9, atol=1e-9)


def test_pendulum_as_the_rod_without_shear():
    """Shear stiffness times 1000, 0.4 s, n 16: tips within 1e-3 m of 1.2 m, the order of either mesh error."""
    tips = [
        advanced(swing(pendulum(16, kind=kind, stiffening=1000.0), 1e-3, 0.0), 400).q[-1, :2]
        for kind in (AncfCable, Rod)
    ]
    np.testing.assert_allclose(tips[0], tips[1], rtol=0, atol=1e-3)


def test_bends_alike_in_every_plane():
    """A cantilever under a sideways and a downward load is one shape turned about its axis."""
    cable = AncfCable.straight(1.0, 6, limp_section(2.0, 1e4, 1e4), INERTIA)
    tips = []
    for load in ((0.0, -8.0, 0.0), (0.0, 0.0, -8.0), (0.0, -4.8, -6.4)):
        loads = np.zeros((7, 6))
        loads[-1, :3] = load
        tip = equilibrium(RodModel(cable, straight(cable.s), [Support(0)], load=loads)).q[-1, :3]
        tips.append([tip[0], tip @ np.array(load) / 8.0])
    np.testing.assert_allclose(tips, np.tile(tips[0], (3, 1)), rtol=0, atol=1e-7)


def test_what_it_does_not_have_is_refused():
    """One sentence each: two bending stiffnesses, initial curvature, moments, a skew clamp, a prescribed turn, theta'."""
    blade = SectionStiffness.uncoupled(EA=1e4, GA_x=1e4, GA_y=1e4, EI_x=1.0, EI_y=9.0, GJ=1.0, area=1.0)
    with pytest.raises(SpecError, match="one bending stiffness"):
        AncfCable.straight(1.0, 4, blade, INERTIA)
    cable = AncfCable.straight(1.0, 4, limp_section(2.0, 1e4, 1e4), INERTIA)
    q = straight(cable.s)
    with pytest.raises(SpecError, match="initial curvature needs the rod"):
        AncfCable.build(cable.lengths, limp_section(2.0, 1e4, 1e4), INERTIA, stress_free=q)
    load = np.zeros((5, 12))
    load[-1, 8] = 1.0
    with pytest.raises(SpecError, match="a moment cannot act"):
        RodModel(cable, q, load=load)
    with pytest.raises(SpecError, match="point along x, y or z"):
        RodModel(cable, straight(cable.s, angle=0.3), [Support(0)])
    with pytest.raises(SpecError, match="no theta' to hold"):
        RodModel(cable, q, [Support(0, ("theta'",))])
    with pytest.raises(SpecError, match="cannot be turned"):
        RodModel(cable, q, [Support(0, turn=Turn(lambda t: (t, 1.0, 0.0)))])


def test_towing_with_either_element():
    """The published constants shear little: pull force within 2 % of the rod's, the same record, energy closed."""
    short = read_scenario("intelligent-horizontal").changed(
        chain="smeared",
        cable__elements=100,
        time__duration="1 s",
        time__frame="0.5 s",
        drive__ramp_start="0 s",
        drive__ramp_end="0.5 s",
    )
    records = []
    for kind in ("rod", "ancf-cable"):
        run = tow(short.changed(element=kind))
        records.append(run.record())
        assert run.dataset.attrs["element"] == records[-1]["element"] == kind
        assert abs(run.balance_error) < 1e-4 and run.outcome.completed
    assert records[0].keys() == records[1].keys()
    pulls = [r["pull_force_max"] for r in records]
    assert pulls[0] != pulls[1]
    np.testing.assert_allclose(pulls[1], pulls[0], rtol=0.02)

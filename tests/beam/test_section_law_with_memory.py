"""A section law with internal state: it acts like the stiffness it stands for, remembers accepted steps only, and its
work closes the balance of energies."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from beam.generalized_alpha import Integrator, StepSettings
from beam.rod import GAUSS_W, Rod
from beam.rod_model import Blocks, RodModel, Support
from beam.section_law import DampingTimes
from beam.section_memory import SectionMemory, law_step
from beam.shape import straight, strands_and_arcs
from beam.statics import equilibrium
from geometry.errors import SpecError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

INERTIA = SectionInertia(2.0, 1e-3, 1e-3, 2e-3)
DIAGONAL = np.array([2e4, 2e4, 5e4, 6.0, 6.0, 4.0])


@dataclass(frozen=True)
class Stiffness:
    """S = K E: a law that could as well be part of C."""

    K: np.ndarray
    memory: int = 0

    def advance(self, E, before, dt, state, tangent):
        return E @ self.K.T, np.broadcast_to(self.K, (len(E), 6, 6)) if tangent else None, state


@dataclass(frozen=True)
class Slip:
    """Elastic and perfectly plastic in each strain: S = k s, |s| <= limit."""

    k: np.ndarray
    limit: np.ndarray
    memory: int = 6

    def advance(self, E, before, dt, state, tangent):
        trial = state + E - before
        s = np.clip(trial, -self.limit, self.limit)
        T = np.where(np.abs(trial) < self.limit, self.k, 0.0)[:, :, None] * np.eye(6) if tangent else None
        return self.k * s, T, s


@dataclass(frozen=True)
class Dashpot:
    """S = D dE/dt over the step."""

    D: np.ndarray
    memory: int = 0

    def advance(self, E, before, dt, state, tangent):
        T = np.broadcast_to(self.D / dt, (len(E), 6, 6)) if tangent else None
        return (E - before) @ self.D.T / dt, T, state


@dataclass(frozen=True)
class Cubic:
    """S = a (E . E) E, coupled and nonlinear."""

    a: float
    memory: int = 0

    def advance(self, E, before, dt, state, tangent):
        square = np.einsum("ni,ni->n", E, E)
        T = self.a * (square[:, None, None] * np.eye(6) + 2 * E[:, :, None] * E[:, None, :])
        return self.a * square[:, None] * E, T if tangent else None, state


def cantilever(diagonal=DIAGONAL, law=None, damping=None, elements=6) -> RodModel:
    section = SectionStiffness(np.diag(diagonal), 1e-3)
    rod = Rod.straight(1.0, elements, section, INERTIA, damping)
    return RodModel(rod, straight(rod.s), [Support(0)], gravity=(0.0, -9.81, 0.0), law=law)


def rod_order(diagonal):
    return diagonal[[2, 0, 1, 5, 3, 4]]


def halves() -> tuple[RodModel, RodModel]:
    """The whole stiffness in C, and half of it there and half in the law."""
    law = Stiffness(np.diag(0.5 * rod_order(DIAGONAL)))
    return cantilever(), cantilever(0.5 * DIAGONAL, law)


def test_stiffness_in_the_law_is_stiffness_of_the_section_at_rest():
    """The same static shape and the same section forces, to the tolerance of the statics."""
    whole, split = (equilibrium(model) for model in halves())
    split.outcome.require_success()
    np.testing.assert_allclose(split.q, whole.q, rtol=0, atol=1e-6)
    np.testing.assert_allclose(split.forces.S, whole.forces.S, rtol=0, atol=1e-4)


def test_stiffness_in_the_law_is_stiffness_of_the_section_in_motion():
    """A falling cantilever, 100 steps: the positions agree to the stopping rule of Newton's iteration."""
    settings = StepSettings(1e-3, adaptive=False, absolute=1e-7, relative=1e-12)
    runs = [Integrator(model, model.q0, settings=settings) for model in halves()]
    assert all(run.advance(100) for run in runs)
    np.testing.assert_allclose(runs[1].q, runs[0].q, rtol=0, atol=1e-8)
    assert runs[1].q[-1, 1] < -0.03


def test_dashpot_in_the_law_tends_to_the_damping_of_the_rod():
    """S = D dE/dt by differences is of first order in the step: halving it halves the distance (ratio 1.7 to 2.4)."""
    D = np.diag(rod_order(DIAGONAL)) * np.repeat([1e-3, 2e-2], 3)

    def tip(h, law, damping):
        model = cantilever(law=law, damping=damping)
        run = Integrator(model, model.q0, settings=StepSettings(h, adaptive=False, absolute=1e-6, relative=1e-10))
        assert run.advance(round(0.2 / h))
        return run.q[-1, 1]

    far, near = (abs(tip(h, Dashpot(D), None) - tip(h, None, DampingTimes(1e-3, 2e-2))) for h in (2e-3, 1e-3))
    assert 1.7 < far / near < 2.4


def test_tangent_is_the_derivative_of_the_force():
    """A nonlinear, coupled law at a bent, twisted state: differences of F agree with the blocks to 2e-6 of the largest."""
    model = cantilever(law=Cubic(3e4), elements=2)
    rng = np.random.default_rng(11)
    q = model.q0 + 0.2 * rng.normal(size=model.q0.shape) * np.repeat([0.01, 0.1, 1.0, 1.0], 3)
    v = np.zeros_like(q)
    blocks = Blocks.zeros(model.rod.nodes)
    model.forces(0.0, q, v, [], blocks=blocks)
    A = np.zeros((3, 12, 3, 12))
    for i in range(3):
        A[i, :, i] = blocks.D[i]
    for i in range(2):
        A[i, :, i + 1], A[i + 1, :, i] = blocks.U[i], blocks.L[i]
    expected = np.empty((36, 36))
    for k in range(36):
        d = 1e-6 * np.eye(36)[k].reshape(3, 12)
        expected[:, k] = ((model.forces(0.0, q + d, v, []).F - model.forces(0.0, q - d, v, []).F) / 2e-6).ravel()
    np.testing.assert_allclose(A.reshape(36, 36), expected, rtol=0, atol=2e-6 * np.abs(expected).max())


def slipping() -> Slip:
    return Slip(2.0 * rod_order(DIAGONAL), np.array([1e-5, 1e-4, 1e-4, 0.05, 0.05, 0.05]))


def test_energies_close_with_slip():
    """A cantilever that falls and swings with slip in every strain: stored + lost - work below 1e-5 of the throughput."""
    model = cantilever(law=slipping())
    run = Integrator(model, model.q0, settings=StepSettings(5e-4, spectral_radius=0.95))
    assert run.advance(1200), str(run.outcome)
    assert abs(run.ledger.balance_error) < 1e-5
    assert run.ledger.totals["section_law"] > 100 * abs(run.ledger.balance_error) * run.ledger.throughput


def test_swing_with_slip_calms_down():
    """Friction inside the section damps: the second second swings at most 0.7 of the first, without it at least 0.9."""
    ranges = []
    for law in (None, slipping()):
        model = cantilever(law=law)
        heights: list[float] = []
        run = Integrator(model, model.q0, settings=StepSettings(2e-3, spectral_radius=0.95))
        assert run.advance(1000, lambda m, heights=heights: heights.append(float(m.q[-1, 1])))
        ranges.append((np.ptp(heights[: len(heights) // 2]), np.ptp(heights[len(heights) // 2 :])))
    assert ranges[0][1] > 0.9 * ranges[0][0]
    assert ranges[1][1] < 0.7 * ranges[1][0]


def test_rejected_step_leaves_the_memory():
    """One iteration a step cannot converge: no step is accepted, and the memory is the object that it was."""
    model = cantilever(law=slipping())
    run = Integrator(model, model.q0, settings=StepSettings(1e-2, iterations=1, absolute=1e-12, relative=1e-14))
    before, state = run.memory, run.memory.state.copy()
    assert not run.advance(1)
    assert run.memory is before and np.array_equal(before.state, state)


def test_step_in_one_or_in_halves_is_the_same_for_monotonic_slip():
    """Static load steps hand on the memory: half the load and then all of it, or all at once."""
    model = cantilever(law=slipping())
    at_once = equilibrium(model)
    half = replace(model, gravity=(0.0, -4.9, 0.0))
    first = equilibrium(half)
    second = equilibrium(model, first.q, memory=first.memory)
    second.outcome.require_success()
    assert first.memory is not None and np.abs(first.memory.state).max() > 0
    np.testing.assert_allclose(second.q, at_once.q, rtol=0, atol=1e-5)


def test_unloaded_rod_keeps_a_set():
    """Bend and let go: the tip stays down, and the law's moments are held by those of the section: in the mean over the rod to
    1e-4, at every point to 10 % (the end of the slipped part lies inside an element)."""
    law = slipping()
    model = cantilever(law=replace(law, limit=np.where(np.arange(6) < 3, 1.0, law.limit)))
    loaded = equilibrium(model)
    back = equilibrium(replace(model, gravity=(0.0, 0.0, 0.0)), loaded.q, memory=loaded.memory)
    back.outcome.require_success()
    assert back.q[-1, 1] < -1e-3
    held = np.abs(back.memory.S[..., 5]).max()
    assert held > 0.1
    assert abs(np.mean(back.forces.S[..., 5] @ GAUSS_W)) < 1e-4 * held
    np.testing.assert_allclose(back.forces.S[..., 5], 0.0, atol=0.1 * held)


def test_integrator_goes_on_from_the_static_state():
    """Started with the static memory at its equilibrium, nothing moves: 1e-6 m in 0.2 s."""
    model = cantilever(law=slipping())
    static = equilibrium(model)
    run = Integrator(model, static.q, memory=static.memory, settings=StepSettings(5e-3))
    assert run.advance(40)
    np.testing.assert_allclose(run.q[:, :3], static.q[:, :3], rtol=0, atol=1e-6)


def test_stress_free_shape_has_no_force_of_the_law():
    """The law gets strains minus those of the stress-free shape, here an arc."""
    s = np.linspace(0, 1, 7)
    arc = strands_and_arcs(s, [(1.0, -0.8)], angle=0.0)
    rod = Rod.build(np.diff(s), SectionStiffness(np.diag(DIAGONAL), 1e-3), INERTIA, stress_free=arc)
    model = RodModel(rod, arc, [Support(0)], law=slipping())
    forces = model.forces(0.0, arc, 0 * arc, [])
    np.testing.assert_allclose(forces.memory.S, 0.0, atol=1e-12)


def test_memory_of_another_rod_is_refused():
    """A sentence with both numbers of elements."""
    law = slipping()
    with pytest.raises(SpecError, match=r"of 4 elements.*has 6"):
        law_step(law, SectionMemory.fresh(law, 4, 3), np.zeros((6, 3, 6)), 1.0, False)


def test_law_that_returns_another_shape_is_refused():
    """A sentence with the shapes, not a broadcast."""

    class Wrong(Slip):
        def advance(self, E, before, dt, state, tangent):
            return np.zeros((len(E), 3)), None, state

    law = Wrong(np.ones(6), np.ones(6))
    with pytest.raises(SpecError, match="returned forces"):
        law_step(law, SectionMemory.fresh(law, 2, 3), np.zeros((2, 3, 6)), 1.0, False)

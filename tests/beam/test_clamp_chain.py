"""A cable in a chain of clamps: momentum, energy, stops, gap, friction on a floor, restart."""

import numpy as np
import pytest

from beam.bodies_alone import bodies_alone
from beam.body_record import body_motion, bushing_states
from beam.checkpoint import read_checkpoint, write_checkpoint
from beam.clamp_chain import ClampSettings, clamp_chain
from beam.generalized_alpha import Integrator, StepSettings
from beam.joint import Joint
from beam.rigid_body import RigidBody
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.section_law import DampingTimes
from beam.shape import straight
from beam.statics import equilibrium
from beam.surface import ContactLaw, Plane
from geometry.errors import InputError, SpecError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

SECTION = SectionStiffness.uncoupled(EA=1e5, GA_x=3e4, GA_y=3e4, EI_x=5.0, EI_y=5.0, GJ=3.0, area=1e-3)
CLAMP = ClampSettings(
    mass=0.4, inertia=(2e-4, 3e-4, 4e-4), pin_stiffness=(1e6, 1e6, 1e6, 50.0, 50.0, 0.0),
    pin_damping=(20.0, 20.0, 20.0, 0.01, 0.01, 0.01), hole_stiffness=(2e4, 2e4, 2e4, 1.0, 0.0, 0.0),
    hole_damping=(5.0, 5.0, 5.0, 1e-3, 0.0, 0.0), gap=0.002, stop_angle=0.15, stop_stiffness=200.0, pin_width=0.05,
    points=((0.0, 0.0, 0.02), (0.0, 0.0, -0.02)),
)  # fmt: skip


def chain(supports=(), gravity=(0.0, 0.0, 0.0), surfaces=(), elements=9, damping=None) -> RodModel:
    """Four clamps on every third node of a cable of 0.9 m."""
    rod = Rod.straight(
        0.9, elements, SECTION, SectionInertia(1.0, 1e-4, 1e-4, 2e-4), damping or DampingTimes(1e-3, 1e-3)
    )
    q = straight(rod.s)
    bodies, bushings = clamp_chain(q, range(0, elements + 1, 3), CLAMP)
    return RodModel(rod, q, supports, gravity, bodies=bodies, bushings=bushings, body_surfaces=surfaces)


def momentum(motion: Integrator) -> tuple[np.ndarray, np.ndarray]:
    """Linear and angular momentum about the origin: M v against the rigid motions, whose rates are exact for the rod."""
    model = motion.model
    p = model.inertia(motion.v, motion.q)
    now = body_motion(model, motion.q, motion.v)
    linear = p[: model.moving, 0:3].sum(axis=0)
    rod = model.rod.nodes
    angular = np.cross(motion.q[:rod, 0:3], p[:rod, 0:3]).sum(axis=0) + np.cross(motion.q[:rod, 3:6], p[:rod, 3:6]).sum(
        axis=0
    )
    for k, body in enumerate(model.bodies):
        R = now.rotation[k]
        angular += np.cross(now.position[k], body.mass * now.velocity[k]) + R @ body.J @ R.T @ now.spin[k]
    return linear, angular


def test_free_chain_keeps_its_momentum():
    """Clamps thrown in different directions in the plane: linear momentum exact; angular to 1e-3 with the rod's own spin left out."""
    model = chain()
    v = np.zeros((10, 12))
    v[:, 1], v[:, 4] = 0.3 * np.sin(3 * model.q0[:10, 0]), 0.9 * np.cos(3 * model.q0[:10, 0])
    motion = Integrator(
        model,
        model.q0,
        model.complete(v, motion=True),
        settings=StepSettings(5e-4, adaptive=False, relative=1e-10, absolute=1e-8),
    )
    p0, L0 = momentum(motion)
    assert motion.advance(200), motion.outcome
    p, L = momentum(motion)
    np.testing.assert_allclose(p, p0, rtol=0, atol=1e-9)
    assert abs(L[2] - L0[2]) < 5e-3 * abs(L0[2])
    assert np.abs(bushing_states(model, motion.t, motion.q, motion.v).force).max() > 0.1


def test_energy_balance_of_a_falling_chain():
    """One end held, the chain falls, cable hits the clamps, neighbours hit their stops: 1e-6 of what is exchanged."""
    model = chain([Support(0)], (0, -9.81, 0.3))
    motion = Integrator(model, model.q0, settings=StepSettings(2.5e-5, adaptive=False, relative=1e-9, absolute=1e-7))
    errors = []
    assert motion.advance(2400, lambda m: errors.append(abs(m.ledger.balance_error * m.ledger.throughput)))
    totals = motion.ledger.totals
    assert totals["bushing_damping_loss"] > 0 and totals["bushing"] > 0
    assert max(errors) < 1e-6 * max(abs(totals["gravity"]), totals["kinetic"])


def test_chain_on_two_supports_hangs_on_its_stops():
    """Static sag of a chain whose neighbours may turn by 0.15 rad: stops and gap are met, weight is carried."""
    model = chain([Support(0, ("r",)), Support(-1, ("r",))], (0, -9.81, 0))
    rest = equilibrium(model)
    rest.outcome.require_success()
    state = bushing_states(model, 0.0, rest.q, np.zeros_like(rest.q))
    holes = state.displacement[-4:]
    assert np.hypot(holes[:, 1], holes[:, 2]).max() > 0.002
    lifted = rest.forces.F[[0, 9], 1].sum()
    assert lifted == pytest.approx((4 * 0.4 + 0.9) * 9.81, rel=1e-5)
    order = [b.name for b in model.bushings]
    assert order[:3] == ["pin 0.0", "pin 0.1", "pin 1.0"] and order[6] == "stop 0" and order[-1] == "hole 3"


def test_body_slides_and_sticks_on_a_slope():
    """Slope of 0.5 rad: with mu 0.3 a = g (sin - mu cos) within 5e-4 once the contact has settled; with mu 0.6 it stays.

    The equations are solved to 1e-6 N: to 1e-3 N the block at rest would shake by 1e-3 N / 2 kg in a step of 1 ms.
    """
    points = [(x, 0.0, z) for x in (-0.1, 0.1) for z in (-0.1, 0.1)]
    gravity = 9.81 * np.array([np.sin(0.5), -np.cos(0.5), 0.0])
    depth = 2.0 * 9.81 * np.cos(0.5) / (1.25e6 * 0.2)
    body = RigidBody("block", 2.0, (0.01, 0.01, 0.01), (0, -depth, 0), points=points, contact_length=0.2)
    speeds = []
    for mu in (0.3, 0.6):
        model = bodies_alone([body], surfaces=[Plane("floor", ContactLaw(friction=mu))], gravity=gravity)
        motion = Integrator(model, model.q0, settings=StepSettings(1e-3, absolute=1e-6))
        assert motion.advance(100), motion.outcome
        first = motion.v[2, 0]
        assert motion.advance(200), motion.outcome
        speeds.append((motion.v[2, 0] - first) / 0.2)
        assert motion.forces.body_contact[0, 1] == pytest.approx(2.0 * 9.81 * np.cos(0.5), rel=1e-4)
        assert abs(motion.ledger.balance_error) < 1e-3
    assert speeds[0] == pytest.approx(9.81 * (np.sin(0.5) - 0.3 * np.cos(0.5)), rel=5e-4)
    assert abs(speeds[1]) < 1e-6


def test_restart_with_bodies_is_bit_exact(tmp_path):
    """Clamps that slide on a floor with friction, adaptive steps, kept matrix: state, energies, counters."""

    def fresh() -> Integrator:
        model = chain([Support(0, ("x", "z", "theta"))], (2.0, -9.81, 0), [Plane("floor", ContactLaw(friction=0.2))])
        return Integrator(model, model.q0, settings=StepSettings(2e-3))

    whole, first, second = fresh(), fresh(), fresh()
    assert whole.advance(30) and first.advance(17)
    read_checkpoint(second, write_checkpoint(first, tmp_path / "chain.checkpoint"))
    assert second.advance(13)
    np.testing.assert_array_equal(second.q, whole.q)
    np.testing.assert_array_equal(second.v, whole.v)
    assert second.ledger.totals == whole.ledger.totals and second.counters == whole.counters
    other = chain([Support(0)])
    with pytest.raises(InputError, match="another model"):
        read_checkpoint(Integrator(other, other.q0, settings=whole.settings), tmp_path / "chain.checkpoint")


def test_divergence_names_the_body():
    """A drive that becomes NaN reaches a clamp or a node by name."""
    model = chain([Support(0)], (0, -9.81, 0))
    motion = Integrator(model, model.q0, settings=StepSettings(1e-2, relative=0.0, absolute=0.0, iterations=2))
    assert not motion.advance(1)
    assert "node" in motion.outcome.detail or "clamp" in motion.outcome.detail


def test_chain_without_order_is_refused():
    """Nodes must grow."""
    with pytest.raises(SpecError, match="growing order"):
        clamp_chain(straight(np.linspace(0, 1, 5)), [2, 1], CLAMP)


def one_step() -> np.ndarray:
    """Two clamps on a floor, one on a swivel: what test_uncompiled_kernels.py computes twice."""
    part = chain((), (2.0, -9.81, 0), [Plane("floor", ContactLaw(friction=0.2))], elements=3)
    joint = Joint("swivel", "ground", "clamp 0", axis=(0, 0, 1))
    model = RodModel(
        part.rod, part.q0[:4], (), part.gravity, bodies=part.bodies, bushings=part.bushings, joints=[joint],
        body_surfaces=part.body_surfaces,
    )  # fmt: skip
    motion = Integrator(model, model.q0, settings=StepSettings(2e-3, adaptive=False))
    motion.advance(1)
    return np.append(motion.q[3:6].ravel(), motion.counters.iterations)

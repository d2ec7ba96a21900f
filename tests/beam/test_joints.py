"""Joints take the unknowns that they say and no others: mechanisms against their kinematics, rods with joints against exact modes."""

import numpy as np
import pytest
from scipy.linalg import eigh, null_space
from scipy.optimize import brentq

from beam.bodies_alone import bodies_alone
from beam.body_record import body_motion, joint_reactions
from beam.generalized_alpha import Integrator, StepSettings
from beam.joint import KINDS, Joint
from beam.motion import SpeedRamp, Turn
from beam.rigid_body import RigidBody
from beam.rod import Rod
from beam.rod_model import RodModel
from beam.shape import straight
from beam.statics import equilibrium
from beam.support import Support
from geometry.errors import SpecError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

TIGHT = {"adaptive": False, "relative": 1e-9, "absolute": 1e-6, "iterations": 60}
EI, M = 2.0, 1.0
SECTION = SectionStiffness.uncoupled(EA=1e5, GA_x=1e5, GA_y=1e5, EI_x=EI, EI_y=EI, GJ=1.0, area=1e-3)
ROD = Rod.straight(1.0, 8, SECTION, SectionInertia(M, 1e-7, 1e-7, 2e-7))
PLANE = [0, 1, 3, 4, 8, 11]


def plane_frequencies(model: RodModel, q: np.ndarray) -> np.ndarray:
    """Angular frequencies of small motions in the x, y plane about the equilibrium `q`, constraints eliminated."""
    n = model.rows

    def dense(factor_a: float) -> np.ndarray:
        blocks, zero = model.blocks(), np.zeros_like(q)
        model.forces(0.0, q, zero, model.fresh_anchors(), blocks=blocks, a=zero, factor_a=factor_a)
        A = np.zeros((n, 12, n, 12))
        for (i, j), s in blocks.pattern.slot.items():
            A[i, :, j] = blocks.store[s]
        return A.reshape(12 * n, 12 * n)

    K = dense(0.0)
    mass = (dense(1e6) - K) / 1e6
    moving = np.zeros((n, 12), dtype=bool)
    moving[: model.moving, PLANE] = model.free[: model.moving, PLANE]
    rows = np.zeros((n, 12), dtype=bool)
    rows[model.moving :] = model.free[model.moving :]
    x, c = moving.ravel(), rows.ravel()
    G = K[c][:, x]
    N = null_space(G[np.abs(G).max(axis=1) > 1e-3]) if c.any() else np.eye(int(x.sum()))
    part = [N.T @ (0.5 * (A + A.T))[x][:, x] @ N for A in (K, mass)]
    return np.sign(eigh(*part, eigvals_only=True)) * np.sqrt(np.abs(eigh(*part, eigvals_only=True)))


def test_rod_pinned_at_both_ends():
    """f_n = (n pi / L)^2 sqrt(EI / m), n = 1, 2: within 3e-4, the share of shear and rotary inertia of this rod."""
    joint = Joint("pinned", "ground", 0)
    model = RodModel(ROD, straight(ROD.s), [Support(-1, ("x", "y", "z"))], joints=[joint])
    got = plane_frequencies(model, model.q0)
    np.testing.assert_allclose(got[:2], [np.pi**2 * np.sqrt(EI / M), 4 * np.pi**2 * np.sqrt(EI / M)], rtol=1e-3)


def test_euler_buckling_of_a_pinned_rod():
    """Under the thrust P the first frequency falls as w^2 = w0^2 (1 - P / P_E), P_E = pi^2 EI / L^2: at P_E / 2, within 1e-3."""
    load = np.zeros((9, 12))
    P = np.pi**2 * EI / 2
    load[-1, 0] = -P
    model = RodModel(
        ROD,
        straight(ROD.s),
        [Support(-1, ("y", "z", "theta'")), Support(0, ("theta'",))],
        load=load,
        joints=[Joint("pinned", "ground", 0)],
    )
    rest = equilibrium(RodModel(ROD, straight(ROD.s), [Support(0), Support(-1, ("y", "z"))], load=load))
    rest.outcome.require_success()
    q = model.q0.copy()
    q[:9] = rest.q
    got = plane_frequencies(model, q)[0]
    free = RodModel(ROD, straight(ROD.s), [Support(-1, ("y", "z"))], joints=[Joint("pinned", "ground", 0)])
    assert (got / plane_frequencies(free, free.q0)[0]) ** 2 == pytest.approx(0.5, abs=5e-3)


def test_cantilever_with_a_tip_mass():
    """1 + cos x cosh x + (M x / m L)(cos x sinh x - sin x cosh x) = 0 for the ratio M / m L = 0.7."""
    ratio = 0.7
    body = RigidBody("tip", ratio * M, (1e-9, 1e-9, 1e-9), (1.0, 0.0, 0.0))
    model = RodModel(ROD, straight(ROD.s), [Support(0)], bodies=[body], joints=[Joint("fixed", -1, "tip")])
    x = brentq(
        lambda x: 1 + np.cos(x) * np.cosh(x) + ratio * x * (np.cos(x) * np.sinh(x) - np.sin(x) * np.cosh(x)), 0.5, 1.8
    )
    assert plane_frequencies(model, model.q0)[0] == pytest.approx(x**2 * np.sqrt(EI / M), rel=5e-4)


def test_slider_crank():
    """Crank turned with 8 rad/s: x = a cos + sqrt(l^2 - a^2 sin^2) to 1e-8 m over a turn and more; work of the drive is the energy."""
    a, l = 0.1, 0.3
    crank = RigidBody("crank", 1.0, (0.01, 0.01, 0.01), (0, 0, 0), spin=(0, 0, 0.0))
    rod = RigidBody("rod", 0.5, (1e-5, 4e-3, 4e-3), (a + l / 2, 0, 0))
    piston = RigidBody("piston", 2.0, (0.01, 0.01, 0.01), (a + l, 0, 0))

    def angle(t):
        x = min(t / 0.4, 1.0)
        return 8 * (0.4 * (x**3 - x**4 / 2) + max(t - 0.4, 0)), 8 * (3 * x**2 - 2 * x**3), 8 / 0.4 * (6 * x - 6 * x**2)

    joints = [
        Joint("pinned", "crank", "rod", point=(a, 0, 0)),
        Joint("pinned", "rod", "piston", point=(l / 2, 0, 0)),
        Joint("slider", "ground", "piston"),
    ]
    model = bodies_alone([crank, rod, piston], joints=joints, supports=[Support("crank", turn=Turn(angle))])
    motion = Integrator(model, model.q0, settings=StepSettings(1e-3, spectral_radius=0.8, **TIGHT))
    assert motion.advance(1300), motion.outcome
    phi = angle(motion.t)[0]
    assert phi > 2 * np.pi
    x = a * np.cos(phi) + np.sqrt(l * l - (a * np.sin(phi)) ** 2)
    assert motion.q[model.row("piston"), 0] == pytest.approx(x, abs=1e-8)
    assert abs(motion.ledger.balance_error) < 1e-3
    assert motion.ledger.totals["drive_work"] == pytest.approx(motion.ledger.totals["kinetic"], rel=5e-3)


@pytest.mark.parametrize("kind", list(KINDS))
def test_every_kind_leaves_what_it_says(kind):
    """A body pushed and turned at random: displacements and turns that are taken stay zero, the others move."""
    body = RigidBody("a", 1.0, (0.1, 0.12, 0.14), (0.3, 0.1, 0.2), (0.2, -0.3, 0.5), force=(3.0, -2.0, 1.0))
    push = RigidBody("b", 1.0, (0.1, 0.12, 0.14), (0.5, 0.4, 0.2), force=(-1.0, 4.0, -3.0))
    axis = np.array([1.0, 2.0, -1.0]) / np.sqrt(6)
    joints = [Joint(kind, "ground", "a", axis=axis), Joint("pinned", "a", "b", point=(0.3, 0.2, 0.1))]
    model = bodies_alone([body, push], joints=joints)
    motion = Integrator(model, model.q0, settings=StepSettings(2e-3, **TIGHT))
    assert motion.advance(100), motion.outcome
    now, then = body_motion(model, motion.q, motion.v), body_motion(model, model.q0, motion.v)
    d = now.position[0] - then.position[0]
    turned = now.rotation[0] @ then.rotation[0].T
    along, _, _, turns = KINDS[kind]
    across = d - axis * (axis @ d)
    assert np.linalg.norm(across) < 1e-9
    assert (abs(axis @ d) < 1e-9) == along
    free = np.linalg.norm(turned - np.eye(3))
    assert (free < 1e-9) == (turns == 3) and (np.linalg.norm(turned @ axis - axis) < 1e-9) == (turns >= 2)
    assert free > 1e-3 or turns == 3


def test_reaction_of_a_prescribed_joint():
    """A pinned joint that moves with a ramp carries the mass: reaction m a + weight, its work is the kinetic energy."""
    ramp = SpeedRamp(2.0, 0.0, 0.5, direction=(0.0, 0.0, 1.0))
    body = RigidBody("a", 3.0, (0.1, 0.1, 0.1), (0.0, 0.0, 0.0))
    model = bodies_alone([body], joints=[Joint("fixed", "ground", "a", travel=ramp)], gravity=(0, -9.81, 0))
    motion = Integrator(model, model.q0, settings=StepSettings(1e-3, spectral_radius=0.5, **TIGHT))
    assert motion.advance(250)
    np.testing.assert_allclose(
        joint_reactions(model, motion.t, motion.q)[0, :3], [0, 3 * 9.81, 3 * 6.0], rtol=2e-3, atol=1e-3
    )
    assert motion.ledger.totals["drive_work"] == pytest.approx(0.5 * 3.0 * 1.0**2, rel=1e-4)


def test_hanging_chain_of_links_at_rest():
    """Statics with joints: three links pinned in a row and pushed sideways hang in a line along the force; reactions balance it."""
    bodies = [RigidBody(f"l{k}", 1.0, (0.1, 0.1, 0.1), (0.1 + 0.2 * k, 0, 0)) for k in range(3)]
    bodies[2] = RigidBody("l2", 1.0, (0.1, 0.1, 0.1), (0.5, 0, 0), force=(5.0, 0.0, 0.0))
    joints = [Joint("swivel", "ground", "l0", point=(0, 0, 0), axis=(0, 0, 1))]
    joints += [Joint("swivel", f"l{k}", f"l{k + 1}", point=(0.1, 0, 0), axis=(0, 0, 1)) for k in range(2)]
    model = bodies_alone(bodies, joints=joints, gravity=(0, -9.81, 0))
    rest = equilibrium(model)
    rest.outcome.require_success()
    reaction = joint_reactions(model, 0.0, rest.q)
    np.testing.assert_allclose(reaction[0, :3], [-5.0, 3 * 9.81, 0], rtol=0, atol=1e-4)
    np.testing.assert_allclose(reaction[2, :3], [-5.0, 9.81, 0], rtol=0, atol=1e-4)


@pytest.mark.parametrize(
    ("joints", "supports", "sentence"),
    [
        ([Joint("fixed", "ground", "a")], [Support("a", ("r",))], "3 of 6 constraints are superfluous"),
        ([Joint("pinned", "ground", "a")] * 2, [], "the 2 joints together: 3 of 6"),
        ([Joint("fixed", 0, "a"), Joint("swivel", "ground", "a")], [], "superfluous"),
    ],
)
def test_over_constraint_is_a_sentence(joints, supports, sentence):
    """Held unknowns, two joints on one body, a held node."""
    body = RigidBody("a", 1.0, (0.1, 0.1, 0.1), (0.0, 0.0, 0.0))
    with pytest.raises(SpecError, match=sentence):
        bodies_alone([body], joints=joints, supports=supports)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"kind": "hinge"}, "no kind 'hinge'; choose one of fixed, pinned"),
        ({"axis": (0, 0, 0)}, "not all zero"),
        ({"second": "nobody"}, "refers to the body 'nobody'"),
        ({"first": "a", "travel": SpeedRamp(1.0, 0.0, 1.0)}, "on the ground"),
    ],
)
def test_wrong_joints_are_refused(change, sentence):
    """One sentence each."""
    body = RigidBody("a", 1.0, (0.1, 0.1, 0.1), (0.0, 0.0, 0.0))
    with pytest.raises(SpecError, match=sentence):
        bodies_alone([body], joints=[Joint(**({"kind": "fixed", "first": "ground", "second": "a"} | change))])

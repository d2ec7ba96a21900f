"""Newton's and Euler's equations: free flight, tops, pendulums; order two of the step; impossible bodies are refused."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from beam.bodies_alone import bodies_alone
from beam.body_record import body_motion, joint_reactions
from beam.generalized_alpha import Integrator, StepSettings
from beam.joint import Joint
from beam.rigid_body import RigidBody
from beam.rod_model import RodModel
from geometry.errors import SpecError

G = 9.81


def run(model: RodModel, h: float, T: float, absolute: float = 1e-6) -> Integrator:
    settings = StepSettings(
        h, adaptive=False, relative=1e-9, absolute=absolute, spectral_radius=0.9, iterations=60
    )  # a cut would change the step
    motion = Integrator(model, model.q0, settings=settings)
    assert motion.advance(round(T / h)), motion.outcome
    return motion


def momentum(motion: Integrator, body: RigidBody) -> tuple[np.ndarray, np.ndarray]:
    """Linear and angular momentum about the origin, in global axes."""
    now = body_motion(motion.model, motion.q, motion.v)
    p = body.mass * now.velocity[0]
    return p, np.cross(now.position[0], p) + now.rotation[0] @ body.J @ now.rotation[0].T @ now.spin[0]


def test_free_flight_keeps_momentum_and_energy():
    """Asymmetric body in free flight, a full turn: linear momentum exact, angular momentum and energy of second order or better."""
    body = RigidBody("stone", 2.0, (0.1, 0.2, 0.25), (0.1, 0, 0), (0.3, 0.2, 0), (1.0, 2.0, -0.5), (1.0, 6.0, 0.5))
    drift = []
    for h in (8e-3, 4e-3):
        motion = run(bodies_alone([body]), h, 1.0, 1e-9)
        start = Integrator(motion.model, motion.model.q0)
        (p0, L0), (p, L) = momentum(start, body), momentum(motion, body)
        np.testing.assert_allclose(p, p0, rtol=1e-12)
        assert np.linalg.norm(motion.q[2, 6:9]) < 1.26 * np.pi
        drift.append((np.linalg.norm(L - L0), abs(motion.ledger.totals["kinetic"] - start.ledger.totals["kinetic"])))
    (L1, E1), (L2, E2) = drift
    assert L1 / L2 > 3.4 and E2 < E1
    assert L2 < 1e-3 * np.linalg.norm(L0)


def test_asymmetric_top_against_eulers_equations():
    """J w' = J w x w integrated for itself: the angular velocity in the body's axes, order two of the step."""
    J, w0 = np.array([0.1, 0.2, 0.25]), np.array([0.2, 5.0, 0.1])
    exact = solve_ivp(lambda t, w: np.cross(J * w, w) / J, (0, 0.8), w0, rtol=1e-11, atol=1e-12).y[:, -1]
    body, errors = RigidBody("top", 1.0, J, (0, 0, 0), spin=w0), []
    for h in (8e-3, 4e-3):
        motion = run(bodies_alone([body]), h, 0.8, 1e-9)
        now = body_motion(motion.model, motion.q, motion.v)
        errors.append(np.abs(now.rotation[0].T @ now.spin[0] - exact).max())
    assert errors[1] < 1e-4
    assert 3.5 < errors[0] / errors[1] < 4.5


def test_symmetric_top_precesses_with_the_exact_rate():
    """Free symmetric top: its axis goes round the angular momentum with |L| / J_1; 1e-4 rad of 10 from the step of 1 ms."""
    body = RigidBody("top", 1.0, (0.1, 0.1, 0.18), (0, 0, 0), spin=(1.0, 0.0, 8.0))
    L = np.array([0.1, 0.0, 0.18 * 8.0])
    rate, T = np.linalg.norm(L) / 0.1, 0.7
    motion = run(bodies_alone([body]), 1e-3, T)
    axis = body_motion(motion.model, motion.q, motion.v).rotation[0][:, 2]
    e3 = L / np.linalg.norm(L)
    e1 = np.array([0.0, 0.0, 1.0]) - e3[2] * e3
    e1 /= np.linalg.norm(e1)
    angle = np.arctan2(axis @ np.cross(e3, e1), axis @ e1)
    off = (angle - rate * T + np.pi) % (2 * np.pi) - np.pi
    assert abs(off) < 2e-3
    assert axis @ e3 == pytest.approx(e3[2], abs=1e-5)


def test_heavy_top_steady_precession():
    """Pinned top, steady precession W of J_s s W - (J_t - J_s) ... at a right angle: J_3 s W = m g l exactly when it is level."""
    m, r, Jt, Js, spin = 0.8, 0.1, 2e-3, 3e-3, 80.0
    W = m * G * r / (Js * spin)
    body = RigidBody("top", m, (Js, Jt, Jt), (r, 0, 0), velocity=(0, 0, -W * r), spin=(spin, W, 0.0))
    model = bodies_alone([body], joints=[Joint("pinned", "ground", "top", point=(0, 0, 0))], gravity=(0, -G, 0))
    motion = run(model, 5e-4, 0.3)
    where = body_motion(model, motion.q, motion.v).position[0]
    assert np.arctan2(-where[2], where[0]) == pytest.approx(W * 0.3, rel=1e-4)
    assert abs(where[1]) < 5e-4 * r  # 0.04 rad of spin a step, squared over twelve


def test_compound_pendulum_period_and_reaction():
    """I phi'' = -m g l sin phi; the pin carries weight and centripetal force; its work is zero; order two."""
    m, l, I = 2.0, 0.5, 0.04 + 2.0 * 0.25
    body = RigidBody("bob", m, (0.02, 0.03, 0.04), (0.0, -l, 0.0))
    joint = Joint("swivel", "ground", "bob", point=(0, 0, 0), axis=(0, 0, 1))
    model = bodies_alone([body], joints=[joint], gravity=(G, 0, 0))
    exact = solve_ivp(lambda t, y: [y[1], m * G * l * np.cos(y[0]) / I], (0, 1.2), [0, 0], rtol=1e-11, atol=1e-12)
    phi, w = exact.y[:, -1]
    errors = []
    for h in (4e-3, 2e-3):
        motion = run(model, h, 1.2)
        x = motion.q[model.row("bob"), 0:3]
        errors.append(abs(np.arctan2(x[0], -x[1]) - phi))
        assert np.linalg.norm(x) == pytest.approx(l, abs=1e-9)
    assert errors[1] < 3e-4 and 3.5 < errors[0] / errors[1] < 4.5
    along = np.array([np.sin(phi), -np.cos(phi), 0.0])
    reaction = joint_reactions(model, motion.t, motion.q)[0]
    tangent = np.array([np.cos(phi), np.sin(phi), 0.0])
    acceleration = -w * w * l * along + m * G * l * np.cos(phi) / I * l * tangent
    np.testing.assert_allclose(reaction[:3], m * acceleration - [m * G, 0, 0], rtol=0, atol=2e-3 * m * G)
    assert abs(reaction[5]) < 1e-9 and abs(motion.ledger.totals["drive_work"]) == 0.0


def test_double_pendulum_of_rigid_bodies():
    """Two thin links, mass matrix and forces of the textbook, integrated for themselves."""
    m, L = 1.0, 0.6
    I, c = m * L**2 / 12, L / 2

    def rate(t, y):
        a, b, u, w = y
        M = np.array([[I + m * c**2 + m * L**2, m * L * c * np.cos(a - b)], [m * L * c * np.cos(a - b), I + m * c**2]])
        s = m * L * c * np.sin(a - b)
        f = [-s * w * w - m * G * (c + L) * np.sin(a), s * u * u - m * G * c * np.sin(b)]
        return [u, w, *np.linalg.solve(M, f)]

    exact = solve_ivp(rate, (0, 0.8), [np.pi / 2, np.pi / 2, 0, 0], rtol=1e-11, atol=1e-12).y[:, -1]
    J = (1e-4, I, I)
    bodies = [RigidBody("upper", m, J, (c, 0, 0)), RigidBody("lower", m, J, (3 * c, 0, 0))]
    joints = [
        Joint("swivel", "ground", "upper", point=(0, 0, 0), axis=(0, 0, 1)),
        Joint("pinned", "upper", "lower", point=(c, 0, 0)),
    ]
    model, errors = bodies_alone(bodies, joints=joints, gravity=(0, -G, 0)), []
    tip = L * np.array([np.sin(exact[0]) + 0.5 * np.sin(exact[1]), -np.cos(exact[0]) - 0.5 * np.cos(exact[1])])
    for h in (8e-3, 4e-3):
        motion = run(model, h, 0.8)
        errors.append(np.linalg.norm(motion.q[model.row("lower"), 0:2] - tip))
    assert errors[1] < 1e-3 and 3.3 < errors[0] / errors[1] < 4.7
    assert abs(motion.ledger.balance_error) < 1e-4


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"mass": -1.0}, "its mass is -1 kg"),
        ({"inertia": (1.0, 1.0, 0.0)}, "must be positive"),
        ({"inertia": (1.0, 1.0, 2.5)}, "larger than the sum of the other two"),
        ({"inertia": [[1, 0.2, 0], [0, 1, 0], [0, 0, 1]]}, "symmetric"),
        ({"position": (0.0, np.nan, 0.0)}, "its position must be three finite numbers"),
        ({"points": [(0.0, 0.0, 0.0)]}, "contact length of 0 m"),
    ],
)
def test_impossible_bodies_are_refused(change, sentence):
    """Mass, inertia, position and contact points."""
    given = {"mass": 1.0, "inertia": (1.0, 1.0, 1.0), "position": (0.0, 0.0, 0.0)} | change
    with pytest.raises(SpecError, match=sentence):
        RigidBody("stone", **given)

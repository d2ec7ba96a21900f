"""Formula (21): the law in each direction, with play, preload and damping; balance of force and moment; energy."""

import numpy as np
import pytest

from beam.bodies_alone import bodies_alone
from beam.body_record import bushing_states
from beam.bushing import Bushing
from beam.generalized_alpha import Integrator, StepSettings
from beam.relative_motion import POSE, RELATIVE, inverse_turn, pose, relative, rotation_vector_of
from beam.rigid_body import RigidBody
from beam.rotation_vector import rotation_matrix
from beam.statics import equilibrium
from beam.support import Support
from beam.surface import ContactLaw, Plane
from geometry.errors import SpecError

K = np.array([3e3, 2e3, 1e3, 5.0, 7.0, 9.0])
C = np.array([3.0, 2.0, 1.0, 0.5, 0.7, 0.9])


def forces_at(bushing, x=(0, 0, 0), theta=(0, 0, 0), v=(0, 0, 0), rate=(0, 0, 0)):
    """State of the bushing and generalised forces on the two bodies, the first at the origin."""
    bodies = [RigidBody("a", 1.0, (1.0, 1.0, 1.0), (0, 0, 0)), RigidBody("b", 1.0, (1.0, 1.0, 1.0), (0.2, 0, 0))]
    model = bodies_alone(bodies, [bushing])
    q, w = model.q0.copy(), np.zeros_like(model.q0)
    q[3, 0:3] += x
    q[3, 6:9], w[3, 0:3], w[3, 6:9] = theta, v, rate
    return bushing_states(model, 0.0, q, w), model.forces(0.0, q, w, []).F[2:4]


@pytest.mark.parametrize("direction", range(6))
def test_law_in_each_direction(direction):
    """Axial, two shears, torsion, two bendings: F = -K x - C v + F0, on the second body, and nothing elsewhere."""
    size, speed, preload = 0.01, 0.3, np.arange(1.0, 7.0)
    given = [np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)]
    part, axis = direction // 3, direction % 3
    given[part][axis], given[2 + part][axis] = size, speed
    bushing = Bushing("a", "b", K, C, preload, first_point=(0.2, 0, 0), second_point=(0, 0, 0))
    state, _ = forces_at(bushing, *given)
    expected = preload.copy()
    expected[direction] += -K[direction] * size - C[direction] * speed
    np.testing.assert_allclose(state.force[0], expected, rtol=1e-12)
    np.testing.assert_allclose(np.delete(state.displacement[0], direction), 0, atol=1e-15)


@pytest.mark.parametrize("direction", range(6))
def test_play_is_free_and_stops_only_push(direction):
    """Inside the play nothing, outside -K (x - play) on both sides; opening faster than it springs back gives no pull."""
    part, axis = direction // 3, direction % 3
    bushing = Bushing("a", "b", K, C, play=0.01, first_point=(0.2, 0, 0), second_point=(0, 0, 0))

    def force(x, v=0.0):
        given = [np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)]
        given[part][axis], given[2 + part][axis] = x, v
        return forces_at(bushing, *given)[0].force[0, direction]

    assert force(0.0099, 5.0) == 0.0
    assert force(0.03) == pytest.approx(-0.02 * K[direction], rel=1e-12)
    assert force(-0.03) == pytest.approx(0.02 * K[direction], rel=1e-12)
    assert force(0.03, -1e6) == 0.0 == force(-0.03, 1e6)
    assert force(0.03, 2.0) == pytest.approx(-0.02 * K[direction] - 2.0 * C[direction], rel=1e-12)


def test_round_play_pushes_to_the_middle():
    """Off by 3-4-5 mm in a hole of 2 mm: 3 mm deep, towards the middle; one-sided play in the axis."""
    play = [(-0.001, 1.0), (-0.002, 0.002), (-0.002, 0.002), (0, 0), (0, 0), (0, 0)]
    bushing = Bushing("a", "b", K, 0, play=play, round_play=True, first_point=(0.2, 0, 0), second_point=(0, 0, 0))
    force = forces_at(bushing, (0.5, 0.003, -0.004))[0].force[0]
    np.testing.assert_allclose(force[:3], [0.0, -0.003 * 0.6 * K[1], 0.003 * 0.8 * K[1]], rtol=1e-12, atol=1e-12)


def test_rounded_corner_of_the_play():
    """Within the edge the force grows with the square of the depth, and after it is off by half the edge."""
    bushing = Bushing("a", "b", K, play=0.01, edge=(0.004, 0.1), first_point=(0.2, 0, 0), second_point=(0, 0, 0))
    for depth, stretch in ((0.002, 0.002**2 / 0.008), (0.004, 0.002), (0.01, 0.008)):
        force = forces_at(bushing, (0.01 + depth, 0, 0))[0].force[0, 0]
        assert force == pytest.approx(-K[0] * stretch, rel=1e-9)


def test_force_is_the_gradient_of_the_energy_and_balances():
    """Large turns of both bodies, points off their centres: virtual work, resultant and moment vanish; 1e-6 from differences."""
    rng = np.random.default_rng(2)
    bodies = [RigidBody(n, 1.0, (1.0, 1.0, 1.0), (0, 0, 0)) for n in "ab"]
    bushing = Bushing(
        "a",
        "b",
        K,
        0,
        np.arange(6.0),
        first_point=(0.1, 0.2, 0.3),
        second_point=(-0.2, 0.1, 0.0),
        axes=(0.3, -0.2, 0.5),
    )
    model = bodies_alone(bodies, [bushing])
    q, rest = model.q0.copy(), np.zeros_like(model.q0)
    q[2:4, 0:3], q[2:4, 6:9] = rng.normal(size=(2, 3)), rng.normal(size=(2, 3))
    F = model.forces(0.0, q, rest, []).F[2:4]
    for i in (2, 3):
        for k in (0, 1, 2, 6, 7, 8):
            d = np.zeros_like(q)
            d[i, k] = 1e-6
            slope = (model.forces(0.0, q + d, rest, []).bushing - model.forces(0.0, q - d, rest, []).bushing) / 2e-6
            assert slope == pytest.approx(F[i - 2, k], rel=1e-6, abs=1e-5)
    np.testing.assert_allclose(F[0, 0:3] + F[1, 0:3], 0, atol=1e-10)
    moment = np.zeros(3)
    for row in (0, 1):
        theta = q[2 + row, 6:9]
        T = np.empty((3, 3))
        for k in range(3):
            inverse_turn(theta, np.eye(3)[k], 1.0, T[:, k])
        moment += np.cross(q[2 + row, 0:3], F[row, 0:3]) + rotation_matrix(theta) @ T.T @ F[row, 6:9]
    np.testing.assert_allclose(moment, 0, atol=1e-9)


def test_tangent_is_the_derivative_of_the_force():
    """Bushing with play between a body and a node, a swivel, contact of a body: 2e-6 of the largest entry."""
    rng = np.random.default_rng(4)
    floor = Plane("floor", ContactLaw(1e4, 0.3), offset=0.5)
    bodies = [
        RigidBody(n, 2.0, (1.0, 1.2, 1.4), (0.1, 0.2, 0.3), points=[(0.1, 0, 0), (0, 0, 0.2)], contact_length=0.4)
        for n in "ab"
    ]
    from beam.joint import Joint

    play = (0.001, 0.01, 0.01, 0.0, 0.0, 0.1)
    model = bodies_alone(
        bodies, [Bushing("a", 1, K, C, play=play, round_play=True)], [Joint("swivel", "a", "b"), Joint("slider", "ground", "b")],
        surfaces=[floor],
    )  # fmt: skip
    shape = model.q0.shape
    q, v, a = model.q0 + 0.1 * rng.normal(size=shape), 0.1 * rng.normal(size=shape), 0.1 * rng.normal(size=shape)
    blocks = model.blocks()
    anchors = model.forces(0.0, q + 1e-6, v, model.fresh_anchors()).moved
    model.forces(0.0, q, v, anchors, blocks=blocks, factor=7.0, a=a, factor_a=30.0)
    n = len(q)
    A = np.zeros((n, 12, n, 12))
    for (i, j), s in blocks.pattern.slot.items():
        A[i, :, j] = blocks.store[s]
    used = model.system.used.ravel()
    expected = np.empty((12 * n, 12 * n))
    for k in range(12 * n):
        d = 1e-6 * np.eye(12 * n)[k].reshape(shape)
        plus = model.forces(0.0, q + d, v + 7 * d, anchors, a=a + 30 * d).F
        expected[:, k] = ((plus - model.forces(0.0, q - d, v - 7 * d, anchors, a=a - 30 * d).F) / 2e-6).ravel()
    A, expected = A.reshape(12 * n, 12 * n)[used][:, used], expected[used][:, used]
    np.testing.assert_allclose(A, expected, rtol=0, atol=2e-6 * np.abs(expected).max())


@pytest.mark.parametrize("angle", [1e-5, 1e-2, 1.0, 2.5, 3.1])
def test_relative_rotation_vector_and_its_rate(angle):
    """The rotation vector of Q, in every branch of its formula, and phi' = T^-1 omega against a difference."""
    for axis in np.eye(3):
        axis = (axis + 0.1) / np.linalg.norm(axis + 0.1)
        phi, frame, P, D = np.empty(3), np.eye(3), np.empty((2, POSE)), np.empty(RELATIVE)
        rate = np.array([0.3, -0.2, 0.5])

        def look(t, axis=axis, P=P, D=D, rate=rate, frame=frame):
            pose(np.zeros(6), np.zeros(6), np.zeros(3), frame, P[0])
            pose(
                np.concatenate([np.zeros(3), angle * axis + t * rate]),
                np.concatenate([np.zeros(3), rate]),
                np.zeros(3),
                frame,
                P[1],
            )
            relative(P[0], P[1], D)

        look(0.0)
        rotation_vector_of(D[6:15], phi)
        np.testing.assert_allclose(phi, angle * axis, rtol=0, atol=1e-12)
        out = np.empty(3)
        inverse_turn(phi, D[15:18], 1.0, out)
        np.testing.assert_allclose(out, rate, rtol=0, atol=1e-11)


def test_static_answer_has_the_preload_and_the_weight():
    """A body hung on a bushing: x = (m g + F0) / K; damping does not change it."""
    body = RigidBody("a", 2.0, (1.0, 1.0, 1.0), (0, 0, 0))
    for c in (0.0, 50.0):
        model = bodies_alone([body], [Bushing("ground", "a", K, c, (0, 5.0, 0, 0, 0, 0.5))], gravity=(0, -9.81, 0))
        rest = equilibrium(model)
        rest.outcome.require_success()
        assert rest.q[2, 1] == pytest.approx((5.0 - 2 * 9.81) / K[1], rel=1e-6)
        assert rest.q[2, 8] == pytest.approx(0.5 / K[5], rel=1e-6)


def test_energy_of_a_body_between_stops():
    """It flies, hits stops with play and damping, is driven by a moving ground: balance to 1e-6 of what is exchanged."""
    body = RigidBody("a", 1.0, (0.01, 0.012, 0.014), (0, 0, 0), velocity=(0.5, 0.2, 0), spin=(0.3, -0.4, 2.0))

    def shake(t):
        u = np.array([0.01 * (1 - np.cos(20 * t)), 0, 0])
        return u, np.array([0.2 * np.sin(20 * t), 0, 0]), np.array([4 * np.cos(20 * t), 0, 0])

    play = (0.002, 0.002, 0.01, 0.0, 0.0, 0.05)
    bushing = Bushing(
        "ground",
        "a",
        (5e3, 5e3, 5e3, 2.0, 2.0, 20.0),
        (3, 3, 3, 1e-3, 1e-3, 2e-3),
        play=play,
        edge=(1e-3, 0.02),
        travel=shake,
    )
    model = bodies_alone([body], [bushing])
    motion = Integrator(model, model.q0, settings=StepSettings(2e-5, adaptive=False, relative=1e-9, absolute=1e-7))
    assert motion.advance(2500)
    totals = motion.ledger.totals
    assert totals["bushing_damping_loss"] > 1e-2 and totals["drive_work"] != 0.0
    assert abs(motion.ledger.balance_error) < 1e-6


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"stiffness": -1.0}, "stiffness must be one or six finite numbers of zero or more"),
        ({"stiffness": (1.0, 2.0)}, "stiffness must be one or six"),
        ({"play": -0.1}, "play must be half widths"),
        ({"rest": "now"}, "rest is 'axes' or 'start'"),
        ({"round_play": True, "play": (0, 0.1, 0.2, 0, 0, 0)}, "same play in directions 2 and 3"),
        ({"second": "c"}, "refers to the body 'c'; the bodies are: a, b"),
        ({"second": 7}, "refers to node 7; the rod has the nodes 0 to 1"),
        ({"second": "a"}, "connects a with itself"),
    ],
)
def test_wrong_bushings_are_refused(change, sentence):
    """One sentence each."""
    given = {"first": "a", "second": "b", "stiffness": 1.0} | change
    bodies = [RigidBody(n, 1.0, (1.0, 1.0, 1.0), (0, 0, 0)) for n in "ab"]
    with pytest.raises(SpecError, match=sentence):
        bodies_alone(bodies, [Bushing(**given)])


def test_support_of_an_unknown_body_or_field():
    """A body that is not there, a field that bodies have not."""
    body = RigidBody("a", 1.0, (1.0, 1.0, 1.0), (0, 0, 0))
    with pytest.raises(SpecError, match="refers to the body 'z'"):
        bodies_alone([body], supports=[Support("z")])
    with pytest.raises(SpecError, match='no field "r\'" that could be held'):
        bodies_alone([body], supports=[Support("a", ("r'",))])

"""The tangent is the derivative of the force, for the elastic rod with damping and for contact that sticks and slips."""

import numpy as np
import pytest

from beam.rod import Rod
from beam.rod_model import Blocks, RodModel
from beam.section_law import DampingTimes
from beam.shape import straight
from beam.strain import gauss_force
from beam.surface import ContactLaw, Cylinder, Plane
from homogenize.section_stiffness import SectionInertia, SectionStiffness


def coupled_section() -> SectionStiffness:
    C = np.diag([2e3, 3e3, 9e3, 40.0, 50.0, 30.0])
    C[2, 5] = C[5, 2] = 120.0
    C[0, 4] = C[4, 0] = 35.0
    return SectionStiffness(C, 1e-3)


def model_and_state(surfaces=()):
    rod = Rod.straight(1.2, 3, coupled_section(), SectionInertia(2.0, 1e-3, 1e-3, 2e-3), DampingTimes(1e-3, 3e-3))
    model = RodModel(rod, straight(rod.s), surfaces=surfaces)
    rng = np.random.default_rng(7)
    q = model.q0 + 0.3 * rng.normal(size=model.q0.shape) * np.repeat([0.01, 0.1, 1.0, 1.0], 3)
    q[:, 1] = -2e-3
    v = 0.1 * rng.normal(size=q.shape)
    return model, q, v


def dense(blocks: Blocks) -> np.ndarray:
    n = blocks.D.shape[0]
    A = np.zeros((n, 12, n, 12))
    for i in range(n):
        A[i, :, i] = blocks.D[i]
        if i + 1 < n:
            A[i, :, i + 1], A[i + 1, :, i] = blocks.U[i], blocks.L[i]
    return A.reshape(12 * n, 12 * n)


def differences(model, q, v, anchors, factor, step=1e-6) -> np.ndarray:
    """Central differences of F along q and v = factor q at once."""
    columns = []
    for k in range(q.size):
        d = np.zeros(q.size)
        d[k] = step
        d = d.reshape(q.shape)
        plus = model.forces(0.0, q + d, v + factor * d, anchors).F
        minus = model.forces(0.0, q - d, v - factor * d, anchors).F
        columns.append(((plus - minus) / (2 * step)).ravel())
    return np.array(columns).T


def assert_consistent(model, q, v, anchors, factor, rtol):
    blocks = Blocks.zeros(model.rod.nodes)
    model.forces(0.0, q, v, anchors, blocks=blocks, factor=factor)
    expected = differences(model, q, v, anchors, factor)
    np.testing.assert_allclose(dense(blocks), expected, rtol=0, atol=rtol * np.abs(expected).max())


@pytest.mark.parametrize("factor", [0.0, 40.0])
def test_rod_with_coupling_and_damping(factor):
    """Random bent, twisted, moving state; 1e-6 of the largest entry is the accuracy of both differences."""
    model, q, v = model_and_state()
    assert_consistent(model, q, v, [], factor, 2e-6)


@pytest.mark.parametrize(("slip", "speed"), [(1e-7, 0.0), (1e-2, 0.05), (1e-2, -0.05)])
def test_floor_contact_in_stick_and_slip(slip, speed):
    """Anchors a little (stick) or far (slip) behind the contact points; slip that goes on, and one that just turns round.

    The speed keeps the differences off the corner between the two: the bristle's damping acts in the way back only.
    """
    law = ContactLaw(stiffness=1e5, friction=0.4, damping_time=1e-3)
    model, q, v = model_and_state([Plane("floor", law)])
    q[:, 3:6] = [1.0, 0.0, 0.0]
    anchors = [a.copy() for a in model.forces(0.0, q, v, model.fresh_anchors(), friction=False).moved]
    anchors = model.forces(0.0, q, 0.0 * v, anchors).moved
    for a in anchors:
        a[..., 0] -= slip
        a[..., 2] += 0.4 * slip
    v *= 1e-3
    v[:, 0] += speed
    v[:, 2] -= 0.4 * speed
    cones = model.forces(0.0, q, v, anchors).cones[0]
    assert (cones.max() >= 1 - 1e-12) == (speed > 0)
    assert_consistent(model, q, v, anchors, 25.0, 1e-5)


def test_cylinder_contact():
    """Frictionless cylinder: the curvature of the surface enters the tangent."""
    model, q, v = model_and_state([Cylinder("roller", ContactLaw(stiffness=1e5), (0.6, -0.3, 0.0), 0.306)])
    q[:, 1] = 0.0
    q[:, 3:6] = [1.0, 0.0, 0.0]
    forces = model.forces(0.0, q, v, model.fresh_anchors())
    assert forces.penetration > 1e-3
    assert_consistent(model, q, 0.01 * v, forces.moved, 25.0, 1e-5)


def test_force_is_the_gradient_of_the_energy():
    """Without damping f = dW/dz at one point, for |theta| below and above the switch to series."""
    rng = np.random.default_rng(3)
    A = rng.normal(size=(6, 6))
    C = A @ A.T + 6 * np.eye(6)
    E, rate, S, f = np.zeros(6), np.zeros(6), np.zeros(6), np.zeros(9)
    for size in (0.01, 1.0, 4.0):
        z = rng.normal(size=9)
        z[:3] *= size / np.linalg.norm(z[:3])
        gauss_force(z, np.zeros(9), C, 0 * C, np.zeros(6), E, rate, S, f)
        gradient = f.copy()
        for k in range(9):
            d = 1e-5 * np.eye(9)[k]
            plus, _ = gauss_force(z + d, np.zeros(9), C, 0 * C, np.zeros(6), E, rate, S, f)
            minus, _ = gauss_force(z - d, np.zeros(9), C, 0 * C, np.zeros(6), E, rate, S, f)
            assert (plus - minus) / 2e-5 == pytest.approx(gradient[k], rel=1e-7, abs=1e-7)


def test_strain_rate_is_the_derivative_of_the_strain():
    """dE/dt along a straight path in z, by central differences."""
    rng = np.random.default_rng(5)
    z, zdot, C = rng.normal(size=9), rng.normal(size=9), np.eye(6)
    work = [np.zeros(6) for _ in range(3)]
    E_plus, E_minus, rate, f = np.zeros(6), np.zeros(6), np.zeros(6), np.zeros(9)
    gauss_force(z + 1e-6 * zdot, zdot, C, C, work[0], E_plus, work[1], work[2], f)
    gauss_force(z - 1e-6 * zdot, zdot, C, C, work[0], E_minus, work[1], work[2], f)
    gauss_force(z, zdot, C, C, work[0], work[1], rate, work[2], f)
    np.testing.assert_allclose(rate, (E_plus - E_minus) / 2e-6, rtol=1e-7, atol=1e-8)

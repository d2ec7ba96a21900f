"""Rotary inertia of the section: a short stiff rod is a free rigid body (Euler's equations), with gyroscopic moments."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from beam import point_force as lanes
from beam.generalized_alpha import Integrator, StepSettings
from beam.rod import Rod
from beam.rod_model import RodModel
from beam.rotation_vector import rotation_coefficients, rotation_matrix
from beam.shape import straight
from beam.strain import gauss_force, rotary_inertia
from homogenize.section_stiffness import SectionInertia, SectionStiffness

J = np.array([0.5, 0.9, 0.3])
"""Per length about e1, e2, e3 [kg m]."""
M, LENGTH = 1.2, 1.0


def free_rod() -> RodModel:
    section = SectionStiffness.uncoupled(EA=1e6, GA_x=1e6, GA_y=1e6, EI_x=1e5, EI_y=1e5, GJ=1e5, area=1e-3)
    rod = Rod.straight(LENGTH, 2, section, SectionInertia(M, J[1], J[2], J[0]))
    return RodModel(rod, straight(rod.s, start=(-LENGTH / 2, 0, 0)))


def spinning(omega: np.ndarray, h: float, end: float) -> Integrator:
    """The free rod after a start that turns as a whole with `omega`."""
    model = free_rod()
    v = np.zeros_like(model.q0)
    v[:, 0:3], v[:, 3:6] = np.cross(omega, model.q0[:, 0:3]), np.cross(omega, model.q0[:, 3:6])
    v[:, 6:9] = omega
    # theta' = 0 and theta = 0 everywhere: R^T omega is the same for all sections, so that theta'_dot = 0
    settings = StepSettings(h, adaptive=False, spectral_radius=0.8, absolute=1e-8, relative=1e-11)
    motion = Integrator(model, model.q0, v=v, settings=settings)
    assert motion.advance(round(end / h)), str(motion.outcome)
    return motion


def euler(omega: np.ndarray, end: float) -> np.ndarray:
    """R at the end, of a rigid body with the rod's inertia."""
    inertia = J * LENGTH + M * LENGTH**3 / 12 * np.array([0, 1, 1])

    def rate(_, y):
        R, w = y[:9].reshape(3, 3), y[9:]
        hat = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        return np.concatenate([(R @ hat).ravel(), -np.cross(w, inertia * w) / inertia])

    start = np.concatenate([np.eye(3).ravel(), omega])
    return solve_ivp(rate, (0, end), start, rtol=1e-11, atol=1e-12).y[:9, -1].reshape(3, 3)


OMEGA = np.array([6.0, 0.05, 0.02])
"""Close to the middle axis of inertia (0.5 between 0.4 and 1.0 kg m^2): it tumbles."""


def test_middle_axis_tumbles_like_a_rigid_body():
    """Three seconds, about three turns and a tumble: the section turns as by Euler's equations, error of second order."""
    end = 3.0
    exact = euler(OMEGA, end)
    assert exact[2, 2] < 0.5 or exact[1, 1] < 0.5
    errors = [np.abs(rotation_matrix(spinning(OMEGA, h, end).q[1, 6:9]) - exact).max() for h in (4e-3, 2e-3)]
    assert errors[1] < 0.05
    assert 3.0 < errors[0] / errors[1] < 5.0


def test_energy_and_angular_momentum_are_kept():
    """Kinetic energy and the momentum r x m v + R J omega over two seconds, to 1e-3 at 2 ms (second order in the step)."""
    inertia = J * LENGTH + M * LENGTH**3 / 12 * np.array([0, 1, 1])
    energy = 0.5 * np.sum(inertia * OMEGA**2)
    for h, bound in ((4e-3, 2e-3), (2e-3, 5e-4)):
        motion = spinning(OMEGA, h, 2.0)
        assert motion.ledger.totals["kinetic"] == pytest.approx(energy, rel=bound)
        R = rotation_matrix(motion.q[1, 6:9])
        theta, rate = motion.q[1, 6:9], motion.v[1, 6:9]
        _, b, c, _, _ = rotation_coefficients(float(theta @ theta))
        x = np.cross(theta, rate)
        omega = rate - b * x + c * np.cross(theta, x)
        np.testing.assert_allclose(R @ (inertia * omega), inertia * OMEGA, rtol=0, atol=bound * 6)


def test_eight_points_at_once_are_the_formulas():
    """point_forces against gauss_force and rotary_inertia at eight random states: round-off."""
    rng = np.random.default_rng(2)
    A = rng.normal(size=(6, 6))
    C, D = A @ A.T, 0.1 * A.T @ A
    z, zdot, acc, E0 = (rng.normal(size=(8, k)) for k in (9, 9, 3, 6))
    W, H = np.zeros(lanes.END), np.zeros((1, 8))
    H[0, 0] = H[0, 5] = 1.0  # the first node's values and slopes
    order = [6, 7, 8, 9, 10, 11, 3, 4, 5]
    for k in range(9):
        W[order[k] * lanes.ROW :][:8], W[(12 + order[k]) * lanes.ROW :][:8] = z[:, k], zdot[:, k]
    for k in range(3):
        W[(30 + k) * lanes.ROW :][:8] = acc[:, k]
    W[lanes.LENGTH : lanes.LENGTH + 16] = 1.0
    W[lanes.REST : lanes.SHIFT] = E0.T.ravel()
    W[lanes.STIFF : lanes.DAMP], W[lanes.DAMP : lanes.FORCE] = np.repeat(C, 8), np.repeat(D, 8)
    lanes.point_forces(W, H, 0, 1.0, J[0], J[1], J[2], 0.0, 0.0)
    for k in range(8):
        E, rate, S, f, g = np.zeros(6), np.zeros(6), np.zeros(6), np.zeros(9), np.zeros(9)
        energies = gauss_force(z[k], zdot[k], C, D, E0[k], E, rate, S, f)
        rotary_inertia(z[k], zdot[k], acc[k], J, g)
        np.testing.assert_allclose(W[lanes.ENERGY + k :: 8][:2], energies, rtol=1e-12)
        np.testing.assert_allclose(W[lanes.FORCE + k :: 8][:9], f + g, rtol=1e-11, atol=1e-11)
        np.testing.assert_allclose(W[lanes.SECTION + k :: 8][:6], S, rtol=1e-11, atol=1e-11)


def test_rotary_inertia_is_the_derivative_of_angular_momentum():
    """T^T R^T d(R J omega)/dt by central differences along a motion of the rotation vector (1e-6 from the differences)."""
    h = 1e-4
    theta0, rate0, acc = np.array([0.8, -1.1, 0.5]), np.array([0.7, 0.4, -1.3]), np.array([0.3, -0.2, 0.9])

    def momentum(t):
        theta, rate = theta0 + t * rate0 + 0.5 * t * t * acc, rate0 + t * acc
        _, b, c, _, _ = rotation_coefficients(float(theta @ theta))
        x = np.cross(theta, rate)
        return rotation_matrix(theta) @ (J * (rate - b * x + c * np.cross(theta, x)))

    f, z, zdot = np.zeros(9), np.zeros(9), np.zeros(9)
    z[:3], zdot[:3] = theta0, rate0
    rotary_inertia(z, zdot, acc, J, f)
    _, b, c, _, _ = rotation_coefficients(float(theta0 @ theta0))
    torque = rotation_matrix(theta0).T @ ((momentum(h) - momentum(-h)) / (2 * h))
    x = np.cross(theta0, torque)
    np.testing.assert_allclose(f[:3], torque + b * x + c * np.cross(theta0, x), rtol=0, atol=1e-6)

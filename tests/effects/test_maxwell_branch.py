"""Maxwell branches: exponential relaxation, complex modulus, and a step that is exact on straight paths."""

import numpy as np
import pytest

from effects.maxwell_branch import maxwell_record, maxwell_step


def test_relaxation_is_exponential():
    """A sudden strain held: q = exp(-t/tau), at uneven instants."""
    t = np.array([0.0, 0.1, 0.5, 1.7, 1.75, 4.0])
    tau = np.array([0.5, 3.0])
    np.testing.assert_allclose(maxwell_record(np.ones(6), t, tau), np.exp(-t[:, None] / tau), rtol=1e-13)


def test_ramp():
    """A strain that grows at rate r: q = r tau (1 - exp(-t/tau)), whatever the steps."""
    t = np.array([0.0, 0.3, 0.31, 2.0, 5.0])
    np.testing.assert_allclose(maxwell_record(2.0 * t, t, np.array([0.7]))[:, 0], -1.4 * np.expm1(-t / 0.7), rtol=1e-13)


@pytest.mark.parametrize("w_tau", [0.1, 1.0, 10.0])
def test_complex_modulus(w_tau):
    """A steady sine: storage (w tau)^2/(1 + (w tau)^2), loss w tau/(1 + (w tau)^2); chords of 800 samples a period: 1e-5."""
    periods, n = 12, 800
    t = np.linspace(0.0, 2 * np.pi * periods, periods * n + 1)
    # long after the start; the slowest branch has forgotten it after 12 periods by exp(-12 * 2 pi / 10) = 5e-4
    q = maxwell_record(np.sin(t), t, np.array([w_tau]))[-n:, 0]
    t = t[-n:]
    storage, loss = 2 * np.mean(q * np.sin(t)), 2 * np.mean(q * np.cos(t))
    expected = np.array([w_tau**2, w_tau]) / (1 + w_tau**2)
    np.testing.assert_allclose([storage, loss], expected, rtol=2e-5, atol=5e-5)


def test_independent_of_the_steps():
    """Finer samples on the same straight path change nothing."""
    corners = np.random.default_rng(0).normal(size=40)
    t = np.cumsum(np.random.default_rng(1).uniform(0.1, 1.0, size=40))
    fine_t = np.interp(np.linspace(0, 39, 313), np.arange(40), t)
    fine = np.interp(fine_t, t, corners)
    tau = np.array([0.05, 1.0, 100.0])
    np.testing.assert_allclose(maxwell_record(fine, fine_t, tau)[::8], maxwell_record(corners, t, tau), atol=1e-12)


def test_limits():
    """Very slow branches are springs, very fast ones dashpots of viscosity tau."""
    t = np.linspace(0.0, 1.0, 101)
    strain = t**2
    slow = maxwell_record(strain, t, np.array([1e9]))[:, 0]
    fast = maxwell_record(strain, t, np.array([1e-6]))[:, 0]
    np.testing.assert_allclose(slow, strain, atol=1e-8)
    np.testing.assert_allclose(fast[1:], 1e-6 * np.diff(strain) / 0.01, rtol=1e-9)


def test_points_and_record_agree():
    """Many points stepped together, with steps of different length, one of them without duration."""
    rng = np.random.default_rng(5)
    strain, h = rng.normal(size=(30, 4)), rng.uniform(0.01, 2.0, size=30)
    h[0] = 0.0
    tau = np.array([0.1, 1.0, 10.0])
    q, before = np.zeros((4, 3)), np.zeros(4)
    for i in range(30):
        q = maxwell_step(q, strain[i] - before, h[i], tau)
        before = strain[i]
    for p in range(4):
        np.testing.assert_allclose(q[p], maxwell_record(strain[:, p], np.cumsum(h), tau)[-1], atol=1e-13)

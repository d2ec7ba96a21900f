"""Stick-slip elements: Masing's rule, loop energy, independence of rate, and the exact return of a hardening limit."""

from itertools import pairwise

import numpy as np
import pytest

from effects.slip_element import hardening_record, hardening_step, slip_record, slip_step


def cycle(amplitude: float, cycles: int, n: int) -> np.ndarray:
    """Zigzag between +amplitude and -amplitude from 0, n steps a quarter, every turning point a sample."""
    corners = amplitude * np.array([0.0, *[1.0, -1.0] * cycles, 1.0])
    parts = [np.linspace(a, b, (n if i == 0 else 2 * n) + 1)[1:] for i, (a, b) in enumerate(pairwise(corners))]
    return np.concatenate([[0.0], *parts])


def loop_energy(strain: np.ndarray, stress: np.ndarray, n: int) -> float:
    """Area of the last closed loop (4 n steps), trapezoidal, exact where the stress is straight between samples."""
    return float(np.trapezoid(stress[-4 * n - 1 :], strain[-4 * n - 1 :]))


@pytest.mark.parametrize("slip", [0.2, 0.5, 0.9])
def test_loop_energy(slip):
    """A closed loop of amplitude A costs 4 x (A - x) per unit stiffness; samples hit every kink, so rtol is rounding."""
    n = 40
    strain = cycle(1.0, 2, n)
    stress = slip_record(strain, np.array([slip]), np.ones(strain.size))[:, 0]
    np.testing.assert_allclose(loop_energy(strain, stress, n), 4 * slip * (1.0 - slip), rtol=1e-12)


def test_no_loop_below_the_slip_limit():
    """Below the limit the element is elastic."""
    strain = cycle(0.3, 3, 20)
    stress = slip_record(strain, np.array([0.31]), np.ones(strain.size))[:, 0]
    np.testing.assert_allclose(stress, strain, atol=1e-15)


def test_masing_rule():
    """Every branch after a turn is the first loading curve, twice as large in both directions."""
    slip, strength = np.geomspace(0.05, 0.8, 6), np.linspace(1.0, 0.3, 6)
    n = 200
    strain = cycle(1.0, 1, n)
    stress = slip_record(strain, slip, np.ones(strain.size)) @ strength
    turn, back = n, slice(n, 3 * n + 1)
    first = np.minimum(((strain[turn] - strain[back]) / 2)[:, None], slip) @ strength
    np.testing.assert_allclose(stress[turn] - stress[back], 2 * first, atol=1e-12)


def test_independent_of_rate_and_sampling():
    """Ten times as many samples on the same straight steps change nothing at the old samples."""
    corners = np.random.default_rng(1).normal(size=60)
    fine = np.interp(np.linspace(0, 59, 591), np.arange(60), corners)
    slip = np.array([0.1, 0.7, 2.0])
    coarse = slip_record(corners, slip, np.ones(60))
    np.testing.assert_allclose(slip_record(fine, slip, np.ones(591))[::10], coarse, atol=1e-12)


def test_limit_that_falls_takes_the_stress_with_it():
    """When the grip loosens, the stress drops to the new limit without a strain; it does not come back with the grip."""
    strain, ratio = np.full(4, 1.0), np.array([1.0, 1.0, 0.4, 1.0])
    stress = slip_record(strain, np.array([0.8]), ratio)[:, 0]
    np.testing.assert_allclose(stress, [0.8, 0.8, 0.32, 0.32], rtol=1e-14)


def test_hardening_slope_and_reversal():
    """Beyond yield the slope is h/(1 + h); after a turn it yields at twice the limit reached."""
    x, h = 0.3, 0.25
    stress = hardening_record(np.array([0.0, 1.3, 1.3 - 2 * 0.5 + 1e-9, 0.0, -1.0]), x, h)[:, 0]
    top = x + h / (1 + h) * (1.3 - x)
    np.testing.assert_allclose(top, 0.5, rtol=1e-14)
    np.testing.assert_allclose(stress[1], top, rtol=1e-14)
    np.testing.assert_allclose(stress[2], -top, atol=2e-9)
    np.testing.assert_allclose(stress[4], -top - h / (1 + h) * 1.3, rtol=1e-12)


def test_hardening_shakes_down():
    """Isotropic hardening under a constant amplitude ends elastic: the last loops lose less than 1e-6 of the first."""
    n = 30
    strain = cycle(1.0, 60, n)
    stress = hardening_record(strain, 0.2, 0.5)[:, 0]
    first = np.trapezoid(stress[n : 5 * n + 1], strain[n : 5 * n + 1])
    assert abs(loop_energy(strain, stress, n)) < 1e-6 * first
    np.testing.assert_allclose(np.abs(stress).max(), 1.0, rtol=1e-3)


def test_no_hardening_is_the_plain_element():
    """h = 0 gives the stop operator."""
    strain = np.random.default_rng(2).normal(size=200)
    plain = slip_record(strain, np.array([0.6]), np.ones(200))
    np.testing.assert_allclose(hardening_record(strain, 0.6, 0.0), plain, atol=1e-13)


def test_points_and_record_agree():
    """Many points stepped together give the records of each: a second implementation, with clip instead of branches."""
    rng = np.random.default_rng(3)
    strain, ratio = rng.normal(size=(80, 5)), rng.uniform(0.0, 2.0, size=(80, 5))
    slip = np.array([0.2, 1.0, 3.0])
    stress, before = np.zeros((5, 3)), np.zeros(5)
    s, growth = np.zeros(5), np.zeros(5)
    for i in range(80):
        stress = slip_step(stress, strain[i] - before, slip, ratio[i])
        s, growth = hardening_step(s, growth, strain[i] - before, 0.4, 0.1)
        before = strain[i]
    for p in range(5):
        np.testing.assert_allclose(stress[p], slip_record(strain[:, p], slip, ratio[:, p])[-1], atol=1e-13)
        np.testing.assert_allclose(s[p], hardening_record(strain[:, p], 0.4, 0.1)[-1, 0], atol=1e-13)

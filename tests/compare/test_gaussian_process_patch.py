"""A Gaussian process gives back a smooth function between its points and zero far away; a patch mends only in range."""

from __future__ import annotations

import numpy as np
import pytest
from made_bent_cable import EI, bent_campaign, compared

from compare.gaussian_process_patch import GaussianProcess, patch_error, refit_error


def linear(b):
    return EI * b.k


def bent_with_a_spring(b):
    """A cubic law of the curvature alone, which a patch can learn."""
    return EI * b.k * (1 + 0.1 * b.k**2)


def test_it_interpolates_a_smooth_function_and_falls_back_to_zero():
    rng = np.random.default_rng(0)
    X = rng.uniform(-2, 2, (150, 2))
    y = np.sin(2 * X[:, 0]) * X[:, 1]
    gp = GaussianProcess.fit(X, y)
    new = rng.uniform(-1.5, 1.5, (50, 2))
    # 150 points are 0.3 apart, the wave is 3 long
    np.testing.assert_allclose(gp(new), np.sin(2 * new[:, 0]) * new[:, 1], atol=0.02)
    assert abs(gp(np.array([[60.0, 60.0]]))[0]) < 1e-9


def test_marginal_likelihood_finds_the_noise():
    """Its share of the variance of a wave of variance 1/2 with noise of 0.3: the process is not fitted to the noise."""
    rng = np.random.default_rng(1)
    x = np.linspace(0, 12, 240)[:, None]
    gp = GaussianProcess.fit(x, np.sin(x[:, 0]) + rng.normal(0, 0.3, 240))
    # some ten free numbers learnt from 240 samples leave 0.3 sqrt(10/240) = 0.06
    assert np.sqrt(np.mean((gp(x) - np.sin(x[:, 0])) ** 2)) < 0.12


def test_nothing_to_learn_is_left_alone():
    """On noise the patch neither helps nor harms: one per cent of the floor is the scatter of 400 samples' mean."""
    comparison = compared(bent_campaign(linear))
    assert patch_error(comparison, "validate") == pytest.approx(comparison.relative_error("validate"), rel=0.03)


def test_in_range_the_patch_reaches_the_floor_and_the_refit_does_not():
    comparison = compared(bent_campaign(bent_with_a_spring, noise=0.5))
    base, patch, refit = (
        f(comparison, "validate") for f in (type(comparison).relative_error, patch_error, refit_error)
    )
    assert base is not None and patch is not None and refit is not None
    assert base > 4 and patch < 0.5 * base
    assert patch < refit < base


def test_the_refit_is_the_least_squares_line():
    """With white noise no other stiffness leaves less."""
    comparison = compared(bent_campaign(bent_with_a_spring, noise=0.5))
    fits = [f for f in comparison.fits if f.experiment.set == "validate"]
    k = np.concatenate([f.experiment.record["curvature"] for f in fits])
    y = np.concatenate([f.measured for f in fits])
    left = np.sqrt(np.mean((y - k * (k @ y) / (k @ k)) ** 2)) / fits[0].noise_floor
    # the fitted noise may carry some gain and phi, which weighs the samples a little differently
    assert refit_error(comparison, "validate") == pytest.approx(left, rel=0.01)
    own = comparison.relative_error("calibrate")
    assert refit_error(comparison, "calibrate") == pytest.approx(own, rel=1e-6)


def test_an_empty_set_has_no_error():
    comparison = compared(bent_campaign(linear))
    assert patch_error(comparison, "sealed") is None and refit_error(comparison, "sealed") is None


def test_it_is_deterministic():
    comparison = compared(bent_campaign(bent_with_a_spring))
    assert patch_error(comparison, "validate") == patch_error(comparison, "validate")

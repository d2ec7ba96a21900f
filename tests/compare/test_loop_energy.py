"""Energy of a loop is the area that load and path enclose; amplitude and mean rate of a cyclic path in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from made_campaign import made_campaign, made_experiment
from made_findings import made_findings

from compare import BenchModel, compare
from compare.loading import amplitude, loop_energy, mean_rate


def cycle(cycles: float, n: int = 2001, lag: float = 0.4):
    """Fit of a bending loop M = 50 sin(wt + lag) over kappa = 0.8 sin(wt)."""
    t = np.linspace(0, 2 * np.pi * cycles, n)
    channels = {"curvature": 0.8 * np.sin(t), "moment": 50 * np.sin(t + lag)}
    campaign = made_campaign([made_experiment("a", "bending", "curvature", channels)])
    return compare(BenchModel(campaign.section), campaign).fits[0]


@pytest.mark.parametrize("cycles", [1, 2, 5])
def test_an_ellipse_encloses_pi_a_b_sin_of_its_phase(cycles):
    expected = np.pi * 0.8 * 50 * np.sin(0.4)
    assert loop_energy(cycle(cycles)) == pytest.approx(expected, rel=2e-3)  # trapezoids, 400 a cycle


def test_a_linear_model_loses_nothing():
    assert loop_energy(cycle(2), model=True) == pytest.approx(0.0, abs=1e-9)


def test_a_path_that_does_not_close_has_no_loop():
    assert loop_energy(cycle(1.2)) is None
    assert loop_energy(cycle(0.25)) is None


def test_amplitude_and_mean_rate_of_a_sine():
    """Mean size of the rate of a sine is 4 amplitudes a period."""
    fit = made_findings("identified").comparison.fits[2]  # 0.8 1/m, two cycles in 60 s
    assert amplitude(fit.experiment) == pytest.approx(0.8, rel=1e-3)
    assert mean_rate(fit.experiment) == pytest.approx(4 * 0.8 * 2 / 60, rel=5e-3)


def test_without_a_clock_there_is_no_rate():
    assert np.isnan(mean_rate(cycle(1).experiment))

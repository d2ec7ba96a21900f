"""Misfit over the noise floor: nothing is found where nothing is missing, and what is missing is found with its size."""

from __future__ import annotations

import numpy as np
import pytest
from made_campaign import NOMINAL, made_campaign, made_experiment, null_pulls

from compare import BenchModel, NoiseCovariance, NominalSection, compare
from compare.misfit import misfit

MODEL = BenchModel(NominalSection(NOMINAL))
X = np.sin(np.linspace(0, 12, 200))


def test_rmse_bias_and_excess_by_hand():
    noise = NoiseCovariance(s=3.0, offset=4.0)  # floor 5
    found = misfit(np.array([13.0, 13.0, -13.0, 39.0]), np.array([0.0, 0.0, 0.0, 26.0]), noise)
    assert (found.rmse, found.bias, found.excess) == (13.0, 6.5, 12.0)  # 5-12-13


def test_excess_below_the_floor_is_zero():
    assert misfit(0.1 * X, 0 * X, NoiseCovariance(s=1.0)).excess == 0.0


@pytest.fixture(scope="module")
def null_comparisons():
    """Thirty campaigns without a missing effect, noise with gain, offset and correlation, and a nominal EA 25 % off."""
    from conftest import record_noise

    rng = np.random.default_rng(11)

    def noise(m):
        return record_noise(rng, m, 15.0, 0.5, 0.01, 12.0)

    return [compare(MODEL, made_campaign(null_pulls(rng, noise, 5.3e5, groups=6))) for _ in range(30)]


def test_null_excess_is_zero_on_average(null_comparisons):
    """Mean square residual minus mean square noise floor, over all records, is zero within four standard errors.

    The fit of one stiffness to 12 records takes a little away, which the bound on the left allows for.
    """
    gap = np.array([f.after.rmse**2 / f.noise_floor**2 - 1 for c in null_comparisons for f in c.fits])
    assert -0.15 < gap.mean() < 4 * gap.std() / np.sqrt(gap.size)
    assert gap.std() / np.sqrt(gap.size) < 0.05


def test_chance_of_a_null_misfit_is_rarely_small(null_comparisons):
    """P(chance < p) <= p for a valid chance; 360 records in which repeats share the estimated noise."""
    chance = np.array([f.after.chance for c in null_comparisons for f in c.fits])
    assert (chance < 0.05).mean() < 0.08  # 0.05 + 2.6 standard errors
    assert (chance < 0.005).mean() < 0.015
    assert (chance < 0.5).mean() > 0.25, "but it is a probability, not always near one"


def test_null_campaigns_fail_nowhere(null_comparisons):
    """The gate lets 1 % of the null campaigns through: more than two of thirty has a probability of 0.3 %."""
    assert sum(bool(c.where_it_fails()) for c in null_comparisons) <= 2


def test_null_lack_of_fit_is_uniform(null_comparisons):
    p = np.array([c.lack_of_fit["tension", "force"].p for c in null_comparisons])
    assert (p < 0.05).mean() <= 0.17  # 30 campaigns: 0.05 +- 0.04
    assert 0.3 < p.mean() < 0.7


def test_null_bias_is_within_its_uncertainty(null_comparisons):
    within = [abs(f.after.bias) <= f.bias_uncertainty for c in null_comparisons for f in c.fits]
    assert 0.9 < np.mean(within) <= 1.0


def test_wrong_nominal_stiffness_is_no_excess(null_comparisons):
    for comparison in null_comparisons:
        before, after = comparison.relative_error("calibrate", before=True), comparison.relative_error("calibrate")
        assert before is not None and after is not None
        assert before > 5 * after


def with_loop(rng, size):
    """Two pairs of bending loops with a friction-like part of constant size."""
    loops = []
    for g in range(2):
        for r in (0, 1):
            moment = 50 * X + size * np.sign(np.cos(np.linspace(0, 12, 200))) + rng.normal(size=X.size)
            of = f"g{g}r0" if r else None
            loops.append(
                made_experiment(f"g{g}r{r}", "bending", "curvature", {"curvature": X, "moment": moment}, repeat_of=of)
            )
    return compare(MODEL, made_campaign(loops))


def test_a_missing_loop_is_seen_with_its_size():
    """A square loop of height 3, uncorrelated with the path, is an excess of 3 whatever the noise of 1."""
    comparison = with_loop(np.random.default_rng(12), 3.0)
    for fit in comparison.fits:
        assert fit.after.excess == pytest.approx(3.0, rel=0.05)  # 200 samples of noise 1: rms 3.16 +- 0.07
    assert len(comparison.where_it_fails()) == 4
    assert comparison.lack_of_fit["bending", "moment"].p < 1e-6
    assert "Fails in 4 of 4" in comparison.headline()


def test_no_loop_no_failure():
    comparison = with_loop(np.random.default_rng(13), 0.0)
    assert comparison.where_it_fails() == ()
    assert "within the noise" in comparison.headline()


def test_the_worst_comes_first():
    rng = np.random.default_rng(14)
    loops = []
    for g, size in enumerate((0.0, 5.0, 2.0)):
        for r in (0, 1):
            moment = 50 * X + size * np.sign(np.cos(np.linspace(0, 12, 200))) + rng.normal(size=X.size)
            of = f"g{g}r0" if r else None
            loops.append(
                made_experiment(f"g{g}r{r}", "bending", "curvature", {"curvature": X, "moment": moment}, repeat_of=of)
            )
    worst = compare(MODEL, made_campaign(loops)).where_it_fails()
    assert {f.experiment.id for f in worst[:2]} == {"g1r0", "g1r1"}
    assert {f.experiment.id for f in worst[2:]} == {"g2r0", "g2r1"}

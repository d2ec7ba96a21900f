"""Whether the error fell on data that nothing was fitted to: a ratio of excesses, its interval, and when it is confirmed."""

from dataclasses import replace

import numpy as np
import pytest
from made_bench import MODEL, RICH, made, switched, white

from compare import compare, explain
from compare.effect_calibration import calibrate_model
from compare.validation import set_error

PLAN = [replace(c, set="validate" if i in (1, 3, 6) else "calibrate") for i, c in enumerate((*RICH, RICH[0]))]
FRICTION = switched("interlayer-friction", "bending", (0.3, 0.7), (0.4,))


@pytest.fixture(scope="module")
def null():
    """Comparison of a campaign in which nothing is missing."""
    return compare(MODEL, made([], "bending", PLAN, n=60, seed=3))


def with_residual(comparison, of):
    """The comparison with rms errors `of(i)` noise floors in its fits."""
    fits = [
        replace(f, after=replace(f.after, rmse=float(of(i)) * f.noise_floor)) for i, f in enumerate(comparison.fits)
    ]
    return replace(comparison, fits=tuple(fits))


@pytest.mark.parametrize(
    ("before", "after", "ratio"),
    [(5.0, 2.0, np.sqrt(3 / 24)), (3.0, 1.0, 0.0), (2.0, 2.0, 1.0), (2.0, 4.0, np.sqrt(5))],
)
def test_ratio_of_excesses(null, before, after, ratio):
    """excess^2 = n (rmse^2/floor^2 - 1): an error at the floor has none, whatever the floor is."""
    error = set_error(with_residual(null, lambda i: before), with_residual(null, lambda i: after), "validate")
    assert (error.before, error.after) == pytest.approx((before, after), rel=1e-12)
    assert error.ratio == pytest.approx(ratio, abs=1e-9)
    assert error.ratio_low == pytest.approx(ratio, abs=1e-9) and error.ratio_high == pytest.approx(ratio, abs=1e-9)
    assert error.confirmed == (ratio < 1)


def test_interval_is_over_conditions(null):
    """With conditions that disagree the interval is that of resampled conditions: here between all and none of a fall."""
    fell = {"b02": 1.0, "b04": 4.0, "b07": 4.0}
    before = with_residual(null, lambda i: 4.0)
    after = with_residual(null, lambda i: fell.get(null.fits[i].experiment.id[:3], 4.0))
    error = set_error(before, after, "validate")
    assert error.ratio == pytest.approx(np.sqrt(2 / 3))
    assert error.ratio_low == pytest.approx(0.0, abs=1e-9)  # all three draws the one that fell: 1 in 27
    assert error.ratio_high == pytest.approx(1.0)  # none of them: 8 in 27
    assert error.confirmed is False


def test_calibration_set_confirms_nothing(null):
    """A fall on the set that was fitted proves nothing and is never called confirmed."""
    error = set_error(with_residual(null, lambda i: 5.0), with_residual(null, lambda i: 1.1), "calibrate")
    assert error.ratio < 0.2 and error.confirmed is None
    assert set_error(null, null, "sealed") is None


def test_no_excess_has_no_ratio(null):
    """Where the old model was at the noise floor there is nothing to fall, and no ratio is made up."""
    error = set_error(with_residual(null, lambda i: 0.99), with_residual(null, lambda i: 0.98), "validate")
    assert error.ratio is None and error.confirmed is None


def test_a_named_effect_is_confirmed():
    """What is found on one set brings the other, whose conditions it has not seen, to the noise; a refit does not."""
    campaign = made([FRICTION], "bending", PLAN, n=60, seed=3)
    findings = explain(MODEL, campaign)
    error = findings.errors["validate"]
    assert findings.effects == ("interlayer-friction",)
    assert error.confirmed and error.ratio < 0.1 and error.ratio_high < 0.3
    assert error.after == pytest.approx(1.0, abs=0.1) and error.before > 5
    assert error.baselines["refit of the old model"] > 0.5 * error.before
    assert error.baselines["Gaussian process patch"] > 2 * error.after


def test_a_lucky_fit_is_not_confirmed():
    """An effect that was switched on where another law holds does not bring unseen conditions down as its own data do."""
    campaign = made([FRICTION], "bending", PLAN, n=60, seed=3)
    right = compare(MODEL.add("interlayer-friction"), campaign)
    wrong = compare(MODEL.add("direction-asymmetry"), campaign)
    base = compare(MODEL, campaign)
    assert set_error(base, right, "validate").confirmed
    assert set_error(base, wrong, "validate").ratio > 0.9


def test_validation_data_are_not_fitted():
    """Whatever stands in the set validate changes no parameter: without these data the model is the same."""
    campaign = made([FRICTION], "bending", PLAN, white(0.01), n=60, seed=3)
    without = [e for e in campaign.experiments if e.set == "calibrate"]
    both = compare(MODEL.add("interlayer-friction"), campaign)
    alone = calibrate_model(MODEL.add("interlayer-friction"), without, both.noise)
    assert alone.model.effects[0].shape == both.model.effects[0].shape
    assert alone.model.effects[0].strength == both.model.effects[0].strength

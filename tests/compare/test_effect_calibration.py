"""Parameters of a model with effects are unbiased, and their standard deviations are the scatter of repeated campaigns."""

import numpy as np
import pytest
from made_bench import MODEL, RICH, blank, measured, refer, switched, white

from compare import NoiseCovariance, NoiseModel, effect_calibration
from compare.bench_model import BenchModel
from compare.effect_calibration import calibrate_model
from geometry.errors import InputError

LEVEL = 0.02
RUNS = 40
CASES = {
    "stiffening": (switched("stiffening", "bending", (), (0.2,)), ("cubic stiffening",)),
    "viscoelasticity": (switched("viscoelasticity", "bending", (3.0,), (0.3,)), ("relaxation time", "fading stiffness")),
    "backlash": (switched("backlash", "bending", (0.2,)), ("play",)),
    "sensor-lag": (switched("sensor-lag", "bending", (0.5,), channel="moment"), ("tau (moment)",)),
    "sensor-drift": (switched("sensor-drift", "bending", (), (0.1,), channel="moment"), ("rate (moment)",)),
}  # fmt: skip


@pytest.fixture(scope="module", params=CASES)
def calibrations(request):
    """Calibrations of the true form on campaigns that differ in their noise only, begun away from the truth."""
    effect, names = CASES[request.param]
    experiments = blank("bending", RICH[:6], 40)
    truth = refer([effect], experiments, MODEL.with_ratios({"EI": 1.1}))
    size = max(np.sqrt(np.mean(truth.predict(e)["moment"] ** 2)) for e in experiments)
    noise = NoiseModel({("bending", "moment"): NoiseCovariance(s=float(LEVEL * size))}, (), ())
    start = BenchModel(
        MODEL.section,
        effects=(switched(effect.effect.name, "bending", [1.2 * s for s in effect.shape], channel=effect.channel),),
    )

    def again(seed):
        return calibrate_model(start, measured(truth, experiments, white(LEVEL), seed).experiments, noise)

    labels = [f"{request.param}: {n}" for n in names]
    return labels, (*effect.shape, *effect.strength), [again(seed) for seed in range(RUNS)], again


def test_standard_deviation_is_the_scatter(calibrations, monkeypatch):
    """What the noise alone gives is the observed scatter within 40 %: forty campaigns know it within 11 %.

    The larger of this and of a bootstrap over the groups is reported. With six groups, of which one may say most about a
    parameter, the bootstrap is up to twice as large where all groups agree; never is too little reported.
    """
    labels, _, found, again = calibrations
    monkeypatch.setattr(effect_calibration, "bootstrap_std", lambda J, r, kinds: np.zeros(J[0].shape[1]))
    by_noise = [again(seed) for seed in range(5)]
    for label in labels:
        scatter = np.array([c.parameters[label].value for c in found]).std(ddof=1)
        assert 0.7 < np.median([c.parameters[label].std for c in by_noise]) / scatter < 1.4
        assert 0.75 < np.median([c.parameters[label].std for c in found]) / scatter < 2.5
    scatter = np.array([c.values["EI"].value for c in found]).std(ddof=1)
    assert 0.7 < np.median([c.values["EI"].std_noise_only for c in found]) / scatter < 1.4
    assert 0.75 < np.median([c.values["EI"].std for c in found]) / scatter < 2.5


def test_no_bias(calibrations):
    """The mean over the campaigns is the truth within its own error."""
    labels, values, found, _ = calibrations
    for label, value in zip(labels, values, strict=True):
        got = np.array([c.parameters[label].value for c in found])
        assert abs(got.mean() - value) < 4 * got.std(ddof=1) / np.sqrt(RUNS) + 1e-3 * abs(value)
    stiffness = np.array([c.values["EI"].value for c in found]) / 95.0
    assert abs(stiffness.mean() - 1.1) < 4 * stiffness.std(ddof=1) / np.sqrt(RUNS) + 1e-4


def test_calibrated_model_predicts_what_was_fitted(calibrations):
    """The model that is handed back predicts the truth within a fifth of the noise: fitted values and columns agree."""
    labels, _, found, _ = calibrations
    effect = CASES[labels[0].split(":")[0]][0]
    experiments = blank("bending", RICH[:6], 40)
    truth = refer([effect], experiments, MODEL.with_ratios({"EI": 1.1}))
    size = max(np.sqrt(np.mean(truth.predict(e)["moment"] ** 2)) for e in experiments)
    for e in experiments:
        difference = found[0].model.predict(e)["moment"] - truth.predict(e)["moment"]
        assert np.sqrt(np.mean(difference**2)) < 0.2 * LEVEL * size  # 480 samples on two to four numbers: a tenth


def test_effect_that_cannot_act_is_a_sentence():
    """Switching on an effect of another kind of experiment says what it needs."""
    experiments = blank("bending", RICH[:6], 40)
    campaign = measured(MODEL, experiments, white(LEVEL), 0)
    noise = NoiseModel({("bending", "moment"): NoiseCovariance(s=1.0)}, (), ())
    with pytest.raises(InputError, match="rig-compliance cannot act in these experiments"):
        calibrate_model(MODEL.add("rig-compliance"), campaign.experiments, noise)

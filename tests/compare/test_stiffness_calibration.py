"""Calibration: exact without noise, whatever the nominal value; with noise, its standard deviation has the coverage it states."""

from __future__ import annotations

import numpy as np
import pytest
from made_campaign import NOMINAL, made_campaign, made_experiment, null_pulls

from compare import BenchModel, NominalSection, calibrate, compare, measure_noise

X = np.sin(np.linspace(0, 12, 200))
TINY = 1e-7  # relative noise that keeps the covariance positive and the answer exact to its size


def exact(rng, signal):
    return signal + TINY * np.abs(signal).max() * rng.normal(size=signal.size)


def calibrated(experiments, nominal=NOMINAL):
    campaign = made_campaign(experiments, NominalSection(nominal))
    return calibrate(BenchModel(NominalSection(nominal)), campaign.of_set("calibrate"), measure_noise(campaign))


@pytest.mark.parametrize("factor", [0.01, 0.7, 1.0, 1.355, 50.0])
def test_nominal_value_does_not_matter(factor):
    """A wrong nominal stiffness leaves no trace: the truth comes back from a start fifty times off."""
    rng = np.random.default_rng(0)
    experiments = [
        made_experiment("t", "tension", "strain", {"strain": 1e-3 * X, "force": exact(rng, 5.3e5 * 1e-3 * X)}),
        made_experiment("b", "bending", "curvature", {"curvature": X, "moment": exact(rng, 47.058 * X)}),
        made_experiment("w", "torsion", "twist", {"twist": X, "torque": exact(rng, 33.0 * X)}),
    ]
    values = calibrated(experiments, {k: factor * v for k, v in NOMINAL.items()}).values
    for name, truth in (("EA", 5.3e5), ("EI", 47.058), ("GJ", 33.0)):
        assert values[name].value == pytest.approx(truth, rel=10 * TINY)  # noise over sqrt(200), with margin


@pytest.mark.parametrize("factor", [0.1, 1.0, 10.0])
def test_prescribed_load_gives_the_same_stiffness(factor):
    rng = np.random.default_rng(1)
    creep = made_experiment(
        "b", "bending", "moment", {"curvature": exact(rng, 80 * X / 47.058), "moment": 80 * X}, control="moment"
    )
    values = calibrated([creep], {**NOMINAL, "EI": factor * 47.058}).values
    assert values["EI"].value == pytest.approx(47.058, rel=10 * TINY)


def shear(rng, id, length, EI, GA):
    force = 1e-2 * X / (length**3 / (3 * EI) + length / GA)
    fields = {"direction": "x+", "conditions": {"specimen length": length}}
    return made_experiment(id, "shear", "deflection", {"deflection": 1e-2 * X, "force": exact(rng, force)}, **fields)


def test_cantilevers_of_two_lengths_separate_bending_from_shear():
    rng = np.random.default_rng(2)
    EI, GA = 50.0, 9.0e4
    values = calibrated([shear(rng, "s", 0.05, EI, GA), shear(rng, "l", 0.4, EI, GA)]).values
    assert values["EI"].value == pytest.approx(EI, rel=1e-5)
    assert values["GA"].value == pytest.approx(GA, rel=1e-5)


def test_cantilevers_of_one_length_scale_bending_and_shear_together():
    rng = np.random.default_rng(3)
    result = calibrated([shear(rng, "s", 0.2, 0.5 * NOMINAL["EI"], 0.5 * NOMINAL["GA"])])
    assert result.values["EI"].ratio == pytest.approx(0.5, rel=10 * TINY)
    assert result.values["GA"].ratio == pytest.approx(0.5, rel=10 * TINY)
    assert any("scaled together" in note for note in result.notes)


def test_validation_and_sealed_data_are_not_fitted():
    rng = np.random.default_rng(4)
    experiments = [
        made_experiment("c", "bending", "curvature", {"curvature": X, "moment": exact(rng, 50 * X)}),
        made_experiment("v", "bending", "curvature", {"curvature": X, "moment": exact(rng, 90 * X)}, set="validate"),
    ]
    comparison = compare(BenchModel(NominalSection(NOMINAL)), made_campaign(experiments))
    assert comparison.calibration.values["EI"].value == pytest.approx(50, rel=10 * TINY)


def test_wrong_sign_is_said():
    rng = np.random.default_rng(5)
    result = calibrated([made_experiment("b", "bending", "curvature", {"curvature": X, "moment": exact(rng, -50 * X)})])
    assert result.values["EI"].value == pytest.approx(-50, rel=10 * TINY)
    assert any("check the signs" in note for note in result.notes)


def test_path_that_never_moves_determines_nothing():
    rng = np.random.default_rng(15)
    still = made_experiment("b", "bending", "curvature", {"curvature": 0 * X, "moment": rng.normal(size=X.size)})
    comparison = compare(BenchModel(NominalSection(NOMINAL)), made_campaign([still]))
    assert comparison.calibration.values["EI"].value == NOMINAL["EI"]
    record = comparison.record()
    assert record["calibrated"]["EI"]["std"] is None
    assert any("calibrated.EI.std is null" in note for note in record["notes"])
    assert any("EI is not determined" in note for note in record["notes"])


def test_records_with_a_gain_of_their_own_are_averaged_not_trusted():
    """Two records of gain 1.1 and 0.9, one ten times longer: least squares by samples would give 1.08, the truth is 1."""
    rng = np.random.default_rng(6)
    experiments = []
    for g, n in enumerate((2000, 200)):
        x = np.sin(np.linspace(0, 12, n))
        for r, gain in enumerate((1.1, 0.9)):
            force = NOMINAL["EA"] * x * (gain if n == 2000 else 2 - gain) + 1.0 * rng.normal(size=n)
            repeat_of = f"g{g}r0" if r else None
            experiments.append(
                made_experiment(f"g{g}r{r}", "tension", "strain", {"strain": x, "force": force}, repeat_of=repeat_of)
            )
    kept = [e for e in experiments if e.id in ("g0r0", "g1r0")]
    noise = measure_noise(made_campaign(experiments))
    result = calibrate(BenchModel(NominalSection(NOMINAL)), kept, noise)
    assert result.values["EA"].ratio == pytest.approx(1.0, abs=1e-3)


def test_standard_deviation_covers_the_truth(draw_noise):
    """z = (EA - truth)/std over 80 null campaigns of six pairs: rms 1, and |z| < 2 in 95 % of them.

    The reported std is the larger of two estimates and comes from 12 records, so z may be somewhat below or above 1:
    rms of 80 values scatters by 8 %, the std of 12 clusters by 20 %. With a covariance of samples alone it would be 5.
    """
    rng, truth, z, z_noise = np.random.default_rng(7), 5.3653e5, [], []
    for _ in range(80):
        pulls = null_pulls(rng, lambda m: draw_noise(rng, m, 15.0, 0.4, 0.02, 10.0), truth, groups=6, n=60)
        value = calibrated(pulls).values["EA"]
        z.append((value.value - truth) / value.std)
        z_noise.append((value.value - truth) / value.std_noise_only)
    assert 0.7 < np.sqrt(np.mean(np.square(z))) < 1.25
    assert 0.75 < np.sqrt(np.mean(np.square(z_noise))) < 1.45
    assert np.mean(np.abs(z) < 2) >= 0.9


def test_bootstrap_sees_experiments_that_disagree():
    """Stiffness that differs between experiments by 5 % shows in the std, although every record is almost free of noise."""
    rng = np.random.default_rng(8)
    each = NOMINAL["EA"] * (1 + 0.05 * rng.normal(size=12))
    pulls = [
        made_experiment(f"e{i}", "tension", "strain", {"strain": 1e-3 * X, "force": exact(rng, EA * 1e-3 * X)})
        for i, EA in enumerate(each)
    ]
    value = calibrated(pulls).values["EA"]
    few = 2.201 / 1.960  # Student's t of 11 over the normal quantile, from tables
    assert value.std == pytest.approx(few * np.std(each, ddof=1) / np.sqrt(12), rel=0.1)  # 1000 resamples: 2 %
    assert value.std > 100 * value.std_noise_only


def test_the_same_campaign_gives_the_same_numbers(draw_noise):
    def values():
        rng = np.random.default_rng(9)
        return calibrated(null_pulls(rng, lambda m: draw_noise(rng, m, 15.0), 4e5, groups=2)).values

    assert values() == values()

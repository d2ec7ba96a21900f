"""Nothing is named where nothing is missing, whatever kind of noise there is."""

import numpy as np
import pytest
from made_bench import MODEL, RICH, blank, measured, one_sided, white
from made_campaign import NOMINAL

from compare import BenchModel, explain

LEVEL = 0.02


def correlated(rng, y):
    e = rng.normal(size=y.size)
    for t in range(1, y.size):
        e[t] = 0.7 * e[t - 1] + np.sqrt(1 - 0.49) * e[t]
    return LEVEL * e


def heavy_tail(rng, y):
    return LEVEL * rng.standard_t(3, size=y.size) / np.sqrt(3)


def heteroscedastic(rng, y):
    return LEVEL * rng.normal(size=y.size) * (0.3 + np.abs(y) / np.sqrt(np.mean(y**2)))


def specimen_scatter(rng, y):
    return 0.5 * LEVEL * rng.normal(size=y.size) + 0.01 * rng.normal() * y + 0.005 * rng.normal()


def drift(rng, y):
    """Noise of 1/f power."""
    spectrum = np.fft.rfft(rng.normal(size=y.size))
    spectrum[1:] /= np.sqrt(np.arange(1, spectrum.size))
    wave = np.fft.irfft(spectrum, y.size)
    return LEVEL * wave / wave.std()


NOISES = [white(LEVEL), correlated, heavy_tail, heteroscedastic, specimen_scatter, drift]
NAMES = ["white", "correlated", "heavy tail", "heteroscedastic", "specimen scatter", "1/f"]


@pytest.mark.parametrize(("noise", "kind"), list(zip(NOISES, ["bending", "tension"] * 3)), ids=NAMES)
def test_nothing_is_named(noise, kind):
    """The verdict is none; the base stiffness is that of the cable; and what would have been seen is said."""
    truth = MODEL.with_ratios({"EA": 0.9, "EI": 1.2})
    plan = one_sided(RICH) if kind == "tension" else RICH
    campaign = measured(truth, blank(kind, plan, 60), noise, seed=8)
    findings = explain(BenchModel(campaign.section), campaign)
    assert findings.verdict == "none"
    assert findings.effects == findings.confusable == () and findings.closest is None
    assert findings.after is findings.comparison and not findings.model.effects
    assert findings.smallest_seen and all("% of the load" in text for text in findings.smallest_seen.values())
    assert set(findings.smallest_seen).isdisjoint(u.effect for u in findings.untestable)
    name, ratio = {"bending": ("EI", 1.2), "tension": ("EA", 0.9)}[kind]
    value = findings.comparison.calibration.values[name]
    assert abs(value.value / NOMINAL[name] - ratio) < max(4 * value.std / NOMINAL[name], 0.01)


def test_one_kind_of_experiment_does_not_hide_another():
    """Bending and tension together, nothing missing in either."""
    truth = MODEL.with_ratios({"EA": 0.9, "EI": 1.2})
    experiments = [*blank("bending", RICH[:5], 60), *blank("tension", one_sided(RICH[:5]), 60)]
    campaign = measured(truth, experiments, white(LEVEL), seed=9)
    assert explain(BenchModel(campaign.section), campaign).verdict == "none"

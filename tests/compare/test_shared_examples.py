"""Example campaigns with disclosed truth, where they lie beside the repository: the null is null, the friction is seen."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from compare import BenchModel, Campaign, compare

EXAMPLES = Path(__file__).resolve().parents[3] / "shared" / "examples"
pytestmark = pytest.mark.skipif(not EXAMPLES.is_dir(), reason="the example campaigns are not beside the repository")


def comparison_of(name: str):
    campaign = Campaign.read(EXAMPLES / name)
    assert campaign.section is not None
    return compare(BenchModel(campaign.section), campaign)


def test_tension_null_has_no_excess_and_the_true_stiffness():
    """Disclosed truth: EA = 5.3653e5 N, nothing missing, noise of the force 14.9 N white with gain and offset."""
    comparison = comparison_of("tension-null")
    EA = comparison.calibration.values["EA"]
    assert abs(EA.value - 5.3653e5) < 2 * EA.std
    assert EA.std < 0.005 * EA.value
    assert comparison.noise.by_channel["tension", "force"].s == pytest.approx(14.9, rel=0.05)
    assert comparison.where_it_fails() == ()
    assert all(test.p > 0.01 for test in comparison.lack_of_fit.values())
    pooled = np.mean([f.after.rmse**2 - f.noise_floor**2 for f in comparison.fits if f.channel == "force"])
    floor = np.mean([f.noise_floor**2 for f in comparison.fits if f.channel == "force"])
    assert abs(pooled) < 0.5 * floor  # 16 records whose offset is one draw each: sqrt(2/16) = 0.35


def test_bending_friction_fails_in_every_record():
    """Disclosed truth: 9.8 % of the rms moment cannot be absorbed by EI; noise 1 %, correlation 0.7."""
    comparison = comparison_of("bending-friction")
    noise = comparison.noise.by_channel["bending", "moment"]
    assert noise.phi == pytest.approx(0.7, abs=0.05)  # three standard errors of 2500 samples
    assert len(comparison.where_it_fails()) == len(comparison.fits) == 16
    share = np.sqrt(
        np.mean([f.after.excess**2 for f in comparison.fits])
        / np.mean([np.mean(f.measured**2) for f in comparison.fits])
    )
    assert 0.08 < share < 0.12
    assert comparison.calibration.values["EI"].value > 47.058, (
        "the sticking layers stiffen the fit above the true elastic EI"
    )


def test_towing_example_is_read_and_not_compared():
    comparison = comparison_of("towing-example")
    assert comparison.fits == ()
    assert len(comparison.not_compared) == 28
    assert comparison.noise.by_channel["towing", "tension"].s == pytest.approx(5.24, rel=0.03)

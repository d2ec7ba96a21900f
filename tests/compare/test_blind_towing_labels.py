"""Labels of blind towing campaigns: which other effects the records could not tell from the truth, by the generator's own line."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.blind.judge import CLOSE, class_of, right
from benchmarks.blind_towing.generator import Case, TowingCampaign, label
from benchmarks.blind_towing.rivals import _Fit, rivals

SLOW = ((0.010, 10.0, 900.0, "calibrate"), (0.015, 10.0, 900.0, "calibrate"))
LOAD = Case(
    901, ("added-load",), ("whole",), share=0.04, noise="white", noise_size=0.01, conditions=SLOW, samples=51, duration=5.0,
    inside=False,
)  # fmt: skip


def test_the_truth_itself_at_another_strength_is_no_distance_away():
    """Fitted strength and friction give the truth back; 1 noise unit is left of hundreds, nonlinear friction included."""
    fit = _Fit(TowingCampaign(LOAD))
    (truth,) = fit.made.truths
    whole = float(np.linalg.norm(fit.truth))
    assert fit.distance(truth.of_size(0.4 * truth.size)) < 0.5 < 0.01 * whole


def test_weight_on_one_slow_incline_is_an_offset_and_on_two_it_is_not():
    """b g L sin(slope) is a constant per inclination, its friction goes into the coefficient, its inertia is small: closer than 5."""
    near = label(LOAD, ("sensor-offset", "sensor-drift"))
    assert near["twins"] == ["sensor-offset"] and near["rival"] == "sensor-offset"
    assert near["apart"] < CLOSE < 0.1 * near["D"]
    assert right({"verdict": "confusable", "effects": [], "confusable": ["added-load", "sensor-offset"], "label": near})
    steeper = (*SLOW, (0.010, 20.0, 900.0, "calibrate"))
    apart = label(replace(LOAD, conditions=steeper), ("sensor-offset",))
    assert apart["twins"] == [] and CLOSE < apart["apart"] <= apart["D"]


def test_no_rival_is_farther_than_the_base_model():
    """Strength zero is always to be had; 2 %: the distance of the base model is taken on the finer line."""
    made = TowingCampaign(replace(LOAD, effects=("viscous-drag",)))
    found = rivals(made, ("trough-friction-stribeck", "trolley-ratio-error", "sensor-lag"))
    assert set(found) == {"trough-friction-stribeck", "trolley-ratio-error", "sensor-lag"}
    assert max(found.values()) <= 1.02 * made.distance()


@pytest.mark.parametrize(
    ("effects", "confusable", "good"),
    [
        ((), ("added-load", "sensor-offset"), True),
        (("added-load",), (), True),
        (("sensor-offset",), (), False),
        ((), (), False),
    ],
)
def test_a_set_of_truth_and_twins_is_right(effects, confusable, good):
    """Where nothing can be sure of the name; the twin alone or nothing at all is not."""
    truth = {
        "group": "single", "effects": ["added-load"], "untestable": [], "D_alone": [60.0], "twins": ["sensor-offset"], "tied": [],
        "apart": 1.0,
    }  # fmt: skip
    verdict = "confusable" if confusable else "identified" if effects else "none"
    row = {"verdict": verdict, "effects": list(effects), "confusable": list(confusable), "ranking": [], "label": truth}
    assert class_of(row) == "tie"
    assert right(row) == good

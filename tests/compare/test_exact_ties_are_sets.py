"""What the experiments cannot tell apart is reported as a set: never one name out of it, however strong the evidence."""

from dataclasses import replace

import pytest
from made_bench import RICH, made, one_sided, switched

from compare import BenchModel, explain
from compare.rivals import TIE

ONE_TENSION = [replace(c, tension=1000.0) for c in RICH]
SLIPS = {
    "interlayer-friction": switched("interlayer-friction", "bending", (0.3, 0.7), (0.4,)),
    "plasticity": switched("plasticity", "bending", (0.3,), (0.4,)),
}


@pytest.mark.parametrize("seed", [1])
@pytest.mark.parametrize("truth", SLIPS)
def test_friction_and_plasticity_at_one_tension(truth, seed):
    """A slip limit that tension moves and one that it does not are the same law while the tension is one."""
    campaign = made([SLIPS[truth]], "bending", ONE_TENSION, n=40, seed=seed)
    findings = explain(BenchModel(campaign.section), campaign)
    assert findings.verdict == "confusable"
    assert set(findings.confusable) == set(SLIPS) and findings.effects == ()
    behind = {c.effect: c.behind for c in findings.ranking}
    assert max(behind[name] for name in SLIPS) < TIE
    assert findings.next_experiment is not None
    assert set(findings.next_experiment.separates) == set(SLIPS)


@pytest.mark.parametrize("truth", SLIPS)
def test_two_tensions_break_the_tie(truth):
    """The same truth on a design that varies the tension has one name."""
    campaign = made([SLIPS[truth]], "bending", RICH, n=40, seed=1)
    findings = explain(BenchModel(campaign.section), campaign)
    assert (findings.verdict, findings.effects) == ("identified", (truth,))


def test_lag_and_damping_where_amplitude_is_tied_to_nothing():
    """A sensor that lags by a time short against the period reads what a viscous cable gives: nearly, and so maybe a set.

    Whichever is true is in what is reported.
    """
    for name, effect in {
        "sensor-lag": switched("sensor-lag", "bending", (0.05,), channel="moment"),
        "viscous-damping": switched("viscous-damping", "bending", (), (0.05,)),
    }.items():
        campaign = made([effect], "bending", [c for c in RICH if c.period == 20.0], n=60, seed=4)
        findings = explain(BenchModel(campaign.section), campaign)
        assert name in (*findings.effects, *findings.confusable)
        assert len(findings.effects) + len(findings.confusable) <= 4


def test_a_third_of_one_law():
    """End load introduction and rig compliance have one formula; a twin of the cable and one of the rig stay two names."""
    campaign = made([switched("rig-compliance", "tension", (0.3,))], "tension", one_sided(RICH), n=40, seed=6)
    findings = explain(BenchModel(campaign.section), campaign)
    assert findings.verdict == "confusable"
    assert set(findings.confusable) == {"end-load-introduction", "rig-compliance"}
    kinds = {c.kind for c in findings.ranking if c.effect in findings.confusable}
    assert kinds == {"physics", "rig"}

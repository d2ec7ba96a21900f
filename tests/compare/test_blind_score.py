"""A small blind set, bench and towing, fixed seeds: what is missing is named as it was when the limits were set.

The campaigns come from generators that share no code with the models; an identification that gets worse fails here. The full
scorecards are run by hand: benchmarks/blind.md, benchmarks/blind_towing.md.
"""

import numpy as np
import pytest

from benchmarks.blind import follow_up
from benchmarks.blind.generator import hidden, write
from benchmarks.blind_towing.generator import Case
from benchmarks.blind_towing.score import answer
from compare import BenchModel, Campaign, explain
from effects import find

BENCH_RIVALS = ("interlayer-friction", "plasticity", "viscoelasticity", "stiffening")
BENCH = {  # truth: seed and changes to its case; the form is drawn
    "nothing": (3, {"effects": (), "kind": "bending", "noise": "ar"}),
    "friction": (10, {"effects": ("interlayer-friction",), "kind": "bending", "noise": "ar"}),
    "relaxation": (6, {"effects": ("viscoelasticity",), "kind": "torsion", "noise": "white"}),
}
TOWING_PLAN = ((0.12, 0.0, 900.0, "calibrate"), (0.5, 8.0, 900.0, "calibrate"))
TOWING = {  # truth: seed, effects, variants, noise
    "nothing": (31, (), (), "ar"),
    "drag with the power 0.85 of the speed": (32, ("viscous-drag",), ("power",), "white"),
}
TIED = {"effects": ("interlayer-friction",), "group": "tie", "design": "one-tension", "kind": "bending"}


def explained(folder, rivals=BENCH_RIVALS):
    campaign = Campaign.read(folder)
    return explain(BenchModel(campaign.section), campaign, library=[find(name) for name in rivals])


@pytest.mark.parametrize("name", BENCH)
def test_bench_campaigns(name, tmp_path):
    """Nothing is named where nothing is missing; elsewhere that effect alone, and the error falls to the noise."""
    seed, changes = BENCH[name]
    group = "single" if changes["effects"] else "null"
    made = hidden(seed, group=group, design="rich", size=0.01, strength=0.06, two_kinds=False, **changes)
    found = explained(write(made, tmp_path))
    assert found.effects == changes["effects"] and not found.confusable
    assert (found.verdict == "none") == (name == "nothing")
    assert found.errors["validate"].after < 1.5


@pytest.mark.parametrize("name", TOWING)
def test_towing_campaigns(name):
    """The same of two towing campaigns; the drag goes with a power of the speed, which the library does not know."""
    seed, effects, variants, noise = TOWING[name]
    case = Case(seed, effects, variants, share=0.08, noise=noise, noise_size=0.01, conditions=TOWING_PLAN,
                samples=91, duration=9.0)  # fmt: skip
    said = answer(case, ("viscous-drag", "added-load"))
    assert said["effects"] == list(effects) and not said["confusable"]
    assert (said["verdict"] == "none") == (name == "nothing")
    assert said["after"] < 1.5


def test_suggest_and_do(tmp_path):
    """Bending at one tension: friction and yield are a set; the proposed experiment leaves the true name, a random one the set."""
    made = hidden(11, noise="white", size=0.01, strength=0.05, two_kinds=False, **TIED)
    rivals = ("interlayer-friction", "plasticity")
    first = explained(write(made, tmp_path / "first"), rivals)
    assert first.verdict == "confusable" and set(first.confusable) == set(rivals)
    proposed = first.next_experiment.conditions
    after = explained(write(follow_up.done(made, proposed), tmp_path / "proposed"), rivals)
    assert after.verdict == "identified" and after.effects == ("interlayer-friction",)
    control = follow_up.at_random(np.random.default_rng(11), made, proposed)
    still = explained(write(follow_up.done(made, control), tmp_path / "random"), rivals)
    assert still.verdict == "confusable" and set(still.confusable) == set(rivals)

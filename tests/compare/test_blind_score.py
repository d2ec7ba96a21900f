"""A small blind set, bench and towing, fixed seeds: what is missing is named as it was when the limits were set.

The campaigns come from generators that share no code with the models; an identification that gets worse fails here. The full
scorecards are run by hand: benchmarks/blind.md, benchmarks/blind_towing.md.

The seeds of the bench are consecutive, and one fails: friction of the form of Bouc and Wen (seed 5), beside which
viscoelasticity is named, too. The seeds of the two towing campaigns and of the tied bench were chosen among a few that were tried;
they guard what works and are no measure of how often it does.
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
BENCH_SEEDS = (2, 3, 4, 5)
BENCH_ERRORS = 1
"""How many of the seeds may be answered wrongly; 2 to 7 had one error (5), which is among these."""
BENCH = (  # in turn: truth, kind, noise; the form is drawn
    ((), "bending", "ar"),
    (("viscoelasticity",), "torsion", "white"),
    (("interlayer-friction",), "bending", "ar"),
)
TOWING_PLAN = ((0.12, 0.0, 900.0, "calibrate"), (0.5, 8.0, 900.0, "calibrate"))
TOWING = {  # truth: seed, effects, variants, noise
    "nothing": (31, (), (), "ar"),
    "drag with the power 0.85 of the speed": (32, ("viscous-drag",), ("power",), "white"),
}
TIED = {"effects": ("interlayer-friction",), "group": "tie", "design": "one-tension", "kind": "bending"}


def explained(folder, rivals=BENCH_RIVALS):
    campaign = Campaign.read(folder)
    return explain(BenchModel(campaign.section), campaign, library=[find(name) for name in rivals])


def bench_answer(seed, folder):
    """Whether exactly what is missing is named and the error falls to the noise, and what was said."""
    truth, kind, noise = BENCH[seed % 3]
    made = hidden(seed, group="single" if truth else "null", design="rich", size=0.01, strength=0.06, two_kinds=False,
                  effects=truth, kind=kind, noise=noise)  # fmt: skip
    found = explained(write(made, folder))
    as_it_is = found.effects == truth and not found.confusable and (found.verdict == "none") == (not truth)
    return as_it_is and found.errors["validate"].after < 1.5, (
        seed,
        truth,
        found.verdict,
        found.effects,
        found.confusable,
    )


def test_bench_campaigns(tmp_path):
    """Nothing is named where nothing is missing; elsewhere that effect alone, and the error falls to the noise."""
    answers = [bench_answer(seed, tmp_path / str(seed)) for seed in BENCH_SEEDS]
    wrong = [said for good, said in answers if not good]
    assert len(wrong) <= BENCH_ERRORS, wrong
    assert not any(truth and not set(truth) & set(names) for _, truth, _, names, _ in wrong)
    assert not any(names and not truth for _, truth, _, names, _ in wrong)


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

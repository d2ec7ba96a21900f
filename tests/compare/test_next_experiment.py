"""The proposed experiment separates: made by the true law and added to the campaign, it leaves one name."""

from dataclasses import replace
from itertools import count

import numpy as np
import pytest
from made_bench import LARGEST, MODEL, RICH, Condition, blank, made, measured, refer, switched, white
from made_campaign import NOMINAL

from compare import BenchModel, explain

ONE_TENSION = [replace(c, tension=1000.0) for c in RICH]
SLIPS = {
    "interlayer-friction": switched("interlayer-friction", "bending", (0.3, 0.7), (0.4,)),
    "plasticity": switched("plasticity", "bending", (0.3,), (0.4,)),
}


def condition_of(proposed):
    """The plan of a proposed experiment; the largest rate of two sine cycles is amplitude times 2 pi over the period."""
    amplitude, rate = proposed["largest curvature [1/m]"], proposed["largest rate [1/m/s]"]
    return Condition(
        amplitude / LARGEST["bending"],
        2 * np.pi * amplitude / rate,
        proposed["axial tension [N]"],
        proposed["temperature [degC]"] + 273.15,
        proposed["specimen length [m]"],
    )


@pytest.fixture(scope="module", params=SLIPS)
def tied(request):
    """The truth, its campaign at one tension, and what was found there."""
    campaign = made([SLIPS[request.param]], "bending", ONE_TENSION, n=40, seed=1)
    return request.param, campaign, explain(BenchModel(campaign.section), campaign)


def test_promises(tied):
    """The chance of a wrong name falls from that of the tie to almost nothing; repeating what exists does not help."""
    _, _, findings = tied
    proposal = findings.next_experiment
    assert proposal.kind == "bending" and set(proposal.separates) == set(SLIPS)
    assert 0.1 < proposal.p_wrong_before <= 0.5
    assert proposal.p_wrong_after < 1e-3 < proposal.p_wrong_before
    assert proposal.p_wrong_repeat == pytest.approx(proposal.p_wrong_before, abs=0.2)
    assert proposal.conditions["axial tension [N]"] != 1000.0  # nothing else tells them apart


def test_keeps_what_it_promises(tied):
    """The proposed condition, done twice, turns the set into the one true name."""
    name, campaign, findings = tied
    new = [condition_of(findings.next_experiment.conditions)]
    experiments = [*blank("bending", ONE_TENSION, 40), *(renumbered(blank("bending", new, 40)))]
    old_scales = refer([SLIPS[name]], blank("bending", ONE_TENSION, 40), MODEL.with_ratios(dict.fromkeys(NOMINAL, 1.1)))
    more = measured(old_scales, experiments, white(0.01), seed=5)
    assert len(more.experiments) == len(campaign.experiments) + 2
    after = explain(BenchModel(more.section), more)
    assert after.verdict == "identified" and after.effects == (name,)
    behind = {c.effect: c.behind for c in after.ranking}
    rival = next(n for n in SLIPS if n != name)
    assert behind[rival] > 10


def test_a_repeat_keeps_the_tie(tied):
    """Doing again what exists leaves the set as it was."""
    name, _, _ = tied
    twice = [*ONE_TENSION, ONE_TENSION[0]]
    campaign = made([SLIPS[name]], "bending", twice, n=40, seed=7)
    assert set(explain(BenchModel(campaign.section), campaign).confusable) == set(SLIPS)


def renumbered(experiments):
    numbers = count(90)
    done, first = [], None
    for e in experiments:
        id = f"b{next(numbers)}"
        done.append(replace(e, id=id, sha256=id, repeat_of=first))
        first = first or id
    return done

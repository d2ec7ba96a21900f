"""What makes towing campaigns cheap changes no answer: rough columns while shapes are searched, runs on all cores, finer steps."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from made_towing import CONDITIONS, tow_campaign, towing_model

from compare import Campaign, compare, explain, towing_response
from compare.bench_design import make_blocks
from compare.gram import Scan, total_cost
from compare.search import Stage
from effects import find, library
from effects.effect import ActiveEffect

TOWING = [e for e in library() if "towing" in e.kinds and e.stage != "filter"]


def falling(cable):
    return find("trough-friction-stribeck").forms[0].respond(cable, (0.08,), 0.1)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tow_campaign(tmp_path_factory.mktemp("falling"), falling, conditions=CONDITIONS[::2])


def stage(folder, effects):
    campaign = Campaign.read(folder)
    base = compare(towing_model(campaign), campaign)
    return Stage(make_blocks(campaign.of_set("calibrate"), base.model, base.noise), ((),), effects)


def test_the_best_shape_of_a_grid_is_corrected_and_the_truth_falls_most(folder):
    """The least cost of a grid is that of a full correction; no effect that is not there promises more than the one that is."""
    tried = stage(folder, TOWING)
    falls = {site.effect.name: tried._fall(site, site.effect.forms[0]) for site in tried.sites}
    assert max(falls, key=lambda name: falls[name]) == "trough-friction-stribeck"
    site = next(s for s in tried.sites if s.effect.name == "trough-friction-stribeck")
    grid, shapes = tried._grid(site, site.effect.forms[0])
    costs, scan = total_cost(grid), tried.scans[0]
    best = site.term(site.effect.forms[0], shapes[int(np.argmin(costs))])
    assert costs.min() == pytest.approx(float(total_cost(scan.candidate(best))), rel=1e-9)  # the same columns
    rough = float(total_cost(scan.of_matrix(best, scan.cost_matrix(best, rough=True))))
    assert abs(rough - costs.min()) > 1.0  # so that the correction matters


def test_a_rough_search_ends_where_the_full_one_ends(folder, monkeypatch):
    """Shape to 1 %, square residual to 1; with fewer runs.

    Gain to a thousandth: it is read where one of two conditions is left out, far from where columns are corrected.
    """
    found, runs = [], []
    for dear in (True, False):
        if not dear:
            monkeypatch.setattr(Scan, "dear", property(lambda _self: False))
        tried = stage(folder, [find("trough-friction-stribeck")])
        found.append(tried.trial(tried.sites[0], tried.sites[0].effect.forms[0]))
        runs.append(tried.blocks[0].records[0].response.runs)
    rough, full = found
    assert rough.fit.term.shape == pytest.approx(full.fit.term.shape, rel=0.01)
    assert rough.fit.square == pytest.approx(full.fit.square, abs=1.0)
    assert rough.total == pytest.approx(full.total, rel=1e-3)
    assert runs[0] < 0.7 * runs[1]


def test_runs_on_all_cores_are_those_on_one(folder, monkeypatch):
    """Every digit of the ranking."""
    campaign, said = Campaign.read(folder), []
    effects = [find(n) for n in ("viscous-drag", "roller-resistance", "trough-friction-stribeck")]
    with ThreadPoolExecutor(3) as pool:
        for threads in (None, pool):
            monkeypatch.setattr(towing_response, "_pool", lambda threads=threads: threads)
            findings = explain(towing_model(campaign), campaign, library=effects)
            said.append([(c.effect, c.log_e, c.behind, c.parameters) for c in findings.ranking])
    assert said[0] == said[1] and said[0][0][0] == "trough-friction-stribeck"


def test_finer_steps_of_a_drive_are_no_effect(tmp_path):
    """A ripple of next to nothing changes next to nothing, though the record is stepped half as often again."""
    tried = stage(tow_campaign(tmp_path, conditions=CONDITIONS[3:]), [find("polygon-effect")])
    record = tried.blocks[0].records[0]
    effect = find("polygon-effect")
    ripple = ActiveEffect(effect, effect.forms[0], "towing", None, (0.04,), (1e-9, 0.0))
    response = record.response
    cable = response.setup.cable(record.experiment, 0.35)
    driven = effect.forms[0].respond(cable, (1e-9, 0.0), 0.04)
    assert cable.chain.substeps(cable.time, driven.shortest) > 1.5 * cable.chain.substeps(cable.time)
    told = np.ptp(driven.tensions()[0] - cable.tensions()[0])
    changed = np.ptp(response.run(record.experiment, 1.0, (ripple,))[0] - response.run(record.experiment, 1.0, ())[0])
    assert changed < 1e-3 < 0.02 < told

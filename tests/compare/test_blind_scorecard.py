"""The scorecard of the blind campaigns: what counts as right, exact intervals, and a log that survives a crash."""

from __future__ import annotations

import json

import pytest

from benchmarks.blind.judge import class_of, exact, false_single, first, named, right, wrong
from benchmarks.blind.runner import Job, labels_of, read_log, run
from benchmarks.blind.scorecard import bars, clopper_pearson, scorecard


def answer(truth=(), effects=(), confusable=(), verdict="none", **label):
    """One row of the log."""
    group = label.pop("group", "single" if truth else "null")
    full = {
        "seed": 1, "group": group, "effects": list(truth), "variants": ["v"] * len(truth), "kind": "bending",
        "design": "rich", "noise": "white", "size": 0.01, "strength": 0.05, "D": 50.0, "D_alone": [50.0] * len(truth),
        "F0": 2.0, "untestable": [], "twins": [], "tied": [], "rival": "", "apart": 50.0, **label,
    }  # fmt: skip
    return {"seed": 1, "method": "m", "verdict": verdict, "effects": list(effects), "confusable": list(confusable),
            "seconds": 1.0, "ratio": None, "label": full}  # fmt: skip


def test_clopper_pearson_against_known_values():
    """0 of 300 leaves 1.22 % (two-sided 95 %); 5 of 10 is 18.7 % to 81.3 %. Source: Clopper & Pearson 1934, by the beta law."""
    assert clopper_pearson(0, 300) == pytest.approx((0.0, 0.012222), abs=2e-5)
    assert clopper_pearson(5, 10) == pytest.approx((0.18709, 0.81291), abs=1e-5)
    assert clopper_pearson(10, 10)[1] == 1.0


def test_single_effects():
    """Exact is that one, nothing else, no open set; wrong is a name without the truth."""
    hit = answer(["slack"], ["slack"], verdict="identified")
    more = answer(["slack"], ["slack", "plasticity"], verdict="identified")
    as_set = answer(["slack"], [], ["slack", "backlash"], "confusable")
    other = answer(["slack"], ["backlash"], verdict="identified")
    assert [exact(r) for r in (hit, more, as_set, other)] == [True, False, False, False]
    assert [first(r) for r in (hit, more, as_set, other)] == [True, True, True, False]
    assert [wrong(r) for r in (hit, more, as_set, other)] == [False, False, False, True]
    assert wrong(answer(["slack"], verdict="crash"))


def test_ties_sets_nulls_and_outsiders():
    """A single name in an exact tie is a guess; a null allows nothing; outside the library only unknown is right."""
    tie = {"twins": ["interlayer-friction", "plasticity"], "tied": ["plasticity"]}
    guess = answer(["plasticity"], ["plasticity"], verdict="identified", **tie)
    assert class_of(guess) == "tie"
    assert false_single(guess)
    assert not right(guess)
    good = answer(["plasticity"], [], ["interlayer-friction", "plasticity"], "confusable", **tie)
    assert right(good)
    assert len(named(good)) == 2
    assert not right(answer([], verdict="unknown"))
    assert right(answer(["hum"], verdict="unknown", group="outside"))
    assert not right(answer(["hum"], ["sensor-lag"], verdict="identified", group="outside"))


def test_a_single_effect_with_a_rival_too_close_is_no_bar_for_the_name():
    """Below five units of noise from the nearest rival the set is as right as the name."""
    near = answer(["slack"], [], ["slack", "sensor-offset"], "confusable", apart=3.0)
    assert class_of(near) == "near"
    assert right(near)
    assert not right(answer(["slack"], apart=3.0))


def test_bars_count_what_they_say():
    """Two nulls, one of them a false positive; one exact single out of two."""
    rows = [answer(), answer(verdict="unknown"), answer(["slack"], ["slack"], verdict="identified"), answer(["slack"])]
    found = {bar.title: bar for bar in bars(rows)}
    assert (found["nulls: anything but none"].hits, found["nulls: anything but none"].count) == (1, 2)
    assert found["nulls: anything but none"].passed is False
    assert found["single, testable: exactly that one"].value == 0.5
    assert "**FAIL**" in scorecard(rows, "m")


def test_log_is_taken_up_where_it_was_cut(tmp_path):
    """A torn last line is done again, the rest is not."""
    labels, digest = labels_of([0, 1], workers=1)
    assert len(digest) == 64
    log = tmp_path / "log.jsonl"
    jobs = [Job(0, "says-none"), Job(1, "says-none")]
    assert len(list(run(jobs, labels, log, workers=1))) == 2
    whole = log.read_text().splitlines()
    log.write_text(whole[0] + "\n" + whole[1][:20] + "\n")
    again = list(run(jobs, labels, log, workers=1))
    assert [row["seed"] for row in again] == [json.loads(whole[1])["seed"]]
    assert sorted(seed for _, seed in read_log(log)) == [0, 1]


def test_a_method_that_breaks_is_logged_as_a_crash(tmp_path, monkeypatch):
    """And counted, not lost."""
    from benchmarks.blind import methods

    def breaks(_folder):
        raise RuntimeError("as it may happen")

    monkeypatch.setattr(methods, "METHODS", {"explain": breaks})
    labels, _ = labels_of([0], workers=1)
    (row,) = run([Job(0, "explain")], labels, tmp_path / "log.jsonl", workers=1)
    assert row["verdict"] == "crash"
    assert "as it may happen" in row["why"]

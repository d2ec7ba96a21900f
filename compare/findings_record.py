"""Findings as plain numbers: the JSON object of ``helicable explain``, schema version 1 of the campaign contract.

The keys that the contract names are always there: an empty list where nothing was found, null where there is nothing to
say (``closest`` but for the verdict unknown, ``next_experiment`` without rivals, an error of a set that is empty or still
sealed). JSON knows no NaN: a number that the data leave open becomes null, with its place in the notes. The schema ships
as ``compare/schemas/explain.schema.json``; further keys stand beside those of the contract.
"""

from __future__ import annotations

import importlib.resources
import json
import math
from collections.abc import Sequence
from typing import Any

from compare.campaign import Campaign
from compare.comparison import Comparison
from compare.comparison_record import comparison_record, finite_content, noise_rows
from compare.findings import Candidate, Check, Findings, NextExperiment, ParameterValue, Separation, SetError, Step
from compare.findings_sentences import missing_effect, named, parameters_of, with_units
from compare.kinds import SETS
from effects.effect_record import effect_record

UNIT = "relative to the noise floor"


def explain_schema() -> dict[str, Any]:
    """JSON schema (draft 2020-12) of what :func:`findings_record` returns."""
    text = importlib.resources.files("compare").joinpath("schemas/explain.schema.json").read_text(encoding="utf-8")
    return json.loads(text)


def headline(findings: Findings) -> str:
    """The verdict in one sentence.

    Examples
    --------
    >>> headline(findings)                                                          # doctest: +SKIP
    'Missing: interlayer-friction (identified); ...'
    """
    return missing_effect(findings)


def findings_record(findings: Findings) -> dict[str, Any]:
    """JSON object of ``helicable explain``: the contract's keys first, in its order, then what else is known."""
    f = findings
    content: dict[str, Any] = {
        "schema": 1,
        "verdict": f.verdict,
        "effects": list(f.effects),
        "confusable": list(f.confusable),
        "closest": None if f.closest is None else {"effect": f.closest[0], "share": f.closest[1]},
        "ranking": [_candidate(c) for c in f.ranking],
        "untestable": [{"effect": u.effect, "why": u.why} for u in f.untestable],
        "error": {"unit": UNIT, **{name: _set_error(f.errors.get(name)) for name in SETS}},
        "where": [
            {"experiment": p.experiment, "channel": p.channel, "excess": p.excess, "after": p.after} for p in f.where
        ],
        "next_experiment": None if f.next_experiment is None else _next_experiment(f.next_experiment),
    }
    content |= {
        "campaign": f.comparison.campaign.title,
        "headline": headline(f),
        "uncalibrated": {name: f.comparison.relative_error(name, before=True) for name in SETS},
        **_calibrated(f),
        "parameters": {
            name: {key: parameter_record(p) for key, p in parameters_of(f, name).items()} for name in named(f)
        },
        "found": [effect_record(active) for active in f.model.effects],
        "path": [_step_row(step) for step in f.path],
        "smallest_seen": dict(f.smallest_seen),
        "separation": _separation(f.separation),
        "marks": [
            {"name": m.name, "sentence": m.sentence, "value": m.value, "std": m.std, "computed": m.computed}
            for m in f.marks
        ],
        "noise_assumed": f.noise_assumed,
        "sealed_opened": f.sealed_opened,
        "seconds": f.seconds,
    }
    return _with_notes(content, f.notes)


def check_record(check: Check) -> dict[str, Any]:
    """JSON object of ``helicable check``."""
    content: dict[str, Any] = {
        "schema": 1,
        "campaign": check.campaign.title,
        "experiments": experiment_rows(check.campaign),
        "noise": noise_rows(check.noise),
        "separation": _separation(check.separation),
        "untestable": [{"effect": u.effect, "why": u.why} for u in check.untestable],
        "smallest_seen": dict(check.smallest_seen),
    }
    return _with_notes(content, tuple(dict.fromkeys((*check.noise_notes, *check.notes))))


def experiment_rows(campaign: Campaign) -> list[dict[str, Any]]:
    """One dictionary per experiment of the campaign; a sealed one shows its list entry only."""
    rows = []
    for e in campaign.experiments:
        record = e.table
        row: dict[str, Any] = {"id": e.id, "kind": e.kind, "set": e.set, "specimen": e.specimen}
        row |= {"repeat_of": e.repeat_of, "conditions": dict(e.conditions)}
        row |= {"rows": None, "duration": None, "largest": None, "prescribed": None, "measured": []}
        if record is not None:
            path = record[record.prescribed]
            row |= {"rows": len(record), "prescribed": record.prescribed, "measured": list(record.measured)}
            row["largest"] = float(abs(path).max()) if len(path) else None
            row["duration"] = None if record.time is None else float(record.time[-1] - record.time[0])
        rows.append(row)
    return rows


def _candidate(c: Candidate) -> dict[str, Any]:
    return {
        "effect": c.effect,
        "kind": c.kind,
        "log_e": c.log_e,
        "share": c.share,
        "parameters": {name: parameter_record(p) for name, p in c.parameters.items()},
        "note": c.note,
        "form": c.form,
        "needed": c.needed,
        "behind": c.behind,
        "positive_folds": c.positive_folds,
        "folds": c.folds,
    }


def parameter_record(p: ParameterValue) -> dict[str, Any]:
    """A parameter with its uncertainty; an open end of the plausible range is None."""
    plausible = None if p.plausible is None else [v if math.isfinite(v) else None for v in p.plausible]
    row: dict[str, Any] = {"value": p.value, "std": p.std, "unit": p.unit}
    return row | {"meaning": p.meaning, "plausible": plausible, "expected": p.expected}


def _set_error(e: SetError | None) -> dict[str, Any] | None:
    if e is None:
        return None
    row: dict[str, Any] = {"before": e.before, "after": e.after, "floor": e.floor}
    row |= {"ratio": e.ratio, "ratio_low": e.ratio_low, "ratio_high": e.ratio_high}
    return row | {"confirmed": e.confirmed, "baselines": dict(e.baselines)}


def _next_experiment(n: NextExperiment) -> dict[str, Any]:
    row: dict[str, Any] = {"kind": n.kind, "conditions": with_units(n.conditions), "separates": list(n.separates)}
    row |= {"p_wrong_before": n.p_wrong_before, "p_wrong_after": n.p_wrong_after}
    return row | {"p_wrong_repeat": n.p_wrong_repeat, "sentence": n.sentence}


def _step_row(step: Step) -> dict[str, Any]:
    return {
        "added": step.added,
        "form": step.form,
        "log_e": step.log_e,
        "error": step.error,
        "share": step.share,
        "note": step.note,
    }


def _separation(s: Separation) -> dict[str, Any]:
    return {
        "effects": list(s.effects),
        "distance": [float(d) for d in s.distance],
        "size": list(s.size),
        "confusion": [[float(v) for v in row] for row in s.confusion],
        "confounded": list(s.confounded),
    }


def _calibrated(f: Findings) -> dict[str, Any]:
    base = comparison_record(f.comparison)
    return {
        "calibrated": base["calibrated"],
        "calibrated_with_effects": _values(f.after),
        "noise": base["noise"],
        "lack_of_fit": base["lack_of_fit"],
    }


def _values(comparison: Comparison) -> dict[str, Any]:
    return {
        name: {"value": v.value, "std": v.std, "unit": v.unit, "nominal": v.nominal, "ratio": v.ratio}
        for name, v in comparison.calibration.values.items()
    }


def _with_notes(content: dict[str, Any], notes: Sequence[str]) -> dict[str, Any]:
    lost: list[str] = []
    clean = finite_content(content, "", lost)
    reasons = [f"{place} is null: the data leave no finite number for it." for place in lost]
    return {**clean, "notes": [*notes, *reasons]}

"""`helicable check`: is the data readable, what was recorded, how noisy is it, and what can it show?"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from compare.findings import Check
from compare.findings_record import check_record
from compare.findings_sentences import with_units
from helicable.bench_campaign import bench_model, read_bench_campaign
from helicable.explain_screen import untestable_sentences
from helicable.options import CampaignArgument, JsonOption
from helicable.screen import progress, sheet, table, write_json

_CONFUSED = 0.05


def check(campaign: CampaignArgument, json: JsonOption = None) -> None:
    """Check a campaign before any verdict: readable, what was recorded, the noise, and which effects it can show.

    Example: `helicable check my-campaign`
    """
    read, notes = read_bench_campaign(campaign, "check")
    from compare.testability import check as check_campaign

    with progress("checking") as tell:
        found = check_campaign(bench_model(read), read, progress=tell)
    record = check_record(found)
    record["notes"] = [*notes, *record["notes"]]
    show_check(found, record)
    write_json(json, record)


def show_check(found: Check, record: dict[str, Any]) -> None:
    """Print what was recorded, the noise, and what can be tested."""
    rows = record["experiments"]
    sheet(record["campaign"], [("readable", f"{len(rows)} experiments, every file, row and column was understood.")])
    columns = ("kind", "experiments", "repeats", "sets", "path", "largest", "measured")
    table("What was recorded (SI units)", columns, kind_rows(rows), right=(1, 2, 5))
    spans = condition_rows(rows)
    table("Conditions (SI units)", ("kind", "condition", "from", "to", "values"), spans, right=(2, 3, 4))
    noise = [
        (n["kind"], n["channel"], *(f"{n[k]:.3g}" for k in ("s", "phi", "white", "gain", "offset")), n["source"])
        for n in record["noise"]
    ]
    columns = ("kind", "channel", "s", "phi", "white", "gain", "offset", "from")
    table("Noise: sample, correlation, white part, scatter of gain and offset", columns, noise, right=(2, 3, 4, 5, 6))
    table("What these experiments can show", ("effect", "D", "at a size of"), testable_rows(found), right=(1,))
    confused = confused_rows(found)
    title = f"Pairs that may be taken for each other in more than {100 * _CONFUSED:.0f} %"
    table(title, ("effect", "taken for", "chance"), confused, right=(2,)) if confused else None
    sentences = [("not testable", s) for s in untestable_sentences(found.untestable)]
    sentences += [("confounded", s) for s in found.separation.confounded]
    sentences += [("note", s) for s in record["notes"]]
    sheet("Mind", sentences or [("", "nothing: every effect can be tested, no covariates vary together.")])


def kind_rows(rows: Sequence[dict[str, Any]]) -> list[tuple[str, ...]]:
    """One row per kind of experiment."""
    made = []
    for kind in dict.fromkeys(r["kind"] for r in rows):
        of_kind = [r for r in rows if r["kind"] == kind]
        sets = ", ".join(f"{sum(r['set'] == s for r in of_kind)} {s}" for s in dict.fromkeys(r["set"] for r in of_kind))
        paths = dict.fromkeys(r["prescribed"] for r in of_kind if r["prescribed"])
        measured = dict.fromkeys(c for r in of_kind for c in r["measured"])
        largest = max((r["largest"] for r in of_kind if r["largest"] is not None), default=None)
        repeats = sum(r["repeat_of"] is not None for r in of_kind)
        size = "-" if largest is None else f"{largest:.4g}"
        made.append((kind, str(len(of_kind)), str(repeats), sets, ", ".join(paths), size, ", ".join(measured)))
    return made


def condition_rows(rows: Sequence[dict[str, Any]]) -> list[tuple[str, ...]]:
    """Span of every condition in every kind."""
    seen: dict[tuple[str, str], set[float]] = {}
    for row in rows:
        for name, value in with_units(row["conditions"]).items():
            seen.setdefault((row["kind"], name), set()).add(value)
    return [(k, n, f"{min(v):.4g}", f"{max(v):.4g}", str(len(v))) for (k, n), v in seen.items()]


def testable_rows(found: Check) -> list[tuple[str, ...]]:
    """Testable effects by their distance from the refitted base, in units of the noise."""
    s = found.separation
    order = sorted(range(len(s.effects)), key=lambda i: -s.distance[i])
    return [(s.effects[i], f"{s.distance[i]:.3g}", found.smallest_seen.get(s.effects[i], s.size[i])) for i in order]


def confused_rows(found: Check) -> list[tuple[str, ...]]:
    """Pairs above the threshold, most likely first; each pair once, with the larger of the two chances."""
    s, pairs = found.separation, []
    for i, name in enumerate(s.effects):
        for j in range(i):
            chance = max(float(s.confusion[i, j]), float(s.confusion[j, i]))
            if chance > _CONFUSED:
                pairs.append((chance, s.effects[j], name))
    return [(a, b, f"{100 * p:.0f} %") for p, a, b in sorted(pairs, reverse=True)]

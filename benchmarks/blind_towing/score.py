"""Lets `compare.explain` answer towing campaigns and holds the answers against the labels; questions of :mod:`benchmarks.blind.judge`.

Here alone are `compare` and `effects` imported. The explainer sees the folder and nothing else.
"""

from __future__ import annotations

import json
import signal
import tempfile
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.blind.judge import class_of, named, right, wrong
from benchmarks.blind.scorecard import clopper_pearson
from benchmarks.blind_towing.generator import Case, TowingCampaign, label_of, make

Row = Mapping[str, Any]
LIMIT = 600
"""Seconds that one campaign may take."""


def explain_folder(folder: Path, library: Sequence[str] | None = None) -> dict[str, Any]:
    """Verdict, names and errors of `compare.explain` on a towing campaign; `library` names the effects that are tried."""
    from compare import BenchModel, Campaign
    from compare.explain import explain
    from compare.towing_setup import TowingSetup
    from effects import find

    campaign = Campaign.read(folder)
    assert campaign.section is not None
    model = BenchModel(campaign.section, towing=TowingSetup.of(campaign))
    found = explain(model, campaign, library=[find(name) for name in library] if library else None)
    error = found.errors.get("validate") or found.errors.get("calibrate")
    proposed = found.next_experiment
    return {
        "verdict": found.verdict, "effects": list(found.effects), "confusable": list(found.confusable),
        "closest": list(found.closest) if found.closest else None,
        "ranking": [[c.effect, c.form, round(c.log_e, 2), round(c.share, 3), round(c.behind, 2)] for c in found.ranking[:5]],
        "untestable": [u.effect for u in found.untestable],
        "before": error.before if error else None, "after": error.after if error else None,
        "next": dict(proposed.conditions) if proposed else None,
    }  # fmt: skip


def answer(case: Case, library: Sequence[str] | None = None) -> dict[str, Any]:
    """Make the campaign, let it be explained, and put the label beside what was said; a breakdown counts as ``crash``."""
    made = TowingCampaign(case)
    with tempfile.TemporaryDirectory(prefix="blind-") as scratch:
        folder = make(made, Path(scratch) / "campaign")
        start = time.process_time()
        try:
            signal.signal(signal.SIGALRM, _expired)
            signal.alarm(LIMIT)
            said = explain_folder(folder, library)
        except Exception as error:
            said = {"verdict": "crash", "effects": [], "confusable": [], "why": f"{type(error).__name__}: {error}"}
        finally:
            signal.alarm(0)
    seconds = round(time.process_time() - start, 2)
    return {"seed": case.seed, **said, "seconds": seconds, "label": label_of(made, library or ())}


def _expired(_signal: int, _frame: object) -> None:
    raise TimeoutError(f"more than {LIMIT} s")


def run(cases: Sequence[Case], log: Path, until: float) -> Iterator[Row]:
    """Answer what the log lacks, one line of JSON each, and begin no case after `until` seconds of CPU time."""
    log.parent.mkdir(parents=True, exist_ok=True)
    done = {row["seed"] for row in read_log(log)}
    begun = time.process_time()
    for case in cases:
        if case.seed in done:
            continue
        if time.process_time() - begun > until:
            return
        row = answer(case)
        with log.open("a", encoding="utf-8") as file:
            file.write(json.dumps(row) + "\n")
        yield row


def read_log(log: Path) -> list[Row]:
    """All answers so far."""
    return [json.loads(x) for x in log.read_text(encoding="utf-8").splitlines()] if log.exists() else []


@dataclass(frozen=True)
class Share:
    """Hits of a count, and how many there should be."""

    title: str
    hits: int
    count: int
    bar: str

    def line(self) -> str:
        """Row of the table, with the exact 95 % interval."""
        if not self.count:
            return f"| {self.title} | - | {self.bar} | 0 | - |"
        low, high = clopper_pearson(self.hits, self.count)
        return f"| {self.title} | {self.hits / self.count:.2f} | {self.bar} | {self.hits}/{self.count} | {low:.2f}-{high:.2f} |"


def shares(rows: Iterable[Row]) -> list[Share]:
    """What is asked: nothing named in nulls, the truth named, never wrongly, outsiders unknown, pairs complete."""
    by: dict[str, list[Row]] = {}
    for row in rows:
        by.setdefault(class_of(row), []).append(row)
    single, outside, null = by.get("single", []), by.get("outside", []), by.get("null", [])
    pair, hidden = by.get("pair", []), by.get("hidden", [])
    close = [*by.get("tie", []), *by.get("near", [])]
    known = [*single, *close, *pair]
    return [
        Share("nulls: anything but none", sum(r["verdict"] != "none" for r in null), len(null), "<= 0.01"),
        Share("single: exactly that one", sum(map(right, single)), len(single), ">= 0.90"),
        Share("single: truth named, alone or in a set", sum(map(among, single)), len(single), ">= 0.97"),
        Share("single: wrongly", sum(map(wrong, single)), len(single), "<= 0.02"),
        Share("a rival within the noise: truth named, alone or in a set", sum(map(among, close)), len(close), ">= 0.97"),
        Share("a rival within the noise: anything but truth and twins named", sum(map(beside, close)), len(close), "<= 0.02"),
        Share("pairs: both named", sum(set(r["label"]["effects"]) <= set(named(r)) for r in pair), len(pair), ">= 0.80"),
        Share("outside: unknown", sum(map(right, outside)), len(outside), ">= 0.85"),
        Share("outside: called identified", sum(r["verdict"] == "identified" for r in outside), len(outside), "<= 0.05"),
        Share("too small to be seen: named wrongly", sum(map(wrong, hidden)), len(hidden), "<= 0.02"),
        Share("validation error below 1.5 noise floors", sum((r.get("after") or 9.0) < 1.5 for r in known), len(known), ">= 0.90"),
        Share("broke down", sum(r["verdict"] == "crash" for v in by.values() for r in v), sum(map(len, by.values())), "0"),
    ]  # fmt: skip


def among(row: Row) -> bool:
    """Whether the first truth is named, alone or in a set."""
    return row["label"]["effects"][0] in named(row)


def beside(row: Row) -> bool:
    """Whether something is named that is neither true nor, within the noise, like it."""
    return bool(set(named(row)) - set(row["label"]["effects"]) - set(row["label"]["twins"]))


def said(row: Row) -> str:
    """One column of the confusion matrix: the name, several names, a set, or the verdict."""
    if row["confusable"]:
        return "set with the truth" if set(row["label"]["effects"]) & set(named(row)) else "set without it"
    if len(row["effects"]) > 1:
        return "several"
    return str(row["effects"][0]) if row["effects"] else str(row["verdict"])


def table(rows: Sequence[Row]) -> str:
    """The scorecard in Markdown."""
    lines = [
        "| measure | value | bar | count | 95 % interval |",
        "|---|---|---|---|---|",
        *(s.line() for s in shares(rows)),
        "",
    ]
    lines += [
        "| truth | variant | share | noise | D | nearest rival, apart | said | error on validate: before, after | CPU s |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for row in sorted(rows, key=lambda r: (r["label"]["group"], r["label"]["effects"], r["seed"])):
        label = row["label"]
        names = ", ".join(row["effects"]) + (
            f" {{{', '.join(sorted(row['confusable']))}}}" if row["confusable"] else ""
        )
        rival = f"{label['rival']}, {label['apart']:.0f}" if label["rival"] else "-"
        errors = f"{row['before']:.2f}, {row['after']:.2f}" if row.get("after") else "-"
        lines.append(
            f"| {' + '.join(label['effects']) or '(none)'} | {' + '.join(label['variants'])} | {label['strength']:g} | "
            f"{label['noise']} {label['size']:g} | {label['D']:.0f} | {rival} | "
            f"{row['verdict']}: {names or '-'} | {errors} | {row['seconds']:.0f} |"
        )
    return "\n".join(lines) + "\n"

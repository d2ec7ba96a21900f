"""The scorecard: every bar with its value, count, Clopper-Pearson interval and pass or fail, and the tables behind it."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.stats import beta

from benchmarks.blind import judge
from benchmarks.blind.judge import SEEN, VISIBLE, Row, class_of, exact, false_positive, first, named, right, wrong

_D_EDGES = (0, 3, 6, 8, 10, 15, 20, 50, 100, np.inf)


@dataclass(frozen=True)
class Bar:
    """A share (or a mean, with `count` cases) that shall be at least or at most `limit`."""

    title: str
    hits: float
    count: int
    limit: float
    at_least: bool
    share: bool = True

    @property
    def value(self) -> float:
        return (self.hits / self.count if self.share else self.hits) if self.count else float("nan")

    @property
    def passed(self) -> bool | None:
        if not self.count:
            return None
        return self.value >= self.limit if self.at_least else self.value <= self.limit


def clopper_pearson(hits: int, count: int, level: float = 0.95) -> tuple[float, float]:
    """Exact interval of a share.

    >>> clopper_pearson(0, 300)[1] < 0.0123
    True
    """
    tail = (1 - level) / 2
    low = float(beta.ppf(tail, hits, count - hits + 1)) if hits else 0.0
    high = float(beta.ppf(1 - tail, hits + 1, count - hits)) if hits < count else 1.0
    return low, high


def _share(title: str, rows: Sequence[Row], test: Callable[[Row], bool], limit: float, at_least: bool) -> Bar:
    return Bar(title, sum(map(test, rows)), len(rows), limit, at_least)


def _spurious(row: Row) -> bool:
    return bool(set(named(row)) - set(row["label"]["effects"]) - set(row["label"]["twins"]))


def bars(rows: Sequence[Row]) -> list[Bar]:
    """The bars of the proof."""
    by = defaultdict(list)
    for row in rows:
        by[class_of(row)].append(row)
    found = [_share("nulls: anything but none", by["null"], false_positive, 0.01, False)]
    for kind in dict.fromkeys(r["label"]["noise"] for r in by["null"]):
        some = [r for r in by["null"] if r["label"]["noise"] == kind]
        found.append(_share(f"  nulls, {kind} noise", some, false_positive, 0.03, False))
    single, tie, pair = by["single"], by["tie"], by["pair"]
    out = [r for r in by["outside"] if r["label"]["F0"] >= VISIBLE]
    sets = [len(named(r)) for r in tie if named(r)]
    judged = [r for r in rows if r.get("ratio") is not None]
    ratios = [r["ratio"] for r in single + pair + tie if r.get("ratio") is not None]
    return [
        *found,
        _share("single, testable: named first", single, first, 0.97, True),
        _share("single, testable: exactly that one", single, exact, 0.95, True),
        _share("single, testable: wrongly", single, wrong, 0.01, False),
        _share("confusable: truth in the set", tie, lambda r: r["label"]["effects"][0] in named(r), 0.97, True),
        Bar("confusable: mean size of the set", float(np.mean(sets)) if sets else 0.0, len(sets), 2.5, False, share=False),
        _share("outside, visible: called identified", out, lambda r: r["verdict"] == "identified", 0.03, False),
        _share("outside, visible: unknown", out, lambda r: r["verdict"] == "unknown", 0.95, True),
        _share("pairs: both named", pair, lambda r: set(r["label"]["effects"]) <= set(named(r)), 0.90, True),
        _share("pairs: a spurious third", pair, _spurious, 0.05, False),
        Bar("held-out excess ratio, median", float(np.median(ratios)) if ratios else 0.0, len(ratios), 0.3, False, share=False),
        _share("  held-out error worse than the base", judged, lambda r: r["ratio"] > 1, 0.02, False),
        _share("  confusable: a false single name", tie, judge.false_single, 0.05, False),
        _share("  outside, visible: anything accepted", out, lambda r: bool(named(r)), 0.05, False),
        _share("  single, rival too close: truth named", by["near"], lambda r: r["label"]["effects"][0] in named(r), 0.9, True),
        _share("  too small or untestable: named wrongly", by["hidden"], wrong, 0.02, False),
        _share("  untestable: listed as such", [r for r in rows if r["label"]["untestable"]],
               lambda r: set(r["label"]["untestable"]) <= set(r.get("untestable") or []), 1.0, True),
        _share("  crashed or out of time", rows, lambda r: r["verdict"] == "crash", 0.0, False),
    ]  # fmt: skip


def _bar_line(bar: Bar) -> str:
    sign = ">=" if bar.at_least else "<="
    if not bar.count:
        return f"| {bar.title} | - | {sign} {bar.limit:g} | 0 | - | no case |"
    verdict = "pass" if bar.passed else "**FAIL**"
    if not bar.share:
        return f"| {bar.title} | {bar.value:.3f} | {sign} {bar.limit:g} | {bar.count} | - | {verdict} |"
    low, high = clopper_pearson(int(bar.hits), bar.count)
    return f"| {bar.title} | {bar.value:.3f} | {sign} {bar.limit:g} | {int(bar.hits)}/{bar.count} | {low:.3f}-{high:.3f} | {verdict} |"


def _table(header: Sequence[str], rows: Sequence[Sequence[Any]]) -> list[str]:
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return lines + ["| " + " | ".join(str(c) for c in row) + " |" for row in rows] + [""]


def _said(row: Row) -> str:
    return (
        ", ".join(row["effects"]) + (f" {{{', '.join(sorted(row['confusable']))}}}" if row["confusable"] else "")
        or row["verdict"]
    )


def _by(rows: Sequence[Row], key: Callable[[Row], Any]) -> list[tuple[Any, list[Row]]]:
    groups: dict[Any, list[Row]] = defaultdict(list)
    for row in rows:
        groups[key(row)].append(row)
    return sorted(groups.items(), key=lambda item: str(item[0]))


def _counted(rows: Sequence[Row], key: Callable[[Row], Any], title: str) -> list[str]:
    lines = [
        (name, len(some), f"{sum(map(right, some)) / len(some):.2f}", sum(r["verdict"] == "none" for r in some),
         sum(r["verdict"] == "unknown" for r in some), sum(map(wrong, some)))
        for name, some in _by(rows, key)
    ]  # fmt: skip
    return _table((title, "cases", "right", "none", "unknown", "wrong"), lines)


def detection_table(rows: Sequence[Row]) -> list[str]:
    """How often a single effect is seen at all and named, against its distance from the linear model."""
    single = [r for r in rows if r["label"]["group"] in ("single", "tie", "untestable")]
    lines = []
    for low, high in pairwise(_D_EDGES):
        some = [r for r in single if low <= r["label"]["D"] < high]
        if some:
            seen = np.mean([r["verdict"] not in ("none", "crash") for r in some])
            hit = np.mean([bool(set(r["label"]["effects"]) & set(named(r))) for r in some])
            lines.append(
                (f"{low:g}-{high:g}", len(some), f"{seen:.2f}", f"{hit:.2f}", f"{np.mean(list(map(wrong, some))):.2f}")
            )
    return _table(("D", "cases", "seen", "truth named", "wrong"), lines)


def confusion_matrix(rows: Sequence[Row]) -> list[str]:
    """What was said, for every truth, most frequent first."""
    lines = []
    for truth, some in _by(rows, lambda r: " + ".join(r["label"]["effects"]) or "(none)"):
        said = Counter(map(_said, some))
        lines.append((truth, len(some), "; ".join(f"{n} x {what}" for what, n in said.most_common())))
    return _table(("truth", "cases", "said"), lines)


def scorecard(rows: Sequence[Row], title: str) -> str:
    """Everything about one method, in Markdown."""
    seconds = [r["seconds"] for r in rows]
    lines = [f"## {title}", "", f"{len(rows)} campaigns; seconds per campaign: median {np.median(seconds):.2f}, "
             f"95 % {np.quantile(seconds, 0.95):.2f}, largest {max(seconds):.2f}", ""]  # fmt: skip
    lines += ["| measure | value | bar | count | 95 % interval | |", "|---|---|---|---|---|---|"]
    lines += [_bar_line(bar) for bar in bars(rows)] + [""]
    lines += [f"### Detection against D (testable from D = {SEEN:g})", "", *detection_table(rows)]
    lines += ["### Truth against what was said", "", *confusion_matrix(rows)]
    known = [r for r in rows if r["label"]["group"] not in ("null", "outside")]
    for name, key in (
        ("class", class_of), ("design", lambda r: r["label"]["design"]), ("kind", lambda r: r["label"]["kind"]),
        ("noise", lambda r: f"{r['label']['noise']} {r['label']['size']:g}"),
        ("strength", lambda r: f"{r['label']['strength']:g}"),
    ):  # fmt: skip
        lines += [f"### By {name}", "", *_counted(rows, key, name)]
    lines += ["### By effect and variant", "", *_counted(known, _variant, "effect, variant")]
    return "\n".join(lines)


def _variant(row: Row) -> str:
    label = row["label"]
    return " + ".join(f"{e} ({v})" for e, v in zip(label["effects"], label["variants"]))


def side_by_side(by_method: Mapping[str, Sequence[Row]]) -> str:
    """One column of values per method."""
    columns = {name: bars(rows) for name, rows in by_method.items()}
    first_column = next(iter(columns.values()))
    lines = []
    for i, bar in enumerate(first_column):
        values = [f"{c[i].value:.3f}" if c[i].count else "-" for c in columns.values()]
        lines.append((bar.title, f"{'>=' if bar.at_least else '<='} {bar.limit:g}", *values))
    return "\n".join(["## Beside the baselines", "", *_table(("measure", "bar", *columns), lines)])

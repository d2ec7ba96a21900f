"""Tables on what a campaign holds and what it can show, for the terminal and for the page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from compare.findings import Separation
from compare.findings_sentences import with_units

CONFUSED = 0.05  # chance of confusion from which a pair is named
TESTABLE_COLUMNS = ("effect", "D", "at a size of", "would be seen from")
NOISE_COLUMNS = ("kind", "channel", "s", "phi", "white", "gain", "offset", "from")


def noise_cells(rows: Sequence[Mapping[str, Any]]) -> list[tuple[str, ...]]:
    """Noise of every kind and channel as text."""
    numbers = ("s", "phi", "white", "gain", "offset")
    return [(n["kind"], n["channel"], *(f"{n[k]:.3g}" for k in numbers), n["source"]) for n in rows]


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


def testable_rows(s: Separation, smallest_seen: Mapping[str, str]) -> list[tuple[str, ...]]:
    """Testable effects by their distance from the refitted base, in units of the noise."""
    order = sorted(range(len(s.effects)), key=lambda i: -s.distance[i])
    return [(s.effects[i], f"{s.distance[i]:.3g}", s.size[i], smallest_seen.get(s.effects[i], "-")) for i in order]


def confused_rows(s: Separation) -> list[tuple[str, ...]]:
    """Pairs above the threshold, most likely first; each pair once, with the larger of the two chances."""
    pairs = []
    for i, name in enumerate(s.effects):
        for j in range(i):
            chance = max(float(s.confusion[i, j]), float(s.confusion[j, i]))
            if chance > CONFUSED:
                pairs.append((chance, s.effects[j], name))
    return [(a, b, f"{100 * p:.0f} %") for p, a, b in sorted(pairs, reverse=True)]

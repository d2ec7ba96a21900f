"""One answer against its label: which of the yes/no questions of the scorecard it answers, and how."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Row = Mapping[str, Any]
SEEN = 6.0
"""Distance from which an effect counts as testable."""
CLOSE = 5.0
"""Distance from the nearest rival below which no method can be sure of the name."""
VISIBLE = 1.2
"""Lack of fit from which a truth outside the library counts as clearly visible."""


def named(row: Row) -> list[str]:
    """Everything that the answer names, accepted or in its set."""
    return [*row["effects"], *(c for c in row["confusable"] if c not in row["effects"])]


def class_of(row: Row) -> str:
    """What the label says: null, single, tie, outside, pair, near (a rival too close), hidden (untestable or too small)."""
    label = row["label"]
    if label["group"] in ("null", "outside"):
        return str(label["group"])
    if label["group"] == "untestable" or label["untestable"] or min(label["D_alone"]) < SEEN:
        return "hidden"
    if len(label["effects"]) > 1:
        return "pair"
    if label["twins"]:
        return "tie"
    return "single" if label["apart"] >= CLOSE else "near"


def first(row: Row) -> bool:
    """Whether the truth is what is named first: accepted first, or at the top of the set where nothing is accepted."""
    truth = row["label"]["effects"][0]
    if row["effects"]:
        return row["effects"][0] == truth
    if truth not in row["confusable"]:
        return False
    rank = [c[0] for c in row.get("ranking") or [] if c[0] in row["confusable"]]
    return not rank or rank[0] == truth


def exact(row: Row) -> bool:
    """The truth, nothing else, and no open set."""
    return list(row["effects"]) == list(row["label"]["effects"]) and not row["confusable"]


def wrong(row: Row) -> bool:
    """Something is named and the truth is not among it, or the method broke down."""
    truth = set(row["label"]["effects"])
    return row["verdict"] == "crash" or (bool(named(row)) and not truth & set(named(row)))


def false_single(row: Row) -> bool:
    """Of an exact tie: a name without its set; of a near one: a name that is not the truth."""
    return bool(row["effects"]) and not row["confusable"] and (bool(row["label"]["tied"]) or wrong(row))


def false_positive(row: Row) -> bool:
    """Of a null: anything but none."""
    return row["verdict"] != "none"


def right(row: Row) -> bool:
    """Whether the answer is as good as the label allows; for the list of failures."""
    label, kind = row["label"], class_of(row)
    if kind == "null":
        return not false_positive(row)
    if kind == "outside":
        return row["verdict"] == "unknown"
    if kind == "tie":
        return label["effects"][0] in (row["confusable"] if label["tied"] else named(row)) and not wrong(row)
    if kind == "near":
        return label["effects"][0] in named(row)
    if kind == "pair":
        return set(label["effects"]) <= set(named(row)) and not set(row["effects"]) - set(label["effects"])
    if kind == "hidden":
        return not wrong(row)
    return exact(row)

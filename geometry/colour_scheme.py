"""One colour for each kind of part, the same in every picture."""

from __future__ import annotations

KIND_COLOURS = {
    "conductor": "#c8743c",
    "insulation": "#e9dcc0",
    "screen": "#8d98a3",
    "cover": "#4d5560",
    "interstices": "#7fa3b5",
    "wrap": "#e3b23c",
    "sheath": "#2b2f36",
}
"""Copper, EPR cream, braid grey, semiconducting graphite, bedding blue, tape yellow, rubber black."""

KIND_TITLES = {
    "conductor": "conductor (copper)",
    "insulation": "insulation",
    "screen": "screen",
    "cover": "conductor cover",
    "interstices": "interstices (bedding)",
    "wrap": "wrap",
    "sheath": "sheath",
}


def kind_colour(kind: str) -> str:
    """Colour of a kind of part, grey for a kind that is not known."""
    return KIND_COLOURS.get(kind, "#999999")

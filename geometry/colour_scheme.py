"""One colour for each kind of part, the same in every picture."""

from __future__ import annotations

KIND_COLOURS = {
    "conductor": "#c8743c",
    "insulation": "#e9dcc0",
    "screen": "#8d98a3",
    "cover": "#4d5560",
    "interstices": "#7fa3b5",
    "armour": "#aeb9c2",
    "wire": "#b9c0c6",
    "bedding": "#5e6b57",
    "tape": "#d9c48a",
    "wrap": "#e3b23c",
    "sheath": "#2b2f36",
}
"""Copper, EPR cream, braid grey, semiconducting graphite, filler blue, zinc, bright steel, bitumen green, cloth, tape yellow,
rubber black."""

KIND_TITLES = {
    "conductor": "conductor",
    "insulation": "insulation",
    "screen": "screen",
    "cover": "conductor cover",
    "interstices": "interstices (bedding)",
    "armour": "armour",
    "wire": "wires",
    "bedding": "bedding",
    "tape": "tape",
    "wrap": "wrap",
    "sheath": "sheath",
}

STEEL = "#b9c0c6"
ALUMINIUM = "#d3d8dc"
VOID = "#f4efe7"
"""Gaps between the strands of a conductor."""
INK = "#22262b"
SOFT = "#6b7178"


def kind_colour(kind: str) -> str:
    """Colour of a kind of part, grey for a kind that is not known."""
    return KIND_COLOURS.get(kind, "#999999")


def part_colour(kind: str, density: float, modulus: float) -> str:
    """Colour of a part; metal conductors by their metal: steel and aluminium are not drawn as copper.

    A stranded conductor as a cylinder is lighter and softer than its metal: the ratio E / density tells them apart
    (copper about 10, steel 26, aluminium 26 with a third of the density, MN m / kg).

    >>> part_colour("conductor", 7850.0, 200e9) == STEEL, part_colour("conductor", 6343.0, 80e9) == KIND_COLOURS["conductor"]
    (True, True)
    """
    kind = "conductor" if kind == "strand" else kind
    if kind != "conductor" or density <= 0 or modulus / density < 18e6:
        return kind_colour(kind)
    return STEEL if density > 3200 else ALUMINIUM

"""The kinds of experiment of a campaign and the channels that each may record.

============  =========================================  =====================  ==================================
kind          path (one of them)                         load                   further channels
============  =========================================  =====================  ==================================
tension       extension u [m], strain epsilon = u / L    force N [N]            torque (rotation blocked) [N m]
torsion       rotation theta [rad], twist tau = theta/L  torque M_z [N m]       force [N]
bending       curvature kappa [1/m]                      moment M [N m]
shear         deflection u [m] of a cantilever           force F [N]
towing        position [m] or speed [m/s]                tension [N]            tension at s, lateral displacement at s
============  =========================================  =====================  ==================================

The path is prescribed and the load measured, unless the column ``control`` names the load: then it is the other way
round. L is the specimen length. Source: the campaign contract of helicable, after the usual bench
tests of cables.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

SETS = ("calibrate", "validate", "sealed")
DIRECTIONS = ("x+", "x-", "y+", "y-")


@dataclass(frozen=True)
class Quantity:
    """A channel or condition: its name, its SI unit, and the SI units that a column of it may convert from.

    ``accepts`` keeps angles apart from pure numbers: a curvature may be given per metre or in rad/m, a strain not in
    degrees.
    """

    name: str
    unit: str
    accepts: tuple[str, ...]


def _quantity(name: str, unit: str, *also: str) -> Quantity:
    return Quantity(name, unit, (unit, *also))


QUANTITIES = {
    q.name: q
    for q in (
        _quantity("time", "s"),
        _quantity("extension", "m"),
        _quantity("strain", "1"),
        _quantity("rotation", "rad"),
        _quantity("twist", "rad/m", "1/m"),
        _quantity("curvature", "1/m", "rad/m"),
        _quantity("deflection", "m"),
        _quantity("position", "m"),
        _quantity("speed", "m/s"),
        _quantity("force", "N"),
        _quantity("torque", "N m"),
        _quantity("moment", "N m"),
        _quantity("tension", "N"),
    )
}

CONDITIONS = {
    q.name: q
    for q in (
        _quantity("temperature", "K"),
        _quantity("axial tension", "N"),
        _quantity("tail tension", "N"),
        _quantity("specimen length", "m"),
        _quantity("inclination", "rad"),
        _quantity("speed", "m/s"),
        Quantity("frequency", "Hz", ("1/s",)),
    )
}

_STATIONS = {"tension": "N", "lateral displacement": "m"}
_STATION_NAME = re.compile(r"(tension|lateral displacement) at (\d+(?:\.\d*)?|\.\d+)")


@dataclass(frozen=True)
class Kind:
    """One kind of experiment: its possible paths, its load, its optional channels, and whether stations are allowed."""

    name: str
    paths: tuple[str, ...]
    load: str
    optional: tuple[str, ...] = ()
    stations: bool = False


KINDS = {
    k.name: k
    for k in (
        Kind("tension", ("extension", "strain"), "force", ("torque",)),
        Kind("torsion", ("rotation", "twist"), "torque", ("force",)),
        Kind("bending", ("curvature",), "moment"),
        Kind("shear", ("deflection",), "force"),
        Kind("towing", ("position", "speed"), "tension", stations=True),
    )
}

PATHS_OF_A_LENGTH = ("extension", "rotation", "deflection")
"""Paths that mean something only together with the specimen length."""


def station(name: str) -> float | None:
    """Distance s [m] from the towed end in ``"tension at 15"``, or None for a channel without a station.

    >>> station("tension at 15"), station("tension")
    (15.0, None)
    """
    match = _STATION_NAME.fullmatch(name)
    return float(match[2]) if match else None


def channel_quantity(name: str) -> Quantity | None:
    """The quantity of a channel of that name, or None if there is no such channel."""
    match = _STATION_NAME.fullmatch(name)
    return _quantity(name, _STATIONS[match[1]]) if match else QUANTITIES.get(name)


def allowed_channels(kind: Kind) -> tuple[str, ...]:
    """Every plain channel name that a table of this kind may hold (stations apart)."""
    return ("time", *kind.paths, kind.load, *kind.optional)

r"""Common period of nested lays: the height after which everything in a cable stands as before, and the nearest lays that have one.

A cell of height H whose ends are joined by the motion x -> R_z(Omega H) x + H e_z serves a layer when that motion carries
the layer into itself. A layer of `fold` equal members that turns at the rate omega against the motion does so when

.. math::  \omega H = 2\pi k / \mathrm{fold}, \qquad k \text{ whole} .

About the cable axis omega = h 2 pi / p - Omega; for a pure translation (Omega = 0) this is the rule l = k_j p_j / n_j of
Menard and Cartraud, Marine Structures 91 (2023) 103465. For strands of a conductor on a core helix omega is the turn
rate in the core's own frame (bent_lay.py), and Omega the cabling rate. Lays drawn from a real cable are never exactly
commensurate: they are adjusted. With omega given, the lay follows from h 2 pi / p = (omega + Omega / q) / q,
q = sqrt(1 + (r Omega)^2), and the lay angle from tan beta = 2 pi radius / p.

Which period is taken: the shortest at which no lay angle changes by more than the tolerance counts as the measure; of
all periods up to `ECONOMY` times that one, the one with the smallest largest change is chosen. Straight
members stay straight where that is possible, else they are given a long lay. The search itself is in period_search.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from math import gcd

import numpy as np

from geometry.bent_lay import lay_rate
from geometry.cable import Cable
from geometry.errors import GeometryError
from geometry.matched_lay import CommonPeriod, LayeredLay, MatchedLay
from geometry.period_search import STEEPEST, PeriodSearch
from geometry.strand import layer_radii

__all__ = ["TOLERANCE", "CommonPeriod", "LayeredLay", "MatchedLay", "cell_of", "common_period"]

TOLERANCE = float(np.radians(0.5))
"""Change of a lay angle [rad] that is accepted when nothing else is asked for."""


def common_period(
    layers: Sequence[LayeredLay],
    reference: str | None = None,
    *,
    twist_rate: float = 0.0,
    tolerance: float = TOLERANCE,
    longest: float | None = None,
    height: float | None = None,
) -> CommonPeriod | None:
    """Nearest commensurate lays and their common period; None where every height will do, because no layer turns.

    Parameters
    ----------
    layers : the layers that have to match
    reference : layer that the cell's motion follows, so that only turning relative to it counts; None for `twist_rate`
    twist_rate : of the cell's motion [rad/m], signed; 0 for a pure translation
    tolerance : largest accepted change of a lay angle [rad]
    longest : longest accepted period [m]; None takes the longest lay there is
    height : period to match [m] instead of a search; the nearest whole numbers of turns are taken

    Raises
    ------
    GeometryError
        If a lay angle would change by more than the tolerance; names the layer, and the longer period or the larger
        tolerance that would do.

    Examples
    --------
    Two layers of wires that need 0.6 m together, of which a thirtieth will do:

    >>> inner = LayeredLay("inner", 0.020, 0.300, "Z", 30)
    >>> outer = LayeredLay("outer", 0.024, 0.402, "S", 40)
    >>> cell = common_period([inner, outer])
    >>> round(cell.height, 5), [layer.turns for layer in cell.layers]
    (0.01002, [1, -1])
    """
    _check(tolerance, longest, height, twist_rate)
    if reference is not None:
        followed = next((layer for layer in layers if layer.name == reference), None)
        if followed is None:
            raise GeometryError(
                f'there is no layer "{reference}" to follow; known are {", ".join(l.name for l in layers)}.'
            )
        twist_rate = lay_rate(followed.lay, followed.hand)
    search = PeriodSearch(tuple(layers), twist_rate)
    if height is not None:
        return search.at(height, tolerance)
    if all(search.rate(layer) == 0 for layer in layers):
        return None
    return search.best(tolerance, longest or search.longest_lay())


def cell_of(cable: Cable, longest: float | None = None, tolerance: float = TOLERANCE) -> CommonPeriod | None:
    """Period of a cable whose conductors have strands, or which has wires of several lays: the cabling lay is kept.

    A conductor that lies in several cores of one radius counts once, with one lay for all its layers; the angle that
    counts is that of its outer strands. Conductors given as one cylinder ask for nothing.

    Parameters
    ----------
    longest : longest accepted period [m]; None takes the longest lay in the cable
    tolerance : largest accepted change of a lay angle [rad]

    Returns
    -------
    CommonPeriod or None
        Layers carry the name of the conductor or of the layer of wires. None if no part turns relative to the
        cable's section: then every height is a period.

    Raises
    ------
    GeometryError
        As `common_period`.

    Examples
    --------
    >>> from geometry import read_cable
    >>> cell = cell_of(read_cable("mcpt-1.9-3.3-3x35"))
    >>> round(1e3 * cell.height, 3), round(1e3 * cell.layer("power").lay, 2), cell.layer("power").turns
    (78.0, 125.42, 2)
    """
    return common_period(_layers_of(cable), twist_rate=cable.twist_rate, tolerance=tolerance, longest=longest)


def _layers_of(cable: Cable) -> list[LayeredLay]:
    """Stranded conductors by name and core radius, and layers of wires laid about the cable axis."""
    found: dict[tuple[str, float], LayeredLay] = {}
    wires = [part.layer for part in cable.parts]
    for part in cable.parts:
        conductor = cable.conductor_of(part)
        if part.layer is not None:
            lay = 2 * np.pi / abs(part.twist_rate) if part.twist_rate else None
            hand = "S" if part.twist_rate < 0 else "Z"
            layer = LayeredLay(part.layer, part.centre_radius, lay, hand, wires.count(part.layer))
            found.setdefault((part.layer, 0.0), layer)
        elif conductor is not None and conductor.strand is not None and sum(conductor.layers) > 1:
            radius = layer_radii(conductor.layers, conductor.strand.diameter, conductor.name)[-1]
            fold = reduce(gcd, [count for count in conductor.layers if count > 1])
            r = part.centre_radius
            layer = LayeredLay(conductor.name, radius, conductor.lay, conductor.hand, fold, r)
            found.setdefault((conductor.name, round(r, 9)), layer)
    return list(found.values())


def _check(tolerance: float, longest: float | None, height: float | None, twist_rate: float) -> None:
    if not (0 <= tolerance < STEEPEST):
        raise GeometryError(
            f"the tolerance of a lay angle must lie between 0 and {np.degrees(STEEPEST):.0f} deg, found {np.degrees(tolerance):.4g} deg."
        )
    for what, length in (("longest period", longest), ("height of a cell", height)):
        if length is not None and not (np.isfinite(length) and length > 0):
            raise GeometryError(f"the {what} must be a positive length, found {length:g} m.")
    if not np.isfinite(twist_rate):
        raise GeometryError(f"the twist rate of a cell must be finite, found {twist_rate:g} rad/m.")

r"""Do helical members clear each other? The distance between centre lines, not the chord in the section.

Two helices of one lay p with radii r1, r2 and the angle a between them are apart by

.. math::  \min_d \sqrt{r_1^2 + r_2^2 - 2 r_1 r_2 \cos(a + d) + (p\, d / 2\pi)^2},

and round members clear by that distance minus the sum of their radii. The distance is shorter than the chord
(d = 0), because the neighbour is nearer a little further along the lay: circles that clear can belong to cores that cut.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from geometry.errors import GeometryError

TOUCH = 1e-6
"""Members that overlap by less than this [m] count as touching."""


@dataclass(frozen=True)
class Member:
    """Round member laid round the cable axis: `name`, `centre_radius` [m], `phase` [rad], `radius` [m]."""

    name: str
    centre_radius: float
    phase: float
    radius: float


@dataclass(frozen=True)
class Clearance:
    """Gap [m] between two members, negative where they overlap."""

    first: str
    second: str
    gap: float


def helix_distance(r1: float, r2: float, angle: float, lay: float | None) -> float:
    """Shortest distance [m] between two helices about one axis with one lay [m]; None for straight lines.

    Examples
    --------
    Neighbouring cores of the reference cable; the chord would be 16.44 mm:

    >>> round(1e3 * helix_distance(11.625e-3, 11.625e-3, np.pi / 2, 234e-3), 3)
    16.036
    """
    if lay is None:
        return float(np.sqrt(r1**2 + r2**2 - 2 * r1 * r2 * np.cos(angle)))

    def square(d: np.ndarray) -> np.ndarray:
        return r1**2 + r2**2 - 2 * r1 * r2 * np.cos(angle + d) + (lay * d / (2 * np.pi)) ** 2

    d = np.linspace(-2 * np.pi, 2 * np.pi, 721)
    step = d[1] - d[0]
    best = d[int(np.argmin(square(d)))]
    for _ in range(4):
        d = np.linspace(best - step, best + step, 201)
        best, step = d[int(np.argmin(square(d)))], d[1] - d[0]
    return float(np.sqrt(max(square(np.array(best)), 0.0)))


def clearances(members: list[Member], lay: float | None) -> list[Clearance]:
    """Gap of every pair of members, and of every member from its own next turn, smallest first."""
    found = []
    for i, a in enumerate(members):
        for b in members[i + 1 :]:
            distance = helix_distance(a.centre_radius, b.centre_radius, b.phase - a.phase, lay)
            found.append(Clearance(a.name, b.name, distance - a.radius - b.radius))
        if lay is not None and a.centre_radius > 0:
            found.append(Clearance(a.name, f"the next turn of {a.name}", _next_turn(a, lay) - 2 * a.radius))
    return sorted(found, key=lambda c: c.gap)


def neighbour_gap(count: int, radius: float, diameter: float, lay: float | None) -> float:
    """Gap [m] between neighbours of `count` equal members at equal angles on one circle; of one member, to its next turn.

    Examples
    --------
    Six wires of 3.73 mm round one of 3.94 mm at a lay of 115 mm; the circles in the section would clear by 0.105 mm:

    >>> round(1e3 * neighbour_gap(6, 3.835e-3, 3.73e-3, 0.115), 4)
    0.0427
    """
    if count == 1:
        return np.inf if lay is None else _next_turn(Member("", radius, 0.0, diameter / 2), lay) - diameter
    return helix_distance(radius, radius, 2 * np.pi / count, lay) - diameter


def shortest_lay(count: int, radius: float, diameter: float, lay: float | None) -> float | None:
    """Shortest lay [m] from `lay` on at which neighbours clear each other; None if they overlap even when straight."""
    if lay is None or (count > 1 and neighbour_gap(count, radius, diameter, None) < 0):
        return None
    return _smallest(lambda x: neighbour_gap(count, radius, diameter, x), lay, 1e3 * lay)


def check_clearance(
    members: list[Member], lay: float | None, try_centre: Callable[[float], list[Member]] | None = None
) -> None:
    """Raise if two members overlap, with the lay or the centre that would fit.

    Parameters
    ----------
    members : all members of one layer and the centre
    lay : cabling lay [m], None for a straight cable
    try_centre : gives the members that result when the diameter of the centre grows by some length [m]

    Raises
    ------
    GeometryError
        Names the two parts, the overlap, and what would fit.
    """
    pairs = clearances(members, lay)
    if not pairs or pairs[0].gap >= -TOUCH:
        return
    worst = pairs[0]
    advice = []
    if try_centre is not None:
        grow = _smallest(lambda x: _gap(try_centre(x), lay), 0.0, 4 * max(m.radius for m in members))
        if grow is not None:
            advice.append(f"enlarge the centre by {1e3 * _round_up(grow, 1e-5):.2f} mm in diameter")
    if lay is not None:
        fitting = _smallest(lambda x: _gap(members, x), lay, 100 * lay)
        if fitting is not None:
            advice.append(
                f"lengthen the lay from {1e3 * lay:.4g} mm to at least {1e3 * _round_up(fitting, 1e-4):.1f} mm"
            )
    advice = advice or ["make the parts thinner or move them further from the axis"]
    along = " along the lay, although their circles clear in the section" if _gap(members, None) >= -TOUCH else ""
    raise GeometryError(
        f"{worst.first} and {worst.second} overlap by {-1e3 * worst.gap:.3f} mm{along}: {', or '.join(advice)}."
    )


def touching_radius(place: Callable[[float], list[Member]], lay: float | None, largest: float) -> float:
    """Smallest inner radius [m] at which the members that `place` puts there clear each other.

    Raises
    ------
    GeometryError
        If no radius up to `largest` lets them fit.
    """
    radius = _smallest(lambda x: _gap(place(x), lay), 0.0, largest)
    if radius is None:
        raise GeometryError(f"the cores fit on no circle at a lay of {1e3 * (lay or 0):.4g} mm: lengthen the lay.")
    return radius


def _gap(members: list[Member], lay: float | None) -> float:
    pairs = clearances(members, lay)
    return pairs[0].gap if pairs else np.inf


def _next_turn(member: Member, lay: float) -> float:
    d = np.linspace(np.pi, 2.5 * np.pi, 361)
    square = 2 * member.centre_radius**2 * (1 - np.cos(d)) + (lay * d / (2 * np.pi)) ** 2
    return float(np.sqrt(square.min()))


def _smallest(gap: Callable[[float], float], low: float, high: float) -> float | None:
    """Smallest x in [low, high] with gap(x) >= 0, where the gap grows with x; None if even `high` does not fit."""
    if gap(high) < 0:
        return None
    if gap(low) >= 0:
        return low
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if gap(middle) >= 0 else (middle, high)
        if high - low < 1e-10:
            break
    return high


def _round_up(value: float, step: float) -> float:
    return float(np.ceil(value / step - 1e-6) * step)

r"""One layer of equal round members laid at equal angles round an axis: does it fit, where does it sit, how steep may it lie?

n members of diameter d and lay p on the twisting radius R. With P = p / 2 pi the centre lines of neighbours are apart by

.. math::  D(n, R, p) = \min_x \sqrt{2 R^2 (1 - \cos x) + P^2 (x - 2\pi/n)^2},

exactly (clearance.py), and the members just touch where D = d. D grows with R and with p and falls with n, so that each
of these equations has one solution or none:

* radius: D < p / n on every radius, so n members of d need a lay longer than n d; below that nothing fits;
* lay angle: D / R depends on n and beta only, so R = d / D(n, 1, 2 pi / tan beta). The largest angle at which n members
  of d go on R is the locking limit of the layer;
* a layer that rests on the one below, of outer radius r0, and touches in itself: D(n, r0 + d / 2, p) = d.

Contact condition of strands: Costello, Theory of Wire Rope, 2nd ed. 1997, section 2.2, there by the elliptic section
of the wire, which is the first order of D.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from geometry.clearance import TOUCH, helix_distance
from geometry.errors import GeometryError
from geometry.helix import lay_angle as angle_of

LARGEST_COUNT = 100_000


@dataclass(frozen=True)
class StrandLayer:
    """Layer of `count` round members of `diameter` [m] on the twisting `radius` [m].

    Attributes
    ----------
    lay : pitch [m], None for straight members
    lay_angle : angle of the members to the axis [rad], not signed
    gap_to_neighbour : clearance of neighbours along the lay [m]; inf for a single member
    gap_below : clearance to the layer below [m]; None where nothing is said about it
    """

    count: int
    diameter: float
    radius: float
    lay: float | None
    lay_angle: float
    gap_to_neighbour: float
    gap_below: float | None = None

    @property
    def outer_radius(self) -> float:
        """Radius over the layer [m]."""
        return self.radius + self.diameter / 2

    @property
    def locking_angle(self) -> float:
        """Largest lay angle [rad] at which as many members fit on this radius: there neighbours touch."""
        return (
            angle_of(self.radius, lay_for_contact(self.count, self.diameter, self.radius))
            if self.count > 1
            else np.pi / 2
        )


def neighbour_distance(count: int, radius: float, lay: float | None) -> float:
    """Shortest distance D [m] between the centre lines of neighbours; inf for a single member.

    Examples
    --------
    >>> round(1e3 * neighbour_distance(6, 3.016e-3, 127e-3), 3)
    2.991
    """
    return np.inf if count == 1 else helix_distance(radius, radius, 2 * np.pi / count, lay)


def layer_gap(count: int, diameter: float, radius: float, lay: float | None) -> float:
    """Clearance of neighbours [m], negative where they overlap."""
    return neighbour_distance(count, radius, lay) - diameter


def twisting_radius(count: int, diameter: float, lay: float | None = None, *, lay_angle: float | None = None) -> float:
    """Smallest radius [m] on which the members clear each other: there neighbours touch. Give the lay [m] or the lay angle [rad].

    Raises
    ------
    GeometryError
        If the lay is so short that the members fit on no radius.

    Examples
    --------
    >>> round(1e3 * twisting_radius(6, 3.016e-3, 127e-3), 4)
    3.0416
    """
    _check(count=count, diameter=diameter, lay=lay, lay_angle=lay_angle)
    if count == 1:
        return 0.0
    if lay_angle is not None:
        return diameter / neighbour_distance(count, 1.0, _lay(1.0, lay_angle))
    if lay is not None and lay <= count * diameter * (1 + 1e-6):
        raise GeometryError(
            f"{count} members of {_mm(diameter)} fit on no radius at a lay of {_mm(lay)}, because side by side along the axis they take "
            f"{_mm(count * diameter)}: lengthen the lay beyond that, or take fewer members."
        )
    high = diameter
    while layer_gap(count, diameter, high, lay) < 0:
        high *= 2
    return _root(lambda radius: layer_gap(count, diameter, radius, lay), 0.0, high)


def largest_count(diameter: float, radius: float, lay: float | None) -> int:
    """Largest number of members that fit on a radius [m] without overlap of more than a micrometre.

    Examples
    --------
    >>> largest_count(1.0, 1.0, None), largest_count(1.0, 1.0, 20.0)
    (6, 5)
    """
    _check(diameter=diameter, radius=radius, lay=lay)
    touching = diameter - min(TOUCH, 1e-3 * diameter)
    bound = 2 * np.pi * radius * np.cos(angle_of(radius, lay)) / touching
    if bound > LARGEST_COUNT:
        raise GeometryError(
            f"a layer on the radius {_mm(radius)} has room for some {bound:.2g} members of {_mm(diameter)}, more than {LARGEST_COUNT}: "
            "check the units of both."
        )
    count = max(int(bound + 1e-9), 2 if 2 * radius >= touching else 1)
    while count > 1 and neighbour_distance(count, radius, lay) < touching:
        count -= 1
    return count


def tangent_diameter(
    count: int, lay: float | None, *, radius: float | None = None, radius_below: float | None = None
) -> float:
    """Diameter [m] of members that just touch their neighbours.

    Parameters
    ----------
    count : at least 2
    lay : [m], None for straight members
    radius : twisting radius [m]; or
    radius_below : outer radius [m] of the layer below, on which the members are to rest

    Raises
    ------
    GeometryError
        If no diameter fits (two straight members on a centre never touch each other).

    Examples
    --------
    >>> round(1e3 * tangent_diameter(6, 127e-3, radius_below=1.508e-3), 3)
    2.967
    """
    _check(count=count, lay=lay, radius=radius, radius_below=radius_below)
    if count < 2:
        raise GeometryError("a single member has no neighbour that would set its diameter: give the diameter.")
    if (radius is None) == (radius_below is None):
        raise GeometryError(
            "the diameter of a layer needs either its twisting radius or the radius of the layer below."
        )
    if radius is not None:
        return neighbour_distance(count, radius, lay)
    below = float(radius_below or 0.0)

    def overlap(diameter: float) -> float:
        return -layer_gap(count, diameter, below + diameter / 2, lay)

    high = max(below, 1e-9)
    while overlap(high) < 0:
        high *= 2
        if high > 1e6 * max(below, 1e-9):
            raise GeometryError(
                f"{count} members that rest on a layer of radius {_mm(below)} never touch each other, however thick they are: "
                "take at least 3 members, or give the diameter."
            )
    return _root(overlap, 0.0, high)


def lay_for_contact(count: int, diameter: float, radius: float) -> float | None:
    """Shortest lay [m] at which the members fit on the radius: there neighbours touch, and the lay angle is the locking limit.

    None if they touch when straight (to a micrometre), so that they bear no lay at all.

    Raises
    ------
    GeometryError
        If they do not even fit straight.

    Examples
    --------
    Six of 2.967 mm round a strand of 3.016 mm:

    >>> round(1e3 * (lay_for_contact(6, 2.9672e-3, 2.9916e-3) or 0))
    127
    """
    _check(count=count, diameter=diameter, radius=radius)
    if count == 1:
        raise GeometryError("a single member has no neighbour that would set its lay: give the lay.")
    straight = layer_gap(count, diameter, radius, None)
    touch = min(TOUCH, 1e-3 * diameter)
    if straight < -touch:
        raise GeometryError(_too_many(count, diameter, radius, None))
    if straight <= 1e-9 * diameter:
        return None
    high = count * diameter
    while layer_gap(count, diameter, radius, high) < 0:
        high *= 2
    return _root(lambda lay: layer_gap(count, diameter, radius, lay), 1e-3 * diameter, high)


def solve_layer(
    *,
    count: int | None = None,
    diameter: float | None = None,
    radius: float | None = None,
    lay: float | None = None,
    lay_angle: float | None = None,
    radius_below: float | None = None,
) -> StrandLayer:
    """The layer that follows from what is given; at most one of count, diameter and radius is found by contact.

    Parameters
    ----------
    count : without it, as many members as fit
    diameter : [m]; without it, members that touch their neighbours, and the layer below if only that is given
    radius : twisting radius [m]; without it, the smallest that is free of overlap: on the layer below, or, where the
        members are too many for that, standing off it and touching each other
    lay, lay_angle : one of them, or neither for straight members [m, rad]
    radius_below : outer radius of the layer below [m]

    Raises
    ------
    GeometryError
        If too little or too much is given, a size is not positive, the members are too many, the lay angle is past the
        locking limit, or members reach into the layer below.

    Examples
    --------
    >>> solve_layer(count=6, diameter=3.016e-3, lay=127e-3, radius_below=1.508e-3).gap_below > 0.02e-3
    True
    """
    _check(count=count, diameter=diameter, radius=radius, lay=lay, lay_angle=lay_angle, radius_below=radius_below)
    if lay is not None and lay_angle is not None:
        raise GeometryError("a layer is given by its lay or by its lay angle, not by both: leave one out.")
    if (count is None) + (diameter is None) > 1:
        raise GeometryError("a layer needs its count or the diameter of its members: give one of them.")
    if radius is None and radius_below is None and (count is None or diameter is None):
        raise GeometryError(
            "a layer needs its twisting radius, the radius of the layer below, or both count and diameter."
        )
    if diameter is None:
        assert count is not None
        diameter = _found_diameter(count, radius, radius_below, lay, lay_angle)
    if radius is None:
        radius = _found_radius(count, diameter, radius_below, lay, lay_angle)
    if lay_angle is not None:
        lay = _lay(radius, lay_angle)
    if count is None:
        count = largest_count(diameter, radius, lay)
    gap = layer_gap(count, diameter, radius, lay)
    touch = min(TOUCH, 1e-3 * diameter)
    if gap < -touch:
        raise GeometryError(_too_many(count, diameter, radius, lay))
    below = None if radius_below is None else radius - diameter / 2 - radius_below
    if below is not None and below < -touch:
        raise GeometryError(
            f"members of {_mm(diameter)} on the radius {_mm(radius)} reach {_mm(-below)} into the layer below, whose outer radius is "
            f"{_mm(float(radius_below or 0))}: enlarge the radius to {_mm(radius - below)}, or take members of {_mm(diameter + 2 * below)}."
        )
    return StrandLayer(count, diameter, radius, lay, angle_of(radius, lay), gap, below)


def _found_diameter(
    count: int, radius: float | None, below: float | None, lay: float | None, lay_angle: float | None
) -> float:
    if lay_angle is None:
        return tangent_diameter(count, lay, radius=radius, radius_below=None if radius is not None else below)
    if radius is not None:
        return tangent_diameter(count, _lay(radius, lay_angle), radius=radius)
    if count < 2:
        raise GeometryError("a single member has no neighbour that would set its diameter: give the diameter.")
    ratio = neighbour_distance(count, 1.0, _lay(1.0, lay_angle))  # d = ratio (r0 + d / 2)
    if ratio >= 2:
        raise GeometryError(
            f"{count} members that rest on a layer never touch each other at {np.degrees(lay_angle):.4g} deg: give the diameter."
        )
    return ratio * float(below or 0.0) / (1 - ratio / 2)


def _found_radius(
    count: int | None, diameter: float, below: float | None, lay: float | None, lay_angle: float | None
) -> float:
    rests = 0.0 if below is None else below + diameter / 2
    if count is None:
        return rests
    return max(rests, twisting_radius(count, diameter, lay, lay_angle=lay_angle))


def _too_many(count: int, diameter: float, radius: float, lay: float | None) -> str:
    """Sentence for a layer without room: by how much, and what would fit."""
    gap, angle = layer_gap(count, diameter, radius, lay), angle_of(radius, lay)
    found = f"{count} members of {_mm(diameter)} overlap by {_mm(-gap)} on the radius {_mm(radius)}"
    room = largest_count(diameter, radius, lay)
    if lay is None or layer_gap(count, diameter, radius, None) < 0:
        return f"{found}, which has room for {room}: take fewer or thinner members, or enlarge the radius."
    limit = lay_for_contact(count, diameter, radius)
    return (
        f"{found} at a lay angle of {np.degrees(angle):.4g} deg, past the locking limit of {np.degrees(angle_of(radius, limit)):.4g} deg "
        f"at which neighbours touch: lengthen the lay from {_mm(lay)} to at least {_mm(_rounded_up(limit or 0.0))}, or take {room} members."
    )


def _lay(radius: float, lay_angle: float) -> float | None:
    """Lay [m] of a lay angle; None for straight members (less than 1e-9 rad)."""
    return None if lay_angle < 1e-9 or radius == 0 else float(2 * np.pi * radius / np.tan(lay_angle))


def _root(grows: Callable[[float], float], low: float, high: float) -> float:
    """Smallest x in [low, high] with grows(x) >= 0, to round-off, where grows(high) >= 0."""
    while high - low > 1e-14 * high:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (low, middle) if grows(middle) >= 0 else (middle, high)
    return high


def _check(**given: float | None) -> None:
    """Each size that is given is finite and positive (a radius may be zero), the count a whole number, the angle below 90 deg."""
    for key, value in given.items():
        if value is None:
            continue
        what = key.replace("_", " ")
        if key == "count":
            if not (isinstance(value, (int, np.integer)) and 1 <= value <= LARGEST_COUNT):
                raise GeometryError(
                    f"the count of a layer must be a whole number from 1 to {LARGEST_COUNT}, found {value}."
                )
        elif key == "lay_angle":
            if not 0 <= value < np.radians(89.9):
                raise GeometryError(
                    f"the lay angle of a layer must lie between 0 and 89.9 deg, found {np.degrees(value):.4g} deg; give the hand as Z or S."
                )
        elif not (np.isfinite(value) and (value >= 0 if key.startswith("radius") else value > 0)):
            raise GeometryError(f"the {what} of a layer must be positive, found {value:g} m.")


def _rounded_up(length: float) -> float:
    """To four digits, upwards, so that advice that is followed works."""
    step = 10 ** (np.floor(np.log10(length)) - 3)
    return float(np.ceil(length / step) * step)


def _mm(length: float) -> str:
    return f"{1e3 * length:.5g} mm"

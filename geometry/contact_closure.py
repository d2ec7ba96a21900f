r"""Where round parts touch: the closures that end the filler bluntly, and the necks where the mesh must be finer.

Round parts touch each other at single points, where the filler would end in cusps of angle zero that no mesh can fill.
Near a contact the gap is g + k s^2 at the distance s. Where it is narrower than the width w, the filler is replaced
by the material of the layer that is touched (earth cover, wrap, or the outer layer of the neighbouring core); the filler then
ends in a blunt edge of the width w. One closure moves the area

.. math::  2 \int_0^{s_w} k s^2 ds = \tfrac23\, w \sqrt{w / k}

(g = 0), and w is chosen so that no layer gains more than 0.4 % of its own. The outlines that are kept stay exact.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.clearance import TOUCH
from geometry.errors import MeshError
from geometry.wire_trace import WireTrace

CLOSURE_SHARE = 0.004
"""Largest share of a touched layer's area that closures may add."""


@dataclass(frozen=True)
class Neck:
    """Narrow place at `point`: the gap is max(closure, gap + bend s^2) [m] at the distance s."""

    point: NDArray[np.float64]
    gap: float
    bend: float
    closure: float


@dataclass(frozen=True)
class Contact:
    """Closure between curve `a` (kept) and curve `b` (its arc goes); angles at the two ends, in the sense of a."""

    a: int
    b: int
    a_ends: tuple[float, float]
    b_ends: tuple[float, float]


def find_closures(
    curves: Sequence[WireTrace],
    cores: Sequence[int],
    centre: int | None,
    outer: int | None,
    host_areas: Mapping[int, float],
    neck_below: float,
    filled: bool = True,
) -> tuple[list[Contact], list[Neck]]:
    """Closures at all contacts, and all narrow places.

    Parameters
    ----------
    curves : all outlines; `cores`, `centre` and `outer` (the laid-up circle), None if absent, number those that bound the gaps
    host_areas : area of the layer that a closure on that curve would join [m^2]
    neck_below : gaps narrower than this [m] are necks
    filled : False where the gaps are empty: then parts that touch are joined, and narrow gaps stay open

    Raises
    ------
    MeshError
        If two outlines run close to each other over more than a quarter turn.
    """
    pairs = [(core, other) for core in cores for other in (centre, outer) if other is not None]
    pairs += [(a, b) for i, a in enumerate(cores) for b in cores[i + 1 :]]
    near = [(a, b, *_narrowest(curves[a], curves[b])) for a, b in pairs]
    near = [place for place in near if place[3] < neck_below]
    contacts, necks = [], []
    for a, b, phi, gap in near:
        bend = _bend(curves[a], curves[b], phi, gap)
        sharing = sum(1 for _, host, _, _ in near if host == b)
        closure = _closure_width(bend, CLOSURE_SHARE * host_areas[b] / sharing, curves[a].radius)
        necks.append(Neck(curves[a].point(phi), gap, bend, closure))
        if gap < (closure if filled else TOUCH):
            ends = [_end(curves[a], curves[b], phi, sense, closure) for sense in (-1, 1)]
            b_ends = curves[b].nearest(curves[a].point(np.array(ends)))
            contacts.append(Contact(a, b, (ends[0], ends[1]), (float(b_ends[0]), float(b_ends[1]))))
    return contacts, necks


def _narrowest(a: WireTrace, b: WireTrace) -> tuple[float, float]:
    """Angle on a where b is nearest, and the gap there [m]."""
    phi = np.linspace(0, 2 * np.pi, 361)
    k = int(np.argmin(_gap(a, b, phi)))
    phi = np.linspace(phi[k] - 0.02, phi[k] + 0.02, 201)
    gaps = _gap(a, b, phi)
    return float(phi[np.argmin(gaps)]), float(gaps.min())


def _gap(a: WireTrace, b: WireTrace, phi: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distance from points phi of curve a to curve b."""
    points = a.point(phi)
    if b.centre_radius == 0:
        return np.abs(np.hypot(*points.T) - b.radius)
    return np.linalg.norm(points - b.point(b.nearest(points)), axis=1)


def _bend(a: WireTrace, b: WireTrace, phi: float, gap: float) -> float:
    """Growth of the gap with the square of the distance from the contact [1/m]."""
    side = 0.1
    grown = float(np.mean(_gap(a, b, np.array([phi - side, phi + side]))))
    return max((grown - gap) / (side * a.radius) ** 2, 1e-3 / a.radius)


def _closure_width(bend: float, area: float, radius: float) -> float:
    """Width w whose lens (2/3) w sqrt(w / bend) has the given area, at most a hundredth of the radius."""
    return min(float((1.5 * area * np.sqrt(bend)) ** (2 / 3)), 0.01 * radius)


def _end(a: WireTrace, b: WireTrace, phi: float, sense: int, width: float) -> float:
    """Angle on a, from phi in the given sense, where the gap to b has grown to `width`."""
    low, high = 0.0, 0.02
    while float(_gap(a, b, np.array([phi + sense * high]))[0]) < width:
        high *= 1.3
        if high > np.pi / 2:
            raise MeshError(
                "two parts run so close to each other over a quarter turn that the gap cannot be meshed; join them."
            )
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if float(_gap(a, b, np.array([phi + sense * middle]))[0]) < width else (low, middle)
    return phi + sense * high

r"""Where the strands of a conductor touch, in the plane normal to its axis, and the flats they share there.

Two convex curves a and b are apart by the largest separation over all directions n (Boyd and Vandenberghe, Convex
Optimization, 2004, section 8.2.2), negative where they overlap:

.. math::  g = \max_{|n| = 1} \Bigl( \min_{x \in b} n \cdot x - \max_{x \in a} n \cdot x \Bigr) .

They share a flat, normal to that n, half-way between the two support points, if g is below `CLOSED` strand radii; where the
pattern was scaled down to a stated diameter, strands of their full radius are meant. A strand that would hang free is held by
its nearest neighbour, up to `HELD`; in a real conductor it would have settled there. Strands of the outermost layer share edges
with the circle about the conductor, over an arc of the same width as near as its nodes allow, at least an edge to each side.

How wide a flat is, is physics, not mesh: the bonded stiffness grows with the logarithm of the width. Hertz gives it for round rods and
a known force (line_contact.py). Without a number the half-width is `FLAT` strand radii, an assumption: there a circle has
left its tangent by 1.1 % of its radius, about half the gap that is closed here (`CLOSED`), and the overlap of the reference
cable's strands (0.127 radii to each side) is spanned.
Strands whose round traces overlap share a flat at least as wide as the overlap.
A mesh resolves flats down to a half-width of `NARROWEST` times the distance of its nodes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import GeometryError
from geometry.wire_trace import WireTrace

RING = -1
"""Stands for the circle about the conductor where strand numbers are listed."""
CLOSED = 0.025
"""Gaps up to this fraction of the strand radius are closed."""
HELD = 0.25
"""Gaps up to this fraction of the strand radius are closed if a strand would hang free otherwise."""
OVERLAP = 0.15
"""Overlaps beyond this fraction of the strand radius are refused."""
FLAT = 0.15
"""Half-width of a flat over the strand radius, where none is stated."""
WIDEST = 0.3
"""Largest half-width of a flat over the strand radius."""
ROOM = 1.1
"""Width of a flat over that of the overlap of two strands, which it must span."""
NARROWEST = 0.15
"""Smallest half-width of a flat over the distance of the nodes."""
REACH = 2.75
"""Strands whose centres are farther apart than this many strand radii are not neighbours."""
TIE = 1e-6
"""Gaps that differ by less than this fraction of the strand radius are equal."""


@dataclass(frozen=True)
class StrandPlace:
    """Strand of a conductor: its `layer` from the inside, `centre_radius` [m], `phase` [rad] and `radius` [m]."""

    layer: int
    centre_radius: float
    phase: float
    radius: float


@dataclass(frozen=True)
class Contact:
    """Nodes (k, 2) [m] that two strands share, counter-clockwise about the `first` (about the `second` if `first` is RING);
    `gap` [m] between their traces before."""

    first: int
    second: int
    nodes: NDArray[np.float64]
    gap: float


@dataclass(frozen=True)
class Touch:
    """Support of two traces on each other: `middle` of the flat [m], its `normal` from the first to the second, `gap` [m], and the
    angles phi of the two support points on their traces."""

    middle: NDArray[np.float64]
    normal: NDArray[np.float64]
    gap: float
    on_first: float
    on_second: float


def turned(points: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    """Points (..., 2) turned about the origin."""
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


def find_contacts(
    places: Sequence[StrandPlace],
    traces: Sequence[WireTrace],
    layers: tuple[int, ...],
    fold: int,
    ring: NDArray[np.float64],
    size: float,
    flat: float,
) -> list[Contact]:
    """All contacts of the strands with each other and with the ring; they repeat after 2 pi / fold.

    Parameters
    ----------
    places, traces : of each strand, numbered from the inside and counter-clockwise in each layer
    ring : (N, 2) nodes of the circle about the conductor
    size : wanted distance of the nodes [m]; flats have edges of about that length
    flat : wanted width of the flats [m]; they come out narrower where contacts are close together, wider where the mesh is coarse

    Raises
    ------
    GeometryError
        If strands overlap by more than flats can hold, or one has no neighbour near enough to hold it.
    """
    radius = traces[0].radius
    orbits = _orbits(layers, fold)
    touches = {}
    for orbit in orbits:
        a, b = orbit[0]
        if np.linalg.norm(centre_of(places[a]) - centre_of(places[b])) > REACH * radius:
            continue
        touch = touch_of(traces[a], traces[b])
        if touch.gap < -OVERLAP * radius:
            raise GeometryError(
                f"strands {a} and {b} of a conductor overlap by {-1e3 * touch.gap:.3g} mm: lay fewer strands in the layer, make "
                "them thinner, or lengthen their lay."
            )
        touches[orbit] = touch
    pressed = 2 * max(0.0, places[0].radius - radius)
    outer = range(len(places) - layers[-1], len(places))
    closed = _closed(orbits, touches, outer, len(places), radius, CLOSED * radius + pressed)
    apart = _least_angle(closed, touches, places, outer, fold)
    widest = min(WIDEST * radius, 0.3 * apart * radius)
    contacts = [_ring_contact(b, places[b].phase, ring, min(0.5 * flat, widest)) for b in outer]
    for orbit in closed:
        touch = touches[orbit]
        overlap = overlap_half_width(touch, *(traces[k] for k in orbit[0]))
        half = min(max(0.5 * flat, NARROWEST * size, overlap), widest)
        edges = max(1, round(2 * half / size))
        along = np.array([-touch.normal[1], touch.normal[0]])
        nodes = touch.middle + half * np.linspace(-1, 1, edges + 1)[:, None] * along
        for copy, (a, b) in enumerate(orbit):
            image = turned(nodes, 2 * np.pi * copy / fold)
            contacts.append(Contact(a, b, image, touch.gap) if a < b else Contact(b, a, image[::-1], touch.gap))
    return contacts


def overlap_half_width(touch: Touch, a: WireTrace, b: WireTrace) -> float:
    """Half the width [m] over which two traces overlap, with a little room; 0 if they are apart: gap + (k_a + k_b) s^2 / 2 = 0."""
    if touch.gap >= 0:
        return 0.0
    return ROOM * float(np.sqrt(-2 * touch.gap / (a.curvature(touch.on_first) + b.curvature(touch.on_second))))


def _orbits(layers: tuple[int, ...], fold: int) -> list[tuple[tuple[int, int], ...]]:
    """Pairs of strands, each with its images under turns of 2 pi / fold."""
    first = np.concatenate([[0], np.cumsum(layers)])
    layer_of = np.repeat(np.arange(len(layers)), layers)

    def image(strand: int, copy: int) -> int:
        k = layer_of[strand]
        return int(
            first[k] + (strand - first[k] + copy * (layers[k] // fold if layers[k] % fold == 0 else 0)) % layers[k]
        )

    seen, orbits = set(), []
    for a in range(first[-1]):
        for b in range(a + 1, first[-1]):
            if (a, b) in seen:
                continue
            pairs: list[tuple[int, int]] = []
            for copy in range(fold):
                pair = (image(a, copy), image(b, copy))
                key = (min(pair), max(pair))
                if key in seen:
                    break
                seen.add(key)
                pairs.append(pair)
            orbits.append(tuple(pairs))
    return orbits


def centre_of(member: StrandPlace | WireTrace) -> NDArray[np.float64]:
    """Centre (2,) [m] of a strand in the plane."""
    return member.centre_radius * np.array([np.cos(member.phase), np.sin(member.phase)])


def touch_of(a: WireTrace, b: WireTrace) -> Touch:
    """Largest separation of two traces over all directions near the line of their centres."""
    from scipy.optimize import minimize_scalar  # slow to load, needed here only

    line = centre_of(b) - centre_of(a)
    base = float(np.arctan2(line[1], line[0]))

    def touch(angle: float) -> Touch:
        n = np.array([np.cos(angle), np.sin(angle)])
        on_a, on_b = _support(a, n), _support(b, -n)
        pa, pb = a.point(on_a), b.point(on_b)
        return Touch((pa + pb) / 2, n, float(n @ (pb - pa)), on_a, on_b)

    found = minimize_scalar(
        lambda x: -touch(base + x).gap, bounds=(-0.5, 0.5), method="bounded", options={"xatol": 1e-9}
    )
    return touch(base + round(float(found["x"]), 7))


def _support(trace: WireTrace, n: NDArray[np.float64]) -> float:
    """The angle phi of the point of a trace that lies farthest along `n`, by table and Newton steps."""
    table = np.linspace(0, 2 * np.pi, 128, endpoint=False)
    phi = float(table[(trace.point(table) @ n).argmax()])
    for _ in range(4):
        bend = (trace.derivative(phi + 1e-5) - trace.derivative(phi - 1e-5)) @ n / 2e-5
        phi -= float(np.clip(trace.derivative(phi) @ n / min(bend, -0.1 * trace.radius), -0.05, 0.05))
    return phi


def _closed(
    orbits: Sequence[tuple[tuple[int, int], ...]],
    touches: dict[tuple[tuple[int, int], ...], Touch],
    outer: range,
    count: int,
    radius: float,
    near: float,
) -> list[tuple[tuple[int, int], ...]]:
    """Orbits of pairs that become contacts: all with gaps up to `near`, then the nearest until every strand is tied to the ring."""
    group = np.arange(count + 1)
    group[list(outer)] = count
    group[-1] = count

    def tie(orbit: tuple[tuple[int, int], ...]) -> None:
        for a, b in orbit:
            group[group == group[a]] = group[b]

    ranked = sorted((o for o in orbits if o in touches), key=lambda o: touches[o].gap)
    closed = [o for o in ranked if touches[o].gap <= near]
    for orbit in closed:
        tie(orbit)
    while (group != group[-1]).any():
        nearest = next((o for o in ranked if group[o[0][0]] != group[o[0][1]]), None)
        loose = int(np.flatnonzero(group != group[-1])[0])
        if nearest is None or touches[nearest].gap > HELD * radius:
            raise GeometryError(
                f"strand {loose} of a conductor touches no other strand (the nearest gap is more than {HELD:g} strand radii): "
                "give its layer more strands."
            )
        limit = touches[nearest].gap + TIE * radius
        same = [o for o in ranked if o not in closed and touches[o].gap <= limit and group[o[0][0]] != group[o[0][1]]]
        for orbit in same:
            tie(orbit)
        closed += same
    return closed


def _least_angle(
    closed: Sequence[tuple[tuple[int, int], ...]],
    touches: dict[tuple[tuple[int, int], ...], Touch],
    places: Sequence[StrandPlace],
    outer: range,
    fold: int,
) -> float:
    """Smallest angle [rad] between two neighbouring contacts of one strand."""
    angles: dict[int, list[float]] = {b: [places[b].phase] for b in outer}
    for orbit in closed:
        for copy, (a, b) in enumerate(orbit):
            n = touches[orbit].normal
            direction = float(np.arctan2(n[1], n[0])) + 2 * np.pi * copy / fold
            angles.setdefault(a, []).append(direction)
            angles.setdefault(b, []).append(direction + np.pi)
    least = 2 * np.pi
    for found in angles.values():
        around = np.sort(np.mod(found, 2 * np.pi))
        if len(around) > 1:
            least = min(least, float(np.diff(around, append=around[0] + 2 * np.pi).min()))
    return least


def _ring_contact(strand: int, phase: float, ring: NDArray[np.float64], half: float) -> Contact:
    """The ring nodes within about `half` [m] of the phase of a strand: at least three, or two where the phase falls between nodes."""
    step = 2 * np.pi / len(ring)
    position, steps = phase / step, half / (step * float(np.linalg.norm(ring[0])))
    middle = round(2 * position) / 2
    reach = max(1.0, steps)
    if abs(position - middle) < 1e-6:
        reach = max(1, round(steps)) if middle == round(middle) else max(0, round(steps - 0.5)) + 0.5
    indices = np.arange(int(np.ceil(position - reach - 1e-6)), int(np.floor(position + reach + 1e-6)) + 1)
    return Contact(RING, strand, ring[indices % len(ring)], 0.0)

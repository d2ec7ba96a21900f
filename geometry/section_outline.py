r"""The outlines of a cross-section as a planar graph whose faces are the parts.

Every curve is a WireTrace (a circle about the axis is one too), cut into pieces at the ends of the closures
(contact_closure.py).
The loops follow from one rule: a piece is walked with the face on its left, and in every face one piece leaves each vertex.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from geometry.cable import Cable, Part
from geometry.contact_closure import Contact, Neck, find_closures
from geometry.errors import MeshError
from geometry.laid_zone import curve_key, host_area, the_filler, zone_curves
from geometry.wire_trace import WireTrace

QUARTERS = np.linspace(0, 2 * np.pi, 5)[:-1]


@dataclass(frozen=True)
class Edge:
    """Piece of curve number `curve` from angle `start` to `end` (end > start), or a straight bridge (`curve` = -1)."""

    curve: int
    tail: int
    head: int
    start: float = 0.0
    end: float = 0.0


@dataclass
class SectionOutline:
    """Curves, vertices (n, 2), edges, and the loops of every part.

    A loop is a list of signed edge numbers, (number + 1) walked forwards, -(number + 1) backwards. `faces[name]` is a list
    of faces, each a list of loops, outer loop first.
    """

    curves: list[WireTrace]
    vertices: list[NDArray[np.float64]] = field(default_factory=list)
    edges: list[Edge] = field(default_factory=list)
    faces: dict[str, list[list[list[int]]]] = field(default_factory=dict)
    necks: list[Neck] = field(default_factory=list)

    def points(self, edge: Edge, count: int) -> NDArray[np.float64]:
        """Points (count, 2) along an edge, both ends included."""
        if edge.curve < 0:
            t = np.linspace(0, 1, count)[:, None]
            return (1 - t) * self.vertices[edge.tail] + t * self.vertices[edge.head]
        return self.curves[edge.curve].point(np.linspace(edge.start, edge.end, count))


def section_outline(
    cable: Cable, neck_below: float, cuts: Mapping[WireTrace, NDArray[np.float64]] | None = None
) -> SectionOutline:
    """Outline of all parts of a cable.

    Parameters
    ----------
    neck_below : gaps narrower than this [m] are listed as necks, so that the mesh can be refined there
    cuts : angles at which to cut curves that touch nothing, growing within one turn

    Raises
    ------
    MeshError
        If two closures meet, because a part between them is too small.
    """
    rings = [part for part in cable.parts if part.kind != "interstices"]
    curves: list[WireTrace] = []
    index: dict[tuple[float, float, float], int] = {}
    for part in rings:
        for trace in (part.inner_trace, part.outer_trace):
            if trace is not None and curve_key(trace) not in index:
                index[curve_key(trace)] = len(curves)
                curves.append(trace)
    outline = SectionOutline(curves)
    filler = the_filler(cable)
    if (
        filler is not None
        and (rim := WireTrace(0.0, 0.0, filler.outer_radius, cable.twist_rate))
        and curve_key(rim) not in index
    ):
        index[curve_key(rim)] = len(curves)  # nothing lies round the filler
        curves.append(rim)
    zone = zone_curves(cable, index)
    contacts: list[Contact] = []
    if zone:
        cores, centre, outer = zone
        hosts = cores + [number for number in (centre, outer) if number is not None]
        areas = {number: host_area(cable, curves[number], number == outer) for number in hosts}
        contacts, outline.necks = find_closures(curves, cores, centre, outer, areas, neck_below, filler is not None)
    pieces = _cut(outline, contacts, cuts or {})
    bridges = _bridges(outline, contacts, pieces)
    _ring_faces(outline, rings, index, zone, contacts, pieces, bridges)
    if zone and filler is not None:
        outline.faces[filler.name] = _filler_faces(outline, zone, contacts, pieces, bridges)
    return outline


def _cut(
    outline: SectionOutline, contacts: list[Contact], cuts: Mapping[WireTrace, NDArray[np.float64]]
) -> dict[int, list[tuple[int, int | None, bool]]]:
    """Cut every curve at the closure ends; per curve its pieces in ccw order: (edge, closure it bounds or None, removed)."""
    pieces: dict[int, list[tuple[int, int | None, bool]]] = {}
    for number, curve in enumerate(outline.curves):
        spans = []
        for c, contact in enumerate(contacts):
            if contact.a == number:
                spans.append((*contact.a_ends, c, False))
            if contact.b == number:
                spans.append((*_short_way(*contact.b_ends), c, True))
        spans = sorted(
            (start % (2 * np.pi), start % (2 * np.pi) + end - start, c, removed) for start, end, c, removed in spans
        )
        pieces[number] = _pieces_of(outline, number, curve, spans, cuts.get(curve, QUARTERS))
    return pieces


def _short_way(start: float, end: float) -> tuple[float, float]:
    """The two angles so that the second follows the first within half a turn."""
    step = (end - start + np.pi) % (2 * np.pi) - np.pi
    return (start, start + step) if step > 0 else (start + step, start)


def _pieces_of(
    outline: SectionOutline,
    number: int,
    curve: WireTrace,
    spans: list[tuple[float, float, int, bool]],
    otherwise: NDArray[np.float64],
) -> list[tuple[int, int | None, bool]]:
    cuts: list[tuple[float, int | None, bool]] = []  # angle at which a piece begins, closure, removed
    for k, (start, end, c, removed) in enumerate(spans):
        following = spans[k + 1][0] if k + 1 < len(spans) else spans[0][0] + 2 * np.pi
        if end >= following:
            raise MeshError("two contacts of one part lie so close together that no filler is left between them.")
        cuts += [(start, c, removed), (end, None, False)]
        cuts += [(float(x), None, False) for x in np.linspace(end, following, _parts_of(following - end) + 1)[1:-1]]
    if not spans:
        cuts = [(float(x), None, False) for x in otherwise]
    first = len(outline.vertices)
    outline.vertices += [curve.point(angle) for angle, *_ in cuts]
    found: list[tuple[int, int | None, bool]] = []
    for k, (angle, c, removed) in enumerate(cuts):
        until = cuts[k + 1][0] if k + 1 < len(cuts) else cuts[0][0] + 2 * np.pi
        outline.edges.append(Edge(number, first + k, first + (k + 1) % len(cuts), angle, until))
        found.append((len(outline.edges) - 1, c, removed))
    return found


def _parts_of(angle: float) -> int:
    return max(1, int(np.ceil(angle / (0.6 * np.pi))))


def _bridges(
    outline: SectionOutline, contacts: list[Contact], pieces: dict[int, list[tuple[int, int | None, bool]]]
) -> list[list[int]]:
    """Straight edges across the gap at both ends of each closure, walked with the filler on the left."""
    bridges = []
    for c, contact in enumerate(contacts):
        arc_a = next(outline.edges[e] for e, closure, removed in pieces[contact.a] if closure == c and not removed)
        arc_b = next(outline.edges[e] for e, closure, removed in pieces[contact.b] if closure == c and removed)
        b_ends = [arc_b.tail, arc_b.head]
        start, end = outline.vertices[arc_a.tail], outline.vertices[arc_a.head]
        if np.linalg.norm(outline.vertices[b_ends[0]] - start) > np.linalg.norm(outline.vertices[b_ends[0]] - end):
            b_ends.reverse()
        outline.edges += [Edge(-1, b_ends[0], arc_a.tail), Edge(-1, arc_a.head, b_ends[1])]
        bridges.append([len(outline.edges) - 2, len(outline.edges) - 1])
    return bridges


def _loops(outline: SectionOutline, signed: list[int]) -> list[list[int]]:
    """Chain signed edges into closed loops."""

    def ends(number: int) -> tuple[int, int]:
        edge = outline.edges[abs(number) - 1]
        return (edge.tail, edge.head) if number > 0 else (edge.head, edge.tail)

    leaving = {ends(number)[0]: number for number in signed}
    loops = []
    while leaving:
        loop = [leaving.pop(next(iter(leaving)))]
        while (vertex := ends(loop[-1])[1]) in leaving:
            loop.append(leaving.pop(vertex))
        loops.append(loop)
    return loops


def _hosted(number: int, contacts: list[Contact], pieces: dict, bridges: list[list[int]]) -> list[int]:
    """Signed edges that enclose the closures hosted by curve `number`, closure on the left."""
    signed = []
    for c, contact in enumerate(contacts):
        if contact.b == number:
            signed += [-(e + 1) for e, closure, removed in pieces[contact.a] if closure == c and not removed]
            signed += [-(e + 1) for e in bridges[c]]
    return signed


def _ring_faces(
    outline: SectionOutline,
    rings: list[Part],
    index: dict[tuple[float, float, float], int],
    zone: tuple[list[int], int | None, int | None] | None,
    contacts: list[Contact],
    pieces: dict[int, list[tuple[int, int | None, bool]]],
    bridges: list[list[int]],
) -> None:
    """Faces of all rings; the layer that touches gets the closures."""
    around = zone[2] if zone else None

    def boundary(number: int, sign: int, host: bool) -> list[list[int]]:
        signed = [sign * (e + 1) for e, _, removed in pieces[number] if not removed]
        return _loops(outline, signed + (_hosted(number, contacts, pieces, bridges) if host else []))

    for part in rings:
        outer = index[curve_key(part.outer_trace)]
        loops = boundary(outer, 1, outer != around)
        if part.inner_trace is not None:
            inner = index[curve_key(part.inner_trace)]
            loops += boundary(inner, -1, inner == around)
        outline.faces[part.name] = [loops]


def _filler_faces(
    outline: SectionOutline,
    zone: tuple[list[int], int | None, int | None],
    contacts: list[Contact],
    pieces: dict[int, list[tuple[int, int | None, bool]]],
    bridges: list[list[int]],
) -> list[list[list[int]]]:
    cores, centre, outer = zone
    assert outer is not None
    signed = [e + 1 for e, closure, _ in pieces[outer] if closure is None]
    for number in cores + ([centre] if centre is not None else []):
        signed += [-(e + 1) for e, closure, _ in pieces[number] if closure is None]
    signed += [e + 1 for pair in bridges for e in pair]
    loops = _loops(outline, signed)
    polygons = [np.vstack([_walk(outline, number) for number in loop]) for loop in loops]
    outers = [k for k, polygon in enumerate(polygons) if _signed_area(polygon) > 0]
    faces = {k: [loops[k]] for k in outers}
    for k, polygon in enumerate(polygons):
        if k not in faces:
            around = [o for o in outers if _contains(polygons[o], polygon[0])]
            faces[min(around, key=lambda o: _signed_area(polygons[o]))].append(loops[k])
    return list(faces.values())


def _walk(outline: SectionOutline, number: int) -> NDArray[np.float64]:
    points = outline.points(outline.edges[abs(number) - 1], 24)
    return (points if number > 0 else points[::-1])[:-1]


def _signed_area(polygon: NDArray[np.float64]) -> float:
    x, y = polygon.T
    return float(0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum())


def _contains(polygon: NDArray[np.float64], point: NDArray[np.float64]) -> bool:
    a, b = polygon - point, np.roll(polygon, -1, axis=0) - point
    turn: Callable[..., NDArray] = np.arctan2
    return abs(turn(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(1)).sum()) > np.pi

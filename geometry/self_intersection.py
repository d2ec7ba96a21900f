r"""Do the round members of a cable cut each other, or themselves, before they are swept?

Two round members clear by the shortest distance of their centre lines minus the sum of their radii:

* two helices of one lay about the axis: exact minimum over the shift along the lay (clearance.py);
* layers of different lay or hand cross somewhere, so that the distance is exactly the difference of their radii;
* rings about the axis and what lies inside or outside them: the difference of radii;
* strands of one conductor, which is itself laid: from the sampled lines, then Newton's method on both arc parameters of

.. math::  \min_{u, v} |x_a(u) - x_b(v)|^2 .

A member cuts itself when its radius is not below the radius of curvature of its centre line (clearance.py holds its own
next turn). Strands that are flattened a little in reality overlap as round ones: that is a note, not an error.
"""

from __future__ import annotations

import itertools
import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from geometry.cable import Cable, Part
from geometry.clearance import TOUCH, helix_distance
from geometry.errors import GeometryError
from geometry.helix import Helix
from geometry.laid_member import STRAIGHT, LaidMember, laid_members, stranded, strands
from geometry.nested_helix import CentreLine

FLATTENING = 0.02
"""Strands that overlap by less than this share of the smaller diameter are flattened in reality."""
LONGEST = 1.0
"""Longest piece [m] over which strands are compared."""

_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Overlap:
    """Two parts that cut each other by `depth` [m]; `severe` if no flattening explains it."""

    first: str
    second: str
    depth: float
    severe: bool

    @property
    def sentence(self) -> str:
        """What overlaps, and by how much."""
        if self.first == self.second:
            return f"{self.first} bends more sharply than its own radius allows: lengthen its lay."
        end = (
            "make them thinner, move them apart, or lengthen the lay."
            if self.severe
            else "as round ones; in reality they are flattened there."
        )
        return f"{self.first} and {self.second} overlap by {1e3 * self.depth:.3f} mm{':' if self.severe else ','} {end}"


def self_intersections(cable: Cable, length: float | None = None, level: str = "strand") -> list[Overlap]:
    """Every overlap of two round members, deepest first; congruent neighbours are named once.

    Parameters
    ----------
    length : piece of the cable over which strands are compared [m]; None takes one turn of the strands in the core, at
        most 1 m
    level : "conductor" takes stranded conductors as one cylinder, "strand" takes their strands

    Raises
    ------
    GeometryError
        If the level is unknown.
    """
    whole = laid_members(cable, "conductor")
    laid_members(cable, level, ())  # refuses an unknown level
    found = [*_rings(whole), *_within_layers(_outlines(whole)), *_between_layers(_outlines(whole))]
    found += [_itself(m) for m in whole if m.outer_radius * m.levels[0].curvature >= 1]
    if level == "strand":
        for part in _conductor_samples(cable):
            found += _strand_overlaps(cable, part, length)
    return sorted(found, key=lambda o: -o.depth)


def check_self_intersection(cable: Cable, length: float | None = None, level: str = "strand") -> list[Overlap]:
    """Raise on the deepest severe overlap; returns and logs the slight ones.

    Raises
    ------
    GeometryError
        Names the two parts and the overlap.
    """
    found = self_intersections(cable, length, level)
    for overlap in found:
        if overlap.severe:
            raise GeometryError(overlap.sentence)
        _log.info(overlap.sentence)
    return found


def centre_distance(a: CentreLine, b: CentreLine) -> float:
    """Shortest distance [m] of two finely sampled centre lines; Newton's method from the closest samples.

    Examples
    --------
    Neighbouring cores of the reference cable, in closed form 16.036 mm:

    >>> from geometry.helix import Helix
    >>> from geometry.nested_helix import nested_helix
    >>> z = np.linspace(0, 0.234, 200)
    >>> lines = [nested_helix([Helix(11.625e-3, 0.234, "Z", phase)], z) for phase in (0.0, np.pi / 2)]
    >>> round(1e3 * centre_distance(*lines), 3)
    16.036
    """
    from scipy.interpolate import CubicSpline  # slow to load, needed here only
    from scipy.spatial import KDTree

    near, partner = KDTree(b.points).query(a.points)
    rows = np.argsort(near)[:8]
    x, y = CubicSpline(a.s, a.points), CubicSpline(b.s, b.points)
    u, v = a.s[rows], b.s[np.asarray(partner)[rows]]
    for _ in range(12):
        gap, dx, dy = x(u) - y(v), x(u, 1), y(v, 1)
        gu, gv = (gap * dx).sum(1), -(gap * dy).sum(1)
        uu = np.maximum((dx * dx).sum(1) + (gap * x(u, 2)).sum(1), 0.05)
        vv = np.maximum((dy * dy).sum(1) - (gap * y(v, 2)).sum(1), 0.05)
        uv = -(dx * dy).sum(1)
        det = np.where(uu * vv - uv**2 > 1e-3, uu * vv - uv**2, 1.0)
        parallel = uu * vv - uv**2 <= 1e-3  # then one parameter is enough
        du = np.where(parallel, -gu / uu, (uv * gv - vv * gu) / det)
        dv = np.where(parallel, 0.0, (uv * gu - uu * gv) / det)
        step = 2 * max(a.s[1] - a.s[0], b.s[1] - b.s[0])
        u = np.clip(u + np.clip(du, -step, step), a.s[0], a.s[-1])
        v = np.clip(v + np.clip(dv, -step, step), b.s[0], b.s[-1])
    return float(min(near.min(), np.linalg.norm(x(u) - y(v), axis=1).min()))


def _outlines(members: Sequence[LaidMember]) -> list[LaidMember]:
    """The outermost round of each part that is laid about the axis, and of the centre."""
    last = {m.part.member: m for m in members if not _about_axis(m) or m.inner_radius == 0 or m.kind == "cover"}
    return list(last.values())


def _about_axis(member: LaidMember) -> bool:
    return member.levels[0].radius == 0


def _within_layers(members: Sequence[LaidMember]) -> Iterator[Overlap]:
    """Pairs of one lay, and each with its neighbours only; equal pairs are computed once."""
    known: dict[tuple[float, ...], float] = {}
    for a, b in itertools.combinations(members, 2):
        p, q = a.levels[0], b.levels[0]
        if not (_same_lay(p, q) or _about_axis(a) or _about_axis(b)):
            continue
        angle = abs((q.phase - p.phase + np.pi) % (2 * np.pi) - np.pi)
        reach = a.outer_radius + b.outer_radius
        if abs(p.radius - q.radius) > reach or min(p.radius, q.radius) * angle > 4 * reach:
            continue
        key = tuple(round(x, 9) for x in (p.radius, q.radius, angle, p.pitch, reach))
        if key not in known:
            laid = p if p.radius > 0 else q
            known[key] = (
                helix_distance(p.radius, q.radius, angle, None if laid.pitch >= STRAIGHT else laid.pitch) - reach
            )
            if known[key] < -TOUCH:
                yield _overlap(a.name, b.name, -known[key], min(a.outer_radius, b.outer_radius), False)


def _between_layers(members: Sequence[LaidMember]) -> Iterator[Overlap]:
    """Layers of different lay cross: the distance of their centre lines is the difference of the radii."""
    layers = {
        (round(m.levels[0].radius, 9), m.levels[0].turn_rate, m.outer_radius): m for m in members if not _about_axis(m)
    }
    for a, b in itertools.combinations(layers.values(), 2):
        p, q = a.levels[0], b.levels[0]
        depth = a.outer_radius + b.outer_radius - abs(p.radius - q.radius)
        if not _same_lay(p, q) and depth > TOUCH:
            yield _overlap(a.name, b.name, depth, min(a.outer_radius, b.outer_radius), False)


def _rings(members: Sequence[LaidMember]) -> Iterator[Overlap]:
    """Rings about the axis against everything that is not part of the same member."""
    seen = set()
    for ring in (m for m in members if _about_axis(m) and m.inner_radius > 0):
        middle = 0.5 * (ring.inner_radius + ring.outer_radius)
        for m in members:
            r, rho = m.levels[0].radius, m.outer_radius
            if m.part.member == ring.part.member or (r == 0 and m.inner_radius >= ring.outer_radius - TOUCH):
                continue
            depth = r + rho - ring.inner_radius if r < middle else ring.outer_radius - (r - rho)
            key = (ring.name, round(r, 9), round(rho, 9))
            if depth > TOUCH and key not in seen:
                seen.add(key)
                yield _overlap(m.name, ring.name, depth, rho, False)


def _conductor_samples(cable: Cable) -> list[Part]:
    """One part for each kind of stranded conductor and place; the others are the same, turned about the axis."""
    found = {
        (part.material.name, round(part.centre_radius, 9), part.twist_rate): part
        for part in reversed(cable.parts)
        if stranded(cable, part) is not None
    }
    return list(found.values())


def _strand_overlaps(cable: Cable, part: Part, length: float | None) -> Iterator[Overlap]:
    conductor = stranded(cable, part)
    assert conductor is not None
    members = strands(part, conductor)
    core, outer = members[0].levels[0], members[-1].levels[-1]
    if length is None:
        rate = abs(outer.turn_rate - core.torsion)
        length = min(LONGEST, 2 * np.pi / rate if rate > 2 * np.pi / LONGEST else LONGEST)
    z = np.union1d(*(m.stations(0.0, length) for m in (members[0], members[-1])))
    yield from _neighbours(members, {m.name: m.centre_line(z) for m in members})
    depth = outer.radius + members[-1].outer_radius - part.outer_radius
    if depth > TOUCH:
        yield _overlap(members[-1].name, f"the outline of {part.name}", depth, members[-1].outer_radius, True)
    for m in members:
        if m.outer_radius * m.curvature(m.stations(0.0, length)).max() >= 1:
            yield _itself(m)


def _neighbours(members: Sequence[LaidMember], lines: Mapping[str, CentreLine]) -> Iterator[Overlap]:
    """The deepest overlap between two layers of strands, or within one."""
    deepest: dict[tuple[float, float], Overlap] = {}
    for a, b in itertools.combinations(members, 2):
        p, q, reach = a.levels[-1], b.levels[-1], a.outer_radius + b.outer_radius
        chord = np.sqrt(p.radius**2 + q.radius**2 - 2 * p.radius * q.radius * np.cos(p.phase - q.phase))
        if chord > 1.5 * reach:
            continue
        depth = reach - centre_distance(lines[a.name], lines[b.name])
        key = (p.radius, q.radius)
        if depth > TOUCH and (key not in deepest or depth > deepest[key].depth):
            deepest[key] = _overlap(a.name, b.name, depth, min(a.outer_radius, b.outer_radius), True)
    yield from deepest.values()


def _overlap(first: str, second: str, depth: float, radius: float, soft: bool) -> Overlap:
    return Overlap(first, second, float(depth), not soft or depth > FLATTENING * 2 * radius)


def _itself(member: LaidMember) -> Overlap:
    return Overlap(member.name, member.name, member.outer_radius, True)


def _same_lay(p: Helix, q: Helix) -> bool:
    return abs(p.turn_rate - q.turn_rate) <= 1e-9 * max(1.0, abs(p.turn_rate))

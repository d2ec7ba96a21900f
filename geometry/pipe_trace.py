r"""Where a round member on any nest of helices is cut by the section z = 0: the exact closed curve.

The pipe of radius rho about the centre line x(w) with normals e1, e2 meets the plane at the polar angle phi where

.. math::  z\,[x(w) + \rho\,(\cos\varphi\, e_1(w) + \sin\varphi\, e_2(w))] = 0 ,

one equation for w, solved by Newton's method from w at the plane of the centre. One level of helix gives the closed form of
wire_trace.py.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.cable import Cable, Part
from geometry.laid_member import LaidMember, stranded, strands, wires, wound_from_origin
from geometry.nested_helix import CentreLine


@dataclass(frozen=True)
class Trace:
    """Closed curve of a member in the section z = 0: `points` (n, 2) [m], anticlockwise, the first not repeated.

    `level` is "part", "strand" or "wire"; `hole` (m, 2) is the inner boundary of a ring, clockwise, else None.
    """

    name: str
    kind: str
    level: str
    points: NDArray[np.float64]
    hole: NDArray[np.float64] | None = None

    @property
    def area(self) -> float:
        """Area of the polygon [m^2]."""
        return sum(float(0.5 * _cross(curve).sum()) for curve in (self.points, self.hole) if curve is not None)


def pipe_trace(member: LaidMember, phi: ArrayLike, radius: float | None = None) -> NDArray[np.float64]:
    """Points (..., 2) [m] of the trace at the polar angles phi [rad] about the centre line.

    Parameters
    ----------
    radius : of the pipe [m], None for the outer radius of the member
    """
    rho = member.outer_radius if radius is None else radius
    reach = max(2.0 * rho, 1e-6)
    return line_trace(member.centre_line(np.linspace(-reach, reach, 25)), phi, rho)


def line_trace(line: CentreLine, phi: ArrayLike, rho: float) -> NDArray[np.float64]:
    """Trace (..., 2) [m] of the pipe of radius `rho` [m] about a centre line that is sampled on both sides of z = 0."""
    from scipy.interpolate import CubicSpline  # slow to load, needed here only

    phi = np.asarray(phi, dtype=float)
    along = CubicSpline(line.z, np.concatenate([line.points, line.frames[:, 1], line.frames[:, 2]], axis=1))
    c, s = rho * np.cos(phi)[..., None], rho * np.sin(phi)[..., None]

    def point(w: NDArray[np.float64], order: int) -> NDArray[np.float64]:
        x, e1, e2 = np.split(along(w, order), 3, axis=-1)
        return x + c * e1 + s * e2

    w = np.zeros_like(phi)
    for _ in range(6):
        w = np.clip(w - point(w, 0)[..., 2] / point(w, 1)[..., 2], line.z[0], line.z[-1])
    return point(w, 0)[..., :2]


def section_traces(cable: Cable, inside: str = "wire", samples: int = 180) -> list[Trace]:
    """Everything round that the section z = 0 cuts, in the order of drawing: parts, then their strands, then their wires.

    Parameters
    ----------
    inside : how deep conductors are taken apart: "part", "strand" or "wire"
    samples : points round a part; strands have a third, wires a tenth of it

    Notes
    -----
    Cores that are alike have the same traces turned about the axis: the curves of the first are computed.
    """
    phi = np.linspace(0, 2 * np.pi, samples, endpoint=False)
    found = []
    known: dict[tuple[float, float, str | None], list[Trace]] = {}
    for part in cable.parts:
        if part.kind == "interstices":
            continue
        inner = part.inner_trace
        hole = None if inner is None else inner.point(phi[::-1])
        found.append(Trace(part.name, part.kind, "part", part.outer_trace.point(phi), hole))
        if inside == "part" or stranded(cable, part) is None:
            continue
        key = (part.centre_radius, part.twist_rate, part.conductor)
        if key not in known:
            known[key] = [_turned(t, -part.phase) for t in _inside(cable, part, inside, samples)]
        found += [_turned(t, part.phase, part.name) for t in known[key]]
    return found


def _inside(cable: Cable, part: Part, inside: str, samples: int) -> Iterator[Trace]:
    conductor = stranded(cable, part)
    assert conductor is not None and conductor.strand is not None
    round_strand = np.linspace(0, 2 * np.pi, max(samples // 3, 12), endpoint=False)
    round_wire = np.linspace(0, 2 * np.pi, max(samples // 10, 10), endpoint=False)
    for strand in strands(part, conductor):
        suffix, reach = strand.name.removeprefix(part.name), 2 * strand.outer_radius
        line = strand.centre_line(np.linspace(-reach, reach, 41))
        yield Trace(suffix, part.kind, "strand", line_trace(line, round_strand, strand.outer_radius))
        line = replace(line, s=line.s - line.s[20])  # counts from z = 0
        for wire in wires(strand, conductor.strand) if inside == "wire" else ():
            own = wound_from_origin(line, wire.levels[-1], 20)
            yield Trace(
                wire.name.removeprefix(part.name), part.kind, "wire", line_trace(own, round_wire, wire.outer_radius)
            )


def _turned(trace: Trace, angle: float, name: str = "") -> Trace:
    c, s = np.cos(angle), np.sin(angle)
    return Trace(name + trace.name, trace.kind, trace.level, trace.points @ np.array([[c, s], [-s, c]]))


def _cross(curve: NDArray[np.float64]) -> NDArray[np.float64]:
    (x, y), (u, v) = curve.T, np.roll(curve, -1, axis=0).T
    return x * v - y * u

"""Section of a 1 + m strand whose wires are tied to the core over flats of a given width, instead of along one line of no width.

Six-node triangles in polar grids about the core and about each wire, on its exact trace; edges as long as half the flat at its middle,
growing away from it. The nodes of core and wire on the flat are one; there the wire is moved onto the core, by a^2 / 4 over the radius.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh, Region
from geometry.line_contact import hertz_half_width, line_contact
from geometry.material import Material
from geometry.wire_trace import WireTrace
from homogenize.benchmark_sections import Shape, rings, wire_trace
from homogenize.strand_theory import Strand16, contact_force

GROWTH = 1.9
"""Of the elements away from the flat."""
DEEPEST = 0.3
"""Longest element towards the middle of a wire, over its radius."""


def flat_half_width(strand: Strand16, strain: float) -> float:
    """Half-width [m] of the flat between core and wire, across the line of contact, when the strand is stretched by `strain` (Hertz)."""
    core, wire = (WireTrace(r, 0.0, a, strand.twist_rate) for r, a in _members(strand)[:2])
    steel = Material("wire", strand.E, strand.nu, 7850.0)
    return hertz_half_width(contact_force(strand, strain), line_contact(core, wire), steel, steel)


def flat_strand_section(strand: Strand16, half_width: float, edges: int = 1) -> CrossSectionMesh:
    """Mesh of the strand, its wires tied over flats; wires do not touch each other.

    Parameters
    ----------
    strand : core and wires
    half_width : of the flats, across the line of contact [m]
    edges : elements across half a flat
    """
    tau, m = strand.twist_rate, strand.wires
    (_, core), (r, wire) = _members(strand)[:2]
    in_plane = half_width * line_contact(WireTrace(0.0, 0.0, core, tau), WireTrace(r, 0.0, wire, tau)).stretch
    fine = in_plane / edges
    longest = 0.9 * float(np.sqrt(2 * fine / core))  # a longer arc bulges past the next ring
    sector = _graded(np.pi / m, fine / core, edges, longest)
    parts = [_disc(strand, core, fine, edges, _both_sides(sector, m), lambda a, b: (a * np.cos(b), a * np.sin(b)))]
    speed = float(np.linalg.norm(WireTrace(r, 0.0, wire, tau).derivative(np.pi)))
    around = np.pi + _both_sides(_graded(np.pi, fine / speed, edges, longest), 1)
    for k in range(m):
        parts.append(_disc(strand, wire, fine, edges, around, wire_trace(wire, r, tau, 2 * np.pi * k / m)))
    points = np.concatenate([p.points for p in parts])
    start = np.cumsum([0, *(len(p.points) for p in parts)])
    number = np.arange(len(points))
    inner = _on_flats(points[: start[1]], core, m, in_plane)
    number[_nearest(points, inner, int(start[1]))] = inner
    cells = np.concatenate([p.cells + s for p, s in zip(parts, start)])
    used, packed = np.unique(number[cells], return_inverse=True)
    material = Material("wire", strand.E, strand.nu, 7850.0)
    names = ["core", *(f"wire {k + 1}" for k in range(m))]
    return CrossSectionMesh(
        points[used],
        packed.reshape(cells.shape),
        "triangle6",
        np.repeat(np.arange(m + 1), [len(p.cells) for p in parts]),
        tuple(Region(name, "conductor", material, float("nan")) for name in names),
        tau,
    )


def _members(strand: Strand16) -> list[tuple[float, float]]:
    """Helix radius and radius of the core and of the wires [m]."""
    return [(0.0, strand.core)] + [(strand.helix_radius, strand.wire)] * strand.wires


def _graded(length: float, fine: float, edges: int, longest: float) -> NDArray[np.float64]:
    """Nodes from 0 (the middle of a flat) to `length`: `edges` steps of `fine`, then growing up to `longest`."""
    nodes, step = [fine * i for i in range(edges + 1)], fine
    while True:
        step = min(GROWTH * step, longest)
        left = length - nodes[-1]
        if left < 2.5 * step or step >= longest:
            count = max(1, round(left / step + 0.3))
            return np.concatenate([nodes, nodes[-1] + left * np.arange(1, count + 1) / count])
        nodes.append(nodes[-1] + step)


def _both_sides(nodes: NDArray[np.float64], copies: int) -> NDArray[np.float64]:
    """Angles round a circle with `copies` flats, from half a flat's nodes and their mirror images."""
    turn = 2 * np.pi / copies
    one = np.concatenate([nodes, turn - nodes[-2:0:-1]])
    return (one + turn * np.arange(copies)[:, None]).ravel()


def _disc(
    strand: Strand16, radius: float, fine: float, edges: int, angles: NDArray[np.float64], shape: Shape
) -> CrossSectionMesh:
    """One member: the circle of `rings` with its nodes moved to `angles`, rings thin at the outside."""
    n, closed = len(angles), np.append(angles, angles[0] + 2 * np.pi)
    depth = _graded(radius, fine, edges, DEEPEST * radius)
    radii: Sequence[float] = [float(x) for x in (radius - depth[::-1])[1:]]

    def moved(rho: float, phi: float) -> tuple[float, float]:
        return shape(rho, float(np.interp(phi * n / (2 * np.pi), np.arange(n + 1), closed)))

    return rings(radii, *[(strand.E, strand.nu)] * len(radii), per_ring=1, around=n, shape=moved)


def _on_flats(points: NDArray[np.float64], radius: float, flats: int, half: float) -> NDArray[np.int64]:
    """Nodes of the core that lie on a flat of half-width `half` along its circle."""
    turn = 2 * np.pi / flats
    off = np.abs((np.arctan2(points[:, 1], points[:, 0]) + turn / 2) % turn - turn / 2) * radius
    outside = np.abs(np.hypot(*points.T) - radius) < 1e-9 * radius
    return np.flatnonzero(outside & (off <= half * (1 + 1e-6)))


def _nearest(points: NDArray[np.float64], inner: NDArray[np.int64], start: int) -> NDArray[np.int64]:
    from scipy.spatial import KDTree  # slow to load, needed here only

    return np.asarray(KDTree(points[start:]).query(points[inner])[1], dtype=np.int64) + start

r"""Quadrilaterals of a stranded conductor in the plane normal to its axis, in the frame that turns with its strands.

A strand of radius rho about the helix of radius r appears as the exact trace of a round wire (wire_trace.py), of area

.. math::  A = \pi \rho^2 / \cos\beta_2, \qquad \beta_2 = \arctan(\omega r),

omega the turn rate of the strands. Strands touch along lines, which a mesh that holds together cannot show: they share narrow
flats instead (strand_contact.py), two edges wide, and the outermost share edges with the circle about the conductor. The rest
of the outline follows the trace, moved outwards evenly until the polygon has the area A exactly; metal that a flat takes away
thus reappears beside it. The ring about the conductor is a polygon of N nodes with the area of its circle,

.. math::  R_N^2 = R^2 \frac{2\pi/N}{\sin(2\pi/N)} .

The voids between the strands stay empty. The section is built from the strands of one sector and turned by 2 pi / fold, so
that it maps on itself node for node; fold is the greatest common divisor of the layers, a single centre strand apart.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.disc_grid import DiscGrid, disc_grid, node_multiple
from geometry.errors import GeometryError, MeshError
from geometry.strand import layer_radii
from geometry.strand_contact import RING, Contact, StrandPlace, find_contacts, turned
from geometry.wire_trace import WireTrace

MISFIT = 0.03
"""Largest misfit of a stated conductor radius, as a fraction of the radius over the strands."""
PATCH = 0.8
"""Longest distance of ring nodes over the strand radius: longer ones stand off the strand by a fifth of its radius."""
EVEN = 1e-6
"""Pieces of outline that differ by less than this fraction of the strand radius count as equal."""


@dataclass(frozen=True)
class ConductorSection:
    """Quadrilateral mesh of the strands of a conductor.

    Attributes
    ----------
    points : (n, 2) [m]
    cells : (m, 4) node numbers, counter-clockwise
    strand_of : (m,) strand number: from the inside, counter-clockwise from angle 0 in each layer
    ring : (N,) nodes of the circle about the conductor at the angles 2 pi j / N; some belong to no cell
    fold : the section maps on itself, node for node, when turned by 2 pi / fold
    strands : place of each strand; `radius` is the stated one, `centre_radius` as it is used
    contacts : pairs of strand numbers that share edges, the smaller first; (-1, b) for a strand on the ring
    conductor_radius : R [m]
    strand_scale : conductor radius over the radius over its strands; the pattern was scaled by it, the areas were not
    closed_gap : widest gap [m] between two traces that was closed to a contact; negative if all of them overlap
    """

    points: NDArray[np.float64]
    cells: NDArray[np.int64]
    strand_of: NDArray[np.int64]
    ring: NDArray[np.int64]
    fold: int
    strands: tuple[StrandPlace, ...]
    contacts: tuple[tuple[int, int], ...]
    conductor_radius: float
    strand_scale: float
    closed_gap: float


def conductor_section(
    layers: tuple[int, ...],
    strand_radius: float,
    conductor_radius: float,
    turn_rate: float,
    ring_nodes: int,
    size: float | None = None,
) -> ConductorSection:
    """Mesh the strands of a conductor in the plane normal to its axis.

    Parameters
    ----------
    layers : strands in each layer from the inside, such as (1, 6); all have one lay
    strand_radius, conductor_radius : [m]; the conductor's may differ by up to 3 % from the radius over the strands
    turn_rate : 2 pi / lay per arc length of the conductor [rad/m], signed; 0 for straight strands
    ring_nodes : N, nodes of the circle about the conductor; even and a multiple of the fold
    size : distance [m] of the nodes on the outline of a strand; None takes that of the ring nodes. From strand_radius on,
        the strands are meshed as coarsely as can be.

    Raises
    ------
    GeometryError
        If the strands do not fit into each other or into the conductor.
    MeshError
        If the number of ring nodes does not suit the strands.

    Examples
    --------
    >>> section = conductor_section((1, 6), 1.5e-3, 4.5e-3, 2 * np.pi / 0.127, 48)
    >>> section.fold, len(section.contacts)
    (6, 18)
    """
    if not (strand_radius > 0 and conductor_radius > 0):
        raise GeometryError(
            f"the radii of a conductor and of its strands must be positive, found {1e3 * conductor_radius:g} mm and "
            f"{1e3 * strand_radius:g} mm."
        )
    if not layers or min(layers) < 1:
        raise GeometryError(f"every layer of a conductor needs at least one strand, found the layers {layers}.")
    radii = layer_radii(layers, 2 * strand_radius, "conductor")
    scale = conductor_radius / (radii[-1] + strand_radius)
    if abs(scale - 1) > MISFIT:
        raise GeometryError(
            f"the {sum(layers)} strands of a conductor reach out to {1e3 * conductor_radius / scale:.4g} mm, but its radius is "
            f"stated as {1e3 * conductor_radius:.4g} mm ({100 * (scale - 1):+.1f} %): correct one of them."
        )
    fold = section_fold(layers, ring_nodes)
    _check_ring(ring_nodes, fold, conductor_radius, strand_radius * scale, sum(layers) == 1)
    size = 2 * np.pi * conductor_radius / ring_nodes if size is None else size
    ring = _ring(conductor_radius, ring_nodes)
    if sum(layers) == 1:
        return _whole_disc(ring, fold, conductor_radius, scale, size)
    places = tuple(
        StrandPlace(k, radius * scale, 2 * np.pi * i / count, strand_radius)
        for k, (count, radius) in enumerate(zip(layers, radii, strict=True))
        for i in range(count)
    )
    traces = [WireTrace(p.centre_radius, p.phase, p.radius * scale, turn_rate) for p in places]
    contacts = find_contacts(places, traces, layers, fold, ring, size)
    return _assembled(places, traces, contacts, layers, fold, ring, conductor_radius, scale, size)


def section_fold(layers: tuple[int, ...], ring_nodes: int) -> int:
    """Turns of 2 pi / fold map the section on itself; for a single strand, whose pattern must suit the ring, 6, 4, 5 or 3.

    >>> section_fold((1, 6, 12), 48), section_fold((3, 9, 15), 48), section_fold((1,), 32)
    (6, 3, 4)
    """
    if tuple(layers) == (1,):
        return next((k for k in (6, 4, 5, 3) if ring_nodes % node_multiple(k) == 0), 4)
    return math.gcd(*(layers[1:] if layers[0] == 1 else layers))


def _check_ring(ring_nodes: int, fold: int, conductor_radius: float, radius: float, single: bool) -> None:
    """Raise if the ring nodes do not suit the fold, or are too few for edges shared with the outer strands."""
    step = math.lcm(2, fold) if not single else node_multiple(fold)
    fewest = step * math.ceil(2 * np.pi * conductor_radius / (PATCH * radius) / step - 1e-9)
    if ring_nodes < 1 or ring_nodes % step:
        raise MeshError(
            f"the ring about a conductor whose strands repeat {fold} times a turn needs a number of nodes that is a multiple "
            f"of {step}, found {ring_nodes}: take {max(fewest, step * max(1, round(ring_nodes / step)))}."
        )
    if ring_nodes < fewest and not single:
        raise MeshError(
            f"{ring_nodes} nodes on the ring about a conductor of {1e3 * conductor_radius:.4g} mm are too far apart for edges "
            f"shared with strands of {1e3 * radius:.4g} mm: take at least {fewest}."
        )


def _ring(radius: float, count: int) -> NDArray[np.float64]:
    """Nodes of a polygon with the area of the circle."""
    step = 2 * np.pi / count
    angle = step * np.arange(count)
    return radius * np.sqrt(step / np.sin(step)) * np.column_stack([np.cos(angle), np.sin(angle)])


def _whole_disc(ring: NDArray[np.float64], fold: int, radius: float, scale: float, size: float) -> ConductorSection:
    grid = disc_grid(ring, fold, _rings(radius, size))
    strand_of = np.zeros(len(grid.cells), dtype=np.int64)
    place = (StrandPlace(0, 0.0, 0.0, radius),)
    nodes = np.arange(len(ring))
    return ConductorSection(grid.points, grid.cells, strand_of, nodes, fold, place, ((RING, 0),), radius, scale, 0.0)


def _rings(radius: float, size: float) -> int | None:
    """No rings in strands that are wanted as coarse as can be."""
    return 0 if size >= radius else None


def _assembled(
    places: Sequence[StrandPlace],
    traces: Sequence[WireTrace],
    contacts: Sequence[Contact],
    layers: tuple[int, ...],
    fold: int,
    ring: NDArray[np.float64],
    conductor_radius: float,
    scale: float,
    size: float,
) -> ConductorSection:
    """Mesh the strands of one sector, turn them into place, and give common nodes one number."""
    points, cells, strand_of = [ring], [], []
    start, count = 0, len(ring)
    outlines: dict[int, NDArray[np.float64]] = {}
    for layer in layers:
        centre = layer == 1 and start == 0
        sector = range(start, start + (1 if centre else layer // fold))
        for strand in sector:
            pattern = fold if centre and fold not in (1, 2, 4) else 4
            target = float(np.pi * places[strand].radius ** 2 / np.cos(traces[strand].lay_angle))
            touching = [c for c in contacts if strand in (c.first, c.second)]
            outline = _outline(strand, traces[strand], touching, target, node_multiple(pattern), size)
            outlines[strand] = outline
            grid = _grid(strand, outline, pattern, _rings(places[strand].radius, size))
            for copy in range(1 if centre else fold):
                points.append(turned(grid.points, 2 * np.pi * copy / fold))
                cells.append(grid.cells + count)
                strand_of.append(np.full(len(grid.cells), strand + copy * len(sector)))
                count += len(grid.points)
        start += layer
    merged, number = _merged(np.vstack(points), 1e-6 * places[0].radius)
    return ConductorSection(
        points=merged,
        cells=number[np.vstack(cells)],
        strand_of=np.concatenate(strand_of),
        ring=number[: len(ring)],
        fold=fold,
        strands=tuple(places),
        contacts=tuple(sorted((c.first, c.second) for c in contacts)),
        conductor_radius=conductor_radius,
        strand_scale=scale,
        closed_gap=max((c.gap for c in contacts if c.first != RING), default=0.0),
    )


def _grid(strand: int, outline: NDArray[np.float64], pattern: int, rings: int | None) -> DiscGrid:
    try:
        return disc_grid(outline, pattern, rings)
    except MeshError as error:
        raise MeshError(f"strand {strand} of the conductor: {error}") from error


def _outline(
    strand: int, trace: WireTrace, touching: Sequence[Contact], target: float, multiple: int, size: float
) -> NDArray[np.float64]:
    """Boundary nodes of one strand: shared nodes at its contacts, free ones on its trace moved out to give the area."""
    centre = trace.centre_radius * np.array([np.cos(trace.phase), np.sin(trace.phase)])
    shared = [c.nodes if c.first in (strand, RING) else c.nodes[::-1] for c in touching]
    middles = np.array([nodes.mean(0) - centre for nodes in shared])
    turn = np.arctan2(middles[:, 1], middles[:, 0]) - trace.phase
    shared = [shared[k] for k in np.argsort(np.round(turn, 9) % (2 * np.pi))]
    ends = np.vstack([[nodes[0], nodes[-1]] for nodes in shared])
    phi = trace.nearest(ends).reshape(-1, 2)
    width = (phi[:, 1] - phi[:, 0] + np.pi) % (2 * np.pi) - np.pi
    gap = (np.roll(phi[:, 0], -1) - phi[:, 0]) % (2 * np.pi)
    gap[gap < 1e-9] = 2 * np.pi
    free = gap - width
    if free.min() <= 0:
        raise GeometryError(
            f"two contacts of strand {strand} of the conductor run into each other: take more ring nodes or a smaller size."
        )
    counts = _edge_counts(free * trace.radius, sum(len(nodes) - 1 for nodes in shared), multiple, size, trace.radius)
    nodes, normals = [], []
    for piece, end, width_free, count in zip(shared, phi[:, 1], free, counts, strict=True):
        angles = end + width_free * np.arange(1, count) / count
        slope = trace.derivative(angles)
        nodes += [piece, trace.point(angles)]
        outward = np.column_stack([slope[:, 1], -slope[:, 0]])
        normals += [np.zeros_like(piece), outward / np.linalg.norm(outward, axis=1, keepdims=True)]
    return _with_area(np.vstack(nodes), np.vstack(normals), target, strand)


def _edge_counts(
    lengths: NDArray[np.float64], shared: int, multiple: int, size: float, radius: float
) -> NDArray[np.int64]:
    """Edges of each free piece of an outline, equal on equal pieces, so that the total is a multiple and the size about kept."""
    _, group = np.unique(np.round(lengths / (EVEN * radius)), return_inverse=True)
    for groups in (group, np.arange(len(lengths))):
        wanted = np.array([lengths[groups == g].mean() / size for g in range(groups.max() + 1)])
        weight = np.bincount(groups)
        base = np.maximum(1, np.round(wanted)).astype(int)
        reach = range(-1, 4) if len(base) <= 4 else range(0, 2)
        best, least = None, np.inf
        for change in itertools.product(reach, repeat=len(base)):
            edges = base + np.array(change)
            if edges.min() < 1 or edges.max() < 2 or (shared + (weight * edges).sum()) % multiple:
                continue
            cost = float((weight * np.log(edges / wanted) ** 2).sum())
            if cost < least:
                best, least = edges, cost
        if best is not None:
            return best[groups]
    raise MeshError(
        "no number of nodes suits the outline of a strand: take another number of ring nodes or another size."
    )


def _with_area(
    nodes: NDArray[np.float64], normals: NDArray[np.float64], target: float, strand: int
) -> NDArray[np.float64]:
    """Move the free nodes along their normals by one distance so that the polygon has the area `target` [m^2]."""

    def area(p: NDArray[np.float64], q: NDArray[np.float64]) -> float:
        return float(0.5 * (p[:, 0] * np.roll(q[:, 1], -1) - np.roll(q[:, 0], -1) * p[:, 1]).sum())

    constant, square = area(nodes, nodes) - target, area(normals, normals)
    slope = area(nodes, normals) + area(normals, nodes)
    inside = slope**2 - 4 * square * constant
    if slope <= 0 or inside <= 0:
        raise GeometryError(f"strand {strand} of the conductor is pressed from all sides: it cannot keep its area.")
    return nodes - 2 * constant / (slope + np.sqrt(inside)) * normals


def _merged(points: NDArray[np.float64], tolerance: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Points without repetition, and the new number of each; the first of several is kept."""
    from scipy.spatial import cKDTree  # slow to load, needed here only

    first = np.arange(len(points))
    for i, j in sorted(cKDTree(points).query_pairs(tolerance)):
        first[j] = min(first[j], first[i])
    kept, number = np.unique(first, return_inverse=True)
    return points[kept], number.astype(np.int64)

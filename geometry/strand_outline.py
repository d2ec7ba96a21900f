r"""Outline of one strand of a conductor as a polygon: shared nodes at its contacts, free ones between them.

The free nodes follow the exact trace, evenly spaced on each piece, all moved along its outward normals by one distance d. The
area of the polygon is quadratic in d, with the nodes x_k and their normals n_k (zero at shared nodes),

.. math::  A(d) = \tfrac12 \sum_k (x_k + d\, n_k) \times (x_{k+1} + d\, n_{k+1}),

so that the d that gives the exact area of the strand is known in closed form.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import GeometryError, MeshError
from geometry.strand_contact import RING, Contact
from geometry.wire_trace import WireTrace

EVEN = 1e-6
"""Pieces of outline that differ by less than this fraction of the strand radius count as equal."""


@dataclass(frozen=True)
class StrandOutline:
    """`nodes` (n, 2) [m] counter-clockwise; `free` (n,) tells those that no other strand and not the ring shares."""

    nodes: NDArray[np.float64]
    free: NDArray[np.bool_]


def strand_outline(
    strand: int, trace: WireTrace, touching: Sequence[Contact], target: float, multiple: int, size: float
) -> StrandOutline:
    """Boundary nodes of one strand.

    Parameters
    ----------
    strand, trace : its number, and its trace
    touching : its contacts, at least one
    target : area of the polygon [m^2]
    multiple : of this number is the count of nodes
    size : wanted distance of the free nodes [m]

    Raises
    ------
    GeometryError
        If two contacts run into each other, or the strand cannot keep its area between them.
    """
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
    normal = np.vstack(normals)
    return StrandOutline(_with_area(np.vstack(nodes), normal, target, strand), np.any(normal != 0, axis=1))


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


def run_into(nodes: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which of `nodes` (n, 2) lie inside the closed polygon `other` (m, 2): they do if a ray crosses it an odd number of times.

    >>> square = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    >>> run_into(np.array([[0.5, 0.5], [1.5, 0.5]]), square).tolist()
    [True, False]
    """
    x, y = nodes[:, :1], nodes[:, 1:]
    (x0, y0), (x1, y1) = other.T, np.roll(other, -1, axis=0).T
    spans = (y0 > y) != (y1 > y)
    rise = np.where(spans, y1 - y0, 1.0)
    return (spans & (x < x0 + (y - y0) * (x1 - x0) / rise)).sum(1) % 2 == 1

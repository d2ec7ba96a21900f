r"""Doubling the nodes where parts are separated, and the surface that is left between them.

At a node the parts that meet fall into groups: two parts belong together unless their interface is separated. Every group gets
its own copy of the node, so that a point where three separated parts meet has three, and a point where a separated interface ends on
a part that is bonded to both sides has one. The copies are joined in a tree by links, each with

* the normal of the helical surface in the rotating frame, from the first side outwards, and two tangents,

.. math:: N = (n_X,\, n_Y,\, \tau_0 (n_X Y - n_Y X)) / |\cdot|, \quad a = (-n_Y, n_X, 0), \quad b = N \times a,

  (n the normal of the trace; N is orthogonal to the trace and to the helix direction (-tau_0 Y, tau_0 X, 1)),
* its surface per length along z, by Simpson's rule: :math:`w = \int \varphi\, |(n_X, n_Y, \tau_0(n_X Y - n_Y X))|\, ds`.

Where three parts meet, the third interface (between the two copies that are not linked) has no law of its own at that one node: an
error that vanishes with the element size. Where a trace is a circle its normals are those of the circle; else they are means over
the quadratic edges that meet.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import MeshError
from homogenize.section_field import FloatArray, SectionField

_EDGES = ((0, 3, 1), (1, 4, 2), (2, 5, 0))  # corner, middle, corner of a six-node triangle
_ROUND = 1e-7
"""Relative deviation up to which a trace counts as a circle."""


@dataclass(frozen=True)
class DoubledNodes:
    """A section with copies of the nodes on separated interfaces, and the links between copies (L of them).

    Attributes
    ----------
    nodes : (2, n + copies) positions, the original ones first
    cells : (6, e) of the doubled field
    child, parent : (L,) node numbers; a child is always a copy, and hangs on one parent that comes before it
    law : (L,) number of the law
    regions : (L, 2) regions of the child's and the parent's side
    frame : (3, 3, L) normal from child to parent, and two tangents a, b, as rows
    surface : (L,) w, surface per length of cable [m]
    """

    nodes: FloatArray
    cells: NDArray[np.int64]
    child: NDArray[np.int64]
    parent: NDArray[np.int64]
    law: NDArray[np.int64]
    regions: NDArray[np.int64]
    frame: FloatArray
    surface: FloatArray


@dataclass(frozen=True)
class _Edges:
    """Quadratic edges (corner, middle, corner) between separated regions, `regions` (m, 2), and per node of the edge
    the unit normal out of the first region, (2, 3, m), and its length (3, m)."""

    nodes: NDArray[np.int64]
    regions: NDArray[np.int64]
    normal: FloatArray
    length: FloatArray


def doubled_nodes(field: SectionField, law_of: NDArray[np.int64]) -> DoubledNodes:
    """Double the nodes between regions a, b with law_of[a, b] >= 0.

    Raises
    ------
    MeshError
        If the mesh is not made of triangles.
    """
    if field.cells.shape[0] != 6:
        raise MeshError(
            "interfaces that are not bonded need a mesh of triangles; mesh the cross-section with kind triangle6."
        )
    edges = _separated_edges(field, law_of)
    group_of = _groups(field, law_of, np.unique(edges.nodes))
    number = {node: _copy_numbers(groups) for node, groups in group_of.items()}
    n, extra, copy = field.nodes.shape[1], [], {}
    for node, groups in number.items():
        for g in range(max(groups.values()) + 1):
            copy[node, g] = node if g == 0 else n + len(extra)
            if g > 0:
                extra.append(node)
    cells = field.cells.copy()
    for region in np.unique(edges.regions):
        target = np.arange(n)
        for node, groups in number.items():
            if region in groups:
                target[node] = copy[node, groups[region]]
        inside = field.region_of == region
        cells[:, inside] = target[field.cells[:, inside]]
    nodes = np.concatenate([field.nodes, field.nodes[:, extra]], axis=1)
    return _linked(field, edges, number, copy, law_of, nodes, cells)


def _separated_edges(field: SectionField, law_of: NDArray[np.int64]) -> _Edges:
    nodes = np.concatenate([field.cells[list(e)] for e in _EDGES], axis=1)
    element = np.tile(np.arange(field.cells.shape[1]), 3)
    order = np.argsort(nodes[1], kind="stable")
    nodes, element = nodes[:, order], element[order]
    twin = np.flatnonzero(nodes[1, 1:] == nodes[1, :-1])
    regions = np.stack([field.region_of[element[twin]], field.region_of[element[twin + 1]]], axis=1)
    apart = law_of[regions[:, 0], regions[:, 1]] >= 0
    nodes, regions, element = nodes[:, twin[apart]], regions[apart], element[twin[apart]]
    A, M, B = (field.nodes[:, k] for k in nodes)
    slopes = np.stack([-3 * A + 4 * M - B, B - A, A - 4 * M + 3 * B], axis=1)
    speed = np.linalg.norm(slopes, axis=0)
    centroid = field.nodes[:, field.cells[:3, element]].mean(axis=1)
    away = np.sign((B - A)[0] * (centroid - A)[1] - (B - A)[1] * (centroid - A)[0])
    normal = np.stack([slopes[1], -slopes[0]]) * away / speed
    for a, b in np.unique(regions, axis=0):
        here = (regions == (a, b)).all(axis=1) | (regions == (b, a)).all(axis=1)
        centre = _circle(field.nodes[:, np.unique(nodes[:, here])])
        if centre is not None:
            radial = np.stack([A, M, B], axis=1)[:, :, here] - centre[:, None, None]
            radial /= np.linalg.norm(radial, axis=0)
            normal[:, :, here] = radial * np.sign((radial * normal[:, :, here]).sum(axis=0))
    return _Edges(nodes, regions, normal, speed * np.array([1, 4, 1])[:, None] / 6)


def _circle(points: FloatArray) -> FloatArray | None:
    """Centre of the circle through points (2, n), or None if they do not lie on one."""
    if points.shape[1] < 5:
        return None
    middle = points.mean(axis=1, keepdims=True)
    size = np.abs(points - middle).max()
    x, y = (points - middle) / size
    fit = np.linalg.lstsq(np.column_stack([2 * x, 2 * y, np.ones(len(x))]), x**2 + y**2, rcond=None)[0]
    distance = np.hypot(x - fit[0], y - fit[1])
    return fit[:2] * size + middle[:, 0] if np.ptp(distance) < _ROUND * distance.mean() else None


def _groups(field: SectionField, law_of: NDArray[np.int64], nodes: NDArray[np.int64]) -> dict[int, list[list[int]]]:
    """Groups of regions at each node; the one that holds the last region first."""
    wanted = np.zeros(field.nodes.shape[1], dtype=bool)
    wanted[nodes] = True
    met = wanted[field.cells]
    region = np.broadcast_to(field.region_of, field.cells.shape)[met]
    incident: dict[int, set[int]] = defaultdict(set)
    for node, r in zip(field.cells[met].tolist(), region.tolist()):
        incident[node].add(r)
    known: dict[tuple[int, ...], list[list[int]]] = {}
    for regions in {tuple(sorted(r)) for r in incident.values()}:
        groups: list[list[int]] = []
        for r in regions:
            joined = [g for g in groups if any(law_of[r, other] < 0 for other in g)]
            groups = [g for g in groups if g not in joined] + [[r, *(o for g in joined for o in g)]]
        known[regions] = sorted(groups, key=max, reverse=True)
    return {node: known[tuple(sorted(r))] for node, r in incident.items()}


def _copy_numbers(groups: list[list[int]]) -> dict[int, int]:
    """Group number of each region at a node."""
    return {region: g for g, group in enumerate(groups) for region in group}


def _linked(
    field: SectionField,
    edges: _Edges,
    number: dict[int, dict[int, int]],
    copy: dict[tuple[int, int], int],
    law_of: NDArray[np.int64],
    nodes: FloatArray,
    cells: NDArray[np.int64],
) -> DoubledNodes:
    """Links between the copies of each node, from its first group outwards, with what the edges between them add up to."""
    found: dict[int, dict[tuple[int, int], list[tuple]]] = defaultdict(lambda: defaultdict(list))
    for m, (a, b) in enumerate(edges.regions.tolist()):
        for k, node in enumerate(edges.nodes[:, m].tolist()):
            g, h = number[node][a], number[node][b]
            if g != h:
                sign, pair = (1.0, (a, b)) if g > h else (-1.0, (b, a))
                entry = (edges.length[k, m], sign * edges.normal[:, k, m], law_of[a, b], pair)
                found[node][max(g, h), min(g, h)].append(entry)
    links = []
    for node, between in found.items():
        reached = {0}
        while True:
            step = next(((g, h) for g, h in sorted(between) if (g in reached) != (h in reached)), None)
            if step is None:
                break
            child, parent = step if step[1] in reached else step[::-1]
            links.append(_link(between[step], copy[node, child], copy[node, parent], 1.0 if step[0] == child else -1.0))
            reached.add(child)
    child, parent, law, regions, normal, length = zip(*links)
    frame, metric = _frame(field, nodes[:, list(child)], np.array(normal).T)
    surface = np.array(length) * metric
    as_int = [np.array(v, dtype=np.int64) for v in (child, parent, law, regions)]
    return DoubledNodes(nodes, cells, as_int[0], as_int[1], as_int[2], as_int[3], frame, surface)


def _link(entries: list[tuple], child: int, parent: int, sign: float) -> tuple:
    """One link from its edges: (child, parent, law, regions, unit normal, length), the law with the largest share."""
    share: dict[int, float] = defaultdict(float)
    for length, _, law, _ in entries:
        share[law] += length
    law = max(share, key=lambda k: share[k])
    regions = next(pair for _, _, own, pair in entries if own == law)
    normal = sign * sum(length * normal for length, normal, _, _ in entries)
    pair = regions if sign > 0 else regions[::-1]
    return child, parent, law, pair, normal / np.linalg.norm(normal), sum(share.values())


def _frame(field: SectionField, position: FloatArray, normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """N, a, b as rows (3, 3, L), and the surface per length along z and along the trace."""
    (X, Y), (nX, nY) = position, normal
    N = np.stack([nX, nY, field.twist_rate * (nX * Y - nY * X)])
    metric = np.linalg.norm(N, axis=0)
    N /= metric
    a = np.stack([-nY, nX, np.zeros_like(nX)])
    return np.stack([N, a, np.cross(N, a, axis=0)]), metric

r"""What fills the voids between the strands of a conductor: triangles on the nodes that strands and ring have there already.

A void is a face of the drawing: its outline runs along free edges of strands and along edges of the ring. A polygon of n nodes is cut by
n - 3 of its diagonals; of all ways to do so the one whose worst triangle is best is found by dynamic programming over
sub-polygons i .. j,

.. math::  q_{ij} = \max_{i < k < j} \min(q_{ik},\, q_{kj},\, s_{ikj}) ,

s the scaled Jacobian of the triangle (G. T. Klincsek, Minimal triangulations of polygonal domains, Ann. Discrete Math. 9 (1980) 121-123,
there for other measures). All triangles are counter-clockwise, so that they cannot overlap. No node is added but one on the axis
where a void lies round it, and voids that map on each other when the section turns by 2 pi / fold are cut alike.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geometry.errors import MeshError
from geometry.mesh_quality import block_quality

Nodes = NDArray[np.int64]


def fill_voids(
    points: NDArray[np.float64], cells: Nodes, ring: Nodes, fold: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Triangles in all voids of a section.

    Parameters
    ----------
    points : (n, 2) [m]
    cells : (m, 4) quadrilaterals of the strands, counter-clockwise
    ring : (N,) nodes of the circle about the conductor, counter-clockwise
    fold : the section maps on itself when turned by 2 pi / fold

    Returns
    -------
    points : with a node on the axis appended where a void lies round it
    triangles : (t, 3) counter-clockwise

    Raises
    ------
    MeshError
        If the outline of a void crosses itself.
    """
    from scipy.spatial import KDTree  # slow to load, needed here only

    loops = void_outlines(points, cells, ring)
    tree, scale = KDTree(points), float(np.abs(points).max())
    triangles: list[Nodes] = []
    left = {frozenset(loop.tolist()): loop for loop in loops}
    while left:
        loop = next(iter(left.values()))
        angle = 2 * np.pi * np.arange(fold) / fold
        turned = [points[loop] @ np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]]) for a in angle]
        distance, found_nodes = tree.query(np.array(turned))
        images = np.asarray(found_nodes, dtype=np.int64)
        if np.max(distance) > 1e-6 * scale:
            raise MeshError(f"the voids of a conductor do not repeat {fold} times a turn: the strands do not, either.")
        if fold > 1 and frozenset(images[1].tolist()) == frozenset(loop.tolist()):
            centre = len(points)
            points = np.vstack([points, [0.0, 0.0]])
            triangles.append(np.column_stack([loop, np.roll(loop, -1), np.full(len(loop), centre)]))
            del left[frozenset(loop.tolist())]
            continue
        cut = best_triangles(points[loop])
        for image in images:
            triangles.append(image[cut])
            del left[frozenset(image.tolist())]
    found = np.concatenate(triangles) if triangles else np.empty((0, 3), dtype=np.int64)
    if len(found) and not block_quality(points, found, "triangle").min() > 0:
        raise MeshError(
            "a void between strands has an outline that crosses itself: take more ring nodes or a smaller size."
        )
    return points, found


def void_outlines(points: NDArray[np.float64], cells: Nodes, ring: Nodes) -> list[Nodes]:
    """Outlines of all voids, counter-clockwise about them: free edges of the strands backwards, free edges of the ring."""
    edges = np.concatenate([cells[:, [k, (k + 1) % 4]] for k in range(4)])
    round_ring = np.column_stack([np.roll(ring, -1), ring])  # as if a cell lay outside
    edges = np.concatenate([edges, round_ring])
    key = np.sort(edges, axis=1)
    _, index, count = np.unique(key, axis=0, return_index=True, return_counts=True)
    free = edges[index[count == 1]][:, ::-1]
    leaving: dict[int, list[int]] = {}
    for a, b in free.tolist():
        leaving.setdefault(a, []).append(b)
    loops = []
    while leaving:
        start = next(iter(leaving))
        loop, here = [start], leaving[start].pop()
        while here != start:
            loop.append(here)
            here = _leftmost(points, loop[-2], here, leaving)
        loops.append(np.array(loop, dtype=np.int64))
        leaving = {node: ends for node, ends in leaving.items() if ends}
    return loops


def _leftmost(points: NDArray[np.float64], before: int, here: int, leaving: dict[int, list[int]]) -> int:
    """Take the edge from `here` that turns most to the left; where voids meet in a node, each keeps its own outline."""
    back = points[before] - points[here]
    ends = leaving[here]

    def turn(end: int) -> float:
        ahead = points[end] - points[here]
        return float((np.arctan2(ahead[1], ahead[0]) - np.arctan2(back[1], back[0])) % (2 * np.pi))

    best = max(ends, key=turn)
    ends.remove(best)
    return best


def best_triangles(polygon: NDArray[np.float64]) -> NDArray[np.int64]:
    """Cut a simple polygon (n, 2), counter-clockwise, into n - 2 triangles, the worst of them as good as it can be.

    Raises
    ------
    MeshError
        If no cut has triangles that all are counter-clockwise.

    Examples
    --------
    >>> best_triangles(np.array([[0.0, 0.0], [2.0, 0.0], [0.6, 0.5], [0.0, 2.0]])).tolist()
    [[0, 2, 3], [0, 1, 2]]
    """
    n = len(polygon)
    quality, middle = np.full((n, n), -np.inf), np.zeros((n, n), dtype=np.int64)
    quality[np.arange(n - 1), np.arange(1, n)] = np.inf
    for span in range(2, n):
        for i in range(n - span):
            j, k = i + span, np.arange(i + 1, i + span)
            corners = np.column_stack([np.full(len(k), i), k, np.full(len(k), j)])
            own = block_quality(polygon, corners, "triangle")
            worst = np.minimum(np.minimum(quality[i, k], quality[k, j]), own)
            at = int(worst.argmax())
            quality[i, j], middle[i, j] = worst[at], k[at]
    if not quality[0, n - 1] > 0:
        raise MeshError(
            f"the outline of a void between strands, a polygon of {n} nodes, crosses itself: take more ring nodes or a smaller size."
        )
    triangles, left = [], [(0, n - 1)]
    while left:
        i, j = left.pop()
        if j - i > 1:
            k = int(middle[i, j])
            triangles.append((i, k, j))
            left += [(i, k), (k, j)]
    return np.array(triangles, dtype=np.int64)

r"""Structured quadrilaterals inside one closed curve, from its boundary nodes alone, which may be spaced unevenly.

Two patterns, each wrapped by rings of quadrilaterals that follow the boundary (n boundary nodes):

* square: a grid of n/4 x n/4 in the middle, the "O-grid" or "butterfly"; symmetric in quarter turns, n a multiple of 4;
* kites: `sectors` = k kites of m x m cells about a centre node, the midpoint subdivision of a k-gon; symmetric in turns of
  2 pi / k, n = 2 k m.

The nodes inside stand at the mean of their neighbours,

.. math::  \sum_{j \sim i} (x_j - x_i) = 0 .

For a convex boundary no cell of such a drawing folds over: W. T. Tutte, How to draw a graph, Proc. London Math. Soc. 13 (1963)
743-767, doi 10.1112/plms/s3-13.1.743. It is unique, so it has every symmetry that the boundary and the pattern share.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import MeshError
from geometry.mesh_quality import block_quality


@dataclass(frozen=True)
class DiscGrid:
    """Quadrilaterals of a disc: `points` (n, 2) [m], the boundary nodes first, in the order given; `cells` (m, 4), ccw."""

    points: NDArray[np.float64]
    cells: NDArray[np.int64]

    @property
    def quality(self) -> float:
        """Smallest scaled Jacobian."""
        return float(block_quality(self.points, self.cells, "quad").min())


def node_multiple(sectors: int) -> int:
    """The number that the count of boundary nodes must be a multiple of: 4 for the square, 2 k for k kites.

    >>> node_multiple(4), node_multiple(6)
    (4, 12)
    """
    return 4 if sectors == 4 else 2 * sectors


def disc_grid(boundary: NDArray[np.float64], sectors: int = 4, rings: int | None = None) -> DiscGrid:
    """Mesh the inside of a closed polygon; of all positions of the pattern along the boundary the one of best quality is taken.

    Parameters
    ----------
    boundary : (n, 2) nodes, counter-clockwise
    sectors : 4 for the square pattern, 3, 5, 6 ... for that many kites
    rings : rings of cells between the pattern and the boundary; None lets them have about the size of the pattern's cells

    Raises
    ------
    MeshError
        If the number of nodes does not suit the pattern, the polygon runs clockwise, or a cell is inside out.

    Examples
    --------
    >>> angle = 2 * np.pi * np.arange(12) / 12
    >>> len(disc_grid(np.column_stack([np.cos(angle), np.sin(angle)]), rings=1).cells)
    21
    """
    n = len(boundary)
    multiple = node_multiple(sectors)
    if sectors < 3 or n == 0 or n % multiple:
        raise MeshError(
            f"a disc in {sectors} sectors needs a number of boundary nodes that is a multiple of {multiple}, found {n}: "
            "add or remove nodes."
        )
    x, y = boundary.T
    if not (x * np.roll(y, -1) - np.roll(x, -1) * y).sum() > 0:
        raise MeshError("the boundary of a disc must run counter-clockwise: reverse the order of its nodes.")
    rings = max(1, round(0.06 * n)) if rings is None else rings
    count, cells = _square(n // 4, rings) if sectors == 4 else _kites(sectors, n // (2 * sectors), rings)
    grids = [_drawn(boundary, start, count, cells) for start in range(n // sectors)]
    best = max(grids, key=lambda grid: round(grid.quality, 6))
    if not best.quality > 0:
        raise MeshError(
            f"no regular mesh fits inside a closed curve of {n} nodes: its corners are too sharp or its spacing too uneven "
            f"(scaled Jacobian {best.quality:.2g}): use more nodes."
        )
    return best


def _drawn(boundary: NDArray[np.float64], start: int, count: int, cells: NDArray[np.int64]) -> DiscGrid:
    """Place the inner nodes of a pattern whose first boundary node is node `start` of the boundary."""
    from scipy.sparse import coo_array, csc_array  # slow to load, needed here only
    from scipy.sparse.linalg import spsolve

    n = len(boundary)
    number = np.arange(count)
    number[:n] = (number[:n] + start) % n
    edges = np.unique(np.sort(np.concatenate([cells[:, [k, (k + 1) % 4]] for k in range(4)]), axis=1), axis=0)
    i, j = number[edges].T
    pull = coo_array((np.ones(2 * len(edges)), (np.concatenate([i, j]), np.concatenate([j, i]))), (count, count))
    stiffness = csc_array(coo_array((pull.sum(0), (np.arange(count), np.arange(count)))) - pull)
    points = np.vstack([boundary, np.zeros((count - n, 2))])
    if count > n:
        inside = np.asarray(spsolve(stiffness[n:, n:], -(stiffness[n:, :n] @ boundary)))
        points[n:] = inside.reshape(-1, 2)
    return DiscGrid(points, number[cells])


def _rings(n: int, rings: int) -> NDArray[np.int64]:
    """Cells of the rings; node i of level k (0 outside) is k n + i."""
    k, i = np.divmod(np.arange(rings * n), n)
    j = (i + 1) % n
    return np.stack([k * n + i, k * n + j, (k + 1) * n + j, (k + 1) * n + i], axis=1).astype(np.int64)


def _square(q: int, rings: int) -> tuple[int, NDArray[np.int64]]:
    """Number of nodes and cells of the square pattern: 4 q boundary nodes."""
    n = 4 * q
    grid = np.empty((q + 1, q + 1), dtype=np.int64)
    rim, along = rings * n + np.arange(n), np.arange(q)
    grid[along, 0], grid[q, along], grid[q - along, q], grid[0, q - along] = rim.reshape(4, q)
    first = (rings + 1) * n
    grid[1:q, 1:q] = first + np.arange((q - 1) ** 2).reshape(q - 1, q - 1)
    return first + (q - 1) ** 2, np.vstack([_rings(n, rings), _grid_cells(grid)])


def _kites(k: int, m: int, rings: int) -> tuple[int, NDArray[np.int64]]:
    """Number of nodes and cells of the pattern of `k` kites: 2 k m boundary nodes."""
    n = 2 * k * m
    centre = (rings + 1) * n
    spokes = centre + 1 + np.arange(k * (m - 1)).reshape(k, m - 1)
    inside = centre + 1 + k * (m - 1) + np.arange(k * (m - 1) ** 2).reshape(k, m - 1, m - 1)
    cells = [_rings(n, rings)]
    for i in range(k):
        rim = rings * n + (np.arange(-m, m + 1) + 2 * m * i) % n
        grid = np.empty((m + 1, m + 1), dtype=np.int64)
        grid[0, 0], grid[1:m, 0], grid[0, 1:m], grid[1:m, 1:m] = centre, spokes[i - 1], spokes[i], inside[i]
        grid[m, :], grid[:, m] = rim[: m + 1], rim[m:][::-1]
        cells.append(_grid_cells(grid))
    return centre + 1 + k * (m - 1) + k * (m - 1) ** 2, np.vstack(cells)


def _grid_cells(grid: NDArray[np.int64]) -> NDArray[np.int64]:
    corners = [grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]]
    return np.stack([c.ravel() for c in corners], axis=1)

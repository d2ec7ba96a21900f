"""Faces of volume cells: which cells share one, and which lie on each other across the end faces of a periodic cell.

Two cells share a face if its nodes are the same. Faces are listed with their normal (right-hand rule) out of the cell.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.cell_mesh import SliceMesh, SweptCell
from geometry.errors import MeshError

FACES = {
    "hexahedron": [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
    "wedge": [(0, 2, 1, -1), (3, 4, 5, -1), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
    "pyramid": [(0, 3, 2, 1), (0, 1, 4, -1), (1, 2, 4, -1), (2, 3, 4, -1), (3, 0, 4, -1)],
    "tetra": [(0, 2, 1, -1), (0, 1, 3, -1), (1, 2, 3, -1), (2, 0, 3, -1)],
}
WIDTH = 8
"""Most corners of a cell."""


@dataclass(frozen=True)
class CellFaces:
    """Faces of cells: `nodes` (f, 4), the last one -1 for triangles, seen from the cell outwards; `corners` (f, 4), where the
    node stands in ``cell_table(mesh).ravel()``, -1 beside a missing node; `cells` (f,) the owners, counted over all blocks."""

    nodes: NDArray[np.int64]
    corners: NDArray[np.int64]
    cells: NDArray[np.int64]


def cell_table(mesh: SliceMesh | SweptCell) -> NDArray[np.int64]:
    """Node numbers of all cells, block after block, (m, 8), filled up with -1."""
    table = np.full((sum(len(block.cells) for block in mesh.blocks), WIDTH), -1, dtype=np.int64)
    start = 0
    for block in mesh.blocks:
        table[start : start + len(block.cells), : block.cells.shape[1]] = block.cells
        start += len(block.cells)
    return table


def regions_of_cells(mesh: SliceMesh | SweptCell) -> NDArray[np.int64]:
    """Region of all cells, block after block, (m,)."""
    return np.concatenate([block.region_of for block in mesh.blocks])


def faces_at(mesh: SliceMesh | SweptCell, marked: NDArray[np.bool_], whole: bool) -> CellFaces:
    """Faces of all cells with all nodes (`whole`) or at least one node among the `marked` (n,) nodes."""
    nodes, corners, owners = [], [], []
    start = 0
    for block in mesh.blocks:
        if block.kind not in FACES:
            raise MeshError(f'faces of cells of kind "{block.kind}" are not known: take one of {", ".join(FACES)}.')
        mark = marked[block.cells]
        for face in FACES[block.kind]:
            local = [k for k in face if k >= 0]
            rows = np.flatnonzero(mark[:, local].all(axis=1) if whole else mark[:, local].any(axis=1))
            filler = np.full((len(rows), 4 - len(local)), -1)
            nodes.append(np.hstack([block.cells[rows[:, None], local], filler]))
            corners.append(np.hstack([(start + rows[:, None]) * WIDTH + np.array(local), filler]))
            owners.append(start + rows)
        start += len(block.cells)
    return CellFaces(np.vstack(nodes), np.vstack(corners), np.concatenate(owners))


def same_faces(nodes: NDArray[np.int64], mesh: SliceMesh | SweptCell) -> NDArray[np.int64]:
    """Rows of `nodes` (f, 4) that hold the same nodes in any order, as pairs (p, 2).

    Raises
    ------
    MeshError
        If three cells share one face.
    """
    if len(nodes) == 0:
        return np.zeros((0, 2), dtype=np.int64)
    n = len(mesh.points) + 1
    ranked = np.sort(nodes, axis=1) + 1
    first, second = ranked[:, 0] * n + ranked[:, 1], ranked[:, 2] * n + ranked[:, 3]
    order = np.lexsort((second, first))
    equal = (first[order[1:]] == first[order[:-1]]) & (second[order[1:]] == second[order[:-1]])
    if (equal[1:] & equal[:-1]).any():
        x, y, z = 1e3 * mesh.points[nodes[order[np.flatnonzero(equal)[0]], 0]]
        raise MeshError(f"three cells share one face near ({x:.2f}, {y:.2f}, {z:.2f}) mm: the cells overlap.")
    k = np.flatnonzero(equal)
    return np.column_stack([order[k], order[k + 1]])


def seam_faces(faces: CellFaces, lonely: NDArray[np.int64], mesh: SliceMesh | SweptCell) -> NDArray[np.int64]:
    """Pairs (p, 2) of rows of `faces`: a face of the bottom and the face of the top that lies on it when the cell is repeated.

    `lonely` are the rows without a partner inside the cell.
    """
    image = np.full(len(mesh.points) + 1, -2, dtype=np.int64)
    image[mesh.bottom] = mesh.top
    image[-1] = -1
    on_top = np.zeros(len(mesh.points) + 1, dtype=bool)
    on_top[mesh.top] = True
    on_top[-1] = True
    below = lonely[(image[faces.nodes[lonely]] != -2).all(axis=1)]
    above = lonely[on_top[faces.nodes[lonely]].all(axis=1)]
    pairs = same_faces(np.vstack([image[faces.nodes[below]], faces.nodes[above]]), mesh)
    return np.concatenate([below, above])[pairs]


def linked_corners(faces: CellFaces, pairs: NDArray[np.int64], images: NDArray[np.int64]) -> NDArray[np.int64]:
    """Corners (c, 2) that meet in the paired faces; `images` (n + 1,) names nodes that count as one by one number, -1 at the end."""
    sides = []
    for rows in pairs.T:
        order = np.argsort(images[faces.nodes[rows]], axis=1)
        sides.append(np.take_along_axis(faces.corners[rows], order, axis=1).ravel())
    links = np.column_stack(sides)
    return links[links[:, 0] >= 0]

"""A mesh parted along chosen interfaces: double nodes, on which bonded, sliding or frictional laws can be laid.

Around every node of a chosen interface the cells fall into groups that hang together through faces that are not chosen;
each group gets a node of its own. So an interface that ends inside the mesh stays closed at its rim, and three regions
that meet in a line get three nodes there if all their interfaces are chosen, but two if only two of them are. Cells that
meet in an edge or a corner only do not hang together.

The cell is periodic: a node of the bottom and its partner on the top are one node of the endless cable. The groups are
found in that endless cable, and copies of a bottom node and of its top node are partners if their group is the same, also
where a strand of the bottom goes on as another strand of the top.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from geometry.cell_face import WIDTH, CellFaces, cell_table, faces_at, linked_corners, same_faces, seam_faces
from geometry.cell_mesh import CellBlock, SliceMesh, SweptCell
from geometry.interface import Interface, face_areas, face_normals


@dataclass(frozen=True)
class FacePairs:
    """The two sides of an interface in a parted mesh.

    Attributes
    ----------
    interface : Interface
        As it was in the mesh before.
    side_a, side_b : (f, 4) or (f, 3)
        Node numbers of the faces on either side, node by node at the same place, both in the sense of a outwards. A node may be
        the same on both sides, at a rim where the interface ends inside the material.
    normals : (f, 3) unit vectors from a to b
    areas : (f,) [m^2]
    """

    interface: Interface
    side_a: NDArray[np.int64]
    side_b: NDArray[np.int64]
    normals: NDArray[np.float64]
    areas: NDArray[np.float64]


@dataclass(frozen=True)
class DoubledMesh:
    """A parted mesh: `mesh` of the kind that came in, `pairs` one for each chosen interface, and `original` (n,), for every
    node the number that it had before; the first of the old nodes keep their numbers, copies follow."""

    mesh: SliceMesh | SweptCell
    pairs: tuple[FacePairs, ...]
    original: NDArray[np.int64]


def double_nodes(mesh: SliceMesh | SweptCell, chosen: Sequence[Interface]) -> DoubledMesh:
    """Part a mesh along interfaces.

    Parameters
    ----------
    mesh : SliceMesh or SweptCell
    chosen : some of ``interfaces(mesh)``

    Returns
    -------
    DoubledMesh
        Same cells, same places; bottom and top still match node for node.

    Raises
    ------
    MeshError
        If three cells share one face.
    """
    table = cell_table(mesh)
    touched = np.zeros(len(mesh.points), dtype=bool)
    for interface in chosen:
        touched[interface.faces] = True
    on_seam = touched[mesh.bottom] | touched[mesh.top]
    touched[mesh.bottom[on_seam]] = touched[mesh.top[on_seam]] = True
    corners, group = _groups(mesh, table, touched, chosen)
    table, original, copies = _renumbered(table, corners, group, len(mesh.points))
    bottom, top = _partners(mesh, touched, copies)
    pairs = tuple(_pairs(mesh, interface, table) for interface in chosen)
    parted = _rebuilt(mesh, table, mesh.points[original], bottom, top)
    return DoubledMesh(parted, pairs, original)


def _groups(
    mesh: SliceMesh | SweptCell, table: NDArray[np.int64], touched: NDArray[np.bool_], chosen: Sequence[Interface]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Corners of cells at touched nodes, as places in ``table.ravel()``, and the group of each."""
    faces = faces_at(mesh, touched, whole=False)
    pairs = same_faces(faces.nodes, mesh)
    lonely = np.setdiff1d(np.arange(len(faces.nodes)), pairs)
    own = np.append(np.arange(len(mesh.points)), -1)
    endless = own.copy()
    endless[mesh.bottom] = mesh.top
    links = np.vstack(
        [
            linked_corners(faces, pairs[~_is_chosen(faces, pairs, chosen, len(table))], own),
            linked_corners(faces, seam_faces(faces, lonely, mesh), endless),
        ]
    )
    flat = table.ravel()
    corners = np.flatnonzero((flat >= 0) & touched[flat])
    place = np.full(len(flat), -1, dtype=np.int64)
    place[corners] = np.arange(len(corners))
    one, other = place[links[touched[flat[links[:, 0]]]]].T
    graph = coo_array((np.ones(len(one), dtype=bool), (one, other)), shape=(len(corners), len(corners)))
    return corners, connected_components(graph, directed=False)[1].astype(np.int64)


def _is_chosen(
    faces: CellFaces, pairs: NDArray[np.int64], chosen: Sequence[Interface], cells: int
) -> NDArray[np.bool_]:
    parted = [np.sort(interface.cells, axis=1) @ [cells, 1] for interface in chosen]
    return np.isin(np.sort(faces.cells[pairs], axis=1) @ [cells, 1], np.concatenate([np.zeros(0, int), *parted]))


def _renumbered(
    table: NDArray[np.int64], corners: NDArray[np.int64], group: NDArray[np.int64], nodes: int
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Cells with a node for every group; old number of every node; copies as rows (group, old node, new node).

    The group that comes first in the order of the cells keeps the old number.
    """
    flat = table.ravel().copy()
    keys, first, back = np.unique(group * nodes + flat[corners], return_index=True, return_inverse=True)
    old = keys % nodes
    order = np.lexsort((first, old))
    keeps = np.ones(len(keys), dtype=bool)
    keeps[order[1:]] = old[order[1:]] != old[order[:-1]]
    new = old.copy()
    fresh = order[~keeps[order]]
    new[fresh] = nodes + np.arange(len(fresh))
    flat[corners] = new[back]
    original = np.concatenate([np.arange(nodes), old[fresh]])
    return flat.reshape(-1, WIDTH), original, np.column_stack([keys // nodes, old, new])


def _partners(
    mesh: SliceMesh | SweptCell, touched: NDArray[np.bool_], copies: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Bottom and top nodes: the old pairs that were not touched, then the copies whose group is the same."""
    free = ~touched[mesh.bottom]
    group, old, new = copies.T
    sides = []
    for face in (mesh.bottom, mesh.top):
        node_of = np.full(int(group.max(initial=-1)) + 1, -1, dtype=np.int64)
        here = np.isin(old, face)
        node_of[group[here]] = new[here]
        sides.append(node_of)
    both = (sides[0] >= 0) & (sides[1] >= 0)
    return np.concatenate([mesh.bottom[free], sides[0][both]]), np.concatenate([mesh.top[free], sides[1][both]])


def _pairs(mesh: SliceMesh | SweptCell, interface: Interface, table: NDArray[np.int64]) -> FacePairs:
    before = cell_table(mesh)
    sides = []
    for cell in interface.cells.T:
        where = (before[cell][:, None, :] == interface.faces[:, :, None]).argmax(axis=2)
        sides.append(np.take_along_axis(table[cell], where, axis=1))
    normals, areas = face_normals(mesh.points, interface.faces), face_areas(mesh.points, interface.faces)
    return FacePairs(interface, sides[0], sides[1], normals, areas)


def _rebuilt(
    mesh: SliceMesh | SweptCell,
    table: NDArray[np.int64],
    points: NDArray[np.float64],
    bottom: NDArray[np.int64],
    top: NDArray[np.int64],
) -> SliceMesh | SweptCell:
    if isinstance(mesh, SliceMesh):
        return replace(mesh, points=points, cells=table[:, : mesh.cells.shape[1]], bottom=bottom, top=top)
    blocks, start = [], 0
    for block in mesh.blocks:
        m, width = block.cells.shape
        blocks.append(CellBlock(block.kind, table[start : start + m, :width], block.region_of))
        start += m
    return replace(mesh, points=points, blocks=tuple(blocks), bottom=bottom, top=top)

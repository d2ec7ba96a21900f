r"""Linear bricks whose volume change is constant in the element (B-bar), free of volumetric locking.

.. math::  K_e = \int 2 G\, \varepsilon : \varepsilon \, dV + \frac{\lambda}{V} b\, b^T, \qquad b = \int \mathrm{div} N \, dV .

Nagtegaal, Parks, Rice, Comput. Methods Appl. Mech. Eng. 4 (1974) 153-177, doi 10.1016/0045-7825(74)90032-2;
Hughes, Int. J. Numer. Methods Eng. 15 (1980) 1413-1418, doi 10.1002/nme.1620150914.

Every cell is a brick with eight corners, some of which may coincide: a wedge on two edges, a pyramid on a face, a tetrahedron
on a face and an edge. The shape functions of coinciding corners add up when the element matrices are assembled, so that one code
serves all. A tetrahedron so becomes the element of constant strain, which locks when its material is nearly incompressible; in the
meshes of the geometry package tetrahedra, with pyramids, stand in the slip rings only.

The element matrices come from products of shape function gradients, one batched matrix product for many elements; no strain
matrix is formed. Letters: e element, q quadrature point, a b corner of the element, x y direction.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geometry.cell_mesh import SliceMesh, SweptCell
from geometry.errors import MeshError
from geometry.reference_gradients import reference_gradients

FloatArray = NDArray[np.float64]

CHUNK = 500
"""Elements whose matrices (4.6 kB each) are made at a time, so that they stay in the cache."""
GATHERED = 16
"""Chunks added to the global matrix at a time."""

CORNERS = {
    "hexahedron": [0, 1, 2, 3, 4, 5, 6, 7],
    "wedge": [0, 1, 2, 2, 3, 4, 5, 5],
    "pyramid": [0, 1, 2, 3, 4, 4, 4, 4],
    "tetra": [0, 1, 2, 2, 3, 3, 3, 3],
}
"""The node of the cell on each corner of the brick."""


@dataclass(frozen=True)
class Bricks:
    """All cells of a mesh as bricks: `corners` (e, 8) node numbers, `region_of` (e,)."""

    corners: NDArray[np.int64]
    region_of: NDArray[np.int64]


def bricks(mesh: SliceMesh | SweptCell) -> Bricks:
    """The cells of all blocks in the order of their highest node, so that neighbours in the list share rows of the matrix.

    Raises
    ------
    MeshError
        If the mesh has cells of another kind, for instance of second order.
    """
    for block in mesh.blocks:
        if block.kind not in CORNERS:
            raise MeshError(f'no field is known for "{block.kind}" cells; use one of {", ".join(CORNERS)}.')
    corners = np.concatenate([block.cells[:, CORNERS[block.kind]] for block in mesh.blocks])
    region_of = np.concatenate([block.region_of for block in mesh.blocks])
    order = np.argsort(corners.max(axis=1), kind="stable")
    return Bricks(corners[order], region_of[order])


def stiffness_matrix(mesh: SliceMesh | SweptCell, lame: FloatArray | None = None) -> sp.bsr_array:
    """Stiffness of the mesh without constraints, (3n, 3n) in 3x3 blocks [N/m].

    Parameters
    ----------
    mesh : SliceMesh or SweptCell
    lame : (regions,), optional
        lambda of every region [Pa], for what is nearly incompressible a smaller one; that of the materials if not given.

    Raises
    ------
    MeshError
        If an element is turned inside out; the message names its region and place.
    """
    cells = bricks(mesh)
    n = len(mesh.points)
    indptr, columns, slot = _block_pattern(cells.corners, n)
    data = np.zeros((len(columns), 9))
    matrices = _element_matrices(mesh, cells, lame)
    while batch := list(islice(matrices, GATHERED)):
        where = slot[batch[0][0].start : batch[-1][0].stop].ravel()
        blocks = np.concatenate([b for _, b in batch])
        low, high = int(where.min()), int(where.max()) + 1
        sort = (np.ones(len(where)), where - low, np.arange(len(where) + 1))
        data[low:high] += sp.csc_array(sort, shape=(high - low, len(where))) @ blocks.reshape(-1, 9)
    return sp.bsr_array((data.reshape(-1, 3, 3), columns, indptr), shape=(3 * n, 3 * n))


def element_energies(mesh: SliceMesh | SweptCell, fields: NDArray, lame: FloatArray | None = None) -> NDArray:
    """Energy products u_i^H K_e u_j of every element, shape (e, m, m), of displacement fields (m, 3n); `lame` as for the matrix."""
    cells = bricks(mesh)
    U = np.asarray(fields).reshape(len(fields), -1, 3)
    found = np.empty((len(cells.corners), len(U), len(U)), dtype=U.dtype)
    for part, blocks in _element_matrices(mesh, cells, lame):
        K = blocks.transpose(0, 1, 3, 2, 4).reshape(-1, 24, 24)
        local = U[:, cells.corners[part]].transpose(1, 0, 2, 3).reshape(-1, len(U), 24)
        found[part] = local.conj() @ K @ local.transpose(0, 2, 1)
    return found


def region_volumes(mesh: SliceMesh | SweptCell) -> FloatArray:
    """Volume of each region [m^3], shape (regions,)."""
    cells = bricks(mesh)
    volume = np.concatenate([weight.sum(axis=1) for _, _, weight in _gradients(mesh, cells)])
    return np.asarray(np.bincount(cells.region_of, volume, len(mesh.regions)), dtype=float)


def dilatations(mesh: SliceMesh | SweptCell) -> tuple[FloatArray, FloatArray]:
    """Volume change of every element per displacement of its corners, int grad N dV (e, 8, 3) [m^2], and its volume (e,) [m^3]."""
    found = [
        (np.einsum("eq,eqax->eax", weight, gradient, optimize=True), weight.sum(axis=1))
        for _, gradient, weight in _gradients(mesh, bricks(mesh))
    ]
    return np.concatenate([b for b, _ in found]), np.concatenate([v for _, v in found])


def _block_pattern(
    corners: NDArray[np.int64], nodes: int
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]:
    """Row pointer and columns of the pairs of nodes, and the slot (e, a, b) of every pair of corners among them."""
    flat = corners.ravel()
    by_node = np.argsort(flat, kind="stable")
    pairs = 8 * len(flat)
    # one row per node: the corners of all its elements, each with the number of its pair (8 (8 e + a) + b)
    number = (8 * by_node[:, None] + np.arange(8)).astype(np.int64 if pairs > 2**31 - 1 else np.int32)
    start = 8 * np.concatenate([[0], np.cumsum(np.bincount(flat, minlength=nodes))])
    table = sp.csr_array((number.ravel(), corners[by_node // 8].astype(np.int32).ravel(), start), shape=(nodes, nodes))
    table.sort_indices()
    new = np.empty(pairs, dtype=bool)
    new[1:] = table.indices[1:] != table.indices[:-1]
    new[table.indptr[:-1][np.diff(table.indptr) > 0]] = True
    slot = np.empty(pairs, dtype=np.int32)
    slot[np.asarray(table.data, dtype=np.int64)] = np.cumsum(new, dtype=np.int32) - 1
    indptr = np.concatenate([[0], np.cumsum(new)])[table.indptr].astype(np.int32)
    return indptr, table.indices[new].astype(np.int32), slot.reshape(-1, 8, 8)


def _gradients(mesh: SliceMesh | SweptCell, cells: Bricks) -> Iterator[tuple[slice, FloatArray, FloatArray]]:
    """Chunks of elements with gradients (e, q, a, x) [1/m] and weights (e, q) [m^3] at the Gauss points."""
    reference, weights = reference_gradients("hexahedron")
    local = np.array(reference)  # (q, a, r)
    across = local.transpose(0, 2, 1).reshape(-1, 8)  # (q r, a)
    for start in range(0, len(cells.corners), CHUNK):
        part = slice(start, start + CHUNK)
        jacobian = (across @ mesh.points[cells.corners[part]]).reshape(-1, len(local), 3, 3)  # dx / dr, (e, q, r, x)
        cofactor = np.stack(
            [
                np.cross(jacobian[:, :, 1], jacobian[:, :, 2]),
                np.cross(jacobian[:, :, 2], jacobian[:, :, 0]),
                np.cross(jacobian[:, :, 0], jacobian[:, :, 1]),
            ],
            axis=2,
        )
        determinant = (jacobian[:, :, 0] * cofactor[:, :, 0]).sum(axis=-1)
        _check_orientation(mesh, cells, start, determinant)
        gradient = np.matmul(local, cofactor / determinant[:, :, None, None])
        yield part, gradient, np.abs(determinant) * weights


def _check_orientation(mesh: SliceMesh | SweptCell, cells: Bricks, start: int, determinant: FloatArray) -> None:
    folded = determinant.min(axis=1) * determinant.max(axis=1) <= 0
    if folded.any():
        e = start + int(np.argmax(folded))
        x = ", ".join(f"{1e3 * c:.2f}" for c in mesh.points[cells.corners[e]].mean(axis=0))
        raise MeshError(
            f"an element of {mesh.regions[cells.region_of[e]].name} near ({x}) mm is turned inside out; "
            "ask for smaller elements or thinner layers."
        )


def _element_matrices(
    mesh: SliceMesh | SweptCell, cells: Bricks, lame: FloatArray | None
) -> Iterator[tuple[slice, FloatArray]]:
    """Chunks of elements with their matrices (e, a, b, x, y)."""
    G = np.array([r.material.G for r in mesh.regions])
    if lame is None:
        lame = np.array([r.material.lame for r in mesh.regions])
    for part, gradient, weight in _gradients(mesh, cells):
        region = cells.region_of[part]
        yield part, _blocks(gradient, weight, G[region], lame[region])


def _blocks(gradient: FloatArray, weight: FloatArray, G: FloatArray, lame: FloatArray) -> FloatArray:
    e, q, k, _ = gradient.shape
    flat = gradient.reshape(e, q, 3 * k)
    O = np.matmul((flat * (weight * G[:, None])[:, :, None]).transpose(0, 2, 1), flat).reshape(e, k, 3, k, 3)
    blocks = O.transpose(0, 1, 3, 4, 2).copy()  # (a x)(b y) takes the product (a y)(b x)
    trace = np.einsum("eaxbx->eab", O)
    for x in range(3):
        blocks[:, :, :, x, x] += trace
    b = np.matmul(weight[:, None, :], flat).reshape(e, k, 3)
    dilatation = b * (lame / weight.sum(axis=1))[:, None, None]
    blocks += dilatation[:, :, None, :, None] * b[:, None, :, None, :]
    return blocks

r"""Linear bricks and wedges whose volume change is constant in the element (B-bar), free of volumetric locking.

.. math::  K_e = \int 2 G\, \varepsilon : \varepsilon \, dV + \frac{\lambda}{V} b\, b^T, \qquad b = \int \mathrm{div} N \, dV .

Nagtegaal, Parks, Rice, Comput. Methods Appl. Mech. Eng. 4 (1974) 153-177, doi 10.1016/0045-7825(74)90032-2;
Hughes, Int. J. Numer. Methods Eng. 15 (1980) 1413-1418, doi 10.1002/nme.1620150914.

The element matrices come from products of shape function gradients, one batched matrix product for many elements; no strain
matrix is formed. Letters: e element, q quadrature point, a b node of the element, x y direction.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geometry.cell_mesh import SliceMesh
from homogenize.element_basis import element_basis

CHUNK = 20_000
"""Elements assembled at a time; keeps the element matrices (4.6 kB each) in cache and memory low."""


def stiffness_matrix(mesh: SliceMesh) -> sp.bsr_array:
    """Stiffness of the slice without constraints, (3n, 3n) in 3x3 blocks [N/m].

    Raises
    ------
    MeshError
        If an element is turned inside out; the message names its region and place.
    """
    cells, gradient, weight = _basis(mesh)
    G = np.array([r.material.G for r in mesh.regions])[mesh.region_of]
    lame = np.array([r.material.lame for r in mesh.regions])[mesh.region_of]
    n = len(mesh.points)
    k = cells.shape[1]
    pair = (cells[:, :, None] * n + cells[:, None, :]).ravel()
    keys, inverse = np.unique(pair, return_inverse=True)
    data = np.zeros((len(keys), 3, 3))
    for start in range(0, len(cells), CHUNK):
        part = slice(start, start + CHUNK)
        blocks = _element_blocks(gradient[part], weight[part], G[part], lame[part])
        where = inverse[start * k * k : (start + len(blocks)) * k * k]
        for x in range(3):
            for y in range(3):
                data[:, x, y] += np.bincount(where, blocks[:, :, :, x, y].ravel(), len(keys))
    rows, columns = keys // n, keys % n
    indptr = np.concatenate([[0], np.cumsum(np.bincount(rows, minlength=n))])
    return sp.bsr_array((data, columns, indptr), shape=(3 * n, 3 * n))


def region_volumes(mesh: SliceMesh) -> NDArray[np.float64]:
    """Volume of each region [m^3], shape (regions,)."""
    _, _, weight = _basis(mesh)
    return np.asarray(np.bincount(mesh.region_of, weight.sum(axis=1), len(mesh.regions)), dtype=float)


def _basis(mesh: SliceMesh) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """Nodes (e, a), gradients (e, q, a, x) [1/m] and weights (e, q) [m^3] at the quadrature points."""
    basis = element_basis(
        mesh.points, mesh.cells, mesh.cell_kind, lambda e: f"an element of {mesh.regions[mesh.region_of[e]].name}"
    )
    gradient = np.ascontiguousarray(basis.gradient.transpose(2, 3, 1, 0))
    return np.ascontiguousarray(basis.cells.T), gradient, basis.weight


def _element_blocks(
    gradient: NDArray[np.float64], weight: NDArray[np.float64], G: NDArray[np.float64], lame: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Element matrices (e, a, b, x, y)."""
    e, q, k, _ = gradient.shape
    flat = gradient.reshape(e, q, 3 * k)
    O = np.matmul((flat * (weight * G[:, None])[:, :, None]).transpose(0, 2, 1), flat).reshape(e, k, 3, k, 3)
    blocks = O.transpose(0, 1, 3, 4, 2).copy()  # (a x)(b y) takes the product (a y)(b x)
    trace = np.einsum("eaxbx->eab", O)
    for x in range(3):
        blocks[:, :, :, x, x] += trace
    b = np.einsum("eq,eqax->eax", weight, gradient)
    dilatation = b * (lame / weight.sum(axis=1))[:, None, None]
    blocks += dilatation[:, :, None, :, None] * b[:, None, :, None, :]
    return blocks

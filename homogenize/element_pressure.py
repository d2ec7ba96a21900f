r"""Pressures of nearly incompressible elements as unknowns of their own: the solver does not feel how near they are.

Where lambda is large against G, all of it but G becomes a pressure p, constant in the element:

.. math::  A = \int 2 G\, \varepsilon : \varepsilon + \frac{\min(\lambda, G)}{V} b\, b^T , \qquad B u - C p = 0 ,

.. math::  p^T C p = \sum_e \frac{V}{\lambda - G} p_e^2
   + \frac{\beta}{2} \sum_{faces} \Big( \frac{V_i}{G_i} + \frac{V_j}{G_j} \Big) (p_i - p_j)^2 .

Eliminating p without the sum over faces gives the brick of :mod:`homogenize.mean_dilatation` back. The sum over the faces
between elements of one region holds the chequerboards that this brick hardly resists (Silvester, Kechkar, Comput. Methods Appl.
Mech. Eng. 79 (1990) 71-86, doi 10.1016/0045-7825(90)90095-4); it vanishes with the mesh size and leaves constant pressures
exact. No face across the seam of the cell is joined, so that pressures belong to one cell.

The energy of a displacement and its pressures is the value of the Lagrangian u^H A u + 2 Re p^H B u - p^H C p, stationary in both.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geometry.cell_mesh import SliceMesh, SweptCell
from homogenize.block_sweep import Blocks, blocks
from homogenize.mean_dilatation import bricks, dilatations

LAME_LIMIT = 1.0
"""lambda / G that stays in A of the elements that have a pressure."""
COMPRESSIBLE = 9.5
"""lambda / G up to which an element needs no pressure: Poisson's ratio 0.452."""
JUMPS = 0.05
"""beta: 13 iterations at Poisson's ratio 0.4999 against 61 without, 0.25 needs as many (benchmarks/cell_3d.md)."""

FACES = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))


@dataclass(frozen=True)
class ElementPressure:
    """The pressures of a mesh.

    Attributes
    ----------
    elements : (k,) numbers, in the order of :func:`homogenize.mean_dilatation.bricks`, of the elements with a pressure
    B, transposed : volume change (k, 3n) of a displacement, and forces (3n, k) of pressures
    C : (k, k) volume change per pressure [m^3/Pa]
    schur : (k,) diagonal close to C + B A^-1 B^T
    """

    elements: NDArray[np.int64]
    B: Blocks
    transposed: Blocks
    C: Blocks
    schur: NDArray[np.float64]
    compliance: NDArray[np.float64]
    joined: NDArray[np.int64]
    weight: NDArray[np.float64]

    def energies(self, u: NDArray, p: NDArray) -> NDArray:
        """What the pressures add to the energy products of each of their elements, (k, m, m), fields (m, 3n) and (m, k)."""
        m = len(u)
        change = np.array([self.B.product(x.reshape(-1, 3)).ravel() for x in u])
        cross = p.conj().T[:, :, None] * change.T[:, None, :]
        found = cross + cross.conj().transpose(0, 2, 1)
        found -= self.compliance[:, None, None] * p.conj().T[:, :, None] * p.T[:, None, :]
        i, j = self.joined
        jump = (p[:, i] - p[:, j]).T
        half = 0.5 * self.weight[:, None, None] * jump.conj()[:, :, None] * jump[:, None, :]
        for a in range(m):
            for b in range(m):
                for side in (i, j):
                    real = np.bincount(side, half[:, a, b].real, len(found))
                    found[:, a, b] -= real
                    if np.iscomplexobj(found):
                        found[:, a, b] -= 1j * np.bincount(side, half[:, a, b].imag, len(found))
        return found


def element_pressure(mesh: SliceMesh | SweptCell) -> ElementPressure | None:
    """The pressures of all regions whose Poisson's ratio is above 0.452; None if there are none."""
    cells = bricks(mesh)
    G = np.array([r.material.G for r in mesh.regions])
    lame = np.array([r.material.lame for r in mesh.regions])
    soft = lame > COMPRESSIBLE * G
    elements = np.flatnonzero(soft[cells.region_of])
    if not len(elements):
        return None
    region = cells.region_of[elements]
    b, volume = dilatations(mesh)
    b, volume, G, lame = b[elements], volume[elements], G[region], lame[region]
    n, k = len(mesh.points), len(elements)
    corners = cells.corners[elements]
    indptr = np.arange(0, 8 * k + 1, 8, dtype=np.int32)
    B = sp.bsr_matrix((b.reshape(-1, 1, 3), corners.ravel().astype(np.int32), indptr), shape=(k, 3 * n))
    B.sum_duplicates()
    compliance = volume / (lame - LAME_LIMIT * G)
    joined = np.array(_inner_faces(corners, region))
    weight = JUMPS * 0.5 * ((volume / G)[joined[0]] + (volume / G)[joined[1]])
    i, j = joined
    own = np.arange(k)
    rows, columns = np.concatenate([own, i, j, i, j]), np.concatenate([own, i, j, j, i])
    entries = np.concatenate([compliance, weight, weight, -weight, -weight])
    C = sp.coo_matrix((entries, (rows, columns)), shape=(k, k)).tocsr()
    schur = volume / ((2.0 + LAME_LIMIT) * G) + C.diagonal()
    return ElementPressure(
        elements,
        blocks(B),
        blocks(B.T.tobsr()),
        blocks(sp.bsr_matrix(C, blocksize=(1, 1))),
        schur,
        compliance,
        joined,
        weight,
    )


def limited_lame(mesh: SliceMesh | SweptCell) -> NDArray[np.float64]:
    """lambda of every region that stays in A [Pa]."""
    G = np.array([r.material.G for r in mesh.regions])
    lame = np.array([r.material.lame for r in mesh.regions])
    return np.where(lame > COMPRESSIBLE * G, LAME_LIMIT * G, lame)


def _inner_faces(corners: NDArray[np.int64], region: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs of elements of one region that share a face of three or four different corners."""
    faces = np.sort(corners[:, FACES].reshape(-1, 4), axis=1)
    element = np.repeat(np.arange(len(corners)), len(FACES))
    repeated = faces[:, 1:] == faces[:, :-1]
    area = repeated.sum(axis=1) < 2
    faces, element, repeated = faces[area], element[area], repeated[area]
    faces[:, 1:][repeated] = -1  # a triangle is the same whichever of its corners is double
    faces.sort(axis=1)
    order = np.lexsort(faces.T)
    faces, element = faces[order], element[order]
    same = (faces[1:] == faces[:-1]).all(axis=1)
    i, j = element[:-1][same], element[1:][same]
    keep = (i != j) & (region[i] == region[j])
    return i[keep], j[keep]

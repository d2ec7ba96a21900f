r"""Motions of a specimen as a bundle of rods: the coarse space of the solver.

A slender stiff part in soft rubber bends and twists at almost no energy, by a cancellation between B_s u and B_z u' that no
preconditioner of separate stations sees. So at every station the six rigid motions of the section and of each stiff part are taken
together, the latter continued into the rubber at least energy:

.. math::  (E_2 + \mu E_0)\, w = (E_2 + \mu E_0)_{\mathrm{part}}\, z

with z the rigid motion of the part. With W their orthonormal basis the coarse problem is the Kronecker sum of
:math:`W^T E_i W`, block-banded and small; it is solved directly.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from homogenize.free_motion import body_of_nodes
from homogenize.section_field import FloatArray
from homogenize.section_system import SectionSystem
from homogenize.specimen.end_condition import EndMap
from homogenize.specimen.swept_operator import SweptOperator

SYMMETRIC: dict = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
"""How SuperLU factors a symmetric positive definite matrix."""
STIFF = 20.0
"""A part is a rod if its modulus is this much above that of the softest part, and not as much below that of the stiffest."""
MOST_RODS = 40
"""With more stiff parts than this the section moves as one rod only, so that the coarse problem stays small."""
_DEPENDENT = 1e-6


def rod_basis(system: SectionSystem, mesh: CrossSectionMesh, wavelength: float) -> FloatArray:
    """W, (unknowns, motions) orthonormal; `wavelength` [m] sets mu = (2 pi / wavelength)^2."""
    field, p, mu = system.field, system.pencil, (2 * np.pi / wavelength) ** 2
    columns = [p.Z]
    rods = _rods(system, mesh)
    if 0 < len(rods) <= MOST_RODS:
        factor = spla.splu(sp.csc_matrix(p.E2 + mu * p.E0), **SYMMETRIC)
        Z = field.rigid_motion()
        for elements in rods:
            part = replace(
                field, elasticity=np.where(elements[:, None, None], field.elasticity, 0.0), turning_elasticity=None
            )
            E0, _, E2 = part.matrices()
            nodes = np.unique(field.cells[:, elements])
            x, y = field.nodes[:, nodes].mean(axis=1)
            own = Z.copy()  # turns about the part's own centre
            own[:, 3] -= y * Z[:, 2]
            own[:, 4] += x * Z[:, 2]
            own[:, 5] += y * Z[:, 0] - x * Z[:, 1]
            load = E2 @ own + mu * (E0 @ own)
            columns.append(factor.solve(np.ascontiguousarray(load if system.T is None else system.T.T @ load)))
    W = np.concatenate(columns, axis=1)
    W = W / np.linalg.norm(W, axis=0)
    u, s, _ = np.linalg.svd(W, full_matrices=False)
    return u[:, s > _DEPENDENT * s[0]]


def _rods(system: SectionSystem, mesh: CrossSectionMesh) -> list[NDArray[np.bool_]]:
    """Elements of every connected stiff body."""
    field = system.field
    modulus = field.elasticity[:, 3, 3]
    stiff = (modulus > STIFF * modulus.min()) & (modulus > modulus.max() / STIFF)
    if not stiff.any() or stiff.all():
        return []
    body = body_of_nodes(field.cells[:, stiff], field.nodes.shape[1])[field.cells[0]]
    return [stiff & (body == b) for b in np.unique(body[stiff])]


class RodMotions:
    """The coarse problem: W x at the free stations, and the motions of a rigid plate at its own."""

    def __init__(self, operator: SweptOperator, W: FloatArray, ends: tuple[EndMap, EndMap]) -> None:
        self.operator = operator
        self.W = np.concatenate([W, ends[0].rigid, ends[1].rigid], axis=1)
        n, m = operator.shape
        free = np.zeros((m, self.W.shape[1]), dtype=bool)
        free[1:-1, : W.shape[1]] = True
        start = W.shape[1]
        for k, end in zip((0, -1), ends):
            free[k, : W.shape[1]] = end.free == n and not end.rigid.shape[1]
            free[k, start : start + end.rigid.shape[1]] = True
            start += end.rigid.shape[1]
        self.free = free
        p = operator.pencil
        self._images = [np.asarray(E @ self.W) for E in (p.E2, p.E1, p.E1.T, p.E0)]
        g2, g1, _, g0 = (self.W.T @ image for image in self._images)
        M, C, S = operator.axial.matrices
        picked = np.flatnonzero(free.ravel())
        K = sum(sp.kron(sp.csr_array(a), g) for a, g in ((M, g2), (C, g1), (C.T, g1.T), (S, g0)))
        K = sp.csr_array(K)[picked][:, picked]
        self._scale = 1 / np.sqrt(K.diagonal())
        D = sp.diags_array(self._scale)
        self._factor = spla.splu(sp.csc_matrix(D @ K @ D), **SYMMETRIC)
        self._picked = picked

    def solve(self, R: FloatArray) -> FloatArray:
        """Amplitudes (stations, motions, loads) that balance R (n, m, loads) within the coarse space."""
        _, m, loads = R.shape
        r = np.einsum("nmk,nq->mqk", R, self.W, optimize=True).reshape(-1, loads)[self._picked]
        x = np.zeros((m * self.W.shape[1], loads))
        x[self._picked] = self._scale[:, None] * self._factor.solve(self._scale[:, None] * r)
        return x.reshape(m, -1, loads)

    def displacement(self, x: FloatArray) -> FloatArray:
        """W x, shape (n, m, loads)."""
        return np.einsum("nq,mqk->nmk", self.W, x, optimize=True)

    def forces(self, x: FloatArray) -> FloatArray:
        """K W x, shape (n, m, loads), without the whole matrix."""
        M, C, S = self.operator.axial.matrices
        parts = [np.einsum("kl,lqj->kqj", a, x) for a in (M, C, C.T, S)]
        return np.einsum(
            "nq,mqk->nmk", np.concatenate(self._images, axis=1), np.concatenate(parts, axis=1), optimize=True
        )

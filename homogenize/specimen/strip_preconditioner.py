r"""An approximate inverse of the specimen's stiffness: fast diagonalisation along its length, then the rods.

Without the coupling terms the Kronecker sum is diagonal in the eigenvectors of :math:`S v = \mu M v`,

.. math::  (M \otimes E_2 + S \otimes E_0)^{-1} = \sum_j v_j v_j^T \otimes (E_2 + \mu_j E_0)^{-1} ,

one sparse factor of the cross-section for each strip mode (Lynch, Rice, Thomas, Numer. Math. 6 (1964) 185-199). Its spectral distance
from K does not depend on the layers. What it misses, the bending of slender stiff parts, is in :mod:`homogenize.specimen.rod_motions`,
taken off by a balancing step (Tang, Nabben, Vuik, Erlangga, J. Sci. Comput. 39 (2009) 340-370): the residual stays free of coarse parts.
Modes whose mu differ by less than `_SHARED` use one factor.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from numpy.typing import NDArray

from geometry.errors import ConvergenceError
from homogenize.section_field import FloatArray
from homogenize.specimen.end_condition import EndMap
from homogenize.specimen.rod_motions import SYMMETRIC
from homogenize.specimen.swept_operator import SweptOperator

_SHARED = 1.25


class StripPreconditioner:
    """Sum over strip modes; stations whose unknowns are all fixed or in a rigid plate take no part."""

    def __init__(self, operator: SweptOperator, ends: tuple[EndMap, EndMap]) -> None:
        m = operator.shape[1]
        self.ends = ends
        self.inside = slice(1 if ends[0].closed else 0, m - 1 if ends[1].closed else m)
        M, _, S = (a[self.inside, self.inside] for a in operator.axial.matrices)
        mu, self.modes = scipy.linalg.eigh(S, M)
        lowest = (np.pi / (2 * operator.axial.levels[-1])) ** 2
        mu = np.maximum(mu, lowest)
        self.groups: list[tuple[NDArray[np.int64], spla.SuperLU]] = []
        first = 0
        for j in range(1, len(mu) + 1):
            if j == len(mu) or mu[j] > _SHARED * mu[first]:
                shared = float(np.sqrt(mu[first] * mu[j - 1]))
                self.groups.append((np.arange(first, j), self._factor(operator, shared)))
                first = j

    @staticmethod
    def _factor(operator: SweptOperator, mu: float) -> spla.SuperLU:
        p = operator.pencil
        try:
            return spla.splu(sp.csc_matrix(p.E2 + mu * p.E0), **SYMMETRIC)
        except RuntimeError:
            raise ConvergenceError(
                "the stiffness of the specimen's section is singular: some part is not connected to the rest; "
                "check that every region shares nodes with a neighbour."
            ) from None

    def apply(self, R: FloatArray) -> FloatArray:
        """Approximate displacement (n, m, loads) of forces R; admissible at both ends."""
        n, _, loads = R.shape
        R = self._admissible(R)
        r = np.einsum("nmk,mj->jnk", R[:, self.inside], self.modes, optimize=True)
        x = np.empty_like(r)
        for group, factor in self.groups:
            b = np.ascontiguousarray(r[group].transpose(1, 0, 2).reshape(n, -1))
            x[group] = factor.solve(b).reshape(n, len(group), loads).transpose(1, 0, 2)
        U = np.zeros_like(R)
        U[:, self.inside] = np.einsum("jnk,mj->nmk", x, self.modes, optimize=True)
        return self._admissible(U)

    def _admissible(self, R: FloatArray) -> FloatArray:
        """R with the end stations that take part projected on what may move there."""
        out = R
        for k, end in zip((0, -1), self.ends):
            if not end.closed and end.free < R.shape[0]:
                out = out.copy() if out is R else out
                out[:, k] = end.project(R[:, k])
        return out

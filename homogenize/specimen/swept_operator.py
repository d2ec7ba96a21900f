r"""The stiffness of a finite helical specimen as a Kronecker sum over its cross-section and its length.

In the frame that turns with the cable the strain is :math:`B_s u + B_z u'` with operators that do not depend on z
(:mod:`homogenize.section_field`). With u = sum_k u_k(X, Y) N_k(z) and the axial matrices M, C, S

.. math::  K = M \otimes E_2 + C \otimes E_1 + C^T \otimes E_1^T + S \otimes E_0 .

This is the swept quadratic wedge with the helix exact. Nothing is assembled in three dimensions: displacements are arrays
(section unknowns, stations, loads), and K acts by products with the section matrices and with the small axial ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from homogenize.section_problem import SectionPencil
from homogenize.specimen.axial_basis import AxialBasis

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class SweptOperator:
    """K of a specimen with free ends."""

    pencil: SectionPencil
    axial: AxialBasis

    @cached_property
    def _stacked(self) -> sp.csr_array:
        p = self.pencil
        return sp.csr_array(sp.hstack([p.E2, p.E1, p.E1.T, p.E0]))

    @property
    def shape(self) -> tuple[int, int]:
        """Section unknowns and stations."""
        return len(self.pencil.Z), len(self.axial.stations)

    def apply(self, U: FloatArray, at: NDArray[np.int64] | None = None) -> FloatArray:
        """K U, shape (n, m, loads), of displacements U (n, m, loads); with `at` (s,) the rows of those stations only, (n, s, loads)."""
        n, _, loads = U.shape
        M, C, S = self.axial.matrices
        rows = slice(None) if at is None else at
        near = [A[rows] for A in (M, C, C.T, S)]
        parts = np.concatenate([np.matmul(A, U) for A in near])  # (4 n, s, loads)
        count = parts.shape[1]
        return (self._stacked @ parts.reshape(4 * n, count * loads)).reshape(n, count, loads)

    def diagonal_block(self, k: int) -> sp.csr_array:
        """K between a station and itself, (n, n)."""
        M, C, S = (float(A[k, k]) for A in self.axial.matrices)
        p = self.pencil
        return sp.csr_array(M * p.E2 + C * (p.E1 + p.E1.T) + S * p.E0)

    def energy(self, U: FloatArray) -> FloatArray:
        """U^T K U / 2 for each load, (loads,) [J]."""
        return 0.5 * np.einsum("nmk,nmk->k", U, self.apply(U))

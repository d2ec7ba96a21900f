r"""Conjugate gradients preconditioned by smoothed aggregation, for elastic solids in 3x3 blocks, real or complex Hermitian.

The hierarchy is built by pyamg, which is imported here only, from the six rigid-body modes
(Vanek, Mandel, Brezina, Computing 56 (1996) 179-196, doi 10.1007/BF02238511). Settings were chosen by measurement, benchmarks/cell_3d.md.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

STRENGTH_THRESHOLD = 0.1
"""Of smoothed aggregation: at a contrast of 20 000 it needs a fraction of the iterations of 0 (benchmarks/cell.py)."""

SMOOTHER = ("block_gauss_seidel", {"sweep": "symmetric"})
COARSEST = 300
"""Unknowns that are solved directly."""


@dataclass(frozen=True)
class Solution:
    """What conjugate gradients found: the unknowns, the iterations and the relative residual at the end."""

    unknowns: NDArray
    iterations: int
    residual: float


class Multigrid:
    """A matrix with its hierarchy; `complexity` is the number of entries of all levels over those of the first.

    Parameters
    ----------
    matrix : real symmetric or complex Hermitian, 3x3 blocks, positive semi-definite
    points : (n, 3) places of the nodes [m]
    model : matrix from which the hierarchy is made instead, same shape; for a preconditioner of softer material
    """

    def __init__(self, matrix: sp.bsr_array, points: NDArray[np.float64], model: sp.bsr_array | None = None) -> None:
        import pyamg

        self.matrix = _with_short_indices(matrix)
        self.hierarchy: Any = pyamg.smoothed_aggregation_solver(
            self.matrix if model is None else _with_short_indices(model),
            B=rigid_modes(points).astype(matrix.dtype),
            symmetry="hermitian",
            strength=("symmetric", {"theta": STRENGTH_THRESHOLD}),  # pyright: ignore[reportArgumentType]
            smooth=("jacobi", {"omega": 4.0 / 3.0, "weighting": "block"}),
            presmoother=SMOOTHER,
            postsmoother=SMOOTHER,
            max_coarse=COARSEST,
            coarse_solver="pinv",
        )
        self.complexity = float(self.hierarchy.operator_complexity())
        self.precondition = self.hierarchy.aspreconditioner(cycle="V")

    def solve(
        self,
        rhs: NDArray,
        tolerance: float,
        max_iterations: int,
        watch: Callable[[int, float], None] | None = None,
    ) -> Solution:
        """Conjugate gradients from zero until the residual is below tolerance times the load; `watch` hears every iteration."""
        size = float(np.linalg.norm(rhs))
        x, r = np.zeros_like(rhs), rhs.copy()
        p, rho, count, residual = np.zeros_like(rhs), 1.0, 0, 1.0
        while size > 0 and residual > tolerance and count < max_iterations:
            z = self.precondition @ r
            rho, last = float(np.vdot(r, z).real), rho
            if not rho > 0:  # an indefinite preconditioner or not-a-number: the caller reports how far it came
                break
            p = z + (rho / last if count else 0.0) * p
            q = self.matrix @ p
            step = rho / float(np.vdot(p, q).real)
            x += step * p
            r -= step * q
            count += 1
            residual = float(np.linalg.norm(r)) / size
            if watch:
                watch(count, residual)
        return Solution(x, count, float(np.linalg.norm(rhs - self.matrix @ x)) / size if size > 0 else 0.0)


def _with_short_indices(matrix: sp.bsr_array) -> sp.bsr_matrix:
    indices, indptr = matrix.indices.astype(np.int32), matrix.indptr.astype(np.int32)
    return sp.bsr_matrix((matrix.data, indices, indptr), shape=matrix.shape)


def rigid_modes(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Six rigid-body modes (3n, 6), rotations scaled to the size of the body."""
    centred = points - points.mean(axis=0)
    x, y, z = (centred / np.abs(centred).max()).T
    modes = np.zeros((len(points), 3, 6))
    modes[:, range(3), range(3)] = 1.0
    modes[:, 1, 3], modes[:, 2, 3] = -z, y
    modes[:, 0, 4], modes[:, 2, 4] = z, -x
    modes[:, 0, 5], modes[:, 1, 5] = -y, x
    return modes.reshape(-1, 6)

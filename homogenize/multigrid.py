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

STRENGTH_THRESHOLD = 0.05
"""Of smoothed aggregation: at a contrast of 20 000 it needs a third of the iterations of 0 (benchmarks/cell_3d.md)."""
COARSEST = 300
"""Unknowns that are solved directly."""
LEVELS = 10


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
    height : period along z [m]: nodes more than half of it apart are neighbours across the seam only, where a rigid motion
        does not go on as the same rigid motion, so that no aggregate may hold both
    """

    def __init__(self, matrix: sp.bsr_array, points: NDArray[np.float64], height: float) -> None:
        self.matrix = _with_short_indices(matrix)
        levels = _levels(self.matrix, points, height)
        self.complexity = sum(level.nnz for level, _ in levels) / levels[0][0].nnz
        self.precondition = _cycle(levels)

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
            z = self.precondition(r)
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


def _levels(
    matrix: sp.bsr_matrix, points: NDArray[np.float64], height: float
) -> list[tuple[sp.bsr_matrix, sp.bsr_matrix | None]]:
    """Matrix and prolongator of every level, None on the last."""
    from pyamg.aggregation import fit_candidates, standard_aggregation
    from pyamg.aggregation.smooth import jacobi_prolongation_smoother
    from pyamg.strength import symmetric_strength_of_connection

    connection: Any = symmetric_strength_of_connection
    aggregation: Any = standard_aggregation
    levels: list[tuple[sp.bsr_matrix, sp.bsr_matrix | None]] = []
    modes, z = rigid_modes(points).astype(matrix.dtype), points[:, 2]
    while len(modes) > COARSEST and len(levels) < LEVELS:
        strong: Any = connection(matrix, STRENGTH_THRESHOLD).tocoo()
        near = np.abs(z[strong.row] - z[strong.col]) < 0.5 * height
        strong = _with_short_indices(
            sp.csr_matrix((strong.data[near], (strong.row[near], strong.col[near])), strong.shape)
        )
        aggregates = aggregation(strong)[0]
        if aggregates.shape[1] == aggregates.shape[0]:
            break
        z = (aggregates.T @ z) / np.maximum(1, np.asarray(aggregates.sum(axis=0)).ravel())
        tentative, modes = fit_candidates(aggregates, modes)
        P = jacobi_prolongation_smoother(matrix, tentative, strong, modes, omega=4.0 / 3.0, weighting="block")
        P = _with_short_indices(P)
        levels.append((matrix, P))
        matrix = _with_short_indices((P.conj().T @ matrix @ P).tobsr(blocksize=(6, 6)))
    levels.append((matrix, None))
    return levels


def _cycle(levels: list[tuple[sp.bsr_matrix, sp.bsr_matrix | None]]) -> Callable[[NDArray], NDArray]:
    """One V-cycle as a function of the residual: forward block Gauss-Seidel down, backward up, so that it is symmetric.

    Smoothing is in single precision, which halves its traffic; the coarsest level, singular for cells that can move freely, is solved in
    double precision, where rounding does not hide its null vectors.
    """
    from pyamg.multilevel import MultilevelSolver
    from pyamg.relaxation.smoothing import change_smoothers

    kind = np.complex64 if np.iscomplexobj(levels[0][0].data) else np.float32
    inverse = np.linalg.pinv(levels[-1][0].toarray(), rcond=1e-12, hermitian=True)
    made = []
    for matrix, prolongator in levels:
        level: Any = MultilevelSolver.Level()
        level.A = _with_short_indices(matrix.astype(kind))
        if prolongator is not None:
            level.P = _with_short_indices(prolongator.astype(kind))
            level.R = _with_short_indices(level.P.conj().T.tobsr())
        made.append(level)
    make: Any = MultilevelSolver
    hierarchy = make(made, coarse_solver=lambda _, b: (inverse @ b).astype(kind))
    change_smoothers(hierarchy, *[("block_gauss_seidel", {"sweep": sweep}) for sweep in ("forward", "backward")])
    operator = hierarchy.aspreconditioner(cycle="V")

    def precondition(r: NDArray) -> NDArray:
        if len(levels) == 1:
            return inverse @ r
        size = np.abs(r).max()  # the cycle is linear: scaled, so that single precision holds every residual
        return size * (operator @ (r / size).astype(kind)).astype(r.dtype)

    return precondition


def _with_short_indices(matrix: Any) -> Any:
    """The same data as a scipy matrix with 32-bit indices, which pyamg asks for."""
    make = sp.bsr_matrix if matrix.format == "bsr" else sp.csr_matrix
    return make((matrix.data, matrix.indices.astype(np.int32), matrix.indptr.astype(np.int32)), shape=matrix.shape)


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

r"""Smoothed aggregation for elastic solids in 3x3 blocks, real or complex Hermitian: one V-cycle, to precondition with.

The hierarchy is built from the six rigid-body modes (Vanek, Mandel, Brezina, Computing 56 (1996) 179-196, doi
10.1007/BF02238511): aggregates of strongly joined nodes, the rigid motions of each as its coarse unknowns T, and the prolongator

.. math::  P = \big( I - \tfrac{4}{3\rho} D^{-1} A \big) T, \qquad \rho = \rho(D^{-1} A) .

pyamg, which is imported here only, finds strength and aggregates. Settings were chosen by measurement, benchmarks/cell_3d.md.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from homogenize.block_product import block_product
from homogenize.block_sweep import Blocks, Smoother, blocks, smoother, three_parts
from homogenize.energy_gmres import Solution, energy_gmres

STRENGTH_THRESHOLD = 0.05
"""Of smoothed aggregation: at a contrast of 20 000 it needs a third of the iterations of 0 (benchmarks/cell_3d.md)."""
COARSEST = 300
"""Unknowns that are solved directly."""
LEVELS = 10


@dataclass(frozen=True)
class Level:
    """One level: its smoother in single precision, and the way to and from the next."""

    smoother: Smoother
    prolongator: Blocks
    restriction: Blocks
    order: NDArray[np.int64]


class Multigrid:
    """A hierarchy; `complexity` is the number of entries of all levels over those of the first.

    Parameters
    ----------
    matrix : real symmetric or complex Hermitian, 3x3 blocks, positive semi-definite
    points : (n, 3) places of the nodes [m]
    height : period along z [m]: nodes more than half of it apart are neighbours across the seam only, where a rigid motion
        does not go on as the same rigid motion, so that no aggregate may hold both
    """

    def __init__(self, matrix: sp.bsr_array, points: NDArray[np.float64], height: float) -> None:
        self.matrix: Any = _with_short_indices(matrix)
        first, level = matrix.nnz, self.matrix
        modes, entries = rigid_modes(points).astype(matrix.dtype), 0
        modes_here = modes
        self.levels: list[Level] = []
        while len(modes) > COARSEST and len(self.levels) < LEVELS:
            made = _coarsened(level, points, modes, height)
            if made is None:
                break
            entries += level.nnz
            step, level, points, modes = made
            self.levels.append(step)
        self.kind = np.complex64 if np.iscomplexobj(matrix.data) else np.float32
        self.inverse = np.linalg.pinv(level.toarray(), rcond=1e-12, hermitian=True)
        self.complexity = (entries + level.nnz) / first
        self.free = _free_motions(self.matrix, modes_here)

    def precondition(self, r: NDArray) -> NDArray:
        """One V-cycle on the residual: forward Gauss-Seidel down, backward up, so that it is symmetric.

        Smoothing is in single precision, which halves its traffic; the coarsest level, singular for cells that can move
        freely, is solved in double precision, where rounding does not hide its null vectors.
        """
        size = np.abs(r).max()  # the cycle is linear: scaled, so that single precision holds every residual
        if not self.levels or not size > 0:
            return self.inverse @ r
        b = (r / size).astype(self.kind).reshape(-1, 3)
        z = size * self._cycle(0, b).ravel().astype(r.dtype)
        return z - self.free @ (self.free.conj().T @ z)

    def solve(self, rhs: NDArray, tolerance: float, max_iterations: int) -> Solution:
        """Solve with the matrix alone, until the error in the energy norm is about `tolerance` of the solution."""
        product = blocks(self.matrix).product
        return energy_gmres(
            lambda x: product(x.reshape(-1, 3)).ravel(), self.precondition, rhs, tolerance, max_iterations
        )

    def _cycle(self, number: int, b: NDArray) -> NDArray:
        if number == len(self.levels):
            return (self.inverse @ b.ravel()).astype(self.kind).reshape(b.shape)
        level = self.levels[number]
        b = b[level.order]
        x, r = level.smoother.forward(b)
        x += level.prolongator.product(self._cycle(number + 1, level.restriction.product(r)))
        level.smoother.backward(b, x)
        out = np.empty_like(x)
        out[level.order] = x
        return out


def _coarsened(
    matrix: Any, points: NDArray[np.float64], modes: NDArray, height: float
) -> tuple[Level, Any, NDArray[np.float64], NDArray] | None:
    """The level of `matrix`, then the matrix, points and rigid modes of the next one; None if nothing can be joined."""
    from pyamg.aggregation import fit_candidates

    size = matrix.blocksize[0]
    order, parts = three_parts(matrix, points)
    matrix, points = _renumbered(matrix, order), points[order]
    modes = modes.reshape(-1, size, 6)[order].reshape(-1, 6)
    aggregates = _aggregates(matrix, points[:, 2], height)
    if aggregates is None:
        return None
    count = np.maximum(1, np.asarray(aggregates.sum(axis=0)).ravel())
    tentative, coarse_modes = fit_candidates(aggregates, modes)
    kind = np.complex64 if np.iscomplexobj(matrix.data) else np.float32
    sweep = smoother(_with_short_indices(matrix.astype(kind)), parts)
    P = _prolongator(matrix, _with_short_indices(tentative), sweep)
    R = _canonical(P.conj().T.tobsr())
    coarse = block_product(R, block_product(matrix, P))
    level = Level(sweep, blocks(P.astype(kind)), blocks(R.astype(kind)), order)
    return level, _canonical(coarse), (aggregates.T @ points) / count[:, None], coarse_modes


def _aggregates(matrix: Any, z: NDArray[np.float64], height: float) -> Any:
    """Nodes by aggregates, None if there are as many; strength is that of the blocks, without pairs across the seam."""
    from pyamg.aggregation import standard_aggregation
    from pyamg.strength import symmetric_strength_of_connection

    connection: Any = symmetric_strength_of_connection
    aggregation: Any = standard_aggregation
    strong = connection(matrix, STRENGTH_THRESHOLD).tocoo()
    near = np.abs(z[strong.row] - z[strong.col]) < 0.5 * height
    strong = sp.csr_matrix((strong.data[near], (strong.row[near], strong.col[near])), strong.shape)
    aggregates = aggregation(_with_short_indices(strong))[0]
    return None if aggregates.shape[1] == aggregates.shape[0] else aggregates


def _prolongator(matrix: Any, tentative: Any, sweep: Smoother) -> Any:
    """(I - 4 / (3 rho) D^-1 A) T."""
    n, size = sweep.matrix.rows, matrix.blocksize[0]
    x = np.random.default_rng(0).standard_normal((n, size)).astype(sweep.matrix.data.dtype)
    rho = 1.0
    for _ in range(12):  # power iteration
        x /= np.linalg.norm(x)
        x = np.einsum("ipq,iq->ip", sweep.inverse, sweep.matrix.product(x))
        rho = float(np.linalg.norm(x))
    moved = _canonical(block_product(matrix, tentative))
    row = np.repeat(np.arange(n), np.diff(moved.indptr))
    moved.data = np.matmul(sweep.inverse[row], moved.data) * (-4.0 / 3.0 / (1.05 * rho))
    P = tentative + moved
    return _canonical(P.tobsr(blocksize=(size, 6)))


def _renumbered(matrix: Any, order: NDArray[np.int64]) -> Any:
    """Rows and columns of blocks in another order."""
    n = len(order)
    if np.array_equal(order, np.arange(n)):
        return matrix
    number = sp.csr_matrix(
        (np.arange(len(matrix.indices), dtype=np.int32), matrix.indices, matrix.indptr), shape=(n, n)
    )
    number = number[order][:, order]
    number.sort_indices()
    return _canonical(sp.bsr_matrix((matrix.data[number.data], number.indices, number.indptr), shape=matrix.shape))


def _canonical(matrix: Any) -> Any:
    """The same matrix with 32-bit indices and sorted columns, and marked as free of duplicates."""
    matrix = _with_short_indices(matrix)
    matrix.sort_indices()
    matrix.has_canonical_format = True
    return matrix


def _with_short_indices(matrix: Any) -> Any:
    """The same data as a scipy matrix with 32-bit indices, which pyamg asks for."""
    make = sp.bsr_matrix if matrix.format == "bsr" else sp.csr_matrix
    return make((matrix.data, matrix.indices.astype(np.int32), matrix.indptr.astype(np.int32)), shape=matrix.shape)


def _free_motions(matrix: Any, modes: NDArray) -> NDArray:
    """Orthonormal rigid motions that cost nothing, (n, k): they would grow unseen in the solution."""
    Q = np.linalg.qr(modes)[0]
    values, vectors = np.linalg.eigh(Q.conj().T @ np.column_stack([matrix @ q for q in Q.T]))
    return Q @ vectors[:, values < 1e-13 * np.abs(matrix.data).max()]


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

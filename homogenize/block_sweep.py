r"""Products and Gauss-Seidel sweeps of matrices in small dense blocks, on two threads.

A sweep visits the rows one after the other,

.. math::  x_i \leftarrow D_i^{-1} \Big( b_i - \sum_{j \ne i} A_{ij} x_j \Big) ,

so that rows may be visited at the same time only if no entry joins them. The nodes are therefore numbered in three parts: two
halves of the body, and last the nodes of the first half that touch the second. The halves are swept at once, the seam between
them after (before, on the way back): the same numbers as on one thread, and the backward sweep is exactly the adjoint of the
forward one. (Nested dissection of one level: George, SIAM J. Numer. Anal. 10 (1973) 345-363, doi 10.1137/0710032.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from homogenize.compiled import THREADS, kernel, share

SHARED = 2000
"""Blocks of rows below which one thread does it all."""


@dataclass(frozen=True)
class Blocks:
    """A matrix in blocks of fixed size: row pointer, columns and blocks as in scipy's BSR, sorted columns.

    `before`, `after` (square matrices): where the columns that precede the diagonal end, and where those that follow begin.
    """

    indptr: NDArray[np.int32]
    indices: NDArray[np.int32]
    data: NDArray
    before: NDArray[np.int32]
    after: NDArray[np.int32]

    @property
    def rows(self) -> int:
        return len(self.indptr) - 1

    def product(self, x: NDArray, sign: int = 1) -> NDArray:
        """A x (or -A x), (rows, m) for x (columns, k)."""
        y = np.empty((self.rows, self.data.shape[1]), dtype=np.result_type(self.data.dtype, x.dtype))
        share(
            _product,
            halves(self.indptr),
            self.indptr[:-1],
            self.indptr[1:],
            self.indices,
            self.data,
            x,
            y,
            sign,
            *_units(self.data),
        )
        return y


def blocks(matrix: sp.bsr_matrix) -> Blocks:
    """The same matrix, columns sorted."""
    matrix.sort_indices()
    indptr, indices = matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32)
    row = np.repeat(np.arange(len(indptr) - 1, dtype=np.int32), np.diff(indptr))
    before = indptr[:-1] + np.bincount(row[indices < row], minlength=len(indptr) - 1).astype(np.int32)
    on = np.bincount(row[indices == row], minlength=len(indptr) - 1).astype(np.int32)
    return Blocks(indptr, indices, matrix.data, before, before + on)


@dataclass(frozen=True)
class Smoother:
    """Gauss-Seidel on `matrix`, whose rows are numbered in the parts `parts`: two that no entry joins, and the seam."""

    matrix: Blocks
    inverse: NDArray
    parts: tuple[int, int, int]

    def forward(self, b: NDArray) -> tuple[NDArray, NDArray]:
        """One sweep from zero, and the residual b - A x it leaves."""
        m = self.matrix
        x = np.zeros_like(b)
        entries = (m.indptr[:-1], m.before, m.indices, m.data, self.inverse, b, x, *_units(m.data)[:1])
        for ranges in self._phases():
            share(_forward, ranges, *entries)
        r = np.empty_like(b)  # (D + L) x = b, what is left is -U x
        share(_product, halves(m.indptr), m.after, m.indptr[1:], m.indices, m.data, x, r, -1, *_units(m.data))
        return x, r

    def backward(self, b: NDArray, x: NDArray) -> None:
        """One sweep in the opposite order, x changed in place."""
        m = self.matrix
        entries = (m.indptr, m.before, m.after, m.indices, m.data, self.inverse, b, x, *_units(m.data)[:1])
        for ranges in reversed(self._phases()):
            share(_backward, ranges, *entries)

    def _phases(self) -> list[list[tuple[int, int]]]:
        one, two, end = self.parts
        return [[(0, one), (one, two)] if two > one else [(0, one)], [(two, end)]]


def smoother(matrix: sp.bsr_matrix, parts: tuple[int, int, int]) -> Smoother:
    """Smoother of a square matrix."""
    made = blocks(matrix)
    row = np.flatnonzero(made.after > made.before)
    diagonal = np.zeros((made.rows, *made.data.shape[1:]), dtype=np.result_type(made.data.dtype, np.float64))
    diagonal[row] = made.data[made.before[row]]
    return Smoother(made, _pseudo_inverses(diagonal).astype(made.data.dtype), parts)


def _pseudo_inverses(D: NDArray) -> NDArray:
    """Of Hermitian positive semi-definite blocks; directions without stiffness are left alone."""
    values, vectors = np.linalg.eigh(D)
    large = values > 1e-6 * values[:, -1:]
    scale = np.divide(1.0, values, out=np.zeros_like(values), where=large)
    return (vectors * scale[:, None, :]) @ vectors.conj().transpose(0, 2, 1)


def three_parts(matrix: sp.bsr_matrix, points: NDArray[np.float64]) -> tuple[NDArray[np.int64], tuple[int, int, int]]:
    """Order of the rows, and where each of the three parts ends: two halves along the longest side of the body, and their seam."""
    n = len(points)
    half = np.zeros(n, dtype=bool)
    along = points[:, np.argmax(np.ptp(points, axis=0))]
    half[np.argsort(along, kind="stable")[n // 2 :]] = True
    row = np.repeat(np.arange(n), np.diff(matrix.indptr))
    seam = np.zeros(n, dtype=bool)
    seam[row[~half[row] & half[matrix.indices]]] = True
    if n < SHARED or THREADS == 1 or seam.sum() > n // 4:
        return np.arange(n), (n, n, n)
    part = np.where(seam, 2, half)
    one, two = int((part == 0).sum()), int((part <= 1).sum())
    return np.argsort(part, kind="stable"), (one, two, n)


def halves(indptr: NDArray[np.int32]) -> list[tuple[int, int]]:
    """Two ranges of rows with the same number of entries; one if there are few."""
    n = len(indptr) - 1
    if n < SHARED:
        return [(0, n)]
    middle = int(np.searchsorted(indptr, indptr[-1] // 2))
    return [(0, middle), (middle, n)]


def _units(data: NDArray) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Tuples as long as the blocks are high and wide: kernels are compiled for each length."""
    return (0,) * data.shape[1], (0,) * data.shape[2]


@kernel
def _product(first, last, start, end, indices, data, x, y, sign, high, wide):
    sums = np.zeros(len(high), y.dtype)
    for i in range(first, last):
        for p in range(len(high)):
            sums[p] = 0
        for k in range(start[i], end[i]):
            j = indices[k]
            for p in range(len(high)):
                s = data[k, p, 0] * x[j, 0]
                for q in range(1, len(wide)):
                    s += data[k, p, q] * x[j, q]
                sums[p] += s
        for p in range(len(high)):
            y[i, p] = sign * sums[p]


@kernel
def _forward(first, last, start, before, indices, data, inverse, b, x, high):
    sums = np.zeros(len(high), x.dtype)
    for i in range(first, last):
        for p in range(len(high)):
            sums[p] = b[i, p]
        for k in range(start[i], before[i]):
            j = indices[k]
            for p in range(len(high)):
                s = data[k, p, 0] * x[j, 0]
                for q in range(1, len(high)):
                    s += data[k, p, q] * x[j, q]
                sums[p] -= s
        for p in range(len(high)):
            s = inverse[i, p, 0] * sums[0]
            for q in range(1, len(high)):
                s += inverse[i, p, q] * sums[q]
            x[i, p] = s


@kernel
def _backward(first, last, indptr, before, after, indices, data, inverse, b, x, high):
    sums = np.zeros(len(high), x.dtype)
    for i in range(last - 1, first - 1, -1):
        for p in range(len(high)):
            sums[p] = b[i, p]
        for k in range(indptr[i], indptr[i + 1]):
            if k < before[i] or k >= after[i]:
                j = indices[k]
                for p in range(len(high)):
                    s = data[k, p, 0] * x[j, 0]
                    for q in range(1, len(high)):
                        s += data[k, p, q] * x[j, q]
                    sums[p] -= s
        for p in range(len(high)):
            s = inverse[i, p, 0] * sums[0]
            for q in range(1, len(high)):
                s += inverse[i, p, q] * sums[q]
            x[i, p] = s

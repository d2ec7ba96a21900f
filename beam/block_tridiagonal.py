r"""Direct solution of block-tridiagonal systems, the matrix of every chain of nodes that couple to their neighbours.

With blocks D_i on, U_i above and L_i below the diagonal, elimination from the first block on gives

.. math:: P_i \bar D_i = \text{LU}, \quad X_i = \bar D_i^{-1} U_i, \quad \bar D_{i+1} = D_{i+1} - L_i X_i,

with row pivoting inside a block; work and storage grow linearly with the number of blocks.
Source: G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed., section 4.5.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from beam.compiled import inlined, kernel

Array = NDArray[np.float64]


@inlined
def factor_block(A: Array, pivot: NDArray[np.int64]) -> bool:
    """LU of the square `A` in place with row pivoting; False if it is singular or not finite."""
    n = A.shape[0]
    for k in range(n):
        p = k
        largest = abs(A[k, k])
        for i in range(k + 1, n):
            if abs(A[i, k]) > largest:
                largest = abs(A[i, k])
                p = i
        pivot[k] = p
        if not largest > 0.0 or largest > 1e300:
            return False
        if p != k:
            for j in range(n):
                A[k, j], A[p, j] = A[p, j], A[k, j]
        inverse = 1.0 / A[k, k]
        for i in range(k + 1, n):
            A[i, k] *= inverse
            factor = A[i, k]
            if factor != 0.0:
                for j in range(k + 1, n):
                    A[i, j] -= factor * A[k, j]
    return True


@kernel
def swap_rows(pivot: NDArray[np.int64], B: Array) -> None:
    """Apply the row exchanges of a factorisation to `B` (n, m)."""
    n, m = B.shape
    for k in range(n):
        p = pivot[k]
        if p != k:
            for j in range(m):
                B[k, j], B[p, j] = B[p, j], B[k, j]


@kernel
def solve_block(A: Array, pivot: NDArray[np.int64], B: Array) -> None:
    """Replace the right-hand sides `B` (n, m) by the solutions; `A`, `pivot` from :func:`factor_block`."""
    n, m = B.shape
    swap_rows(pivot, B)
    for i in range(n):
        for k in range(i):
            factor = A[i, k]
            for j in range(m):
                B[i, j] -= factor * B[k, j]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            factor = A[i, k]
            for j in range(m):
                B[i, j] -= factor * B[k, j]
        inverse = 1.0 / A[i, i]
        for j in range(m):
            B[i, j] *= inverse


@kernel
def solve_row(A: Array, pivot: NDArray[np.int64], B: Array, row: int) -> None:
    """Replace the right-hand side ``B[row]`` by its solution; `A`, `pivot` from :func:`factor_block`."""
    n = A.shape[0]
    for k in range(n):
        p = pivot[k]
        if p != k:
            B[row, k], B[row, p] = B[row, p], B[row, k]
    for i in range(n):
        total = B[row, i]
        for k in range(i):
            total -= A[i, k] * B[row, k]
        B[row, i] = total
    for i in range(n - 1, -1, -1):
        total = B[row, i]
        for k in range(i + 1, n):
            total -= A[i, k] * B[row, k]
        B[row, i] = total / A[i, i]


@inlined
def factor_chain(D: Array, U: Array, L: Array, pivots: NDArray[np.int64]) -> int:
    """Factorise in place: `D` (n, b, b), `U` and `L` (n - 1, b, b), `pivots` (n, b). Returns -1, or the singular block."""
    n, b, _ = D.shape
    for i in range(n):
        if not factor_block(D[i], pivots[i]):
            return i
        if i == n - 1:
            break
        solve_block(D[i], pivots[i], U[i])
        for r in range(b):
            for k in range(b):
                factor = L[i, r, k]
                if factor != 0.0:
                    for c in range(b):
                        D[i + 1, r, c] -= factor * U[i, k, c]
    return -1


@kernel
def solve_chain(D: Array, U: Array, L: Array, pivots: NDArray[np.int64], B: Array) -> None:
    """Replace `B` (n, b) by the solution; the other arguments from :func:`factor_chain`."""
    n, b, _ = D.shape
    for i in range(n):
        if i > 0:
            for r in range(b):
                total = 0.0
                for k in range(b):
                    total += L[i - 1, r, k] * B[i - 1, k]
                B[i, r] -= total
        solve_row(D[i], pivots[i], B, i)
    for i in range(n - 2, -1, -1):
        for r in range(b):
            total = 0.0
            for k in range(b):
                total += U[i, r, k] * B[i + 1, k]
            B[i, r] -= total


@kernel
def invert_chain(D: Array, U: Array, L: Array, pivots: NDArray[np.int64]) -> int:  # noqa: C901 - loops over rows and columns
    """Factorise in place for :func:`sweep_chain`: the blocks become (D^-1)^T, (D^-1 U)^T, (D^-1 L)^T, in this sense explicit.

    Twice the work of :func:`factor_chain`, but a solution costs a tenth. Returns -1, or the singular block.
    """
    n, b, _ = D.shape
    singular = factor_chain(D, U, L, pivots)
    if singular >= 0:
        return singular
    inverse, lower = np.empty((b, b)), np.empty((b, b))
    for i in range(n):
        for r in range(b):
            for c in range(b):
                inverse[r, c] = 1.0 if r == c else 0.0
                lower[r, c] = L[i - 1, r, c] if i > 0 else 0.0
        solve_block(D[i], pivots[i], inverse)
        if i > 0:
            solve_block(D[i], pivots[i], lower)
        for r in range(b):
            for c in range(b):
                D[i, c, r] = inverse[r, c]
                if i > 0:
                    L[i - 1, c, r] = lower[r, c]
        if i < n - 1:
            for r in range(b):
                for c in range(r):
                    U[i, r, c], U[i, c, r] = U[i, c, r], U[i, r, c]
    return -1


def sweep_of(b: int) -> Callable[[Array, Array, Array, Array], None]:  # noqa: C901 - loops over rows and columns
    """A kernel that replaces `B` (n, b) by the solution; blocks of `b` rows from :func:`invert_chain`.

    Only products of a stored row with one number, which the processor does four at a time where `b` is a constant.
    """

    @kernel
    def sweep(D: Array, U: Array, L: Array, B: Array) -> None:  # noqa: C901
        n = D.shape[0]
        y = np.empty(b)
        for i in range(n):
            for r in range(b):
                y[r] = 0.0
            for k in range(b):
                x = B[i, k]
                for r in range(b):
                    y[r] += D[i, k, r] * x
            if i > 0:
                for k in range(b):
                    x = B[i - 1, k]
                    for r in range(b):
                        y[r] -= L[i - 1, k, r] * x
            for r in range(b):
                B[i, r] = y[r]
        for i in range(n - 2, -1, -1):
            for r in range(b):
                y[r] = B[i, r]
            for k in range(b):
                x = B[i + 1, k]
                for r in range(b):
                    y[r] -= U[i, k, r] * x
            for r in range(b):
                B[i, r] = y[r]

    return sweep


sweep_12, sweep_6 = sweep_of(12), sweep_of(6)


def sweep_chain(D: Array, U: Array, L: Array, B: Array) -> None:
    """Replace `B` (n, b) by the solution; blocks of b = 12 or 6 rows from :func:`invert_chain`."""
    if D.shape[1] == 6:
        sweep_6(D, U, L, B)
    else:
        sweep_12(D, U, L, B)

r"""Least squares on normal equations with some unknowns not below zero, many small systems at once.

.. math::  \min_x \tfrac12 x^T A x - b^T x , \qquad x_j \ge 0 \text{ where asked}

Source: the active set method of Lawson & Hanson, Solving Least Squares Problems, 1974, ch. 23, here on A = Z^T Z with
unknowns of free sign held in the passive set throughout.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@kernel
def _solve_passive(A: Array, b: Array, passive: Flags, x: Array) -> None:
    """Cholesky solution on the passive unknowns, the others zero."""
    P = len(b)
    index = np.empty(P, dtype=np.int64)
    k = 0
    for j in range(P):
        x[j] = 0.0
        if passive[j]:
            index[k] = j
            k += 1
    L = np.zeros((k, k))
    z = np.zeros(k)
    for i in range(k):
        for j in range(i + 1):
            value = A[index[i], index[j]]
            for m in range(j):
                value -= L[i, m] * L[j, m]
            if i == j:
                L[i, i] = np.sqrt(max(value, 1e-14 * A[index[i], index[i]] + 1e-300))
            else:
                L[i, j] = value / L[j, j]
        value = b[index[i]]
        for m in range(i):
            value -= L[i, m] * z[m]
        z[i] = value / L[i, i]
    for i in range(k - 1, -1, -1):
        value = z[i]
        for m in range(i + 1, k):
            value -= L[m, i] * x[index[m]]
        x[index[i]] = value / L[i, i]


@kernel
def _steepest(A: Array, b: Array, passive: Flags, x: Array) -> int:
    """The bound unknown along which the cost falls most, columns scaled to one, or -1 if it falls along none."""
    best, steepest = -1, 0.0
    for j in range(len(b)):
        if not passive[j]:
            slope = b[j]
            for m in range(len(b)):
                slope -= A[j, m] * x[m]
            slope /= np.sqrt(A[j, j] + 1e-300)
            if slope > steepest + 1e-9 * np.abs(b[j]) / np.sqrt(A[j, j] + 1e-300):
                best, steepest = j, slope
    return best


@kernel
def _active_set(A: Array, b: Array, positive: Flags, x: Array) -> None:
    P = len(b)
    passive = ~positive
    trial = np.empty(P)
    _solve_passive(A, b, passive, x)
    for _ in range(3 * P):
        best = _steepest(A, b, passive, x)
        if best < 0:
            return
        passive[best] = True
        for _inner in range(P):
            _solve_passive(A, b, passive, trial)
            alpha, leaves = 1.0, -1
            for j in range(P):
                if passive[j] and positive[j] and trial[j] <= 0.0:
                    step = x[j] / (x[j] - trial[j]) if x[j] > trial[j] else 0.0
                    if step < alpha or leaves < 0:
                        alpha, leaves = step, j
            for j in range(P):
                x[j] += alpha * (trial[j] - x[j])
            if leaves < 0:
                break
            x[leaves] = 0.0
            passive[leaves] = False


@kernel
def solve_bounded(A: Array, b: Array, positive: Flags, x: Array) -> None:
    """Write the solutions of systems A (B, P, P), b (B, P) into `x` (B, P); `positive` (P,) asks for x >= 0."""
    everything = np.ones(len(positive), dtype=np.bool_)
    for i in range(len(A)):
        _solve_passive(A[i], b[i], everything, x[i])
        feasible = True
        for j in range(len(positive)):
            if positive[j] and x[i, j] < 0.0:
                feasible = False
        if not feasible:
            _active_set(A[i], b[i], positive, x[i])

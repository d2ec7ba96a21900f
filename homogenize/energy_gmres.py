r"""GMRES for elastic solids with pressures, in the norm in which the stiffness errs.

.. math::  \begin{bmatrix} A & B^H \\ B & -C \end{bmatrix} \begin{bmatrix} u \\ p \end{bmatrix} = \begin{bmatrix} f \\ g \end{bmatrix} , \qquad
   P = \begin{bmatrix} \hat A & B^H \\ 0 & -S \end{bmatrix} ,

with a multigrid cycle for A and the diagonal S for the Schur complement C + B A^-1 B^H (Murphy, Golub, Wathen, SIAM J. Sci. Comput. 21 (2000)
1969-1972, doi 10.1137/S1064827599355153). The preconditioned residual z = P^-1 r is made smallest in the norm of H = diag(A^, S), the energy of an
error z; H z comes with z at no cost. The energy, so the stiffness, is stationary in (u, p): its relative error is about the square of
the relative norm at which the iteration stops. Without pressures this is the minimal residual method in the norm of A^-1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

BASIS = 60
"""Vectors kept before the iteration starts again from where it is."""
SINGLE = 1e-4
"""Reduction after which it starts again, because the cycle is in single precision."""

Product = Callable[[NDArray], NDArray]
Precondition = Callable[[NDArray], tuple[NDArray, NDArray]]


@dataclass(frozen=True)
class Solution:
    """The unknowns, the iterations, and the energy norm of the preconditioned residual over that of the load."""

    unknowns: NDArray
    iterations: int
    residual: float


def energy_gmres(
    product: Product,
    precondition: Precondition,
    load: NDArray,
    tolerance: float,
    max_iterations: int,
    watch: Callable[[int, float], None] | None = None,
) -> Solution:
    """Solve from zero; `precondition` returns z = P^-1 r and H z; `watch` hears every iteration and its residual."""
    x, r, count, size, reached = np.zeros_like(load), load, 0, 0.0, 1.0
    while True:
        z, hz = precondition(r)
        norm = _norm(z, hz)
        size = size or norm
        if not norm > 0 or not np.isfinite(norm):  # nothing to do, or not-a-number: the caller reports how far it came
            return Solution(x, count, norm / size if size > 0 else norm)
        reached = norm / size
        if reached <= tolerance or count >= max_iterations:
            return Solution(x, count, reached)
        goal = max(tolerance / reached, SINGLE)
        steps = min(BASIS, max_iterations - count)
        start = count
        said = None if watch is None else (lambda i, f, s=start, a=reached, w=watch: w(s + i, a * f))
        correction, done = _cycle(product, precondition, z / norm, goal, steps, said)
        x = x + norm * correction
        count += done
        r = load - product(x)


def _cycle(
    product: Product,
    precondition: Precondition,
    first: NDArray,
    goal: float,
    steps: int,
    watch: Callable[[int, float], None] | None,
) -> tuple[NDArray, int]:
    """Arnoldi's process with Givens rotations, from a first vector of norm one until the residual is `goal` of it."""
    V = [first]
    R = np.zeros((steps + 1, steps), dtype=first.dtype)
    turns: list[tuple[float, complex]] = []
    g = np.zeros(steps + 1, dtype=first.dtype)
    g[0] = 1.0
    k = 0
    while k < steps:
        w, hw = precondition(product(V[k]))
        square = _norm(w, hw) ** 2
        for i, v in enumerate(V):
            R[i, k] = np.vdot(v, hw)
            w -= R[i, k] * v
        below = np.sqrt(max(0.0, square - float((np.abs(R[: k + 1, k]) ** 2).sum())))
        for i, (c, s) in enumerate(turns):
            a, b = R[i, k], R[i + 1, k]
            R[i, k], R[i + 1, k] = c * a + np.conj(s) * b, -s * a + c * b
        a = R[k, k]
        length = float(np.hypot(abs(a), below))
        if length == 0:
            break
        phase = a / abs(a) if abs(a) > 0 else 1.0
        c, s = abs(a) / length, below / length * np.conj(phase)
        turns.append((c, s))
        R[k, k] = phase * length
        g[k], g[k + 1] = c * g[k], -s * g[k]
        k += 1
        if watch:
            watch(k, float(abs(g[k])))
        if abs(g[k]) <= goal or below <= 1e-7 * np.sqrt(square):
            break
        V.append(w / below)
    y = np.linalg.solve(R[:k, :k], g[:k]) if k else g[:0]
    return sum((a * v for a, v in zip(y, V, strict=False)), np.zeros_like(first)), k


def _norm(z: NDArray, hz: NDArray) -> float:
    return float(np.sqrt(max(0.0, np.vdot(z, hz).real)))

r"""GMRES for elastic solids with pressures, in the norm in which the stiffness errs.

.. math::  \begin{bmatrix} A & B^H \\ B & -C \end{bmatrix} \begin{bmatrix} u \\ p \end{bmatrix} = \begin{bmatrix} f \\ g \end{bmatrix} ,
   \qquad P = \begin{bmatrix} \hat A & B^H \\ 0 & -S \end{bmatrix} ,

with a multigrid cycle for A and the diagonal S for the Schur complement C + B A^-1 B^H (Murphy, Golub, Wathen, SIAM J. Sci.
Comput. 21 (2000) 1969-1972, doi 10.1137/S1064827599355153). The preconditioned residual z = P^-1 r is made smallest in the norm
of H = diag(A^, S), the energy of an error z. P^-1 = H^-1 L, and L, which needs no cycle, is applied to the equations first. The
energy, so the stiffness, is stationary in (u, p): its relative error is about the square of the relative norm at which the
iteration stops. Without pressures this is the minimal residual method in the norm of A^-1.

Both z and H z are kept (flexible GMRES, Saad, SIAM J. Sci. Comput. 14 (1993) 461-469, doi 10.1137/0914028): the cycle, in single
precision, errs by 1e-7 of the displacement, which in the energy of stiff strands in rubber is 1e-3.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

BASIS = 50
"""Vectors kept before the iteration starts again from where it is."""

Linear = Callable[[NDArray], NDArray]
Watch = Callable[[int, float], None]


@dataclass(frozen=True)
class Solution:
    """The unknowns, the iterations, and the energy norm of the preconditioned residual over that of the load."""

    unknowns: NDArray
    iterations: int
    residual: float


def energy_gmres(
    product: Linear, inverse: Linear, load: NDArray, tolerance: float, max_iterations: int, watch: Watch | None = None
) -> Solution:
    """Solve from zero.

    Parameters
    ----------
    product : L M x
    inverse : H^-1 h, Hermitian
    load : L times the right side
    tolerance : relative norm at which to stop
    watch : hears every iteration and its residual
    """
    x, h, count, size = np.zeros_like(load), load, 0, 0.0
    while True:
        z = inverse(h)
        norm = _norm(z, h)
        size = size or norm
        residual = norm / size if size > 0 else norm
        if (
            not residual > tolerance or count >= max_iterations
        ):  # not-a-number as well: the caller reports how far it came
            return Solution(x, count, residual)
        said = None if watch is None else (lambda i, f, s=count, a=residual, w=watch: w(s + i, a * f))
        steps = min(BASIS, max_iterations - count)
        correction, done = _cycle(product, inverse, (z / norm, h / norm), tolerance / residual, steps, said)
        x = x + norm * correction
        count += done
        h = load - product(x)


def _cycle(
    product: Linear, inverse: Linear, first: tuple[NDArray, NDArray], goal: float, steps: int, watch: Watch | None
) -> tuple[NDArray, int]:
    """Arnoldi's process from a first pair (z, H z) of norm one, until the residual is `goal` of it."""
    Z, duals = [first[0]], [first[1]]
    R = np.zeros((steps + 1, steps), dtype=first[0].dtype)
    g = np.zeros(steps + 1, dtype=first[0].dtype)
    g[0], k, turns = 1.0, 0, []
    while k < steps:
        h = product(Z[k])
        for i, (z, dual) in enumerate(zip(Z, duals, strict=True)):
            R[i, k] = np.vdot(z, h)
            h -= R[i, k] * dual
        z = inverse(h)
        below = _norm(z, h)
        _rotate(R, g, turns, k, below)
        k += 1
        if watch:
            watch(k, float(abs(g[k])))
        if abs(g[k]) <= goal or not below > 0:
            break
        Z.append(z / below)
        duals.append(h / below)
    y = np.linalg.solve(R[:k, :k], g[:k])
    return sum((a * z for a, z in zip(y, Z, strict=False)), np.zeros_like(first[0])), k


def _rotate(R: NDArray, g: NDArray, turns: list[tuple[float, complex]], k: int, below: float) -> None:
    """Givens rotations: the new column of R becomes triangular, and |g[k + 1]| the norm of the residual."""
    for i, (c, s) in enumerate(turns):
        a, b = R[i, k], R[i + 1, k]
        R[i, k], R[i + 1, k] = c * a + np.conj(s) * b, -s * a + c * b
    a = R[k, k]
    length = float(np.hypot(abs(a), below))
    phase = a / abs(a) if abs(a) > 0 else 1.0
    c, s = (abs(a) / length, below / length * np.conj(phase)) if length > 0 else (1.0, 0.0)
    turns.append((c, s))
    R[k, k] = phase * length
    g[k], g[k + 1] = c * g[k], -s * g[k]


def _norm(z: NDArray, dual: NDArray) -> float:
    return float(np.sqrt(max(0.0, np.vdot(z, dual).real)))

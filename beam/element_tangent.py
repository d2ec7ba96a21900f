r"""The tangent of the rod's force: differences at the Gauss points, scattered into the blocks of the chain.

The nine generalised forces at a Gauss point are differenced along q and at once along v = factor q and a = factor_a q, so
that the result is dF/dq + factor dF/dv + factor_a dF/da, the gyroscopic terms with it. An element whose ends lie on two
branches of the rotation vector is differenced as a whole, along its 24 unknowns.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel
from beam.element import DEGREE_SIX, internal_force, on_two_branches

Array = NDArray[np.float64]

STEP = 1e-7


def internal_tangent(
    q: Array, v: Array, a: Array, moving: bool, factor: float, factor_a: float, lengths: Array, x: Array, H: Array,
    w: Array, C: Array, C_damping: Array, E0: Array, m: float, J: Array, mass: Array, D: Array, U: Array, L: Array,
) -> None:  # fmt: skip
    """Add dF/dq + factor dF/dv + factor_a dF/da to the blocks: `D` (n + 1) on, `U` (n) above and `L` (n) below the diagonal."""
    given = (moving, lengths, H, w, C, C_damping, E0, m, J)
    f, S, unused = np.empty((10, lengths.size, w.size, 9)), np.empty_like(E0), np.empty((0, 12))
    for j in range(-1, 9):
        shift = STEP * (np.arange(9) == j)
        internal_force(q, v, a, *given, unused, S, shift, factor, factor_a, f[j])
    rest = add_points(f, q, moving, factor_a, lengths, H, w, m, J, mass, D, U, L)
    if rest:
        for e in [e for e in range(lengths.size) if on_two_branches(q, e)]:
            difference_element(q, v, a, factor, factor_a, e, given, D, U, L)


@kernel
def add_points(
    f: Array, q: Array, moving: bool, factor_a: float, lengths: Array, H: Array, w: Array, m: float, J: Array,
    mass: Array, D: Array, U: Array, L: Array,
) -> int:  # fmt: skip
    """Add the differences of the forces `f` (10, n, points, 9), the last of them not shifted, and the constant mass.

    Elements whose ends lie on two branches are left out; returns how many.
    """
    N, dN, G, rest = np.empty(4), np.empty(4), np.empty((9, 9)), 0
    for e in range(lengths.size):
        if on_two_branches(q, e):
            rest += 1
            continue
        for g in range(w.size):
            for k in range(4):
                N[k] = H[g, k] * (lengths[e] if k % 2 else 1.0)
                dN[k] = H[g, 4 + k] / (1.0 if k % 2 else lengths[e])
            for j in range(9):
                for i in range(9):
                    G[i, j] = (f[j, e, g, i] - f[9, e, g, i]) / STEP
            scatter_tangent(G, e, w[g] * lengths[e], N, dN, D, U, L)
        if moving:
            add_constant_mass(factor_a, e, lengths[e], m, J, mass, D, U, L)
    return rest


def difference_element(
    q: Array, v: Array, a: Array, factor: float, factor_a: float, e: int, given: tuple[Any, ...], D: Array, U: Array,
    L: Array,
) -> None:  # fmt: skip
    """Tangent of one element by differences along its 24 unknowns."""
    Q, V, A = q[e : e + 2].copy(), v[e : e + 2].copy(), a[e : e + 2].copy()
    moving, lengths, H, w, C, C_damping, E0, m, J = given
    rest, none = E0[e : e + 1], np.zeros((0, 0, 0))
    law = (moving, lengths[e : e + 1], H, w, C, C_damping, rest, m, J)

    def force() -> Array:
        F = np.zeros((2, 12))
        internal_force(Q, V, A, *law, F, np.empty_like(rest), np.zeros(9), 0.0, 0.0, none)
        return F

    here = force()
    for column in range(24):
        b, j = divmod(column, 12)
        kept = Q[b, j], V[b, j], A[b, j]
        Q[b, j], V[b, j], A[b, j] = kept[0] + STEP, kept[1] + factor * STEP, kept[2] + factor_a * STEP
        first, second = (force() - here) / STEP
        Q[b, j], V[b, j], A[b, j] = kept
        (D if b == 0 else U)[e, :, j] += first
        (L[e] if b == 0 else D[e + 1])[:, j] += second


@kernel
def add_constant_mass(
    factor: float, e: int, length: float, m: float, J: Array, mass: Array, D: Array, U: Array, L: Array
) -> None:
    """Add factor times the constant part of the mass matrix of element `e` to the blocks."""
    spare = DEGREE_SIX * length * (J[0] + J[1] + J[2]) / 3.0
    for k in range(4):
        for s in range(4):
            a, b, p, r = k // 2, s // 2, 3 * (k % 2), 3 * (s % 2)
            scale = factor * length ** (k % 2 + s % 2)
            line = scale * m * length * mass[k, s]
            turn = scale * spare * (1.0 if k % 2 else 2.0 - 4.0 * a) * (1.0 if s % 2 else 2.0 - 4.0 * b)
            for i in range(3):
                if a == b:
                    D[e + a, p + i, r + i] += line
                    D[e + a, 6 + p + i, 6 + r + i] += turn
                elif a == 0:
                    U[e, p + i, r + i] += line
                    U[e, 6 + p + i, 6 + r + i] += turn
                else:
                    L[e, p + i, r + i] += line
                    L[e, 6 + p + i, 6 + r + i] += turn


@kernel
def scatter_tangent(G: Array, e: int, weight: float, N: Array, dN: Array, D: Array, U: Array, L: Array) -> None:
    """Add P^T G P of one Gauss point, where (theta, theta', r') = P q of the element."""
    column = np.empty(9)
    for b in range(2):
        for j in range(12):
            shape = 2 * b + (j // 3) % 2
            comp = j % 3
            for k in range(9):
                if j < 6:
                    column[k] = weight * G[k, 6 + comp] * dN[shape]
                else:
                    column[k] = weight * (G[k, comp] * N[shape] + G[k, 3 + comp] * dN[shape])
            for a in range(2):
                if a == b:
                    add_column(D, e + a, j, N[2 * a], N[2 * a + 1], dN[2 * a], dN[2 * a + 1], column)
                elif a == 0:
                    add_column(U, e, j, N[0], N[1], dN[0], dN[1], column)
                else:
                    add_column(L, e, j, N[2], N[3], dN[2], dN[3], column)


@kernel
def add_column(blocks: Array, k: int, j: int, n0: float, n1: float, d0: float, d1: float, column: Array) -> None:
    """Add to column `j` of block `k` what nine forces at a Gauss point exert on one node."""
    for i in range(3):
        c0, c3, c6 = column[i], column[3 + i], column[6 + i]
        blocks[k, i, j] += d0 * c6
        blocks[k, 3 + i, j] += d1 * c6
        blocks[k, 6 + i, j] += n0 * c0 + d0 * c3
        blocks[k, 9 + i, j] += n1 * c0 + d1 * c3


@kernel
def add_mass(
    factor: float, lengths: Array, w: Array, H: Array, m: float, J: Array, mass: Array, D: Array, U: Array, L: Array
) -> None:
    """Add factor times the mass matrix of unturned sections (T = I) to the blocks."""
    N, dN, G = np.empty(4), np.zeros(4), np.zeros((9, 9))
    for i in range(3):
        G[i, i] = factor * J[i]
    for e in range(lengths.size):
        add_constant_mass(factor, e, lengths[e], m, J, mass, D, U, L)
        for g in range(w.size):
            for k in range(4):
                N[k] = H[g, k] * lengths[e] ** (k % 2)
            scatter_tangent(G, e, w[g] * lengths[e], N, dN, D, U, L)

r"""The tangent of the rod's force: differences at the Gauss points, scattered into the blocks of the chain.

The nine generalised forces at a Gauss point are differenced along q and at once along v = factor q and a = factor_a q, so
that the result is dF/dq + factor dF/dv + factor_a dF/da, the gyroscopic terms with it. An element whose ends lie on two
branches of the rotation vector is differenced as a whole, along its 24 unknowns.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import inlined, kernel
from beam.element import DEGREE_SIX, gather, internal_force, on_two_branches
from beam.hermite import hermite
from beam.strain import gauss_force, rotary_inertia

Array = NDArray[np.float64]

STEP = 1e-7


@inlined
def point_tangent(  # noqa: C901 - loops over components
    z: Array, zdot: Array, acc: Array, moving: bool, factor: float, factor_a: float, C: Array, C_damping: Array,
    E0: Array, J: Array, room: Array, G: Array,
) -> None:  # fmt: skip
    """Write the derivative of the nine forces by (theta, theta', r') into `G` (9, 9); `room` (7, 9) is work space."""
    E, rate, S, here, ahead, still, turning = room[0], room[1], room[2], room[3], room[4], room[5], room[6]
    for j in range(-1, 9):
        zj, sj, aj = z[max(j, 0)], zdot[max(j, 0)], acc[min(max(j, 0), 2)]
        if j >= 0:
            z[j], zdot[j] = zj + STEP, sj + factor * STEP
        gauss_force(z, zdot, C, C_damping, E0, E, rate, S, ahead)
        for i in range(9):
            turning[i] = 0.0
        if moving and j < 3:
            if j >= 0:
                acc[j] = aj + factor_a * STEP
            rotary_inertia(z, zdot, acc, J, turning)
        if j < 0:
            for i in range(9):
                here[i], still[i] = ahead[i], turning[i]
            continue
        z[j], zdot[j] = zj, sj
        if j < 3:
            acc[j] = aj
        for i in range(9):
            G[i, j] = (ahead[i] - here[i]) / STEP
            if j < 3:
                G[i, j] += (turning[i] - still[i]) / STEP


def internal_tangent(
    q: Array, v: Array, a: Array, moving: bool, factor: float, factor_a: float, lengths: Array, x: Array, H: Array,
    w: Array, C: Array, C_damping: Array, E0: Array, m: float, J: Array, mass: Array, D: Array, U: Array, L: Array,
) -> None:  # fmt: skip
    """Add dF/dq + factor dF/dv + factor_a dF/da to the blocks: `D` (n + 1) on, `U` (n) above and `L` (n) below the diagonal."""
    given = (w, C, C_damping, E0, m, J, mass, D, U, L)
    rest = tangent_on_one_branch(q, v, a, moving, factor, factor_a, lengths, x, H, *given)
    if rest:
        for e in [e for e in range(lengths.size) if on_two_branches(q, e)]:
            difference_element(q, v, a, moving, factor, factor_a, e, lengths, H, *given)


@kernel
def tangent_on_one_branch(
    q: Array, v: Array, a: Array, moving: bool, factor: float, factor_a: float, lengths: Array, x: Array, H: Array,
    w: Array, C: Array, C_damping: Array, E0: Array, m: float, J: Array, mass: Array, D: Array, U: Array, L: Array,
) -> int:  # fmt: skip
    """:func:`internal_tangent` of the elements whose ends lie on one branch; returns how many are left."""
    N, dN, Nz, rest = np.empty(4), np.empty(4), np.empty(12), 0
    z, zdot, acc, G, room = np.empty(9), np.empty(9), np.zeros(3), np.empty((9, 9)), np.empty((7, 9))
    for e in range(lengths.size):
        if on_two_branches(q, e):
            rest += 1
            continue
        for g in range(x.size):
            hermite(x[g], lengths[e], N, dN)
            gather(q, e, H, g, lengths[e], z)
            gather(v, e, H, g, lengths[e], zdot)
            if moving:
                gather(a, e, H, g, lengths[e], Nz)
                for i in range(3):
                    acc[i] = Nz[i]
            point_tangent(z, zdot, acc, moving, factor, factor_a, C, C_damping, E0[e, g], J, room, G)
            scatter_tangent(G, e, w[g] * lengths[e], N, dN, D, U, L)
        if moving:
            add_constant_mass(factor_a, e, lengths[e], m, J, mass, D, U, L)
    return rest


def difference_element(
    q: Array, v: Array, a: Array, moving: bool, factor: float, factor_a: float, e: int, lengths: Array, H: Array,
    w: Array, C: Array, C_damping: Array, E0: Array, m: float, J: Array, mass: Array, D: Array, U: Array, L: Array,
) -> None:  # fmt: skip
    """Tangent of one element by differences along its 24 unknowns."""
    Q, V, A = q[e : e + 2].copy(), v[e : e + 2].copy(), a[e : e + 2].copy()
    rest = E0[e : e + 1]
    given = (moving, True, lengths[e : e + 1], H, w, C, C_damping, rest, m, J, mass)
    here, S = np.zeros((2, 12)), np.zeros_like(rest)
    internal_force(Q, V, A, *given, here, S)
    for column in range(24):
        b, j = divmod(column, 12)
        kept = Q[b, j], V[b, j], A[b, j]
        Q[b, j], V[b, j], A[b, j] = kept[0] + STEP, kept[1] + factor * STEP, kept[2] + factor_a * STEP
        ahead = np.zeros((2, 12))
        internal_force(Q, V, A, *given, ahead, S)
        Q[b, j], V[b, j], A[b, j] = kept
        first, second = (ahead - here) / STEP
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

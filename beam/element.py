r"""Sums over the elements: internal force, its tangent, inertia.

A node carries q = (r, r', theta, theta'), twelve numbers; an element couples two nodes. Three Gauss points are used: two
leave the element singular, four make short rods slightly stiff. The tangent is the central difference of the nine
generalised forces at the Gauss point along q and, at once, along v = factor * q, so that it is dF/dq + factor dF/dv.
The mass matrix is consistent and constant: exact for the centre line; for the rotary inertia it is
J (theta_dot . theta_dot), exact for turning about one fixed axis, without gyroscopic terms.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel
from beam.hermite import hermite
from beam.strain import gauss_force, strain

Array = NDArray[np.float64]

DOF = 12
"""Unknowns of a node: r (0:3), r' (3:6), theta (6:9), theta' (9:12)."""


@kernel
def gather(q: Array, e: int, N: Array, dN: Array, z: Array) -> None:
    """Write (theta, theta', r') at a point of element `e` into `z` (9,)."""
    for i in range(3):
        z[i] = N[0] * q[e, 6 + i] + N[1] * q[e, 9 + i] + N[2] * q[e + 1, 6 + i] + N[3] * q[e + 1, 9 + i]
        z[3 + i] = dN[0] * q[e, 6 + i] + dN[1] * q[e, 9 + i] + dN[2] * q[e + 1, 6 + i] + dN[3] * q[e + 1, 9 + i]
        z[6 + i] = dN[0] * q[e, i] + dN[1] * q[e, 3 + i] + dN[2] * q[e + 1, i] + dN[3] * q[e + 1, 3 + i]


@kernel
def reference_strains(q: Array, lengths: Array, x: Array, E0: Array) -> None:
    """Write the strains of the shape `q` (n + 1, 12) at the Gauss points `x` into `E0` (n, 3, 6)."""
    N, dN, z = np.empty(4), np.empty(4), np.empty(9)
    for e in range(lengths.size):
        for g in range(x.size):
            hermite(x[g], lengths[e], N, dN)
            gather(q, e, N, dN, z)
            strain(z, E0[e, g])


@kernel
def internal_force(
    q: Array, v: Array, lengths: Array, x: Array, w: Array, C: Array, C_damping: Array, E0: Array, F: Array, S: Array
) -> tuple[float, float]:
    """Add the internal force to `F` (n + 1, 12) and write the section forces into `S` (n, 3, 6).

    Returns the elastic energy [J] and the power lost in damping [W].
    """
    N, dN = np.empty(4), np.empty(4)
    z, zdot, f = np.empty(9), np.empty(9), np.empty(9)
    E, rate = np.empty(6), np.empty(6)
    energy = 0.0
    power = 0.0
    for e in range(lengths.size):
        for g in range(x.size):
            hermite(x[g], lengths[e], N, dN)
            gather(q, e, N, dN, z)
            gather(v, e, N, dN, zdot)
            stored, lost = gauss_force(z, zdot, C, C_damping, E0[e, g], E, rate, S[e, g], f)
            weight = w[g] * lengths[e]
            energy += weight * stored
            power += weight * lost
            for a in range(2):
                for i in range(3):
                    F[e + a, i] += weight * dN[2 * a] * f[6 + i]
                    F[e + a, 3 + i] += weight * dN[2 * a + 1] * f[6 + i]
                    F[e + a, 6 + i] += weight * (N[2 * a] * f[i] + dN[2 * a] * f[3 + i])
                    F[e + a, 9 + i] += weight * (N[2 * a + 1] * f[i] + dN[2 * a + 1] * f[3 + i])
    return energy, power


@kernel
def internal_tangent(
    q: Array, v: Array, factor: float, lengths: Array, x: Array, w: Array,
    C: Array, C_damping: Array, E0: Array, D: Array, U: Array, L: Array,
) -> None:  # fmt: skip
    """Add dF/dq + factor dF/dv to the blocks: `D` (n + 1) on, `U` (n) above and `L` (n) below the diagonal."""
    step = 1e-6
    N, dN = np.empty(4), np.empty(4)
    z, zdot, plus, minus = np.empty(9), np.empty(9), np.empty(9), np.empty(9)
    E, rate, S = np.empty(6), np.empty(6), np.empty(6)
    G = np.empty((9, 9))
    for e in range(lengths.size):
        for g in range(x.size):
            hermite(x[g], lengths[e], N, dN)
            gather(q, e, N, dN, z)
            gather(v, e, N, dN, zdot)
            for j in range(9):
                zj, sj = z[j], zdot[j]
                z[j], zdot[j] = zj + step, sj + factor * step
                gauss_force(z, zdot, C, C_damping, E0[e, g], E, rate, S, plus)
                z[j], zdot[j] = zj - step, sj - factor * step
                gauss_force(z, zdot, C, C_damping, E0[e, g], E, rate, S, minus)
                z[j], zdot[j] = zj, sj
                for i in range(9):
                    G[i, j] = (plus[i] - minus[i]) / (2.0 * step)
            scatter_tangent(G, e, w[g] * lengths[e], N, dN, D, U, L)


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
                block = D[e + a] if a == b else (U[e] if a == 0 else L[e])
                for i in range(3):
                    block[i, j] += dN[2 * a] * column[6 + i]
                    block[3 + i, j] += dN[2 * a + 1] * column[6 + i]
                    block[6 + i, j] += N[2 * a] * column[i] + dN[2 * a] * column[3 + i]
                    block[9 + i, j] += N[2 * a + 1] * column[i] + dN[2 * a + 1] * column[3 + i]


@kernel
def inertia_force(a: Array, masses: Array, m: float, J: Array, F: Array) -> None:
    """Add M a to `F`, all (n + 1, 12); `masses` (n, 4, 4) are the integrals of N N^T, `m` kg/m, `J` (3,) kg m."""
    for e in range(masses.shape[0]):
        for k in range(4):
            for s in range(4):
                for i in range(3):
                    row, slot = e + k // 2, 3 * (k % 2) + i
                    F[row, slot] += m * masses[e, k, s] * a[e + s // 2, 3 * (s % 2) + i]
                    F[row, 6 + slot] += J[i] * masses[e, k, s] * a[e + s // 2, 6 + 3 * (s % 2) + i]


@kernel
def add_mass(factor: float, masses: Array, m: float, J: Array, D: Array, U: Array, L: Array) -> None:
    """Add factor M to the blocks."""
    for e in range(masses.shape[0]):
        for k in range(4):
            for s in range(4):
                a, b = k // 2, s // 2
                block = D[e + a] if a == b else (U[e] if a == 0 else L[e])
                for i in range(3):
                    block[3 * (k % 2) + i, 3 * (s % 2) + i] += factor * m * masses[e, k, s]
                    block[6 + 3 * (k % 2) + i, 6 + 3 * (s % 2) + i] += factor * J[i] * masses[e, k, s]

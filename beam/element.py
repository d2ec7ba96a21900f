r"""Sums over the elements: internal force, its tangent, inertia.

A node carries q = (r, r', theta, theta'), twelve numbers; an element couples two nodes. Three Gauss points are used: two
leave the element singular, four make short rods slightly stiff. The tangent is the forward difference of the nine
generalised forces at the Gauss point along q and, at once, along v = factor * q, so that it is dF/dq + factor dF/dv; with
a step of 1e-7 it is exact to about 1e-7 of the stiffness, more than a Newton iteration can use.
The mass matrix is consistent and constant: exact for the centre line; for the rotary inertia it is
J (theta_dot . theta_dot), exact for turning about one fixed axis, without gyroscopic terms.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel
from beam.hermite import hermite
from beam.rotation_vector import rotation_coefficients
from beam.strain import gauss_force, strain

Array = NDArray[np.float64]

DOF = 12
"""Unknowns of a node: r (0:3), r' (3:6), theta (6:9), theta' (9:12)."""


@kernel
def gather(q: Array, e: int, N: Array, dN: Array, z: Array) -> None:
    """Write (theta, theta', r') at a point of element `e` into `z` (9,)."""
    n0, n1, n2, n3 = N[0], N[1], N[2], N[3]
    d0, d1, d2, d3 = dN[0], dN[1], dN[2], dN[3]
    for i in range(3):
        a, b, c, d = q[e, 6 + i], q[e, 9 + i], q[e + 1, 6 + i], q[e + 1, 9 + i]
        z[i] = n0 * a + n1 * b + n2 * c + n3 * d
        z[3 + i] = d0 * a + d1 * b + d2 * c + d3 * d
        z[6 + i] = d0 * q[e, i] + d1 * q[e, 3 + i] + d2 * q[e + 1, i] + d3 * q[e + 1, 3 + i]


@kernel
def reference_strains(q: Array, lengths: Array, x: Array, E0: Array) -> None:
    """Write the strains of the shape `q` (n + 1, 12) at the Gauss points `x` into `E0` (n, 3, 6)."""
    N, dN, z = np.empty(4), np.empty(4), np.empty(9)
    for e in range(lengths.size):
        for g in range(x.size):
            hermite(x[g], lengths[e], N, dN)
            gather(q, e, N, dN, z)
            a, b, c, _, _ = rotation_coefficients(z[0] * z[0] + z[1] * z[1] + z[2] * z[2])
            strain(z, a, b, c, E0[e, g])


@kernel
def internal_force(
    q: Array, v: Array, lengths: Array, x: Array, w: Array, C: Array, C_damping: Array, E0: Array, F: Array, S: Array
) -> tuple[float, float]:
    """Add the internal force to `F` (n + 1, 12) and write the section forces into `S` (n, 3, 6).

    Returns the elastic energy [J] and the power lost in damping [W].
    """
    N, dN = np.empty(4), np.empty(4)
    z, zdot, f = np.empty(9), np.empty(9), np.empty(9)
    E, rate, rest, section = np.empty(6), np.empty(6), np.empty(6), np.empty(6)
    energy = 0.0
    power = 0.0
    for e in range(lengths.size):
        for g in range(x.size):
            hermite(x[g], lengths[e], N, dN)
            gather(q, e, N, dN, z)
            gather(v, e, N, dN, zdot)
            for i in range(6):
                rest[i] = E0[e, g, i]
            stored, lost = gauss_force(z, zdot, C, C_damping, rest, E, rate, section, f)
            for i in range(6):
                S[e, g, i] = section[i]
            weight = w[g] * lengths[e]
            energy += weight * stored
            power += weight * lost
            for a in range(2):
                n0, n1 = weight * N[2 * a], weight * N[2 * a + 1]
                d0, d1 = weight * dN[2 * a], weight * dN[2 * a + 1]
                for i in range(3):
                    f0, f3, f6 = f[i], f[3 + i], f[6 + i]
                    F[e + a, i] += d0 * f6
                    F[e + a, 3 + i] += d1 * f6
                    F[e + a, 6 + i] += n0 * f0 + d0 * f3
                    F[e + a, 9 + i] += n1 * f0 + d1 * f3
    return energy, power


@kernel
def internal_tangent(
    q: Array, v: Array, factor: float, lengths: Array, x: Array, w: Array,
    C: Array, C_damping: Array, E0: Array, D: Array, U: Array, L: Array,
) -> None:  # fmt: skip
    """Add dF/dq + factor dF/dv to the blocks: `D` (n + 1) on, `U` (n) above and `L` (n) below the diagonal."""
    step = 1e-7
    N, dN = np.empty(4), np.empty(4)
    z, zdot, here, ahead = np.empty(9), np.empty(9), np.empty(9), np.empty(9)
    E, rate, S, rest = np.empty(6), np.empty(6), np.empty(6), np.empty(6)
    G = np.empty((9, 9))
    for e in range(lengths.size):
        for g in range(x.size):
            hermite(x[g], lengths[e], N, dN)
            gather(q, e, N, dN, z)
            gather(v, e, N, dN, zdot)
            for i in range(6):
                rest[i] = E0[e, g, i]
            gauss_force(z, zdot, C, C_damping, rest, E, rate, S, here)
            for j in range(9):
                zj, sj = z[j], zdot[j]
                z[j], zdot[j] = zj + step, sj + factor * step
                gauss_force(z, zdot, C, C_damping, rest, E, rate, S, ahead)
                z[j], zdot[j] = zj, sj
                for i in range(9):
                    G[i, j] = (ahead[i] - here[i]) / step
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

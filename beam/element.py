r"""Sums over the elements: internal force, its tangent, inertia.

A node carries q = (r, r', theta, theta'), twelve numbers; an element couples two nodes. Three Gauss points are used: two
leave the element singular, four make short rods slightly stiff. The tangent is the forward difference of the nine
generalised forces at the Gauss point along q and, at once, along v = factor * q (and the accelerations), so that it is
dF/dq + factor dF/dv; with a step of 1e-7 it is exact to about 1e-7 of the stiffness, more than a Newton iteration can use.

Rotation vectors of the two ends may lie on different branches (:mod:`beam.rotation_vector`): the second node's is taken to
the branch of the first before interpolating, and the force on it is taken back.

Inertia is consistent: :math:`m \int N N^T ds\,\ddot r` for the centre line, and for the section, whose inertia J is constant
in its own turning axes,

.. math:: f_\theta = T^T (J\dot\omega + \omega\times J\omega), \qquad \omega = T\dot\theta, \quad
          \dot\omega = T\ddot\theta + \dot T\dot\theta ,

with the gyroscopic moment. The Gauss points integrate it to degree five; the missing term of degree six of N N^T, of rank
one, is added with the mean of J, so that no motion of a node is without inertia.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import embedded, kernel
from beam.hermite import hermite, hermite_mass
from beam.point_force import (
    DAMP,
    END,
    ENERGY,
    FORCE,
    LANES,
    LENGTH,
    NODAL,
    REST,
    ROW,
    SECTION,
    SHIFT,
    STIFF,
    point_forces,
)
from beam.rotation_vector import accelerate_on_branch, force_on_branch, move_on_branch, rotation_coefficients
from beam.strain import strain

Array = NDArray[np.float64]

DOF = 12
"""Unknowns of a node: r (0:3), r' (3:6), theta (6:9), theta' (9:12)."""

UNIT_MASS = hermite_mass(1.0)
"""Integral of N N^T over an element of length one."""
CUBIC = np.array([2.0, 1.0, -2.0, 1.0])
"""Coefficients of x^3 in N."""
DEGREE_SIX = 1.0 / 2800.0
"""Integral of x^6 over [0, 1] minus its value by three Gauss points."""


@kernel
def unit_shapes(x: Array) -> Array:
    """N (0:4) and dN/dx (4:8) of an element of length one at the points `x`, shape (points, 8)."""
    H = np.empty((x.size, 8))
    for g in range(x.size):
        hermite(x[g], 1.0, H[g, 0:4], H[g, 4:8])
    return H


@kernel
def on_two_branches(q: Array, e: int) -> bool:
    """True if the rotation vectors at the ends differ by more than half a turn, and less on the other branch."""
    b0, b1, b2 = q[e + 1, 6], q[e + 1, 7], q[e + 1, 8]
    d0, d1, d2 = q[e, 6] - b0, q[e, 7] - b1, q[e, 8] - b2
    far = d0 * d0 + d1 * d1 + d2 * d2
    if far < np.pi * np.pi:
        return False
    shift = 2.0 * np.pi / max(np.sqrt(b0 * b0 + b1 * b1 + b2 * b2), 1e-9)
    d0, d1, d2 = d0 + shift * b0, d1 + shift * b1, d2 + shift * b2
    return d0 * d0 + d1 * d1 + d2 * d2 < far


@kernel
def copy_ends(q: Array, e: int, ends: Array) -> None:
    """Copy both nodes of element `e` into `ends` (2, 12)."""
    for i in range(2):
        for k in range(12):
            ends[i, k] = q[e + i, k]


@kernel
def shape_on_one_branch(q: Array, e: int, ends: Array) -> None:
    """Copy the nodes of element `e` into `ends` (2, 12), both on the branch of the first."""
    copy_ends(q, e, ends)
    if on_two_branches(q, e):
        still = np.zeros((2, 3))
        move_on_branch(ends[1, 6:9], ends[1, 9:12], still[0], still[1])


@kernel
def gather(q: Array, k: int, H: Array, g: int, length: float, z: Array) -> None:
    """Write (theta, theta', r') at Gauss point `g` between the nodes `k` and k + 1 into `z` (9,)."""
    n1, n3, d0 = H[g, 1] * length, H[g, 3] * length, H[g, 4] / length
    for i in range(3):
        z[i] = H[g, 0] * q[k, 6 + i] + n1 * q[k, 9 + i] + (H[g, 2] * q[k + 1, 6 + i] + n3 * q[k + 1, 9 + i])
        z[3 + i] = d0 * (q[k, 6 + i] - q[k + 1, 6 + i]) + (H[g, 5] * q[k, 9 + i] + H[g, 7] * q[k + 1, 9 + i])
        z[6 + i] = d0 * (q[k, i] - q[k + 1, i]) + (H[g, 5] * q[k, 3 + i] + H[g, 7] * q[k + 1, 3 + i])


@kernel
def scatter(f: Array, k: int, H: Array, g: int, length: float, weight: float, F: Array) -> None:
    """Add weight length times the nine forces `f` on (theta, theta', r') to the nodes `k` and k + 1 of `F`."""
    for a in range(2):
        n0, n1 = weight * length * H[g, 2 * a], weight * length * length * H[g, 2 * a + 1]
        d0, d1 = weight * H[g, 4 + 2 * a], weight * length * H[g, 5 + 2 * a]
        for i in range(3):
            F[k + a, i] += d0 * f[6 + i]
            F[k + a, 3 + i] += d1 * f[6 + i]
            F[k + a, 6 + i] += n0 * f[i] + d0 * f[3 + i]
            F[k + a, 9 + i] += n1 * f[i] + d1 * f[3 + i]


@kernel
def reference_strains(q: Array, lengths: Array, x: Array, E0: Array) -> None:
    """Write the strains of the shape `q` (n + 1, 12) at the Gauss points `x` into `E0` (n, 3, 6)."""
    H, ends, z = unit_shapes(x), np.empty((2, 12)), np.empty(9)
    for e in range(lengths.size):
        shape_on_one_branch(q, e, ends)
        for g in range(x.size):
            gather(ends, 0, H, g, lengths[e], z)
            a, b, c, _, _ = rotation_coefficients(z[0] * z[0] + z[1] * z[1] + z[2] * z[2])
            strain(z, a, b, c, E0[e, g])


@embedded
def element_inertia(
    W: Array, k: int, length: float, m: float, spare: float
) -> tuple[float, float, float, float, float, float]:
    """Forces on r and r' of both nodes and the one of degree six that belong to the accelerations at `k`; their power."""
    x0, x1, x2, x3 = W[k], length * W[k + 48], W[k + 1], length * W[k + 49]
    turn = 2.0 * (W[k + 96] - W[k + 97]) + length * (W[k + 144] + W[k + 145])
    M = UNIT_MASS
    f0 = m * length * (M[0, 0] * x0 + M[0, 1] * x1 + (M[0, 2] * x2 + M[0, 3] * x3))
    f1 = m * length * (M[1, 0] * x0 + M[1, 1] * x1 + (M[1, 2] * x2 + M[1, 3] * x3))
    f2 = m * length * (M[2, 0] * x0 + M[2, 1] * x1 + (M[2, 2] * x2 + M[2, 3] * x3))
    f3 = m * length * (M[3, 0] * x0 + M[3, 1] * x1 + (M[3, 2] * x2 + M[3, 3] * x3))
    f = spare * length * turn
    return f0, length * f1, f2, length * f3, f, (f0 * x0 + f1 * x1) + (f2 * x2 + f3 * x3) + f * turn


@embedded
def add_inertia(W: Array, m: float, spare: float) -> None:
    """Add the constant part of the inertia of eight elements: the centre line's, and `spare` times degree six of the section's.

    The kinetic energy grows by the same part. `m` is the mass per length.
    """
    for i in range(3):
        for l in range(LANES):
            k, at, length = ROW * i + l, NODAL + LANES * i + l, W[LENGTH + l]
            _, _, _, _, _, twice = element_inertia(W, k + 12 * ROW, length, m, spare)
            f0, f1, f2, f3, f, _ = element_inertia(W, k + 24 * ROW, length, m, spare)
            W[ENERGY + 2 * LANES + l] += 0.5 * twice
            W[at] += f0
            W[at + 24] += f1
            W[at + 48] += 2.0 * f
            W[at + 72] += length * f
            W[at + 96] += f2
            W[at + 120] += f3
            W[at + 144] -= 2.0 * f
            W[at + 168] += length * f


@embedded
def load_node(q: Array, v: Array, a: Array, node: int, l: int, W: Array) -> None:
    """Copy a node into place `l`."""
    for k in range(12):
        W[ROW * k + l] = q[node, k]
        W[ROW * (12 + k) + l] = v[node, k]
        W[ROW * (24 + k) + l] = a[node, k]


@kernel
def load_moved_node(q: Array, v: Array, a: Array, node: int, moving: bool, W: Array, room: Array) -> None:
    """Copy a node on its other branch into place 1."""
    for k in range(12):
        room[0, k], room[1, k], room[2, k] = q[node, k], v[node, k], a[node, k]
    theta, slope, rate, slope_rate = room[0, 6:9], room[0, 9:12], room[1, 6:9], room[1, 9:12]
    if moving:
        accelerate_on_branch(theta, slope, rate, slope_rate, room[2, 6:9], room[2, 9:12])
    move_on_branch(theta, slope, rate, slope_rate)
    load_node(room[0:1], room[1:2], room[2:3], 0, 1, W)


@embedded
def elements_together(q: Array, begin: int, n: int) -> tuple[int, bool]:
    """How many elements from `begin` on are worked on at once: eight, fewer before the end of the rod and before an element
    on two branches, which is alone; True if it is such a one.
    """
    for count in range(min(LANES, n - begin)):
        if on_two_branches(q, begin + count):
            return max(count, 1), count == 0
    return min(LANES, n - begin), False


@embedded
def empty_lanes(W: Array, C: Array, C_damping: Array, shift: Array) -> None:
    """Begin a work array of :func:`beam.point_force.point_forces`: the section's law, a shift of (theta, theta', r')."""
    for i in range(W.size):
        W[i] = 0.0
    for l in range(LANES):
        for i in range(6):
            for j in range(6):
                k = LANES * (6 * i + j) + l
                W[STIFF + k], W[DAMP + k] = C[i, j], C_damping[i, j]
        for i in range(9):
            W[SHIFT + LANES * i + l] = shift[i]
        W[LENGTH + l], W[LENGTH + LANES + l] = 1.0, 1.0


@kernel
def internal_force(  # noqa: C901 - loops over lanes and components
    q: Array, v: Array, a: Array, moving: bool, lengths: Array, H: Array, w: Array, C: Array, C_damping: Array,
    E0: Array, m: float, J: Array, F: Array, S: Array, shift: Array, factor: float, factor_a: float, f: Array,
) -> tuple[float, float, float]:  # fmt: skip
    """Add the internal force, and the inertia if `moving`, to `F` (n + 1, 12); write the section forces into `S` (n, 3, 6).

    `H` from :func:`unit_shapes`, `w` weights; an empty `S` is left alone. If `f` (n, 3, 9) is not empty, it receives the nine
    forces at the Gauss points instead, with (theta, theta', r') moved by `shift` (9,), their velocities by `factor` and
    accelerations by `factor_a` times that. Returns the elastic energy [J], the power lost in damping [W] and the kinetic
    energy [J].
    """
    n, nodal, unit, begin = lengths.size, f.size == 0, 1.0 if moving else 0.0, 0
    W, room = np.empty(END), np.empty((3, 12))
    empty_lanes(W, C, C_damping, shift)
    spare = unit * DEGREE_SIX * (J[0] + J[1] + J[2]) / 3.0
    energy, power, kinetic = 0.0, 0.0, 0.0
    curved = np.any(E0)
    while begin < n:
        count, moved = elements_together(q, begin, n)
        for l in range(count):
            load_node(q, v, a, begin + l, l, W)
            W[LENGTH + l], W[LENGTH + LANES + l] = lengths[begin + l], 1.0 / lengths[begin + l]
        if moved:
            load_moved_node(q, v, a, begin + 1, moving, W, room)
        else:
            load_node(q, v, a, begin + count, count, W)
        for i in range(NODAL, END):
            W[i] = 0.0
        for g in range(w.size):
            if curved:
                for l in range(count):
                    for i in range(6):
                        W[REST + LANES * i + l] = E0[begin + l, g, i]
            point_forces(W, H, g, w[g], unit * J[0], unit * J[1], unit * J[2], factor, factor_a)
            if S.size > 0:
                for l in range(count):
                    for i in range(6):
                        S[begin + l, g, i] = W[SECTION + LANES * i + l]
            if not nodal:
                for l in range(count):
                    for i in range(9):
                        f[begin + l, g, i] = W[FORCE + LANES * i + l]
        if moving:
            add_inertia(W, m, spare)
        for l in range(count):
            energy += W[ENERGY + l]
            power += W[ENERGY + LANES + l]
            kinetic += W[ENERGY + 2 * LANES + l]
        if nodal:
            add_nodes(q, begin, count, moved, W, room, F)
        begin += count
    return energy, power, kinetic


@embedded
def add_nodes(q: Array, begin: int, count: int, moved: bool, W: Array, room: Array, F: Array) -> None:
    """Add the forces on the nodes of `count` elements to `F`; if the second node was `moved`, its forces come back first."""
    if moved:
        for k in range(12):
            room[0, k] = W[NODAL + LANES * (12 + k)]
        force_on_branch(q[begin + 1, 6:9], q[begin + 1, 9:12], room[0, 6:9], room[0, 9:12])
        for k in range(12):
            W[NODAL + LANES * (12 + k)] = room[0, k]
    for l in range(count):
        for k in range(12):
            F[begin + l, k] += W[NODAL + LANES * k + l]
            F[begin + l + 1, k] += W[NODAL + LANES * (12 + k) + l]

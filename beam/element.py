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

from beam.compiled import inlined, kernel
from beam.hermite import hermite, hermite_mass
from beam.point_force import interpolate, point_force, rotary_force
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
    z[0], z[1], z[2], z[3], z[4], z[5], z[6], z[7], z[8] = interpolate(q, k, H, g, length)


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


@kernel
def add_inertia(a: Array, k: int, length: float, m: float, J: Array, mass: Array, F: Array) -> None:
    """Add the constant part of the inertia between the nodes `k` and k + 1: the centre line's, and degree six of the section's."""
    spare = DEGREE_SIX * length * (J[0] + J[1] + J[2]) / 3.0
    for i in range(3):
        for s in range(2):
            row, line = 3 * s + i, m * length * (length if s == 1 else 1.0)
            F[k, row] += line * (
                (mass[s, 0] * a[k, i] + mass[s, 2] * a[k + 1, i])
                + length * (mass[s, 1] * a[k, 3 + i] + mass[s, 3] * a[k + 1, 3 + i])
            )
            F[k + 1, row] += line * (
                (mass[2 + s, 0] * a[k, i] + mass[2 + s, 2] * a[k + 1, i])
                + length * (mass[2 + s, 1] * a[k, 3 + i] + mass[2 + s, 3] * a[k + 1, 3 + i])
            )
        f = spare * (2.0 * (a[k, 6 + i] - a[k + 1, 6 + i]) + length * (a[k, 9 + i] + a[k + 1, 9 + i]))
        F[k, 6 + i] += 2.0 * f
        F[k, 9 + i] += length * f
        F[k + 1, 6 + i] -= 2.0 * f
        F[k + 1, 9 + i] += length * f


@inlined
def element_force(
    q: Array, v: Array, a: Array, k: int, moving: bool, damped: bool, e: int, length: float, H: Array, w: Array,
    C: Array, C_damping: Array, E0: Array, m: float, J: Array, mass: Array, F: Array, S: Array,
) -> tuple[float, float, float]:  # fmt: skip
    """Add the forces of element `e`, whose nodes are `k` and k + 1, to `F`, with inertia if it is `moving`; write `S`[e].

    Returns the elastic energy [J], the power lost in damping [W] and the kinetic energy of turning [J].
    """
    energy, power, kinetic = 0.0, 0.0, 0.0
    s0, s1, s2, w0, w1, w2, v0, v1, v2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for g in range(w.size):
        t0, t1, t2, u0, u1, u2, d0, d1, d2 = interpolate(q, k, H, g, length)
        if moving or damped:
            s0, s1, s2, w0, w1, w2, v0, v1, v2 = interpolate(v, k, H, g, length)
        ca, cb, cc, db, dc = rotation_coefficients(t0 * t0 + t1 * t1 + t2 * t2)
        stored, lost, f0, f1, f2, f3, f4, f5, f6, f7, f8 = point_force(
            t0, t1, t2, u0, u1, u2, d0, d1, d2, s0, s1, s2, w0, w1, w2, v0, v1, v2,
            ca, cb, cc, db, dc, C, C_damping, E0, e, g, damped, S,
        )  # fmt: skip
        if moving:
            turning, i0, i1, i2 = rotary_force(t0, t1, t2, s0, s1, s2, cb, cc, db, dc, a, k, H, g, length, J)
            f0, f1, f2 = f0 + i0, f1 + i1, f2 + i2
            kinetic += w[g] * length * turning
        weight = w[g] * length
        energy += weight * stored
        power += weight * lost
        for i in range(2):
            n0, n1 = weight * H[g, 2 * i], weight * length * H[g, 2 * i + 1]
            c0, c1 = w[g] * H[g, 4 + 2 * i], weight * H[g, 5 + 2 * i]
            F[k + i, 0] += c0 * f6
            F[k + i, 1] += c0 * f7
            F[k + i, 2] += c0 * f8
            F[k + i, 3] += c1 * f6
            F[k + i, 4] += c1 * f7
            F[k + i, 5] += c1 * f8
            F[k + i, 6] += n0 * f0 + c0 * f3
            F[k + i, 7] += n0 * f1 + c0 * f4
            F[k + i, 8] += n0 * f2 + c0 * f5
            F[k + i, 9] += n1 * f0 + c1 * f3
            F[k + i, 10] += n1 * f1 + c1 * f4
            F[k + i, 11] += n1 * f2 + c1 * f5
    if moving:
        add_inertia(a, k, length, m, J, mass, F)
    return energy, power, kinetic


@kernel
def move_element(q: Array, v: Array, a: Array, e: int, moving: bool, room: Array) -> None:
    """Copy the nodes of element `e`, both on the branch of the first, into `room` (4, 2, 12); the last part is emptied."""
    copy_ends(q, e, room[0])
    copy_ends(v, e, room[1])
    copy_ends(a, e, room[2])
    theta, slope, rate, slope_rate = room[0, 1, 6:9], room[0, 1, 9:12], room[1, 1, 6:9], room[1, 1, 9:12]
    if moving:
        accelerate_on_branch(theta, slope, rate, slope_rate, room[2, 1, 6:9], room[2, 1, 9:12])
    move_on_branch(theta, slope, rate, slope_rate)
    room[3] = 0.0


@kernel
def return_force(q: Array, e: int, P: Array, F: Array) -> None:
    """Add the forces `P` (2, 12) of an element whose second node was moved to the other branch to `F`."""
    force_on_branch(q[e + 1, 6:9], q[e + 1, 9:12], P[1, 6:9], P[1, 9:12])
    for i in range(2):
        for k in range(12):
            F[e + i, k] += P[i, k]


@kernel
def internal_force(
    q: Array, v: Array, a: Array, moving: bool, damped: bool, lengths: Array, H: Array, w: Array, C: Array,
    C_damping: Array, E0: Array, m: float, J: Array, mass: Array, F: Array, S: Array,
) -> tuple[float, float, float]:  # fmt: skip
    """Add the internal force, and the inertia if `moving`, to `F` (n + 1, 12); write the section forces into `S` (n, 3, 6).

    `H` from :func:`unit_shapes`, `w` weights, `mass` is :data:`UNIT_MASS`; damping is left out unless `damped`.
    Returns the elastic energy [J], the power lost in damping [W] and the kinetic energy of turning [J] (without
    degree six).
    """
    room = np.zeros((4, 2, 12))
    energy, power, kinetic = 0.0, 0.0, 0.0
    for e in range(lengths.size):
        moved = on_two_branches(q, e)
        Q, V, A, P, k = q, v, a, F, e
        if moved:
            move_element(q, v, a, e, moving, room)
            Q, V, A, P, k = room[0], room[1], room[2], room[3], 0
        stored, lost, turning = element_force(
            Q, V, A, k, moving, damped, e, lengths[e], H, w, C, C_damping, E0, m, J, mass, P, S
        )
        energy += stored
        power += lost
        kinetic += turning
        if moved:
            return_force(q, e, P, F)
    return energy, power, kinetic


def kinetic_energy(v: Array, lengths: Array, m: float, J: Array, mass: Array) -> float:
    """Kinetic energy of the constant part of the inertia, see :func:`add_inertia` [J]."""
    P = np.zeros_like(v)
    constant_inertia(v, lengths, m, J, mass, P)
    return 0.5 * float(np.vdot(v, P))


@kernel
def constant_inertia(a: Array, lengths: Array, m: float, J: Array, mass: Array, F: Array) -> None:
    """:func:`add_inertia` of all elements."""
    for e in range(lengths.size):
        add_inertia(a, e, lengths[e], m, J, mass, F)

r"""Sums over the elements of the gradient-deficient ANCF cable: internal force, tangent, inertia.

A node carries q = (r, r'), six numbers, interpolated by cubic Hermite functions. Per unstrained length the cable stores

.. math:: U = \tfrac12 EA\,\varepsilon^2 + \tfrac12 EI\,|\kappa|^2, \qquad
          \varepsilon = |r'| - 1, \qquad \kappa = \frac{r' \times r''}{|r'|^2},

and has neither shear nor torsion. The stretch is the exact one, not Green's, so that N = EA (|r'| - 1) is the rod's law; the
curvature is the turning of the tangent by *unstrained* length, |r' x r''|/|r'|^2, which is work-conjugate to the moment of the
inextensible and of the extensible elastica alike and is the rod's kappa for vanishing shear (|r'|^3 would be the
curvature of the stretched line). Damping adds EA eta_A d(eps)/dt and EI eta_I d(kappa)/dt, times in seconds.

Integration: the derivative of a cubic Hermite interpolant is of higher order at the ends and the middle of the element, its
second derivative at the two Gauss points. The stretch is taken at the former (Lobatto's rule, 1/6, 2/3, 1/6), the
curvature at the latter. Both terms then are exact in straight elements up to linear fields, and a bent element
holds no parasitic tension, which five Gauss points would give it. Two Gauss points would also avoid that tension
but leave a chain with a mode r' = 6 x^2 - 6 x + 1 that costs no energy.

Everything is a polynomial of positions: rigid motions strain nothing, to round-off.

Sources: M. Berzeri, A. A. Shabana, J. Sound Vib. 235 (2000) 539-565, doi 10.1006/jsvi.1999.2935 (the element);
J. Gerstmayr, A. A. Shabana, Nonlinear Dyn. 45 (2006) 109-130, doi 10.1007/s11071-006-1856-1 (thin cables, axial oscillation);
J. Gerstmayr, H. Irschik, J. Sound Vib. 318 (2008) 461-487, doi 10.1016/j.jsv.2008.04.019 (which strain, which curvature).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel
from beam.contact_force import scatter_contact
from beam.hermite import hermite
from beam.strain import cross

Array = NDArray[np.float64]

CABLE_DOF = 6
"""Unknowns of a node: r (0:3), r' (3:6)."""
STEP = 1e-7
BEND_X = 0.5 - 0.5 / np.sqrt(3.0)
"""First of the two points of the curvature, in [0, 1]; the other is its mirror image."""
OUTWARD = np.sqrt(0.15) / (0.5 - BEND_X)
"""Distance from the middle of the outer of three Gauss points over that of the outer of two."""
LOBATTO = np.array([1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0])


@kernel
def bending_shapes(x: float, length: float, dN: Array, ddN: Array) -> None:
    """Write the first and second derivatives by arc length of the four shape functions at `x` in [0, 1]."""
    hermite(x, length, ddN, dN)
    ddN[0] = (12.0 * x - 6.0) / (length * length)
    ddN[1] = (6.0 * x - 4.0) / length
    ddN[2] = -ddN[0]
    ddN[3] = (6.0 * x - 2.0) / length


@kernel
def derivative(q: Array, e: int, dN: Array) -> tuple[float, float, float]:
    """Sum of derivatives of shape functions times nodal values of element `e`; of positions only the difference enters."""
    return (
        dN[2] * (q[e + 1, 0] - q[e, 0]) + (dN[1] * q[e, 3] + dN[3] * q[e + 1, 3]),
        dN[2] * (q[e + 1, 1] - q[e, 1]) + (dN[1] * q[e, 4] + dN[3] * q[e + 1, 4]),
        dN[2] * (q[e + 1, 2] - q[e, 2]) + (dN[1] * q[e, 5] + dN[3] * q[e + 1, 5]),
    )


@kernel
def stretch_force(
    d0: float, d1: float, d2: float, v0: float, v1: float, v2: float, EA: float, damping: float
) -> tuple[float, float, float, float, float, float]:
    """(stored energy, lost power per length, N, N t) for r' = d and its velocity v."""
    size = np.sqrt(d0 * d0 + d1 * d1 + d2 * d2)
    rate = (d0 * v0 + d1 * v1 + d2 * v2) / size
    elastic = EA * (size - 1.0)
    N = elastic + damping * rate
    return 0.5 * elastic * (size - 1.0), damping * rate * rate, N, N * d0 / size, N * d1 / size, N * d2 / size


@kernel
def bending_force(z: Array, zdot: Array, EI: float, damping: float, m: Array, f: Array) -> tuple[float, float]:
    """Write the moment vector into `m` (3,) and the forces on z = (r', r'') into `f` (6,).

    Returns stored energy and lost power per length.
    """
    d0, d1, d2, c0, c1, c2 = z[0], z[1], z[2], z[3], z[4], z[5]
    p = 1.0 / (d0 * d0 + d1 * d1 + d2 * d2)
    w0, w1, w2 = cross(d0, d1, d2, c0, c1, c2)
    k0, k1, k2 = p * w0, p * w1, p * w2
    m[0], m[1], m[2] = EI * k0, EI * k1, EI * k2
    lost = 0.0
    if damping > 0.0:
        x0, x1, x2 = cross(zdot[0], zdot[1], zdot[2], c0, c1, c2)
        y0, y1, y2 = cross(d0, d1, d2, zdot[3], zdot[4], zdot[5])
        s = 2.0 * (d0 * zdot[0] + d1 * zdot[1] + d2 * zdot[2])
        r0, r1, r2 = p * (x0 + y0 - s * k0), p * (x1 + y1 - s * k1), p * (x2 + y2 - s * k2)
        m[0] += damping * r0
        m[1] += damping * r1
        m[2] += damping * r2
        lost = damping * (r0 * r0 + r1 * r1 + r2 * r2)
    x0, x1, x2 = cross(c0, c1, c2, m[0], m[1], m[2])
    s = 2.0 * (m[0] * k0 + m[1] * k1 + m[2] * k2)
    f[0], f[1], f[2] = p * (x0 - s * d0), p * (x1 - s * d1), p * (x2 - s * d2)
    x0, x1, x2 = cross(m[0], m[1], m[2], d0, d1, d2)
    f[3], f[4], f[5] = p * x0, p * x1, p * x2
    return 0.5 * EI * (k0 * k0 + k1 * k1 + k2 * k2), lost


@kernel
def add_line_inertia(a: Array, e: int, length: float, m: float, mass: Array, F: Array) -> None:
    """Add m times the integral of N N^T a over element `e`; `mass` is that integral for length one."""
    for s in range(4):
        scale = m * length * (length if s % 2 else 1.0)
        for i in range(3):
            F[e + s // 2, 3 * (s % 2) + i] += scale * (
                (mass[s, 0] * a[e, i] + mass[s, 2] * a[e + 1, i])
                + length * (mass[s, 1] * a[e, 3 + i] + mass[s, 3] * a[e + 1, 3 + i])
            )


@kernel
def write_sections(N0: float, N1: float, N2: float, first: Array, second: Array, S: Array) -> None:
    """Tension and moments at the three Gauss points of the rod from those at the points of this element, into `S` (3, 6)."""
    x = np.sqrt(0.15)
    for g in range(3):
        y = (g - 1) * x
        S[g, 0] = N1 + y * (N2 - N0) + 2.0 * y * y * (N0 - 2.0 * N1 + N2)
        S[g, 1], S[g, 2] = 0.0, 0.0
        for i in range(3):
            S[g, 3 + i] = 0.5 * ((first[i] + second[i]) + (g - 1) * OUTWARD * (second[i] - first[i]))


@kernel
def cable_force(
    q: Array, v: Array, a: Array, moving: bool, damped: bool, lengths: Array, C: Array, C_damping: Array, m: float,
    mass: Array, F: Array, S: Array,
) -> tuple[float, float]:  # fmt: skip
    """Add the internal force, and the inertia if `moving`, to `F` (n + 1, 6); write (N, 0, 0, moment vector) into `S` (n, 3, 6).

    `C` and `C_damping` are in the rod's order. Returns the elastic energy [J] and the power lost in damping [W].
    """
    EA, EI = C[0, 0], 0.5 * (C[4, 4] + C[5, 5])
    DA, DI = (C_damping[0, 0], 0.5 * (C_damping[4, 4] + C_damping[5, 5])) if damped else (0.0, 0.0)
    dN, ddN, z, zdot, f = np.empty(4), np.empty(4), np.empty(6), np.zeros(6), np.empty(6)
    first, second = np.empty(3), np.empty(3)
    energy, power = 0.0, 0.0
    for e in range(lengths.size):
        length = lengths[e]
        tension0, tension1, tension2 = 0.0, 0.0, 0.0
        for g in range(3):
            hermite(0.5 * g, length, ddN, dN)
            d0, d1, d2 = derivative(q, e, dN)
            v0, v1, v2 = derivative(v, e, dN)
            stored, lost, N, f0, f1, f2 = stretch_force(d0, d1, d2, v0, v1, v2, EA, DA)
            weight = LOBATTO[g] * length
            energy += weight * stored
            power += weight * lost
            for s in range(4):
                part = weight * dN[s]
                F[e + s // 2, 3 * (s % 2)] += part * f0
                F[e + s // 2, 3 * (s % 2) + 1] += part * f1
                F[e + s // 2, 3 * (s % 2) + 2] += part * f2
            tension0, tension1, tension2 = tension1, tension2, N
        for g in range(2):
            bending_shapes(BEND_X if g == 0 else 1.0 - BEND_X, length, dN, ddN)
            z[0], z[1], z[2] = derivative(q, e, dN)
            z[3], z[4], z[5] = derivative(q, e, ddN)
            if DI > 0.0:
                zdot[0], zdot[1], zdot[2] = derivative(v, e, dN)
                zdot[3], zdot[4], zdot[5] = derivative(v, e, ddN)
            stored, lost = bending_force(z, zdot, EI, DI, first if g == 0 else second, f)
            energy += 0.5 * length * stored
            power += 0.5 * length * lost
            for s in range(4):
                for i in range(3):
                    F[e + s // 2, 3 * (s % 2) + i] += 0.5 * length * (dN[s] * f[i] + ddN[s] * f[3 + i])
        write_sections(tension0, tension1, tension2, first, second, S[e])
        if moving:
            add_line_inertia(a, e, length, m, mass, F)
    return energy, power


@kernel
def stretch_tangent(
    d0: float, d1: float, d2: float, v0: float, v1: float, v2: float, EA: float, damping: float, factor: float, K: Array
) -> None:
    """Write the derivative of N t by r', plus factor times that by its velocity, into `K` (3, 3)."""
    size = np.sqrt(d0 * d0 + d1 * d1 + d2 * d2)
    t0, t1, t2 = d0 / size, d1 / size, d2 / size
    rate = t0 * v0 + t1 * v1 + t2 * v2
    across = (EA * (size - 1.0) + damping * rate) / size
    along = EA + factor * damping - across
    t, u = (t0, t1, t2), (v0 - rate * t0, v1 - rate * t1, v2 - rate * t2)
    for i in range(3):
        for j in range(3):
            K[i, j] = along * t[i] * t[j] + damping * t[i] * u[j] / size
        K[i, i] += across


@kernel
def bending_tangent(
    z: Array, zdot: Array, EI: float, damping: float, factor: float, m: Array, here: Array, ahead: Array, G: Array
) -> None:
    """Write the derivative of the six forces of :func:`bending_force` into `G` (6, 6), by differences."""
    bending_force(z, zdot, EI, damping, m, here)
    for j in range(6):
        zj, vj = z[j], zdot[j]
        step = STEP * max(1.0, abs(zj))
        z[j], zdot[j] = zj + step, vj + factor * step
        bending_force(z, zdot, EI, damping, m, ahead)
        z[j], zdot[j] = zj, vj
        for i in range(6):
            G[i, j] = (ahead[i] - here[i]) / step


@kernel
def scatter_bending(G: Array, e: int, weight: float, dN: Array, ddN: Array, D: Array, U: Array, L: Array) -> None:
    """Add B^T G B of one point, where (r', r'') = B q of the element, to the blocks."""
    for a in range(4):
        for b in range(4):
            na, nb = a // 2, b // 2
            blocks, k = (D, e + na) if na == nb else ((U, e) if na == 0 else (L, e))
            for i in range(3):
                for j in range(3):
                    blocks[k, 3 * (a % 2) + i, 3 * (b % 2) + j] += weight * (
                        dN[a] * (G[i, j] * dN[b] + G[i, 3 + j] * ddN[b])
                        + ddN[a] * (G[3 + i, j] * dN[b] + G[3 + i, 3 + j] * ddN[b])
                    )


@kernel
def add_line_mass(factor: float, lengths: Array, m: float, mass: Array, D: Array, U: Array, L: Array) -> None:
    """Add factor times the mass matrix to the blocks."""
    for e in range(lengths.size):
        length = lengths[e]
        for a in range(4):
            for b in range(4):
                part = factor * m * length * length ** (a % 2 + b % 2) * mass[a, b]
                na, nb = a // 2, b // 2
                blocks, k = (D, e + na) if na == nb else ((U, e) if na == 0 else (L, e))
                for i in range(3):
                    blocks[k, 3 * (a % 2) + i, 3 * (b % 2) + i] += part


@kernel
def cable_tangent(
    q: Array, v: Array, moving: bool, factor: float, factor_a: float, lengths: Array, C: Array, C_damping: Array,
    m: float, mass: Array, D: Array, U: Array, L: Array,
) -> None:  # fmt: skip
    """Add dF/dq + factor dF/dv + factor_a M to the blocks: `D` (n + 1) on, `U` (n) above and `L` (n) below the diagonal."""
    EA, EI = C[0, 0], 0.5 * (C[4, 4] + C[5, 5])
    DA, DI = C_damping[0, 0], 0.5 * (C_damping[4, 4] + C_damping[5, 5])
    dN, ddN, z, zdot, K, G = np.empty(4), np.empty(4), np.empty(6), np.empty(6), np.empty((3, 3)), np.empty((6, 6))
    room = np.empty((3, 6))
    for e in range(lengths.size):
        length = lengths[e]
        for g in range(3):
            hermite(0.5 * g, length, ddN, dN)
            d0, d1, d2 = derivative(q, e, dN)
            v0, v1, v2 = derivative(v, e, dN)
            stretch_tangent(d0, d1, d2, v0, v1, v2, EA, DA, factor, K)
            scatter_contact(K, e, LOBATTO[g] * length, dN, D, U, L)
        for g in range(2):
            bending_shapes(BEND_X if g == 0 else 1.0 - BEND_X, length, dN, ddN)
            z[0], z[1], z[2] = derivative(q, e, dN)
            z[3], z[4], z[5] = derivative(q, e, ddN)
            zdot[0], zdot[1], zdot[2] = derivative(v, e, dN)
            zdot[3], zdot[4], zdot[5] = derivative(v, e, ddN)
            bending_tangent(z, zdot, EI, DI, factor, room[0], room[1], room[2], G)
            scatter_bending(G, e, 0.5 * length, dN, ddN, D, U, L)
    if moving:
        add_line_mass(factor_a, lengths, m, mass, D, U, L)


@kernel
def line_kinetic_energy(v: Array, lengths: Array, m: float, mass: Array) -> float:
    """Kinetic energy [J]."""
    ends, P = np.empty((2, 6)), np.empty((2, 6))
    total = 0.0
    for e in range(lengths.size):
        for i in range(2):
            for k in range(6):
                ends[i, k], P[i, k] = v[e + i, k], 0.0
        add_line_inertia(ends, 0, lengths[e], m, mass, P)
        for i in range(2):
            for k in range(6):
                total += 0.5 * ends[i, k] * P[i, k]
    return total

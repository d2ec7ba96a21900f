r"""Strains of the geometrically exact rod at one point, and the force that does work on them.

With the rotation R(theta) of the section and primes for derivatives by arc length,

.. math:: \Gamma = R^T r' - e_1, \qquad \kappa = T(\theta)\,\theta' = \theta' - b\,\theta\times\theta'
          + c\,\theta\times(\theta\times\theta'),

Gamma = (stretch, shear 2, shear 3) and kappa = (twist, curvature 2, curvature 3). The gradient of the power
N . dGamma/dt + M . dkappa/dt by the rates of z = (theta, theta', r') is a closed form of nine numbers:

.. math:: f_{r'} = R N, \quad f_{\theta'} = T^T M, \quad
          f_\theta = T^T (N \times R^T r') + \partial_\theta (M \cdot T(\theta)\theta').

Source: J. C. Simo, L. Vu-Quoc, Comput. Meth. Appl. Mech. Eng. 58 (1986) 79-116, doi 10.1016/0045-7825(86)90079-4
(strains); the gradient is worked out here and checked against differences in the tests.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import inlined, kernel
from beam.rotation_vector import rotation_coefficients

Array = NDArray[np.float64]


@kernel
def cross(a0: float, a1: float, a2: float, b0: float, b1: float, b2: float) -> tuple[float, float, float]:
    """a x b, by components."""
    return a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0


@kernel
def strain(z: Array, a: float, b: float, c: float, E: Array) -> tuple[float, float, float, float, float, float]:
    """Write (Gamma, kappa) of z = (theta, theta', r') into `E` (6,).

    `a`, `b`, `c` are :func:`rotation_coefficients`. Returns theta x theta' and theta x (theta x theta').
    """
    t0, t1, t2, u0, u1, u2, d0, d1, d2 = z[0], z[1], z[2], z[3], z[4], z[5], z[6], z[7], z[8]
    x0, x1, x2 = cross(t0, t1, t2, d0, d1, d2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    E[0] = d0 - a * x0 + b * y0 - 1.0
    E[1] = d1 - a * x1 + b * y1
    E[2] = d2 - a * x2 + b * y2
    p0, p1, p2 = cross(t0, t1, t2, u0, u1, u2)
    q0, q1, q2 = cross(t0, t1, t2, p0, p1, p2)
    E[3] = u0 - b * p0 + c * q0
    E[4] = u1 - b * p1 + c * q1
    E[5] = u2 - b * p2 + c * q2
    return p0, p1, p2, q0, q1, q2


@inlined
def strain_rate(
    z: Array, zdot: Array, a: float, b: float, c: float, db: float, dc: float, E: Array,
    p0: float, p1: float, p2: float, q0: float, q1: float, q2: float, rate: Array,
) -> None:  # fmt: skip
    """Write the time derivative of (Gamma, kappa) into `rate` (6,); `E`, `p` and `q` come from :func:`strain`."""
    t0, t1, t2 = z[0], z[1], z[2]
    s0, s1, s2, w0, w1, w2, v0, v1, v2 = zdot[0], zdot[1], zdot[2], zdot[3], zdot[4], zdot[5], zdot[6], zdot[7], zdot[8]
    x0, x1, x2 = cross(t0, t1, t2, s0, s1, s2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    o0, o1, o2 = s0 - b * x0 + c * y0, s1 - b * x1 + c * y1, s2 - b * x2 + c * y2
    x0, x1, x2 = cross(t0, t1, t2, v0, v1, v2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    g0, g1, g2 = cross(o0, o1, o2, E[0] + 1.0, E[1], E[2])
    rate[0] = v0 - a * x0 + b * y0 - g0
    rate[1] = v1 - a * x1 + b * y1 - g1
    rate[2] = v2 - a * x2 + b * y2 - g2
    x0, x1, x2 = cross(t0, t1, t2, w0, w1, w2)
    m0, m1, m2 = cross(s0, s1, s2, z[3], z[4], z[5])
    n0, n1, n2 = cross(t0, t1, t2, x0 + m0, x1 + m1, x2 + m2)
    k0, k1, k2 = cross(s0, s1, s2, p0, p1, p2)
    spin = 2.0 * (t0 * s0 + t1 * s1 + t2 * s2)
    rate[3] = w0 - b * (x0 + m0) + c * (n0 + k0) + spin * (dc * q0 - db * p0)
    rate[4] = w1 - b * (x1 + m1) + c * (n1 + k1) + spin * (dc * q1 - db * p1)
    rate[5] = w2 - b * (x2 + m2) + c * (n2 + k2) + spin * (dc * q2 - db * p2)


@kernel
def force_of_section(
    z: Array, a: float, b: float, c: float, db: float, dc: float, E: Array,
    p0: float, p1: float, p2: float, q0: float, q1: float, q2: float, S: Array, f: Array,
) -> None:  # fmt: skip
    """Write the nine generalised forces that the section forces `S` (6,) exert on z = (theta, theta', r') into `f`."""
    t0, t1, t2, u0, u1, u2 = z[0], z[1], z[2], z[3], z[4], z[5]
    N0, N1, N2, M0, M1, M2 = S[0], S[1], S[2], S[3], S[4], S[5]
    x0, x1, x2 = cross(t0, t1, t2, N0, N1, N2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    f[6], f[7], f[8] = N0 + a * x0 + b * y0, N1 + a * x1 + b * y1, N2 + a * x2 + b * y2
    x0, x1, x2 = cross(t0, t1, t2, M0, M1, M2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    f[3], f[4], f[5] = M0 + b * x0 + c * y0, M1 + b * x1 + c * y1, M2 + b * x2 + c * y2
    h0, h1, h2 = cross(N0, N1, N2, E[0] + 1.0, E[1], E[2])
    x0, x1, x2 = cross(t0, t1, t2, h0, h1, h2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    m0, m1, m2 = cross(u0, u1, u2, M0, M1, M2)
    tu = t0 * u0 + t1 * u1 + t2 * u2
    tM = t0 * M0 + t1 * M1 + t2 * M2
    uM = u0 * M0 + u1 * M1 + u2 * M2
    along = 2.0 * (dc * (M0 * q0 + M1 * q1 + M2 * q2) - db * (M0 * p0 + M1 * p1 + M2 * p2) - c * uM)
    f[0] = h0 + b * x0 + c * y0 - b * m0 + c * (M0 * tu + u0 * tM) + along * t0
    f[1] = h1 + b * x1 + c * y1 - b * m1 + c * (M1 * tu + u1 * tM) + along * t1
    f[2] = h2 + b * x2 + c * y2 - b * m2 + c * (M2 * tu + u2 * tM) + along * t2


@inlined
def linear_law(C: Array, C_damping: Array, E0: Array, E: Array, rate: Array, S: Array) -> tuple[float, float]:
    """Section forces `S` of the linear law with damping; returns stored energy and dissipated power per length."""
    d0, d1, d2, d3, d4, d5 = E[0] - E0[0], E[1] - E0[1], E[2] - E0[2], E[3] - E0[3], E[4] - E0[4], E[5] - E0[5]
    r0, r1, r2, r3, r4, r5 = rate[0], rate[1], rate[2], rate[3], rate[4], rate[5]
    stored = 0.0
    dissipated = 0.0
    for i in range(6):
        elastic = (C[i, 0] * d0 + C[i, 1] * d1) + (C[i, 2] * d2 + C[i, 3] * d3) + (C[i, 4] * d4 + C[i, 5] * d5)
        D = C_damping
        viscous = (D[i, 0] * r0 + D[i, 1] * r1) + (D[i, 2] * r2 + D[i, 3] * r3) + (D[i, 4] * r4 + D[i, 5] * r5)
        stored += 0.5 * elastic * (E[i] - E0[i])
        dissipated += viscous * rate[i]
        S[i] = elastic + viscous
    return stored, dissipated


@inlined
def gauss_force(
    z: Array, zdot: Array, C: Array, C_damping: Array, E0: Array, E: Array, rate: Array, S: Array, f: Array
) -> tuple[float, float]:
    """Section forces `S` and generalised force `f` at one point; returns stored energy and dissipated power per length."""
    a, b, c, db, dc = rotation_coefficients(z[0] * z[0] + z[1] * z[1] + z[2] * z[2])
    p0, p1, p2, q0, q1, q2 = strain(z, a, b, c, E)
    strain_rate(z, zdot, a, b, c, db, dc, E, p0, p1, p2, q0, q1, q2, rate)
    energies = linear_law(C, C_damping, E0, E, rate, S)
    force_of_section(z, a, b, c, db, dc, E, p0, p1, p2, q0, q1, q2, S, f)
    return energies


@inlined
def rotary_inertia(z: Array, zdot: Array, acceleration: Array, J: Array, f: Array) -> None:
    """Add T^T (J omega_dot + omega x J omega), the inertia of the section per length, to `f` (9,).

    `acceleration` (3,) is the second derivative of theta, `J` (3,) the inertia about the section's axes.
    """
    t0, t1, t2, s0, s1, s2 = z[0], z[1], z[2], zdot[0], zdot[1], zdot[2]
    _, b, c, db, dc = rotation_coefficients(t0 * t0 + t1 * t1 + t2 * t2)
    x0, x1, x2 = cross(t0, t1, t2, s0, s1, s2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    k0, k1, k2 = cross(s0, s1, s2, x0, x1, x2)
    a0, a1, a2 = acceleration[0], acceleration[1], acceleration[2]
    m0, m1, m2 = cross(t0, t1, t2, a0, a1, a2)
    n0, n1, n2 = cross(t0, t1, t2, m0, m1, m2)
    spin = 2.0 * (t0 * s0 + t1 * s1 + t2 * s2)
    b_dot, c_dot = spin * db, spin * dc
    o0, o1, o2 = s0 - b * x0 + c * y0, s1 - b * x1 + c * y1, s2 - b * x2 + c * y2
    r0 = a0 - b * m0 + c * (n0 + k0) - b_dot * x0 + c_dot * y0
    r1 = a1 - b * m1 + c * (n1 + k1) - b_dot * x1 + c_dot * y1
    r2 = a2 - b * m2 + c * (n2 + k2) - b_dot * x2 + c_dot * y2
    g0, g1, g2 = cross(o0, o1, o2, J[0] * o0, J[1] * o1, J[2] * o2)
    g0, g1, g2 = g0 + J[0] * r0, g1 + J[1] * r1, g2 + J[2] * r2
    x0, x1, x2 = cross(t0, t1, t2, g0, g1, g2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    f[0] += g0 + b * x0 + c * y0
    f[1] += g1 + b * x1 + c * y1
    f[2] += g2 + b * x2 + c * y2

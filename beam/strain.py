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

from beam.compiled import kernel
from beam.rotation_vector import rotation_coefficients

Array = NDArray[np.float64]


@kernel
def cross(a0: float, a1: float, a2: float, b0: float, b1: float, b2: float) -> tuple[float, float, float]:
    """a x b, by components."""
    return a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0


@kernel
def strain(z: Array, E: Array) -> None:
    """Write (Gamma, kappa) of z = (theta, theta', r') into `E` (6,)."""
    t0, t1, t2, u0, u1, u2, d0, d1, d2 = z[0], z[1], z[2], z[3], z[4], z[5], z[6], z[7], z[8]
    a, b, c, _, _ = rotation_coefficients(t0 * t0 + t1 * t1 + t2 * t2)
    x0, x1, x2 = cross(t0, t1, t2, d0, d1, d2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    E[0] = d0 - a * x0 + b * y0 - 1.0
    E[1] = d1 - a * x1 + b * y1
    E[2] = d2 - a * x2 + b * y2
    x0, x1, x2 = cross(t0, t1, t2, u0, u1, u2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    E[3] = u0 - b * x0 + c * y0
    E[4] = u1 - b * x1 + c * y1
    E[5] = u2 - b * x2 + c * y2


@kernel
def strain_rate(z: Array, zdot: Array, E: Array, rate: Array) -> None:
    """Write the time derivative of (Gamma, kappa) into `rate` (6,); `E` holds the strains of `z`."""
    t0, t1, t2, u0, u1, u2 = z[0], z[1], z[2], z[3], z[4], z[5]
    s0, s1, s2, w0, w1, w2, v0, v1, v2 = zdot[0], zdot[1], zdot[2], zdot[3], zdot[4], zdot[5], zdot[6], zdot[7], zdot[8]
    a, b, c, db, dc = rotation_coefficients(t0 * t0 + t1 * t1 + t2 * t2)
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
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    p0, p1, p2 = cross(t0, t1, t2, u0, u1, u2)
    q0, q1, q2 = cross(t0, t1, t2, p0, p1, p2)
    m0, m1, m2 = cross(s0, s1, s2, u0, u1, u2)
    n0, n1, n2 = cross(t0, t1, t2, m0, m1, m2)
    k0, k1, k2 = cross(s0, s1, s2, p0, p1, p2)
    spin = 2.0 * (t0 * s0 + t1 * s1 + t2 * s2)
    rate[3] = w0 - b * (x0 + m0) + c * (y0 + n0 + k0) + spin * (dc * q0 - db * p0)
    rate[4] = w1 - b * (x1 + m1) + c * (y1 + n1 + k1) + spin * (dc * q1 - db * p1)
    rate[5] = w2 - b * (x2 + m2) + c * (y2 + n2 + k2) + spin * (dc * q2 - db * p2)


@kernel
def force_of_section(z: Array, E: Array, S: Array, f: Array) -> None:
    """Write the nine generalised forces that the section forces `S` (6,) exert on z = (theta, theta', r') into `f`."""
    t0, t1, t2, u0, u1, u2 = z[0], z[1], z[2], z[3], z[4], z[5]
    N0, N1, N2, M0, M1, M2 = S[0], S[1], S[2], S[3], S[4], S[5]
    a, b, c, db, dc = rotation_coefficients(t0 * t0 + t1 * t1 + t2 * t2)
    x0, x1, x2 = cross(t0, t1, t2, N0, N1, N2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    f[6], f[7], f[8] = N0 + a * x0 + b * y0, N1 + a * x1 + b * y1, N2 + a * x2 + b * y2
    x0, x1, x2 = cross(t0, t1, t2, M0, M1, M2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    f[3], f[4], f[5] = M0 + b * x0 + c * y0, M1 + b * x1 + c * y1, M2 + b * x2 + c * y2
    h0, h1, h2 = cross(N0, N1, N2, E[0] + 1.0, E[1], E[2])
    x0, x1, x2 = cross(t0, t1, t2, h0, h1, h2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    p0, p1, p2 = cross(t0, t1, t2, u0, u1, u2)
    q0, q1, q2 = cross(t0, t1, t2, p0, p1, p2)
    m0, m1, m2 = cross(u0, u1, u2, M0, M1, M2)
    tu = t0 * u0 + t1 * u1 + t2 * u2
    tM = t0 * M0 + t1 * M1 + t2 * M2
    uM = u0 * M0 + u1 * M1 + u2 * M2
    along = 2.0 * (dc * (M0 * q0 + M1 * q1 + M2 * q2) - db * (M0 * p0 + M1 * p1 + M2 * p2) - c * uM)
    f[0] = h0 + b * x0 + c * y0 - b * m0 + c * (M0 * tu + u0 * tM) + along * t0
    f[1] = h1 + b * x1 + c * y1 - b * m1 + c * (M1 * tu + u1 * tM) + along * t1
    f[2] = h2 + b * x2 + c * y2 - b * m2 + c * (M2 * tu + u2 * tM) + along * t2


@kernel
def gauss_force(
    z: Array, zdot: Array, C: Array, C_damping: Array, E0: Array, E: Array, rate: Array, S: Array, f: Array
) -> tuple[float, float]:
    """Section forces `S` and generalised force `f` at one point; returns stored energy and dissipated power per length."""
    strain(z, E)
    strain_rate(z, zdot, E, rate)
    stored = 0.0
    dissipated = 0.0
    for i in range(6):
        elastic = 0.0
        viscous = 0.0
        for j in range(6):
            elastic += C[i, j] * (E[j] - E0[j])
            viscous += C_damping[i, j] * rate[j]
        stored += 0.5 * elastic * (E[i] - E0[i])
        dissipated += viscous * rate[i]
        S[i] = elastic + viscous
    force_of_section(z, E, S, f)
    return stored, dissipated

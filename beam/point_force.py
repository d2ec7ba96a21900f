r"""The force at one Gauss point, written out in scalars: what a step spends its time on.

The same formulas as :func:`beam.strain.gauss_force`, where they are stated, without arrays in between, which is 1.4 times
faster. The two are compared to round-off in the tests.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import inlined, kernel
from beam.strain import cross

Array = NDArray[np.float64]

Six = tuple[float, float, float, float, float, float]


@kernel
def interpolate(
    q: Array, k: int, H: Array, g: int, length: float
) -> tuple[float, float, float, float, float, float, float, float, float]:
    """(theta, theta', r') at Gauss point `g` between the nodes `k` and k + 1; `H` from :func:`beam.element.unit_shapes`."""
    n0, n1, n2, n3 = H[g, 0], H[g, 1] * length, H[g, 2], H[g, 3] * length
    d0, d1, d3 = H[g, 4] / length, H[g, 5], H[g, 7]
    t0 = n0 * q[k, 6] + n1 * q[k, 9] + (n2 * q[k + 1, 6] + n3 * q[k + 1, 9])
    t1 = n0 * q[k, 7] + n1 * q[k, 10] + (n2 * q[k + 1, 7] + n3 * q[k + 1, 10])
    t2 = n0 * q[k, 8] + n1 * q[k, 11] + (n2 * q[k + 1, 8] + n3 * q[k + 1, 11])
    u0 = d0 * (q[k, 6] - q[k + 1, 6]) + (d1 * q[k, 9] + d3 * q[k + 1, 9])
    u1 = d0 * (q[k, 7] - q[k + 1, 7]) + (d1 * q[k, 10] + d3 * q[k + 1, 10])
    u2 = d0 * (q[k, 8] - q[k + 1, 8]) + (d1 * q[k, 11] + d3 * q[k + 1, 11])
    r0 = d0 * (q[k, 0] - q[k + 1, 0]) + (d1 * q[k, 3] + d3 * q[k + 1, 3])
    r1 = d0 * (q[k, 1] - q[k + 1, 1]) + (d1 * q[k, 4] + d3 * q[k + 1, 4])
    r2 = d0 * (q[k, 2] - q[k + 1, 2]) + (d1 * q[k, 5] + d3 * q[k + 1, 5])
    return t0, t1, t2, u0, u1, u2, r0, r1, r2


@kernel
def times(C: Array, e0: float, e1: float, e2: float, e3: float, e4: float, e5: float) -> Six:
    """C e of a matrix (6, 6)."""
    s0 = (C[0, 0] * e0 + C[0, 1] * e1 + C[0, 2] * e2) + (C[0, 3] * e3 + C[0, 4] * e4 + C[0, 5] * e5)
    s1 = (C[1, 0] * e0 + C[1, 1] * e1 + C[1, 2] * e2) + (C[1, 3] * e3 + C[1, 4] * e4 + C[1, 5] * e5)
    s2 = (C[2, 0] * e0 + C[2, 1] * e1 + C[2, 2] * e2) + (C[2, 3] * e3 + C[2, 4] * e4 + C[2, 5] * e5)
    s3 = (C[3, 0] * e0 + C[3, 1] * e1 + C[3, 2] * e2) + (C[3, 3] * e3 + C[3, 4] * e4 + C[3, 5] * e5)
    s4 = (C[4, 0] * e0 + C[4, 1] * e1 + C[4, 2] * e2) + (C[4, 3] * e3 + C[4, 4] * e4 + C[4, 5] * e5)
    s5 = (C[5, 0] * e0 + C[5, 1] * e1 + C[5, 2] * e2) + (C[5, 3] * e3 + C[5, 4] * e4 + C[5, 5] * e5)
    return s0, s1, s2, s3, s4, s5


@inlined
def point_force(
    t0: float, t1: float, t2: float, u0: float, u1: float, u2: float, d0: float, d1: float, d2: float,
    s0: float, s1: float, s2: float, w0: float, w1: float, w2: float, v0: float, v1: float, v2: float,
    a: float, b: float, c: float, db: float, dc: float, C: Array, D: Array, E0: Array, e: int, g: int, damped: bool,
    S: Array,
) -> tuple[float, float, float, float, float, float, float, float, float, float, float]:  # fmt: skip
    """Stored energy and dissipated power per length, and the nine forces on (theta, theta', r'); writes `S`[e, g].

    theta = t, theta' = u, r' = d; their velocities s, w, v count only if `damped`;
    a to dc are :func:`beam.rotation_vector.rotation_coefficients`.
    """
    x0, x1, x2 = cross(t0, t1, t2, d0, d1, d2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    g0, g1, g2 = d0 - a * x0 + b * y0, d1 - a * x1 + b * y1, d2 - a * x2 + b * y2
    p0, p1, p2 = cross(t0, t1, t2, u0, u1, u2)
    q0, q1, q2 = cross(t0, t1, t2, p0, p1, p2)
    e0, e1, e2 = g0 - 1.0 - E0[e, g, 0], g1 - E0[e, g, 1], g2 - E0[e, g, 2]
    e3, e4, e5 = (
        u0 - b * p0 + c * q0 - E0[e, g, 3],
        u1 - b * p1 + c * q1 - E0[e, g, 4],
        u2 - b * p2 + c * q2 - E0[e, g, 5],
    )
    N0, N1, N2, M0, M1, M2 = times(C, e0, e1, e2, e3, e4, e5)
    stored = 0.5 * ((N0 * e0 + N1 * e1 + N2 * e2) + (M0 * e3 + M1 * e4 + M2 * e5))
    lost = 0.0
    if damped:
        x0, x1, x2 = cross(t0, t1, t2, s0, s1, s2)
        y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
        h0, h1, h2 = cross(s0 - b * x0 + c * y0, s1 - b * x1 + c * y1, s2 - b * x2 + c * y2, g0, g1, g2)
        x0, x1, x2 = cross(t0, t1, t2, v0, v1, v2)
        y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
        r0, r1, r2 = v0 - a * x0 + b * y0 - h0, v1 - a * x1 + b * y1 - h1, v2 - a * x2 + b * y2 - h2
        x0, x1, x2 = cross(t0, t1, t2, w0, w1, w2)
        m0, m1, m2 = cross(s0, s1, s2, u0, u1, u2)
        x0, x1, x2 = x0 + m0, x1 + m1, x2 + m2
        y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
        m0, m1, m2 = cross(s0, s1, s2, p0, p1, p2)
        spin = 2.0 * (t0 * s0 + t1 * s1 + t2 * s2)
        cc, bb = spin * dc, spin * db
        r3 = w0 - b * x0 + c * (y0 + m0) + (cc * q0 - bb * p0)
        r4 = w1 - b * x1 + c * (y1 + m1) + (cc * q1 - bb * p1)
        r5 = w2 - b * x2 + c * (y2 + m2) + (cc * q2 - bb * p2)
        n0, n1, n2, m0, m1, m2 = times(D, r0, r1, r2, r3, r4, r5)
        lost = (n0 * r0 + n1 * r1 + n2 * r2) + (m0 * r3 + m1 * r4 + m2 * r5)
        N0, N1, N2, M0, M1, M2 = N0 + n0, N1 + n1, N2 + n2, M0 + m0, M1 + m1, M2 + m2
    S[e, g, 0], S[e, g, 1], S[e, g, 2], S[e, g, 3], S[e, g, 4], S[e, g, 5] = N0, N1, N2, M0, M1, M2
    x0, x1, x2 = cross(t0, t1, t2, N0, N1, N2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    f6, f7, f8 = N0 + a * x0 + b * y0, N1 + a * x1 + b * y1, N2 + a * x2 + b * y2
    x0, x1, x2 = cross(t0, t1, t2, M0, M1, M2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    f3, f4, f5 = M0 + b * x0 + c * y0, M1 + b * x1 + c * y1, M2 + b * x2 + c * y2
    h0, h1, h2 = cross(N0, N1, N2, g0, g1, g2)
    x0, x1, x2 = cross(t0, t1, t2, h0, h1, h2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    m0, m1, m2 = cross(u0, u1, u2, M0, M1, M2)
    tu, tM = t0 * u0 + t1 * u1 + t2 * u2, t0 * M0 + t1 * M1 + t2 * M2
    along = dc * (M0 * q0 + M1 * q1 + M2 * q2) - db * (M0 * p0 + M1 * p1 + M2 * p2)
    along = 2.0 * (along - c * (u0 * M0 + u1 * M1 + u2 * M2))
    f0 = h0 + b * x0 + c * y0 - b * m0 + c * (M0 * tu + u0 * tM) + along * t0
    f1 = h1 + b * x1 + c * y1 - b * m1 + c * (M1 * tu + u1 * tM) + along * t1
    f2 = h2 + b * x2 + c * y2 - b * m2 + c * (M2 * tu + u2 * tM) + along * t2
    return stored, lost, f0, f1, f2, f3, f4, f5, f6, f7, f8


@inlined
def rotary_force(
    t0: float, t1: float, t2: float, s0: float, s1: float, s2: float, b: float, c: float, db: float, dc: float,
    a: Array, k: int, H: Array, g: int, length: float, J: Array,
) -> tuple[float, float, float, float]:  # fmt: skip
    """Kinetic energy per length and T^T (J omega_dot + omega x J omega) for theta = t, its velocity s, accelerations `a`."""
    n0, n1, n2, n3 = H[g, 0], H[g, 1] * length, H[g, 2], H[g, 3] * length
    a0 = n0 * a[k, 6] + n1 * a[k, 9] + (n2 * a[k + 1, 6] + n3 * a[k + 1, 9])
    a1 = n0 * a[k, 7] + n1 * a[k, 10] + (n2 * a[k + 1, 7] + n3 * a[k + 1, 10])
    a2 = n0 * a[k, 8] + n1 * a[k, 11] + (n2 * a[k + 1, 8] + n3 * a[k + 1, 11])
    x0, x1, x2 = cross(t0, t1, t2, s0, s1, s2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    k0, k1, k2 = cross(s0, s1, s2, x0, x1, x2)
    m0, m1, m2 = cross(t0, t1, t2, a0, a1, a2)
    l0, l1, l2 = cross(t0, t1, t2, m0, m1, m2)
    spin = 2.0 * (t0 * s0 + t1 * s1 + t2 * s2)
    bb, cc = spin * db, spin * dc
    o0, o1, o2 = s0 - b * x0 + c * y0, s1 - b * x1 + c * y1, s2 - b * x2 + c * y2
    r0 = a0 - b * m0 + c * (l0 + k0) - bb * x0 + cc * y0
    r1 = a1 - b * m1 + c * (l1 + k1) - bb * x1 + cc * y1
    r2 = a2 - b * m2 + c * (l2 + k2) - bb * x2 + cc * y2
    kinetic = 0.5 * (J[0] * o0 * o0 + J[1] * o1 * o1 + J[2] * o2 * o2)
    g0, g1, g2 = cross(o0, o1, o2, J[0] * o0, J[1] * o1, J[2] * o2)
    g0, g1, g2 = g0 + J[0] * r0, g1 + J[1] * r1, g2 + J[2] * r2
    x0, x1, x2 = cross(t0, t1, t2, g0, g1, g2)
    y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
    return kinetic, g0 + b * x0 + c * y0, g1 + b * x1 + c * y1, g2 + b * x2 + c * y2

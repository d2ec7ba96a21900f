r"""The force at one Gauss point of eight elements at once, written out in scalars: what a step spends its time on.

The same formulas as :func:`beam.strain.gauss_force` and :func:`beam.strain.rotary_inertia`, where they are stated; the tests
compare the two to round-off. All numbers of eight elements stand in one work array, number k of element l at 8 k + l, so that
the loop over the eight is one of independent operations at fixed distances, which the processor does four or eight at a time.

The coefficients of the rotation are their power series in x = |theta|^2,

.. math:: b = \sum_k \frac{(-x)^k}{(2k+2)!}, \qquad c = \sum_k \frac{(-x)^k}{(2k+3)!}, \qquad a = 1 - x c,

to 20 terms and with their derivatives: exact to round-off up to |theta| = 2 pi, and without a branch.
"""

from __future__ import annotations

from math import factorial

import numpy as np
from numpy.typing import NDArray

from beam.compiled import embedded, kernel

Array = NDArray[np.float64]
Three = tuple[float, float, float]
Six = tuple[float, float, float, float, float, float]

LANES = 8
"""Elements that are worked on at once."""
ROW = 2 * LANES
"""Places for one number of the nine nodes of eight elements: the second node of an element is the first one of the next."""
LENGTH, REST, SHIFT, STIFF, DAMP, FORCE, NODAL, SECTION, ENERGY, END = (
    36 * ROW + LANES * k for k in (0, 2, 8, 17, 53, 89, 98, 122, 128, 131)
)
"""Where in the work array, after 12 positions, 12 velocities and 12 accelerations of the nodes: length and its inverse, strains
at rest, shift of (theta, theta', r'), C and C_damping, the nine forces, forces on both nodes, section forces, energies
(elastic, lost power, kinetic)."""

B_SERIES = np.array([(-1.0) ** k / factorial(2 * k + 2) for k in range(20)])
C_SERIES = np.array([(-1.0) ** k / factorial(2 * k + 3) for k in range(20)])


@embedded
def cross(a0: float, a1: float, a2: float, b0: float, b1: float, b2: float) -> Three:
    """a x b, by components."""
    return a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0


@embedded
def rotation_series(x: float) -> tuple[float, float, float, float, float]:
    """(a, b, c, db, dc) as of :func:`beam.rotation_vector.rotation_coefficients`."""
    b, c, db, dc = B_SERIES[19], C_SERIES[19], 0.0, 0.0
    for k in range(1, 20):
        db, b = db * x + b, b * x + B_SERIES[19 - k]
        dc, c = dc * x + c, c * x + C_SERIES[19 - k]
    return 1.0 - x * c, b, c, db, dc


@embedded
def value(W: Array, i: int, n0: float, n1: float, n2: float, n3: float) -> Three:
    """Interpolated vector of the element whose nodal values begin at `i`."""
    return (
        n0 * W[i] + n1 * W[i + 48] + (n2 * W[i + 1] + n3 * W[i + 49]),
        n0 * W[i + 16] + n1 * W[i + 64] + (n2 * W[i + 17] + n3 * W[i + 65]),
        n0 * W[i + 32] + n1 * W[i + 80] + (n2 * W[i + 33] + n3 * W[i + 81]),
    )


@embedded
def slope(W: Array, i: int, d0: float, d1: float, d3: float) -> Three:
    """Its derivative by arc length; of the values only the difference enters."""
    return (
        d0 * (W[i] - W[i + 1]) + (d1 * W[i + 48] + d3 * W[i + 49]),
        d0 * (W[i + 16] - W[i + 17]) + (d1 * W[i + 64] + d3 * W[i + 65]),
        d0 * (W[i + 32] - W[i + 33]) + (d1 * W[i + 80] + d3 * W[i + 81]),
    )


@embedded
def shifted(W: Array, i: int, factor: float, x0: float, x1: float, x2: float) -> Three:
    """x plus factor times the shift that begins at `i`."""
    return x0 + factor * W[i], x1 + factor * W[i + 8], x2 + factor * W[i + 16]


@embedded
def times(W: Array, i: int, e0: float, e1: float, e2: float, e3: float, e4: float, e5: float) -> Six:
    """C e of the matrix (6, 6) that begins at `i`."""
    return (
        (W[i] * e0 + W[i + 8] * e1 + W[i + 16] * e2) + (W[i + 24] * e3 + W[i + 32] * e4 + W[i + 40] * e5),
        (W[i + 48] * e0 + W[i + 56] * e1 + W[i + 64] * e2) + (W[i + 72] * e3 + W[i + 80] * e4 + W[i + 88] * e5),
        (W[i + 96] * e0 + W[i + 104] * e1 + W[i + 112] * e2) + (W[i + 120] * e3 + W[i + 128] * e4 + W[i + 136] * e5),
        (W[i + 144] * e0 + W[i + 152] * e1 + W[i + 160] * e2) + (W[i + 168] * e3 + W[i + 176] * e4 + W[i + 184] * e5),
        (W[i + 192] * e0 + W[i + 200] * e1 + W[i + 208] * e2) + (W[i + 216] * e3 + W[i + 224] * e4 + W[i + 232] * e5),
        (W[i + 240] * e0 + W[i + 248] * e1 + W[i + 256] * e2) + (W[i + 264] * e3 + W[i + 272] * e4 + W[i + 280] * e5),
    )


@embedded
def put(W: Array, i: int, x0: float, x1: float, x2: float) -> None:
    """Write three numbers."""
    W[i], W[i + 8], W[i + 16] = x0, x1, x2


@embedded
def add(W: Array, i: int, n: float, x0: float, x1: float, x2: float) -> None:
    """Add n x."""
    W[i] += n * x0
    W[i + 8] += n * x1
    W[i + 16] += n * x2


@kernel
def point_forces(  # noqa: PLR0915 - the formulas written out
    W: Array, H: Array, g: int, w: float, J0: float, J1: float, J2: float, factor: float, factor_a: float
) -> None:
    """Gauss point `g` of weight `w` of eight elements: adds to the forces on their nodes and to their energies.

    `H` are :func:`beam.element.unit_shapes`. The shift is added to (theta, theta', r'), `factor` times it to their
    velocities and `factor_a` times it to the accelerations. J is the rotary inertia, zero if nothing moves.
    """
    h0, h1, h2, h3, h4, h5, h7 = H[g, 0], H[g, 1], H[g, 2], H[g, 3], H[g, 4], H[g, 5], H[g, 7]
    for l in range(LANES):
        n1, n3, slant = h1 * W[LENGTH + l], h3 * W[LENGTH + l], h4 * W[LENGTH + 8 + l]
        x0, x1, x2 = value(W, l + 6 * ROW, h0, n1, h2, n3)
        t0, t1, t2 = shifted(W, SHIFT + l, 1.0, x0, x1, x2)
        x0, x1, x2 = slope(W, l + 6 * ROW, slant, h5, h7)
        u0, u1, u2 = shifted(W, SHIFT + l + 24, 1.0, x0, x1, x2)
        x0, x1, x2 = slope(W, l, slant, h5, h7)
        d0, d1, d2 = shifted(W, SHIFT + l + 48, 1.0, x0, x1, x2)
        x0, x1, x2 = value(W, l + 18 * ROW, h0, n1, h2, n3)
        s0, s1, s2 = shifted(W, SHIFT + l, factor, x0, x1, x2)
        x0, x1, x2 = slope(W, l + 18 * ROW, slant, h5, h7)
        w0, w1, w2 = shifted(W, SHIFT + l + 24, factor, x0, x1, x2)
        x0, x1, x2 = slope(W, l + 12 * ROW, slant, h5, h7)
        v0, v1, v2 = shifted(W, SHIFT + l + 48, factor, x0, x1, x2)
        x0, x1, x2 = value(W, l + 30 * ROW, h0, n1, h2, n3)
        a0, a1, a2 = shifted(W, SHIFT + l, factor_a, x0, x1, x2)
        # strains
        a, b, c, db, dc = rotation_series(t0 * t0 + t1 * t1 + t2 * t2)
        x0, x1, x2 = cross(t0, t1, t2, d0, d1, d2)
        y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
        g0, g1, g2 = d0 - a * x0 + b * y0, d1 - a * x1 + b * y1, d2 - a * x2 + b * y2
        p0, p1, p2 = cross(t0, t1, t2, u0, u1, u2)
        q0, q1, q2 = cross(t0, t1, t2, p0, p1, p2)
        e0, e1, e2 = g0 - 1.0 - W[REST + l], g1 - W[REST + 8 + l], g2 - W[REST + 16 + l]
        e3 = u0 - b * p0 + c * q0 - W[REST + 24 + l]
        e4 = u1 - b * p1 + c * q1 - W[REST + 32 + l]
        e5 = u2 - b * p2 + c * q2 - W[REST + 40 + l]
        N0, N1, N2, M0, M1, M2 = times(W, STIFF + l, e0, e1, e2, e3, e4, e5)
        stored = 0.5 * ((N0 * e0 + N1 * e1 + N2 * e2) + (M0 * e3 + M1 * e4 + M2 * e5))
        # angular velocity o, inertia of the section i
        z0, z1, z2 = cross(t0, t1, t2, s0, s1, s2)
        y0, y1, y2 = cross(t0, t1, t2, z0, z1, z2)
        o0, o1, o2 = s0 - b * z0 + c * y0, s1 - b * z1 + c * y1, s2 - b * z2 + c * y2
        spin = 2.0 * (t0 * s0 + t1 * s1 + t2 * s2)
        cc, bb = spin * dc, spin * db
        k0, k1, k2 = cross(s0, s1, s2, z0, z1, z2)
        m0, m1, m2 = cross(t0, t1, t2, a0, a1, a2)
        x0, x1, x2 = cross(t0, t1, t2, m0, m1, m2)
        i0 = a0 - b * m0 + c * (x0 + k0) - bb * z0 + cc * y0
        i1 = a1 - b * m1 + c * (x1 + k1) - bb * z1 + cc * y1
        i2 = a2 - b * m2 + c * (x2 + k2) - bb * z2 + cc * y2
        j0, j1, j2 = J0 * o0, J1 * o1, J2 * o2
        kinetic = 0.5 * (j0 * o0 + j1 * o1 + j2 * o2)
        x0, x1, x2 = cross(o0, o1, o2, j0, j1, j2)
        i0, i1, i2 = x0 + J0 * i0, x1 + J1 * i1, x2 + J2 * i2
        # strain rates r, damping
        k0, k1, k2 = cross(o0, o1, o2, g0, g1, g2)
        x0, x1, x2 = cross(t0, t1, t2, v0, v1, v2)
        y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
        r0, r1, r2 = v0 - a * x0 + b * y0 - k0, v1 - a * x1 + b * y1 - k1, v2 - a * x2 + b * y2 - k2
        x0, x1, x2 = cross(t0, t1, t2, w0, w1, w2)
        m0, m1, m2 = cross(s0, s1, s2, u0, u1, u2)
        x0, x1, x2 = x0 + m0, x1 + m1, x2 + m2
        y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
        m0, m1, m2 = cross(s0, s1, s2, p0, p1, p2)
        r3 = w0 - b * x0 + c * (y0 + m0) + (cc * q0 - bb * p0)
        r4 = w1 - b * x1 + c * (y1 + m1) + (cc * q1 - bb * p1)
        r5 = w2 - b * x2 + c * (y2 + m2) + (cc * q2 - bb * p2)
        x0, x1, x2, m0, m1, m2 = times(W, DAMP + l, r0, r1, r2, r3, r4, r5)
        lost = (x0 * r0 + x1 * r1 + x2 * r2) + (m0 * r3 + m1 * r4 + m2 * r5)
        N0, N1, N2, M0, M1, M2 = N0 + x0, N1 + x1, N2 + x2, M0 + m0, M1 + m1, M2 + m2
        put(W, SECTION + l, N0, N1, N2)
        put(W, SECTION + 24 + l, M0, M1, M2)
        weight = w * W[LENGTH + l]
        W[ENERGY + l] += weight * stored
        W[ENERGY + 8 + l] += weight * lost
        W[ENERGY + 16 + l] += weight * kinetic
        # generalised forces
        x0, x1, x2 = cross(t0, t1, t2, N0, N1, N2)
        y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
        f6, f7, f8 = N0 + a * x0 + b * y0, N1 + a * x1 + b * y1, N2 + a * x2 + b * y2
        x0, x1, x2 = cross(t0, t1, t2, M0, M1, M2)
        y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
        f3, f4, f5 = M0 + b * x0 + c * y0, M1 + b * x1 + c * y1, M2 + b * x2 + c * y2
        x0, x1, x2 = cross(N0, N1, N2, g0, g1, g2)
        i0, i1, i2 = i0 + x0, i1 + x1, i2 + x2
        x0, x1, x2 = cross(t0, t1, t2, i0, i1, i2)
        y0, y1, y2 = cross(t0, t1, t2, x0, x1, x2)
        m0, m1, m2 = cross(u0, u1, u2, M0, M1, M2)
        tu, tM = t0 * u0 + t1 * u1 + t2 * u2, t0 * M0 + t1 * M1 + t2 * M2
        along = dc * (M0 * q0 + M1 * q1 + M2 * q2) - db * (M0 * p0 + M1 * p1 + M2 * p2)
        along = 2.0 * (along - c * (u0 * M0 + u1 * M1 + u2 * M2))
        f0 = i0 + b * x0 + c * y0 - b * m0 + c * (M0 * tu + u0 * tM) + along * t0
        f1 = i1 + b * x1 + c * y1 - b * m1 + c * (M1 * tu + u1 * tM) + along * t1
        f2 = i2 + b * x2 + c * y2 - b * m2 + c * (M2 * tu + u2 * tM) + along * t2
        put(W, FORCE + l, f0, f1, f2)
        put(W, FORCE + 24 + l, f3, f4, f5)
        put(W, FORCE + 48 + l, f6, f7, f8)
        steep = w * h4
        add(W, NODAL + l, steep, f6, f7, f8)
        add(W, NODAL + 24 + l, weight * h5, f6, f7, f8)
        add(W, NODAL + 48 + l, weight * h0, f0, f1, f2)
        add(W, NODAL + 48 + l, steep, f3, f4, f5)
        add(W, NODAL + 72 + l, weight * n1, f0, f1, f2)
        add(W, NODAL + 72 + l, weight * h5, f3, f4, f5)
        add(W, NODAL + 96 + l, -steep, f6, f7, f8)
        add(W, NODAL + 120 + l, weight * h7, f6, f7, f8)
        add(W, NODAL + 144 + l, weight * h2, f0, f1, f2)
        add(W, NODAL + 144 + l, -steep, f3, f4, f5)
        add(W, NODAL + 168 + l, weight * n3, f0, f1, f2)
        add(W, NODAL + 168 + l, weight * h7, f3, f4, f5)

"""The contact forces of eight elements at once: what a step spends its time on besides the rod's own force.

The same law as :func:`beam.contact_force.point_contact`, where it is stated; the tests compare the two to round-off. Here it
has no branches: where a point does not touch, its numbers are multiplied by zero. The work array is laid out as that of
:mod:`beam.point_force`. Surfaces that none of the eight elements can reach are left out.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import embedded, kernel
from beam.contact_force import PLANE, gap_and_normal, out_of_reach
from beam.hermite import hermite_values
from beam.point_force import LANES, ROW, add, put, value
from beam.sliding_friction import friction_coefficient

Array = NDArray[np.float64]

LENGTH, ANCHOR, MOVED, NODAL, REPORT, DEPTH, FRICTION, END = (
    12 * ROW + LANES * k for k in (0, 1, 4, 7, 19, 24, 26, 27)
)
"""Where in the work array, after positions, slopes and their velocities of the nodes: length, anchors before and after, forces
on both nodes, five sums, penetration and its element, friction coefficient."""


@kernel
def point_contacts(W: Array, p: Array, N: Array, w: float, begin: float) -> None:  # noqa: PLR0915 - the formulas written out
    """One contact point of weight `w` on each of the eight elements from `begin` on; `N` (4,) shapes for length one."""
    h0, h1, h2, h3, plane = N[0], N[1], N[2], N[3], p[0] == PLANE
    kn, cn, kt, ct, k0, k1, k2, offset = p[1], p[2], p[4], p[5], p[6], p[7], p[8], p[9]
    c0, c1, c2, s0, s1, s2, radius, spin = p[10], p[11], p[12], p[13], p[14], p[15], p[16], p[23]
    low0, low1, low2, high0, high1, high2, cosine, sine = p[17], p[18], p[19], p[20], p[21], p[22], p[24], p[25]
    rubs = p[3] + p[26] > 0.0
    for l in range(LANES):
        n1, n3 = h1 * W[LENGTH + l], h3 * W[LENGTH + l]
        x0, x1, x2 = value(W, l, h0, n1, h2, n3)
        u0, u1, u2 = value(W, l + 6 * ROW, h0, n1, h2, n3)
        y0, y1, y2 = x0 - c0, x1 - c1, x2 - c2
        distance = max(np.sqrt(y0 * y0 + y1 * y1), 1e-12)
        gap = offset - (k0 * x0 + k1 * x1 + k2 * x2) if plane else radius - distance
        m0 = k0 if plane else y0 / distance
        m1 = k1 if plane else y1 / distance
        m2 = k2 if plane else 0.0
        inside = (x0 >= low0) & (x0 <= high0) & (x1 >= low1) & (x1 <= high1) & (x2 >= low2) & (x2 <= high2)
        touches = inside & (gap > 0.0)
        weight = w * W[LENGTH + l] if touches else 0.0
        z0, z1 = s0 - spin * y1, s1 + spin * y0
        u0, u1, u2 = u0 - z0, u1 - z1, u2 - s2
        closing = -(m0 * u0 + m1 * u1 + m2 * u2)
        fn = max(kn * gap + cn * closing, 0.0)
        # bristle from the anchor, which it may drag, trial friction, return to the cone
        d0, d1, a2 = W[ANCHOR + l], W[ANCHOR + 8 + l], W[ANCHOR + 16 + l]
        held = d0 == d0
        a0 = d0 * cosine - d1 * sine if held else y0
        a1 = d0 * sine + d1 * cosine if held else y1
        a2 = a2 if held else y2
        along = m0 * (y0 - a0) + m1 * (y1 - a1) + m2 * (y2 - a2)
        b0, b1, b2 = y0 - a0 - along * m0, y1 - a1 - along * m1, y2 - a2 - along * m2
        elastic, limit = kt * np.sqrt(b0 * b0 + b1 * b1 + b2 * b2), W[FRICTION + l] * fn
        slid = elastic > limit
        scale = limit / elastic if slid else 1.0
        b0, b1, b2 = scale * b0, scale * b1, scale * b2
        t0 = -kt * b0 - ct * (u0 + closing * m0)
        t1 = -kt * b1 - ct * (u1 + closing * m1)
        t2 = -kt * b2 - ct * (u2 + closing * m2)
        size = np.sqrt(t0 * t0 + t1 * t1 + t2 * t2)
        scale = limit / size if size > limit else 1.0
        t0, t1, t2 = scale * t0, scale * t1, scale * t2
        a0, a1, a2 = y0 - b0 if slid else a0, y1 - b1 if slid else a1, y2 - b2 if slid else a2
        put(W, MOVED + l, a0 * cosine + a1 * sine if touches & rubs else np.nan, a1 * cosine - a0 * sine, a2)
        f0, f1, f2 = fn * m0 + t0, fn * m1 + t1, fn * m2 + t2
        W[REPORT + l] += weight * 0.5 * kn * gap * gap
        W[REPORT + 8 + l] += weight * 0.5 * kt * (b0 * b0 + b1 * b1 + b2 * b2)
        W[REPORT + 16 + l] += weight * (fn - kn * gap) * closing
        W[REPORT + 24 + l] -= weight * (t0 * u0 + t1 * u1 + t2 * u2)
        W[REPORT + 32 + l] += weight * (f0 * z0 + f1 * z1 + f2 * s2)
        deeper = touches & (gap > W[DEPTH + l])
        W[DEPTH + 8 + l] = begin + l if deeper else W[DEPTH + 8 + l]
        W[DEPTH + l] = gap if deeper else W[DEPTH + l]
        add(W, NODAL + l, -weight * h0, f0, f1, f2)
        add(W, NODAL + 24 + l, -weight * n1, f0, f1, f2)
        add(W, NODAL + 48 + l, -weight * h2, f0, f1, f2)
        add(W, NODAL + 72 + l, -weight * n3, f0, f1, f2)


@kernel
def sliding(W: Array, p: Array, N: Array, w: float) -> None:
    """Before :func:`point_contacts`, where the surface asks for the speed: friction coefficient of every lane, and the drag."""
    for l in range(LANES):
        h0, h1, h2, h3, length = N[0], N[1], N[2], N[3], W[LENGTH + l]
        x0, x1, x2 = value(W, l, h0, h1 * length, h2, h3 * length)
        gap, _, m0, m1, m2 = gap_and_normal(p, x0, x1, x2)
        W[FRICTION + l] = p[3] + p[26]
        if not gap > 0.0:
            continue
        z0, z1 = p[13] - p[23] * (x1 - p[11]), p[14] + p[23] * (x0 - p[10])
        u0, u1, u2 = value(W, l + 6 * ROW, h0, h1 * length, h2, h3 * length)
        u0, u1, u2 = u0 - z0, u1 - z1, u2 - p[15]
        along = m0 * u0 + m1 * u1 + m2 * u2
        u0, u1, u2 = u0 - along * m0, u1 - along * m1, u2 - along * m2
        square, f = u0 * u0 + u1 * u1 + u2 * u2, -w * length * p[29]
        W[FRICTION + l] = friction_coefficient(p, np.sqrt(square))
        W[REPORT + 24 + l] -= f * square
        W[REPORT + 32 + l] += f * (u0 * z0 + u1 * z1 + u2 * p[15])
        add(W, NODAL + l, -h0, f * u0, f * u1, f * u2)
        add(W, NODAL + 24 + l, -h1 * length, f * u0, f * u1, f * u2)
        add(W, NODAL + 48 + l, -h2, f * u0, f * u1, f * u2)
        add(W, NODAL + 72 + l, -h3 * length, f * u0, f * u1, f * u2)


@embedded
def load(q: Array, v: Array, lengths: Array, begin: int, count: int, W: Array) -> None:
    """Copy the nodes of `count` elements into the work array and empty the forces."""
    for l in range(count + 1):
        for k in range(6):
            W[ROW * k + l], W[ROW * (6 + k) + l] = q[begin + l, k], v[begin + l, k]
    for l in range(count):
        W[LENGTH + l] = lengths[begin + l]
    for i in range(NODAL, REPORT):
        W[i] = 0.0


@embedded
def surface_contacts(
    p: Array,
    N: Array,
    ws: Array,
    begin: int,
    count: int,
    row: int,
    anchors: Array,
    moved: Array,
    report: Array,
    W: Array,
) -> None:
    """All contact points of `count` elements on one surface; its anchors begin at `row`."""
    points = ws.size
    for i in range(REPORT, END):
        W[i] = 0.0
    for l in range(LANES):
        W[FRICTION + l] = p[3]
    for g in range(points):
        for l in range(count):
            j = row + l * points + g
            put(W, ANCHOR + l, anchors[j, 0], anchors[j, 1], anchors[j, 2])
        if p[26] > 0.0 or p[29] > 0.0:
            sliding(W, p, N[g], ws[g])
        point_contacts(W, p, N[g], ws[g], float(begin))
        for l in range(count):
            j = row + l * points + g
            moved[j, 0], moved[j, 1], moved[j, 2] = W[MOVED + l], W[MOVED + 8 + l], W[MOVED + 16 + l]
    for l in range(count):
        for k in range(5):
            report[k] += W[REPORT + LANES * k + l]
        if W[DEPTH + l] > report[5]:
            report[5], report[6] = W[DEPTH + l], W[DEPTH + LANES + l]


@kernel
def contact_residual(  # noqa: C901 - loops over surfaces and lanes
    P: Array, first: NDArray[np.int64], xs: Array, ws: Array, q: Array, v: Array, lengths: Array, anchors: Array,
    moved: Array, F: Array, reports: Array,
) -> None:  # fmt: skip
    """:func:`beam.contact_force.contact_forces` without tangent and without what is collected at the nodes."""
    n, W, N = lengths.size, np.zeros(END), np.empty((xs.size, 4))
    for g in range(xs.size):
        hermite_values(xs[g], 1.0, N[g])
    for k in range(P.shape[0]):
        for i in range(7):
            reports[k, i] = 0.0
    for begin in range(0, n, LANES):
        count, loaded = min(LANES, n - begin), False
        for k in range(P.shape[0]):
            i, j = first[k], first[k + 1]
            row, near = n * i + begin * (j - i), False
            for l in range(count):
                near = near or not out_of_reach(P[k], q, begin + l, lengths[begin + l])
            if not near:
                for r in range(row, row + count * (j - i)):
                    moved[r, 0] = np.nan
                continue
            if not loaded:
                loaded = True
                load(q, v, lengths, begin, count, W)
            surface_contacts(P[k], N[i:j], ws[i:j], begin, count, row, anchors, moved, reports[k], W)
        if loaded:
            for l in range(count):
                for k in range(6):
                    F[begin + l, k] += W[NODAL + LANES * k + l]
                    F[begin + l + 1, k] += W[NODAL + LANES * (6 + k) + l]

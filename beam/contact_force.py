r"""Contact of the centre line with planes and cylinders: penalty normal force, Coulomb friction by bristles.

Per length of cable, with the penetration g > 0 and the outward normal n of the surface,

.. math:: f_n = \max(0,\; k_n g + c_n \dot g), \qquad
          b = (I - n n^T)(x - \text{anchor}), \quad t^* = -k_t\,b - c_t\,\dot x_t,

    t = t^*  while |t*| <= mu f_n (stick),   t = mu f_n t*/|t*|  otherwise (slip).

The bristle b is elastic, so that stick is exact: below the limit nothing creeps. Where k_t |b| would exceed mu f_n the anchor
follows such that it is mu f_n, and this b enters t*. What loses energy is then never negative, because t is the projection
of t* on a ball that -k_t b lies in. The damping alone never moves the anchor: if it did, every jolt would strain the
bristle, and a slip front would run ahead the further, the longer the time steps are. Anchors are committed at the end of
a converged step only, never inside an iteration. The tangent is the derivative of this return map. mu may fall with the
sliding speed, and a drag may come to t, see :mod:`beam.sliding_friction`.

Source: J. C. Simo, T. A. Laursen, Comput. Struct. 42 (1992) 97-116, doi 10.1016/0045-7949(92)90540-G.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import embedded, kernel
from beam.hermite import hermite_values
from beam.sliding_friction import friction_coefficient, speed_tangent

Array = NDArray[np.float64]

PLANE, CYLINDER = 0.0, 1.0
PARAMETERS = 30
"""kind, kn, cn, mu, kt, ct, normal (6:9), offset, centre (10:13), its velocity (13:16), radius, box low (17:20), high (20:23),
turning about z: angular velocity, cosine and sine of the angle; (26:30) as of :mod:`beam.sliding_friction`."""


@kernel
def gap_and_normal(p: Array, x0: float, x1: float, x2: float) -> tuple[float, float, float, float, float]:
    """Penetration of the point x, distance from the cylinder's axis, outward normal; no contact outside the box."""
    if x0 < p[17] or x0 > p[20] or x1 < p[18] or x1 > p[21] or x2 < p[19] or x2 > p[22]:
        return -1.0, 1e30, 0.0, 0.0, 0.0
    if p[0] == PLANE:
        return p[9] - (p[6] * x0 + p[7] * x1 + p[8] * x2), 1e30, p[6], p[7], p[8]
    dx, dy = x0 - p[10], x1 - p[11]
    distance = max(np.sqrt(dx * dx + dy * dy), 1e-12)
    return p[16] - distance, distance, dx / distance, dy / distance, 0.0


@kernel
def normal_tangent(n: Array, slope: float, curvature: float, K: Array) -> None:
    """Write the derivative of the normal force: `slope` along n, `curvature` = f_n / radius across it in the plane."""
    for i in range(3):
        for j in range(3):
            across = (1.0 if i == j and i < 2 else 0.0) - n[i] * n[j]
            K[i, j] = slope * n[i] * n[j] - curvature * across


@kernel
def friction_tangent(
    n: Array, b: Array, trial: Array, slid: bool, limit: float, kt: float, damping: float, coupling: float, fade: Array,
    K: Array,
) -> None:  # fmt: skip
    """Add the derivative of the return map: `damping` = ct factor, `coupling` = mu d(f_n)/d(gap), `fade` (3,) = -f_n d(mu)/dx;
    `b` as it was before its return."""
    reach = np.sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2])
    size = np.sqrt(trial[0] * trial[0] + trial[1] * trial[1] + trial[2] * trial[2])
    column = np.empty(3)
    for j in range(3):
        along = 0.0
        for i in range(3):
            across = (1.0 if i == j else 0.0) - n[i] * n[j]
            column[i] = (kt + damping) * across
            if slid:
                column[i] = limit / reach * (across - b[i] * b[j] / (reach * reach)) + damping * across
                column[i] -= coupling * b[i] / reach * n[j]
                column[i] -= fade[j] * b[i] / reach
            along += trial[i] * column[i]
        for i in range(3):
            if size > limit:
                column[i] = limit / size * (column[i] - trial[i] * along / (size * size))
                column[i] += coupling * trial[i] / size * n[j]
                column[i] += fade[j] * trial[i] / size
            K[i, j] += column[i]


@kernel
def bristle(
    p: Array, y0: float, y1: float, y2: float, a0: float, a1: float, a2: float, u0: float, u1: float, u2: float,
    n0: float, n1: float, n2: float, closing: float, limit: float,
) -> tuple[float, float, float, float, float, float, bool]:  # fmt: skip
    """Bristle b from the anchor a to the point y, and trial friction -kt b - ct v, along the surface; True if it drags its anchor."""
    along = n0 * (y0 - a0) + n1 * (y1 - a1) + n2 * (y2 - a2)
    b0, b1, b2 = y0 - a0 - along * n0, y1 - a1 - along * n1, y2 - a2 - along * n2
    elastic = p[4] * np.sqrt(b0 * b0 + b1 * b1 + b2 * b2)
    slid = elastic > limit
    if slid:
        b0, b1, b2 = limit / elastic * b0, limit / elastic * b1, limit / elastic * b2
    t0 = -p[4] * b0 - p[5] * (u0 + closing * n0)
    t1 = -p[4] * b1 - p[5] * (u1 + closing * n1)
    t2 = -p[4] * b2 - p[5] * (u2 + closing * n2)
    return b0, b1, b2, t0, t1, t2, slid


@kernel
def out_of_reach(p: Array, q: Array, e: int, length: float) -> bool:
    """True if both nodes of the element are so far from the surface that no point between them can touch it."""
    far = 2.0 * length
    for a in range(2):
        if p[0] == CYLINDER:
            dx, dy = q[e + a, 0] - p[10], q[e + a, 1] - p[11]
            if np.sqrt(dx * dx + dy * dy) <= p[16] + far:
                return False
        else:
            height = p[6] * q[e + a, 0] + p[7] * q[e + a, 1] + p[8] * q[e + a, 2] - p[9]
            outside = False
            for i in range(3):
                outside |= q[e + a, i] < p[17 + i] - far or q[e + a, i] > p[20 + i] + far
            if height <= far and not outside:
                return False
    return True


@embedded
def point_contact(
    p: Array, e: int, g: int, j: int, q: Array, v: Array, N: Array, anchors: Array, moved: Array, report: Array,
    weight: float, drag: Array,
) -> tuple[float, float, float, float, float, float, float, float, float]:  # fmt: skip
    """One contact point: f_n, normal, friction, distance from the axis, mu; adds to `report`.

    Writes the anchor to commit (`moved`, relative to the surface's centre, turning with it) and, where the surface has one, the
    `drag` (3,), which the friction does not contain. f_n is -1 without contact.
    """
    N0, N1, N2, N3 = N[g, 0], N[g, 1], N[g, 2], N[g, 3]
    x0 = (N0 * q[e, 0] + N1 * q[e, 3]) + (N2 * q[e + 1, 0] + N3 * q[e + 1, 3])
    x1 = (N0 * q[e, 1] + N1 * q[e, 4]) + (N2 * q[e + 1, 1] + N3 * q[e + 1, 4])
    x2 = (N0 * q[e, 2] + N1 * q[e, 5]) + (N2 * q[e + 1, 2] + N3 * q[e + 1, 5])
    gap, distance, n0, n1, n2 = gap_and_normal(p, x0, x1, x2)
    if gap <= 0.0:
        moved[j, 0] = np.nan
        return -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    w0, w1 = p[13] - p[23] * (x1 - p[11]), p[14] + p[23] * (x0 - p[10])
    u0 = (N0 * v[e, 0] + N1 * v[e, 3]) + (N2 * v[e + 1, 0] + N3 * v[e + 1, 3]) - w0
    u1 = (N0 * v[e, 1] + N1 * v[e, 4]) + (N2 * v[e + 1, 1] + N3 * v[e + 1, 4]) - w1
    u2 = (N0 * v[e, 2] + N1 * v[e, 5]) + (N2 * v[e + 1, 2] + N3 * v[e + 1, 5]) - p[15]
    closing = -(n0 * u0 + n1 * u1 + n2 * u2)
    fn = max(p[1] * gap + p[2] * closing, 0.0)
    report[0] += weight * 0.5 * p[1] * gap * gap
    report[2] += weight * (fn - p[1] * gap) * closing
    t0, t1, t2, mu = 0.0, 0.0, 0.0, p[3]
    if p[26] > 0.0 or p[29] > 0.0:
        s0, s1, s2 = u0 + closing * n0, u1 + closing * n1, u2 + closing * n2
        mu = friction_coefficient(p, np.sqrt(s0 * s0 + s1 * s1 + s2 * s2))
        drag[0], drag[1], drag[2] = -p[29] * s0, -p[29] * s1, -p[29] * s2
        report[3] += weight * p[29] * (s0 * s0 + s1 * s1 + s2 * s2)
        report[4] += weight * (drag[0] * w0 + drag[1] * w1 + drag[2] * p[15])
    if mu > 0.0:
        limit = mu * fn
        y0, y1, y2 = x0 - p[10], x1 - p[11], x2 - p[12]
        a0, a1, a2 = (
            anchors[j, 0] * p[24] - anchors[j, 1] * p[25],
            anchors[j, 0] * p[25] + anchors[j, 1] * p[24],
            anchors[j, 2],
        )
        if a0 != a0:
            a0, a1, a2 = y0, y1, y2
        b0, b1, b2, t0, t1, t2, slid = bristle(p, y0, y1, y2, a0, a1, a2, u0, u1, u2, n0, n1, n2, closing, limit)
        size = np.sqrt(t0 * t0 + t1 * t1 + t2 * t2)
        if size > limit:
            scale = limit / size
            t0, t1, t2 = scale * t0, scale * t1, scale * t2
        if slid:
            a0, a1, a2 = y0 - b0, y1 - b1, y2 - b2
        moved[j, 0], moved[j, 1], moved[j, 2] = a0 * p[24] + a1 * p[25], a1 * p[24] - a0 * p[25], a2
        report[1] += weight * 0.5 * p[4] * (b0 * b0 + b1 * b1 + b2 * b2)
        report[3] -= weight * (t0 * u0 + t1 * u1 + t2 * u2)
    else:
        moved[j, 0] = np.nan
    f0, f1, f2 = fn * n0 + t0, fn * n1 + t1, fn * n2 + t2
    report[4] += weight * (f0 * w0 + f1 * w1 + f2 * p[15])
    if gap > report[5]:
        report[5], report[6] = gap, e
    return fn, n0, n1, n2, t0, t1, t2, distance, mu


@embedded
def point_tangent(
    p: Array, e: int, g: int, j: int, q: Array, v: Array, N: Array, anchors: Array, n: Array, distance: float,
    fn: float, factor: float, trial: Array, K: Array,
) -> None:  # fmt: skip
    """Write the stiffness K = -d(force)/dx - factor d(force)/dv of a point in contact; `n` (3,) is its normal."""
    slope = p[1] + p[2] * factor if fn > 0.0 else 0.0
    normal_tangent(n, slope, fn / distance, K)
    if p[3] == 0.0 and p[26] == 0.0 and p[29] == 0.0:
        return
    x, u, fade = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in range(3):
        for k in range(4):
            x[i] += N[g, k] * q[e + k // 2, 3 * (k % 2) + i]
            u[i] += N[g, k] * v[e + k // 2, 3 * (k % 2) + i]
        x[i] -= p[10 + i]
        u[i] -= p[13 + i]
    u[0] += p[23] * x[1]
    u[1] -= p[23] * x[0]
    closing = -(n[0] * u[0] + n[1] * u[1] + n[2] * u[2])
    mu = speed_tangent(p, u, n, closing, fn, factor, fade, K)
    if mu == 0.0:
        return
    a0, a1, a2 = (
        anchors[j, 0] * p[24] - anchors[j, 1] * p[25],
        anchors[j, 0] * p[25] + anchors[j, 1] * p[24],
        anchors[j, 2],
    )
    if a0 != a0:
        a0, a1, a2 = x[0], x[1], x[2]
    _, _, _, t0, t1, t2, slid = bristle(
        p, x[0], x[1], x[2], a0, a1, a2, u[0], u[1], u[2], n[0], n[1], n[2], closing, mu * fn
    )  # fmt: skip
    trial[0], trial[1], trial[2] = t0, t1, t2
    x[0], x[1], x[2] = x[0] - a0, x[1] - a1, x[2] - a2
    along = n[0] * x[0] + n[1] * x[1] + n[2] * x[2]
    for i in range(3):
        x[i] -= along * n[i]
    friction_tangent(n, x, trial, slid, mu * fn, p[4], p[5] * factor, mu * slope, fade, K)


@kernel
def shapes_at(xs: Array, length: float, N: Array) -> None:
    """Write the shape functions of an element at the contact points into `N` (points, 4)."""
    for g in range(xs.size):
        hermite_values(xs[g], length, N[g])


@embedded
def contact_force(  # noqa: C901 - loops over components
    p: Array, begin: int, q: Array, v: Array, lengths: Array, xs: Array, ws: Array, anchors: Array, moved: Array,
    F: Array, nodal: Array, friction: Array, report: Array, cone: Array, collect: bool,
    want_tangent: bool, factor: float, D: Array, U: Array, L: Array,
) -> None:  # fmt: skip
    """Subtract the contact forces of one surface from `F` (n + 1, 12) and add their tangent to the blocks.

    `xs`, `ws` contact points in [0, 1] and weights; `anchors`, `moved` committed and candidate anchors (NaN: none yet),
    three numbers a contact point, those of this surface from row `begin` on. To `collect` means to add all contact
    forces, and their friction part, to `nodal` and `friction` (n + 1, 3) and to write |t| / (mu f_n) into `cone`.
    `report` receives penalty energy, bristle energy,
    power lost in normal damping, power of friction, power of the moving surface, deepest penetration, its element.
    """
    N, n, trial, K, at = np.empty((xs.size, 4)), np.empty(3), np.empty(3), np.zeros((3, 3)), -1.0
    d = np.zeros(3)
    for i in range(7):
        report[i] = 0.0
    for e in range(lengths.size):
        j0 = begin + e * xs.size
        if out_of_reach(p, q, e, lengths[e]):
            for g in range(xs.size):
                moved[j0 + g, 0] = np.nan
            continue
        if lengths[e] != at:
            at = lengths[e]
            shapes_at(xs, at, N)
        for g in range(xs.size):
            weight = ws[g] * at
            fn, n0, n1, n2, t0, t1, t2, distance, mu = point_contact(
                p, e, g, j0 + g, q, v, N, anchors, moved, report, weight, d
            )  # fmt: skip
            if fn < 0.0:
                continue
            f0, f1, f2 = weight * (fn * n0 + t0), weight * (fn * n1 + t1), weight * (fn * n2 + t2)
            f0, f1, f2 = f0 + weight * d[0], f1 + weight * d[1], f2 + weight * d[2]
            for k in range(4):
                row, slot, part = e + k // 2, 3 * (k % 2), N[g, k]
                F[row, slot] -= part * f0
                F[row, slot + 1] -= part * f1
                F[row, slot + 2] -= part * f2
            if collect:
                n[0], n[1], n[2], trial[0], trial[1], trial[2] = f0, f1, f2, weight * t0, weight * t1, weight * t2
                collect_point(e, j0 + g, xs[g], n, trial, mu * fn * weight, nodal, friction, cone)
            if want_tangent:
                n[0], n[1], n[2] = n0, n1, n2
                point_tangent(p, e, g, j0 + g, q, v, N, anchors, n, distance, fn, factor, trial, K)
                scatter_contact(K, e, weight, N[g], D, U, L)


@embedded
def collect_point(
    e: int, j: int, x: float, force: Array, shear: Array, limit: float, nodal: Array, friction: Array, cone: Array
) -> None:
    """Share the force of one point, and its friction part, between the two nodes; write its use of the friction cone."""
    size = np.sqrt(shear[0] * shear[0] + shear[1] * shear[1] + shear[2] * shear[2])
    cone[j] = size / limit if limit > 0.0 else 0.0
    for i in range(3):
        nodal[e, i] += (1.0 - x) * force[i]
        nodal[e + 1, i] += x * force[i]
        friction[e, i] += (1.0 - x) * shear[i]
        friction[e + 1, i] += x * shear[i]


@kernel
def contact_forces(
    P: Array, first: NDArray[np.int64], xs: Array, ws: Array, q: Array, v: Array, lengths: Array, anchors: Array, moved: Array,
    F: Array, nodal: Array, friction: Array, reports: Array, cone: Array, collect: bool,
    want_tangent: bool, factor: float, D: Array, U: Array, L: Array,
) -> None:  # fmt: skip
    """:func:`contact_force` of all surfaces: parameters `P` (surfaces, 30), contact points of surface k from `first`[k] on.

    `anchors`, `moved` (n points, 3) and `cone` (n points,) hold the surfaces one after the other; `reports` (surfaces, 7).
    """
    for k in range(P.shape[0]):
        i, j = first[k], first[k + 1]
        contact_force(
            P[k], lengths.size * i, q, v, lengths, xs[i:j], ws[i:j], anchors, moved, F, nodal, friction, reports[k], cone,
            collect, want_tangent, factor, D, U, L,
        )  # fmt: skip


@kernel
def scatter_contact(K: Array, e: int, weight: float, N: Array, D: Array, U: Array, L: Array) -> None:
    """Add N^T K N of one contact point to the blocks."""
    for a in range(4):
        for b in range(4):
            na, nb = a // 2, b // 2
            if na == nb:
                add_point_block(D, e + na, a % 2, b % 2, weight * N[a] * N[b], K)
            elif na == 0:
                add_point_block(U, e, a % 2, b % 2, weight * N[a] * N[b], K)
            else:
                add_point_block(L, e, a % 2, b % 2, weight * N[a] * N[b], K)


@kernel
def add_point_block(blocks: Array, k: int, a: int, b: int, weight: float, K: Array) -> None:
    """Add weight K to the position (0) or slope (1) rows `a` and columns `b` of block `k`."""
    for i in range(3):
        for j in range(3):
            blocks[k, 3 * a + i, 3 * b + j] += weight * K[i, j]

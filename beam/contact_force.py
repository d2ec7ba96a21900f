r"""Contact of the centre line with planes and cylinders: penalty normal force, Coulomb friction by bristles.

Per length of cable, with the penetration g > 0 and the outward normal n of the surface,

.. math:: f_n = \max(0,\; k_n g + c_n \dot g), \qquad
          t^* = -k_t\,b - c_t\,\dot x_t, \quad b = (I - n n^T)(x - \text{anchor}),

    t = t^*  while |t*| <= mu f_n (stick),   t = mu f_n t*/|t*|  otherwise (slip).

The bristle b is elastic, so that stick is exact: below the limit nothing creeps. In slip the anchor follows such that the
bristle carries exactly t; anchors are committed at the end of a converged step only, never inside an iteration.
The tangent is the derivative of this return map.

Source: J. C. Simo, T. A. Laursen, Comput. Struct. 42 (1992) 97-116, doi 10.1016/0045-7949(92)90540-G.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel
from beam.hermite import hermite_values

Array = NDArray[np.float64]

PLANE, CYLINDER = 0.0, 1.0
PARAMETERS = 23
"""kind, kn, cn, mu, kt, ct, normal (6:9), offset, centre (10:13), its velocity (13:16), radius, box low (17:20), high (20:23)."""


@kernel
def gap_and_normal(p: Array, x: Array, n: Array) -> tuple[float, float]:
    """Penetration of the point `x` and distance from the cylinder's axis; writes the outward normal into `n`."""
    if p[0] == PLANE:
        n[0], n[1], n[2] = p[6], p[7], p[8]
        return p[9] - (n[0] * x[0] + n[1] * x[1] + n[2] * x[2]), 1e30
    dx, dy = x[0] - p[10], x[1] - p[11]
    distance = max(np.sqrt(dx * dx + dy * dy), 1e-12)
    n[0], n[1], n[2] = dx / distance, dy / distance, 0.0
    return p[16] - distance, distance


@kernel
def normal_force(
    p: Array,
    gap: float,
    distance: float,
    u: Array,
    n: Array,
    want_tangent: bool,
    factor: float,
    normal: Array,
    K: Array,
) -> tuple[float, float, float, float]:
    """Normal force per length; returns its size, d(size)/d(gap) with damping, the closing speed and the power lost."""
    closing = -(n[0] * u[0] + n[1] * u[1] + n[2] * u[2])
    size = p[1] * gap + p[2] * closing
    slope = p[1] + p[2] * factor
    if size <= 0.0:
        size, slope = 0.0, 0.0
    for i in range(3):
        normal[i] = size * n[i]
    if want_tangent:
        for i in range(3):
            for j in range(3):
                across = (1.0 if i == j and i < 2 else 0.0) - n[i] * n[j]
                K[i, j] = slope * n[i] * n[j] - size / distance * across
    return size, slope, closing, (size - p[1] * gap) * closing


@kernel
def friction_tangent(
    n: Array, trial: Array, size: float, limit: float, stiff: float, coupling: float, K: Array
) -> None:
    """Add the derivative of the return map: `stiff` = kt + ct factor, `coupling` = mu d(f_n)/d(gap)."""
    for i in range(3):
        for j in range(3):
            across = (1.0 if i == j else 0.0) - n[i] * n[j]
            if size > limit:
                across = limit / size * (across - trial[i] * trial[j] / (size * size))
                K[i, j] += coupling * trial[i] / size * n[j]
            K[i, j] += stiff * across


@kernel
def friction_force(
    p: Array, x: Array, u: Array, n: Array, fn: float, fn_gap: float, closing: float, want_tangent: bool, factor: float,
    anchors: Array, e: int, g: int, shear: Array, moved: Array, K: Array,
) -> tuple[float, float]:  # fmt: skip
    """Friction per length by the return map; writes the anchor to commit, returns bristle energy and friction power."""
    kt, ct, limit = p[4], p[5], p[3] * fn
    y0, y1, y2 = x[0] - p[10], x[1] - p[11], x[2] - p[12]
    a0, a1, a2 = anchors[e, g, 0], anchors[e, g, 1], anchors[e, g, 2]
    if a0 != a0:
        a0, a1, a2 = y0, y1, y2
    n0, n1, n2 = n[0], n[1], n[2]
    along = n0 * (y0 - a0) + n1 * (y1 - a1) + n2 * (y2 - a2)
    b0, b1, b2 = y0 - a0 - along * n0, y1 - a1 - along * n1, y2 - a2 - along * n2
    t0 = -kt * b0 - ct * (u[0] + closing * n0)
    t1 = -kt * b1 - ct * (u[1] + closing * n1)
    t2 = -kt * b2 - ct * (u[2] + closing * n2)
    size = np.sqrt(t0 * t0 + t1 * t1 + t2 * t2)
    if want_tangent:
        shear[0], shear[1], shear[2] = t0, t1, t2
        friction_tangent(n, shear, size, limit, kt + ct * factor, p[3] * fn_gap, K)
    if size > limit:
        scale = limit / size
        t0, t1, t2 = scale * t0, scale * t1, scale * t2
        b0, b1, b2 = -t0 / kt, -t1 / kt, -t2 / kt
        a0, a1, a2 = y0 - b0, y1 - b1, y2 - b2
    shear[0], shear[1], shear[2] = t0, t1, t2
    moved[e, g, 0], moved[e, g, 1], moved[e, g, 2] = a0, a1, a2
    return 0.5 * kt * (b0 * b0 + b1 * b1 + b2 * b2), -(t0 * u[0] + t1 * u[1] + t2 * u[2])


@kernel
def point_force(
    p: Array, x: Array, u: Array, want_tangent: bool, factor: float, anchors: Array, e: int, g: int,
    n: Array, normal: Array, shear: Array, moved: Array, K: Array,
) -> tuple[float, float, float, float, float]:  # fmt: skip
    """Force per length at the point `x` with velocity `u` relative to the surface's own motion.

    Writes the normal and the friction force, the anchor to commit (`moved`, relative to the centre; NaN without contact)
    and the stiffness K = -d(force)/dx - factor d(force)/dv. Returns penetration, penalty energy, bristle energy, power
    lost in normal damping, power of friction; the penetration is negative where there is no contact.
    """
    gap, distance = gap_and_normal(p, x, n)
    moved[e, g, 0] = np.nan
    for i in range(3):
        if x[i] < p[17 + i] or x[i] > p[20 + i]:
            gap = -1.0
    if gap <= 0.0:
        return gap, 0.0, 0.0, 0.0, 0.0
    fn, fn_gap, closing, lost = normal_force(p, gap, distance, u, n, want_tangent, factor, normal, K)
    stored, power = 0.0, 0.0
    shear[0], shear[1], shear[2] = 0.0, 0.0, 0.0
    if p[3] > 0.0:
        stored, power = friction_force(
            p, x, u, n, fn, fn_gap, closing, want_tangent, factor, anchors, e, g, shear, moved, K
        )
    return gap, 0.5 * p[1] * gap * gap, stored, lost, power


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


@kernel
def interpolate_point(q: Array, v: Array, e: int, N: Array, drift: Array, x: Array, u: Array) -> None:
    """Write position and velocity relative to `drift` (3 values from index 13 on) of a point of element `e`."""
    n0, n1, n2, n3 = N[0], N[1], N[2], N[3]
    for i in range(3):
        x[i] = n0 * q[e, i] + n1 * q[e, 3 + i] + n2 * q[e + 1, i] + n3 * q[e + 1, 3 + i]
        u[i] = n0 * v[e, i] + n1 * v[e, 3 + i] + n2 * v[e + 1, i] + n3 * v[e + 1, 3 + i] - drift[13 + i]


@kernel
def scatter_force(
    e: int, x: float, weight: float, N: Array, normal: Array, shear: Array, F: Array, nodal: Array, friction: Array
) -> None:  # fmt: skip
    """Subtract the force of one point from `F`; collect it, and its friction part, at the two nodes."""
    n0, n1, n2, n3 = N[0], N[1], N[2], N[3]
    for i in range(3):
        f, t = weight * (normal[i] + shear[i]), weight * shear[i]
        F[e, i] -= n0 * f
        F[e, 3 + i] -= n1 * f
        F[e + 1, i] -= n2 * f
        F[e + 1, 3 + i] -= n3 * f
        nodal[e, i] += (1.0 - x) * f
        nodal[e + 1, i] += x * f
        friction[e, i] += (1.0 - x) * t
        friction[e + 1, i] += x * t


@kernel
def friction_use(mu: float, normal: Array, shear: Array) -> float:
    """|t| / (mu f_n), one in slip."""
    fn2 = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]
    if mu <= 0.0 or fn2 <= 0.0:
        return 0.0
    return np.sqrt((shear[0] * shear[0] + shear[1] * shear[1] + shear[2] * shear[2]) / fn2) / mu


@kernel
def contact_force(
    p: Array, q: Array, v: Array, lengths: Array, xs: Array, ws: Array, anchors: Array, moved: Array,
    F: Array, nodal: Array, friction: Array, report: Array, cone: Array,
    want_tangent: bool, factor: float, D: Array, U: Array, L: Array,
) -> None:  # fmt: skip
    """Subtract the contact forces of one surface from `F` (n + 1, 12) and add their tangent to the blocks.

    `xs`, `ws` contact points in [0, 1] and weights; `anchors`, `moved` (n, points, 3) committed and candidate anchors
    (NaN: none yet); `nodal`, `friction` (n + 1, 3) all contact forces, and their friction
    part, collected at the nodes; `cone` (n, points) is |t| / (mu f_n). `report` receives penalty energy, bristle energy,
    power lost in normal damping, power of friction, power of the moving surface, deepest penetration, its element.
    """
    N = np.empty(4)
    x, u, n, normal, shear = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    K = np.zeros((3, 3))
    report[:] = 0.0
    cone[:] = 0.0
    for e in range(lengths.size):
        if out_of_reach(p, q, e, lengths[e]):
            moved[e] = np.nan
            continue
        for g in range(xs.size):
            hermite_values(xs[g], lengths[e], N)
            interpolate_point(q, v, e, N, p, x, u)
            gap, pressed, stored, lost, power = point_force(
                p, x, u, want_tangent, factor, anchors, e, g, n, normal, shear, moved, K
            )
            if gap <= 0.0:
                continue
            weight = ws[g] * lengths[e]
            report[0] += weight * pressed
            report[1] += weight * stored
            report[2] += weight * lost
            report[3] += weight * power
            for i in range(3):
                report[4] += weight * (normal[i] + shear[i]) * p[13 + i]
            if gap > report[5]:
                report[5], report[6] = gap, e
            cone[e, g] = friction_use(p[3], normal, shear)
            scatter_force(e, xs[g], weight, N, normal, shear, F, nodal, friction)
            if want_tangent:
                scatter_contact(K, e, weight, N, D, U, L)


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

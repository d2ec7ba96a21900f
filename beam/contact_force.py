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
from beam.hermite import hermite

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
def point_force(
    p: Array, x: Array, u: Array, factor: float, anchor: Array, n: Array, normal: Array, shear: Array, moved: Array, K: Array
) -> tuple[float, float, float, float, float]:
    """Force per length at the point `x` with velocity `u` relative to the surface's own motion.

    Writes the normal and the friction force, the anchor to commit (`moved`, relative to the centre) and the stiffness
    K = -d(force)/dx - factor d(force)/dv. Returns penetration, penalty energy, bristle energy, power lost in normal
    damping, power of friction; the penetration is negative where there is no contact.
    """
    kn, cn, mu, kt, ct = p[1], p[2], p[3], p[4], p[5]
    gap, distance = gap_and_normal(p, x, n)
    for i in range(3):
        normal[i] = 0.0
        shear[i] = 0.0
        moved[i] = x[i] - p[10 + i]
        if x[i] < p[17 + i] or x[i] > p[20 + i]:
            gap = -1.0
    if gap <= 0.0:
        return gap, 0.0, 0.0, 0.0, 0.0
    closing = -(n[0] * u[0] + n[1] * u[1] + n[2] * u[2])
    fn = kn * gap + cn * closing
    stiff = kn + cn * factor
    if fn <= 0.0:
        fn, stiff = 0.0, 0.0
    curved = fn / distance
    for i in range(3):
        normal[i] = fn * n[i]
        for j in range(3):
            plane_ij = (1.0 if i == j and i < 2 else 0.0) - n[i] * n[j]
            K[i, j] = stiff * n[i] * n[j] - curved * plane_ij
    lost = (fn - kn * gap) * closing
    if mu <= 0.0:
        return gap, 0.5 * kn * gap * gap, 0.0, lost, 0.0
    along = 0.0
    for i in range(3):
        along += n[i] * (x[i] - p[10 + i] - anchor[i])
    size = 0.0
    for i in range(3):
        bristle = x[i] - p[10 + i] - anchor[i] - along * n[i]
        shear[i] = -kt * bristle - ct * (u[i] + closing * n[i])
        size += shear[i] * shear[i]
    size = np.sqrt(size)
    limit = mu * fn
    scale = 1.0
    slope = kt + ct * factor
    if size > limit:
        scale = limit / size
    stored = 0.0
    power = 0.0
    for i in range(3):
        direction = shear[i] / max(size, 1e-300)
        for j in range(3):
            P_ij = (1.0 if i == j else 0.0) - n[i] * n[j]
            if size > limit:
                P_ij -= direction * shear[j] / max(size, 1e-300)
                K[i, j] += mu * stiff * direction * n[j]
            K[i, j] += scale * slope * P_ij
    for i in range(3):
        shear[i] *= scale
        if size > limit:
            bristle = -shear[i] / kt
            moved[i] = x[i] - p[10 + i] - bristle
        else:
            moved[i] = anchor[i]
            bristle = x[i] - p[10 + i] - anchor[i] - along * n[i]
        stored += 0.5 * kt * bristle * bristle
        power -= shear[i] * u[i]
    return gap, 0.5 * kn * gap * gap, stored, lost, power


@kernel
def contact_force(
    p: Array, q: Array, v: Array, lengths: Array, xs: Array, ws: Array, anchors: Array, moved: Array,
    F: Array, nodal: Array, friction: Array, report: Array, cone: Array,
    want_tangent: bool, factor: float, D: Array, U: Array, L: Array,
) -> None:  # fmt: skip
    """Subtract the contact forces of one surface from `F` (n + 1, 12) and add their tangent to the blocks.

    Parameters not named in :func:`point_force`: `xs`, `ws` contact points in [0, 1] and weights; `anchors`, `moved`
    (n, points, 3) committed and candidate anchors; `nodal`, `friction` (n + 1, 3) all contact forces, and their friction
    part, collected at the nodes; `cone` (n, points) is |t| / (mu f_n). `report` receives penalty energy, bristle energy,
    power lost in normal damping, power of friction, power of the moving surface, deepest penetration, its element.
    """
    N, dN = np.empty(4), np.empty(4)
    x, u, n, normal, shear = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    K = np.zeros((3, 3))
    for k in range(5):
        report[k] = 0.0
    report[5], report[6] = -1.0, -1.0
    for e in range(lengths.size):
        if p[0] == CYLINDER:
            dx, dy = q[e, 0] - p[10], q[e, 1] - p[11]
            if np.sqrt(dx * dx + dy * dy) > p[16] + 2.0 * lengths[e]:
                for g in range(xs.size):
                    cone[e, g] = 0.0
                continue
        for g in range(xs.size):
            hermite(xs[g], lengths[e], N, dN)
            for i in range(3):
                x[i] = N[0] * q[e, i] + N[1] * q[e, 3 + i] + N[2] * q[e + 1, i] + N[3] * q[e + 1, 3 + i]
                u[i] = N[0] * v[e, i] + N[1] * v[e, 3 + i] + N[2] * v[e + 1, i] + N[3] * v[e + 1, 3 + i] - p[13 + i]
            gap, pressed, stored, lost, power = point_force(
                p, x, u, factor, anchors[e, g], n, normal, shear, moved[e, g], K
            )
            cone[e, g] = 0.0
            if gap <= 0.0:
                continue
            weight = ws[g] * lengths[e]
            report[0] += weight * pressed
            report[1] += weight * stored
            report[2] += weight * lost
            report[3] += weight * power
            fn2, ft2 = 0.0, 0.0
            for i in range(3):
                fn2 += normal[i] * normal[i]
                ft2 += shear[i] * shear[i]
                report[4] += weight * (normal[i] + shear[i]) * p[13 + i]
            if p[3] > 0.0 and fn2 > 0.0:
                cone[e, g] = np.sqrt(ft2 / fn2) / p[3]
            if gap > report[5]:
                report[5], report[6] = gap, e
            for k in range(4):
                row, slot = e + k // 2, 3 * (k % 2)
                for i in range(3):
                    F[row, slot + i] -= weight * N[k] * (normal[i] + shear[i])
                    if k % 2 == 0:
                        share = xs[g] if k == 2 else 1.0 - xs[g]
                        nodal[row, i] += weight * share * (normal[i] + shear[i])
                        friction[row, i] += weight * share * shear[i]
            if want_tangent:
                scatter_contact(K, e, weight, N, D, U, L)


@kernel
def scatter_contact(K: Array, e: int, weight: float, N: Array, D: Array, U: Array, L: Array) -> None:
    """Add N^T K N of one contact point to the blocks."""
    for a in range(4):
        for b in range(4):
            na, nb = a // 2, b // 2
            block = D[e + na] if na == nb else (U[e] if na == 0 else L[e])
            for i in range(3):
                for j in range(3):
                    block[3 * (a % 2) + i, 3 * (b % 2) + j] += weight * N[a] * N[b] * K[i, j]

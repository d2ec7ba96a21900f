r"""Contact of points of rigid bodies with planes and cylinders, by the same law as the cable's.

A point p of a body at x + R p takes the share w of the body's contact length [m]; normal force w f_n and friction w t follow from
:mod:`beam.contact_force`, with the bristle's anchor kept per point and surface. Tangent by forward differences.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel
from beam.contact_force import bristle, gap_and_normal
from beam.relative_motion import POSE, moment_to_theta, pose
from beam.rigid_body import STEP
from beam.sliding_friction import friction_coefficient

Array = NDArray[np.float64]
Index = NDArray[np.int64]


class BodyPoints(NamedTuple):
    """Contact points of all bodies: the row of their body, place in its axes (k, 3), share of the law [m]."""

    rows: Index
    at: Array
    share: Array


@kernel
def sliding_velocity(p: Array, P: Array, n0: float, n1: float, n2: float) -> tuple[float, float, float]:
    """Velocity of the point of the pose `P` along the surface and relative to it."""
    u0, u1 = P[6] - p[13] + p[23] * (P[4] - p[11]), P[7] - p[14] - p[23] * (P[3] - p[10])
    u2 = P[8] - p[15]
    along = n0 * u0 + n1 * u1 + n2 * u2
    return u0 - along * n0, u1 - along * n1, u2 - along * n2


@kernel
def body_point(p: Array, w: float, P: Array, anchor: Array, moved: Array, report: Array, force: Array) -> bool:
    """Force of the surface `p` on the point of the pose `P` into `force` (3,); anchor to commit into `moved` (3,)."""
    x0, x1, x2 = P[3], P[4], P[5]
    gap, _, n0, n1, n2 = gap_and_normal(p, x0, x1, x2)
    if not gap > 0.0:
        moved[0] = np.nan
        return False
    w0, w1 = p[13] - p[23] * (x1 - p[11]), p[14] + p[23] * (x0 - p[10])
    u0, u1, u2 = P[6] - w0, P[7] - w1, P[8] - p[15]
    closing = -(n0 * u0 + n1 * u1 + n2 * u2)
    fn = max(p[1] * gap + p[2] * closing, 0.0)
    t0, t1, t2, d0, d1, d2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    moved[0] = np.nan
    mu = p[3]
    if p[26] > 0.0 or p[29] > 0.0:
        s0, s1, s2 = sliding_velocity(p, P, n0, n1, n2)
        mu = friction_coefficient(p, np.sqrt(s0 * s0 + s1 * s1 + s2 * s2))
        d0, d1, d2 = -w * p[29] * s0, -w * p[29] * s1, -w * p[29] * s2
        report[3] -= d0 * s0 + d1 * s1 + d2 * s2
    if mu > 0.0:
        limit = mu * fn
        y0, y1, y2 = x0 - p[10], x1 - p[11], x2 - p[12]
        a0, a1, a2 = anchor[0] * p[24] - anchor[1] * p[25], anchor[0] * p[25] + anchor[1] * p[24], anchor[2]
        if anchor[0] != anchor[0]:
            a0, a1, a2 = y0, y1, y2
        b0, b1, b2, t0, t1, t2, slid = bristle(p, y0, y1, y2, a0, a1, a2, u0, u1, u2, n0, n1, n2, closing, limit)
        size = np.sqrt(t0 * t0 + t1 * t1 + t2 * t2)
        if size > limit:
            t0, t1, t2 = limit / size * t0, limit / size * t1, limit / size * t2
        if slid:
            a0, a1, a2 = y0 - b0, y1 - b1, y2 - b2
        moved[0], moved[1], moved[2] = a0 * p[24] + a1 * p[25], a1 * p[24] - a0 * p[25], a2
        report[1] += w * 0.5 * p[4] * (b0 * b0 + b1 * b1 + b2 * b2)
        report[3] -= w * (t0 * u0 + t1 * u1 + t2 * u2)
    report[0] += w * 0.5 * p[1] * gap * gap
    report[2] += w * (fn - p[1] * gap) * closing
    force[0], force[1], force[2] = w * (fn * n0 + t0), w * (fn * n1 + t1), w * (fn * n2 + t2)
    force[0], force[1], force[2] = force[0] + d0, force[1] + d1, force[2] + d2
    report[4] += force[0] * w0 + force[1] * w1 + force[2] * p[15]
    report[5] = max(report[5], gap)
    return True


@kernel
def spread_point(P: Array, force: Array, out: Array) -> None:
    """Write the generalised force (6,) of a force at the point of the pose `P`."""
    out[0], out[1], out[2] = force[0], force[1], force[2]
    moment_to_theta(
        P, P[13] * force[2] - P[14] * force[1], P[14] * force[0] - P[12] * force[2],
        P[12] * force[1] - P[13] * force[0], out,
    )  # fmt: skip


@kernel
def body_contacts(  # noqa: C901 - loops over components
    S: Array, points: BodyPoints, q: Array, v: Array, anchors: Array, moved: Array, begin: int, F: Array,
    reports: Array, on_body: Array, first_row: int, want_tangent: bool, factor: float, D: Array,
) -> None:  # fmt: skip
    """Subtract the contact forces of the surfaces `S` (surfaces, 30) on the points from `F`; add the tangent to `D`.

    Anchors of surface k and point j are in row `begin` + k points + j; `on_body` (bodies, 3) sums the forces.
    """
    P, still, frame = np.empty(POSE), np.empty(3), np.eye(3)
    x, u, force, out, other, scrap = np.empty(6), np.empty(6), np.empty(3), np.empty(6), np.empty(6), np.zeros(16)
    for k in range(S.shape[0]):
        for i in range(7):
            reports[k, i] = 0.0
        for j in range(points.rows.size):
            row, here = points.rows[j], begin + k * points.rows.size + j
            for i in range(3):
                x[i], x[3 + i], u[i], u[3 + i] = q[row, i], q[row, 6 + i], v[row, i], v[row, 6 + i]
            deepest = reports[k, 5]
            pose(x, u, points.at[j], frame, P)
            if not body_point(S[k], points.share[j], P, anchors[here], moved[here], reports[k], force):
                continue
            if reports[k, 5] > deepest:
                reports[k, 6] = row - first_row
            spread_point(P, force, out)
            for i in range(3):
                F[row, i] -= out[i]
                F[row, 6 + i] -= out[3 + i]
                on_body[row - first_row, i] += force[i]
            if want_tangent:
                for c in range(6):
                    x[c] += STEP
                    u[c] += factor * STEP
                    pose(x, u, points.at[j], frame, P)
                    other[:] = 0.0
                    if body_point(S[k], points.share[j], P, anchors[here], still, scrap, force):
                        spread_point(P, force, other)
                    x[c] -= STEP
                    u[c] -= factor * STEP
                    column = c if c < 3 else c + 3
                    for i in range(3):
                        D[row, i, column] -= (other[i] - out[i]) / STEP
                        D[row, 6 + i, column] -= (other[3 + i] - out[3 + i]) / STEP

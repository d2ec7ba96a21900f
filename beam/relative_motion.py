r"""Two bodies seen from each other: displacement and turning of the second's frame in the frame of the first.

An end carries a frame E at a point p of its own axes, with position x, rotation R = exp(theta^) and angular velocity W,

.. math:: y = x + R p, \quad \dot y = \dot x + W \times R p, \qquad
          d = E_1^T (y_2 - y_1), \quad \dot d = E_1^T (\dot y_2 - \dot y_1 - W_1 \times (y_2 - y_1)), \quad
          Q = E_1^T E_2, \quad \omega = E_2^T (W_2 - W_1).

A force f on the second (axes of frame 1) at y_2 and a moment m (axes of frame 2) have the power f . d' + m . omega; what is
conjugate to the rotation vectors follows with T of :mod:`beam.rotation_vector`, f_theta = T^T R^T M. Force and moment act on
the first in the opposite sense along the same line, so that both balances hold exactly.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import inlined, kernel
from beam.rotation_vector import rotation_coefficients

Array = NDArray[np.float64]

POSE = 42
"""x (0:3), y (3:6), its velocity (6:9), W (9:12), R p (12:15), R (15:24), E (24:33), theta (33:36), b, c of T (36:38)."""
RELATIVE = 18
"""d (0:3), its rate (3:6), Q (6:15), omega (15:18)."""


@kernel
def pose(x: Array, v: Array, point: Array, frame: Array, P: Array) -> None:
    """Write the pose of an end with the unknowns `x` (6,), rates `v` (6,), `point` (3,) and `frame` (3, 3) into `P`."""
    t0, t1, t2 = x[3], x[4], x[5]
    p2 = t0 * t0 + t1 * t1 + t2 * t2
    a, b, c, _, _ = rotation_coefficients(p2)
    e = 1.0 - b * p2
    P[15], P[16], P[17] = e + b * t0 * t0, b * t0 * t1 - a * t2, b * t0 * t2 + a * t1
    P[18], P[19], P[20] = b * t1 * t0 + a * t2, e + b * t1 * t1, b * t1 * t2 - a * t0
    P[21], P[22], P[23] = b * t2 * t0 - a * t1, b * t2 * t1 + a * t0, e + b * t2 * t2
    r0, r1, r2 = v[3], v[4], v[5]
    s0, s1, s2 = t1 * r2 - t2 * r1, t2 * r0 - t0 * r2, t0 * r1 - t1 * r0
    w0 = r0 - b * s0 + c * (t1 * s2 - t2 * s1)
    w1 = r1 - b * s1 + c * (t2 * s0 - t0 * s2)
    w2 = r2 - b * s2 + c * (t0 * s1 - t1 * s0)
    for i in range(3):
        k = 15 + 3 * i
        P[9 + i] = P[k] * w0 + P[k + 1] * w1 + P[k + 2] * w2
        P[12 + i] = P[k] * point[0] + P[k + 1] * point[1] + P[k + 2] * point[2]
        P[i] = x[i]
        P[3 + i] = x[i] + P[12 + i]
        P[33 + i] = x[3 + i]
        for j in range(3):
            P[24 + 3 * i + j] = P[k] * frame[0, j] + P[k + 1] * frame[1, j] + P[k + 2] * frame[2, j]
    P[6] = v[0] + P[10] * P[14] - P[11] * P[13]
    P[7] = v[1] + P[11] * P[12] - P[9] * P[14]
    P[8] = v[2] + P[9] * P[13] - P[10] * P[12]
    P[36], P[37] = b, c


@kernel
def relative(P: Array, B: Array, D: Array) -> None:
    """Write what the first end `P` sees of the second `B` into `D` (:data:`RELATIVE`)."""
    d0, d1, d2 = B[3] - P[3], B[4] - P[4], B[5] - P[5]
    u0 = B[6] - P[6] - (P[10] * d2 - P[11] * d1)
    u1 = B[7] - P[7] - (P[11] * d0 - P[9] * d2)
    u2 = B[8] - P[8] - (P[9] * d1 - P[10] * d0)
    w0, w1, w2 = B[9] - P[9], B[10] - P[10], B[11] - P[11]
    for i in range(3):
        D[i] = P[24 + i] * d0 + P[27 + i] * d1 + P[30 + i] * d2
        D[3 + i] = P[24 + i] * u0 + P[27 + i] * u1 + P[30 + i] * u2
        D[15 + i] = B[24 + i] * w0 + B[27 + i] * w1 + B[30 + i] * w2
        for j in range(3):
            D[6 + 3 * i + j] = P[24 + i] * B[24 + j] + P[27 + i] * B[27 + j] + P[30 + i] * B[30 + j]


@kernel
def spread(P: Array, B: Array, f: Array, m: Array, out: Array) -> None:
    """Write the generalised forces on both ends into `out` (2, 6); `f` (3,) axes of frame 1, `m` (3,) axes of frame 2."""
    for i in range(3):
        out[1, i] = P[24 + 3 * i] * f[0] + P[25 + 3 * i] * f[1] + P[26 + 3 * i] * f[2]
        out[1, 3 + i] = B[24 + 3 * i] * m[0] + B[25 + 3 * i] * m[1] + B[26 + 3 * i] * m[2]
        out[0, i] = -out[1, i]
        out[0, 3 + i] = -out[1, 3 + i]
    g0, g1, g2 = out[1, 0], out[1, 1], out[1, 2]
    a0, a1, a2 = B[3] - P[0], B[4] - P[1], B[5] - P[2]
    moment_to_theta(
        P, out[0, 3] - (a1 * g2 - a2 * g1), out[0, 4] - (a2 * g0 - a0 * g2), out[0, 5] - (a0 * g1 - a1 * g0), out[0]
    )
    a0, a1, a2 = B[12], B[13], B[14]
    moment_to_theta(
        B, out[1, 3] + (a1 * g2 - a2 * g1), out[1, 4] + (a2 * g0 - a0 * g2), out[1, 5] + (a0 * g1 - a1 * g0), out[1]
    )


@kernel
def moment_to_theta(P: Array, m0: float, m1: float, m2: float, out: Array) -> None:
    """Write T^T R^T m of the global moment m into ``out[3:6]``."""
    y0 = P[15] * m0 + P[18] * m1 + P[21] * m2
    y1 = P[16] * m0 + P[19] * m1 + P[22] * m2
    y2 = P[17] * m0 + P[20] * m1 + P[23] * m2
    t0, t1, t2, b, c = P[33], P[34], P[35], P[36], P[37]
    s0, s1, s2 = t1 * y2 - t2 * y1, t2 * y0 - t0 * y2, t0 * y1 - t1 * y0
    out[3] = y0 + b * s0 + c * (t1 * s2 - t2 * s1)
    out[4] = y1 + b * s1 + c * (t2 * s0 - t0 * s2)
    out[5] = y2 + b * s2 + c * (t0 * s1 - t1 * s0)


@kernel
def rotation_vector_of(Q: Array, phi: Array) -> None:
    """Write the rotation vector, at most half a turn, of the rotation matrix `Q` (9,) into `phi` (3,)."""
    trace = Q[0] + Q[4] + Q[8]
    if trace > 0.0:
        w = 0.5 * np.sqrt(1.0 + trace)
        x, y, z = (Q[7] - Q[5]) / (4 * w), (Q[2] - Q[6]) / (4 * w), (Q[3] - Q[1]) / (4 * w)
    elif Q[0] >= Q[4] and Q[0] >= Q[8]:
        x = 0.5 * np.sqrt(max(1.0 + Q[0] - Q[4] - Q[8], 0.0))
        w, y, z = (Q[7] - Q[5]) / (4 * x), (Q[3] + Q[1]) / (4 * x), (Q[2] + Q[6]) / (4 * x)
    elif Q[4] >= Q[8]:
        y = 0.5 * np.sqrt(max(1.0 + Q[4] - Q[0] - Q[8], 0.0))
        w, x, z = (Q[2] - Q[6]) / (4 * y), (Q[3] + Q[1]) / (4 * y), (Q[7] + Q[5]) / (4 * y)
    else:
        z = 0.5 * np.sqrt(max(1.0 + Q[8] - Q[0] - Q[4], 0.0))
        w, x, y = (Q[3] - Q[1]) / (4 * z), (Q[2] + Q[6]) / (4 * z), (Q[7] + Q[5]) / (4 * z)
    if w < 0.0:
        w, x, y, z = -w, -x, -y, -z
    s = np.sqrt(x * x + y * y + z * z)
    scale = 2.0 * (1.0 + s * s / 6 + 3 * s**4 / 40) if s < 1e-3 else 2.0 * np.arctan2(s, w) / s
    phi[0], phi[1], phi[2] = scale * x, scale * y, scale * z


@kernel
def inverse_turn(phi: Array, y: Array, sign: float, out: Array) -> None:
    """Write T^-1 y (`sign` 1) or T^-T y (`sign` -1) for the rotation vector `phi` into `out`; all (3,)."""
    p2 = phi[0] * phi[0] + phi[1] * phi[1] + phi[2] * phi[2]
    a, b, _, _, _ = rotation_coefficients(p2)
    e = 1 / 12 + p2 / 720 + p2 * p2 / 30240 if p2 < 1e-4 else (1.0 - 0.5 * a / b) / p2
    t0, t1, t2, y0, y1, y2 = phi[0], phi[1], phi[2], y[0], y[1], y[2]
    s0, s1, s2 = t1 * y2 - t2 * y1, t2 * y0 - t0 * y2, t0 * y1 - t1 * y0
    half = 0.5 * sign
    out[0] = y0 + half * s0 + e * (t1 * s2 - t2 * s1)
    out[1] = y1 + half * s1 + e * (t2 * s0 - t0 * s2)
    out[2] = y2 + half * s2 + e * (t0 * s1 - t1 * s0)


@inlined
def take_end(row: int, q: Array, v: Array, u: Array, du: Array, x: Array, rate: Array) -> None:
    """Copy the six unknowns and rates of `row` into `x`, `rate` (6,); of the ground (-1), moved by `u` (3,) with speed `du`."""
    for i in range(3):
        if row >= 0:
            x[i], x[3 + i], rate[i], rate[3 + i] = q[row, i], q[row, 6 + i], v[row, i], v[row, 6 + i]
        else:
            x[i], x[3 + i], rate[i], rate[3 + i] = u[i], 0.0, du[i], 0.0

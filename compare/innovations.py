r"""Innovations of an AR(1) process that is read with white noise: the samples made independent, in O(n).

.. math::  y_t = a_t + w_t,\quad a_t = \varphi a_{t-1} + e_t,\quad \operatorname{var} a = s^2,\quad \operatorname{var} w = w^2

The Kalman filter gives the one-step prediction of y_t and its variance F_t; (y_t - prediction) / sqrt F_t is white with
variance one, and the product of the F_t is the determinant of the covariance. Without white noise this is the usual
(y_t - phi y_{t-1}) / (s sqrt(1 - phi^2)). Source: Harvey, Forecasting, Structural Time Series Models and the Kalman
Filter, 1989, sections 3.2 and 3.4.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel

Array = NDArray[np.float64]


@kernel
def innovations(x: Array, s2: float, phi: float, w2: float, out: Array) -> float:
    """Write the scaled innovations of the columns of `x` (n, k) into `out` (n, k); return the sum of ln F_t."""
    n, k = x.shape
    log_det = 0.0
    variance = s2  # of the prediction of a_t
    predicted = np.zeros(k)
    for t in range(n):
        F = variance + w2
        gain = variance / F
        root = 1.0 / np.sqrt(F)
        for j in range(k):
            v = x[t, j] - predicted[j]
            out[t, j] = v * root
            predicted[j] = phi * (predicted[j] + gain * v)
        log_det += np.log(F)
        variance = phi * phi * (variance - gain * variance) + s2 * (1.0 - phi * phi)
    return log_det


@kernel
def products(V: Array, begin: NDArray[np.intp], phi: float, rho2: float, P: Array) -> float:
    """Write V^T [A(phi) + rho2 I]^-1 V of every record to `P` (records, 3, 3); return the sum of their log determinants.

    The rows of `V` (N, 3) hold the records one below the other, record i from ``begin[i]`` to ``begin[i + 1]``.
    """
    log_det = 0.0
    F = inverse = log_F = 0.0
    for i in range(len(begin) - 1):
        variance = 1.0
        x = y = z = 0.0  # predictions of the three columns
        xx = xy = xz = yy = yz = zz = 0.0
        for t in range(begin[i], begin[i + 1]):
            if variance + rho2 != F:  # the filter soon comes to rest
                F = variance + rho2
                inverse, log_F = 1.0 / F, np.log(F)
            gain = variance * inverse
            a, b, c = V[t, 0] - x, V[t, 1] - y, V[t, 2] - z
            x, y, z = phi * (x + gain * a), phi * (y + gain * b), phi * (z + gain * c)
            ai, bi = a * inverse, b * inverse
            xx += a * ai
            xy += b * ai
            xz += c * ai
            yy += b * bi
            yz += c * bi
            zz += c * c * inverse
            log_det += log_F
            variance = phi * phi * (variance - gain * variance) + 1.0 - phi * phi
        P[i, 0, 0], P[i, 1, 1], P[i, 2, 2] = xx, yy, zz
        P[i, 0, 1] = P[i, 1, 0] = xy
        P[i, 0, 2] = P[i, 2, 0] = xz
        P[i, 1, 2] = P[i, 2, 1] = yz
    return log_det

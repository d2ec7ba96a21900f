r"""Rotations written as a total rotation vector theta, R = exp(theta^).

With p = |theta|, a = sin p / p, b = (1 - cos p) / p^2, c = (p - sin p) / p^3,

.. math:: R = I + a\,\hat\theta + b\,\hat\theta^2, \qquad T = I - b\,\hat\theta + c\,\hat\theta^2,

where T turns the rate of theta into the angular velocity seen from the section, omega = T theta_dot. T is singular at
p = 2 pi, where the vector ceases to describe the rotation's neighbourhood; :data:`LARGEST_ROTATION` guards it.

Source: A. Cardona, M. Geradin, Int. J. Numer. Meth. Eng. 26 (1988) 2403-2438, doi 10.1002/nme.1620261105.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel

Array = NDArray[np.float64]

LARGEST_ROTATION = 2 * np.pi - 0.2
"""Largest |theta| [rad] that is accepted at a node; T is singular at 2 pi."""


@kernel
def rotation_coefficients(p2: float) -> tuple[float, float, float, float, float]:
    """(a, b, c, db, dc): coefficients of R and T, and the derivatives of b and c by p^2."""
    if p2 < 1e-2:
        a = 1 - p2 / 6 * (1 - p2 / 20 * (1 - p2 / 42 * (1 - p2 / 72)))
        b = 0.5 - p2 / 24 * (1 - p2 / 30 * (1 - p2 / 56 * (1 - p2 / 90)))
        c = 1 / 6 - p2 / 120 * (1 - p2 / 42 * (1 - p2 / 72 * (1 - p2 / 110)))
        db = -1 / 24 + p2 / 360 * (1 - p2 / (112 / 3) * (1 - p2 / 67.5))
        dc = -1 / 120 + p2 / 2520 * (1 - p2 / 48 * (1 - p2 / 82.5))
        return a, b, c, db, dc
    p = np.sqrt(p2)
    sine = np.sin(p)
    a = sine / p
    b = (1.0 - np.cos(p)) / p2
    c = (p - sine) / (p2 * p)
    return a, b, c, (a - 2.0 * b) / (2.0 * p2), (b - 3.0 * c) / (2.0 * p2)


def rotation_matrix(theta: Array) -> Array:
    """R of rotation vectors `theta` (..., 3), shape (..., 3, 3); its columns are the section's axes e1, e2, e3.

    Examples
    --------
    >>> rotation_matrix(np.array([0.0, 0.0, np.pi / 2])).round(12)[:, 0] + 0.0
    array([0., 1., 0.])
    """
    theta = np.asarray(theta, dtype=float)
    p = np.linalg.norm(theta, axis=-1)
    a = np.sinc(p / np.pi)
    b = 0.5 * np.sinc(p / (2 * np.pi)) ** 2
    hat = np.zeros((*theta.shape, 3))
    hat[..., 0, 1], hat[..., 0, 2], hat[..., 1, 2] = -theta[..., 2], theta[..., 1], -theta[..., 0]
    hat = hat - np.swapaxes(hat, -1, -2)
    return np.eye(3) + a[..., None, None] * hat + b[..., None, None] * (hat @ hat)

r"""Reactions of a support as a force and a moment in global axes.

The unknown conjugate to the rotation vector is no moment: the power of a moment m (global) is
:math:`m \cdot R\,T(\theta)\dot\theta`, so that the generalised force on theta is :math:`f_\theta = T^T R^T m` and

.. math:: m = R\,T(\theta)^{-T} f_\theta, \qquad T = I - b\,[\theta] + c\,[\theta]^2

with the coefficients of :mod:`beam.rotation_vector`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.rotation_vector import rotation_coefficients, rotation_matrix

Array = NDArray[np.float64]


def global_moment(theta: Array, f: Array) -> Array:
    """Moment (3,) [N m] in global axes of the generalised force `f` (3,) on the rotation vector `theta` (3,).

    Examples
    --------
    >>> global_moment(np.array([0.0, 0.0, np.pi]), np.array([0.0, 0.0, 2.0]))
    array([0., 0., 2.])
    """
    _, b, c, _, _ = rotation_coefficients(float(theta @ theta))
    x, y, z = theta
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    T = np.eye(3) - b * skew + c * skew @ skew
    return rotation_matrix(theta) @ np.linalg.solve(T.T, f)

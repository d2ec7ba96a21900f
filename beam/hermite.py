r"""Cubic Hermite shape functions of an element of length l, and Gauss points on it.

.. math:: N = (1 - 3x^2 + 2x^3,\; l(x - 2x^2 + x^3),\; 3x^2 - 2x^3,\; l(x^3 - x^2)), \qquad x = s/l \in [0, 1].

They multiply (value, slope) of the first and (value, slope) of the second node. Both fields of the rod, position and
rotation vector, are interpolated by them, so that centre line and rotation are continuously differentiable.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel

Array = NDArray[np.float64]


@kernel
def hermite_values(x: float, length: float, N: Array) -> None:
    """Write the four shape functions at `x` in [0, 1] into `N`."""
    x2 = x * x
    N[0] = 1.0 - 3.0 * x2 + 2.0 * x2 * x
    N[1] = length * (x - 2.0 * x2 + x2 * x)
    N[2] = 3.0 * x2 - 2.0 * x2 * x
    N[3] = length * (x2 * x - x2)


@kernel
def hermite(x: float, length: float, N: Array, dN: Array) -> None:
    """Write the four shape functions and their derivatives by arc length at `x` in [0, 1] into `N` and `dN`."""
    hermite_values(x, length, N)
    x2 = x * x
    dN[0] = (6.0 * x2 - 6.0 * x) / length
    dN[1] = 1.0 - 4.0 * x + 3.0 * x2
    dN[2] = -dN[0]
    dN[3] = 3.0 * x2 - 2.0 * x


def gauss_points(count: int) -> tuple[Array, Array]:
    """Gauss points in [0, 1] and weights that sum to one.

    Examples
    --------
    >>> x, w = gauss_points(3)
    >>> float((w * x**5).sum().round(12))    # exact to degree 5: 1/6
    0.166666666667
    """
    x, w = np.polynomial.legendre.leggauss(count)
    return 0.5 * (x + 1.0), 0.5 * w


def hermite_mass(length: float) -> Array:
    """Integral of N N^T over the element, shape (4, 4), from Gauss points that integrate degree six exactly."""
    x, w = gauss_points(4)
    mass = np.zeros((4, 4))
    N, dN = np.zeros(4), np.zeros(4)
    for xi, wi in zip(x, w, strict=True):
        hermite(xi, length, N, dN)
        mass += wi * length * np.outer(N, N)
    return mass

r"""Lagrange polynomials along the specimen, continuous from layer to layer, and their three matrices.

.. math::  M_{kl} = \int_0^L N_k N_l\,dz, \qquad C_{kl} = \int_0^L N_k' N_l\,dz, \qquad S_{kl} = \int_0^L N_k' N_l'\,dz .

A *station* is a node of this basis: the ends of the layers and degree - 1 places between. Integrals of N N are exact by
Gauss-Legendre points, degree + 1 of them in each layer.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from geometry.errors import SpecError

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class AxialBasis:
    """Piecewise polynomials on layers.

    Parameters
    ----------
    levels : (layers + 1,) heights of the layer boundaries, growing [m]
    degree : 1 to 4

    Raises
    ------
    SpecError
        If the heights do not grow or the degree is not usable.

    Examples
    --------
    >>> basis = AxialBasis(np.array([0.0, 1.0, 3.0]))
    >>> basis.stations.tolist()
    [0.0, 0.5, 1.0, 2.0, 3.0]
    >>> M, C, S = basis.matrices
    >>> round(float(M.sum()), 12), round(abs(float(S.sum())), 12)
    (3.0, 0.0)
    """

    levels: FloatArray
    degree: int = 2

    def __post_init__(self) -> None:
        if self.degree not in (1, 2, 3, 4):
            raise SpecError(f"the degree of the axial polynomials must be 1, 2, 3 or 4, found {self.degree}.")
        if self.levels.ndim != 1 or len(self.levels) < 2 or not (np.diff(self.levels) > 0).all():
            raise SpecError("a specimen needs at least one layer, and layer boundaries that grow along its length.")

    @property
    def layers(self) -> int:
        """Number of layers."""
        return len(self.levels) - 1

    @cached_property
    def stations(self) -> FloatArray:
        """(m,) heights of the nodes [m]."""
        inside = np.arange(self.degree) / self.degree
        return np.append((self.levels[:-1, None] + np.diff(self.levels)[:, None] * inside).ravel(), self.levels[-1])

    @property
    def matrices(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """M, C, S, each (m, m)."""
        return self._matrices

    @cached_property
    def _matrices(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        _, w, N, D = self.quadrature
        return (N.T * w) @ N, (D.T * w) @ N, (D.T * w) @ D

    @cached_property
    def quadrature(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Heights (g,), weights (g,) [m], values (g, m) and derivatives (g, m) [1/m] at the Gauss points."""
        x, w = np.polynomial.legendre.leggauss(self.degree + 1)
        h = np.diff(self.levels)
        z = (self.levels[:-1, None] + h[:, None] * (x + 1) / 2).ravel()
        return z, (h[:, None] * w / 2).ravel(), *self.at(z)

    def at(self, z: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Values (g, m) and derivatives (g, m) [1/m] at heights z (g,)."""
        layer = np.clip(np.searchsorted(self.levels, z, side="right") - 1, 0, self.layers - 1)
        h = np.diff(self.levels)[layer]
        x = (z - self.levels[layer]) / h
        N, D = np.zeros((2, len(z), len(self.stations)))
        rows = np.arange(len(z))
        for a, polynomial in enumerate(_lagrange(self.degree)):
            N[rows, self.degree * layer + a] = polynomial(x)
            D[rows, self.degree * layer + a] = polynomial.deriv()(x) / h
        return N, D

    def coarser(self) -> AxialBasis:
        """The basis with every two layers joined; a layer that is left over stays."""
        return AxialBasis(np.unique(np.append(self.levels[::2], self.levels[-1])), self.degree)


def _lagrange(degree: int) -> list[np.polynomial.Polynomial]:
    """Polynomials on [0, 1] that are 1 at one of degree + 1 equally spaced points and 0 at the others."""
    points = np.arange(degree + 1) / degree
    found = []
    for a in range(degree + 1):
        others = np.delete(points, a)
        polynomial = np.polynomial.Polynomial.fromroots(others)
        found.append(polynomial / polynomial(points[a]))
    return found

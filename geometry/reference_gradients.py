"""Gradients of the shape functions in the reference element, at Gauss points that integrate its size exactly.

The Jacobian determinant of a first-order element is of degree 2 at most in each direction, that of a second-order one of
degree 3: two points per direction, or three in a triangle, are exact. A pyramid is a hexahedron whose upper four nodes are one.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

GAUSS = np.array([-1.0, 1.0]) / np.sqrt(3.0)
"""Weights 1."""
TRIANGLE = np.array([[1 / 6, 1 / 6], [2 / 3, 1 / 6], [1 / 6, 2 / 3]])
"""Weights 1/6."""
PLACES = {
    "quad": [(-1, -1), (1, -1), (1, 1), (-1, 1)],
    "quad9": [(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0), (0, 0)],
    "hexahedron": [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)],
}


def reference_gradients(kind: str) -> tuple[list[NDArray[np.float64]], list[float]]:
    """Shape-function gradients (nodes, dim) and weights at the Gauss points of an element, in meshio order.

    >>> gradients, weights = reference_gradients("tetra")
    >>> len(gradients), round(sum(weights), 12)
    (1, 0.166666666667)
    """
    if kind == "tetra":
        return [np.vstack([-np.ones(3), np.eye(3)])], [1 / 6]
    if kind in ("triangle", "triangle6"):
        gradient = _triangle if kind == "triangle" else _triangle6
        return [gradient(*p) for p in TRIANGLE], [1 / 6] * 3
    if kind == "wedge":
        return [_wedge(p[0], p[1], z) for p in TRIANGLE for z in GAUSS], [1 / 6] * 6
    if kind == "pyramid":
        gradients, weights = reference_gradients("hexahedron")
        return [np.vstack([g[:4], g[4:].sum(axis=0)]) for g in gradients], weights
    grid = list(itertools.product(GAUSS, repeat=len(PLACES[kind][0])))
    return [_tensor(x, kind) for x in grid], [1.0] * len(grid)


def _triangle(r: float, s: float) -> NDArray[np.float64]:
    return np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])


def _triangle6(r: float, s: float) -> NDArray[np.float64]:
    t = 1 - r - s
    return np.array(
        [
            [1 - 4 * t, 1 - 4 * t],
            [4 * r - 1, 0],
            [0, 4 * s - 1],
            [4 * (t - r), -4 * r],
            [4 * s, 4 * r],
            [-4 * s, 4 * (t - s)],
        ]
    )


def _wedge(r: float, s: float, z: float) -> NDArray[np.float64]:
    shape, slope = np.array([1 - r - s, r, s], dtype=float), _triangle(r, s)
    low, high = (1 - z) / 2, (1 + z) / 2
    return np.vstack([np.column_stack([low * slope, -shape / 2]), np.column_stack([high * slope, shape / 2])])


def _tensor(x: tuple[float, ...], kind: str) -> NDArray[np.float64]:
    """Lagrange elements on [-1, 1]^d."""
    one = _quadratic if kind == "quad9" else _linear
    table = np.empty((len(PLACES[kind]), len(x)))
    for a, place in enumerate(PLACES[kind]):
        values = [one(position, xi) for position, xi in zip(place, x, strict=True)]
        for d in range(len(x)):
            table[a, d] = np.prod([value[1 if k == d else 0] for k, value in enumerate(values)])
    return table


def _linear(position: float, x: float) -> tuple[float, float]:
    return (1 + position * x) / 2, position / 2


def _quadratic(position: float, x: float) -> tuple[float, float]:
    return (1 - x * x, -2 * x) if position == 0 else (x * (x + position) / 2, x + position / 2)

"""How well numbers can be read off a figure, judged by the numbers themselves: nothing else is known of a digitised curve."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def scatter_of_neighbours(x: Array, y: Array) -> float:
    """Standard deviation of one point of a smooth curve: each against the cubic through two neighbours on either side.

    Taken from the median, which a bend of the curve between two points does not disturb.

    >>> x = np.linspace(0, 1, 9) ** 2
    >>> round(scatter_of_neighbours(x, 1 + x**3), 12)
    0.0
    """
    error = []
    for i in range(2, len(x) - 2):
        near = [i - 2, i - 1, i + 1, i + 2]
        weights = [float(np.prod([(x[i] - x[k]) / (x[j] - x[k]) for k in near if k != j])) for j in near]
        error.append((y[i] - np.dot(weights, y[near])) / np.sqrt(1 + np.dot(weights, weights)))
    return float(np.median(np.abs(error)) / 0.6745)


def pixel_of_the_path(x: Array, y: Array) -> float:
    """Standard deviation of y along a steep loop: the raster of x times the slope that the loop begins with."""
    steps = np.diff(np.unique(np.round(x, 6)))
    pixel = float(steps[steps > 1e-5].min())
    first = np.flatnonzero(np.abs(x) > 0.05 * np.abs(x).max())[0]
    return pixel * abs(float(x[:first] @ y[:first] / (x[:first] @ x[:first])))

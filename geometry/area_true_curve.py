r"""Polygons that enclose the area of the curve they stand for.

A chord of length l cuts the segment kappa l^3 / 12 off a curve of curvature kappa. A polygon with its corners on a round
outline is therefore too small, by (2 pi / n)^2 / 6 of the area for n equal edges: 2 % at n = 18. Moving each edge outwards by
kappa l^2 / 12 gives the area back. Corner i between edges l_1 and l_2 carries half of each, so that the moves

.. math::  \delta_i = \frac{\kappa_i}{12}\,\frac{l_1^3 + l_2^3}{l_1 + l_2}

along the outward normal return all segments together; what is left is of the order (kappa l)^4. The moves differ little
between neighbouring curves, and are limited to `most`, so that thin layers keep their order.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.wire_trace import WireTrace


def area_true_points(
    curve: WireTrace, points: ArrayLike, edges: ArrayLike, most: float = np.inf
) -> NDArray[np.float64]:
    """Corners of a polygon moved off its curve so that the polygon encloses the curve's area.

    Parameters
    ----------
    curve : WireTrace
    points : (n, 2) corners of the polygon, on the curve or near it [m]
    edges : (m, 2) which corners each edge joins; the polygon may have gaps, a free end then gets the move of its only edge
    most : largest move [m]

    Returns
    -------
    NDArray
        (n, 2) [m]; a corner of no edge stays on the curve.

    Examples
    --------
    A circle of radius 1 as a polygon of 12 edges; the inscribed one has 0.955 of the area:

    >>> circle = WireTrace(0.0, 0.0, 1.0, 0.0)
    >>> x, y = area_true_points(circle, circle.point(2 * np.pi * np.arange(12) / 12), [(k, (k + 1) % 12) for k in range(12)]).T
    >>> round(float(0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / np.pi), 3)
    0.998
    """
    edges = np.asarray(edges, dtype=np.int64).reshape(-1, 2)
    phi = curve.nearest(points)
    on = curve.point(phi)
    lengths = np.linalg.norm(on[edges[:, 1]] - on[edges[:, 0]], axis=1)
    total, cubes = np.zeros(len(on)), np.zeros(len(on))
    np.add.at(total, edges.ravel(), np.repeat(lengths, 2))
    np.add.at(cubes, edges.ravel(), np.repeat(lengths**3, 2))
    normal, curvature = _normal_and_curvature(curve, phi)
    move = curvature / 12 * np.divide(cubes, total, out=np.zeros_like(total), where=total > 0)
    return on + np.clip(move, -most, most)[:, None] * normal


def _normal_and_curvature(
    curve: WireTrace, phi: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Outward unit normal (n, 2) and curvature (n,) [1/m], positive where the curve is convex."""
    step = 1e-4
    (dx, dy) = curve.derivative(phi).T
    (ddx, ddy) = (curve.derivative(phi + step) - curve.derivative(phi - step)).T / (2 * step)
    speed = np.hypot(dx, dy)
    return np.column_stack([dy, -dx]) / speed[:, None], (dx * ddy - dy * ddx) / speed**3

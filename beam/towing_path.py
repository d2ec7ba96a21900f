r"""The path of the cable at the start, and the pins of a clamp chain on it.

The bend is a half circle of the radius R, or, where the upper strand lies at a height h < 2R above the lower one, an arc of
pi + a and a counter arc of a with the radius 3R that brings the strand down to h:

.. math:: \cos a = \frac{h - R + 3R}{R + 3R}.

A chain of straight links of pitch p follows an arc of radius R with the same number of links per length of cable if its
pins lie on the radius

.. math:: R_p = \frac{p}{2 \sin(p / 2R)} \approx R + \frac{p^2}{24 R} .
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.shape import strands_and_arcs

Array = NDArray[np.float64]

COUNTER = 3.0
"""Radius of the counter arc over that of the bend."""

Pieces = list[tuple[float, float]]


def bend_pieces(radius: float, height: float) -> Pieces:
    """Arcs (length, curvature) from the lower strand to the upper one, `height` above it; all lengths in m.

    Examples
    --------
    >>> [(round(length, 4), round(curvature, 4)) for length, curvature in bend_pieces(0.5, 1.0)]
    [(1.5708, -2.0)]
    """
    counter = COUNTER * radius
    cosine = (height - radius + counter) / (radius + counter)
    if cosine >= 1.0:
        return [(np.pi * radius, -1.0 / radius)]
    angle = float(np.arccos(cosine))
    return [((np.pi + angle) * radius, -1.0 / radius), (angle * counter, 1.0 / counter)]


def chain_pins(pieces: Pieces, at: Array, pitch: float) -> tuple[Array, Array]:
    """Pins (k, 3) of a chain at the arc lengths `at` (k,) [m] of the path, and the path's direction there [rad].

    Examples
    --------
    >>> pins, _ = chain_pins([(1.0, 0.0), (np.pi, -1.0), (9.0, 0.0)], np.array([1.5, 1.9]), 0.4)
    >>> round(float(np.linalg.norm(pins[1] - pins[0])), 12)
    0.4
    """
    q = strands_and_arcs(at, pieces, angle=np.pi)
    curvature, direction = q[:, 11], q[:, 8]
    bent = curvature != 0.0
    size = np.where(bent, np.abs(curvature), 1.0)
    outward = np.where(bent, 0.5 * pitch / np.sin(0.5 * pitch * size) - 1.0 / size, 0.0) * np.sign(curvature)
    pins = q[:, 0:3] + outward[:, None] * np.stack([np.sin(direction), -np.cos(direction), 0 * direction], axis=1)
    return pins, direction

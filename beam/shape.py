"""Plane shapes of a rod as nodal values q = (r, r', theta, theta'), the starting points of statics and dynamics."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beam.element import DOF

Array = NDArray[np.float64]


def strands_and_arcs(
    s: Array, pieces: Sequence[tuple[float, float]], start: ArrayLike = (0.0, 0.0, 0.0), angle: float = 0.0
) -> Array:
    """A chain of straight strands and circular arcs in the plane z = constant.

    Parameters
    ----------
    s : (n,) array
        Arc length of the nodes [m].
    pieces : sequence of (length, curvature)
        In order; the last piece continues to the end. Length in m, curvature in 1/m, positive turns from x to y.
    start : (3,) array_like
        Position of s = 0 [m].
    angle : float
        Direction of the first piece, from the x axis [rad].

    Returns
    -------
    (n, 12) array
        r, r', theta = (0, 0, angle), theta' = (0, 0, curvature).

    Examples
    --------
    A quarter of a circle of radius 1 m ends at (1, 1):

    >>> strands_and_arcs(np.array([0.0, np.pi / 2]), [(2.0, 1.0)])[-1, :2].round(12)
    array([1., 1.])
    """
    q = np.zeros((s.size, DOF))
    corner = np.array(start, dtype=float)
    begin = 0.0
    for k, (length, curvature) in enumerate(pieces):
        end = np.inf if k == len(pieces) - 1 else begin + length
        inside = (s >= begin) & ((s <= end) | (end == np.inf))
        q[inside] = _piece(s[inside] - begin, curvature, corner, angle)
        corner = _piece(np.array([length]), curvature, corner, angle)[0, :3]
        angle += curvature * length
        begin += length
    return q


def straight(s: Array, start: ArrayLike = (0.0, 0.0, 0.0), angle: float = 0.0) -> Array:
    """A straight rod in the plane z = constant, see :func:`strands_and_arcs`."""
    return strands_and_arcs(s, [(float(s[-1]), 0.0)], start, angle)


def _piece(s: Array, curvature: float, start: Array, angle: float) -> Array:
    q = np.zeros((s.size, DOF))
    turn = angle + curvature * s
    half = 0.5 * curvature * s
    chord = s * np.sinc(half / np.pi)
    q[:, 0] = start[0] + chord * np.cos(angle + half)
    q[:, 1] = start[1] + chord * np.sin(angle + half)
    q[:, 2] = start[2]
    q[:, 3], q[:, 4] = np.cos(turn), np.sin(turn)
    q[:, 8] = turn
    q[:, 11] = curvature
    return q

r"""Helix on a helix, to any depth: strand in a conductor, wire in a strand in a core.

A member of level k runs round the centre line x_(k-1) of the next thicker one, formula (2) of Ge et al., PLoS ONE
18(2) e0281136 (2023):

.. math::  x_k = x_{k-1} + r_k (\cos\psi_k\, e_1 + \sin\psi_k\, e_2), \qquad \psi_k = h_k\, 2\pi s_{k-1}/p_k + \phi_k,

s the arc length of x_(k-1) and e1, e2 its frame of parallel transport, so that the pitch counts true turns of the
member about its own centre line. With w = cos psi e1 + sin psi e2 and the curvature vector K of x_(k-1),

.. math::  dx_k/ds_{k-1} = t (1 - r_k\, w \cdot K) + r_k \psi_k' (-\sin\psi_k\, e_1 + \cos\psi_k\, e_2) .

The first level has its frame in closed form (helix.py). Deeper frames are carried by double reflection, fourth
order in the step: Wang et al., ACM Trans. Graphics 27 (2008) 2, doi 10.1145/1330511.1330513.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.errors import GeometryError
from geometry.helix import Helix

SAMPLES_PER_TURN = 96


@dataclass(frozen=True)
class CentreLine:
    """Sampled centre line: heights of the first level `z` (n,), `points` (n, 3) [m], `frames` (n, 3, 3) with rows
    t, e1, e2, and arc length `s` (n,) [m] from z[0]."""

    z: NDArray[np.float64]
    points: NDArray[np.float64]
    frames: NDArray[np.float64]
    s: NDArray[np.float64]


def nested_helix(levels: Sequence[Helix], z: ArrayLike) -> CentreLine:
    """Centre line of the innermost member.

    Parameters
    ----------
    levels : helices from the outermost (core in the cable) to the innermost (wire in its strand); the pitch of level k is
        per arc length of level k - 1
    z : (n,) increasing heights of the first level [m], at least two

    Raises
    ------
    GeometryError
        If there is no level, the heights do not increase, or a member is thicker than the bend it sits on.

    Examples
    --------
    One level is the helix itself:

    >>> core = Helix(0.01, 0.2)
    >>> line = nested_helix([core], np.linspace(0, 0.1, 5))
    >>> bool(np.allclose(line.points, core.position(line.z)))
    True
    """
    heights = np.asarray(z, dtype=float)
    if not levels:
        raise GeometryError("a nested helix needs at least one level.")
    if heights.ndim != 1 or len(heights) < 2 or not (np.diff(heights) > 0).all():
        raise GeometryError("the heights of a nested helix must be a list of at least two increasing numbers.")
    fine = _refined(levels, heights)
    helix = levels[0]
    line = CentreLine(
        fine, helix.position(fine), helix.transported_frame(fine), (fine - fine[0]) / np.cos(helix.lay_angle)
    )
    for level in levels[1:]:
        line = wound_on(line, level)
    rows = np.searchsorted(fine, heights)
    return CentreLine(heights, line.points[rows], line.frames[rows], line.s[rows])


def _refined(levels: Sequence[Helix], heights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Heights with enough steps between them for the shortest pitch; contains every given height exactly."""
    step = min(level.pitch for level in levels) / SAMPLES_PER_TURN
    pieces = [np.linspace(a, b, max(2, int(np.ceil((b - a) / step)) + 1))[:-1] for a, b in itertools.pairwise(heights)]
    return np.concatenate([*pieces, heights[-1:]])


def wound_on(line: CentreLine, level: Helix, transport: bool = True) -> CentreLine:
    """Centre line of a member wound on a finely sampled centre line.

    Parameters
    ----------
    line : CentreLine
        Samples of at least some 50 per pitch of `level`; the error falls with the fourth power of the step.
    level : Helix
        Radius, pitch (per arc length of `line`), hand and phase of the member.
    transport : bool
        False gives frames that turn with the member (e1 points away from `line`), which is faster and enough for a picture.

    Raises
    ------
    GeometryError
        If the line bends more sharply than the member can follow.
    """
    from scipy.interpolate import CubicSpline  # slow to load, needed here only

    t, e1, e2 = np.moveaxis(line.frames, 1, 0)
    rate = level.sign * 2 * np.pi / level.pitch
    psi = (rate * line.s + level.phase)[:, None]
    w = np.cos(psi) * e1 + np.sin(psi) * e2
    v = -np.sin(psi) * e1 + np.cos(psi) * e2
    bend = CubicSpline(line.s, t).derivative()(line.s)
    stretch = 1 - level.radius * (w * bend).sum(1, keepdims=True)
    if stretch.min() <= 0:
        raise GeometryError(
            f"a helix of radius {1e3 * level.radius:.3g} mm cannot be wound on a centre line that bends more sharply than that: "
            "lengthen the lay of the thicker member."
        )
    velocity = t * stretch + level.radius * rate * v
    speed = np.linalg.norm(velocity, axis=1)
    tangent = velocity / speed[:, None]
    points = line.points + level.radius * w
    s = np.concatenate([[0.0], CubicSpline(line.s, speed).antiderivative()(line.s)[1:]])
    if transport:
        return CentreLine(line.z, points, _transported(points, tangent, w[0]), s)
    normal = w - (w * tangent).sum(1, keepdims=True) * tangent
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return CentreLine(line.z, points, np.stack([tangent, normal, np.cross(tangent, normal)], axis=1), s)


def _transported(x: NDArray[np.float64], t: NDArray[np.float64], start: NDArray[np.float64]) -> NDArray[np.float64]:
    """Frames with rows t, e1, e2 along sampled points by double reflection; e1[0] is `start` made normal to t[0]."""
    e1 = np.empty_like(x)
    e1[0] = start - (start @ t[0]) * t[0]
    e1[0] /= np.linalg.norm(e1[0])
    for i in range(len(x) - 1):
        v = x[i + 1] - x[i]
        c = v @ v
        reflected = e1[i] - (2 / c) * (v @ e1[i]) * v
        turned = t[i] - (2 / c) * (v @ t[i]) * v
        u = t[i + 1] - turned
        d = u @ u
        e1[i + 1] = reflected - (2 / d) * (u @ reflected) * u if d > 0 else reflected
    return np.stack([t, e1, np.cross(t, e1)], axis=1)

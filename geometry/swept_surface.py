"""Surfaces for pictures: the trace of a part swept along the lay, and round tubes about given centre lines."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geometry.nested_helix import CentreLine
from geometry.wire_trace import WireTrace

SIDES = 96
"""Points round a part."""
WIRE_SIDES = 8
"""Points round a thin wire."""


def swept_surface(trace: WireTrace, start: float, end: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Surface of a tube between z = start and z = end: points (n, 3) [m] and quadrilaterals (m, 4)."""
    turns = abs(trace.twist_rate) * (end - start) / (2 * np.pi)
    stations = np.linspace(start, end, max(2, int(np.ceil(90 * turns)) + 1))
    ring = trace.point(np.linspace(0, 2 * np.pi, SIDES, endpoint=False))
    angle = trace.twist_rate * stations[:, None]
    x = np.cos(angle) * ring[:, 0] - np.sin(angle) * ring[:, 1]
    y = np.sin(angle) * ring[:, 0] + np.cos(angle) * ring[:, 1]
    points = np.stack([x, y, np.broadcast_to(stations[:, None], x.shape)], axis=-1).reshape(-1, 3)
    first = SIDES * np.arange(len(stations) - 1)[:, None] + np.arange(SIDES)
    following = SIDES * np.arange(len(stations) - 1)[:, None] + (np.arange(SIDES) + 1) % SIDES
    quads = np.stack([first, following, following + SIDES, first + SIDES], axis=-1).reshape(-1, 4)
    return points, quads


def wire_surfaces(
    lines: list[CentreLine], radius: float, sides: int = WIRE_SIDES
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
    """Points, normals and quadrilaterals of round tubes along centre lines with the same number of samples."""
    angle = 2 * np.pi * np.arange(sides) / sides
    frames = np.stack([line.frames for line in lines])[:, :, None]
    normals = np.cos(angle)[:, None] * frames[..., 1, :] + np.sin(angle)[:, None] * frames[..., 2, :]
    points = np.stack([line.points for line in lines])[:, :, None] + radius * normals
    rows = points.shape[1]
    number = np.arange(points.shape[0] * rows * sides).reshape(len(lines), rows, sides)
    following = np.roll(number, -1, axis=2)
    quads = np.stack([number[:, :-1], following[:, :-1], following[:, 1:], number[:, 1:]], axis=-1)
    return points.reshape(-1, 3), normals.reshape(-1, 3), quads.reshape(-1, 4)

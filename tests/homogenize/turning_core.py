"""A cylinder of one material, drawn as a core that turns inside a tube: hexahedra, with pyramids and tetrahedra between."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree
from section_meshes import regions

from geometry.cell_mesh import CellBlock, SweptCell
from geometry.disc_grid import disc_grid
from geometry.slip_ring import slip_ring


def turning_core(n: int, core, tube, twist_rate: float = 0.0, height: float = 1.2, outer: float = 1.0) -> SweptCell:
    """Core of radius 0.45, turning by a quarter over the height, slip ring to 0.6, tube to `outer`; (E, nu) of both."""
    N, layers = 12 * n, 6 * n
    angle = 2 * np.pi * np.arange(N) / N
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    disc = disc_grid(0.45 * circle)
    radii = np.linspace(0.6, outer, 2 * n + 1)
    host = np.concatenate([r * circle for r in radii])
    rows = np.arange(len(radii) - 1)[:, None] * N + len(disc.points)
    i, j = np.arange(N), np.roll(np.arange(N), -1)
    annulus = np.stack([rows + i, rows + N + i, rows + N + j, rows + j], axis=-1).reshape(-1, 4)
    flat = np.concatenate([disc.cells, annulus])
    stride = len(disc.points) + len(host)
    z = np.linspace(0, height, layers + 1)
    planes = []
    for k, level in enumerate(z):
        own = np.pi / 2 * k / layers
        plane = np.concatenate([_turned(disc.points, own), host])
        planes.append(np.column_stack([_turned(plane, twist_rate * level), np.full(stride, level)]))
    shift = stride * np.arange(layers + 1)[:, None]
    ring = slip_ring(shift + np.arange(N), shift + len(disc.points) + np.arange(N), N // 4, stride * (layers + 1))
    points = np.concatenate(planes)
    points = np.concatenate([points, points[ring.divided].mean(axis=1)])
    hexes = np.concatenate([flat + s for s in shift[:-1]]), np.concatenate([flat + s for s in shift[1:]])
    swept = np.hstack(hexes)
    region = np.tile(np.r_[np.zeros(len(disc.cells), int), np.ones(len(annulus), int)], layers)
    blocks = [
        CellBlock("hexahedron", np.vstack([swept, ring.hexahedra]), np.r_[region, np.ones(len(ring.hexahedra), int)])
    ]
    blocks += [
        CellBlock(kind, c, np.ones(len(c), int)) for kind, c in (("pyramid", ring.pyramids), ("tetra", ring.tetrahedra))
    ]
    top = np.arange(stride) + stride * layers
    image = _turned(points[:stride, :2], twist_rate * height)
    _, bottom = cKDTree(image).query(points[top, :2])
    return SweptCell(points, tuple(blocks), regions(core, tube), twist_rate, height, bottom, top)


def _turned(points, angle):
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]])

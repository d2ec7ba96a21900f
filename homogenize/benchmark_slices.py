"""The three-dimensional cell: slices of any height are one problem, they tend to the 2D cell, and rubber does not lock them (T3).

The forces that cross the seam of a periodic problem are seen in one dimension: -u'' + u = f with u = 1 + sin 2 pi x on quadratic
elements; a reduction that drops the rows of the far end misses it by 13.6.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from geometry.cell_mesh import CrossSectionMesh
from homogenize.benchmark import Benchmark, Case, components
from homogenize.benchmark_cylinder import COAXIAL
from homogenize.benchmark_sections import linear, rings, swept
from homogenize.helical_cell import solve_helical_cell
from homogenize.helical_periodicity import reduction
from homogenize.periodic_cell import solve_periodic_cell
from homogenize.section_stiffness import pitch_average

NAMES = ("EA [N]", "coupling [N m]", "GJ [N m2]")


def eccentric_rod(n: int) -> CrossSectionMesh:
    """A stiff eccentric trace in soft rubber; `n` scales the mesh."""
    soft = (1.0, 0.45)
    return rings((0.4, 1.0), (100.0, 0.3), soft, per_ring=2 * n, around=12 * n, centre=(0.3, 0.0), twist_rate=0.5)


def heights() -> Iterable[Benchmark]:
    """Two and three layers of equal thickness against one."""
    section = linear(eccentric_rod(1))
    values = [solve_periodic_cell(swept(section, 0.1 * k, k), tolerance=1e-11).stiffness for k in (1, 2, 3)]
    one = values[0][[0, 0, 1], [0, 1, 1]]
    for k in (1, 2):
        name = f"3D cell, slice of {k + 1} layers"
        yield from components(name, "invariance", NAMES, one, values[k][[0, 0, 1], [0, 1, 1]], 1e-7)


def mesh_limit() -> Iterable[Benchmark]:
    """EA, coupling and GJ tend to those of the 2D cell with order 2."""
    exact = pitch_average(solve_helical_cell(eccentric_rod(4)).stiffness).C[np.ix_([2, 5], [2, 5])]
    scale = np.sqrt(np.outer(np.diag(exact), np.diag(exact)))
    errors = []
    for n in (1, 2, 4):
        K = solve_periodic_cell(swept(linear(eccentric_rod(n)), 0.2 / n, 1)).stiffness
        errors.append(float(np.abs((K - exact) / scale).max()))
    name, source = "3D cell to 2D cell", "two formulations"
    yield Benchmark(name, source, "largest difference, finest mesh", 0.01, errors[2], 0.0, "at most")
    yield Benchmark(name, source, "order", 1.6, float(np.log2(errors[1] / errors[2])), 0.0, "at least")


def no_locking() -> Iterable[Benchmark]:
    """Core of Poisson's ratio 0.4999: EA within a fiftieth of the Poisson mismatch, which locking would multiply."""
    core, tube, a, b, exact = COAXIAL[3]
    around = 48
    section = linear(rings((a, b), core, tube, per_ring=4, around=around, twist_rate=0.05))
    EA = solve_periodic_cell(swept(section, 0.2, 1)).stiffness[0, 0]
    step = 2 * np.pi / around
    polygon = np.sin(step) / step  # its area over the circle's
    yield Benchmark("T3 coaxial in the 3D cell, core nu 0.4999", "Lame", "EA [N]", exact, float(EA / polygon), 7e-5)


def seam() -> Iterable[Benchmark]:
    """The reduced problem has the exact solution at its nodes."""
    n = 40
    x = np.linspace(0, 1, 2 * n + 1)
    h = 1 / n
    stiff = np.array([[7.0, -8.0, 1.0], [-8.0, 16.0, -8.0], [1.0, -8.0, 7.0]]) / (3 * h)
    mass = np.array([[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]]) * h / 30
    nodes = 2 * np.arange(n)[:, None] + np.arange(3)
    shape, places = (2 * n + 1, 2 * n + 1), (np.repeat(nodes, 3, axis=1).ravel(), np.tile(nodes, 3).ravel())
    K = sp.coo_array((np.tile((stiff + mass).ravel(), n), places), shape).tocsr()
    M = sp.coo_array((np.tile(mass.ravel(), n), places), shape).tocsr()
    f = M @ (1 + (1 + 4 * np.pi**2) * np.sin(2 * np.pi * x))
    R, _ = reduction(len(x), np.array([0]), np.array([2 * n]), np.eye(1))
    u = R @ spla.spsolve((R.T @ K @ R).tocsc(), R.T @ f)
    error = float(np.abs(u - 1 - np.sin(2 * np.pi * x)).max())
    yield Benchmark("periodic problem in one dimension", "exact", "largest error", 1e-5, error, 0.0, "at most")


def slice_cases() -> tuple[Case, ...]:
    """Heights, mesh limit, locking, seam."""
    return (
        Case("3D cell, slices", "invariance", heights),
        Case("3D cell to 2D cell", "two formulations", mesh_limit),
        Case("T3 coaxial in the 3D cell", "Lame", no_locking),
        Case("periodic problem in one dimension", "exact", seam),
    )

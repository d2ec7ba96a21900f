"""Round sections whose stiffness is exact at any pitch: the homogeneous cylinder (case T2) and Lame's bonded core and tube (T3)."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

import numpy as np

from geometry.material import Material
from homogenize.benchmark import Benchmark, Case, components
from homogenize.benchmark_prismatic import ENTRIES
from homogenize.benchmark_sections import rings
from homogenize.coaxial_cylinder import CoaxialCylinder
from homogenize.helical_cell import solve_helical_cell

COAXIAL = (
    ((8.0, 0.45), (80000.0, 0.34), 5.0, 10.0, 18850288.96),
    ((8.0, 0.49), (80000.0, 0.34), 5.0, 10.0, 18851126.94),
    ((8.0, 0.499), (80000.0, 0.34), 5.0, 10.0, 18860140.19),
    ((8.0, 0.4999), (80000.0, 0.34), 5.0, 10.0, 18915363.996),
    ((210000.0, 0.30), (1000.0, 0.45), 1.0, 3.0, 684952.78),
    ((110000.0, 0.34), (10.0, 0.4995), 4.0, 11.3, 5532726.83),
)
"""(E, nu) of core and tube, radii, and the exact EA as printed in the verification table; N, mm, MPa."""


def homogeneous_cylinder(twist_rate: float, nu: float) -> Iterable[Benchmark]:
    """Radius 1, E 1: EA, EI, GJ of the circle, shear coefficient 1 / (7/6 + (nu/(1+nu))^2 / 6), no coupling, at any pitch."""
    C = solve_helical_cell(rings((1.0,), (1.0, nu), per_ring=6, around=40, twist_rate=twist_rate)).stiffness.C
    G = 0.5 / (1 + nu)
    shear = G / (7 / 6 + (nu / (1 + nu)) ** 2 / 6)
    exact = np.pi * np.array([shear, shear, 1.0, 0.25, 0.25, 0.5 * G])
    name = f"T2 cylinder, tau R {twist_rate:g}, nu {nu:g}"
    names = [ENTRIES[i] for i in (2, 3, 5)]
    yield from components(
        name, "exact", names, exact[[2, 3, 5]], np.diag(C)[[2, 3, 5]], 3e-6
    )  # area of the curved mesh
    yield Benchmark(name, "Love, energy", ENTRIES[0], exact[0], C[0, 0], 1e-4)  # cubic shear field, h = 1/6
    yield Benchmark(name, "symmetry", "largest coupling", 0.0, float(np.abs(C - np.diag(np.diag(C))).max()), 2e-6)


def coaxial_cylinder(row: int, pitch: float) -> Iterable[Benchmark]:
    """EA of core and tube; locking elements would miss it by a multiple of the Poisson mismatch."""
    core, tube, a, b, printed = COAXIAL[row]
    exact = CoaxialCylinder(Material("core", *core, 1.0), Material("tube", *tube, 1.0), a, b).EA()
    name = f"T3 coaxial, core nu {core[1]:g}, E {core[0]:g}, pitch {pitch:g}"
    if np.isinf(pitch):
        yield Benchmark(name, "verification table", "EA, closed form [N]", printed, exact, 1e-8)
    C = solve_helical_cell(rings((a, b), core, tube, per_ring=4, around=48, twist_rate=2 * np.pi / pitch)).stiffness.C
    yield Benchmark(name, "Lame", "EA [N]", exact, C[2, 2], 2e-6)


def cylinder_cases() -> tuple[Case, ...]:
    """Seven lays of the homogeneous cylinder, six pairs of materials at two pitches."""
    lays = [(0.5, 0.0), *((tau, 0.45) for tau in (0.0, 0.1, 0.5, 1.0, -1.0, 2.0))]
    bars = [(row, pitch) for row in range(len(COAXIAL)) for pitch in (np.inf, 60.0)]
    return tuple(
        [Case(f"T2 cylinder, tau R {t:g}, nu {n:g}", "exact", partial(homogeneous_cylinder, t, n)) for t, n in lays]
        + [Case(f"T3 coaxial row {r + 1}, pitch {p:g}", "Lame", partial(coaxial_cylinder, r, p)) for r, p in bars]
    )

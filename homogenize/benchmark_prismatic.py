"""Straight bars: the 6x6 of other codes and Saint-Venant's closed forms (cases T1).

Values of BECAS as asserted by GXBeam.jl (test/section.jl) after the BECAS user guide, which used 10 x 10 linear elements: 1 to 1.5 %
on shear
and torsion. ANBA4: its unit test. Exact: EA, EI, and GJ = 0.1405770 G a^4 of a square.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from homogenize.benchmark import Benchmark, Case, components
from homogenize.benchmark_sections import rectangle, rings
from homogenize.helical_cell import solve_helical_cell

BECAS = "BECAS user guide, by GXBeam.jl"
ENTRIES = ("K11 [N]", "K22 [N]", "K33 [N]", "K44 [N m2]", "K55 [N m2]", "K66 [N m2]")


def square() -> Iterable[Benchmark]:
    """S1: side 0.1 m, E 100 Pa, nu 0.2."""
    a, E, nu = 0.1, 100.0, 0.2
    C = solve_helical_cell(rectangle(16, 16, a, a, (E, nu))).stiffness.C
    name, G = "T1 square bar S1", E / (2 * (1 + nu))
    bending = E * a**4 / 12
    yield from components(name, "exact", ENTRIES[2:5], (E * a**2, bending, bending), np.diag(C)[2:5], 1e-10)
    yield Benchmark(name, "Saint-Venant", ENTRIES[5], 0.1405770 * G * a**4, C[5, 5], 1e-4)
    yield from components(name, BECAS, ENTRIES[:2], (0.34899, 0.34899), np.diag(C)[:2], 1e-2)
    off = np.abs(C - np.diag(np.diag(C))).max()
    yield Benchmark(name, "symmetry", "largest coupling [N, N m, N m2]", 0.0, float(off), 1e-6)


def unit_square() -> Iterable[Benchmark]:
    """Side 1 m, E 1 Pa, nu 0.33."""
    C = solve_helical_cell(rectangle(12, 12, 1.0, 1.0, (1.0, 0.33))).stiffness.C
    expected = (0.311064, 0.311064, 1.0, 1 / 12, 1 / 12, 0.0528559)
    yield from components("T1 unit square", "ANBA4 unit test", ENTRIES, expected, np.diag(C), 1e-3)


def two_materials() -> Iterable[Benchmark]:
    """S2: E 100 for x < 0, 10 for x > 0; the couplings with their signs."""
    C = solve_helical_cell(rectangle(10, 10, 0.1, 0.1, (100.0, 0.2), (10.0, 0.2), split_x=0.0)).stiffness.C
    name, expected = "T1 two-material square S2", (0.128, 0.192, 0.550, 4.59e-4, 4.59e-4, 2.77e-4)
    yield from components(name, BECAS, ENTRIES, expected, np.diag(C), 1.5e-2)
    yield Benchmark(name, BECAS, "K26 [N m]", -3.93e-3, C[1, 5], 1.5e-2)
    yield Benchmark(name, BECAS, "K35 [N m]", 1.13e-2, C[2, 4], 1.5e-2)


def tube() -> Iterable[Benchmark]:
    """C1: outer radius 0.1 m, wall 0.01 m, E 100 Pa, nu 0.2."""
    C = solve_helical_cell(rings((0.09, 0.10), (100.0, 0.2), around=48)).stiffness.C
    E, G = 100.0, 100 / 2.4
    area, inertia = np.pi * (0.1**2 - 0.09**2), np.pi * (0.1**4 - 0.09**4) / 4
    exact = (E * area, E * inertia, E * inertia, 2 * G * inertia)
    yield from components("T1 thin tube C1", "exact", ENTRIES[2:], exact, np.diag(C)[2:], 1e-5)
    yield from components("T1 thin tube C1", BECAS, ENTRIES[:2], (0.1249, 0.1249), np.diag(C)[:2], 1e-2)


def thick_tube() -> Iterable[Benchmark]:
    """Radii 0.1 and 0.3 m, E 73 GPa, nu 0.33; GJ is the exact value (3.519e8 is asserted elsewhere and 2 % off)."""
    C = solve_helical_cell(rings((0.1, 0.3), (73e9, 0.33), per_ring=6, around=48)).stiffness.C
    expected = (4.682e9, 4.682e9, 1.835e10, 4.587e8, 4.587e8, 3.449e8)
    yield from components("T1 thick tube", "ANBA4 unit test; GJ exact", ENTRIES, expected, np.diag(C), 1e-3)


def prismatic_cases() -> tuple[Case, ...]:
    """The straight bars."""
    return (
        Case("T1 square bar S1", BECAS, square),
        Case("T1 unit square", "ANBA4 unit test", unit_square),
        Case("T1 two-material square S2", BECAS, two_materials),
        Case("T1 thin tube C1", BECAS, tube),
        Case("T1 thick tube", "ANBA4 unit test", thick_tube),
    )

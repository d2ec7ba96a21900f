"""A single helical wire against Kirchhoff's rod (case T4), extrapolated to a wire that is thin beside its helix.

The cell differs from the rod by O((a/r)^2) and by the shear of the wire, so that ratios to the rod at r/a = 40 and 80 are extrapolated,
(4 q(80) - q(40)) / 3. Mirror images differ in the sign of the coupling only.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from homogenize.benchmark import Benchmark, Case, components
from homogenize.benchmark_sections import rings, wire_trace
from homogenize.helical_cell import solve_helical_cell
from homogenize.helical_spring import spring_bending_stiffness, spring_stiffness
from homogenize.section_stiffness import SectionStiffness, pitch_average

PRINTED = {
    80: (1.058528e-3, -5.381883e-4, 0.1354339, 1.056389e-3),
    75: (1.594876e-3, -1.172592e-3, 0.2001335, 1.588005e-3),
    60: (3.245642e-3, -3.922058e-3, 0.3700409, 3.204072e-3),
    45: (4.907377e-3, -6.400926e-3, 0.4912711, 4.823977e-3),
}
"""K_FF, K_FM, K_MM and 1 / C_FF of the verification table, by lay angle [deg]: r 10, a 1, E 1, nu 0.3."""


def wire_section(beta: float, r: float, a: float, sign: float = 1.0) -> SectionStiffness:
    """Pitch-averaged 6x6 of one wire of radius a on a helix of radius r, lay angle beta [rad], E 1, nu 0.3."""
    tau = sign * np.tan(beta) / r
    mesh = rings((a,), (1.0, 0.3), per_ring=4, around=48, twist_rate=tau, shape=wire_trace(a, r, tau))
    return pitch_average(solve_helical_cell(mesh).stiffness)


def wire_ratios(beta: float, r: float, a: float) -> NDArray[np.float64]:
    """Cell over rod: K_FF, K_FM, K_MM, EI."""
    section, K = wire_section(beta, r, a), spring_stiffness(beta, r, a)
    C = section.C
    EI = spring_bending_stiffness(beta, a)
    return np.array([C[2, 2] / K[0, 0], C[2, 5] / K[0, 1], C[5, 5] / K[1, 1], section.EI_x / EI])


def closed_form() -> Iterable[Benchmark]:
    """The closed form has the printed digits."""
    for degrees, row in PRINTED.items():
        K = spring_stiffness(np.radians(degrees), 10.0, 1.0)
        found = (K[0, 0], K[0, 1], K[1, 1], K[0, 0] - K[0, 1] ** 2 / K[1, 1])
        names = ("K_FF [N]", "K_FM [N m]", "K_MM [N m2]", "1 / C_FF [N]")
        yield from components(
            f"T4 closed form, {degrees} deg", "verification table", names, row, found, 1e-6
        )  # seven printed digits


def spring(degrees: float) -> Iterable[Benchmark]:
    """The 2D cell tends to Kirchhoff's rod."""
    beta = np.radians(degrees)
    coarse, fine = wire_ratios(beta, 10.0, 0.25), wire_ratios(beta, 10.0, 0.125)
    names = ("K_FF over rod", "K_FM over rod", "K_MM over rod", "EI over rod")
    yield from components(
        # what is left, 6e-5 in the coupling at 60 deg, falls with the mesh of the wire
        f"T4 spring, {degrees:g} deg, a/r -> 0",
        "Kirchhoff, Love",
        names,
        np.ones(4),
        (4 * fine - coarse) / 3,
        2e-4,
    )


def mirror() -> Iterable[Benchmark]:
    """Reversing the lay changes the sign of the coupling and nothing else; a free spring winds up when it is pulled."""
    Z, S = (wire_section(np.radians(30), 10.0, 1.0, sign).C for sign in (1.0, -1.0))
    name = "mirror image of a lay, 30 deg"
    names = ("EA [N]", "GJ [N m2]", "EI [N m2]", "GA [N]")
    order = (2, 5, 3, 0)
    yield from components(name, "symmetry", names, [Z[i, i] for i in order], [S[i, i] for i in order], 1e-8)
    yield Benchmark(name, "symmetry", "coupling [N m]", -Z[2, 5], S[2, 5], 1e-8)
    yield Benchmark(name, "Kirchhoff", "coupling of a free right-hand spring [N m]", 0.0, Z[2, 5], 0.0, "at most")


def spring_cases() -> tuple[Case, ...]:
    """Closed form, three lay angles, mirror image."""
    source = "Kirchhoff, Love"
    return (
        Case("T4 closed form", "verification table", closed_form),
        *(Case(f"T4 spring, {b} deg", source, partial(spring, b)) for b in (20, 45, 60)),
        Case("mirror image", "symmetry", mirror),
    )

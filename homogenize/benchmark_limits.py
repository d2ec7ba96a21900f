"""What holds for every section: energy bounds and reciprocity, the straight limit of a long pitch, and the limits of the rubber law (T12).

The sections are made of rings, so that no mesher is needed; the reference cable is checked against the same bounds on every run.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from geometry.material import Material
from homogenize.benchmark import Benchmark, Case, band, components
from homogenize.benchmark_prismatic import ENTRIES
from homogenize.benchmark_sections import rings
from homogenize.cell_checks import axial_bounds, check_cell, reciprocal_couplings
from homogenize.helical_cell import solve_helical_cell
from homogenize.rubber_filled_cable import RubberFilledCable
from homogenize.section_stiffness import pitch_average

PRINTED_RUBBER = {
    0.45: ((10, 6423, 164), (15, 4647, 73), (20, 2620, 41), (30, 555, 18)),
    0.49: ((10, 6748, 160), (15, 5791, 71), (20, 4394, 40), (30, 1611, 18)),
    0.499: ((10, 6829, 159), (15, 6146, 71), (20, 5232, 40), (30, 3009, 18)),
}
"""By Poisson's ratio: lay angle [deg], EA / A blocked and free [MPa], as printed; OD 68 mm, 335 mm2 at 80 GPa, r 16 mm, rubber 8 MPa."""


def energy_bounds() -> Iterable[Benchmark]:
    """An eccentric stiff rod in rubber: EA between its bounds, energy equal to work, both couplings equal."""
    mesh = rings((0.4, 1.0), (1000.0, 0.34), (3.0, 0.45), per_ring=3, around=24, centre=(0.1, 0.0), twist_rate=0.8)
    cell = solve_helical_cell(mesh)
    section = pitch_average(cell.stiffness)
    lower, upper = axial_bounds(mesh, cell)
    name = "energy bounds, eccentric rod in rubber"
    yield Benchmark(name, "Hill 1963", "EA blocked [N]", upper, section.EA_blocked_twist, 0.0, "at most")
    yield Benchmark(name, "Hill 1963", "EA free [N]", lower, section.EA_free_twist, 0.0, "at least")
    torque, tension = reciprocal_couplings(cell)
    yield Benchmark(name, "Betti", "coupling from stresses [N m]", tension, torque, 1e-7)
    held = float(sum(check.holds for check in check_cell(mesh, cell)))
    yield Benchmark(name, "energy, equilibrium", "checks that hold, of 5", 5.0, held, 0.0)


def bounds_close() -> Iterable[Benchmark]:
    """One material: both bounds are E A."""
    mesh = rings((1.0,), (5.0, 0.4), twist_rate=0.4)
    cell = solve_helical_cell(mesh)
    lower, upper = axial_bounds(mesh, cell)
    EA = 5.0 * cell.field.area
    name = "energy bounds, one material"
    values = (lower, upper, cell.stiffness.C[2, 2])
    yield from components(name, "exact", ("lower [N]", "upper [N]", "EA [N]"), (EA, EA, EA), values, 1e-9)


def long_pitch() -> Iterable[Benchmark]:
    """A pitch of a million radii is a straight bar."""
    straight, long = (
        solve_helical_cell(rings((0.5, 1.0), (100.0, 0.3), (1.0, 0.45), twist_rate=tau)).stiffness.C
        for tau in (0.0, 6e-6)
    )
    yield from components("long pitch, tau R 6e-6", "prismatic limit", ENTRIES, np.diag(straight), np.diag(long), 1e-6)


def _reference_rubber(nu: float, degrees: float, conductor: float = 80e9, rubber: float = 8e6) -> RubberFilledCable:
    area = np.pi * 34e-3**2 - 335e-6
    material = Material("rubber", rubber, nu, 1000.0)
    return RubberFilledCable(335e-6 * conductor, 16e-3, float(np.radians(degrees)), material, float(area))


def rubber_law() -> Iterable[Benchmark]:
    """The printed table, to half a unit of its last digit."""
    total = np.pi * 34e-3**2
    for nu, rows in PRINTED_RUBBER.items():
        for degrees, blocked, free in rows:
            cable, name = _reference_rubber(nu, degrees), f"T12 rubber law, nu {nu:g}, {degrees} deg"
            found = (cable.EA() / total / 1e6, cable.EA(free_twist=True) / total / 1e6)
            quantities = ("EA/A blocked [MPa]", "EA/A free [MPa]")
            yield from components(name, "verification table", quantities, (blocked, free), found, 0.5, scale=1.0)


def rubber_limits() -> Iterable[Benchmark]:
    """Stiff radius, soft radius, incompressible; leading terms for a small lay angle of 5 deg, where they hold to tan^2 = 0.8 %."""
    name = "T12 rubber law, limits at 5 deg"
    stiff = _reference_rubber(0.0, 5.0, conductor=1e3)
    # conductors far softer than the rubber: what they add to its own EA is S0 cos^3 and the Poisson terms vanish at nu 0
    alone = _reference_rubber(0.0, 5.0, conductor=1e-9).EA()
    yield Benchmark(
        name, "S0 cos^3", "added by the conductors, stiff radius [N]", stiff.stiff_radius, stiff.EA() - alone, 1e-3
    )
    soft = _reference_rubber(0.3, 5.0, conductor=80e15)
    yield Benchmark(name, "4 (l + m) A cot^4", "EA blocked, soft radius [N]", soft.soft_radius, soft.EA(), 2e-2)
    tight = _reference_rubber(0.4999999, 5.0, conductor=80e9, rubber=1e3)
    # bulk modulus far above, shear modulus far below the conductors
    yield Benchmark(
        name, "(S0/c)(c^2 - s^2/2)^2", "EA blocked, incompressible [N]", tight.incompressible, tight.EA(), 2e-2
    )
    free = _reference_rubber(0.49999, 5.0, conductor=80e15)
    expected = free.incompressible_free_twist
    yield Benchmark(name, "m J cot^2 / r^2 + 3 m A", "EA free, incompressible [N]", expected, free.EA(True), 2e-2)
    cable = _reference_rubber(0.49, 15.0)
    yield band(name, "limits", "EA blocked, 15 deg [N]", 0.0, cable.stiff_radius * 1.05, cable.EA())


def limit_cases() -> tuple[Case, ...]:
    """Bounds, straight limit, rubber law."""
    return (
        Case("energy bounds", "Hill 1963", energy_bounds),
        Case("energy bounds, one material", "exact", bounds_close),
        Case("long pitch", "prismatic limit", long_pitch),
        Case("T12 rubber law", "verification table", rubber_law),
        Case("T12 limits of the rubber law", "closed forms", rubber_limits),
    )

"""The two-stage route beside the cell with all strands, on the reference cable.

Three tables:

1. every stage of the route, strands bonded and strands without friction;
2. one core by itself, straight: rope, equivalent cylinder and layers against the three-dimensional cell of all strands;
3. with --resolved, the whole cable: route and single cylinders, conductors bonded in their insulation and sliding, against the
   three-dimensional cell of all strands (about 800 000 unknowns).

Run: python -m benchmarks.two_stage [--resolved] (half a minute of CPU; with --resolved six). The last results are in
benchmarks/two_stage.md, what they mean in docs/section-stiffness.md.
"""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np

from geometry import Cable, nested_cell, read_cable
from geometry.cable import ring_moments
from homogenize import PeriodicCell, solve_periodic_cell
from homogenize.section_stiffness import SectionStiffness
from homogenize.two_stage import Stage, TwoStage, two_stage

CABLE = "mcpt-1.9-3.3-3x35"
HEAD = f"{'':20} {'':36} {'E GPa':>8} {'EA MN':>8} {'free MN':>8} {'coupling N m':>13} {'GJ N m2':>9} {'EI N m2':>9}"


def line(stage: Stage) -> str:
    """A stage as a line of the table."""

    def shown(value: float | None, scale: float, width: int) -> str:
        return f"{'-':>{width}}" if value is None else f"{value / scale:{width}.4g}"

    cells = [(stage.E, 1e9, 8), (stage.EA_blocked_twist, 1e6, 8), (stage.EA_free_twist, 1e6, 8)]
    cells += [(stage.coupling, 1, 13), (stage.GJ, 1, 9), (stage.EI, 1, 9)]
    return f"{stage.name:20} {stage.what:36} " + " ".join(shown(*cell) for cell in cells)


def core_of(cable: Cable, member: str) -> Cable:
    """One core as a cable of its own, straight."""
    parts = tuple(
        replace(
            p,
            centre_radius=0.0,
            phase=0.0,
            twist_rate=0.0,
            moments=tuple(ring_moments(0.0, 0.0, p.inner_radius, p.outer_radius, 0.0).tolist()),
        )
        for p in cable.parts
        if p.member == member
    )
    radius = parts[-1].outer_radius
    return replace(cable, name=member, parts=parts, lay=None, outer_radius=radius, laid_up_radius=radius)


def resolved_stage(name: str, what: str, area: float, cell: PeriodicCell) -> Stage:
    """Stretch and twist of the three-dimensional cell; bending where it was solved."""
    (EA, coupling), (_, GJ) = cell.stiffness
    EI = None if cell.section is None else cell.section.EI_x
    return Stage(name, what, area, float(EA), float(EA - coupling**2 / GJ), float(coupling), float(GJ), EI)


def difference(route: SectionStiffness, cell: PeriodicCell) -> str:
    """EA, coupling and GJ of the route less those of the cell, of the cell's diagonal."""
    C = route.C[np.ix_([2, 5], [2, 5])]
    scale = np.sqrt(np.outer(np.diag(cell.stiffness), np.diag(cell.stiffness)))
    error = 100 * (C - cell.stiffness) / scale
    words = f"EA {error[0, 0]:+.2f} %, coupling {error[0, 1]:+.2f} %, GJ {error[1, 1]:+.2f} %"
    return words if cell.section is None else f"{words}, EI {100 * (route.EI_x / cell.section.EI_x - 1):+.1f} %"


def main() -> None:
    cable = read_cable(CABLE)
    results: dict[str, TwoStage] = {}
    for strands in ("bonded", "frictionless"):
        results[strands] = two_stage(cable, strands)
        print(f"\n{CABLE}, strands {strands}, conductors bonded in their insulation\n{HEAD}")
        for stage in results[strands].stages:
            print(line(stage))
    core = core_of(cable, "power core 1")
    print(f"\nOne power core, straight, all bonded\n{HEAD}")
    print(line(next(s for s in results["bonded"].stages if s.name == "power core 1")))
    for size in (1.6e-3, 1.0e-3):
        cell = nested_cell(core, size=size)
        solved = solve_periodic_cell(cell, tolerance=1e-6)
        print(line(resolved_stage("power core 1", f"all strands, {solved.unknowns} unknowns", core.area, solved)))
    if "--resolved" not in sys.argv:
        return
    cell = nested_cell(cable, size=2.5e-3)
    solved = solve_periodic_cell(cell, tolerance=1e-6)
    print(f"\nThe whole cable, all bonded\n{HEAD}")
    print(line(resolved_stage("cable", f"all strands, {solved.unknowns} unknowns", cable.area, solved)))
    sliding = two_stage(cable, "bonded", "frictionless")
    for held, result in (("bonded", results["bonded"]), ("sliding", sliding)):
        print(f"two-stage, conductors {held}:", difference(result.section, solved))
        print(f"single cylinders, {held}:", difference(result.single_cylinder, solved))


if __name__ == "__main__":
    main()

"""`helicable stress`: local stresses in every part from what a rod carries."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
import typer

from geometry import read_cable
from geometry.errors import SpecError
from geometry.units import read_quantity
from helicable.interface_words import read_interface
from helicable.options import CableArgument, JsonOption, OutOption, SizeOption
from helicable.screen import engineering, folder, progress, say, table, write_json
from homogenize import INTERFACES, Homogenization, homogenize_cable
from homogenize.stress_recovery import RegionStress, StressRecovery, recover, section_forces

HARD_DRAWN = 1e-3
"""Strain at which soft copper leaves its elastic line; beyond it a linear stress is a measure of strain only."""


def stress(
    cable: CableArgument,
    tension: Annotated[str, typer.Option(help="Tension N.")] = "0 N",
    bend_radius: Annotated[
        str | None,
        typer.Option("--bend-radius", metavar="LENGTH", help="Radius of the cable's axis; straight without it."),
    ] = None,
    moment: Annotated[str | None, typer.Option(help="Bending moment, instead of a bend radius.")] = None,
    torque: Annotated[str, typer.Option(help="Torque M_z.")] = "0 N m",
    blocked: Annotated[
        bool, typer.Option("--blocked", help="The ends cannot turn: twist zero, instead of a torque.")
    ] = False,
    interface: Annotated[
        str, typer.Option(help=f"`{'`, `'.join(INTERFACES)}`, or pairs with laws, as in `helicable homogenize`.")
    ] = "bonded",
    size: SizeOption = None,
    json: JsonOption = None,
    out: OutOption = None,
) -> None:
    """Recover stresses and strains in every part under tension, bend and torque, at their worst over the pitch.

    Example: `helicable stress mcpt-1.9-3.3-3x35 --tension "1300 N" --bend-radius "310 mm" --out stress`
    """
    if bend_radius is not None and moment is not None:
        raise SpecError("--bend-radius and --moment say the same twice; keep one of them.")
    made = read_cable(cable)
    pull, twisting = read_quantity(tension, "N", "--tension"), read_quantity(torque, "N m", "--torque")
    if blocked and twisting != 0:
        raise SpecError("--blocked and --torque exclude each other; keep one of them.")
    radius = None if bend_radius is None else read_quantity(bend_radius, "m", "--bend-radius")
    if radius is not None and not radius > 0.5 * made.outer_diameter:
        raise SpecError(
            f"--bend-radius {1e3 * radius:g} mm must exceed the radius of the cable, {5e2 * made.outer_diameter:.4g} mm."
        )
    element = None if size is None else read_quantity(size, "m", "--size")
    held_by = read_interface(interface)
    with progress("stress recovery") as tell:
        result = homogenize_cable(made, interface=held_by, size=element, progress=tell)
        kappa = 0.0 if radius is None else 1 / radius
        forces = section_forces(
            result.section, tension=pull, curvature=(kappa, 0.0), torque=twisting, twist=0.0 if blocked else None
        )
        if moment is not None:
            forces[3] = read_quantity(moment, "N m", "--moment")
        recovery = recover(result.cell, result.mesh, forces)
    show_stress(result, recovery)
    record = stress_record(result, recovery)
    write_json(json, record)
    if out is not None:
        from homogenize.stress_picture import draw_stress

        write_json(folder(out) / "stress.json", record)
        picture = draw_stress(
            recovery, out / "stress.png", title=f"{made.name}: {interface}, worst angle of the conductors"
        )
        say(f"written: {out / 'stress.json'}, {picture}")


def show_stress(result: Homogenization, recovery: StressRecovery) -> None:
    """Print the table and what to make of it."""
    F, psi = recovery.forces, result.section.compliance @ recovery.forces
    say(
        f"N {engineering(F[2], 'N')}, M_x {engineering(F[3], 'N m')}, M_z {engineering(F[5], 'N m')}; stretch {100 * psi[2]:.3g} %, "
        f"curvature {psi[3]:.4g} 1/m, twist {np.degrees(psi[5]):.3g} deg/m\n"
    )
    rows = [
        (
            r.name,
            *(f"{value / 1e6:.4g}" for value in (r.axial_mean, r.axial_max, r.axial_min, r.von_mises)),
            f"{100 * r.strain_max:.3g}",
            f"{1e3 * r.place[0]:.1f}, {1e3 * r.place[1]:.1f}",
        )
        for r in recovery.regions
    ]
    columns = ("part", "mean", "max", "min", "von Mises", "strain", "at x, y")
    table(
        f"{result.cable.name}: over the whole pitch, {result.cell.interface}", columns, rows, right=(1, 2, 3, 4, 5, 6)
    )
    for note in stress_notes(recovery):
        say(f"- {note}")


def stress_notes(recovery: StressRecovery) -> list[str]:
    """What limits the numbers."""
    notes = [
        "linear elastic; along = along the helix of the part; places in the section as drawn",
        "a conductor is one cylinder: mean over metal and voids. Its strands slide on each other and bend one by one, so that the bending "
        "part is an upper estimate",
    ]
    conductors = [r for r in recovery.regions if r.kind == "conductor"]
    worst = max(conductors, key=_largest_strain, default=None)
    if worst is not None and _largest_strain(worst) > HARD_DRAWN:
        notes.append(
            f"{worst.name} is strained by {100 * _largest_strain(worst):.2g} %, soft copper yields near {100 * HARD_DRAWN:.2g} %: "
            "read its stress as a strain"
        )
    return notes


def _largest_strain(row: RegionStress) -> float:
    return max(abs(row.strain_max), abs(row.strain_min))


def stress_record(result: Homogenization, recovery: StressRecovery) -> dict[str, Any]:
    """The JSON of `helicable stress`."""
    return {
        "schema": 1,
        "cable": result.cable.name,
        "interface": result.cell.interface,
        "forces": dict(zip(("T_x", "T_y", "N", "M_x", "M_y", "M_z"), recovery.forces.tolist(), strict=True)),
        "strains": dict(
            zip(
                ("gamma_x", "gamma_y", "epsilon", "kappa_x", "kappa_y", "tau"),
                (result.section.compliance @ recovery.forces).tolist(),
                strict=True,
            )
        ),
        "regions": {
            r.name: {
                "kind": r.kind,
                "axial_mean": r.axial_mean,
                "axial_max": r.axial_max,
                "axial_min": r.axial_min,
                "axial_strain_max": r.strain_max,
                "axial_strain_min": r.strain_min,
                "von_mises_max": r.von_mises,
                "von_mises_place": list(r.place),
                "von_mises_angle": r.angle,
            }
            for r in recovery.regions
        },
        "notes": stress_notes(recovery),
    }

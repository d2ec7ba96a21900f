"""`helicable homogenize`: the constants of the beam equivalent to a long cable."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from geometry import Cable, read_cable
from geometry.errors import ConvergenceError, SpecError
from geometry.units import read_quantity
from helicable.interface_words import read_interface
from helicable.options import CableArgument, JsonOption, OutOption, SizeOption
from helicable.published import modulus_rows
from helicable.screen import engineering, folder, progress, say, table, write_json
from helicable.two_stage_report import show_two_stage, two_stage_record
from homogenize import (
    ORDER,
    Homogenization,
    Interfaces,
    PeriodicCell,
    SectionInertia,
    homogenize_cable,
    slice_stiffness,
    strand_stiffness,
    two_stage,
)
from homogenize.section_export import FORMATS, ExportedSection, dropped, export_format, export_section

METHODS = ("helical", "cell", "two-stage")
LEVELS = ("section", "strand")


def homogenize(
    cable: CableArgument,
    method: Annotated[
        str,
        typer.Option(
            help="`helical`: 2D cell of the cross-section; `cell`: 3D periodic cell; `two-stage`: strands first."
        ),
    ] = "helical",
    level: Annotated[
        str, typer.Option(help="With `--method cell`: `section`, a slice; `strand`, all strands one by one (minutes).")
    ] = "section",
    strands: Annotated[
        str, typer.Option(help="With `--method two-stage`: strands of a conductor `bonded` or `frictionless`.")
    ] = "bonded",
    interface: Annotated[
        str,
        typer.Option(
            help="`bonded`; `frictionless`: conductors slide, without opening; or pairs with laws, such as "
            '"conductor-insulation=frictionless,core-filler=elastic:1e9 Pa/m".'
        ),
    ] = "bonded",
    size: SizeOption = None,
    phase: Annotated[str, typer.Option(help="Angle of the section for the values at a phase.")] = "0 deg",
    json: JsonOption = None,
    out: OutOption = None,
    export: Annotated[
        Path | None, typer.Option("--export", metavar="FILE", help="Write the section for another beam program.")
    ] = None,
    format: Annotated[
        str | None,
        typer.Option("--format", metavar="NAME", help=f"Of --export: {', '.join(FORMATS)}; else by the file's ending."),
    ] = None,
) -> None:
    """Compute E, G_yoz, G_xoz and the 6x6 section stiffness of a long cable.

    Example: `helicable homogenize mcpt-1.9-3.3-3x35 --json section.json`
    """
    held_by = _check_choices(method, interface, level)
    _check_export(method, export, format)
    made = read_cable(cable)
    element = None if size is None else read_quantity(size, "m", "--size")
    angle = read_quantity(phase, "rad", "--phase")
    if method == "cell":
        with progress("3D periodic cell") as tell:
            start = time.perf_counter()
            if level == "strand":
                cell = strand_stiffness(made, size=element, progress=tell)
            else:
                cell = slice_stiffness(made, size=element, bending=True, progress=tell)
        show_slice(made, cell)
        write_json(json, slice_record(made, cell, time.perf_counter() - start, level))
        return
    if method == "two-stage":
        with progress("two-stage route") as tell:
            start = time.perf_counter()
            staged = two_stage(made, strands, interface, element, progress=tell)
        show_two_stage(staged)
        write_json(json, two_stage_record(staged, _head(made, staged.section.area), time.perf_counter() - start))
        return
    with progress("2D helical cell") as tell:
        result = homogenize_cable(made, interface=held_by, size=element, progress=tell)
    show_constants(result, angle)
    write_json(json, homogenization_record(result, angle))
    if out is not None:
        from geometry import draw_mesh

        write_json(folder(out) / "section.json", homogenization_record(result, angle))
        draw_mesh(result.mesh, out / "mesh.png")
        say(f"written: {out / 'section.json'}, {out / 'mesh.png'}")
    failed = [c.name for c in result.checks if not c.holds]
    if failed:
        raise ConvergenceError(
            f"the result fails the check of {', '.join(failed)}: do not use it, and try another element size."
        )
    if export is not None:
        kind = export_format(export, format)
        say(
            f"written: {export_section(exported_section(result), export, kind)}, {kind}, averaged over the pitch. {dropped(kind)}"
        )


def _check_choices(method: str, interface: str, level: str) -> str | Interfaces:
    """The interfaces that were asked for."""
    if method not in METHODS:
        raise SpecError(f'--method "{method}" is not known; choose {", ".join(METHODS)}.')
    found = read_interface(interface)
    if method == "cell" and found != "bonded":
        raise SpecError(f'the 3D cell bonds all parts; use --method helical for --interface "{interface}".')
    if method == "two-stage" and not isinstance(found, str):
        raise SpecError(
            "the two-stage route knows bonded and frictionless only; use --method helical for pairs with laws."
        )
    if level not in LEVELS:
        raise SpecError(f'--level "{level}" is not known; choose {" or ".join(LEVELS)}.')
    if level == "strand" and method != "cell":
        raise SpecError("the strands one by one need the 3D cell: add --method cell.")
    return found


def _check_export(method: str, export: Path | None, format: str | None) -> None:
    if export is None and format is not None:
        raise SpecError("--format says how --export FILE is written; name the file too.")
    if export is not None:
        export_format(export, format)
        if method != "helical":
            raise SpecError("--export writes the 6x6 of --method helical; leave the other method out.")


def exported_section(result: Homogenization) -> ExportedSection:
    """What other beam programs are given: the averaged section, mass, and rotary inertia as of a circle."""
    cable = result.cable
    inertia = SectionInertia.solid_circle(cable.mass_per_length, cable.outer_diameter)
    return ExportedSection(cable.name, result.section, inertia, cable.outer_diameter)


def held(result: Homogenization) -> str:
    """How the parts hold together, in words."""
    words = {"bonded": "all parts bonded", "frictionless": "conductors sliding without friction"}
    return words.get(result.cell.interface, result.cell.interface)


def constant_rows(result: Homogenization) -> list[tuple[str, str, str]]:
    """Quantity, value and definition, for terminal and report."""
    s, a = result.section, result.average
    lower, upper = result.bounds
    least = engineering(lower, "N") if lower > 0 else "0"
    return [
        ("E, twist blocked", engineering(a.E_blocked_twist, "Pa"), "mean stress / mean strain, no twist"),
        ("E, ends free to twist", engineering(a.E_free_twist, "Pa"), "mean stress / mean strain, no torque"),
        ("G_yoz = G_xoz", engineering(a.G_yoz, "Pa"), "mean shear stress / mean shear strain, averaged over the pitch"),
        ("EA, twist blocked", engineering(s.EA_blocked_twist, "N"), "C33 of the 6x6"),
        ("EA, ends free to twist", engineering(s.EA_free_twist, "N"), "C33 - C36^2 / C66"),
        (
            "bounds of EA",
            f"{least} .. {engineering(upper, 'N')}",
            "central conductor .. sum of E A with Poisson mismatch",
        ),
        ("stretch-twist coupling", engineering(s.coupling, "N m"), "C36: torque per unit stretch"),
        ("GJ", engineering(s.GJ, "N m2"), "C66, stretch blocked"),
        ("EI_x = EI_y", engineering(s.EI_x, "N m2"), "moment / curvature, constant moment"),
        ("GA_x = GA_y", engineering(s.GA_x, "N"), "beam shear: energy of a shear force and of the moment it builds up"),
    ]


def show_constants(result: Homogenization, phase: float = 0.0) -> None:
    """Print constants, published values and checks."""
    cable = result.cable
    table(
        f"{cable.name}: long cable, {held(result)}; moduli refer to {1e6 * result.section.area:.0f} mm2",
        ("quantity", "value", "definition"),
        constant_rows(result),
        right=(1,),
    )
    G_yoz, G_xoz = result.average.shear_moduli_at(phase)
    at = result.phase_zero.turned(phase)
    say(
        f"At phase {np.degrees(phase):.0f} deg: G_yoz {engineering(G_yoz, 'Pa')}, G_xoz {engineering(G_xoz, 'Pa')}, "
        f"EI_x {engineering(at.EI_x, 'N m2')}, EI_y {engineering(at.EI_y, 'N m2')}.\n"
    )
    published = modulus_rows(result)
    if published:
        rows = [
            (r.quantity, *(f"{v / 1e6:.1f}" for v in (r.published, r.computed)), f"{r.ratio:.2g}") for r in published
        ]
        heads = ("", "published MPa", "computed MPa", "ratio")
        table(
            "Beside the published values, which answer another question: a finite specimen",
            heads,
            rows,
            right=(1, 2, 3),
        )
    checks = [("holds" if c.holds else "FAILS", c.name, c.sentence) for c in result.checks]
    table("Checks", ("", "check", "found"), checks)
    if result.cell.free_motions:
        say(f"Free, and held in the solution, since nothing resists: {', '.join(result.cell.free_motions)}.")
    say(f"{result.cell.field.unknowns} unknowns, {len(result.mesh.cells)} elements, {result.seconds:.1f} s")


def show_slice(cable: Cable, cell: PeriodicCell) -> None:
    """Print the result of the 3D cell."""
    EA, coupling, GJ = cell.stiffness[0, 0], cell.stiffness[0, 1], cell.stiffness[1, 1]
    rows = [
        ("EA, twist blocked", engineering(EA, "N")),
        ("EA, ends free to twist", engineering(EA - coupling**2 / GJ, "N")),
        ("stretch-twist coupling", engineering(coupling, "N m")),
        ("GJ", engineering(GJ, "N m2")),
    ]
    if cell.section is not None:
        rows += [
            ("EI_x", engineering(cell.section.EI_x, "N m2")),
            ("EI_y", engineering(cell.section.EI_y, "N m2")),
            ("GA_x", engineering(cell.section.GA_x, "N")),
            ("GA_y", engineering(cell.section.GA_y, "N")),
        ]
    table(f"{cable.name}: 3D periodic cell, all parts bonded", ("quantity", "value"), rows, right=(1,))
    counts = ", ".join(f"{name} {n}" for name, n in zip(cell.loads, cell.iterations, strict=True))
    say(f"{cell.unknowns} unknowns; iterations: {counts}")


def homogenization_record(result: Homogenization, phase: float = 0.0) -> dict[str, Any]:
    """The JSON of `helicable homogenize`, method helical."""
    s, a = result.section, result.average
    G_yoz, G_xoz = a.shear_moduli_at(phase)
    at = result.phase_zero.turned(phase)
    return {
        **_head(result.cable, s.area),
        "section": {
            "order": list(ORDER),
            "C": s.C,
            "EA_blocked_twist": s.EA_blocked_twist,
            "EA_free_twist": s.EA_free_twist,
            "GJ": s.GJ,
            "coupling": s.coupling,
            "EI_x": s.EI_x,
            "EI_y": s.EI_y,
            "GA_x": s.GA_x,
            "GA_y": s.GA_y,
            "phase": "averaged over the pitch",
        },
        "E_blocked_twist": a.E_blocked_twist,
        "E_free_twist": a.E_free_twist,
        "G_yoz": a.G_yoz,
        "G_xoz": a.G_xoz,
        "at_phase": {"phase": phase, "G_yoz": G_yoz, "G_xoz": G_xoz, "EI_x": at.EI_x, "EI_y": at.EI_y, "C": at.C},
        "bounds": {"EA_lower": result.bounds[0], "EA_upper": result.bounds[1]},
        "checks": [{"name": c.name, "holds": c.holds, "found": c.sentence} for c in result.checks],
        "published": {r.quantity: r.published for r in modulus_rows(result)},
        "mesh": {"unknowns": result.cell.field.unknowns, "elements": len(result.mesh.cells)},
        "method": "helical",
        "interface": result.cell.interface,
        "free_motions": list(result.cell.free_motions),
        "seconds": result.seconds,
        "notes": [
            f"long cable, {held(result)}; the published values belong to a finite specimen and are not a target",
            "GA is the beam's shear stiffness by energy; G_yoz and G_xoz are volume averages (formula 3)",
        ],
    }


def slice_record(cable: Cable, cell: PeriodicCell, seconds: float, level: str = "section") -> dict[str, Any]:
    """The JSON of `helicable homogenize --method cell`; what the cell was not asked for is null."""
    C: list[list[float | None]] = [[None] * 6 for _ in range(6)]
    (EA, coupling), (_, GJ) = cell.stiffness
    C[2][2], C[2][5], C[5][2], C[5][5] = float(EA), float(coupling), float(coupling), float(GJ)
    free = EA - coupling**2 / GJ
    bending: dict[str, float | None] = dict.fromkeys(("EI_x", "EI_y", "GA_x", "GA_y"))
    notes = ["E refers to the area of the cable; formula (3) for G and bounds come from --method helical"]
    if cell.section is not None:
        C = cell.section.C.tolist()
        bending = {name: getattr(cell.section, name) for name in bending}
    else:
        notes.append("bending and shear were not computed on this cell")
    return {
        **_head(cable, cable.area),
        "section": {
            "order": list(ORDER),
            "C": C,
            "EA_blocked_twist": EA,
            "EA_free_twist": free,
            "GJ": GJ,
            "coupling": coupling,
            **bending,
        },
        "E_blocked_twist": EA / cable.area,
        "E_free_twist": free / cable.area,
        "G_yoz": None,
        "G_xoz": None,
        "bounds": {"EA_lower": None, "EA_upper": None},
        "mesh": {"unknowns": cell.unknowns, "elements": None},
        "method": "cell",
        "level": level,
        "interface": "bonded",
        "iterations": list(cell.iterations),
        "seconds": seconds,
        "notes": notes,
    }


def _head(cable: Cable, area: float) -> dict[str, Any]:
    return {
        "schema": 1,
        "cable": cable.name,
        "outer_diameter": cable.outer_diameter,
        "area": area,
        "mass_per_length": cable.mass_per_length,
    }

"""`helicable specimen`: a finite piece of cable, held at one end and loaded at the other."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from geometry import Cable, CrossSectionMesh, read_cable
from geometry.errors import SpecError
from geometry.specimen_case import SpecimenCase
from geometry.units import read_quantity
from helicable.interface_words import read_interface
from helicable.opening_words import read_opening
from helicable.options import CableArgument, JsonOption, OutOption, SizeOption
from helicable.published_specimen import LOADS, PublishedRow, published_rows, specimen_cable
from helicable.screen import engineering, folder, progress, say, table, write_json
from helicable.specimen_steps import is_opening, run_in_steps
from homogenize import solve_helical_cell
from homogenize.specimen import (
    Held,
    LoadCase,
    Plate,
    Specimen,
    SpecimenSolution,
    read_end,
    solve_specimen,
)
from homogenize.specimen.apparent_modulus import ApparentModulus, apparent_moduli, von_mises_moduli
from homogenize.specimen.gauge_length import gauge_modulus
from homogenize.specimen.length_law import LengthLaw, moduli_over_length
from homogenize.specimen.specimen_mesh import specimen_mesh

LENGTH = 0.1823
"""Of a specimen [m] if neither the options nor the cable file give one."""
FAR = 0.1
"""Largest displacement over the length above which small displacements are doubted."""
SIZES = {
    "tension": ("2000 N", "N"),
    "shear": ("500 N", "N"),
    "bending": ("10 N m", "N m"),
    "torsion": ("10 N m", "N m"),
}
"""Size of each kind of load if none is given, and its unit."""


def specimen(
    cable: CableArgument,
    length: Annotated[
        str | None,
        typer.Option(metavar="LENGTH", help="Of the specimen; the cable file's [specimen], or 182.3 mm, if not given."),
    ] = None,
    load: Annotated[
        str | None,
        typer.Option(
            help="`tension` (if not given), `shear`, `bending`, `torsion`, several with commas; direction as in `shear:-y`."
        ),
    ] = None,
    force: Annotated[
        str | None, typer.Option(metavar="SIZE", help="Of the load: 2000 N, 500 N across, 10 N m if not given.")
    ] = None,
    ends: Annotated[
        str | None,
        typer.Option(
            help="The loaded end: `uniform`, `traction:sheath+interstices`, `plate`, `plate:no-tilt,no-twist`, `grip:conductor`."
        ),
    ] = None,
    held: Annotated[
        str | None, typer.Option(help="The other end: `fixed`, or `grip:conductor` for the named parts.")
    ] = None,
    interface: Annotated[
        str | None,
        typer.Option(
            help="As in `helicable homogenize`, or opening contact, `core-filler=opening:GAP+coulomb:0.3`; bonded if not given."
        ),
    ] = None,
    large_displacement: Annotated[
        bool, typer.Option("--large-displacement", help="Follow the load in steps with large displacements; bonded.")
    ] = False,
    steps: Annotated[int, typer.Option(help="Load steps, with large displacements or opening contact.")] = 4,
    lengths: Annotated[
        str | None,
        typer.Option(metavar="LIST", help='Apparent E over several lengths, such as "60 mm, 120 mm, 400 mm".'),
    ] = None,
    phase: Annotated[
        str | None, typer.Option(help="Angle by which the drawn section stands turned at the held end; 0 if not given.")
    ] = None,
    published: Annotated[bool, typer.Option("--published", help="Run the published load cases and compare.")] = False,
    size: SizeOption = None,
    json: JsonOption = None,
    out: OutOption = None,
) -> None:
    """Load a finite specimen and read its apparent moduli, displacements and shear lag.

    Example: `helicable specimen paper-specimen-3x35 --length 182.3mm --load tension,shear:x --out specimen`
    """
    made, substitute = specimen_cable(cable) if published else (read_cable(cable), "")
    wanted = wanted_specimen(made, length, phase, ends, held, interface)
    if published and (load or force):
        raise SpecError("--published has load cases of its own; leave --load and --force out.")
    loads = LOADS if published else _loads(load or "tension", force)
    several = None if lengths is None else _lengths(lengths)
    edge = None if size is None else read_quantity(size, "m", "--size")
    if large_displacement or is_opening(wanted.interface):
        if several is not None:
            raise SpecError("--lengths is for linear specimens; leave --large-displacement and opening contacts out.")
        wanted = replace(wanted, large_displacement=large_displacement)
        found, record = run_in_steps(made, wanted, loads, edge, steps)
        record |= _beside_published(found, made, substitute) if published else {}
        write_json(json, record)
        if out is not None:
            write_json(folder(out) / "specimen.json", record)
            _draw_curves(folder(out), found, wanted.loaded.describe())
            say(f"written in {out}: specimen.json, stress_strain.png")
        return
    mesh = specimen_mesh(made, edge)
    with progress("finite specimen") as tell:
        solution = solve_specimen(wanted, mesh, loads, progress=tell)
    found = apparent_moduli(solution)
    show_specimen(made, solution, found)
    record = specimen_record(made, solution, found)
    if published:
        record |= _beside_published(found, made, substitute)
    law = None
    if several is not None:
        law, record["lengths"] = _over_lengths(wanted, mesh, several)
    write_json(json, record)
    if out is not None:
        _draw(folder(out), solution, found, law, record)


def _lengths(text: str) -> list[float]:
    found = [read_quantity(part, "m", "--lengths") for part in text.split(",")]
    if len(set(found)) < 2 or min(found) <= 0:
        raise SpecError(
            f'--lengths "{text}" needs at least two different lengths above zero; the law is fitted to them.'
        )
    return found


def _beside_published(found: tuple[ApparentModulus, ...], cable: Cable, substitute: str) -> dict[str, Any]:
    """Print the table beside the published numbers; its part of the record."""
    rows = published_rows(found)
    notes = published_notes(cable, substitute)
    show_published(rows, notes)
    shown = {
        r.quantity: {"published": r.published, "computed": r.computed, "ratio": r.ratio, "unit": r.unit} for r in rows
    }
    return {"published": shown, "published_notes": notes}


def wanted_specimen(
    cable: Cable, length: str | None, phase: str | None, ends: str | None, held: str | None, interface: str | None
) -> Specimen:
    """The specimen of the options; what they leave open is that of the cable file, or a bonded one of 182.3 mm with uniform traction."""
    case = cable.specimen or SpecimenCase(LENGTH)
    return Specimen(
        length=case.length if length is None else read_quantity(length, "m", "--length"),
        loaded=read_end(case.loaded if ends is None else ends),
        held=_held(case.held if held is None else held),
        interface=read_interface(case.interface, "specimen.interface")
        if interface is None
        else read_opening(interface) or read_interface(interface),
        phase=case.phase if phase is None else read_quantity(phase, "rad", "--phase"),
    )


def _held(text: str) -> Held:
    if text.strip() == "fixed":
        return Held()
    end = read_end(text)
    if not (text.strip().startswith("grip") and isinstance(end, Plate)):
        raise SpecError(f'--held "{text}" is not known; choose fixed, or grip:PART+PART such as grip:conductor.')
    return Held(end.parts)


def _loads(text: str, force: str | None) -> tuple[LoadCase, ...]:
    """Load cases in words: kind, and for shear and bending a direction x, +y, -x ... after a colon."""
    found = []
    for entry in text.split(","):
        kind, _, direction = (part.strip() for part in entry.partition(":"))
        if kind not in SIZES:
            raise SpecError(f'--load "{entry.strip()}" is not known; choose {", ".join(SIZES)}.')
        axis, sign = direction.lstrip("+-") or "x", -1.0 if direction.startswith("-") else 1.0
        if direction and (kind in ("tension", "torsion") or axis not in ("x", "y")):
            raise SpecError(
                f'--load "{entry.strip()}": shear and bending take a direction x, y, -x or -y, the others none.'
            )
        default, unit = SIZES[kind]
        found.append(LoadCase(kind, sign * read_quantity(force or default, unit, "--force"), axis))
    if len({load.name for load in found}) < len(found):
        raise SpecError(f'--load "{text}" names a load twice.')
    return tuple(found)


def show_specimen(cable: Cable, solution: SpecimenSolution, found: tuple[ApparentModulus, ...]) -> None:
    """Print the table and what to make of it."""
    s = solution.specimen
    rows = [
        (
            a.load,
            engineering(a.modulus, "Pa" if a.u_max == a.u_max else "N m2"),
            *(f"{1e3 * u:.3f}" if u == u else "" for u in (a.u_max, a.u_mean)),
            f"{a.unevenness:.2f}" if a.u_max == a.u_max else "",
            *(engineering(m, "Pa") if m == m else "" for m in (a.modulus_of_maximum, a.modulus_of_mean)),
        )
        for a in found
    ]
    table(
        f"{cable.name}, {1e3 * s.length:.4g} mm: {s.held.describe()}; {s.loaded.describe()}",
        ("load", "apparent modulus", "u max mm", "u mean mm", "max / mean", "(F/A) L / u max", "(F/A) L / u mean"),
        rows,
        right=(1, 2, 3, 4, 5, 6),
    )
    for note in specimen_notes(solution, found):
        say(f"- {note}")
    say(f"{solution.unknowns} unknowns, {solution.iterations} iterations, {solution.seconds:.1f} s\n")


def specimen_notes(solution: SpecimenSolution, found: tuple[ApparentModulus, ...]) -> list[str]:
    """What limits the numbers."""
    notes = ["linear: a load step of any size gives the same modulus, R2 of the average stress-strain line is 1"]
    far = max((a.u_max / solution.specimen.length for a in found if a.u_max == a.u_max), default=0.0)
    if far > FAR:
        notes.append(
            f"the largest displacement is {100 * far:.3g} % of the length: too far for small displacements; take a smaller force "
            "or --large-displacement"
        )
    uneven = [a for a in found if a.unevenness > 1.2 and a.load == "tension"]
    if uneven:
        notes.append(
            f"{uneven[0].load}: the largest displacement is {uneven[0].unevenness:.2f} times the mean of the loaded end: the soft "
            "material at the end is measured, not the cable"
        )
    if any(load.kind == "tension" for load in solution.loads):
        k = next(i for i, load in enumerate(solution.loads) if load.kind == "tension")
        notes.append(f"strain over the middle fifth of the length: E = {engineering(gauge_modulus(solution, k), 'Pa')}")
    if any(load.kind == "shear" for load in solution.loads):
        notes.append(
            "G is a small difference of large numbers, deflection less tilt; it is not a shear modulus for a beam"
        )
    if solution.system.free_motions:
        notes.append(f"nothing but the held end resists: {', '.join(solution.system.free_motions)}")
    return notes


def published_notes(cable: Cable, substitute: str) -> list[str]:
    """What the comparison with the published numbers is worth."""
    notes = [substitute] if substitute else []
    if cable.specimen is None:
        notes.append("section and length are not those of the published specimen, which are not known")
    notes.append(
        "a linear specimen deflects alike in +X and -X; the published 6.95 and 7.96 mm differ by a part that does not turn with the load"
    )
    return notes


def show_published(rows: list[PublishedRow], notes: list[str]) -> None:
    """Print published, computed and ratio."""
    shown = [
        (r.quantity, f"{r.published * scale:.2f} {unit}", f"{r.computed * scale:.2f} {unit}", f"{r.ratio:.3f}")
        for r in rows
        for scale, unit in [(1e-6, "MPa") if r.unit == "Pa" else (1e3, "mm")]
    ]
    table("Beside the published load cases", ("", "published", "computed", "ratio"), shown, right=(1, 2, 3))
    for note in notes:
        say(f"- {note}")
    say("")


def _over_lengths(wanted: Specimen, mesh: CrossSectionMesh, lengths: list[float]) -> tuple[LengthLaw, dict[str, Any]]:
    with progress("specimens of several lengths") as tell:
        law, gauges = moduli_over_length(wanted, mesh, lengths, progress=tell)
    section = solve_helical_cell(mesh, wanted.interface).stiffness
    cell = {"E_free_twist": section.E_free_twist, "E_blocked_twist": section.E_blocked_twist}
    rows = [
        (f"{1e3 * L:.4g} mm", engineering(E, "Pa"), engineering(float(law.modulus(L)), "Pa"), engineering(g, "Pa"))
        for L, E, g in zip(law.lengths, law.moduli, gauges)
    ]
    table("Apparent E over the length", ("length", "E", "law", "E of the middle fifth"), rows, right=(1, 2, 3))
    say(
        f"L/E = c + L/E_inf: c {1e9 * law.c:.4g} mm/MPa, E_inf {engineering(law.E_infinite, 'Pa')}, "
        f"largest misfit {100 * law.misfit:.2g} %; "
        f"the long cable by its cell: {engineering(section.E_free_twist, 'Pa')} free to twist, "
        f"{engineering(section.E_blocked_twist, 'Pa')} blocked. Half of E_inf at {law.half_length:.3g} m.\n"
    )
    record = {
        "lengths": law.lengths,
        "E": law.moduli,
        "E_gauge": gauges,
        "c": law.c,
        "E_infinite": law.E_infinite,
        "misfit": law.misfit,
        "cell": cell,
    }
    return law, record


def specimen_record(cable: Cable, solution: SpecimenSolution, found: tuple[ApparentModulus, ...]) -> dict[str, Any]:
    """The JSON of `helicable specimen`."""
    s = solution.specimen
    mises = von_mises_moduli(solution)
    return {
        "schema": 1,
        "cable": cable.name,
        "length": s.length,
        "phase": s.phase,
        "held": s.held.describe(),
        "loaded": s.loaded.describe(),
        "interface": s.interface if isinstance(s.interface, str) else s.interface.describe(),
        "loads": {
            a.load: {
                "size": load.size,
                "modulus": a.modulus,
                "mean_stress": a.mean_stress,
                "mean_strain": a.mean_strain,
                "u_max": a.u_max,
                "u_mean": a.u_mean,
                "modulus_of_maximum": a.modulus_of_maximum,
                "modulus_of_mean": a.modulus_of_mean,
                "modulus_of_von_mises": float(m),
                "curve": {"strain": a.curve.strain, "stress": a.curve.stress, "slope": a.curve.slope, "R2": a.curve.R2},
            }
            for a, load, m in zip(found, solution.loads, mises)
        },
        "checks": [{"name": c.name, "holds": c.holds, "found": c.sentence} for c in solution.checks],
        "mesh": {
            "unknowns": solution.unknowns,
            "elements": len(solution.mesh.cells),
            "layers": solution.operator.axial.layers,
        },
        "iterations": solution.iterations,
        "seconds": solution.seconds,
        "notes": specimen_notes(solution, found),
    }


def _draw_curves(where: Path, found: tuple[ApparentModulus, ...], note: str) -> None:
    from homogenize.specimen.stress_strain_plot import draw_stress_strain

    draw_stress_strain(found, where / "stress_strain.png", note)


def _draw(
    where: Path,
    solution: SpecimenSolution,
    found: tuple[ApparentModulus, ...],
    law: LengthLaw | None,
    record: dict[str, Any],
) -> None:
    from homogenize.specimen.length_law_plot import draw_length_law
    from homogenize.specimen.shear_lag import shear_lag
    from homogenize.specimen.shear_lag_plot import draw_shear_lag

    write_json(where / "specimen.json", record)
    _draw_curves(where, found, solution.specimen.loaded.describe())
    written = ["specimen.json", "stress_strain.png"]
    kinds = {region.name: region.kind for region in solution.mesh.regions}
    for k, load in enumerate(solution.loads):
        if load.kind == "tension":
            draw_shear_lag(shear_lag(solution, k), kinds, where / "shear_lag.png", solution.specimen.loaded.describe())
            written.append("shear_lag.png")
    if law is not None:
        draw_length_law(law, record["lengths"]["cell"]["E_free_twist"], where / "length_law.png")
        written.append("length_law.png")
    say(f"written in {where}: {', '.join(written)}")

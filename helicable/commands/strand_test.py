"""`helicable strand-test`: from a tensile test of a strand, slip in the grips and all, to its modulus."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any

import typer

from compare.record_table import read_record
from compare.strand_modulus import StrandModulus, strand_modulus
from compare.strand_tensile_test import TensileRecord, synthetic_record
from compare.text_file import read_bytes
from geometry import read_cable
from geometry.errors import InputError, SpecError
from geometry.units import read_quantity
from helicable.options import JsonOption, OutOption
from helicable.screen import engineering, folder, say, table, write_json

CABLE = "mcpt-1.9-3.3-3x35"
SYNTHETIC = ("power", "control")
_FRAME, _FRAME_ERROR = 50e6, 0.1
_SLIP, _NOISE = (3e-4, 5e-4, 1e-3), 2e-3
_MADE_UP = (
    "the record is synthetic: an elastic strand of the published modulus, 100 mm, 100 mm/min, a sample each 0.032 s; the "
    "slip, the frame of 50 kN/mm and the noise are made up, because the published curve is not available"
)


def strand_test(
    record: Annotated[
        str,
        typer.Argument(
            metavar="RECORD",
            help="CSV with columns such as `extension [mm],force [N]`; or `power`, `control`: a synthetic record of the published test.",
        ),
    ],
    length: Annotated[str, typer.Option(help="Length between the grips.")] = "100 mm",
    area: Annotated[
        str | None,
        typer.Option(help='Area that the modulus refers to, such as "7.143 mm^2": cylinder of the strand, or metal.'),
    ] = None,
    machine_stiffness: Annotated[
        str | None,
        typer.Option(help='Frame, load cell and grips, such as "50 kN/mm"; left out: travel measured on the strand.'),
    ] = None,
    machine_error: Annotated[float, typer.Option(help="Relative doubt of the machine stiffness.")] = _FRAME_ERROR,
    area_error: Annotated[float, typer.Option(help="Relative doubt of the area.")] = 0.01,
    length_error: Annotated[float, typer.Option(help="Relative doubt of the length.")] = 0.005,
    until: Annotated[str | None, typer.Option(help="Largest force that is used: the elastic range ends there.")] = None,
    json: JsonOption = None,
    out: OutOption = None,
) -> None:
    """Modulus of a strand from force and crosshead travel, with the slip of the grips and the frame taken out.

    Example: `helicable strand-test power --out strand`
    """
    span = read_quantity(length, "m", "--length")
    frame = math.inf if machine_stiffness is None else read_quantity(machine_stiffness, "N/m", "--machine-stiffness")
    notes = []
    if record in SYNTHETIC:
        curve, cross_section = published_record(record, span)
        frame = _FRAME
        notes.append(_MADE_UP)
    else:
        if area is None:
            raise SpecError('--area is missing: the area that the modulus refers to, such as "7.143 mm^2".')
        cross_section = 0.0
        curve = read_curve(Path(record), span)
    cross_section = cross_section if area is None else read_quantity(area, "m^2", "--area")
    if until is not None:
        curve = curve.until(read_quantity(until, "N", "--until"))
    found = strand_modulus(
        curve,
        cross_section,
        machine_stiffness=frame,
        machine_error=machine_error,
        area_error=area_error,
        length_error=length_error,
    )
    notes += strand_notes(curve, found, frame)
    show_strand_test(record, found, notes)
    write_json(json, strand_record(record, curve, found, cross_section, notes))
    if out is not None:
        _write(folder(out), record, curve, found, cross_section, notes)


def published_record(name: str, length: float) -> tuple[TensileRecord, float]:
    """Synthetic record of the published test of the power or the control strand, and the area of its cylinder [m^2]."""
    conductor = read_cable(CABLE).conductors[name]
    part = conductor.strand or conductor
    force = part.E * part.area * 5e-3
    curve = synthetic_record(
        part.E, part.area, length=length, slip=_SLIP, machine_stiffness=_FRAME, noise=_NOISE * force, start=2e-5
    )
    return curve, part.area


def read_curve(path: Path, length: float) -> TensileRecord:
    """Extension and force of a CSV file.

    Raises
    ------
    SpecError
        One sentence with file, row and column for whatever is not understood.
    """
    read = read_record(read_bytes(path, path.name), path.name, "tension", None, {"specimen length": length})
    travel = read["extension"] if "extension" in read.channels else length * read["strain"]
    return TensileRecord(travel, read["force"], length)


def strand_notes(curve: TensileRecord, found: StrandModulus, frame: float) -> list[str]:
    """What limits the number."""
    rising = int(curve.force.argmax()) + 1
    yields = max(1, int((curve.travel[:rising] < 1e-3 * curve.length).sum()))
    notes = [
        f"{rising} samples up to the largest force; {yields} of them below 0.1 % of travel, where soft copper ends to be elastic"
    ]
    if not found.unloaded:
        notes.append(
            "the record holds no unloading: a bend of the curve is read as slip, and could be the strand yielding or its wires "
            "drawing straight; unload once, from a force that the strand has not yielded at"
        )
    if math.isinf(frame):
        notes.append(
            "no machine stiffness is given: what the frame stretched counts as the strand's, so that E is too low"
        )
    if found.slip_form != "none":
        notes.append(f"the grips lost {1e3 * found.slip:.3f} mm; form of grip-slip: {found.slip_form}")
    return notes


def show_strand_test(name: str, found: StrandModulus, notes: list[str]) -> None:
    """Print the modulus and what it is made of."""
    doubts = ", ".join(f"{k} {100 * v:.1f} %" for k, v in found.parts.items())
    rows = [
        ("E of the strand", f"{1e-9 * found.E:.2f} ± {1e-9 * found.standard_error:.2f} GPa", f"one sigma: {doubts}"),
        ("straight line", engineering(found.slope_modulus, "Pa"), "force over travel, slip and frame left in"),
        ("frame taken out", engineering(found.machine_modulus, "Pa"), "the same line, slip left in"),
        ("residual", engineering(found.noise, "N"), "root mean square of the force"),
    ]
    table(f"{name}: tensile test of a strand", ("quantity", "value", "what it is"), rows, right=(1,))
    for note in notes:
        say(f"- {note}")


def strand_record(
    name: str, curve: TensileRecord, found: StrandModulus, area: float, notes: list[str]
) -> dict[str, Any]:
    """The JSON of `helicable strand-test`."""
    return {
        "schema": 1,
        "record": name,
        "synthetic": name in SYNTHETIC,
        "length": curve.length,
        "area": area,
        "samples": len(curve.force),
        "E": found.E,
        "standard_error": found.standard_error,
        "relative_doubts": found.parts,
        "slope_modulus": found.slope_modulus,
        "machine_modulus": found.machine_modulus,
        "slip_form": found.slip_form,
        "slip": found.slip,
        "noise": found.noise,
        "unloaded": found.unloaded,
        "notes": notes,
    }


def _write(place: Path, name: str, curve: TensileRecord, found: StrandModulus, area: float, notes: list[str]) -> None:
    from compare.strand_test_plot import draw_strand_test

    stem = Path(name).stem
    write_json(place / "strand-test.json", strand_record(name, curve, found, area, notes))
    made = " (synthetic record)" if name in SYNTHETIC else ""
    picture = draw_strand_test(curve, found, area, place / "strand-test.png", f"Tensile test of a strand: {stem}{made}")
    written = [place / "strand-test.json", picture]
    if name in SYNTHETIC:
        rows = [f"{1e3 * u:.6g},{F:.6g}" for u, F in zip(curve.travel, curve.force, strict=True)]
        written.append(place / f"{stem}.csv")
        try:
            written[-1].write_text("\n".join(["extension [mm],force [N]", *rows]) + "\n", encoding="utf-8")
        except OSError as error:
            raise InputError(
                f"{written[-1]} cannot be written: {error.strerror or error}; choose another place."
            ) from None
    say("written: " + ", ".join(str(path) for path in written))

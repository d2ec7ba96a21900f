"""`helicable calibrate`: the assumed inputs of a finite specimen that bring it to published or measured numbers."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated, Any

import typer

from compare.evaluation_store import EvaluationStore
from compare.input_calibration import InputCalibration
from compare.target_file import read_targets
from geometry.errors import InputError, SpecError
from geometry.units import read_quantity
from helicable.calibration_case import CalibrationCase, is_interface, read_case, written
from helicable.options import CableArgument, JsonOption, SizeOption
from helicable.screen import folder, progress, say, table, write_json
from helicable.specimen_calibration import calibrate_case, calibrated_text
from helicable.specimen_surrogate import SpecimenSurrogate


def calibrate(
    cable: CableArgument,
    targets: Annotated[
        str, typer.Option(help="`published` (six numbers of Ge et al. 2023) or a TOML file of targets and ranges.")
    ] = "published",
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Cable file, report and finished runs go into this folder."),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the finished runs in --out after a kill.")
    ] = False,
    runs: Annotated[int, typer.Option(help="Full runs at most.")] = 8,
    snapshots: Annotated[int, typer.Option(help="First solutions of the cheap model; it learns more by itself.")] = 12,
    starts: Annotated[int, typer.Option(help="Starts of each search.")] = 16,
    size: SizeOption = None,
    coarse: Annotated[
        str | None,
        typer.Option(
            "--coarse", metavar="SIZE", help="Element size of the cheap model; a few hundred elements if not given."
        ),
    ] = None,
    json: JsonOption = None,
) -> None:
    """Find the assumed inputs of a finite specimen that bring it to targets, and what the targets fix of them.

    Example: `helicable calibrate mcpt-1.9-3.3-3x35 --targets published --out calibrated`
    """
    for name, value in (("--runs", runs), ("--snapshots", snapshots), ("--starts", starts)):
        if not 1 <= value <= 1000:
            raise SpecError(f"{name} is {value}; it must lie between 1 and 1000.")
    if resume and out is None:
        raise SpecError("--resume needs --out, the folder of the run that was stopped.")
    element = None if size is None else read_quantity(size, "m", "--size")
    cheap_element = None if coarse is None else read_quantity(coarse, "m", "--coarse")
    case = read_case(cable, read_targets(targets), element, snapshots, cheap_element)
    store = EvaluationStore(None if out is None else folder(out) / "finished-runs.jsonl", resume)
    started = time.process_time()
    with progress("calibrating") as tell:
        found, cheap = calibrate_case(case, store, runs, starts, tell, None if out is None else out / "snapshots")
    show_calibration(found)
    say(
        f"{len(found.runs)} full runs, {len(cheap.basis.places)} solutions in the cheap model, "
        f"{time.process_time() - started:.0f} s of processor time"
    )
    record = calibration_record(case, found, cheap)
    write_json(json, record)
    if out is not None:
        write_json(out / "calibration.json", record)
        name = f"{case.name}-calibrated"
        path = out / f"{name}.toml"
        try:
            path.write_text(calibrated_text(case, found, name), encoding="utf-8")
        except OSError as error:
            raise InputError(f"{path} cannot be written: {error.strerror or error}; choose another place.") from None
        say(f"written: {path}, {out / 'calibration.json'}, {out / 'finished-runs.jsonl'}")


def show_calibration(found: InputCalibration) -> None:
    """Print targets, parameters and directions."""
    rows = [
        (
            t.name,
            written(t.value, t.unit),
            written(found.best.outputs[t.name], t.unit),
            f"{r:.3f}",
            f"{100 * t.error:.0f} %",
            t.load,
        )
        for t, r in zip(found.targets, found.ratios.values(), strict=True)
    ]
    table(
        "Targets, from the full model",
        ("target", "wanted", "computed", "ratio", "error", "load"),
        rows,
        right=(1, 2, 3, 4),
    )
    known = found.identifiability
    cells = []
    for p, error in zip(found.parameters, known.standard_error, strict=True):
        spread = f"{100 * error:.0f} %" if p.logarithmic else written(float(error), p.unit)
        edge = "at the end of its range" if p.name in known.at_bound else ""
        value = written(found.best.inputs[p.name], p.unit)
        cells.append((p.name, value, spread, f"{written(p.low, p.unit)} .. {written(p.high, p.unit)}", edge))
    table("Inputs", ("input", "value", "one sigma", "range", ""), cells, right=(1, 2))
    say("What the targets fix, the stiffest first:")
    for direction in known.directions:
        say(f"- {direction.words}")
    costs = found.profile.cost
    say(
        f"Along the sloppiest direction, across its range, the misfit is {costs.min():.3g} to {costs.max():.3g} "
        f"({len(costs)} places); 0.5 is one sigma."
    )
    for sentence in calibration_notes(found):
        say(f"- {sentence}")


def calibration_notes(found: InputCalibration) -> list[str]:
    """What limits the result."""
    held = "elastic interfaces" if any(is_interface(p) for p in found.parameters) else "bonded"
    notes = [
        f"linear, {held}, uniform traction on the whole end: +X and -X are alike, and large displacements are not followed"
    ]
    if not found.agreed:
        notes.append(
            f"the cheap model still differs from the last full run by {100 * found.runs[-1].disagreement:.1f} %; more --runs would go on"
        )
    if found.identifiability.at_bound:
        notes.append(
            f"at the end of the range: {', '.join(found.identifiability.at_bound)}; the targets would take them further"
        )
    far = [f"{name} {100 * (r - 1):+.0f} %" for name, r in found.ratios.items() if abs(r - 1) > 0.05]
    if far:
        notes.append(f"not reached within 5 %: {', '.join(far)}")
    return notes


def calibration_record(case: CalibrationCase, found: InputCalibration, cheap: SpecimenSurrogate) -> dict[str, Any]:
    """The JSON of `helicable calibrate`."""
    known = found.identifiability
    return {
        "schema": 1,
        "cable": case.name,
        "title": case.file.title,
        "targets": [
            {
                "name": t.name,
                "unit": t.unit,
                "wanted": t.value,
                "computed": found.best.outputs[t.name],
                "error": t.error,
                "load": t.load,
            }
            for t in found.targets
        ],
        "ratios": found.ratios,
        "inputs": [
            {
                "name": p.name,
                "moves": p.moves,
                "value": found.best.inputs[p.name],
                "unit": p.unit,
                "range": (p.low, p.high),
                "standard_error": error,
                "of_logarithm": p.logarithmic,
                "at_bound": p.name in known.at_bound,
            }
            for p, error in zip(found.parameters, known.standard_error, strict=True)
        ],
        "correlation": known.correlation,
        "directions": [
            {"eigenvalue": d.eigenvalue, "vector": d.vector, "open": d.is_open, "words": d.words}
            for d in known.directions
        ],
        "profile": {"step": found.profile.step, "cost": found.profile.cost, "inputs": found.profile.x},
        "full_runs": [
            {"inputs": r.inputs, "outputs": r.outputs, "cost": r.cost, "disagreement": r.disagreement}
            for r in found.runs
        ],
        "minima": [{"x": m.x, "cost": m.cost, "starts": m.starts} for m in found.minima[:10]],
        "snapshots": len(cheap.basis.places),
        "agreed": found.agreed,
        "notes": calibration_notes(found),
    }

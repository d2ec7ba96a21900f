"""`helicable sweep`: a grid of towing runs in parallel."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Any

import typer

from beam import Scenario, read_scenario
from beam.parameter_sweep import sweep as run_sweep
from beam.sweep_axis import CONSTANTS, Axis, read_axes, sweepable
from beam.sweep_record import SweepFolder, read_manifest
from geometry.errors import ConvergenceError, InputError, SpecError
from helicable.beam_constants import beam_constants
from helicable.commands.tow import REFERENCE_CABLE
from helicable.options import JsonOption
from helicable.screen import plain, progress, say, table, write_json
from homogenize import SectionStiffness


def sweep(
    scenario: Annotated[str, typer.Argument(metavar="SCENARIO", help="A built-in scenario or a TOML file.")],
    over: Annotated[
        list[str] | None,
        typer.Option("--over", metavar="NAME=VALUES", help='Such as inclination="0,10,20 deg"; once for every axis.'),
    ] = None,
    workers: Annotated[
        int | None, typer.Option(metavar="N", help="Processes; the number of cores without it, 1: no other process.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Scheduler of a cluster, such as tcp://node1:8786.")
    ] = None,
    cable: Annotated[str, typer.Option(metavar="CABLE", help="Cable that `cell` homogenizes.")] = REFERENCE_CABLE,
    full: Annotated[bool, typer.Option("--full", help="Keep every run as NetCDF, too (runs/ID.nc).")] = False,
    json: JsonOption = None,
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="Folder of the sweep; the same command goes on with it.")
    ] = Path("sweep"),
) -> None:
    """Run a scenario for every combination of values, in parallel; a sweep that was stopped goes on.

    Example: `helicable sweep intelligent-horizontal --over inclination="0,10,20 deg" --over friction="0.2,0.3" --workers 2 --out sweep`
    """
    base = read_scenario(scenario)
    if not over:
        raise SpecError(
            f'a sweep needs --over NAME=VALUES, such as --over friction="0.2,0.3". What can be swept: {", ".join(sweepable(base))}.'
        )
    axes = read_axes(over, base)
    sections, notes = _sections(base, axes, cable, out)
    with progress("sweep") as tell:
        processes = (os.cpu_count() or 1) if workers is None else workers
        folder = run_sweep(
            base, axes, out, sections, workers=processes, scheduler=scheduler, full=full, notes=notes, progress=tell
        )
    written = _tables(folder)
    write_json(json, sweep_json(folder, written))
    completed, failed, missing = folder.counts()
    show_sweep(folder)
    say(f"{completed} completed, {failed} failed, {missing} not run; written: " + ", ".join(map(str, written)))
    if failed or missing:
        raise ConvergenceError(
            f"{failed} of {len(folder.places)} runs failed and {missing} were lost with their worker; sweep.csv says why. "
            f"The same command runs the lost ones again."
        )


def _sections(
    base: Scenario, axes: list[Axis], cable: str, out: Path
) -> tuple[dict[str, SectionStiffness], dict[str, str]]:
    """Section and origin of every name of constants; what a sweep in the folder has homogenized is taken from there."""
    names = next((axis.texts for axis in axes if axis.key == CONSTANTS), (base.constants,))
    kept = read_manifest(out) or {"sections": {}, "notes": {}}
    sections, notes = {}, {}
    for name in names:
        if name == "published":
            continue
        notes[name] = f"cable {cable}" if name == "cell" else f"file {name}"
        there = kept["sections"].get(name)
        if name == "cell" and there is not None and kept["notes"].get(name) == notes[name]:
            sections[name] = SectionStiffness(there["C"], there["area"])
        else:
            sections[name] = beam_constants(base.changed(constants=name), cable).section
    return sections, notes


def _tables(folder: SweepFolder) -> list[Path]:
    """Tables and picture."""
    from beam.sweep_plot import sweep_figure

    written = folder.write_tables()
    written.append(folder.path / "sweep.png")
    try:
        sweep_figure(folder).savefig(written[-1], dpi=150)
    except OSError as error:
        raise InputError(f"{written[-1]}: the picture cannot be written: {error}.") from None
    return written


def show_sweep(folder: SweepFolder, most: int = 40) -> None:
    """Print the first rows over the axes with more than one value, and why runs failed."""
    kept = [k for k, axis in enumerate(folder.axes) if len(axis.texts) > 1]
    heads = (*(folder.axes[k].label for k in kept), "pull, steady [N]", "largest [N]", "bend radius [m]", "status")
    names = (("pull_force_plateau", ".1f"), ("pull_force_max", ".1f"), ("bend_radius_min", ".4f"))
    rows, found = [], folder.rows()
    for (place, _), row in zip(folder.places[:most], found[:most], strict=True):
        values = [_shown(folder.axes[k], place[k]) for k in kept]
        results = {} if row is None else row["results"]
        numbers = [format(results[name], form) if name in results else "-" for name, form in names]
        rows.append((*values, *numbers, "not run" if row is None else row["status"].partition(":")[0]))
    table(folder.title, heads, rows, right=tuple(range(len(kept) + 3)))
    if len(found) > most:
        say(f"the first {most} of {len(found)} runs; all are in sweep.csv")
    for sentence in sorted({row["status"] for row in found if row is not None} - {"completed"})[:5]:
        say(plain(sentence))


def _shown(axis: Axis, i: int) -> str:
    return f"{axis.numbers[i]:g}" if axis.unit else axis.texts[i]


def sweep_json(folder: SweepFolder, written: list[Path]) -> dict[str, Any]:
    """The JSON of `helicable sweep`."""
    completed, failed, missing = folder.counts()
    return {
        "schema": 1,
        "axes": {
            a.name: {"key": a.key, "unit": a.unit, "values": a.numbers if a.unit else a.texts} for a in folder.axes
        },
        "completed": completed,
        "failed": failed,
        "missing": missing,
        "runs": [row for row in folder.rows() if row is not None],
        "files": [str(path) for path in written],
        "notes": ["results in SI; values of an axis in its unit"],
    }

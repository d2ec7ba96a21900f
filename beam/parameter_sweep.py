"""A full grid of towing runs: every combination of the values of all axes, run in parallel, each kept as soon as it is there.

A run that fails is a row with its sentence; the others go on. What is in the folder is not computed again, so that a sweep
that was killed goes on where it was.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from beam.scenario import Scenario, published_section
from beam.sweep_axis import CONSTANTS, Axis
from beam.sweep_record import SweepFolder, choices
from beam.worker_pool import finished
from geometry.errors import ConvergenceError, InputError, SpecError
from homogenize.section_stiffness import SectionStiffness

Progress = Callable[[float, str], None]
Sections = Mapping[str, SectionStiffness]

logger = logging.getLogger(__name__)

LARGEST_GRID = 100_000


@dataclass(frozen=True)
class Point:
    """One run of the grid: its place, the values that are changed (by key), its section (None: published), its name."""

    place: tuple[int, ...]
    changes: dict[str, str]
    section: SectionStiffness | None
    id: str

    def __str__(self) -> str:
        return ", ".join(f"{key.rpartition('.')[2]} {text}" for key, text in self.changes.items())


def grid(scenario: Scenario, axes: list[Axis], sections: Sections) -> list[Point]:
    """All runs, the last axis fastest; `sections` holds the section of every constants' name except ``published``.

    Raises
    ------
    SpecError
        If the grid is empty or larger than can be meant.
    """
    count = int(np.prod([len(axis.texts) for axis in axes], dtype=object))
    if not axes or count > LARGEST_GRID:
        raise SpecError(
            f"a sweep needs one axis and at most {LARGEST_GRID} runs; this one has {len(axes)} and {count}."
        )
    points = []
    for place in itertools.product(*(range(len(axis.texts)) for axis in axes)):
        changes = {axis.key: axis.texts[i] for axis, i in zip(axes, place, strict=True)}
        section = sections.get(changes.get(CONSTANTS, scenario.constants))
        points.append(Point(place, changes, section, _digest(scenario, changes, section)))
    return points


def _digest(scenario: Scenario, changes: dict[str, str], section: SectionStiffness | None) -> str:
    """Name of a run by everything that it depends on."""
    kept = {k: e.value for k, e in scenario.entries().items() if not k.startswith("published_results.")}
    stiffness = None if section is None else [*np.ravel(section.C).tolist(), section.area]
    whole = {"entries": kept, "changes": changes, "choices": choices(scenario), "section": stiffness}
    return hashlib.sha256(json.dumps(whole, sort_keys=True).encode()).hexdigest()[:16]


def run_point(scenario: Scenario, point: Point, file: Path | None) -> dict[str, Any]:
    """One row: results, and a status that is a sentence if there are none. Never raises but for programming errors of the caller."""
    from beam.towing import tow

    row: dict[str, Any] = {"schema": 1, "id": point.id, "changes": point.changes, "status": "completed", "results": {}}
    try:
        changed = scenario.changed(**{key.replace(".", "__"): text for key, text in point.changes.items()})
        run = tow(changed, point.section or published_section(changed), file=file)
        row["results"] = _results(run.record())
        row["status"] = "completed" if run.outcome.completed else run.status
    except (InputError, ConvergenceError) as error:
        row["status"] = f"failed: {error}"
    except Exception as error:  # one run must not end the others
        logger.exception("run %s", point.id)
        row["status"] = f"failed unexpectedly: {type(error).__name__}: {error}"
    return row


def _results(record: dict[str, Any]) -> dict[str, float]:
    energies = record["energies"]
    plain = (
        "pull_force_max", "pull_force_plateau", "peak_tension", "bend_radius_min", "normal_stress_max", "deepest_penetration",
        "energy_balance_error", "seconds_simulated", "seconds_wall",
    )  # fmt: skip
    changed = ("drive_work", "friction_loss", "damping_loss", "elastic", "kinetic", "gravity")
    return {name: float(record[name]) for name in plain} | {name: float(energies[name]) for name in changed}


def sweep(
    scenario: Scenario,
    axes: list[Axis],
    out: str | Path,
    sections: Sections | None = None,
    *,
    workers: int = 1,
    scheduler: str | None = None,
    full: bool = False,
    notes: Mapping[str, str] | None = None,
    progress: Progress | None = None,
) -> SweepFolder:
    """Run what is missing of the grid.

    Parameters
    ----------
    scenario : Scenario
        The base that all runs share.
    axes : list of Axis
        See :func:`beam.sweep_axis.read_axes`.
    out : path
        Folder of the rows; a folder of the same sweep is gone on with.
    sections : mapping of str to SectionStiffness, optional
        Section of every name of constants except ``published``.
    workers : int
        Processes of this computer; with one the runs are made in this process.
    scheduler : str, optional
        Address of a running scheduler, such as ``"tcp://node1:8786"``; its workers are used instead.
    full : bool
        Also keep every run as a NetCDF file, written by the worker; a cluster must then see `out` under the same path.
    notes : mapping of str to str, optional
        Where the sections come from, kept in the folder.
    progress : callable (fraction, sentence), optional

    Returns
    -------
    SweepFolder
        Rows, table and dataset.

    Raises
    ------
    InputError
        If the grid, the folder or the scheduler cannot be used.
    """
    sections = sections or {}
    tell = progress or (lambda fraction, sentence: None)
    points = grid(scenario, axes, sections)
    folder = SweepFolder.open(out, scenario, axes, sections, notes or {}, [(p.place, p.id) for p in points])
    missing = [p for p in points if not folder.has(p.id)]
    done, total = len(points) - len(missing), len(points)
    tell(done / total, f"{total} runs, {done} of them there already")
    tasks = [(scenario, p, folder.run_file(p.id) if full else None) for p in missing]
    for k, row in finished(run_point, tasks, workers=workers, scheduler=scheduler):
        done += 1
        if isinstance(row, Exception):
            logger.warning("the run with %s was lost with its worker: %s", missing[k], row)
            tell(done / total, f"lost with its worker: {missing[k]}")
            continue
        folder.keep(row)
        force = row["results"].get("pull_force_plateau")
        said = row["status"] if force is None else f"{force:.0f} N"
        tell(done / total, f"{done} of {total}: {missing[k]}: {said}")
    return folder

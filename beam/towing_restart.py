"""Going on with a towing run that was ended from outside: its file, its checkpoint, and whether both belong to the scenario.

The file holds every instant up to the end, the checkpoint (:mod:`beam.checkpoint`) one of them completely. Instants after the
checkpoint are computed again, to the same bits.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from beam.checkpoint import read_checkpoint
from beam.generalized_alpha import Integrator, StepSettings
from beam.record_file import RecordFile
from beam.rod_model import RodModel
from beam.scenario import Scenario
from beam.towing_frame import empty_dataset
from beam.towing_run import Frames
from geometry.errors import InputError


def checkpoint_path(file: Path) -> Path:
    """Where the checkpoint of the run in `file` stands."""
    return file.with_name(file.stem + ".checkpoint")


def resumed_run(
    scenario: Scenario, model: RodModel, settings: StepSettings, file: Path | None, attributes: dict[str, Any]
) -> tuple[Integrator, Frames, tuple[float, float]]:
    """The run at its last checkpoint, its instants so far, and the residual of its static start.

    Raises
    ------
    InputError
        If there is no such run, it is complete, or it is a run of something else.
    """
    if file is None:
        raise InputError("to go on with a run, say in which file it was being written.")
    found = _attributes(file)
    if str(found["status"]).startswith("completed"):
        raise InputError(f"{file}: this run is complete; there is nothing to go on with.")
    _require_same(file, found, attributes)
    residual = float(found["static_residual_N"]), float(found["static_residual_N_m"])
    attributes |= {"static_residual_N": residual[0], "static_residual_N_m": residual[1]}
    if not checkpoint_path(file).is_file():
        raise InputError(f"{file}: this run was ended before its first checkpoint; start it again, without resuming.")
    motion = Integrator(model, model.q0, settings=settings)
    read_checkpoint(motion, checkpoint_path(file))
    instants = round(motion.t / scenario.time.frame.value) + 1
    empty = empty_dataset(model, attributes)
    return motion, Frames(scenario, model, RecordFile.reopen(file, empty, instants)), residual


def _attributes(file: Path) -> dict[str, Any]:
    import xarray as xr

    if not file.is_file():
        raise InputError(f"there is no run in {file} to go on with; start it without resuming.")
    try:
        with xr.open_dataset(file, engine="scipy") as data:
            found = dict(data.attrs)
        needed = ("status", "entries", "section_stiffness", "static_residual_N", "static_residual_N_m")
        return found | {name: found[name] for name in needed}
    except (OSError, TypeError, ValueError, KeyError):
        raise InputError(
            f"{file} is not the file of a run that was being written; start it without resuming."
        ) from None


def _require_same(file: Path, found: dict[str, Any], wanted: dict[str, Any]) -> None:
    there, here = (dict(pair.split(" = ", 1) for pair in x["entries"].split("; ")) for x in (found, wanted))
    other = [key for key in here if here[key] != there.get(key)]
    if other:
        key = other[0]
        raise InputError(
            f"{file} is a run with {key} = {there.get(key, 'missing')}, not {here[key]}: "
            f"resume it with its own scenario, or write to another place."
        )
    for what in ("element", "towing", "chain"):
        if found.get(what) != wanted.get(what):
            raise InputError(
                f"{file} is a run with the {what} {found.get(what)}, not {wanted.get(what)}: resume it with its own."
            )
    if not np.array_equal(np.ravel(found["section_stiffness"]), np.ravel(wanted["section_stiffness"])):
        raise InputError(f"{file} is a run with another section stiffness: resume it with its own constants.")

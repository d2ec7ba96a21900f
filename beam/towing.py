"""The towing run: a cable fixed at the supply, one bend round a roller that travels at half speed, pulled by the shearer.

The mechanical problem is built in :mod:`beam.towing_model`, one instant of the run is taken in :mod:`beam.towing_frame`.
Nodes are counted from the shearer, as published; arc length s from the supply.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from beam.checkpoint import write_checkpoint
from beam.generalized_alpha import Integrator, StepSettings
from beam.record_file import RecordFile
from beam.rod_model import RodModel
from beam.scenario import Scenario, published_section
from beam.section_law import SectionLaw
from beam.statics import equilibrium
from beam.status import Outcome
from beam.towing_frame import empty_dataset
from beam.towing_model import mass_per_length, towing_model
from beam.towing_restart import checkpoint_path, resumed_run
from beam.towing_run import Frames, TowingRun, run_attributes
from geometry.errors import ConvergenceError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

Progress = Callable[[float, str], None]

logger = logging.getLogger(__name__)


def tow(
    scenario: Scenario,
    section: SectionStiffness | None = None,
    inertia: SectionInertia | None = None,
    *,
    progress: Progress | None = None,
    settings: StepSettings | None = None,
    law: SectionLaw | None = None,
    file: str | Path | None = None,
    resume: bool = False,
    checkpoint_every: float = 10.0,
) -> TowingRun:
    """Static start, then the towing run.

    Parameters
    ----------
    scenario : Scenario
        See :func:`beam.read_scenario`.
    section : SectionStiffness, optional
        Which constants the rod has; the published moduli on the cable's diameter if not given. For a section that turns
        with the lay, pass its pitch average.
    inertia : SectionInertia, optional
        Of the cable without clamps; the scenario's mass on its diameter if not given.
    progress : callable (fraction, sentence), optional
    settings : StepSettings, optional
        Replaces the scenario's largest step and the default solver settings, see also :func:`accurate_settings`.
        Its largest step is shortened so that it divides the output interval.
    law : SectionLaw, optional
        Section forces with internal state on top of the linear section, such as `effects.rod_law.RodLaw`. The cable is
        taken to have been bent from straight into the starting shape, and to have rested there.
    file : path, optional
        NetCDF file that grows with every instant of the run, see :mod:`beam.record_file`; then no instant is kept in memory.
        A checkpoint is kept beside it until the run is complete.
    resume : bool, optional
        Go on, bit by bit as if it had never stopped, with the run that was being written to `file`.
    checkpoint_every : float, optional
        Seconds of computing between checkpoints.

    Returns
    -------
    TowingRun
        Also when the run had to stop: what was computed is kept, ``run.outcome`` says in a sentence what happened.

    Raises
    ------
    ConvergenceError
        If no static equilibrium is found to start from.
    InputError
        If the file cannot be written, or there is nothing in it to go on with.
    """
    begin = time.perf_counter()
    section = section or published_section(scenario)
    inertia = inertia or scenario.cable_inertia
    tell = progress or (lambda fraction, sentence: None)
    model = towing_model(scenario, section, inertia, law)
    settings, per_frame, frames = _steps(scenario, settings)
    path = None if file is None else Path(file)
    attributes = run_attributes(scenario, section, mass_per_length(scenario, inertia))
    if resume:
        motion, record, residual = resumed_run(scenario, model, settings, path, attributes)
    else:
        tell(0.0, "looking for the equilibrium to start from")
        motion, record, residual = _started_run(scenario, model, settings, path, attributes)
    due = time.perf_counter() + checkpoint_every
    for k in range(len(record.times), frames + 1):
        if not motion.advance(per_frame):
            break
        record.take(motion)
        if path is not None and time.perf_counter() >= due:
            write_checkpoint(motion, checkpoint_path(path))
            due = time.perf_counter() + checkpoint_every
        tell(k / frames, f"{motion.t:.2f} s of {scenario.time.duration.value:g} s")
    outcome: Outcome = motion.outcome
    if not outcome.completed:
        outcome = replace(outcome, detail=f"{outcome.detail} {_play_hint(scenario)}".strip())
        logger.warning("%s", outcome)
    elif path is not None:
        checkpoint_path(path).unlink(missing_ok=True)
    run = TowingRun(
        scenario=scenario,
        section=section,
        mass_per_length=mass_per_length(scenario, inertia),
        frames=record,
        outcome=outcome,
        counters=motion.counters,
        balance_error=motion.ledger.balance_error,
        static_residual=residual,
        deepest_penetration=motion.deepest,
        seconds_wall=time.perf_counter() - begin,
    )
    run.close()
    return run


def accurate_settings(scenario: Scenario) -> StepSettings:
    """Half the scenario's largest step, and an iteration that goes on nearly to round-off: energies close to 1e-6 of the work.

    Takes about twice the computing time.
    """
    half = 0.5 * scenario.time.largest_step.value
    return StepSettings(half, relative=1e-8, absolute=1e-4, iterations=30)


def _started_run(
    scenario: Scenario, model: RodModel, settings: StepSettings, path: Path | None, attributes: dict[str, Any]
) -> tuple[Integrator, Frames, tuple[float, float]]:
    """Static start, first instant, residual of the equilibrium."""
    start = equilibrium(model)
    if not start.outcome.completed:
        raise ConvergenceError(f"no equilibrium to start from: {start.outcome} {_play_hint(scenario)}".strip())
    residual = (start.residual_force, start.residual_moment)
    logger.info("static residual %.1e N, %.1e N m", *residual)
    motion = Integrator(model, start.q, anchors=start.anchors, settings=settings, memory=start.memory)
    attributes |= {"static_residual_N": residual[0], "static_residual_N_m": residual[1]}
    record = Frames(scenario, model)
    if path is not None:
        checkpoint_path(path).unlink(missing_ok=True)
        record.file = RecordFile.create(path, empty_dataset(model, attributes))
    record.take(motion)
    if path is not None:
        write_checkpoint(motion, checkpoint_path(path))
    return motion, record, residual


def _play_hint(scenario: Scenario) -> str:
    """What play in the pins does to a run that cannot start or go on; empty without it."""
    if not scenario.has_clamps or scenario.clamps is None or scenario.clamps.pin_play.value == 0:
        return ""
    play = 1e3 * scenario.clamps.pin_play.value
    return f"Pins with {play:g} mm of play make the chain a mechanism: try clamps.pin_play = 0 mm, or less of it."


def _steps(scenario: Scenario, settings: StepSettings | None) -> tuple[StepSettings, int, int]:
    """Settings whose largest step divides the output interval, steps an interval, number of intervals."""
    frame = scenario.time.frame.value
    base = settings or StepSettings(largest_step=scenario.time.largest_step.value)
    per_frame = int(np.ceil(frame / base.largest_step - 1e-9))
    exact = replace(base, largest_step=frame / per_frame)
    return exact, per_frame, max(1, round(scenario.time.duration.value / frame))

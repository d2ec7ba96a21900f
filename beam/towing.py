"""The towing run: a cable fixed at the supply, one bend round a roller that travels at half speed, pulled by the shearer.

Global axes: x along the trough in the shearer's direction of travel, y normal to the trough, z across it. The cable starts
at the supply at the origin, runs as lower strand towards -x, bends upwards round the trolley's roller and comes back as
upper strand towards +x, on a deck that begins at the roller. An inclination tilts gravity: positive when the shearer
goes uphill. The centre line is what touches the surfaces, so that y = 0 is half a diameter above the trough.
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
from numpy.typing import NDArray

from beam.ancf_cable import AncfCable
from beam.checkpoint import write_checkpoint
from beam.generalized_alpha import Integrator, StepSettings
from beam.incline_formula import STANDARD_GRAVITY
from beam.motion import SpeedRamp
from beam.record_file import RecordFile
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.scenario import Scenario, published_section
from beam.section_law import DampingTimes, SectionLaw
from beam.shape import strands_and_arcs
from beam.statics import equilibrium
from beam.status import Outcome
from beam.surface import ContactLaw, Cylinder, FreeTurn, Plane, Spin
from beam.towing_frame import empty_dataset
from beam.towing_restart import checkpoint_path, resumed_run
from beam.towing_run import Frames, TowingRun, run_attributes
from homogenize.section_stiffness import SectionInertia, SectionStiffness

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]

logger = logging.getLogger(__name__)

ELEMENTS: dict[str, type[Rod]] = {kind.name: kind for kind in (Rod, AncfCable)}


def towing_model(
    scenario: Scenario, section: SectionStiffness, inertia: SectionInertia, law: SectionLaw | None = None
) -> RodModel:
    """The mechanical problem of a scenario; `inertia` is the cable's, the clamps' mass is added here."""
    cable, contact, layout = scenario.cable, scenario.contact, scenario.layout
    with_clamps = SectionInertia(
        inertia.mass_per_length + cable.clamp_mass_per_length.value, inertia.J_x, inertia.J_y, inertia.J_z
    )
    damping = DampingTimes(cable.damping_time_axial.value, cable.damping_time_bending.value)
    rod = ELEMENTS[scenario.element].straight(cable.length.value, scenario.elements, section, with_clamps, damping)
    R, lower = layout.bend_radius.value, scenario.lower_strand
    pieces = [(lower, 0.0), (scenario.bend_length, -1.0 / R), (layout.upper_strand.value, 0.0)]
    trough = ContactLaw(contact.stiffness.value, contact.friction.value, contact.damping_time.value)
    grip = 0.0 if scenario.roller.friction is None else scenario.roller.friction.value
    roller = ContactLaw(contact.roller_stiffness.value, grip, contact.damping_time.value)
    deck_begin = (scenario.roller_start, R, -np.inf)
    slope = layout.inclination.value
    return RodModel(
        rod,
        strands_and_arcs(rod.s, pieces, angle=np.pi),
        supports=[Support(0), Support(-1, travel=scenario.pull)],
        gravity=(-STANDARD_GRAVITY * np.sin(slope), -STANDARD_GRAVITY * np.cos(slope), 0.0),
        surfaces=[
            Plane("trough", trough),
            Plane("deck", trough, offset=2 * R, low=deck_begin, box_travel=scenario.trolley),
            Cylinder(
                "roller", roller, (scenario.roller_start, R, 0.0), R, scenario.trolley, turn=_roller_turn(scenario)
            ),
        ],
        law=law,
    )


def _roller_turn(scenario: Scenario) -> Spin | FreeTurn | None:
    roller, R, pull = scenario.roller, scenario.layout.bend_radius.value, scenario.pull
    if roller.inertia is not None:
        moment = roller.bearing_moment
        return FreeTurn(roller.inertia.value, 0.0 if moment is None else moment.value)
    if roller.surface_speed is None:
        return None
    ramp = SpeedRamp(-roller.surface_speed.value / R, pull.start, pull.end)

    def turn(t: float) -> tuple[float, float, float]:
        angle, speed, acceleration = (float(x[0]) for x in ramp(t))
        return angle, speed, acceleration

    return turn


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
    attributes = run_attributes(scenario, section, model.rod.mass_per_length)
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
        logger.warning("%s", outcome)
    elif path is not None:
        checkpoint_path(path).unlink(missing_ok=True)
    run = TowingRun(
        scenario=scenario,
        section=section,
        mass_per_length=model.rod.mass_per_length,
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
    start.outcome.require_success()
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


def _steps(scenario: Scenario, settings: StepSettings | None) -> tuple[StepSettings, int, int]:
    """Settings whose largest step divides the output interval, steps an interval, number of intervals."""
    frame = scenario.time.frame.value
    base = settings or StepSettings(largest_step=scenario.time.largest_step.value)
    per_frame = int(np.ceil(frame / base.largest_step - 1e-9))
    exact = replace(base, largest_step=frame / per_frame)
    return exact, per_frame, max(1, round(scenario.time.duration.value / frame))

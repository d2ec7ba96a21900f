"""Motions and tensioner of a towing scenario, from its table `drive`.

The shearer follows `drive.curve`, or a ramp to `drive.speed`; the teeth of its travelling wheel let it run ahead and behind
(:mod:`beam.transmission_error`). The trolley follows the shearer as a movable pulley (:mod:`beam.movable_pulley`), on a round-link
chain whose wheel adds its polygon effect (:mod:`beam.polygon_effect`). Without the optional keys both are plain ramps.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from beam.bushing import Bushing
from beam.hydraulic_tensioner import HydraulicTensioner
from beam.motion import SpeedRamp
from beam.movable_pulley import MovablePulley
from beam.polygon_effect import PolygonEffect
from beam.scenario_curve import CurveEntry
from beam.surface import Travel
from beam.transmission_error import TransmissionError

if TYPE_CHECKING:
    from beam.scenario import Scenario


def shearer_motion(scenario: Scenario) -> Travel:
    """Motion of the shearer with what its travelling wheel adds."""
    drive = scenario.drive
    motion: Travel = SpeedRamp(drive.speed.value, drive.ramp_start.value, drive.ramp_end.value)
    if isinstance(drive.curve, CurveEntry) and drive.curve.motion is not None:
        motion = drive.curve.motion
    if drive.tooth_error is not None and drive.tooth_pitch is not None:
        motion = TransmissionError(motion, drive.tooth_error.value, drive.tooth_pitch.value)
    return motion


def trolley_motion(scenario: Scenario) -> Travel:
    """Motion of the trolley with the error of its ratio and what the chain adds."""
    drive = scenario.drive
    error = 0.0 if drive.trolley_error is None else drive.trolley_error.value
    if drive.curve is None and drive.tooth_error is None:
        ratio = drive.trolley_ratio.value * (1 + error)
        motion: Travel = SpeedRamp(drive.speed.value, drive.ramp_start.value, drive.ramp_end.value, ratio=ratio)
    else:
        motion = MovablePulley(shearer_motion(scenario), drive.trolley_ratio.value, error)
    if drive.chain_pockets is not None and drive.chain_radius is not None:
        motion = PolygonEffect(motion, int(drive.chain_pockets.value), drive.chain_radius.value)
    return motion


def supply_tensioner(scenario: Scenario) -> list[Bushing]:
    """Bushings of the tensioner that pulls the supply end towards the supply; none without `drive.tensioner_force`."""
    drive = scenario.drive
    if drive.tensioner_force is None:
        return []
    stroke = 0.5 if drive.tensioner_stroke is None else drive.tensioner_stroke.value
    damping = 0.0 if drive.tensioner_damping is None else drive.tensioner_damping.value
    half = 0.5 * stroke
    return HydraulicTensioner(0, drive.tensioner_force.value, (half, half), damping).bushings()


def drive_fault(scenario: Scenario) -> str:
    """What the table `drive` cannot be, as a sentence; empty if there is nothing."""
    drive = scenario.drive
    pairs = (("tooth_error", "tooth_pitch"), ("chain_pockets", "chain_radius"))
    for one, other in pairs:
        if (getattr(drive, one) is None) != (getattr(drive, other) is None):
            return f"drive.{one} and drive.{other} belong together: give both or neither."
    if drive.chain_pockets is not None and drive.chain_pockets.value != int(drive.chain_pockets.value):
        return f"drive.chain_pockets is {drive.chain_pockets.value:g}; it must be a whole number."
    if drive.tensioner_force is None and (drive.tensioner_stroke or drive.tensioner_damping):
        return "a tensioner with stroke or damping pulls with nothing: add drive.tensioner_force."
    if scenario.machine is not None and (
        drive.curve or drive.tooth_error or drive.chain_pockets or drive.tensioner_force
    ):
        return "the bending machine has strokes and a tension of its own: curve, teeth, chain and tensioner belong to towing."
    if drive.tensioner_force is not None and scenario.element != "rod":
        return 'a tensioner is a bushing, which needs a cable that can turn: take element = "rod".'
    return ""

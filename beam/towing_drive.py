"""Motions and tensioner of a towing scenario, from its table `drive`.

The shearer follows `drive.curve`, or a ramp to `drive.speed`; the teeth of its travelling wheel let it run ahead and behind
(:mod:`beam.transmission_error`), and a play lets the towed end wait at reversals (:mod:`beam.drive_play`). The trolley follows the
shearer as a movable pulley (:mod:`beam.movable_pulley`), on a round-link chain whose wheel adds its polygon effect
(:mod:`beam.polygon_effect`), or a ripple that was measured (:mod:`beam.speed_ripple`). Without the optional keys both are plain ramps.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from beam.bushing import Bushing
from beam.drive_play import DrivePlay
from beam.hydraulic_tensioner import HydraulicTensioner
from beam.motion import SpeedRamp
from beam.movable_pulley import MovablePulley
from beam.polygon_effect import PolygonEffect
from beam.scenario_curve import CurveEntry
from beam.speed_ripple import SpeedRipple
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
    parts = ripple_parts(scenario)
    if drive.ripple_travel is not None and parts:
        motion = SpeedRipple(motion, drive.ripple_travel.value, parts)
    return motion


def with_play(scenario: Scenario, motion: Travel) -> Travel:
    """What the towed end does of the motion of its drive."""
    play, taken_up = scenario.drive.play, scenario.drive.play_taken_up
    if play is None or play.value == 0:
        return motion
    return DrivePlay(motion, play.value, scenario.time.duration.value, 1.0 if taken_up is None else taken_up.value)


def ripple_parts(scenario: Scenario) -> tuple[tuple[float, float], ...]:
    """Cosine and sine part of the first and second harmonic of the trolley's ripple; empty without a ripple."""
    drive = scenario.drive
    pairs = ((drive.ripple_cosine, drive.ripple_sine), (drive.ripple_cosine_2, drive.ripple_sine_2))
    values = tuple((0.0 if A is None else A.value, 0.0 if B is None else B.value) for A, B in pairs)
    return values if any(A or B for A, B in values) else ()


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
    if fault := _ripple_fault(scenario):
        return fault
    if scenario.machine is not None and (
        drive.curve or drive.tooth_error or drive.chain_pockets or drive.ripple_travel or drive.tensioner_force
    ):
        return "the bending machine has strokes and a tension of its own: curve, teeth, chain and tensioner belong to towing."
    if drive.tensioner_force is not None and scenario.element != "rod":
        return 'a tensioner is a bushing, which needs a cable that can turn: take element = "rod".'
    return ""


def _ripple_fault(scenario: Scenario) -> str:
    drive, parts = scenario.drive, ripple_parts(scenario)
    if bool(parts) and drive.ripple_travel is None:
        return "a ripple of the trolley needs the travel after which it comes again: add drive.ripple_travel."
    size = sum((A * A + B * B) ** 0.5 for A, B in parts)
    if size >= 1:
        return f"the ripple of the trolley is {size:.2f} of its speed and would turn it back: lessen drive.ripple_cosine, ..._sine."
    if drive.play_taken_up is not None and drive.play is None:
        return "drive.play_taken_up says where in its play the towed end begins: add drive.play."
    return ""

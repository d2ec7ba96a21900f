r"""What a scenario cannot be: one sentence for each, naming the key and what to try.

A chain of links of pitch p bends round a radius R with the angle 2 arctan(p / 2R) between neighbouring links, which must stay
below the stop angle of its pins.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from beam.towing_drive import drive_fault

if TYPE_CHECKING:
    from beam.scenario import Scenario

FEWEST_ON_BEND = 5
"""Elements that must lie on the bend."""
FEWEST_LINKS = 4
"""Links that must lie on the bend."""


def first_fault(scenario: Scenario) -> str:
    """The first thing that cannot be true, as a sentence; empty if there is none."""
    checks = (
        _time_fault,
        _kind_fault,
        drive_fault,
        _shape_fault,
        _stroke_fault,
        _mesh_fault,
        _roller_fault,
        _friction_fault,
        _clamp_fault,
    )
    return next((fault for check in checks if (fault := check(scenario))), "")


def _time_fault(scenario: Scenario) -> str:
    drive, time = scenario.drive, scenario.time
    if drive.ramp_end.value <= drive.ramp_start.value:
        return "drive.ramp_end must be later than drive.ramp_start."
    if time.largest_step.value > time.frame.value or time.frame.value > time.duration.value:
        return "time.largest_step must not exceed time.frame, nor time.frame the duration."
    return ""


def _kind_fault(scenario: Scenario) -> str:
    machine = scenario.towing == "bending-machine"
    if machine != (scenario.machine is not None):
        return (
            'towing = "bending-machine" needs the table [machine] with stroke, pause, tension and arch_friction.'
            if machine
            else f'the table [machine] belongs to towing = "bending-machine", found "{scenario.towing}".'
        )
    if scenario.has_clamps and scenario.element != "rod":
        return 'clamps need a cable that can turn: take element = "rod", or chain = "smeared".'
    radius, height = scenario.layout.bend_radius.value, scenario.deck_height
    if height > 2 * radius * (1 + 1e-9):
        return (
            f"layout.deck_height is {height:g} m, higher than the bend of {2 * radius:g} m: "
            f"enlarge layout.bend_radius or lower the deck."
        )
    return ""


def _shape_fault(scenario: Scenario) -> str:
    length, upper, arc = scenario.cable.length.value, scenario.layout.upper_strand.value, scenario.bend_length
    if scenario.lower_strand <= 0 or upper <= 0:
        return (
            f"an upper strand of {upper:g} m and a bend of {arc:.3f} m leave {scenario.lower_strand:.3f} m of the {length:g} m "
            f"long cable for the lower strand: shorten layout.upper_strand or lengthen cable.length."
        )
    return ""


def _stroke_fault(scenario: Scenario) -> str:
    length, lower = scenario.cable.length.value, scenario.lower_strand
    machine = scenario.machine
    if machine is not None:
        if machine.stroke.value >= lower:
            return (
                f"the stroke machine.stroke of {machine.stroke.value:g} m takes the whole lower strand of {lower:.2f} m "
                f"over the arch: shorten it or layout.upper_strand."
            )
        least = scenario.drive.speed.value * (scenario.drive.ramp_end.value - scenario.drive.ramp_start.value)
        if machine.stroke.value < least:
            return (
                f"the stroke machine.stroke of {machine.stroke.value:g} m is too short to reach drive.speed within the ramp: "
                f"it needs {least:g} m, or a shorter ramp."
            )
        return ""
    stroke = float(scenario.pull(scenario.time.duration.value)[0][0])
    travel = float(scenario.trolley(scenario.time.duration.value)[0][0])
    if stroke > length:
        return (
            f"the stroke of {stroke:.2f} m is longer than the cable of {length:g} m: "
            f"shorten time.duration or lower drive.speed."
        )
    if travel >= lower:
        what = "the roller" if scenario.towing == "intelligent" else "the bend"
        return (
            f"{what} travels {travel:.2f} m and runs off the lower strand of {lower:.2f} m: "
            f"shorten time.duration or layout.upper_strand, or lower drive.speed."
        )
    return ""


def _mesh_fault(scenario: Scenario) -> str:
    count, length = scenario.cable.elements.value, scenario.cable.length.value
    if count != int(count):
        return f"cable.elements is {count:g}; it must be a whole number."
    on_bend = scenario.bend_length * count / length
    if on_bend < FEWEST_ON_BEND:
        needed = int(np.ceil(FEWEST_ON_BEND * length / scenario.bend_length))
        return f"{count:g} elements put {on_bend:.1f} on the bend, too few to bend round it: use at least {needed}."
    return ""


def _roller_fault(scenario: Scenario) -> str:
    roller = scenario.roller
    if roller.friction is None and (roller.inertia or roller.bearing_moment or roller.surface_speed):
        return "a roller with inertia, bearing moment or surface speed turns with the cable or turns it: add roller.friction."
    if roller.inertia is not None and roller.surface_speed is not None:
        return "a roller is either driven (roller.surface_speed) or turned by the cable (roller.inertia), not both."
    if roller.bearing_moment is not None and roller.inertia is None:
        return "a roller with a bearing moment turns freely otherwise: add roller.inertia."
    if roller.inertia is not None and scenario.has_clamps:
        return 'a roller with inertia can be turned by the bare cable only: leave out roller.inertia, or take chain = "smeared".'
    return ""


def _friction_fault(scenario: Scenario) -> str:
    contact = scenario.contact
    fall, speed, power = contact.friction_fall, contact.fall_speed, contact.fall_power
    if fall is None and (speed is not None or power is not None):
        return "contact.fall_speed and contact.fall_power say how friction falls: add contact.friction_fall, or leave them out."
    if fall is not None and fall.value > 0 and speed is None:
        return (
            "friction that falls by contact.friction_fall needs the speed over which it does: add contact.fall_speed."
        )
    if power is not None and power.value not in (0.0, 1.0, 2.0):
        return f"contact.fall_power is {power.value:g}; take 1 (exponential), 2 (Gaussian) or 0 (rational)."
    return ""


def _clamp_fault(scenario: Scenario) -> str:
    clamps = scenario.clamps
    if clamps is None or not scenario.has_clamps:
        return ""
    pitch, radius, stop = clamps.pitch.value, scenario.layout.bend_radius.value, clamps.stop_angle.value
    if not scenario.cable.clamp_mass_per_length.value > 0:
        return 'clamps without mass cannot be bodies: give cable.clamp_mass_per_length, or chain = "smeared".'
    if clamps.contact_length.value > pitch:
        return f"clamps.contact_length of {clamps.contact_length.value:g} m is longer than the pitch of {pitch:g} m: shorten it."
    on_bend = scenario.bend_length / pitch
    if on_bend < FEWEST_LINKS:
        return (
            f"clamps of {pitch:g} m pitch put {on_bend:.1f} on the bend of {scenario.bend_length:.3f} m, too few to go round it: "
            f"make clamps.pitch at most {scenario.bend_length / FEWEST_LINKS:.3f} m or enlarge layout.bend_radius."
        )
    needed = 2 * float(np.arctan(0.5 * pitch / radius))
    if needed > stop:
        return (
            f"clamps that stop at {np.degrees(stop):.1f} deg cannot go round a radius of {radius:g} m, which takes "
            f"{np.degrees(needed):.1f} deg a pin: enlarge clamps.stop_angle or layout.bend_radius, or shorten clamps.pitch."
        )
    element = scenario.cable.length.value / scenario.elements
    if pitch < element * (1 - 1e-9):
        return (
            f"clamps of {pitch:g} m pitch are shorter than the elements of {element:g} m, so that two share a node: "
            f"use at least {int(np.ceil(scenario.cable.length.value / pitch))} elements."
        )
    return ""

"""The tables of a scenario file: which numbers there are, their units, and between which limits they can be computed.

What belongs together and what cannot be true is checked in :mod:`beam.scenario`.
"""

from __future__ import annotations

from typing import Annotated

import numpy as np

from beam.scenario_curve import tabulated
from beam.scenario_entry import Entry, Part, quantity


class PublishedConstants(Part):
    """Moduli of the equivalent solid circle."""

    E: Annotated[Entry, quantity("Pa", 1e3, 1e13)]
    G_yoz: Annotated[Entry, quantity("Pa", 1e3, 1e13)]
    G_xoz: Annotated[Entry, quantity("Pa", 1e3, 1e13)]


class Cable(Part):
    """The rod: size, mass, mesh, damping."""

    diameter: Annotated[Entry, quantity("m", 1e-3, 1.0)]
    mass_per_length: Annotated[Entry, quantity("kg/m", 1e-3, 1e3)]
    clamp_mass_per_length: Annotated[Entry, quantity("kg/m", 0.0, 1e3)]
    length: Annotated[Entry, quantity("m", 0.1, 1e4)]
    elements: Annotated[Entry, quantity("1", 8, 20000)]
    damping_time_axial: Annotated[Entry, quantity("s", 0.0, 1.0)]
    damping_time_bending: Annotated[Entry, quantity("s", 0.0, 1.0)]


class Layout(Part):
    """Where the cable lies at the start; without `deck_height` the upper strand lies two bend radii above the lower one."""

    bend_radius: Annotated[Entry, quantity("m", 0.01, 100.0)]
    upper_strand: Annotated[Entry, quantity("m", 0.0, 1e4)]
    slack: Annotated[Entry, quantity("m", -0.5, 1.0)]
    inclination: Annotated[Entry, quantity("rad", -np.pi / 3, np.pi / 3)]
    deck_height: Annotated[Entry, quantity("m", 1e-3, 200.0)] | None = None


class Drive(Part):
    """Shearer and trolley; the optional keys are explained in :mod:`beam.towing_drive`."""

    speed: Annotated[Entry, quantity("m/s", 1e-4, 10.0)]
    trolley_ratio: Annotated[Entry, quantity("1", 0.0, 1.0)]
    ramp_start: Annotated[Entry, quantity("s", 0.0, 1e3)]
    ramp_end: Annotated[Entry, quantity("s", 1e-3, 1e3)]
    curve: Annotated[Entry, tabulated] | None = None
    trolley_error: Annotated[Entry, quantity("1", -0.5, 0.5)] | None = None
    tooth_error: Annotated[Entry, quantity("m", 0.0, 0.1)] | None = None
    tooth_pitch: Annotated[Entry, quantity("m", 1e-4, 10.0)] | None = None
    chain_pockets: Annotated[Entry, quantity("1", 3, 100)] | None = None
    chain_radius: Annotated[Entry, quantity("m", 1e-3, 10.0)] | None = None
    ripple_travel: Annotated[Entry, quantity("m", 1e-3, 10.0)] | None = None
    ripple_cosine: Annotated[Entry, quantity("1", -0.9, 0.9)] | None = None
    ripple_sine: Annotated[Entry, quantity("1", -0.9, 0.9)] | None = None
    ripple_cosine_2: Annotated[Entry, quantity("1", -0.9, 0.9)] | None = None
    ripple_sine_2: Annotated[Entry, quantity("1", -0.9, 0.9)] | None = None
    play: Annotated[Entry, quantity("m", 0.0, 1.0)] | None = None
    play_taken_up: Annotated[Entry, quantity("1", -1.0, 1.0)] | None = None
    tensioner_force: Annotated[Entry, quantity("N", -1e6, 1e6)] | None = None
    tensioner_stroke: Annotated[Entry, quantity("m", 1e-3, 100.0)] | None = None
    tensioner_damping: Annotated[Entry, quantity("N*s/m", 0.0, 1e9)] | None = None


class Clamps(Part):
    """The clamp chain: links of one pitch, each pin two bushings `pin_width` apart, and the cable with a gap in every link.

    K_x ... K_b belong to one bushing: along the chain, normal, across, and about the first two; about the pin it turns freely up
    to the stop. `pin_play` is free along and normal to the chain. A link's mass is ``cable.clamp_mass_per_length`` times the pitch.
    """

    pitch: Annotated[Entry, quantity("m", 1e-3, 10.0)]
    width: Annotated[Entry, quantity("m", 1e-3, 5.0)]
    height: Annotated[Entry, quantity("m", 1e-3, 5.0)]
    contact_length: Annotated[Entry, quantity("m", 1e-3, 10.0)]
    stop_angle: Annotated[Entry, quantity("rad", 0.0, np.pi / 2)]
    stop_stiffness: Annotated[Entry, quantity("N*m/rad", 0.0, 1e9)]
    pin_width: Annotated[Entry, quantity("m", 1e-3, 5.0)]
    K_x: Annotated[Entry, quantity("N/m", 1.0, 1e12)]
    K_y: Annotated[Entry, quantity("N/m", 1.0, 1e12)]
    K_z: Annotated[Entry, quantity("N/m", 1.0, 1e12)]
    K_a: Annotated[Entry, quantity("N*m/rad", 0.0, 1e9)]
    K_b: Annotated[Entry, quantity("N*m/rad", 0.0, 1e9)]
    bushing_damping_time: Annotated[Entry, quantity("s", 0.0, 1.0)]
    preload: Annotated[Entry, quantity("N", -1e6, 1e6)]
    pin_play: Annotated[Entry, quantity("m", 0.0, 0.1)]
    cable_gap: Annotated[Entry, quantity("m", 0.0, 0.5)]
    cable_slide: Annotated[Entry, quantity("m", 0.0, 10.0)]
    cable_stiffness: Annotated[Entry, quantity("N/m", 1.0, 1e12)]


class Walls(Part):
    """Side walls of the trough, at both sides of what lies in it."""

    clearance: Annotated[Entry, quantity("m", 0.0, 10.0)]


class Disturbance(Part):
    """Stress-free waves of the cable across the trough: it is not quite straight."""

    amplitude: Annotated[Entry, quantity("m", 0.0, 1.0)]
    wave_length: Annotated[Entry, quantity("m", 0.05, 1e3)]


class Machine(Part):
    """Bending test machine: stroke of the plate, rest at its ends, tension at the cable's other end, friction of the arch."""

    stroke: Annotated[Entry, quantity("m", 1e-3, 1e3)]
    pause: Annotated[Entry, quantity("s", 0.0, 1e3)]
    tension: Annotated[Entry, quantity("N", 0.0, 1e6)]
    arch_friction: Annotated[Entry, quantity("1", 0.0, 2.0)]


class Contact(Part):
    """Trough and roller; the optional keys, of trough, deck and walls, are explained in :mod:`beam.sliding_friction`.

    Friction falls with the sliding speed by `friction_fall` to `friction`, over `fall_speed` (with `fall_power` 0, 1 or 2, by
    default 1). `drag` is the resistance of trough and deck per length and speed of the cable that lies on them.
    """

    friction: Annotated[Entry, quantity("1", 0.0, 2.0)]
    stiffness: Annotated[Entry, quantity("N/m^2", 1e3, 1e10)]
    roller_stiffness: Annotated[Entry, quantity("N/m^2", 1e3, 1e10)]
    damping_time: Annotated[Entry, quantity("s", 0.0, 1.0)]
    friction_fall: Annotated[Entry, quantity("1", 0.0, 2.0)] | None = None
    fall_speed: Annotated[Entry, quantity("m/s", 1e-6, 100.0)] | None = None
    fall_power: Annotated[Entry, quantity("1", 0.0, 2.0)] | None = None
    drag: Annotated[Entry, quantity("N s/m^2", 0.0, 1e4)] | None = None


class Roller(Part):
    """How the roller turns; with nothing given it turns freely without inertia, bearing friction or friction on the cable.

    With `friction` alone it is a drum that does not turn; with `inertia`, and `bearing_moment`, the cable turns it; with
    `surface_speed` it is driven, positive if its top runs towards the shearer, with the ramp of the drive.
    """

    friction: Annotated[Entry, quantity("1", 0.0, 2.0)] | None = None
    inertia: Annotated[Entry, quantity("kg m^2", 1e-6, 1e6)] | None = None
    bearing_moment: Annotated[Entry, quantity("N m", 0.0, 1e6)] | None = None
    surface_speed: Annotated[Entry, quantity("m/s", -10.0, 10.0)] | None = None


class TimeSpan(Part):
    """Length of the run, output interval, largest step."""

    duration: Annotated[Entry, quantity("s", 1e-2, 1e5)]
    frame: Annotated[Entry, quantity("s", 1e-3, 1e3)]
    largest_step: Annotated[Entry, quantity("s", 1e-5, 0.1)]


class PublishedResults(Part):
    """What the source reports; shown, never used."""

    node_54_Fx_plateau: Annotated[Entry, quantity("N", -1e6, 1e6)] | None = None
    node_220_Fy_plateau: Annotated[Entry, quantity("N", -1e6, 1e6)] | None = None
    node_370_Fx_max: Annotated[Entry, quantity("N", -1e6, 1e6)] | None = None
    bushing_3_amplitude: Annotated[Entry, quantity("N", 0, 1e6)] | None = None
    contact_35_start: Annotated[Entry, quantity("s", 0, 1e6)] | None = None
    contact_35_maximum_at: Annotated[Entry, quantity("s", 0, 1e6)] | None = None
    lateral_displacement_max: Annotated[Entry, quantity("m", 0, 1e3)] | None = None

"""The mechanical problem of a towing scenario: rod, supports, what it touches, and the clamps as mass or as a chain of bodies.

Global axes: x along the trough in the shearer's direction of travel, y normal to the trough, z across it. The cable starts
at the supply at the origin, runs as lower strand towards -x, bends upwards and comes back as upper strand towards +x, on a
deck that begins at the bend. An inclination tilts gravity: positive when the shearer goes uphill. The centre line is what
touches, of the cable or, where the clamps are bodies, of the links, which keep the cable off everything else.

Intelligent: a roller that travels with the trolley holds the bend; it turns freely unless the table `roller` says more.
Conventional: nothing holds it, the upper strand comes down on the lower one. Bending machine: an arch that stands still and has
friction, a plate that carries the upper strand to and fro without friction, and a constant tension at the other end.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from beam.ancf_cable import AncfCable
from beam.incline_formula import STANDARD_GRAVITY
from beam.motion import SpeedRamp
from beam.rod import GAUSS_X, Rod
from beam.rod_model import RodModel, Support
from beam.scenario import Scenario
from beam.section_law import DampingTimes, SectionLaw
from beam.shape import strands_and_arcs
from beam.surface import ContactLaw, Cylinder, FreeTurn, Plane, Spin, Surface
from beam.towing_clamps import clamp_chain
from beam.towing_drive import supply_tensioner
from homogenize.section_stiffness import SectionInertia, SectionStiffness

Array = NDArray[np.float64]

ELEMENTS: dict[str, type[Rod]] = {kind.name: kind for kind in (Rod, AncfCable)}


def towing_model(
    scenario: Scenario, section: SectionStiffness, inertia: SectionInertia, law: SectionLaw | None = None
) -> RodModel:
    """The mechanical problem of a scenario; `inertia` is the cable's, the clamps are added here."""
    rod = _rod(scenario, section, inertia)
    q0 = strands_and_arcs(rod.s, scenario.pieces, angle=np.pi)
    slope = scenario.layout.inclination.value
    gravity = (-STANDARD_GRAVITY * np.sin(slope), -STANDARD_GRAVITY * np.cos(slope), 0.0)
    surfaces, load = towing_surfaces(scenario), None
    tensioner = supply_tensioner(scenario)
    free_end = scenario.machine is not None or bool(tensioner)
    supply = Support(0, held=("y", "z", "theta")) if free_end else Support(0)
    if scenario.machine is not None:
        load = np.zeros((rod.nodes, 12))
        load[0, 0] = scenario.machine.tension.value
    supports = [supply, Support(-1, travel=scenario.pull)]
    if not scenario.has_clamps:
        return RodModel(rod, q0, supports, gravity=gravity, load=load, surfaces=surfaces, law=law, bushings=tensioner)
    chain = clamp_chain(scenario, rod.s)
    return RodModel(
        rod, q0, supports, gravity=gravity, load=load, law=law,
        bodies=chain.bodies, bushings=[*chain.bushings, *tensioner], body_surfaces=surfaces,
    )  # fmt: skip


def mass_per_length(scenario: Scenario, inertia: SectionInertia) -> float:
    """Mass of cable and clamps [kg/m]."""
    return inertia.mass_per_length + scenario.cable.clamp_mass_per_length.value


def _rod(scenario: Scenario, section: SectionStiffness, inertia: SectionInertia) -> Rod:
    cable = scenario.cable
    mass = inertia.mass_per_length if scenario.has_clamps else mass_per_length(scenario, inertia)
    damping = DampingTimes(cable.damping_time_axial.value, cable.damping_time_bending.value)
    rod = ELEMENTS[scenario.element].straight(
        cable.length.value, scenario.elements, section,
        SectionInertia(mass, inertia.J_x, inertia.J_y, inertia.J_z), damping,
    )  # fmt: skip
    waves = scenario.disturbance
    if waves is None or waves.amplitude.value == 0:
        return rod
    k = 2 * np.pi / waves.wave_length.value
    s = rod.s[:-1, None] + GAUSS_X * rod.lengths[:, None]
    E0 = rod.E0.copy()
    E0[:, :, 4] = waves.amplitude.value * k * k * np.sin(k * s)
    return replace(rod, E0=E0)


def trough_law(scenario: Scenario) -> ContactLaw:
    """Of trough and deck, with what falls with speed and the drag where the scenario has them."""
    contact = scenario.contact
    law = ContactLaw(contact.stiffness.value, contact.friction.value, contact.damping_time.value)
    given = {
        "fall": contact.friction_fall, "fall_speed": contact.fall_speed, "fall_power": contact.fall_power, "drag": contact.drag,
    }  # fmt: skip
    return replace(law, **{name: entry.value for name, entry in given.items() if entry is not None})


def towing_surfaces(scenario: Scenario) -> list[Surface]:
    """Trough, deck, side walls, and roller or arch."""
    contact, layout = scenario.contact, scenario.layout
    R, height, start = layout.bend_radius.value, scenario.deck_height, scenario.roller_start
    trough = trough_law(scenario)
    smooth = ContactLaw(contact.roller_stiffness.value, 0.0, contact.damping_time.value)
    trolley = scenario.trolley
    machine = scenario.machine
    plate = replace(trough, friction=0.0, fall=0.0, drag=0.0) if machine else trough
    out: list[Surface] = [
        Plane("trough", trough),
        Plane(
            "deck", plate, offset=height, low=(start, 0.5 * height, -np.inf), box_travel=None if machine else trolley
        ),
    ]
    if scenario.walls is not None:
        half = scenario.walls.clearance.value
        if scenario.has_clamps and scenario.clamps is not None:
            half += 0.5 * scenario.clamps.width.value
        out += [
            Plane(f"{side} wall", replace(trough, drag=0.0), (0.0, 0.0, sign), -half)
            for side, sign in (("left", 1.0), ("right", -1.0))
        ]
    if machine is not None:
        out.append(Cylinder("arch", replace(smooth, friction=machine.arch_friction.value), (start, R, 0.0), R))
    elif scenario.towing == "intelligent":
        grip = scenario.roller.friction
        law = smooth if grip is None else replace(smooth, friction=grip.value)
        out.append(Cylinder("roller", law, (start, R, 0.0), R, trolley, turn=_roller_turn(scenario)))
    return out


def _roller_turn(scenario: Scenario) -> Spin | FreeTurn | None:
    roller, drive = scenario.roller, scenario.drive
    if roller.inertia is not None:
        moment = roller.bearing_moment
        return FreeTurn(roller.inertia.value, 0.0 if moment is None else moment.value)
    if roller.surface_speed is None:
        return None
    angular = -roller.surface_speed.value / scenario.layout.bend_radius.value
    ramp = SpeedRamp(angular, drive.ramp_start.value, drive.ramp_end.value)

    def turn(t: float) -> tuple[float, float, float]:
        angle, speed, acceleration = (float(x[0]) for x in ramp(t))
        return angle, speed, acceleration

    return turn

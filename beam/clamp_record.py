"""What the clamp chain does at one instant: links, bushings, pins, and the cable in the links.

Links, pins and bushings have the source's numbers, counted from the shearer (:mod:`beam.towing_clamps`). Forces of bushings and
pins are what the shearer's side exerts on the supply's side, as for the cable: in a link's axes, x along the chain, tension is
positive. The pressure of a link on the cable is the size of the force across it, the "contact force" of the source.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beam.body_record import bushing_states
from beam.generalized_alpha import Integrator
from beam.rod_model import RodModel

Array = NDArray[np.float64]

Variables = dict[str, tuple[tuple[str, ...], str, str]]

CLAMP_VARIABLES: Variables = {
    "clamp_position": (("clamp", "axis"), "m", "middle of the link"),
    "clamp_rotation_vector": (("clamp", "axis"), "rad", "rotation vector of the link"),
    "clamp_contact_force": (("clamp", "axis"), "N", "force of trough, deck, walls and roller on the link"),
    "clamp_cable_force": (("clamp", "axis"), "N", "force of the link on the cable"),
    "clamp_cable_pressure": (
        ("clamp",),
        "N",
        "size of that force across the link: 0 where the cable lies free in its gap",
    ),
    "bushing_force": (
        ("bushing", "direction"),
        "N (x, y, z), N m (a, b, c)",
        "force of the shearer's side on the supply's side in the link's axes; x positive: tension",
    ),
    "chain_force": (("pin", "axis"), "N", "both bushings of a pin, shearer's side on the supply's side, global axes"),
    "pin_angle": (("pin",), "rad", "angle between the links about the pin"),
}


def has_chain(model: RodModel) -> bool:
    """True if the model holds a clamp chain."""
    return any(body.name.startswith("clamp ") for body in model.bodies)


def clamp_frame(motion: Integrator) -> dict[str, Any]:
    """Values of :data:`CLAMP_VARIABLES` at the present state of `motion`."""
    model, q = motion.model, motion.q
    links = slice(model.rod.nodes, model.moving)
    count = len(model.bodies)
    states = bushing_states(model, motion.t, q, motion.v)
    pins = slice(0, 2 * (count + 1))
    inside = slice(2 * (count + 1), 2 * (count + 1) + count)
    return {
        "clamp_position": q[links, 0:3],
        "clamp_rotation_vector": q[links, 6:9],
        "clamp_contact_force": motion.forces.body_contact,
        "clamp_cable_force": states.force_global[inside],
        "clamp_cable_pressure": np.hypot(states.force[inside, 1], states.force[inside, 2]),
        "bushing_force": -states.force[pins],
        "chain_force": -states.force_global[pins].reshape(-1, 2, 3).sum(axis=1),
        "pin_angle": states.displacement[pins, 5].reshape(-1, 2).mean(axis=1),
    }


def clamp_coordinates(model: RodModel) -> dict[str, tuple[tuple[str, ...], Any, dict[str, str]]]:
    """Numbers of links, pins and bushings, and the six directions of a bushing."""
    count = len(model.bodies)
    numbers = [int(bushing.name.split()[-1]) for bushing in model.bushings[: 2 * (count + 1)]]
    counted = "counted from the shearer"
    return {
        "clamp": (("clamp",), np.arange(count, 0, -1), {"long_name": f"link, {counted}", "units": "1"}),
        "pin": (("pin",), np.arange(count + 1, 0, -1), {"long_name": f"pin, {counted}", "units": "1"}),
        "bushing": (("bushing",), np.array(numbers), {"long_name": f"bushing, two a pin, {counted}", "units": "1"}),
        "direction": (
            ("direction",),
            ["x", "y", "z", "a", "b", "c"],
            {"long_name": "along, normal, across, about them"},
        ),
    }

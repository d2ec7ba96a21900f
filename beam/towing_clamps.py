"""The clamp chain of a towing scenario: one body a link, two bushings a pin, one bushing with gap for the cable in it.

Links are counted from the shearer, as published: link 1 is joined to the shearer's end of the cable, and pin 1 is the one
between them, with the bushings 1 and 2; bushings 3 and 4 are those between the links 1 and 2. In the lists everything stands
from the supply to the shearer, as along the rod. Axes of a link: along the chain towards the shearer, normal, across.

The pins follow the cable's path at the start (:mod:`beam.towing_path`); each link sits on the node that is nearest to its
middle. A link weighs ``cable.clamp_mass_per_length`` times the pitch, spread over the box of pitch, height and width.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beam.bushing import Bushing
from beam.rigid_body import RigidBody
from beam.scenario import Scenario
from beam.scenario_tables import Clamps
from beam.towing_path import chain_pins

Array = NDArray[np.float64]

STOP_EDGE = 0.01
"""rad over which a stop sets in."""
GAP_EDGE = 2e-4
"""m over which a contact with gap sets in."""


@dataclass(frozen=True)
class ClampChain:
    """Bodies and bushings of a chain, and the node of the rod in every link."""

    bodies: list[RigidBody]
    bushings: list[Bushing]
    nodes: list[int]


def link_name(number: int) -> str:
    """Name of a link, counted from the shearer."""
    return f"clamp {number}"


def link_middles(length: float, pitch: float) -> Array:
    """Arc length of the middles of the links [m]: whole pitches from the supply, the last at least one before the end.

    Examples
    --------
    >>> link_middles(1.0, 0.3).round(12).tolist()
    [0.3, 0.6]
    """
    return np.asarray(pitch * np.arange(1, int(np.floor(length / pitch + 1e-9))), dtype=float)


def clamp_chain(scenario: Scenario, s: Array) -> ClampChain:
    """The chain of `scenario` on a rod whose nodes have the arc lengths `s` (n + 1,) [m]."""
    clamps = scenario.clamps
    assert clamps is not None
    pitch = clamps.pitch.value
    middles = link_middles(float(s[-1]), pitch)
    pins, directions = chain_pins(scenario.pieces, np.append(middles - 0.5 * pitch, middles[-1] + 0.5 * pitch), pitch)
    chord = np.diff(pins, axis=0)
    heading = 0.5 * (directions[:-1] + directions[1:])
    turn = np.arctan2(chord[:, 1], chord[:, 0])
    turn += 2 * np.pi * np.round((heading - turn) / (2 * np.pi))
    count = len(middles)
    bodies = [
        _link(scenario, clamps, link_name(count - k), 0.5 * (pins[k] + pins[k + 1]), float(turn[k]))
        for k in range(count)
    ]
    nodes = [int(np.argmin(np.abs(s - middle))) for middle in middles]
    bushings = _pins(clamps, count, float(middles[0] - s[0]), float(s[-1] - middles[-1]))
    bushings += [
        _cable_in_link(clamps, link_name(count - k), node, float(s[node] - middles[k])) for k, node in enumerate(nodes)
    ]
    return ClampChain(bodies, bushings, nodes)


def _link(scenario: Scenario, clamps: Clamps, name: str, position: Array, turn: float) -> RigidBody:
    p, h, w = clamps.pitch.value, clamps.height.value, clamps.width.value
    mass = scenario.cable.clamp_mass_per_length.value * p
    along, across = 0.5 * clamps.contact_length.value, 0.5 * w
    points = [(x, 0.0, z) for x in (-along, along) for z in (-across, across)]
    return RigidBody(
        name,
        mass,
        (mass / 12 * (h * h + w * w), mass / 12 * (p * p + w * w), mass / 12 * (p * p + h * h)),
        position,
        rotation=(0.0, 0.0, turn),
        points=points,
        contact_length=p,
    )


def _pins(clamps: Clamps, count: int, first: float, last: float) -> list[Bushing]:
    """Two bushings a pin; `first`, `last`: from the ends of the cable to the middles of the links there [m]."""
    half, side = 0.5 * clamps.pitch.value, 0.5 * clamps.pin_width.value
    translation = [clamps.K_x.value, clamps.K_y.value, clamps.K_z.value]
    K = np.array([*translation, clamps.K_a.value, clamps.K_b.value, 0.5 * clamps.stop_stiffness.value])
    play = clamps.pin_play.value
    out = []
    for k in range(count + 1):
        number = count - k  # pin `number` + 1, between the links `number` + 1 and `number`
        ends = (0 if k == 0 else link_name(number + 1), -1 if k == count else link_name(number))
        reach = (first - half if k == 0 else half, last - half if k == count else half)
        for i, z in ((1, -side), (0, side)):
            out.append(
                Bushing(
                    *ends,
                    K,
                    damping=clamps.bushing_damping_time.value * K,
                    preload=(-clamps.preload.value, 0, 0, 0, 0, 0),
                    play=(play, play, 0, 0, 0, clamps.stop_angle.value),
                    first_point=(reach[0], 0.0, z),
                    second_point=(-reach[1], 0.0, z),
                    edge=(GAP_EDGE, STOP_EDGE),
                    name=f"bushing {2 * number + 1 + i}",
                )
            )
    return out


def _cable_in_link(clamps: Clamps, name: str, node: int, offset: float) -> Bushing:
    """Force of the link on the cable: none within the gap across and the slide along it."""
    K = clamps.cable_stiffness.value
    gap = clamps.cable_gap.value
    return Bushing(
        name,
        node,
        (K, K, K, 0.0, 0.0, 0.0),
        damping=(*[clamps.bushing_damping_time.value * K] * 3, 0.0, 0.0, 0.0),
        play=(clamps.cable_slide.value, gap, gap, 0.0, 0.0, 0.0),
        first_point=(offset, 0.0, 0.0),
        second_point=(0.0, 0.0, 0.0),
        edge=(GAP_EDGE, STOP_EDGE),
        round_play=gap > 0,
        name=f"cable in {name}",
    )

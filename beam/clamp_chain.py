"""A chain of clamps along a rod: rigid bodies round its nodes, joined to each other by bushings at pins, and to the cable.

Neighbours are joined by `pins` bushings (formula (21), two in the source: one on either side) at the middle between them along
the cable, which lie `pin_width` apart along axis 3 of the clamps. A bushing between every clamp and its node is the hole that the
cable lies in: round play across, and a hold along. The stop angle is the play of a torsional spring between neighbours.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from beam.bushing import Bushing
from beam.rigid_body import RigidBody
from geometry.errors import SpecError

Array = NDArray[np.float64]

Six = tuple[float, float, float, float, float, float]
NONE: Six = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class ClampSettings:
    """One clamp and its pins; N, m, kg, rad.

    Parameters
    ----------
    mass : float
    inertia : (3,) tuple
        About its own axes; axis 1 along the cable.
    pin_stiffness, pin_damping, pin_preload : (6,) tuple
        Of one bushing of a pin, in the axes of the clamp before it.
    hole_stiffness, hole_damping : (6,) tuple
        Between clamp and cable.
    gap : float
        Radial play of the cable in the clamp.
    stop_angle, stop_stiffness : float
        Angle between neighbours at which they touch, and the stiffness beyond it.
    pins : int
    pin_width : float
        Distance between the pins of a pair, along axis 3.
    points : tuple of (3,) tuples
        Points of the clamp that touch trough and deck; `contact_length` of :class:`beam.rigid_body.RigidBody` is the pitch.
    """

    mass: float
    inertia: tuple[float, float, float]
    pin_stiffness: Six
    pin_damping: Six = NONE
    pin_preload: Six = NONE
    hole_stiffness: Six = (1e5, 1e5, 1e5, 10.0, 0.0, 0.0)
    hole_damping: Six = NONE
    gap: float = 0.0
    stop_angle: float = np.inf
    stop_stiffness: float = 0.0
    pins: int = 2
    pin_width: float = 0.08
    points: tuple[tuple[float, float, float], ...] = ()


def clamp_chain(q: Array, nodes: Sequence[int], clamp: ClampSettings) -> tuple[list[RigidBody], list[Bushing]]:
    """Clamps round the `nodes` of a rod with the starting shape `q` (n + 1, 12): bodies "clamp 0" ... and bushings.

    The bushings are first the pins, in the order of the chain, "pin 0.0", "pin 0.1", "pin 1.0", ...; then the stops "stop 0" ...
    (if there is a stop stiffness); then the holes "hole 0" ....

    Raises
    ------
    SpecError
        If there are fewer than two nodes, or they do not grow.
    """
    nodes = [int(i) % len(q) for i in nodes]
    if len(nodes) < 2 or any(b <= a for a, b in pairwise(nodes)):
        raise SpecError(f"a chain of clamps needs two or more nodes in growing order, found {nodes[:8]}.")
    spans = np.linalg.norm(np.diff(q[:, 0:3], axis=0), axis=1)
    pitches = [float(spans[a:b].sum()) for a, b in pairwise(nodes)]
    pitch = float(np.mean(pitches))
    bodies = [
        RigidBody(
            f"clamp {k}", clamp.mass, clamp.inertia, tuple(q[i, 0:3]), tuple(q[i, 6:9]), points=clamp.points,
            contact_length=pitch if clamp.points else 0.0,
        )
        for k, i in enumerate(nodes)
    ]  # fmt: skip
    across = clamp.pin_width * (np.arange(clamp.pins) / max(clamp.pins - 1, 1) - 0.5) if clamp.pins > 1 else [0.0]
    bushings = []
    for k, half in enumerate(0.5 * np.array(pitches)):
        for j, z in enumerate(across):
            ends = f"clamp {k}", f"clamp {k + 1}"
            bushings.append(
                Bushing(
                    *ends, clamp.pin_stiffness, clamp.pin_damping, clamp.pin_preload,
                    first_point=(half, 0.0, float(z)), second_point=(-half, 0.0, float(z)), name=f"pin {k}.{j}",
                )
            )  # fmt: skip
    if clamp.stop_stiffness > 0:
        limit, stiff = (0.0,) * 4 + (clamp.stop_angle,) * 2, (0.0,) * 4 + (clamp.stop_stiffness,) * 2
        bushings += [
            Bushing(f"clamp {k}", f"clamp {k + 1}", stiff, play=limit, name=f"stop {k}") for k in range(len(nodes) - 1)
        ]
    play = (0.0, clamp.gap, clamp.gap, 0.0, 0.0, 0.0)
    for k, i in enumerate(nodes):
        bushings.append(
            Bushing(
                f"clamp {k}", i, clamp.hole_stiffness, clamp.hole_damping, play=play, round_play=clamp.gap > 0,
                first_point=(0.0, 0.0, 0.0), second_point=(0.0, 0.0, 0.0), name=f"hole {k}",
            )
        )  # fmt: skip
    return bodies, bushings

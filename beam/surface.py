"""Surfaces the cable lies on: planes (trough floor, deck) and cylinders (roller, drum), as plain descriptions.

A surface acts on the **centre line**: the floor plane lies half a diameter above the real floor, the cylinder's radius is
the radius of the bend. A cylinder does not turn (a drum), turns as prescribed (a driven roller), or turns freely with its own
inertia and the friction of its bearing (:mod:`beam.free_roller`). A freely turning roller without inertia and bearing friction
carries no friction: mu = 0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beam.contact_force import CYLINDER, PARAMETERS, PLANE
from beam.sliding_friction import DRAG, FALL, friction_coefficient
from geometry.errors import SpecError

Array = NDArray[np.float64]

Travel = Callable[[float], tuple[Array, Array, Array]]
"""Time [s] -> displacement [m], velocity [m/s], acceleration [m/s^2], each (3,)."""

Spin = Callable[[float], tuple[float, float, float]]
"""Time [s] -> angle about z [rad], angular velocity, angular acceleration."""


@dataclass(frozen=True)
class FreeTurn:
    """A cylinder that the cable turns: its `inertia` about the axis [kg m^2], `moment` of the dry friction in its bearing [N m].

    The bearing holds the roller exactly up to `moment`, elastically over an angle of `play` [rad], as a bristle does.
    """

    inertia: float
    moment: float = 0.0
    play: float = 1e-4

    def __post_init__(self) -> None:
        if not (self.inertia > 0 and self.moment >= 0 and self.play > 0):
            raise SpecError(
                f"a free roller needs a positive inertia and play and a bearing moment of zero or more, found "
                f"{self.inertia:g} kg m^2, {self.play:g} rad and {self.moment:g} N m; without inertia take friction 0."
            )


@dataclass(frozen=True)
class ContactLaw:
    """Normal and friction law per length of cable.

    `stiffness` kn [N/m^2], `friction` mu. The damping time tells cn = `damping_time` kn; the bristles have
    kt = `bristle_ratio` kn and ct = `bristle_time` kt. Friction falls with the sliding speed from `friction` + `fall` to
    `friction`, see :mod:`beam.sliding_friction`, and `drag` [N s/m^2] is viscous.

    Examples
    --------
    >>> law = ContactLaw(friction=0.3, fall=0.1, fall_speed=0.05)
    >>> [round(law.coefficient(v), 4) for v in (0.0, 0.05, 10.0)]
    [0.4, 0.3368, 0.3]
    """

    stiffness: float = 1.25e6
    friction: float = 0.0
    damping_time: float = 2e-3
    bristle_ratio: float = 0.5
    bristle_time: float = 1e-2
    fall: float = 0.0
    fall_speed: float = 1.0
    fall_power: float = 1.0
    drag: float = 0.0

    def __post_init__(self) -> None:
        if not (self.stiffness > 0 and self.friction >= 0 and self.damping_time >= 0 and self.bristle_ratio > 0):
            raise SpecError(
                f"a contact law needs a positive stiffness and bristle ratio and a friction coefficient of zero or more, "
                f"found {self.stiffness:g} N/m^2, {self.bristle_ratio:g} and {self.friction:g}."
            )
        if not (self.fall >= 0 and self.fall_speed > 0 and self.fall_power >= 0 and self.drag >= 0):
            raise SpecError(
                f"friction that falls with speed needs a fall, a power and a drag of zero or more and a positive speed, "
                f"found {self.fall:g}, {self.fall_power:g}, {self.drag:g} N s/m^2 and {self.fall_speed:g} m/s."
            )

    def fill(self, p: Array) -> None:
        """Write the nine law parameters into `p`."""
        kt = self.bristle_ratio * self.stiffness
        p[1:6] = self.stiffness, self.damping_time * self.stiffness, self.friction, kt, self.bristle_time * kt
        p[FALL : DRAG + 1] = self.fall, self.fall_speed, self.fall_power, self.drag

    def coefficient(self, speed: float) -> float:
        """Friction coefficient at a sliding speed [m/s]."""
        p = np.zeros(PARAMETERS)
        self.fill(p)
        return float(friction_coefficient(p, abs(float(speed))))


@dataclass(frozen=True)
class Plane:
    """Half space n . x < offset that the centre line cannot enter, inside an axis-parallel box.

    `box_travel` moves the upper x limit of the box, so that a deck can begin at a travelling roller.
    """

    name: str
    law: ContactLaw
    normal: tuple[float, float, float] = (0.0, 1.0, 0.0)
    offset: float = 0.0
    low: tuple[float, float, float] = (-np.inf, -np.inf, -np.inf)
    high: tuple[float, float, float] = (np.inf, np.inf, np.inf)
    box_travel: Travel | None = None
    points: int = 3

    def parameters(self, t: float) -> Array:
        """What the kernel reads at time `t`, shape (30,)."""
        p = np.zeros(PARAMETERS)
        p[24] = 1.0
        p[0] = PLANE
        self.law.fill(p)
        p[6:9], p[9] = self.normal, self.offset
        shift = self.box_travel(t)[0] if self.box_travel else np.zeros(3)
        p[17:20] = np.array(self.low) + shift
        p[20:23] = np.array(self.high) + shift
        return p


@dataclass(frozen=True)
class Cylinder:
    """Cylinder with its axis along z through `centre`, moved by `travel`; the centre line stays outside `radius`.

    `turn` says how it turns about its axis: prescribed, freely, or not at all.
    """

    name: str
    law: ContactLaw
    centre: tuple[float, float, float]
    radius: float
    travel: Travel | None = None
    points: int = 6
    turn: Spin | FreeTurn | None = None

    def parameters(self, t: float) -> Array:
        """What the kernel reads at time `t`, shape (30,)."""
        p = np.zeros(PARAMETERS)
        p[24] = 1.0
        p[0] = CYLINDER
        self.law.fill(p)
        p[10:13], p[16] = self.centre, self.radius
        if self.travel is not None:
            displacement, velocity, _ = self.travel(t)
            p[10:13] += displacement
            p[13:16] = velocity
        if self.turn is not None and not isinstance(self.turn, FreeTurn):
            turn_surface(p, *self.turn(t)[:2])
        p[17:20], p[20:23] = -np.inf, np.inf
        return p


def turn_surface(p: Array, angle: float, speed: float) -> None:
    """Write a cylinder's turning into its parameters `p`."""
    p[23:26] = speed, np.cos(angle), np.sin(angle)


Surface = Plane | Cylinder

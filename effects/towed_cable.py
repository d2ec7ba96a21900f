r"""What an effect of towing acts on: the axial chain of a record, the way its end is led, and the bend it is pulled round.

The told position of a record passes through the drives one after the other, the chain (:mod:`beam.axial_chain`) answers, and
the tension at the towed end is read behind the bend,

.. math::  T_\text{read} = T\,(1 + c\,\sigma), \qquad \sigma = z/d, \quad \mathrm{d}z = \mathrm{d}p, \quad |z| \le d

with the travel d that mobilises the friction of the trough: a stop (Prandtl) operator, whose complement p - z is play
(Visintin, Differential Models of Hysteresis, 1994, ch. III). A cable whose section is known to lose work in bending loses it there
beside that (:mod:`effects.bending_loss`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from beam.axial_chain import AxialChain, led_motion
from effects.bending_loss import BendingLoss
from effects.effect import Array, BenchPath, Starts
from effects.stop_operator import stop

Drive = Callable[[Array, Array], Array]
"""Instants (m,) and position, speed, acceleration (m, 3) to the same (m, 3), of the towed end."""


@dataclass(frozen=True)
class TowedCable:
    """One towing record before it is run, SI.

    Attributes
    ----------
    chain : AxialChain
    time, position : (n,) arrays
        As the drive was told.
    drives : tuple of Drive
        What becomes of the told motion, in this order.
    shortest : float
        Shortest time scale of the drives [s].
    bend : float
        Part of the tension that the bend at the towed end costs.
    smooth_bend : bool
        Whether this is mobilised over the travel of the trough's friction; else it has the sign of the speed.
    carried : BendingLoss or None
        What the section, as the bench knows it, loses at this bend.
    """

    chain: AxialChain
    time: Array = field(repr=False)
    position: Array = field(repr=False)
    drives: tuple[Drive, ...] = ()
    shortest: float = math.inf
    bend: float = 0.0
    smooth_bend: bool = True
    carried: BendingLoss | None = None

    def driven(self, drive: Drive, shortest: float = math.inf) -> TowedCable:
        """The same with one more drive."""
        return replace(self, drives=(*self.drives, drive), shortest=min(self.shortest, shortest))

    def with_chain(self, **changes: object) -> TowedCable:
        """The same with another chain."""
        return replace(self, chain=replace(self.chain, **changes))  # type: ignore[arg-type]

    def tensions(self, stations: Sequence[float] = ()) -> list[Array]:
        """Tension [N] at the towed end behind the bend, and at every station: (n,) each."""
        t, motion, steps = self.led()
        run = self.chain.led(t, motion, steps, stations, tally=False)
        return [self.behind_the_bend(run.tension, motion, steps), *run.at]

    def led(self) -> tuple[Array, Array, int]:
        """Instants (m,), position, speed and acceleration (m, 3) behind all drives, and the steps between two samples."""
        steps = self.chain.substeps(self.time, self.shortest)
        t, motion = led_motion(self.time, self.position, steps)
        for drive in self.drives:
            motion = drive(t, motion)
        return t, motion, steps

    def behind_the_bend(self, tension: Array, motion: Array, steps: int) -> Array:
        """What is read (n,) of the tension before the bend, with the motion of :meth:`led`."""
        read = tension
        if self.bend != 0:
            d = self.chain.presliding
            sense = stop(motion[:, 0], d, 0.0) / d if self.smooth_bend else np.sign(motion[:, 1])
            read = read * (1 + self.bend * sense[::steps])
        if self.carried is not None:
            read = read + self.carried.resistance(motion[::steps, 0], motion[::steps, 1], tension)
        return read


def largest_speed(path: BenchPath) -> float:
    """Largest told speed of a record [m/s]; 0 without a clock."""
    if path.time is None or len(path.time) < 2:
        return 0.0
    return float(np.abs(np.diff(path.strain) / np.diff(path.time)).max())


def of_speed(low: float, high: float, m: int) -> Starts:
    """m values from `low` to `high` times the largest speed of all records."""
    return lambda paths: np.geomspace(low, high, m) * (max((largest_speed(p) for p in paths), default=0.0) or 1.0)


def of_cable(*shares: float) -> Starts:
    """Given shares of the length of the cable."""
    return lambda paths: np.array(shares) * max((p.length or 1.0 for p in paths), default=1.0)


def turns_back(path: BenchPath) -> bool:
    """Whether the towed end goes both ways."""
    step = np.diff(path.strain)
    size = 1e-3 * max(float(np.ptp(path.strain)), 1e-12) / max(len(step), 1)
    return bool((step > size).any() and (step < -size).any())

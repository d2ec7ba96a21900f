r"""Reciprocating motion: strokes there and back with a constant speed between smooth ramps, and a rest at either end.

One stroke of the length S at the speed V with ramps of the duration T takes t_s = S/V + T, and its displacement is the
difference of two ramps u_r of :class:`beam.motion.SpeedRamp` that start at 0 and at t_s - T,

.. math:: u(t) = u_r(t) - u_r(t - t_s + T), \qquad 0 \le t \le t_s .
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beam.motion import SpeedRamp
from geometry.errors import SpecError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ReciprocatingStroke:
    """Strokes of length `stroke` [m] at `speed` [m/s], ramps of `ramp` [s], rests of `pause` [s], from the time `start` [s] on.

    Examples
    --------
    >>> plate = ReciprocatingStroke(stroke=1.5, speed=0.5, ramp=0.5, pause=0.2)
    >>> [round(float(plate(t)[0][0]), 9) for t in (0.0, 1.75, 3.5, 3.6, 5.45, 7.2, 7.4)]
    [0.0, 0.75, 1.5, 1.5, 0.75, 0.0, 0.0]
    """

    stroke: float
    speed: float
    ramp: float
    pause: float = 0.0
    start: float = 0.0
    direction: tuple[float, float, float] = (1.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if not (self.stroke > 0 and self.speed > 0 and self.ramp > 0 and self.pause >= 0):
            raise SpecError(
                "a reciprocating motion needs a positive stroke, speed and ramp, and a pause of zero or more."
            )
        if self.stroke < self.speed * self.ramp:
            raise SpecError(
                f"a stroke of {self.stroke:g} m is too short to reach {self.speed:g} m/s with ramps of {self.ramp:g} s: "
                f"it needs at least {self.speed * self.ramp:g} m."
            )

    @property
    def stroke_time(self) -> float:
        """Duration of one stroke [s]."""
        return self.stroke / self.speed + self.ramp

    @property
    def period(self) -> float:
        """There and back with both rests [s]."""
        return 2 * (self.stroke_time + self.pause)

    def __call__(self, t: float) -> tuple[Array, Array, Array]:
        """Displacement, velocity and acceleration at time `t`, each (3,)."""
        within = max(t - self.start, 0.0) % self.period
        half = 0.5 * self.period
        u, v, a = self._stroke(within if within < half else within - half)
        if within >= half:
            u, v, a = self.stroke - u, -v, -a
        along = np.array(self.direction)
        return u * along, v * along, a * along

    def _stroke(self, t: float) -> tuple[float, float, float]:
        rise = SpeedRamp(self.speed, 0.0, self.ramp)(t)
        fall = SpeedRamp(self.speed, self.stroke_time - self.ramp, self.stroke_time)(t)
        u, v, a = (float(x[0] - y[0]) for x, y in zip(rise, fall, strict=True))
        return u, v, a

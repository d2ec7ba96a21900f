r"""Prescribed motions: a ramp from rest to a constant speed without a jump in acceleration.

With x = (t - t_0)/T in [0, 1],

.. math:: v = V (3x^2 - 2x^3), \qquad u = V T (x^3 - x^4/2), \qquad a = \frac{V}{T} (6x - 6x^2),

and u = V (t - t_0 - T/2) once the ramp is over.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import SpecError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SpeedRamp:
    """Motion from rest along `direction` that reaches `speed` [m/s] between `start` and `end` [s]; scaled by `ratio`.

    Examples
    --------
    >>> ramp = SpeedRamp(speed=0.3, start=0.5, end=1.5)
    >>> [round(float(x[0]), 6) for x in ramp(5.0)]
    [1.2, 0.3, 0.0]
    """

    speed: float
    start: float
    end: float
    direction: tuple[float, float, float] = (1.0, 0.0, 0.0)
    ratio: float = 1.0

    def __post_init__(self) -> None:
        if not self.end > self.start:
            raise SpecError(f"a speed ramp must end after it starts, found {self.start:g} s to {self.end:g} s.")

    def __call__(self, t: float) -> tuple[Array, Array, Array]:
        """Displacement, velocity and acceleration at time `t`, each (3,)."""
        T = self.end - self.start
        x = min(max((t - self.start) / T, 0.0), 1.0)
        u = T * (x**3 - x**4 / 2) + max(t - self.end, 0.0)
        v = 3 * x**2 - 2 * x**3
        a = (6 * x - 6 * x**2) / T
        along = self.ratio * self.speed * np.array(self.direction)
        return u * along, v * along, a * along


@dataclass(frozen=True)
class Turn:
    """Prescribed turning of a section about a fixed `axis`: `angle` gives (angle, speed, acceleration) at a time [s].

    The rotation vector is taken to the branch within half a turn, so that there may be many turns.

    Examples
    --------
    >>> turn = Turn(lambda t: (2 * t, 2.0, 0.0))
    >>> [round(float(x[2]), 6) for x in turn(3.0)]
    [-0.283185, 2.0, 0.0]
    """

    angle: Callable[[float], tuple[float, float, float]]
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)

    def __post_init__(self) -> None:
        if not abs(float(np.linalg.norm(self.axis)) - 1.0) < 1e-9:
            raise SpecError(f"the axis of a turn must have length one, found {self.axis}.")

    def __call__(self, t: float) -> tuple[Array, Array, Array]:
        """Rotation vector, its velocity and acceleration at time `t`, each (3,)."""
        angle, speed, acceleration = self.angle(t)
        axis = np.array(self.axis)
        within = float(np.arctan2(np.sin(angle), np.cos(angle)))
        return within * axis, speed * axis, acceleration * axis

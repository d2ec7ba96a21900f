"""What the drive of a towed end is told: a position that is a sum of soft speed steps.

Each step raises the speed by D within a time q, v = D (3 x^2 - 2 x^3) with x = (t - t0)/q, so that position, speed and
acceleration are closed expressions and the acceleration has no jump.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Motion:
    """Speed steps: instant [s], duration [s] and size [m/s] of each."""

    begin: tuple[float, ...]
    rise: tuple[float, ...]
    step: tuple[float, ...]

    def __call__(self, t: Array) -> tuple[Array, Array, Array]:
        """Position [m], speed [m/s] and acceleration [m/s^2] at the instants.

        Examples
        --------
        >>> p, v, a = to_and_fro(0.5, 12.0)(np.array([0.0, 3.0, 12.0]))
        >>> [round(float(x), 9) for x in v]
        [0.0, 0.5, 0.0]
        """
        p, v, a = (np.zeros_like(t) for _ in range(3))
        for t0, q, D in zip(self.begin, self.rise, self.step, strict=True):
            x = np.clip((t - t0) / q, 0.0, 1.0)
            p += D * (q * (x**3 - x**4 / 2) + np.maximum(t - t0 - q, 0.0))
            v += D * x**2 * (3 - 2 * x)
            a += D / q * 6 * x * (1 - x)
        return p, v, a


def to_and_fro(speed: float, duration: float, back: float = 0.7, rise: float = 0.08) -> Motion:
    """Rest, uphill, rest, downhill for the share `back` of the time uphill, rest, and a little uphill again.

    `rise` is the time of each speed step over the duration.
    """
    q = rise * duration
    plan = ((0.04, 0.36, 1.0), (0.43, 0.43 + back * 0.32, -1.0), (0.50 + back * 0.32, 0.86, 1.0))
    begin, step = [], []
    for start, stop, sign in plan:
        begin += [start * duration, stop * duration - q]
        step += [sign * speed, -sign * speed]
    return Motion(tuple(begin), (q,) * len(begin), tuple(step))

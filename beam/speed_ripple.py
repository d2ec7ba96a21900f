r"""Speed ripple over the travel: a drive that runs ahead and behind once a given travel, with the harmonics that were found.

.. math:: v = v_b \Bigl[1 + \sum_m (A_m \cos m\theta - B_m \sin m\theta)\Bigr], \qquad \theta = 2\pi u_b / \lambda, \qquad
          u = u_b + \frac{\lambda}{2\pi} \sum_m \frac{1}{m} \bigl(A_m \sin m\theta + B_m (\cos m\theta - 1)\bigr)

with the travel u_b of the even drive and lambda the travel from pocket to pocket. A wheel of known size has the series of
:mod:`beam.polygon_effect`; here size and phase of every harmonic are free, as measurements give them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beam.surface import Travel
from geometry.errors import SpecError

Array = NDArray[np.float64]


def rippled(motion: Array, travel: float, parts: Sequence[tuple[float, float]]) -> Array:
    """Position, speed and acceleration (m, 3) of an even drive with the ripple (A_m, B_m), m = 1, 2, ..., once every `travel` [m].

    Examples
    --------
    >>> rippled(np.array([[0.05, 1.0, 0.3]]), 0.1, [(0.02, 0.0)]).round(9).tolist()  # half a travel on: slowest
    [[0.05, 0.98, 0.294]]
    """
    x, v, a = motion.T
    ripple, slope, shift = np.zeros(len(x)), np.zeros(len(x)), np.zeros(len(x))
    for m, (A, B) in enumerate(parts, start=1):
        k = 2 * math.pi * m / travel
        c, s = np.cos(k * x), np.sin(k * x)
        ripple += A * c - B * s
        slope += k * (A * s + B * c)
        shift += (A * s + B * (c - 1)) / k
    return np.column_stack([x + shift, v * (1 + ripple), a * (1 + ripple) - v**2 * slope])


@dataclass(frozen=True)
class SpeedRipple:
    """The motion `base` along x with the ripple `parts` (A_m, B_m) once every `travel` [m].

    Examples
    --------
    >>> from beam.motion import SpeedRamp
    >>> drive = SpeedRipple(SpeedRamp(0.1, 0.0, 1.0), travel=0.1, parts=((0.05, 0.0),))
    >>> round(float(drive(1.5)[1][0]), 12)  # 0.1 m after the start
    0.105
    """

    base: Travel
    travel: float
    parts: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        if not self.travel > 0 or not self.size < 1:
            raise SpecError(
                f"a speed ripple needs a positive travel and less than the speed itself, found {self.travel:g} m and "
                f"{self.size:.2f} of the speed."
            )

    @property
    def size(self) -> float:
        """Sum of the amplitudes of the harmonics, over the speed."""
        return float(sum(math.hypot(A, B) for A, B in self.parts))

    def __call__(self, t: float) -> tuple[Array, Array, Array]:
        """Displacement, velocity and acceleration at time `t`, each (3,)."""
        even = np.array(self.base(t))
        out = even.copy()
        out[:, 0] = rippled(even[None, :, 0], self.travel, self.parts)[0]
        return out[0], out[1], out[2]

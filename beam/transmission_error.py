r"""Transmission error of the travelling wheel and its gears: a motion that runs ahead and behind once a tooth.

.. math:: u = u_b + e \sin\frac{2\pi u_b}{p}, \qquad \dot u = \dot u_b \Bigl(1 + \frac{2\pi e}{p} \cos\frac{2\pi u_b}{p}\Bigr),

with the motion u_b of ideal gears, the way p of a tooth, and the amplitude e of the error on that way. The wheel of a
haulage without chain engages one tooth a rack pitch; a gear of the internal transmission one tooth a p = 2 pi r / (i z), with z
teeth on a shaft that turns i times as fast as the wheel of the pitch radius r.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beam.surface import Travel
from geometry.errors import SpecError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TransmissionError:
    """The motion `base` with an error of `amplitude` [m] once every `pitch` [m] along `direction`.

    Examples
    --------
    >>> from beam.motion import SpeedRamp
    >>> shearer = TransmissionError(SpeedRamp(0.1, 0.0, 1.0), amplitude=1e-3, pitch=0.1)
    >>> round(shearer.ripple, 4)
    0.0628
    """

    base: Travel
    amplitude: float
    pitch: float
    direction: tuple[float, float, float] = (1.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if not self.pitch > 0 or self.amplitude < 0:
            raise SpecError(
                f"a transmission error needs a positive pitch and an amplitude of zero or more, found {self.pitch:g} m and "
                f"{self.amplitude:g} m."
            )
        if self.ripple >= 1:
            raise SpecError(
                f"an error of {self.amplitude:g} m once every {self.pitch:g} m would turn the motion back "
                f"(ripple {self.ripple:.2f}): lessen the amplitude below {self.pitch / (2 * np.pi):.3g} m."
            )

    @property
    def ripple(self) -> float:
        """Amplitude of the speed over the mean speed: 2 pi e / p."""
        return 2 * np.pi * self.amplitude / self.pitch

    def __call__(self, t: float) -> tuple[Array, Array, Array]:
        """Displacement, velocity and acceleration at time `t`, each (3,)."""
        u, du, ddu = self.base(t)
        along = np.array(self.direction)
        k = 2 * np.pi / self.pitch
        x, v, a = (float(value @ along) for value in (u, du, ddu))
        sine, cosine = self.amplitude * np.sin(k * x), self.amplitude * k * np.cos(k * x)
        return u + sine * along, du + cosine * v * along, ddu + (cosine * a - k * k * sine * v * v) * along

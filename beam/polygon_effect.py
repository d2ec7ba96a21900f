r"""Polygon effect of a chain on a wheel with few pockets: the speed of the chain ripples while the wheel turns evenly.

The link that the wheel has caught moves on the pitch radius R; while one pocket passes, phi runs from -pi/N to pi/N and

.. math:: v = R \omega \cos\varphi, \qquad \frac{v_{max} - v_{min}}{v_{max}} = 1 - \cos\frac{\pi}{N}, \qquad
          \bar v = R \omega s, \quad s = \frac{\sin(\pi/N)}{\pi/N} .

When the next link is caught the exact acceleration jumps by 2 R omega^2 sin(pi/N). Its Fourier series

.. math:: \frac{v}{R\omega} = s \Bigl[ 1 + \sum_{m=1}^{M} \frac{2 (-1)^m}{1 - m^2 N^2} \cos(m N \theta) \Bigr]

broken off after M terms has the same mean and no jump: the links and the wheel give way.
Source: elementary kinematics of chain drives, e.g. G. Niemann, H. Winter, Maschinenelemente III, chapter on chain drives.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beam.surface import Travel
from geometry.errors import SpecError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PolygonEffect:
    """The motion `base`, made by a chain on a wheel with `pockets` and the pitch `radius` [m].

    The wheel turns so that the chain's mean speed is that of `base`, with the middle of a pocket (its fastest) at the start.
    `harmonics` terms of the series; None: the exact course, whose acceleration jumps.

    Examples
    --------
    >>> from beam.motion import SpeedRamp
    >>> chain = PolygonEffect(SpeedRamp(0.1, 0.0, 1.0), pockets=5, radius=0.1)
    >>> round(chain.ripple, 4)
    0.191
    """

    base: Travel
    pockets: int
    radius: float
    harmonics: int | None = 3

    def __post_init__(self) -> None:
        if self.pockets < 3 or not self.radius > 0 or (self.harmonics is not None and self.harmonics < 1):
            raise SpecError(
                f"a chain wheel needs three or more pockets, a positive radius and one or more harmonics, found "
                f"{self.pockets:g}, {self.radius:g} m and {self.harmonics}."
            )

    @property
    def ripple(self) -> float:
        """Fall of the speed between two pockets, over the largest speed: 1 - cos(pi/N)."""
        return float(1 - np.cos(np.pi / self.pockets))

    @property
    def mean_ratio(self) -> float:
        """Mean speed over R omega."""
        return float(np.sinc(1.0 / self.pockets))

    def __call__(self, t: float) -> tuple[Array, Array, Array]:
        """Displacement, velocity and acceleration at time `t`, each (3,)."""
        u, du, ddu = self.base(t)
        reach = self.radius * self.mean_ratio
        size = float(np.linalg.norm(du)) or float(np.linalg.norm(u))
        if size == 0:
            return u, du, ddu
        along = du / size if np.any(du) else u / size
        theta = float(u @ along) / reach
        place, first, second = self._wheel(theta)
        speed = float(du @ along) / reach
        turn = float(ddu @ along) / reach
        across = u - (u @ along) * along
        return across + place * along, first * speed * along, (second * speed**2 + first * turn) * along

    def _wheel(self, theta: float) -> tuple[float, float, float]:
        """Place of the chain and its two derivatives by the angle of the wheel."""
        R, N = self.radius, self.pockets
        if self.harmonics is None:
            pocket = np.round(theta * N / (2 * np.pi))
            phi = theta - pocket * 2 * np.pi / N
            return (
                float(R * (np.sin(phi) + 2 * pocket * np.sin(np.pi / N))),
                float(R * np.cos(phi)),
                float(-R * np.sin(phi)),
            )
        m = np.arange(1, self.harmonics + 1)
        k = m * N
        c = 2.0 * (-1.0) ** m / (1.0 - k**2)
        s = self.mean_ratio * R
        return (
            float(s * (theta + (c / k * np.sin(k * theta)).sum())),
            float(s * (1 + (c * np.cos(k * theta)).sum())),
            float(-s * (c * k * np.sin(k * theta)).sum()),
        )

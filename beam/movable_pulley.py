r"""Movable pulley: the trolley follows the shearer at half its speed, and what an error of that ratio does to the cable.

A pulley that hangs in a line whose one end stands and whose other end moves by u_S goes u_T = u_S / 2. With a relative error e of the drive

.. math:: u_T = \tfrac12 (1 + e)\, u_S, \qquad \Delta = 2 u_T - u_S = e\, u_S .

Delta is the slack that the bend of a cable reeved in the same way gains (negative: by how much it is tightened).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beam.surface import Travel

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MovablePulley:
    """The motion `base` times `ratio` (1 + `error`).

    Examples
    --------
    >>> from beam.motion import SpeedRamp
    >>> trolley = MovablePulley(SpeedRamp(0.1, 0.0, 1.0), error=0.01)
    >>> round(float(trolley(10.5)[0][0]), 6), round(trolley.slack(10.5), 6)
    (0.505, 0.01)
    """

    base: Travel
    ratio: float = 0.5
    error: float = 0.0

    def __call__(self, t: float) -> tuple[Array, Array, Array]:
        """Displacement, velocity and acceleration at time `t`, each (3,)."""
        u, du, ddu = self.base(t)
        factor = self.ratio * (1 + self.error)
        return factor * u, factor * du, factor * ddu

    def slack(self, t: float) -> float:
        """Slack that the cable has gained at time `t` [m]; negative: tightened."""
        u = float(self.base(t)[0][0])
        return (2 * self.ratio * (1 + self.error) - 1) * u

r"""Play between the drive and the towed end: after every reversal the end stands still while the drive crosses the play.

.. math:: u = u_d - z, \qquad \mathrm{d}z = \mathrm{d}u_d, \quad |z| \le b/2

the play operator of width b (Visintin, Differential Models of Hysteresis, 1994, ch. III), here as a function of time: between two
reversals of the drive, from (u_d0, u_0), the end has gone

.. math:: \pm h(y), \qquad y = |u_d - u_{d0}| - g, \qquad h = 0 \;(y < -e/2), \quad y \;(y > e/2),

g the gap that is left in that direction. Over the travel e = b/5, and at most 2 g, the clamps come to bear: h rises there as a
ramp of :mod:`beam.motion`, so that the speed has no jump.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from beam.surface import Travel
from geometry.errors import SpecError

Array = NDArray[np.float64]

EDGE = 0.2
"""Travel over which the clamps come to bear, over the play."""
_SAMPLES = 2000  # of a run, among which reversals are looked for


@dataclass(frozen=True)
class DrivePlay:
    """The motion `base` along x behind a `play` [m], until `duration` [s].

    `taken_up` says where in its play the end begins: 1 where the drive pulls at once, 0 in the middle.

    Raises
    ------
    SpecError
        If the play is negative, or begins outside itself.

    Examples
    --------
    >>> from beam.motion import SpeedRamp
    >>> end = DrivePlay(SpeedRamp(0.1, 0.0, 1.0), play=0.02, duration=5.0, taken_up=0.0)
    >>> [round(float(end(t)[0][0]), 6) for t in (0.4, 1.5)]  # half the play is lost
    [0.0, 0.09]
    """

    base: Travel
    play: float
    duration: float
    taken_up: float = 1.0
    _strokes: list[tuple[float, float, float, float, float]] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if not self.play >= 0 or not -1 <= self.taken_up <= 1:
            raise SpecError(
                f"a play needs a width of zero or more and a start within it (-1 to 1), found {self.play:g} m and "
                f"{self.taken_up:g}."
            )
        object.__setattr__(self, "_strokes", self._followed())

    def __call__(self, t: float) -> tuple[Array, Array, Array]:
        """Displacement, velocity and acceleration at time `t`, each (3,)."""
        stroke = self._strokes[max(bisect_right(self._strokes, t, key=lambda s: s[0]) - 1, 0)]
        return self._within(stroke, t)

    def _within(self, stroke: tuple[float, float, float, float, float], t: float) -> tuple[Array, Array, Array]:
        _, x0, p0, sign, gap = stroke
        u, du, ddu = (np.array(part) for part in self.base(t))
        x, v, a = (float(part[0]) for part in (u, du, ddu))
        h, slope, curvature = _bearing(sign * (x - x0) - gap, min(EDGE * self.play, 2 * gap))
        u[0], du[0], ddu[0] = p0 + sign * h, slope * v, slope * a + sign * curvature * v * v
        return u, du, ddu

    def _followed(self) -> list[tuple[float, float, float, float, float]]:
        """Begin, drive and end there, sense, and gap in that sense, of every stroke."""
        half, z, out = 0.5 * self.play, 0.5 * self.play * self.taken_up, []
        begins = reversals(self.base, self.duration)
        start = float(self.base(0.0)[0][0]) - z  # the end begins at zero
        for i, begin in enumerate(begins):
            x = float(self.base(begin)[0][0])
            p = x - z - start
            ahead = self.base(begins[i + 1] if i + 1 < len(begins) else self.duration)
            sign = 1.0 if float(ahead[0][0]) >= x else -1.0
            out.append((begin, x, p, sign, max(half - sign * z, 0.0)))
            if i + 1 < len(begins):
                last = begins[i + 1]
                z = float(self.base(last)[0][0]) - float(self._within(out[-1], last)[0][0]) - start
        return out


def reversals(base: Travel, duration: float) -> tuple[float, ...]:
    """0 and the instants [s] before `duration` at which a motion along x turns back."""
    try:
        hash(base)
    except TypeError:  # a motion that holds arrays
        return _reversals(base, duration)
    return _kept_reversals(base, duration)


def _reversals(base: Travel, duration: float) -> tuple[float, ...]:
    times = np.linspace(0.0, duration, _SAMPLES + 1)
    speed = np.array([float(base(float(t))[1][0]) for t in times])
    moving = np.flatnonzero(np.abs(speed) > 1e-9 * max(float(np.abs(speed).max()), 1e-300))
    out = [0.0]
    for i, j in pairwise(moving.tolist()):
        if speed[i] * speed[j] < 0:
            out.append(_turn(base, float(times[i]), float(times[j]), float(speed[i])))
    return tuple(out)


_kept_reversals = lru_cache(maxsize=64)(_reversals)  # a scenario asks for its motion at every instant


def _turn(base: Travel, low: float, high: float, before: float) -> float:
    """The instant at which the speed leaves the sign of `before`, by halving."""
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if float(base(middle)[1][0]) * before > 0 else (low, middle)
    return high


def _bearing(y: float, edge: float) -> tuple[float, float, float]:
    """h(y) and its two derivatives."""
    s = (y + 0.5 * edge) / edge if edge > 0 else float(y >= 0)
    if s <= 0 or s >= 1:
        return (y, 1.0, 0.0) if s >= 1 else (0.0, 0.0, 0.0)
    return edge * (s**3 - 0.5 * s**4), 3 * s**2 - 2 * s**3, 6 * (s - s * s) / edge

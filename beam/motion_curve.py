r"""Motions from a table of speeds or displacements, continuous up to the acceleration.

A table of speeds is interpolated by a monotone cubic (F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17 (1980) 238-246), which
never exceeds the given values, and integrated exactly. A table of displacements is interpolated by a spline of degree five with
u' = u'' = 0 at its first time and u'' = u''' = 0 at its last one. Before the table the motion rests; after it the last speed goes on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.errors import SpecError

Array = NDArray[np.float64]

Course = Callable[[float], tuple[float, float, float]]


@dataclass(frozen=True)
class MotionCurve:
    """Motion along `direction` after a table: `times` (k,) [s] and as many `values`, speeds [m/s] or, `kind` "displacement", metres.

    Raises
    ------
    SpecError
        If the times do not grow, the numbers do not match, a speed does not start at zero, or `kind` is unknown.

    Examples
    --------
    >>> curve = MotionCurve((0.0, 1.0, 3.0), (0.0, 0.2, 0.2))
    >>> [round(float(x[0]), 6) for x in curve(4.0)]
    [0.7, 0.2, 0.0]
    """

    times: ArrayLike
    values: ArrayLike
    kind: str = "speed"
    direction: tuple[float, float, float] = (1.0, 0.0, 0.0)
    course: Course = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        t, y = (np.asarray(x, dtype=float) for x in (self.times, self.values))
        least = 2 if self.kind == "speed" else 3
        if t.ndim != 1 or t.shape != y.shape or t.size < least or not np.isfinite([t, y]).all():
            raise SpecError(
                f"a curve of {self.kind} needs {least} or more times and as many finite values, found {t.size} and {y.size}."
            )
        if not (np.diff(t) > 0).all():
            k = int(np.argmin(np.diff(t)))
            raise SpecError(f"the times of a motion curve must grow, found {t[k]:g} s before {t[k + 1]:g} s.")
        if self.kind == "speed" and y[0] != 0:
            raise SpecError(
                f"a curve of speed must begin at rest, found {y[0]:g} m/s at {t[0]:g} s: put a zero before it."
            )
        if self.kind not in ("speed", "displacement"):
            raise SpecError(f"a motion curve holds 'speed' or 'displacement', found {self.kind!r}.")
        object.__setattr__(self, "course", _of_speed(t, y) if self.kind == "speed" else _of_displacement(t, y))

    def __call__(self, t: float) -> tuple[Array, Array, Array]:
        """Displacement, velocity and acceleration at time `t`, each (3,)."""
        along = np.array(self.direction)
        u, v, a = self.course(t)
        return u * along, v * along, a * along


def _of_speed(t: Array, v: Array) -> Course:
    from scipy.interpolate import PchipInterpolator

    # equal speeds beyond the table let the acceleration begin and end at zero
    first, last = t[0] - (t[1] - t[0]), t[-1] + (t[-1] - t[-2])
    speed = PchipInterpolator(np.concatenate([[first], t, [last]]), np.concatenate([v[:1], v, v[-1:]]))
    return _within(t, float(speed.integrate(t[0], t[-1])), speed.antiderivative(), speed, speed.derivative())


def _of_displacement(t: Array, u: Array) -> Course:
    from scipy.interpolate import make_interp_spline

    rest = ([(1, 0.0), (2, 0.0)], [(2, 0.0), (3, 0.0)])
    place = make_interp_spline(t, u, k=5, bc_type=rest)
    return _within(t, float(u[-1] - u[0]), place, place.derivative(), place.derivative(2))


def _within(t: Array, total: float, place: Callable, speed: Callable, acceleration: Callable) -> Course:
    begin, end = float(t[0]), float(t[-1])
    offset, last = float(place(begin)), float(speed(end))

    def course(now: float) -> tuple[float, float, float]:
        if now <= begin:
            return 0.0, 0.0, 0.0
        if now >= end:
            return total + last * (now - end), last, 0.0
        return float(place(now)) - offset, float(speed(now)), float(acceleration(now))

    return course

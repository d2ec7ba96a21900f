r"""A cable that is drawn over a bend is bent and straightened again; what its section loses in that must be pulled.

Per length of cable that passes, the work is the loop of the moment over the curvature 0 -> 1/R -> 0 at the grip of the
tension T, once it closes (the cable has been to and fro before); work per length is a force,

.. math::  W(T) = \oint M\,\mathrm{d}\kappa, \qquad T_\text{read} = T + \sigma\,W(T)

The loop is stepped with the laws that a bench has found (:meth:`effects.effect.ActiveEffect.advance`). For a stick-slip
element that yields at M_y and kappa_y it is W = 2 M_y (1/R - 2 kappa_y); an elastic law gives 0. A rate enters by the time in
which a length is bent, lambda/v, and by that which it stays bent, R theta/v.

The cable goes into the bend and out of it within a length lambda on either side, where tension straightens it,

.. math::  \kappa(s) = \frac{1}{R}\,e^{-s/\lambda}, \qquad \lambda = \sqrt{EI/T}

When the motion turns, every point there is first unbent or bent a little by layers that stick. After a travel delta since the
turn the tension is that of all points on both sides, which now go back along their own loops (k the curvature of a point, M_in and
M_out its moment where cable comes to the bend and where it leaves),

.. math::  T_b(\delta) = \int_0^{1/R} (M_\text{in} - M_\text{out})\,\mathrm{d}k, \quad
           M_\text{in}:\ k\,e^{-\delta/\lambda} \to k, \quad M_\text{out}:\ \min(k\,e^{\delta/\lambda}, 1/R) \to k

from -W to W; for the one element it begins with the slope K (1/R)(1/R - 2 kappa_y)/lambda = W/(2 kappa_y R lambda), K = M_y/kappa_y.
sigma is the sum of stop operators of
the position whose turns follow this curve (Iwan's parallel elements), so that it is known after any other turn as well.

Sources: bending stiffness of a rope on a sheave and its losses, Feyrer, Wire Ropes, 2nd ed. 2015, ch. 3; Leider, Draht 28
(1977); Costello, Theory of Wire Rope, 2nd ed. 1997, ch. 7; the stop: Visintin, Differential Models of Hysteresis, 1994, ch. III.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from effects.effect import ActiveEffect
from effects.effect_record import effect_record
from effects.stop_operator import sum_of_stops
from geometry.errors import InputError

Array = NDArray[np.float64]
STEPS = 200
TURNS = np.geomspace(2e-3, 8.0, 16)
"""Travels since a turn, over lambda, at which sigma is known."""
_TENSIONS, _SPEEDS = 17, 9
_REST = 1e6  # times the passage: straight cable rests so long between two
_LEAST_TENSION = 1.0
_CURVATURES, _LEG = 48, 12


@dataclass(frozen=True, repr=False)
class BendingLoss:
    """What a bend costs a cable with given laws of its section, SI.

    Parameters
    ----------
    laws : sequence of ActiveEffect
        Found in bending tests; those of the section.
    EI : float
        Linear bending stiffness [N m^2] that their strengths multiply.
    radius : float
        Of the bend [m].
    angle : float
        By which the cable is wrapped [rad]; only laws with a rate know of it.
    temperature : float
        [K].

    Raises
    ------
    InputError
        If a law does not act in the section in bending, or EI or the radius are not positive.

    Examples
    --------
    >>> from effects import find
    >>> effect = find("plasticity")
    >>> one = ActiveEffect(effect, effect.forms[0], "bending", shape=(0.1,), strength=(2.0,))
    >>> round(BendingLoss([one], 10.0, 0.25).work(500.0), 3)  # 2 (10 * 2 * 0.1) (4 - 0.2)
    15.2
    """

    laws: Sequence[ActiveEffect]
    EI: float
    radius: float
    angle: float = math.pi
    temperature: float = 293.15
    _tables: dict[Any, Any] = field(default_factory=dict, init=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "laws", tuple(self.laws))
        for name in ("EI", "radius"):
            value = getattr(self, name)
            if not (value > 0 and math.isfinite(value)):
                raise InputError(f"bending loss: {name} must be positive, found {value:g}.")
        for one in self.laws:
            if one.kind != "bending" or one.form.stage != "section" or one.form.advance is None:
                raise InputError(
                    f"{one.effect.name} ({one.kind}) is no law of the section in bending: it costs nothing at a bend. Leave it out."
                )

    def __repr__(self) -> str:
        return f"BendingLoss({json.dumps(self.record(), sort_keys=True)})"

    def record(self) -> dict[str, Any]:
        """All that it depends on."""
        return {
            "laws": [effect_record(one) for one in self.laws], "EI": self.EI, "radius": self.radius, "angle": self.angle,
            "temperature": self.temperature,
        }  # fmt: skip

    @property
    def curvature(self) -> float:
        """Of the bend [1/m]."""
        return 1 / self.radius

    @property
    def largest_tested(self) -> float:
        """Largest curvature of the tests in which the laws were found [1/m]."""
        return min((one.reference.largest for one in self.laws), default=math.inf)

    def transition(self, tension: float) -> float:
        """Length lambda within which the cable bends [m]."""
        return math.sqrt(self.EI / max(tension, _LEAST_TENSION))

    def work(self, tension: float, speed: float = 1.0) -> float:
        """W [N] at a tension and a speed of the cable."""
        return float(self.loop(np.array([tension]), speed)[0])

    def loop(self, tension: Array, speed: float) -> Array:
        """Work (n,) [N] of the second of two passages at tensions (n,)."""
        rise = self.transition(float(np.mean(tension))) / speed
        points = _Points(self, np.asarray(tension, dtype=float))
        full, work = np.full(len(tension), self.curvature), np.zeros(len(tension))
        for _ in range(2):
            work = points.to(full, rise, STEPS)
            points.to(full, self.radius * self.angle / speed)
            work += points.to(0 * full, rise, STEPS)
            points.to(0 * full, _REST * (rise + self.radius * self.angle / speed))
        return work

    def turn(self, tension: float, speed: float = 1.0) -> Array:
        """sigma (16,) at the travels 2e-3 to 8 lambda after a turn, from -1 before it to 1 in the end."""
        k0, rise = self.curvature, self.transition(tension) / speed
        middles = (np.arange(_CURVATURES) + 0.5) / _CURVATURES * k0
        k, u = (a.ravel() for a in np.meshgrid(middles, TURNS))
        full, stay = np.full(k.size, k0), self.radius * self.angle / speed
        moments = []
        for turned, leaves in ((np.minimum(k * np.exp(u), k0), False), (k * np.exp(-u), True)):
            points = _Points(self, np.full(k.size, tension))
            points.to(full, rise, _LEG)
            points.to(full, stay)
            points.to(0 * full, rise, _LEG)
            points.to(0 * full, _REST * (rise + stay))
            if leaves:
                points.to(full, rise, _LEG)
                points.to(full, stay)
            points.to(turned, rise, _LEG)
            points.to(k, rise, _LEG)
            moments.append(points.moment)
        out, back = (m.reshape(len(TURNS), -1).sum(axis=1) * k0 / _CURVATURES for m in moments)
        T = back - out  # what went in now leaves, what left now comes back
        return T / T[-1] if T[-1] > 0 else np.ones(len(TURNS))

    def stops(self, tension: float, speed: float = 1.0) -> tuple[Array, Array]:
        """Half travels d (16,) [m] and weights (16,), which sum to 1, of the stop operators."""
        risen = np.concatenate([[0.0], (1 + self.turn(tension, speed)) / 2])
        at = np.concatenate([[0.0], TURNS])
        slope = np.append(np.diff(risen) / np.diff(at), 0.0)
        weight = np.maximum(-np.diff(slope), 0.0) * TURNS
        return TURNS * self.transition(tension) / 2, weight / weight.sum()

    def resistance(self, position: Array, speed: Array, tension: Array) -> Array:
        """sigma W (n,) along a record: position [m], speed [m/s] and tension before the bend [N], (n,) each.

        The stops are those of the mean tension and of the largest speed.
        """
        fastest = float(np.abs(speed).max())
        if not self.laws or fastest == 0:
            return np.zeros(len(position))
        x = 4 * math.log2(max(float(np.mean(tension)), _LEAST_TENSION))  # four a power of two, and between them
        octave = math.ceil(math.log2(fastest)) if self._knows_rate else 0
        sense = np.zeros(len(position))
        for i, share in ((math.floor(x), math.floor(x) + 1 - x), (math.floor(x) + 1, x - math.floor(x))):
            d, w = self._keep(("stops", i, octave), lambda i=i: self.stops(2.0 ** (i / 4), 2.0**octave))
            sense += share * sum_of_stops(np.ascontiguousarray(position), d, w)
        return sense * self._work_along(speed, tension, octave)

    def _work_along(self, speed: Array, tension: Array, octave: int) -> Array:
        """W (n,), between the values of a table up to the next power of two of tension and speed."""
        top = 2.0 ** math.ceil(math.log2(max(float(tension.max()), _LEAST_TENSION)))
        at = np.linspace(0.0, top, _TENSIONS)
        if not self._knows_rate:
            return np.interp(tension, at, self._keep(("work", top), lambda: self.loop(at, 1.0)))
        speeds = 2.0 ** np.arange(octave - _SPEEDS + 1, octave + 1)
        table = self._keep(("work", top, octave), lambda: np.array([[self.work(T, v) for T in at] for v in speeds]))
        by_speed = np.array([np.interp(tension, at, row) for row in table])
        x = np.clip(np.log2(np.maximum(np.abs(speed), 1e-300) / speeds[0]), 0.0, _SPEEDS - 1.0)
        j, rows = np.minimum(x.astype(int), _SPEEDS - 2), np.arange(len(tension))
        return (1 - (x - j)) * by_speed[j, rows] + (x - j) * by_speed[j + 1, rows]

    @property
    def _knows_rate(self) -> bool:
        def asked() -> bool:
            slow, fast = self.work(1000.0, 1e-3), self.work(1000.0, 1.0)
            return abs(fast - slow) > 1e-9 * max(abs(fast), abs(slow))

        return self._keep("rate", asked)

    def _keep(self, key: Any, make: Any) -> Any:
        if key not in self._tables:
            self._tables[key] = make()
        return self._tables[key]


class _Points:
    """Material points (n,) that are bent together, each at its own tension."""

    def __init__(self, loss: BendingLoss, tension: Array) -> None:
        self.loss, self.tension = loss, tension
        self.kappa, self.temperature = np.zeros(len(tension)), np.full(len(tension), loss.temperature)
        self.states = [np.zeros((len(tension), one.form.memory)) for one in loss.laws]
        self.moment = np.zeros(len(tension))
        self.to(self.kappa, 0.0)

    def to(self, kappa: Array, duration: float, steps: int = 1) -> Array:
        """Work per length (n,) [N] of going to the curvatures (n,)."""
        begin, work = self.kappa, np.zeros(len(kappa))
        for i in range(1, steps + 1):
            after, moment = begin + (kappa - begin) * (i / steps), np.zeros(len(kappa))
            for k, one in enumerate(self.loss.laws):
                c, self.states[k] = one.advance(
                    after, self.kappa, duration / steps, self.tension, self.temperature, self.states[k]
                )
                moment += self.loss.EI * c
            work += 0.5 * (self.moment + moment) * (after - self.kappa)
            self.kappa, self.moment = after, moment
        return work

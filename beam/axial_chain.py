r"""A cable that is dragged along a straight trough, as an axial chain: the reduced model of a towing record.

With s from the towed end towards the tail and u(s, t) the displacement along the trough, positive away from the tail,

.. math::

    m\,\ddot u = -\partial_s n - \mu(|\dot u|)\, m g\cos\alpha\; z/d - c\,\dot u ,\qquad
    n = -EA\,(\partial_s u + \beta\,\partial_s\dot u), \qquad u(0,t) = p(t), \quad n(L,t) = 0

and the tension is T = n + T_tail + g sin(alpha) * (mass below). Friction is an elastic-plastic bristle: z follows u and is held
within +-d, so that a travel d mobilises it (Dahl's model without its bend; Dupont et al., IEEE Trans. Autom. Control 47
(2002) 787). The cable starts at rest, z = 0. Damping is proportional to stiffness, beta = 2 zeta / omega_1 with the first
mode of a rod whose tail is free, omega_1 = (pi / 2L) sqrt(EA / m).

Linear elements with lumped masses; Newmark's average acceleration (order 2) between the samples of the record, whose
position is a cubic spline at rest at its first sample. Friction is taken at the end of a step, with the speed there, by Newton's
method.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beam.axial_chain_step import march
from geometry.errors import ConvergenceError, InputError

Array = NDArray[np.float64]
GRAVITY = 9.81
STEPS_A_PERIOD = 48
_STEPS_A_RIPPLE = 12


@dataclass(frozen=True)
class AxialChain:
    """A cable in a trough, SI.

    Parameters
    ----------
    length : float
        Of the cable [m].
    EA : float
        Axial stiffness [N].
    mass : float
        Per length [kg/m].
    friction : float
        Coefficient on the trough.
    tail_tension : float
        [N].
    inclination : float
        [rad], positive where the towed end is the upper one.
    damping_ratio : float
        Of the first axial mode, of a cable without added load.
    presliding : float
        Travel d that mobilises the friction [m].
    added : tuple of (float, float, float)
        Further mass per length [kg/m], from s to s [m]; as often as there are loads.
    fall, fall_speed, fall_power : float
        Friction at rest above `friction`, gone with speed as fall * exp(-(v / fall_speed)^fall_power); with a power of 0
        as fall / (1 + (v / fall_speed)^2).
    drag : float
        Resistance per length and speed [N s/m^2].
    elements : int
        Of equal length.

    Raises
    ------
    InputError
        If a number has no meaning for a cable.

    Examples
    --------
    >>> chain = AxialChain(length=40.0, EA=4e5, mass=5.0, friction=0.3, tail_tension=800.0, inclination=0.0)
    >>> t = np.linspace(0.0, 20.0, 81)
    >>> run = chain.run(t, 0.05 * np.maximum(t - 1.0, 0.0) ** 2 / (1 + np.maximum(t - 1.0, 0.0)))
    >>> bool(abs(run.tension[-1] - (800.0 + 0.3 * 5.0 * 9.81 * 40.0)) < 2.0)  # tail and Coulomb friction
    True
    """

    length: float
    EA: float
    mass: float
    friction: float
    tail_tension: float = 0.0
    inclination: float = 0.0
    damping_ratio: float = 0.1
    presliding: float = 3e-4
    added: tuple[tuple[float, float, float], ...] = ()
    fall: float = 0.0
    fall_speed: float = 1.0
    fall_power: float = 1.0
    drag: float = 0.0
    elements: int = 32

    def __post_init__(self) -> None:
        for name in ("length", "EA", "mass", "presliding", "fall_speed"):
            if not getattr(self, name) > 0:
                raise InputError(f"axial chain: {name} must be positive, found {getattr(self, name):g}.")
        if self.elements < 2:
            raise InputError(f"axial chain: {self.elements} element(s) are no chain; take at least 2.")

    def excess(self, speed: float) -> float:
        """What the friction coefficient has above `friction` at a sliding speed [m/s]."""
        x = speed / self.fall_speed
        return self.fall / (1 + x**2) if self.fall_power == 0 else self.fall * math.exp(-(x**self.fall_power))

    @property
    def first_frequency(self) -> float:
        """Angular frequency of the first axial mode, tail free [rad/s]."""
        return math.pi / (2 * self.length) * math.sqrt(self.EA / self.mass)

    @property
    def damping_time(self) -> float:
        """beta = 2 zeta / omega_1 [s]."""
        return 2 * self.damping_ratio / self.first_frequency

    def mass_between(self, s: ArrayLike, end: float) -> Array:
        """Mass from the stations s to `end` [kg]."""
        begin = np.asarray(s, dtype=np.float64)
        total = self.mass * (end - begin)
        for extra, low, high in self.added:
            total = total + extra * np.maximum(min(high, end) - np.clip(begin, low, high), 0.0)
        return total

    def rest_tension(self, s: Array | float) -> Array:
        """Tension at rest with friction not mobilised: the tail and the weight below [N]."""
        below = self.mass_between(s, self.length)
        return self.tail_tension + GRAVITY * math.sin(self.inclination) * below

    def nodal_masses(self) -> Array:
        """Mass of every node [kg]: that of the half elements beside it."""
        h = self.length / self.elements
        edges = np.clip((np.arange(self.elements + 2) - 0.5) * h, 0.0, self.length)
        to_tail = self.mass_between(edges, self.length)
        return to_tail[:-1] - to_tail[1:]

    def run(
        self, time: Array, position: Array, stations: Sequence[float] = (), substeps: int | None = None
    ) -> AxialRun:
        """Tension while the towed end is led along `position`.

        Parameters
        ----------
        time, position : (n,) arrays
            Instants [s], increasing, and where the towed end is [m]; it rests at the first sample.
        stations : sequence of float
            Distances from the towed end [m] at which the tension is read as well.
        substeps : int, optional
            Steps between two samples; by default so many that the period of the first mode has 48.

        Raises
        ------
        InputError
            If a station lies outside the cable.
        ConvergenceError
            If a step finds no balance.
        """
        substeps = substeps or self.substeps(np.asarray(time, dtype=float))
        t, motion = led_motion(time, position, substeps)
        return self.led(t, motion, substeps, stations)

    def substeps(self, time: Array, shortest: float = math.inf) -> int:
        """Steps between two samples, so that the first mode has 48 in its period and a drive 12 in its `shortest` [s]."""
        step = min(2 * math.pi / self.first_frequency / STEPS_A_PERIOD, shortest / _STEPS_A_RIPPLE)
        return max(1, math.ceil(float(np.median(np.diff(time))) / step))

    def led(
        self, t: Array, motion: Array, substeps: int, stations: Sequence[float] = (), tally: bool = True
    ) -> AxialRun:
        """The same for position, speed and acceleration (m, 3) at every step, of which every `substeps`-th is read.

        The energies are counted where `tally` asks for them, and empty otherwise.
        """
        h = self.length / self.elements
        outside = [s for s in stations if not 0 <= s <= self.length]
        if outside:
            raise InputError(f"the station {outside[0]:g} m lies outside the cable, which is {self.length:g} m long.")
        M, n = self.nodal_masses(), (len(t) - 1) // substeps + 1
        out, energies = np.empty((n, self.elements + 1)), np.zeros((n if tally else 0, 6))
        stuck = march(
            np.array(t), np.array(motion), substeps, M, self.EA / h, self.damping_time, M * GRAVITY * math.cos(self.inclination),
            np.array([self.friction, self.fall, self.fall_speed, self.fall_power, self.presliding]),
            self.drag * h, out, energies,
        )  # fmt: skip
        if stuck >= 0:
            raise ConvergenceError(
                f"axial chain: no balance was found at t = {t[stuck]:.4g} s; the position may jump there, or the friction "
                "falls too steeply with speed."
            )
        at = [_read(s, h, out) + float(self.rest_tension(s)) for s in (0.0, *stations)]
        return AxialRun(t[::substeps], at[0], tuple(at[1:]), Energies(*energies.T))


@dataclass(frozen=True)
class Energies:
    """Of the motion about the state of rest, (n,) each [J]: led + lost to friction, damping, drag = stored."""

    led: Array = field(repr=False)
    kinetic: Array = field(repr=False)
    elastic: Array = field(repr=False)
    friction: Array = field(repr=False)
    damping: Array = field(repr=False)
    drag: Array = field(repr=False)

    @property
    def imbalance(self) -> Array:
        """Led in less stored and lost."""
        return self.led - self.kinetic - self.elastic - self.friction - self.damping - self.drag


@dataclass(frozen=True)
class AxialRun:
    """Tension [N] at the towed end (n,) and at every station (n,), and the energies."""

    time: Array = field(repr=False)
    tension: Array = field(repr=False)
    at: tuple[Array, ...] = field(repr=False)
    energies: Energies = field(repr=False)


def led_motion(time: Array, position: Array, substeps: int) -> tuple[Array, Array]:
    """Instants (m,) and position, speed, acceleration (m, 3) of the towed end, `substeps` between two samples."""
    if len(time) < 3:
        raise InputError("axial chain: a motion takes at least 3 samples.")
    bad = np.flatnonzero(~(np.isfinite(time) & np.isfinite(position)))
    if bad.size:
        raise InputError(f"axial chain: time or position is not finite at sample {bad[0] + 1}.")
    told = np.asarray(time, dtype=float).tobytes(), np.asarray(position, dtype=float).tobytes()
    return _led_motion(*told, substeps)


@lru_cache(maxsize=128)
def _led_motion(time_bytes: bytes, position_bytes: bytes, substeps: int) -> tuple[Array, Array]:
    from scipy.interpolate import CubicSpline

    time, position = np.frombuffer(time_bytes), np.frombuffer(position_bytes)
    parts = np.arange(substeps) / substeps
    t = np.append((time[:-1, None] + np.diff(time)[:, None] * parts).ravel(), time[-1])
    spline = CubicSpline(time, position - position[0], bc_type=((1, 0.0), (2, 0.0)))  # type: ignore[arg-type]
    motion = np.column_stack([spline(t), spline(t, 1), spline(t, 2)])
    t.setflags(write=False)
    motion.setflags(write=False)
    return t, motion


def _read(s: float, h: float, out: Array) -> Array:
    """The part of the tension beside that at rest at station s: between the ends and the middles of the elements."""
    places = np.concatenate([[0.0], (np.arange(out.shape[1] - 1) + 0.5) * h, [(out.shape[1] - 1) * h]])
    j = int(np.clip(np.searchsorted(places, s, side="right") - 1, 0, len(places) - 2))
    w = (s - places[j]) / (places[j + 1] - places[j])
    values = np.column_stack([out, np.zeros(len(out))])
    return (1 - w) * values[:, j] + w * values[:, j + 1]

r"""Slip in the grips: under load the grip slides, the measured extension is larger than the true one and stays so.

The specimen sees what is left of the path after the slip s, a length (an angle in torsion and bending) of the grips,

.. math::  \varepsilon = \frac{u - s}{L}, \qquad
           \mathrm{d}s = \lambda\,\operatorname{sign}(\varepsilon)\,\mathrm{d}M, \quad
           M = \max\bigl(\varepsilon_0,\ \max_t|\varepsilon|\bigr)

Beyond the strain epsilon_0 at which the grip gives way it slides by lambda per strain, whenever the load is larger than
ever before: it bites as it slides. Solved exactly, since on fresh ground epsilon grows by 1/(1 + lambda/L) of the path.
A grip that slides at one load without biting is not a case of its own: its loop is that of ideal plasticity.

Richer: one sudden jump, or one to either
side; a slip that grows fast at first and comes to an end, s (1 - exp(-(M - epsilon_0)/w)); grips that
bite to either side by themselves; grips that slide anew in every cycle; and creep, a speed v per strain above
epsilon_0. Where no specimen length is recorded L is 1 m. Source: a Coulomb slider with hardening in series with a spring,
e.g. Jenkins' element, Ing.-Arch. 3 (1932).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from beam.compiled import kernel
from effects.effect import Array, BenchPath, Effect, Form, Parameter, Starts, of_length, of_play, of_strain


@kernel
def _biting_kernel(x: Array, biting: float, limit: float, memory: int) -> Array:
    """memory: 0 one limit for both sides, 1 one for each side, 2 in every cycle the first limit again."""
    out = np.empty_like(x)
    slip, before = 0.0, 0.0
    limits = np.array([limit, limit])  # of negative, of positive strain
    for i in range(len(x)):
        e = x[i] - slip
        side = 1 if e > 0 else 0
        reached = max(limit, before if side == 1 else -before) if memory == 2 else limits[side]
        if abs(e) > reached:
            now = reached + (abs(e) - reached) / (1.0 + biting)
            moved = math.copysign(abs(e) - now, e)
            slip += moved
            e -= moved
            limits[side] = now
            if memory == 0:
                limits[1 - side] = now
        out[i] = before = e
    return out


@kernel
def _sudden_kernel(x: Array, jump: float, limit: float) -> Array:
    out = np.empty_like(x)
    slip, held = 0.0, True
    for i in range(len(x)):
        if held and abs(x[i]) > limit:
            slip, held = math.copysign(jump, x[i]), False
        out[i] = x[i] - slip
    return out


@kernel
def _sudden_to_either_side_kernel(x: Array, jump: float, limit: float) -> Array:
    out = np.empty_like(x)
    up, down = 0.0, 0.0
    for i in range(len(x)):
        if x[i] > limit:
            up = jump
        elif x[i] < -limit:
            down = jump
        out[i] = x[i] - up + down
    return out


@kernel
def _ending_kernel(x: Array, whole: float, limit: float, width: float) -> Array:
    out = np.empty_like(x)
    slip, reached = 0.0, limit
    for i in range(len(x)):
        e = x[i] - slip
        if abs(e) > reached:
            left = whole * math.exp(-(reached - limit) / width)
            now = reached
            for _ in range(60):  # Newton from below on an increasing concave function: it never overshoots
                gone = left * math.exp(-(now - reached) / width)
                step = (abs(e) - now - (left - gone)) / (1.0 + gone / width)
                now += step
                if abs(step) <= 1e-14 * abs(e):
                    break
            moved = math.copysign(abs(e) - now, e)
            slip += moved
            e -= moved
            reached = now
        out[i] = e
    return out


@kernel
def _creep_kernel(x: Array, time: Array, rate: float, limit: float) -> Array:
    """de/dt = dx/dt - rate (|e| - limit)+, exactly for a path that is straight between the samples."""
    out = np.empty_like(x)
    out[0] = e = x[0]
    for i in range(1, len(x)):
        left = time[i] - time[i - 1]
        q = (x[i] - x[i - 1]) / left
        for _ in range(4):  # at most: slide back, cross, slide on
            v = math.copysign(q, q * e)  # speed away from zero
            beyond = abs(e) - limit
            if beyond < 0.0 or (beyond == 0.0 and v <= 0.0):
                until = (math.copysign(limit, q) - e) / q if q != 0.0 else left
                if until >= left:
                    e += q * left
                    break
                e = math.copysign(limit, q)
            else:
                until = math.log1p(-beyond * rate / v) / rate if v < 0.0 else left
                if until >= left:
                    gone = -math.expm1(-rate * left)
                    e = math.copysign(limit + beyond * (1.0 - gone) + v * gone / rate, e)
                    break
                e = math.copysign(limit, e)
            left -= until
        out[i] = e
    return out


def _biting(memory: int) -> Callable[[BenchPath, float, float], Array]:
    def respond(path: BenchPath, slip: float, limit: float) -> Array:
        return _biting_kernel(_strain(path), slip / _length(path), float(limit), memory)

    return respond


def _sudden(path: BenchPath, slip: float, limit: float) -> Array:
    return _sudden_kernel(_strain(path), slip / _length(path), float(limit))


def _sudden_to_either_side(path: BenchPath, slip: float, limit: float) -> Array:
    return _sudden_to_either_side_kernel(_strain(path), slip / _length(path), float(limit))


def _ending(path: BenchPath, slip: float, limit: float, width: float) -> Array:
    if slip == 0.0:
        return path.strain
    if width < 1e-6 * path.largest:
        return _sudden(path, slip, limit)
    return _ending_kernel(_strain(path), slip / _length(path), float(limit), float(width))


def _creep(path: BenchPath, speed: float, limit: float) -> Array:
    if path.time is None or speed <= 0.0:
        return path.strain
    time = np.ascontiguousarray(path.time, dtype=float)
    return _creep_kernel(_strain(path), time, speed / _length(path), max(float(limit), 1e-30))


def _strain(path: BenchPath) -> Array:
    return np.ascontiguousarray(path.strain, dtype=float)


def _length(path: BenchPath) -> float:
    return float(path.length or 1.0)


def _of_speed(paths: Sequence[BenchPath]) -> Array:
    """Speeds that let a record's length of cable slide in the longest record, and up to hundred times faster."""
    spans = [float(p.time[-1] - p.time[0]) for p in paths if p.time is not None and len(p.time) > 1]
    lengths = [p.length for p in paths if p.length is not None]
    return np.geomspace(0.03, 100.0, 8) * (min(lengths) if lengths else 1.0) / (max(spans) if spans else 1.0)


def _limit(m: int, low: float = 0.05, high: float = 0.9) -> Parameter:
    return Parameter(
        "limit",
        "strain",
        "strain of the specimen at which the grip gives way",
        source="no common value",
        starts=of_strain(low, high, m),
    )


def _slide(starts: Starts) -> Parameter:
    meaning = "slip per strain beyond the limit: the length of cable that would give as much"
    return Parameter("slip", "m", meaning, plausible=(0.0, 10.0), source=_SEEN, starts=starts)


def _way(m: int) -> Parameter:
    source = "wedge and cone grips draw in by 0.1 to 20 mm; clamped jackets creep by centimetres"
    return Parameter(
        "slip", "play", "the whole slip", plausible=(0.0, 0.1), source=source, starts=of_play(0.01, 1.0, m)
    )


_SEEN = "slips of 0.1 to 50 mm at strains of 0.1 to 2 % beyond the limit"
_WIDTH = Parameter(
    "width",
    "strain",
    "strain beyond the limit in which it comes to an end",
    source="no common value",
    starts=of_strain(0.03, 1.0, 4),
)
_SPEED = Parameter(
    "speed", "m/s", "speed of the slip per strain beyond the limit", source="no common value", starts=_of_speed
)

EFFECT = Effect(
    name="grip-slip",
    kind="rig",
    title="the grip slides under load: measured extension is larger than the true one, and does not come back",
    equation="strain = (u - s)/L, ds = slip sign(strain) d max(limit, max|strain|)",
    source="Coulomb slider with hardening in series with a spring, e.g. Jenkins, Ing.-Arch. 3 (1932)",
    needs="loads beyond the limit and back; two specimen lengths tell it from a yielding cable, whose strain does not go"
    " with 1/L",
    signature="straight up to the limit, then flatter; unloading is parallel to the first line and ends at a slip that"
    " stays; a second cycle to the same load is straight; shorter specimens show more",
    kinds=("tension", "torsion", "bending", "shear"),
    forms=(
        Form("bites as it slides", "fixture", _biting(0), shape=(_slide(of_length(0.01, 10.0, 8)), _limit(8))),
        Form("one sudden slip", "fixture", _sudden, shape=(_way(8), _limit(16))),
        Form("one sudden slip to either side", "fixture", _sudden_to_either_side, shape=(_way(8), _limit(16))),
        Form("comes to an end", "fixture", _ending, shape=(_way(6), _limit(5), _WIDTH)),
        Form("bites to either side", "fixture", _biting(1), shape=(_slide(of_length(0.01, 10.0, 8)), _limit(8))),
        Form("slides in every cycle", "fixture", _biting(2), shape=(_slide(of_length(0.01, 10.0, 8)), _limit(8))),
        Form("creeps under load", "fixture", _creep, shape=(_SPEED, _limit(6, 0.01))),
    ),
)

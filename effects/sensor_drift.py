r"""Drift of a sensor: a bias of a channel that starts at zero with every record and grows with time.

.. math::  y = y_\text{true} + r\,t

Richer: a drift as the square root of time (diffusion of heat into the sensor), one that settles,
r (1 - exp(-t/tau)) (warming up), and one that bends, r1 t + r2 t^2. A record without a clock has no drift here. Source:
JCGM 200:2012 (VIM), instrumental drift.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from effects.effect import Array, BenchPath, Effect, Form, Parameter, of_time


def _since_start(path: BenchPath) -> Array:
    return np.zeros(len(path.strain)) if path.time is None else path.time - path.time[0]


def _linear(path: BenchPath) -> Array:
    return _since_start(path)[:, None]


def _root(path: BenchPath) -> Array:
    return np.sqrt(_since_start(path))[:, None]


def _settling(path: BenchPath, tau: float) -> Array:
    t = _since_start(path)
    return (-np.expm1(-t / tau) if tau > 0 else (t > 0).astype(float))[:, None]


def _bent(path: BenchPath) -> Array:
    t = _since_start(path)
    return np.column_stack([t, t**2])


def needs_clock(paths: Sequence[BenchPath]) -> str | None:
    """The sentence why records without a clock cannot show an effect of time, or None if one has a clock."""
    if all(p.time is None for p in paths):
        return 'no record has a clock; add the column "time [s]" to the tables'
    return None


def _rate(name: str, unit: str, meaning: str) -> Parameter:
    return Parameter(name, unit, meaning, low=-np.inf, plausible=(-np.inf, np.inf), source=_SHEET)


def _form(name: str, respond: Callable[..., Array], *strength: Parameter, shape: tuple[Parameter, ...] = ()) -> Form:
    return Form(name, "bias", respond, shape=shape, strength=strength)


_SHEET = "depends on the sensor: compare it with the drift in its data sheet"
_TAU = Parameter("tau", "s", "time in which it settles", source="no common value", starts=of_time(10, 2.0, 2.0))

EFFECT = Effect(
    name="sensor-drift",
    kind="sensor",
    title="bias of a channel that grows with time",
    equation="y = y_true + rate t, t from the start of each record",
    source="JCGM 200:2012 (VIM), instrumental drift",
    needs="a clock, and records of unlike duration or with the same path more than once",
    signature="the loop does not close and wanders one way in proportion to time; the first sample is right; a slower"
    " record of the same path wanders more",
    kinds=("tension", "torsion", "bending", "shear", "towing"),
    forms=(
        _form("proportional to time", _linear, _rate("rate", "channel/s", "growth of the bias")),
        _form("root of time", _root, _rate("rate", "channel/s^0.5", "growth of the bias with the root of time")),
        _form("settling", _settling, _rate("final", "channel", "bias after a long time"), shape=(_TAU,)),
        _form(
            "bent", _bent, _rate("rate", "channel/s", "growth at the start"),
            _rate("acceleration", "channel/s^2", "coefficient of time squared"),
        ),
    ),
    why_untestable=needs_clock,
)  # fmt: skip

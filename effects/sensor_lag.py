r"""Lag of a sensor: the channel follows the truth with a delay, as a first-order low-pass does.

.. math::  \tau\,\dot y + y = x, \qquad y(0) = x(0)

solved exactly for a signal that is straight between the samples. Richer: two such stages in series, and a pure delay
y(t) = x(t - d). A record without a clock is read as slow: its signal is left as it is. Source: the first-order
instrument, e.g. Doebelin, Measurement Systems, ch. 3.
"""

from __future__ import annotations

import math

import numpy as np

from beam.compiled import kernel
from effects.effect import Array, Effect, Form, Parameter, of_time
from effects.sensor_drift import needs_clock


@kernel
def _first_order_kernel(x: Array, time: Array, tau: float) -> Array:
    n, k = x.shape
    y = np.empty_like(x)
    y[0] = x[0]
    for i in range(1, n):
        h = (time[i] - time[i - 1]) / tau
        gone = -math.expm1(-h)  # part of the difference that is made up in this step
        for j in range(k):
            ramp = (x[i, j] - x[i - 1, j]) * gone / h
            y[i, j] = x[i, j] - ramp + (y[i - 1, j] - x[i - 1, j]) * (1.0 - gone)
    return y


@kernel
def _second_order_kernel(x: Array, time: Array, fast: float, slow: float) -> Array:
    n, k = x.shape
    y = np.empty_like(x)
    y[0] = x[0]
    first = x[0].copy()
    for i in range(1, n):
        h = time[i] - time[i - 1]
        a, b = math.exp(-h / fast), math.exp(-h / slow)
        z = h * (fast - slow) / (fast * slow)
        mixed = b * h / slow * (math.expm1(z) / z if z < -1e-9 else 1.0)  # of the first stage in the second
        for j in range(k):
            q = (x[i, j] - x[i - 1, j]) / h
            start = first[j] - x[i - 1, j] + q * fast
            first[j] = x[i, j] - q * fast + start * a
            rest = y[i - 1, j] - x[i - 1, j] + q * (fast + slow)
            y[i, j] = x[i, j] - q * (fast + slow) + start * mixed + rest * b
    return y


def _first_order(signal: Array, time: Array | None, tau: float) -> Array:
    if time is None or tau <= 0:
        return signal
    columns = np.ascontiguousarray(signal.reshape(len(signal), -1), dtype=float)
    return _first_order_kernel(columns, np.ascontiguousarray(time, dtype=float), float(tau)).reshape(signal.shape)


def _second_order(signal: Array, time: Array | None, tau: float, tau_2: float) -> Array:
    fast, slow = sorted((float(tau), float(tau_2)))
    if time is None or fast <= 0:
        return _first_order(signal, time, slow)
    columns = np.ascontiguousarray(signal.reshape(len(signal), -1), dtype=float)
    return _second_order_kernel(columns, np.ascontiguousarray(time, dtype=float), fast, slow).reshape(signal.shape)


def _delay(signal: Array, time: Array | None, delay: float) -> Array:
    if time is None or delay <= 0:
        return signal
    columns = signal.reshape(len(signal), -1)
    moved = [np.interp(time - delay, time, column) for column in columns.T]
    return np.column_stack(moved).reshape(signal.shape)


_SOURCE = (
    "strain-gauge bridges with filters of 1 to 1000 Hz: 0.2 ms to 0.2 s; slow loggers and pneumatic cells up to minutes"
)


def _time(name: str, meaning: str, m: int) -> Parameter:
    return Parameter(name, "s", meaning, plausible=(0.0, 300.0), source=_SOURCE, starts=of_time(m, 0.1, 0.5))


EFFECT = Effect(
    name="sensor-lag",
    kind="sensor",
    title="first-order lag of a channel",
    equation="tau dy/dt + y = x, y(0) = x(0)",
    source="first-order instrument, e.g. Doebelin, Measurement Systems, ch. 3",
    needs="a clock, and the same path at two rates at least: at one rate a lag and viscous damping look alike",
    signature="a loop on which the channel comes late: wide where the path is fast, gone where it rests; the channels of"
    " other sensors keep time",
    kinds=("tension", "torsion", "bending", "shear", "towing"),
    forms=(
        Form("first order", "filter", _first_order, shape=(_time("tau", "time constant", 14),)),
        Form(
            "two stages", "filter", _second_order,
            shape=(_time("tau", "time constant of one stage", 8), _time("second tau", "time constant of the other stage", 8)),
        ),
        Form("pure delay", "filter", _delay, shape=(_time("delay", "time by which it is late", 14),)),
    ),
    why_untestable=needs_clock,
)  # fmt: skip

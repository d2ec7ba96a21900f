r"""The forward model of the bench with effects: what the channels read when effects are switched on.

.. math::  y = \text{bias} + \text{filter}\bigl[ K\,(\varepsilon + \textstyle\sum_j a_j c_j(\varepsilon)) \bigr],
           \qquad \varepsilon = \text{fixture}(\text{path}/L)

Where the load F was prescribed the path is found from the whole history at once,

.. math::  \varepsilon \leftarrow \varepsilon + \omega\,\frac{F - \text{load}(\varepsilon)}{K} ,

which converges because every law is causal and stiffens by less than 1/omega; omega is halved whenever the residual
grows, or goes round without coming nearer.
Without effects this is the linear model of :mod:`compare.bench_model`, to the last digit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from compare.bench_path import LedPath, bench_paths, load_controlled, load_per_strain, path_length
from compare.experiment import Experiment
from compare.kinds import KINDS
from effects.effect import ActiveEffect, BenchPath
from geometry.errors import ConvergenceError

if TYPE_CHECKING:
    from compare.bench_model import BenchModel

Array = NDArray[np.float64]
_MOST_ROUNDS = 400
_AT_REST = 1e-9
_NO_NEARER = 8


def respond(model: BenchModel, experiment: Experiment, before: Sequence[Experiment] = ()) -> dict[str, Array]:
    """Readings of every measured channel of an experiment, shape (n,), SI.

    Parameters
    ----------
    model : BenchModel
        With effects.
    experiment : Experiment
        Open.
    before : sequence of Experiment
        Open experiments among which those may be that it continues.

    Raises
    ------
    ConvergenceError
        If no path carries a prescribed load.
    """
    active = [a for a in model.effects if a.kind == experiment.kind and not a.neutral]
    led = _path(model, experiment, before, active)
    K = load_per_strain(model, experiment)
    kind, record, lead = KINDS[experiment.kind], experiment.record, led.lead
    if load_controlled(experiment):
        led = replace(led, path=led.path.with_strain(_carrying(led.path, K, active, experiment.id)))
    load = K * _load_strain(led.path, active)
    time = None if led.path.time is None else led.path.time[lead:] - led.path.time[lead]
    readings = {}
    for channel in record.measured:
        if channel == kind.load:
            y = load[lead:]
        elif channel in kind.paths:
            y = led.path.strain[lead:] * path_length(experiment, channel)
        else:
            inside = _inside(led.path, active).strain
            y = (model.stiffness("coupling") * inside + K * _columns(led.path, active, "cross"))[lead:]
        readings[channel] = _sensed(y, time, led, active, channel)
    return readings


def _path(
    model: BenchModel, experiment: Experiment, before: Sequence[Experiment], active: Sequence[ActiveEffect]
) -> LedPath:
    """The path with the scales of the experiments that the effects were fitted to."""
    chain = [experiment]
    by_id = {e.id: e for e in before if e.is_open}
    while (previous := chain[-1].continues) is not None and previous in by_id and by_id[previous] not in chain:
        chain.append(by_id[previous])
    led = bench_paths(chain, model)[experiment.id]
    if not active:
        return led
    scales = active[0].reference
    path = replace(
        led.path,
        largest=scales.largest,
        typical_tension=scales.typical_tension,
        typical_temperature=scales.typical_temperature,
    )
    return replace(led, path=path)


def _inside(path: BenchPath, active: Sequence[ActiveEffect]) -> BenchPath:
    for a in active:
        if a.form.stage == "fixture":
            path = path.with_strain(a.form.respond(path, *a.shape))
    return path


def _columns(path: BenchPath, active: Sequence[ActiveEffect], stage: str) -> Array:
    """Strain that the effects of a stage add inside the fixtures."""
    inside = _inside(path, active)
    total = np.zeros(len(path.strain))
    for a in active:
        if a.form.stage == stage:
            c = a.form.respond(inside, *a.shape)
            total += (c[:, None] if c.ndim == 1 else c) @ np.asarray(a.strength)
    return total


def _load_strain(path: BenchPath, active: Sequence[ActiveEffect]) -> Array:
    """Load over K for a path."""
    return _inside(path, active).strain + _columns(path, active, "section")


def _carrying(path: BenchPath, K: float, active: Sequence[ActiveEffect], name: str) -> Array:
    """The strain under which the load over K is what was prescribed; `path` holds that of the linear model."""
    wanted = path.strain
    size = max(float(np.abs(wanted).max()), 1e-300)
    strain, omega, last = wanted.copy(), 1.0, np.inf
    best, nearest, since = strain, np.inf, 0
    for _ in range(_MOST_ROUNDS):
        residual = wanted - _load_strain(path.with_strain(strain), active)
        error = float(np.abs(residual).max())
        if error <= _AT_REST * size:
            return strain
        since += 1
        if error < nearest:
            best, nearest, since = strain, error, 0
        if error > 1.5 * last:
            omega /= 2
        last = error
        strain = strain + omega * residual
        if since >= _NO_NEARER:  # round and round the solution: smaller steps from where it was nearest
            strain, omega, last, since = best, omega / 2, np.inf, 0
    if nearest > 1e-4 * size:
        raise ConvergenceError(
            f"experiment {name}: no path was found that carries the prescribed load; a residual of {nearest / size:.1%} is "
            "left. A law that softens or slips without bound cannot be driven by its load."
        )
    return best


def _sensed(y: Array, time: Array | None, led: LedPath, active: Sequence[ActiveEffect], channel: str) -> Array:
    for a in active:
        if a.form.stage == "filter" and a.channel == channel:
            y = a.form.respond(y[:, None], time, *a.shape)[:, 0]
    own = BenchPath(led.path.kind, led.path.strain[led.lead :], time, led.path.length)
    for a in active:
        if a.form.stage == "bias" and a.channel == channel:
            c = a.form.respond(own, *a.shape)
            y = y + (c[:, None] if c.ndim == 1 else c) @ np.asarray(a.strength)
    return y

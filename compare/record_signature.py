r"""What one record shows beside the calibrated linear model: single numbers, each with its standard deviation.

With the reading y of a record, the signal m of the linear model, u = m / max|m| and r = y - m, all numbers but the last
are coefficients of generalised least squares with the noise covariance of the channel,

.. math::

    y &= x\, m & \text{stiffness ratio}\; x \\
    r &= (b) + c\,u + \dots & \text{beside:}\;
    t;\quad \dot m;\quad \operatorname{sgn}\dot u;\quad u\,[\text{first loading}];\quad T_2(u), T_3(u)

that is a constant, a trend in time, a lag (r = -tau dm/dt to first order), the half width of a loop, the stiffness of
first loading over later, and the second and third Chebyshev polynomial, which on a sine are the second and third harmonic.
On a path of one sign T_2 runs over that side. The loss factor of a closed loop is its energy over 2 pi times the stored one,

.. math::  \eta = \frac{\oint r\,\mathrm{d}u}{\pi a^2},\qquad a = (\max u - \min u)/2 .

Where the load was prescribed the residual of the path is turned round, so that every sign reads as one of the load.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from compare.bench_path import LedPath, bench_paths, load_controlled
from compare.comparison import ChannelFit, Comparison
from compare.kinds import KINDS
from compare.noise_covariance import NoiseCovariance
from compare.towing_signature import towing_columns, towing_conditions

Array = NDArray[np.float64]
Number = tuple[float, float]
_TWO_SIDED = 0.3  # of the largest path, which the other side must reach
_CLOSED = 0.05  # of the span, between the ends of a closed path
_FEWEST_CYCLES = 0.9
_FIRST_LOADING = (0.03, 0.9)  # part of the samples between which first and later loading can be compared
_FEWEST = 12


@dataclass(frozen=True)
class RecordSignature:
    """Numbers (value, std) of one record by name, and the conditions it was taken under.

    `numbers` may hold ``stiffness``, ``offset``, ``trend``, ``lag``, ``direction``, ``history``, ``even``, ``odd``,
    ``curvature``, ``loop`` and, for the other load, ``cross``; of a towing record ``offset``, ``trend``, ``sense``, ``speed`` and
    ``reversal`` (:mod:`compare.towing_signature`). `conditions` holds ``amplitude`` (largest path per length), ``rate``
    (frequency of loading: mean rate over four amplitudes [1/s]), ``axial tension`` [N], ``temperature`` [K], ``length`` [m].
    """

    fit: ChannelFit = field(repr=False)
    numbers: Mapping[str, Number]
    conditions: Mapping[str, float]

    @property
    def group(self) -> str:
        """The experiment that this one repeats, or itself."""
        return self.fit.experiment.repeat_of or self.fit.experiment.id


def record_signatures(comparison: Comparison, set_name: str = "calibrate") -> list[RecordSignature]:
    """Of every compared channel of a set; channels without a signal in the model show only ``offset`` and ``cross``."""
    fits = [f for f in comparison.fits if f.experiment.set == set_name and len(f.measured) >= _FEWEST]
    experiments = list({f.experiment.id: f.experiment for f in fits}.values())
    paths = bench_paths(experiments, comparison.model.linear)
    found = []
    for fit in fits:
        led, noise = paths[fit.experiment.id], comparison.noise.of(fit.experiment, fit.channel)
        if not np.ptp(led.path.strain[led.lead :]) > 0:
            continue
        if fit.experiment.kind == "towing":
            numbers = _towing_numbers(fit, led, noise, comparison)
            found.append(RecordSignature(fit, numbers, towing_conditions(fit, led)))
            continue
        kind = KINDS[fit.experiment.kind]
        main = fit.channel == kind.load or fit.channel in kind.paths
        if main and not fit.model.any():
            continue
        numbers = _main_numbers(fit, led, noise) if main else _cross_numbers(fit, led, noise)
        found.append(RecordSignature(fit, numbers, _conditions(fit, led)))
    return found


def towing_paths(
    comparison: Comparison, fits: Sequence[ChannelFit]
) -> list[tuple[ChannelFit, LedPath, NoiseCovariance]]:
    """Towing records with the told path and the noise of each."""
    experiments = list({f.experiment.id: f.experiment for f in fits}.values())
    paths = bench_paths(experiments, comparison.model.linear)
    return [(f, paths[f.experiment.id], comparison.noise.of(f.experiment, f.channel)) for f in fits]


def _towing_numbers(fit: ChannelFit, led: LedPath, noise: NoiseCovariance, comparison: Comparison) -> dict[str, Number]:
    assert comparison.model.towing is not None
    columns = towing_columns(led, comparison.model.towing.presliding)
    told = np.column_stack([fit.measured - fit.model, *columns.values()])
    white = dict(zip(("r", *columns), noise.whiten(told, fit.model).T, strict=True))
    found: dict[str, Number | None] = {}
    for name in columns:
        found["offset" if name == "1" else "trend" if name == "t" else name] = _gls(
            white, "r", [name, *(c for c in columns if c != name)]
        )
    return {k: v for k, v in found.items() if v is not None and np.isfinite(v).all() and v[1] > 0}


def _conditions(fit: ChannelFit, led: LedPath) -> dict[str, float]:
    path, given = led.path, fit.experiment.conditions
    strain = path.strain[led.lead :]
    largest = float(np.abs(strain).max())
    found = {"amplitude": largest}
    if path.time is not None:
        duration = float(path.time[-1] - path.time[led.lead])
        travelled = float(np.abs(np.diff(strain)).sum())
        if duration > 0 and travelled > 0:
            found["rate"] = travelled / duration / (4 * largest)
    wanted = {"axial tension": "axial tension", "temperature": "temperature", "length": "specimen length"}
    found |= {name: given[column] for name, column in wanted.items() if column in given}
    return found


def _main_numbers(fit: ChannelFit, led: LedPath, noise: NoiseCovariance) -> dict[str, Number]:
    flip = -1.0 if load_controlled(fit.experiment) else 1.0
    m, size = fit.model, float(np.abs(fit.model).max())
    u, r = m / size, flip * (fit.measured - m)
    columns = {"r": r, "y": fit.measured, "1": np.ones(len(u)), "u": u, **_shapes(u, led)}
    white = dict(zip(columns, noise.whiten(np.column_stack(list(columns.values())), m).T, strict=True))
    numbers = {"stiffness": _gls(white, "y", ["u"])}
    numbers["offset"] = _gls(white, "r", ["1", "u"])
    numbers["trend"] = _gls(white, "r", ["t", "1", "u"])
    numbers["lag"] = _gls(white, "r", ["rate", "1", "u"])
    numbers["direction"] = _gls(white, "r", ["direction", "1", "u"])
    numbers["history"] = _gls(white, "r", ["history", "direction", "1", "u"])
    numbers["even"] = _gls(white, "r", ["T2", "T3", "1", "u"])
    numbers["odd"] = _gls(white, "r", ["T3", "T2", "1", "u"])
    numbers["curvature"] = _gls(white, "r", ["side", "1", "u"])
    numbers["loop"] = _loss_factor(r / size, u, noise, size, m)
    scale = dict.fromkeys(("stiffness", "direction", "history", "even", "odd", "curvature"), 1 / size)
    scale |= {"offset": flip, "trend": flip, "lag": -1 / size}
    made = {k: (v[0] * scale.get(k, 1.0), v[1] * abs(scale.get(k, 1.0))) for k, v in numbers.items() if v is not None}
    if flip < 0 and made["stiffness"][0] > 0:
        x, std = made["stiffness"]
        made["stiffness"] = 1 / x, std / x**2
    return {k: v for k, v in made.items() if np.isfinite(v).all() and v[1] > 0}


def _shapes(u: Array, led: LedPath) -> dict[str, Array]:
    """The columns that this path can show; `rate` is dm/dt over max|m|."""
    found = {}
    path, lead = led.path, led.lead
    if path.time is not None and path.time[-1] > path.time[lead]:
        t = path.time[lead:] - path.time[lead]
        found |= {"t": t, "rate": np.gradient(u, t)}
    motion = np.gradient(u)
    turning = float(np.abs(motion).max()) * 1e-3
    direction = np.where(np.abs(motion) > turning, np.sign(motion), 0.0)
    if min(np.mean(direction > 0), np.mean(direction < 0)) > _FIRST_LOADING[0]:
        found["direction"] = direction
        reached = np.abs(path.strain)
        first = (reached >= (1 - 1e-9) * np.maximum.accumulate(reached))[lead:]
        if _FIRST_LOADING[0] < np.mean(first) < _FIRST_LOADING[1]:
            found["history"] = u * first
    other = min(-float(u.min()), float(u.max()))
    if other > _TWO_SIDED:
        found |= {"T2": 2 * u**2 - 1, "T3": 4 * u**3 - 3 * u}
    elif other < 0.1 * _TWO_SIDED:
        side = 1.0 if u.max() > -u.min() else -1.0
        found["side"] = side * (2 * (2 * np.abs(u) - 1) ** 2 - 1)
    return found


def _cross_numbers(fit: ChannelFit, led: LedPath, noise: NoiseCovariance) -> dict[str, Number]:
    """Of a load beside the path: how it moves with the path, in units of the channel at the largest path."""
    strain = led.path.strain[led.lead :]
    columns = np.column_stack([fit.measured - fit.model, np.ones(len(strain)), strain / np.abs(strain).max()])
    white: dict[str, Array] = dict(zip(("r", "1", "u"), noise.whiten(columns, fit.model).T, strict=True))
    found = {"offset": _gls(white, "r", ["1", "u"]), "cross": _gls(white, "r", ["u", "1"])}
    return {k: v for k, v in found.items() if v is not None}


def _gls(white: Mapping[str, Array], target: str, names: Sequence[str]) -> Number | None:
    """Coefficient of the first of the columns beside the others, and its std; None where they cannot tell."""
    if not all(name in white for name in names):
        return None
    X = np.column_stack([white[name] for name in names])
    length = np.linalg.norm(X, axis=0)
    if not (length > 0).all():
        return None
    X = X / length
    S = X.T @ X
    if np.linalg.eigvalsh(S)[0] < 1e-9:
        return None
    inverse = np.linalg.inv(S)
    value = float((inverse @ (X.T @ white[target]))[0])
    return value / float(length[0]), float(np.sqrt(inverse[0, 0])) / float(length[0])


def _loss_factor(r: Array, u: Array, noise: NoiseCovariance, size: float, signal: Array) -> Number | None:
    span = float(np.ptp(u))
    if abs(u[-1] - u[0]) > _CLOSED * span:
        return None
    cycles = float(np.abs(np.diff(u)).sum()) / (2 * span)
    if cycles < _FEWEST_CYCLES:
        return None
    weights = np.empty(len(u))
    weights[1:-1] = (u[2:] - u[:-2]) / 2
    weights[0], weights[-1] = (u[1] - u[0]) / 2, (u[-1] - u[-2]) / 2
    scale = 1 / (cycles * np.pi * (span / 2) ** 2)
    return float(weights @ r) * scale, std_of_sum(weights, noise, signal) / size * scale


def std_of_sum(weights: Array, noise: NoiseCovariance, signal: Array) -> float:
    """Standard deviation of sum w_i e_i of the noise e of one record: sqrt(w^T C w), in O(n).

    Examples
    --------
    >>> round(std_of_sum(np.full(4, 0.25), NoiseCovariance(s=2.0), np.zeros(4)), 12)
    1.0
    """
    forward = lfilter([1.0], [1.0, -noise.phi], weights)
    backward = lfilter([1.0], [1.0, -noise.phi], weights[::-1])[::-1]
    of_samples = noise.s**2 * float(weights @ (forward + backward - weights)) + noise.white**2 * float(
        weights @ weights
    )
    of_records = (noise.gain * float(weights @ signal)) ** 2 + (noise.offset * float(weights.sum())) ** 2
    return float(np.sqrt(max(of_samples, 0.0) + of_records))

r"""What one towing record shows beside the calibrated chain: single numbers, each with its standard deviation.

With r = measured - model of a channel, the told position p and its speed v, and the sense of the motion sigma = z/d mobilised over
the travel d of the trough's friction, all but the last are coefficients of generalised least squares in

.. math::  r = b + c\,\sigma + \dots, \qquad \text{beside:}\; t;\quad v;\quad \sigma\,[\text{first 5 \% of the stroke after a reversal}]

that is a constant, resistance against the motion, a trend in time, a part in proportion to the speed, and what comes after a
reversal. A ripple whose period is a length of travel lambda is looked for in all records of a channel together: the fall of the
square residual by cos(2 pi p / lambda) and sin(2 pi p / lambda) beside the others, as a periodogram (Lomb 1976, Astrophys. Space Sci. 39,
447). It counts if it stands clear of every other period, so that a broad misfit is no ripple, and is judged against the median.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc, chdtri

from compare.bench_path import LedPath
from compare.comparison import ChannelFit
from compare.noise_covariance import NoiseCovariance
from effects.stop_operator import stop

Array = NDArray[np.float64]
AFTER = 0.05
"""Part of the stroke that counts as being after a reversal."""
_TURNED = 1e-3  # of the stroke, by which the drive has to come back to have turned
_FEWEST_PERIODS, _SAMPLES_A_PERIOD, _MOST_PERIODS = 4.0, 3.0, 300.0
_LINE, _CLEAR = 2.0, 3.0  # half width of a line, in periods over the longest stroke; how far it stands above all others


def towing_columns(led: LedPath, presliding: float) -> dict[str, Array]:
    """The columns that a towing record can show, (n,) each: ``1``, ``t``, ``sense``, ``speed`` and ``reversal``."""
    p, t = led.path.strain, led.path.time
    assert t is not None
    found = {"1": np.ones(len(p)), "t": t - t[0], "sense": stop(p, presliding, 0.0) / presliding}
    speed = np.gradient(p, t)
    if speed.any():
        found["speed"] = speed
    after = after_reversals(p)
    if after.any():
        found["reversal"] = after
    return found


def after_reversals(position: Array) -> Array:
    """The sense of the motion over the first 5 % of the stroke after every reversal, 0 elsewhere, (n,).

    Examples
    --------
    >>> after_reversals(np.array([0.0, 1.0, 2.0, 1.98, 1.92, 1.0])).tolist()
    [0.0, 0.0, 0.0, -1.0, -1.0, 0.0]
    """
    stroke = float(np.ptp(position))
    found, sense, turn, begin = np.zeros(len(position)), 0.0, float(position[0]), None
    for i, p in enumerate(position.tolist()):
        if sense == 0.0 and abs(p - turn) > _TURNED * stroke:
            sense, turn = math.copysign(1.0, p - turn), p
        elif sense * (turn - p) > _TURNED * stroke:
            sense, begin, turn = -sense, turn, p
        elif sense * (p - turn) > 0:
            turn = p
        if begin is not None and abs(p - begin) < AFTER * stroke:
            found[i] = sense
    return found


def towing_conditions(fit: ChannelFit, led: LedPath) -> dict[str, float]:
    """Mean tension [N], inclination [rad], largest speed [m/s] and stroke [m] of a record."""
    p, t = led.path.strain, led.path.time
    assert t is not None
    given = fit.experiment.conditions
    found = {"stroke": float(np.ptp(p)), "speed": float(np.abs(np.gradient(p, t)).max())}
    found["mean tension"] = float(np.mean(fit.model))
    return found | ({"inclination": given["inclination"]} if "inclination" in given else {})


@dataclass(frozen=True)
class TravelRipple:
    """The dominant ripple over the travel: its period [m], amplitude and its std, and the chance that there is none."""

    period: float
    amplitude: float
    std: float
    chance: float


def travel_ripple(
    records: Sequence[tuple[ChannelFit, LedPath, NoiseCovariance]], presliding: float
) -> TravelRipple | None:
    """Of one channel in all its records; None where none is long enough, or sampled often enough, to show one."""
    numbers = _wave_numbers([led.path.strain for _, led, _ in records])
    if not numbers.size:
        return None
    power, squares, weight, dof = (np.zeros(len(numbers)) for _ in range(4))
    for fit, led, noise in records:
        told = _SAMPLES_A_PERIOD * float(np.abs(np.diff(led.path.strain)).max()) <= 2 * math.pi / numbers
        if told.any():
            fall, amplitude2, variance = _periodogram(fit, led, noise, presliding, numbers[told])
            power[told] += fall
            squares[told] += amplitude2 / variance
            weight[told] += 1 / variance
            dof[told] += 2
    numbers, power, squares, weight, dof = (x[dof > 0] for x in (numbers, power, squares, weight, dof))
    if len(numbers) < _FEWEST_PERIODS:
        return None
    level = max(float(np.median(power / chdtri(dof, 0.5))), 1.0)
    best = int(np.argmax(power))
    away = np.abs(numbers - numbers[best]) > _LINE * 2 * math.pi / max(float(np.ptp(r[1].path.strain)) for r in records)
    if power[best] < _CLEAR * float(np.max(power[away], initial=0.0)):  # a line, not the spectrum of something else
        return None
    amplitude2 = (squares[best] - level * dof[best]) / weight[best]
    chance = min(1.0, len(numbers) * float(chdtrc(dof[best], power[best] / level)))
    std = math.sqrt(level / weight[best])
    return TravelRipple(2 * math.pi / float(numbers[best]), math.sqrt(max(float(amplitude2), 0.0)), std, chance)


def _wave_numbers(positions: Sequence[Array]) -> Array:
    """Of ripples with 4 periods in the longest stroke to 3 samples in a period, half a period apart over that stroke."""
    stroke = max((float(np.ptp(p)) for p in positions), default=0.0)
    steps = [float(s.max()) for p in positions if (s := np.abs(np.diff(p))).any()]
    if not steps or stroke <= 0:
        return np.zeros(0)
    periods = np.arange(_FEWEST_PERIODS, min(stroke / (_SAMPLES_A_PERIOD * min(steps)), _MOST_PERIODS), 0.5)
    return 2 * math.pi / stroke * periods


def _periodogram(
    fit: ChannelFit, led: LedPath, noise: NoiseCovariance, presliding: float, numbers: Array
) -> tuple[Array, Array, Array]:
    """Fall of the square residual (k,), square amplitude and the variance of each of its two parts."""
    beside = np.column_stack(list(towing_columns(led, presliding).values()))
    phase = led.path.strain[:, None] * numbers
    told = np.column_stack([fit.measured - fit.model, beside, np.cos(phase), np.sin(phase)])
    white = noise.whiten(told, fit.model)
    q, _ = np.linalg.qr(white[:, 1 : 1 + beside.shape[1]])
    rest = white - q @ (q.T @ white)
    r, c, s = rest[:, 0], *np.split(rest[:, 1 + beside.shape[1] :], 2, axis=1)
    cc, ss, cs = (np.einsum("ik,ik->k", a, b) for a, b in ((c, c), (s, s), (c, s)))
    rc, rs = r @ c, r @ s
    det = np.maximum(cc * ss - cs**2, 1e-6 * cc * ss + 1e-300)
    a, b = (ss * rc - cs * rs) / det, (cc * rs - cs * rc) / det
    return a * rc + b * rs, a**2 + b**2, 0.5 * (cc + ss) / det

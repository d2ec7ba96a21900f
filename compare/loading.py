r"""What a record was loaded with: amplitude, mean rate and the energy of a loop.

.. math::  W = \frac{1}{n}\Bigl|\oint F\,\mathrm{d}u\Bigr| , \qquad n = \frac{\sum|\Delta u|}{2\,(\max u - \min u)}

n is the number of cycles. F and u are load and path as they were recorded, so that W is an energy where the path is a
length or an angle, and an energy per length where it is a strain, a twist or a curvature.
"""

from __future__ import annotations

import numpy as np

from compare.comparison import ChannelFit
from compare.experiment import Experiment
from compare.kinds import KINDS

_CLOSED = 0.05
_FEWEST_CYCLES = 0.9


def amplitude(experiment: Experiment) -> float:
    """Largest size of what was prescribed, SI."""
    record = experiment.record
    return float(np.abs(record[record.prescribed]).max())


def mean_rate(experiment: Experiment) -> float:
    """Mean size of the rate of what was prescribed, SI/s; NaN for a record without a clock."""
    record = experiment.record
    if record.time is None or len(record) < 2:
        return float("nan")
    return float(np.abs(np.diff(record[record.prescribed])).sum() / (record.time[-1] - record.time[0]))


def loop_energy(fit: ChannelFit, model: bool = False) -> float | None:
    """Energy of one loop as measured, or of the model; None where the path was not prescribed or does not close."""
    record = fit.experiment.record
    kind = KINDS[fit.experiment.kind]
    if fit.channel != kind.load or record.prescribed not in kind.paths:
        return None
    u, load = record[record.prescribed], fit.model if model else fit.measured
    span = float(np.ptp(u))
    if span == 0 or abs(u[-1] - u[0]) > _CLOSED * span:
        return None
    cycles = float(np.abs(np.diff(u)).sum()) / (2 * span)
    return abs(float(np.trapezoid(load, u))) / cycles if cycles >= _FEWEST_CYCLES else None

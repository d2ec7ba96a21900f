r"""Whether the error fell, on data that no parameter was fitted to.

For each set the rms residual over the noise floor, before (calibrated linear model) and after (with the effects), and

.. math::  R = \frac{\text{excess after}}{\text{excess before}}, \qquad
           \text{excess}^2 = \max\Bigl(0,\ \sum_i n_i\,(\text{rmse}_i^2/\text{floor}_i^2 - 1)\Bigr)

over the channels i of a set, so that noise that is small by chance in one record makes up for noise that is large in
another; with an interval from a bootstrap over groups of repeats. "Confirmed" where its upper end is below 1. Beside it what two
other repairs do: a Gaussian process on the residual, and the old model fitted again to the very data it is judged on.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from compare.bench_design import repeat_groups
from compare.comparison import ChannelFit, Comparison
from compare.findings import SetError

Array = NDArray[np.float64]
_SEED = 20230218
_RESAMPLES = 2000


def set_error(
    before: Comparison, after: Comparison, name: str, baselines: Mapping[str, float] | None = None
) -> SetError | None:
    """Error of one set before and after, or None if the set has no open experiment."""
    old, new = before.relative_error(name), after.relative_error(name)
    if old is None or new is None:
        return None
    if after is before:
        return SetError(old, new)
    fits = [(a, b) for a, b in zip(before.fits, after.fits, strict=True) if a.experiment.set == name]
    squares = np.array([[_square(a), _square(b)] for a, b in fits])
    ratio = _ratio(squares.sum(axis=0))
    low, high = _interval(squares, fits)
    confirmed = None if ratio is None or high is None or name == "calibrate" else bool(high < 1)
    return SetError(old, new, 1.0, ratio, low, high, dict(baselines or {}), confirmed)


def _square(fit: ChannelFit) -> float:
    return len(fit.measured) * ((fit.after.rmse / fit.noise_floor) ** 2 - 1)


def _ratio(sums: Array) -> float | None:
    before, after = float(sums[0]), max(float(sums[1]), 0.0)
    return float(np.sqrt(after / before)) if before > 0 else None


def _interval(squares: Array, fits: Sequence[tuple[ChannelFit, ChannelFit]]) -> tuple[float | None, float | None]:
    """2.5 and 97.5 % of the ratio over resampled groups of repeats, over experiments where there is one group only."""
    experiments = list({a.experiment.id: a.experiment for a, _ in fits}.values())
    groups = repeat_groups(experiments)
    if len(groups) < 2:
        groups = tuple((i,) for i in range(len(experiments)))
    if len(groups) < 2:
        return None, None
    of_group = {experiments[i].id: g for g, members in enumerate(groups) for i in members}
    sums = np.zeros((len(groups), 2))
    for row, (a, _) in zip(squares, fits, strict=True):
        sums[of_group[a.experiment.id]] += row
    rng = np.random.default_rng(_SEED)
    drawn = sums[rng.integers(0, len(groups), size=(_RESAMPLES, len(groups)))].sum(axis=1)
    drawn = drawn[drawn[:, 0] > 0]
    if not len(drawn):
        return None, None
    ratios = np.sqrt(np.maximum(drawn[:, 1], 0.0) / drawn[:, 0])
    low, high = np.quantile(ratios, [0.025, 0.975])
    return float(low), float(high)

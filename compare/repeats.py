r"""Repeats: which experiments were done again, which samples belong together, and what is left without a signal.

k repeats of one experiment give k - 1 contrasts that hold no signal and are independent of their mean,

.. math::  d_j = \sum_i H_{ji}\, y_i , \qquad H 1 = 0,\; H H^T = I ,

for a pair d = (y_1 - y_2)/sqrt 2. Each has the noise covariance of a single record. H: Helmert contrasts, e.g. Searle,
Linear Models, Wiley 1971.

Repeats on the same path are matched sample by sample. Where the sampling differs, every sample of the coarser record is
matched with the nearest one of the others, in time or, without a clock, in the way travelled; interpolating would
average neighbouring samples and make the noise look smaller than it is. What the small remaining difference of the
path does to the signal is taken out to first order with the regression of the channel on the path.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from compare.experiment import Experiment
from compare.noise_likelihood import Contrast

Array = NDArray[np.float64]
_SAME_PATH = 0.02  # rms difference of two paths over their range up to which they are the same path
_FEWEST_SAMPLES = 8


@dataclass(frozen=True)
class Repeats:
    """Repeats of one experiment, and for each the samples that belong together.

    Attributes
    ----------
    experiments : tuple of Experiment
        At least two, the repeated one first.
    samples : (k, n) array of int
        Row i holds the samples of experiment i.
    """

    experiments: tuple[Experiment, ...]
    samples: NDArray[np.intp]

    @property
    def channels(self) -> tuple[str, ...]:
        """Measured channels that all of them recorded."""
        return tuple(
            c for c in self.experiments[0].record.measured if all(c in e.record.measured for e in self.experiments)
        )

    def matched(self, series: Sequence[Array]) -> Array:
        """One series per experiment, shape (k, n), on the samples that belong together."""
        return np.array([x[samples] for x, samples in zip(series, self.samples, strict=True)])

    def contrasts(self, channel: str) -> list[Contrast]:
        """The k - 1 signal-free combinations of a channel, with the mean of the repeats as the signal."""
        y = self.matched([e.record[channel] for e in self.experiments])
        x = self.matched([e.record[e.record.prescribed] for e in self.experiments])
        spread = float(np.sum((x - x.mean()) ** 2))
        slope = float(np.sum((x - x.mean()) * (y - y.mean()))) / spread if spread > 0 else 0.0
        at_common_path = y - slope * (x - x.mean(axis=0))
        return [Contrast(d, y.mean(axis=0)) for d in helmert(len(y)) @ at_common_path]


def helmert(k: int) -> Array:
    """Orthonormal contrasts, shape (k - 1, k), rows that sum to zero.

    >>> helmert(2).round(4).tolist()
    [[0.7071, -0.7071]]
    """
    rows = np.zeros((k - 1, k))
    for j in range(1, k):
        rows[j - 1, :j] = 1.0
        rows[j - 1, j] = -j
        rows[j - 1] /= np.sqrt(j * (j + 1))
    return rows


def find_repeats(experiments: Sequence[Experiment]) -> tuple[list[Repeats], list[str]]:
    """Repeats among the experiments, all of which are open; and a sentence for each that cannot be used as one."""
    by_id = {e.id: e for e in experiments}
    groups: dict[str, list[Experiment]] = {}
    for experiment in experiments:
        groups.setdefault(_root(experiment, by_id), []).append(experiment)
    found, notes = [], []
    for group in groups.values():
        first, members = group[0], [group[0]]
        for other in group[1:]:
            problem = _why_not(first, other, members)
            if problem:
                notes.append(f"{other.id} is not used as a repeat of {first.id}: {problem}.")
            else:
                members.append(other)
        if len(members) > 1:
            samples = _match(members)
            found.append(Repeats(tuple(members), samples))
    return found, notes


def _root(experiment: Experiment, by_id: dict[str, Experiment]) -> str:
    """Id at the end of the chain of repeat_of, also where that experiment is not among those given."""
    while experiment.repeat_of is not None:
        if experiment.repeat_of not in by_id:
            return experiment.repeat_of
        experiment = by_id[experiment.repeat_of]
    return experiment.id


def _why_not(first: Experiment, other: Experiment, members: list[Experiment]) -> str:
    """Reason why `other` is no usable repeat of `first`, empty if it is one."""
    twin = next((e.id for e in members if e.sha256 == other.sha256), None)
    if twin is not None:
        return f"its table is byte for byte that of {twin}, which would make the noise vanish"
    if first.record.prescribed != other.record.prescribed:
        return f"{first.record.prescribed} was prescribed in one, {other.record.prescribed} in the other"
    samples = _match([first, other])
    if samples.shape[1] < _FEWEST_SAMPLES:
        return f"only {samples.shape[1]} of their samples belong together"
    x = [e.record[e.record.prescribed][i] for e, i in zip((first, other), samples, strict=True)]
    difference = float(np.sqrt(np.mean((x[0] - x[1]) ** 2)) / max(float(np.ptp(x[0])), np.finfo(float).tiny))
    if difference > _SAME_PATH:
        return f"their {first.record.prescribed} differs by {100 * difference:.1f} % of its range"
    return ""


def _match(experiments: list[Experiment]) -> NDArray[np.intp]:
    """Samples that belong together, shape (k, n)."""
    clocks = _clocks(experiments)
    lengths = {len(clock) for clock in clocks}
    if len(lengths) == 1 and all(_close(clock, clocks[0]) for clock in clocks):
        return np.tile(np.arange(lengths.pop()), (len(experiments), 1))
    begin, end = max(c[0] for c in clocks), min(c[-1] for c in clocks)
    inside = [np.flatnonzero((c >= begin) & (c <= end)) for c in clocks]
    coarsest = min(range(len(clocks)), key=lambda i: len(inside[i]))
    base = clocks[coarsest][inside[coarsest]]
    return np.array([_nearest(clock, base) for clock in clocks])


def _clocks(experiments: list[Experiment]) -> list[Array]:
    """What tells samples apart: time, or the way travelled along the path where one of them has no clock."""
    records = [e.record for e in experiments]
    times = [r.time for r in records if r.time is not None]
    if len(times) == len(records):
        return [t - t[0] for t in times]
    return [np.concatenate([[0.0], np.cumsum(np.abs(np.diff(r[r.prescribed])))]) for r in records]


def _close(a: Array, b: Array) -> bool:
    """Whether two clocks of equal length never differ by more than a quarter of the mean step."""
    step = max(float(b[-1] - b[0]) / max(len(b) - 1, 1), np.finfo(float).tiny)
    return bool(np.max(np.abs(a - b)) <= 0.25 * step)


def _nearest(clock: Array, at: Array) -> NDArray[np.intp]:
    """Index of the nearest entry of an increasing clock."""
    right = np.clip(np.searchsorted(clock, at), 1, len(clock) - 1)
    return np.where(at - clock[right - 1] <= clock[right] - at, right - 1, right).astype(np.intp)

r"""Lack of fit: is the distance of the model from the mean of the repeats larger than the repeats' own scatter allows?

.. math::  F = \frac{\sum |W\sqrt{k}\,(\bar y - f)|^2 / (n - p)}{\sum |W d|^2 / n_d}

W whitens with the covariance of one record, so that for a true model numerator and denominator are independent mean
squares of variance one: F follows Fisher's distribution with n - p and n_d degrees of freedom. k records are
repeated, d are their k - 1 contrasts, p is the number of calibrated stiffnesses. Source: pure-error lack of fit,
Draper & Smith, Applied Regression Analysis, 3rd ed. 1998, section 2.1, here with correlated noise.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import fdtrc

from compare.noise_covariance import NoiseCovariance
from compare.repeats import Repeats


@dataclass(frozen=True)
class LackOfFit:
    """F, its probability p under a true model, and its degrees of freedom."""

    F: float
    p: float
    dof_model: int
    dof_noise: int


def lack_of_fit(
    repeats: Sequence[Repeats],
    channel: str,
    predicted: Mapping[str, NDArray[np.float64]],
    noise: NoiseCovariance,
    free: int,
) -> LackOfFit | None:
    """Lack of fit of one channel, or None without repeats.

    Parameters
    ----------
    repeats : sequence of Repeats
        Of one kind, all in the set whose fit is judged.
    channel : str
        Channel that all of them measured.
    predicted : mapping of str to (n,) array
        The model's reading of that channel by experiment id.
    noise : NoiseCovariance
        Of the channel, learnt from repeats.
    free : int
        Number of parameters that were fitted to these data.
    """
    misfit, scatter, dof_model, dof_noise = 0.0, 0.0, -free, 0
    for group in repeats:
        series = [e.record[channel] - predicted[e.id] for e in group.experiments]
        signal = group.matched([predicted[e.id] for e in group.experiments]).mean(axis=0)
        mean = group.matched(series).mean(axis=0) * np.sqrt(len(series))
        misfit += float(np.sum(noise.whiten(mean, signal) ** 2))
        dof_model += len(mean)
        for contrast in group.contrasts(channel):
            scatter += float(np.sum(noise.whiten(contrast.d, contrast.m) ** 2))
            dof_noise += len(contrast.d)
    if dof_noise == 0 or dof_model <= 0 or scatter == 0:
        return None
    F = (misfit / dof_model) / (scatter / dof_noise)
    return LackOfFit(F, float(fdtrc(dof_model, dof_noise, F)), dof_model, dof_noise)

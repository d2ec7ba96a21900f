r"""Misfit of a model to one channel of one experiment, beside the noise that the data carry anyway.

With the residual r = measured - model,

.. math::  \text{rmse} = \sqrt{\overline{r^2}}, \quad \text{bias} = \overline{r}, \quad
           \text{excess} = \sqrt{\max(0,\ \text{rmse}^2 - \text{floor}^2)},

floor^2 is the expected mean square of the noise of one record. The bias is called *below noise* when |bias| <= 2 u with
u^2 = 1^T C 1 / n^2: then neither an error nor its absence may be claimed (ASME V&V 20).

The chance that noise alone gives such a residual is found in two parts, because a record draws its gain and its offset only once.
In coordinates in which the noise of the samples is white, r is split into its part along the signal and the constant,
which is judged by the scatter between records and by how few records that is known from, F(2, contrasts), and the
rest, which no gain and no offset touches, F(n - 2, samples). The smaller of the two counts, doubled (Bonferroni).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc, fdtrc

from compare.noise_covariance import NoiseCovariance

Array = NDArray[np.float64]
_COVERAGE = 2.0


@dataclass(frozen=True)
class Misfit:
    """How far a model is from one measured channel [unit of the channel]; bias is measured minus model."""

    rmse: float
    bias: float
    excess: float
    chance: float


def misfit(measured: Array, model: Array, noise: NoiseCovariance) -> Misfit:
    """Misfit of a model's reading to a measured channel, both of shape (n,).

    Examples
    --------
    >>> m = misfit(np.array([1.0, 3.0, 1.0, 3.0]), np.zeros(4), NoiseCovariance(s=1.0))
    >>> m.bias, m.excess
    (2.0, 2.0)
    """
    residual = measured - model
    mean_square = float(np.mean(residual**2))
    excess = float(np.sqrt(max(0.0, mean_square - noise.floor(measured) ** 2)))
    return Misfit(float(np.sqrt(mean_square)), float(np.mean(residual)), excess, _chance(residual, model, noise))


def bias_uncertainty(measured: Array, noise: NoiseCovariance) -> float:
    """Twice the standard deviation of the bias that noise alone gives."""
    return _COVERAGE * noise.mean_std(measured)


def _chance(residual: Array, signal: Array, noise: NoiseCovariance) -> float:
    """Probability of so large a residual if the model were true."""
    whole = float(np.sum(noise.whiten(residual, signal) ** 2))
    if noise.assumed:
        return float(chdtrc(len(residual), whole))
    of_records = noise.whiten_samples(np.column_stack([signal, np.ones(len(signal))]))
    length = np.linalg.norm(of_records, axis=0)
    directions, size, _ = np.linalg.svd(of_records[:, length > 0] / length[length > 0], full_matrices=False)
    directions = directions[:, size > 1e-6]
    white = noise.whiten_samples(residual)
    rest = float(np.sum((white - directions @ (directions.T @ white)) ** 2))
    k = directions.shape[1]
    by_records = _exceeds((whole - rest) / k, k, noise.contrasts)
    by_samples = _exceeds(rest / (len(residual) - k), len(residual) - k, noise.samples)
    return min(1.0, 2 * min(by_records, by_samples))


def _exceeds(mean_square: float, dof: int, dof_of_noise: int) -> float:
    """P(F > mean_square), the noise known from `dof_of_noise` values or, for 0, without doubt."""
    square = max(mean_square, 0.0)
    return float(fdtrc(dof, dof_of_noise, square) if dof_of_noise else chdtrc(dof, square * dof))

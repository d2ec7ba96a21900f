r"""Misfit of a model to one channel of one experiment, beside the noise that the data carry anyway.

With the residual r = measured - model,

.. math::  \text{rmse} = \sqrt{\overline{r^2}}, \quad \text{bias} = \overline{r}, \quad
           \text{excess} = \sqrt{\max(0,\ \text{rmse}^2 - \text{floor}^2)},

floor^2 is the expected mean square of the noise of one record. The chance p that noise alone gives an rmse as large
comes from a scaled chi-square with the mean and the variance, 2 tr C^2 / n^2, of the mean square (Satterthwaite 1946,
doi 10.2307/3002019). The bias is called *below noise* when |bias| <= 2 u with u^2 = 1^T C 1 / n^2: then neither an
error nor its absence may be claimed (ASME V&V 20).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc

from compare.noise_covariance import NoiseCovariance

_COVERAGE = 2.0


@dataclass(frozen=True)
class Misfit:
    """How far a model is from one measured channel [unit of the channel]; bias is measured minus model."""

    rmse: float
    bias: float
    excess: float
    chance: float


def misfit(measured: NDArray[np.float64], model: NDArray[np.float64], noise: NoiseCovariance) -> Misfit:
    """Misfit of a model's reading to a measured channel, both of shape (n,).

    Examples
    --------
    >>> m = misfit(np.array([1.0, 3.0, 1.0, 3.0]), np.zeros(4), NoiseCovariance(s=1.0))
    >>> m.bias, m.excess
    (2.0, 2.0)
    """
    residual = measured - model
    mean_square = float(np.mean(residual**2))
    floor_square = noise.floor(measured) ** 2
    spread = noise.mean_square_std(measured) ** 2
    chance = float(chdtrc(2 * floor_square**2 / spread, mean_square * 2 * floor_square / spread))
    return Misfit(
        float(np.sqrt(mean_square)),
        float(np.mean(residual)),
        float(np.sqrt(max(0.0, mean_square - floor_square))),
        chance,
    )


def bias_uncertainty(measured: NDArray[np.float64], noise: NoiseCovariance) -> float:
    """Twice the standard deviation of the bias that noise alone gives."""
    return _COVERAGE * noise.mean_std(measured)

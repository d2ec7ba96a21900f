r"""Covariance of the noise of one measured channel: correlated samples, random gain and offset of a record.

.. math::  C = s^2 A(\varphi) + g^2\, m m^T + b^2\, 1 1^T , \qquad A_{ij} = \varphi^{|i-j|}

m is the signal. s is the scatter of a sample, phi its correlation from sample to sample (AR(1)), g the relative
scatter of the gain and b the scatter of the offset between records (another specimen, another mounting). The inverse
of A is tridiagonal, so that A^-1 = W^T W with W x = (x_0, (x_t - phi x_{t-1}) / sqrt(1 - phi^2)); the two other terms
are a rank-2 update (Woodbury). Everything costs O(n).

Source: general linear mixed models with AR(1) errors, e.g. Pinheiro & Bates, Mixed-Effects Models in S and S-PLUS,
Springer 2000, ch. 5, doi 10.1007/b98882.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import InputError

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class NoiseCovariance:
    """Noise of one channel in SI; `assumed` where no repeats measured it, `source` says in words where it is from.

    Parameters
    ----------
    s : float
        Standard deviation of a sample [unit of the channel].
    phi : float
        Correlation of neighbouring samples, -1 < phi < 1.
    gain : float
        Relative standard deviation of the gain of a record.
    offset : float
        Standard deviation of the offset of a record [unit of the channel].
    contrasts, samples : int
        How many signal-free contrasts of repeats it was learnt from, and how many samples they have; 0 if it was not.

    Examples
    --------
    >>> noise = NoiseCovariance(s=2.0, phi=0.0, gain=0.0, offset=1.5)
    >>> noise.floor(np.zeros(10))
    2.5
    """

    s: float
    phi: float = 0.0
    gain: float = 0.0
    offset: float = 0.0
    assumed: bool = False
    source: str = ""
    contrasts: int = 0
    samples: int = 0

    def __post_init__(self) -> None:
        if not (
            self.s > 0
            and abs(self.phi) < 1
            and self.gain >= 0
            and self.offset >= 0
            and np.isfinite([self.s, self.gain, self.offset]).all()
        ):
            raise InputError(
                f"no noise covariance has s = {self.s:g}, phi = {self.phi:g}, gain = "
                f"{self.gain:g}, offset = {self.offset:g}."
            )

    def floor(self, signal: Vector) -> float:
        """Root of the expected mean square of the noise of one record with that signal."""
        return float(np.sqrt(self.s**2 + self.gain**2 * np.mean(signal**2) + self.offset**2))

    def whiten(self, x: Vector, signal: Vector) -> Vector:
        """K x with K^T K = C^-1, which turns noise into independent samples of variance one; x: (n,) or (n, k)."""
        Q, shrink = self._update(signal)
        white = self.whiten_samples(x)
        return white - Q @ (shrink[:, None] * (Q.T @ white) if white.ndim == 2 else shrink * (Q.T @ white))

    def log_determinant(self, signal: Vector) -> float:
        """ln det C."""
        _, shrink = self._update(signal)
        n = len(signal)
        return float(2 * n * np.log(self.s) + (n - 1) * np.log1p(-(self.phi**2)) - 2 * np.log1p(-shrink).sum())

    def log_likelihood(self, noise: Vector, signal: Vector) -> float:
        """Gaussian log density of one record's noise."""
        white = self.whiten(noise, signal)
        return float(-0.5 * (white @ white + self.log_determinant(signal) + len(noise) * np.log(2 * np.pi)))

    def mean_std(self, signal: Vector) -> float:
        """Standard deviation of the mean of the noise over one record: sqrt(1^T C 1) / n."""
        n = len(signal)
        variance = self.s**2 * self._mean_correlation(n) + self.gain**2 * np.mean(signal) ** 2 + self.offset**2
        return float(np.sqrt(variance))

    def whiten_samples(self, x: Vector) -> Vector:
        """W x / s: white if there were no scatter of gain and offset; x of shape (n,) or (n, k)."""
        white = x / self.s
        white[1:] = (white[1:] - self.phi * (x[:-1] / self.s)) / np.sqrt(1 - self.phi**2)
        return white

    def _update(self, signal: Vector) -> tuple[Vector, Vector]:
        """Q (n, k) and 1 - 1/sqrt(1 + S^2) of the rank-2 update in whitened coordinates: W U = Q S V^T."""
        U = np.column_stack([self.gain * signal, np.full(len(signal), self.offset)])
        U = U[:, np.any(U != 0, axis=0)]
        if U.shape[1] == 0:
            return np.zeros((len(signal), 0)), np.zeros(0)
        Q, S, _ = np.linalg.svd(self.whiten_samples(U), full_matrices=False)
        return Q, 1 - 1 / np.sqrt(1 + S**2)

    def _mean_correlation(self, n: int) -> float:
        """Mean over all pairs of samples of phi^|i-j|, in closed form."""
        q = self.phi
        return float(((1 + q) / (1 - q) - 2 * q * (1 - q**n) / (n * (1 - q) ** 2)) / n)

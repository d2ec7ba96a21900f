r"""Covariance of the noise of one measured channel: correlated samples, random gain and offset of a record.

.. math::  C = s^2 A(\varphi) + w^2 I + g^2\, m m^T + b^2\, 1 1^T , \qquad A_{ij} = \varphi^{|i-j|}

m is the signal. s is the scatter of a sample that is correlated by phi from sample to sample (AR(1)), w that of its
white part, g the relative scatter of the gain and b the scatter of the offset between records (another specimen,
another mounting). The first two are made white by the innovations of a Kalman filter, the two others are a rank-2
update (Woodbury). Everything costs O(n).

Source: general linear mixed models with AR(1) errors, e.g. Pinheiro & Bates, Mixed-Effects Models in S and S-PLUS,
Springer 2000, ch. 5, doi 10.1007/b98882.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from compare.innovations import innovations
from geometry.errors import InputError

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class NoiseCovariance:
    """Noise of one channel in SI; `assumed` where no repeats measured it, `source` says in words where it is from.

    Parameters
    ----------
    s : float
        Standard deviation of the correlated part of a sample [unit of the channel].
    phi : float
        Correlation of neighbouring samples, -1 < phi < 1.
    gain : float
        Relative standard deviation of the gain of a record.
    offset : float
        Standard deviation of the offset of a record [unit of the channel].
    contrasts, samples : int
        How many signal-free contrasts of repeats it was learnt from, and how many samples they have; 0 if it was not.
    white : float
        Standard deviation of the white part of a sample [unit of the channel]; with phi = 0 all of s is white as well.

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
    white: float = 0.0

    def __post_init__(self) -> None:
        if not (
            self.s > 0
            and abs(self.phi) < 1
            and self.gain >= 0
            and self.offset >= 0
            and self.white >= 0
            and np.isfinite([self.s, self.gain, self.offset, self.white]).all()
        ):
            raise InputError(
                f"no noise covariance has s = {self.s:g}, phi = {self.phi:g}, gain = "
                f"{self.gain:g}, offset = {self.offset:g}."
            )

    def floor(self, signal: Vector) -> float:
        """Root of the expected mean square of the noise of one record with that signal."""
        return float(np.sqrt(self.sample_variance + self.gain**2 * np.mean(signal**2) + self.offset**2))

    @property
    def sample_variance(self) -> float:
        """Variance of one sample within a record, s^2 + w^2."""
        return self.s**2 + self.white**2

    def whiten(self, x: Vector, signal: Vector) -> Vector:
        """K x with K^T K = C^-1, which turns noise into independent samples of variance one; x: (n,) or (n, k)."""
        Q, shrink = self.update(signal)
        white = self.whiten_samples(x)
        return white - Q @ (shrink[:, None] * (Q.T @ white) if white.ndim == 2 else shrink * (Q.T @ white))

    def log_determinant(self, signal: Vector) -> float:
        """ln det C."""
        _, shrink = self.update(signal)
        of_samples = innovations(
            np.empty((len(signal), 0)), self.s**2, self.phi, self.white**2, np.empty((len(signal), 0))
        )
        return float(of_samples - 2 * np.log1p(-shrink).sum())

    def log_likelihood(self, noise: Vector, signal: Vector) -> float:
        """Gaussian log density of one record's noise."""
        white = self.whiten(noise, signal)
        return float(-0.5 * (white @ white + self.log_determinant(signal) + len(noise) * np.log(2 * np.pi)))

    def mean_std(self, signal: Vector) -> float:
        """Standard deviation of the mean of the noise over one record: sqrt(1^T C 1) / n."""
        n = len(signal)
        of_samples = self.s**2 * self._mean_correlation(n) + self.white**2 / n
        variance = of_samples + self.gain**2 * np.mean(signal) ** 2 + self.offset**2
        return float(np.sqrt(variance))

    def whiten_samples(self, x: Vector) -> Vector:
        """The samples made white, as if there were no scatter of gain and offset; x of shape (n,) or (n, k)."""
        columns = np.ascontiguousarray(x[:, None] if x.ndim == 1 else x, dtype=float)
        white = np.empty_like(columns)
        innovations(columns, self.s**2, self.phi, self.white**2, white)
        return white[:, 0] if x.ndim == 1 else white

    def update(self, signal: Vector) -> tuple[Vector, Vector]:
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

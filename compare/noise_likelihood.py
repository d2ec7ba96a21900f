r"""Maximum likelihood of the noise covariance from contrasts of repeats.

A contrast d of repeats, (y1 - y2)/sqrt 2 for a pair, holds no signal and has the covariance C of one record,

.. math::  C = s^2 [A(\varphi) + \rho^2 I + \gamma^2 m m^T + \beta^2 1 1^T], \qquad w = s\rho,\; g = s\gamma,\; b = s\beta .

With V = (d, m, 1) one needs the 3x3 products V^T [A + rho^2 I]^-1 V of every contrast, from one pass of the innovations;
the terms of gain and offset and the best s follow from them in closed form, and so do the derivatives

.. math::  \partial \ln\det C / \partial \gamma^2 = m^T C^{-1} m, \qquad
           \partial (d^T C^{-1} d) / \partial \gamma^2 = -(m^T C^{-1} d)^2 ,

the same with 1 for beta. A coarse grid, on which gain and offset cost no pass, gives the starts. The white part is kept
only where it makes the data clearly more likely. Source: profile likelihood, Pinheiro & Bates 2000
(doi 10.1007/b98882), sections 2.2 and 5.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from compare.innovations import products
from compare.noise_covariance import NoiseCovariance
from geometry.errors import InputError

Array = NDArray[np.float64]
_PHI_LIMIT = 0.995
_LOG_BOUNDS = (-7.0, 7.0)  # of gain and offset over sample scatter: from nothing to a thousand times
_WORTH_WHITE = 4.0  # smallest gain of the deviance for which the white part is kept
_GRID_PHI = (-0.3, 0.3, 0.7, 0.95)
_GRID_LOGS = np.linspace(-5.0, 5.0, 11)
_STEP = 1e-6  # of atanh phi and ln rho, for their derivatives
_POLISHED = 2
_WORTH_POLISH = 1e-3


@dataclass(frozen=True)
class Contrast:
    """A signal-free combination d of repeats, shape (n,), and their signal m on the same samples."""

    d: Array
    m: Array


@dataclass(frozen=True)
class _Columns:
    """d, m / scale and 1 of all contrasts one below the other, (N, 3), and where each begins, (k + 1,)."""

    V: Array
    begin: NDArray[np.intp]

    @classmethod
    def of(cls, contrasts: Sequence[Contrast], scale: float) -> _Columns:
        V = [np.column_stack([c.d, c.m / scale, np.ones(len(c.d))]) for c in contrasts]
        return cls(np.vstack(V), np.concatenate([[0], np.cumsum([len(v) for v in V])]))

    def deviance(self, phi: float, rho: float, gamma: float, beta: float) -> tuple[float, float]:
        """-2 log likelihood up to a constant with s at its best, and that s; rho = w / s."""
        at = _with_record_scatter(*self.products(phi, rho), np.array([gamma]), np.array([beta]), len(self.V))
        return float(at.deviance[0]), float(np.sqrt(at.variance[0]))

    def products(self, phi: float, rho: float) -> tuple[Array, float]:
        """V^T [A + rho^2 I]^-1 V of every contrast, (k, 3, 3), and the sum of their log determinants."""
        P = np.zeros((len(self.begin) - 1, 3, 3))
        return P, products(self.V, self.begin, phi, rho**2, P)


@dataclass(frozen=True)
class _Likelihood:
    """Deviance, best s^2, and derivatives of the deviance by ln gamma and ln beta, at m pairs of them: all (m,)."""

    deviance: Array
    variance: Array
    by_gain: Array
    by_offset: Array


def _with_record_scatter(P: Array, log_det: float, gamma: Array, beta: Array, n: int) -> _Likelihood:
    """Add the scatter of gain and offset, gamma and beta (m,), to the products P (k, 3, 3) of the samples alone."""
    u, v = gamma[:, None] ** 2, beta[:, None] ** 2
    dd, dm, d1 = P[:, 0, 0], P[:, 0, 1], P[:, 0, 2]
    mm, m1, ones = P[:, 1, 1], P[:, 1, 2], P[:, 2, 2]
    minor = np.fmax(mm * ones - m1**2, 0.0)
    det = 1 + u * mm + v * ones + u * v * minor
    # products with the whole C^-1 instead of that of the samples
    Cdm, Cd1 = (dm + v * (dm * ones - d1 * m1)) / det, (d1 + u * (d1 * mm - dm * m1)) / det
    square = np.sum(dd - u * dm * Cdm - v * d1 * Cd1, axis=1)
    variance = np.fmax(square / n, np.finfo(float).tiny)
    deviance = n * np.log(variance) + log_det + np.log(det).sum(axis=1)
    by_gain = 2 * np.sum(u * ((mm + v * minor) / det - Cdm**2 / variance[:, None]), axis=1)
    by_offset = 2 * np.sum(v * ((ones + u * minor) / det - Cd1**2 / variance[:, None]), axis=1)
    return _Likelihood(deviance, variance, by_gain, by_offset)


def fit_noise(contrasts: Sequence[Contrast], source: str = "") -> NoiseCovariance:
    """The noise covariance under which the contrasts are most likely.

    Parameters
    ----------
    contrasts : sequence of Contrast
        At least one, of at least 3 samples and not all zero.

    Returns
    -------
    NoiseCovariance
        A gain or an offset that makes the data no more likely than none at all is zero.

    Raises
    ------
    InputError
        If there is nothing to learn from: no contrast, or repeats that are equal to the last digit.
    """
    if not contrasts or max(float(np.abs(c.d).max()) for c in contrasts) == 0:
        raise InputError("the noise cannot be learnt: there are no repeats, or they are equal to the last digit.")
    scale = float(np.sqrt(np.mean([np.mean(c.m**2) for c in contrasts]))) or 1.0
    columns = _Columns.of(contrasts, scale)
    plain = _search(columns, _starts(columns, _lag_one(contrasts)), with_white=False)
    phi, rho, gamma, beta, deviance = plain
    mixed = _search(
        columns, [[max(np.arctanh(phi / _PHI_LIMIT), x), 0.0, *_logs(gamma, beta)] for x in (1.0, 2.0)], with_white=True
    )
    if mixed[-1] < deviance - _WORTH_WHITE:
        phi, rho, gamma, beta, deviance = mixed
    for none in ((0.0, 0.0), (gamma, 0.0), (0.0, beta)):
        if columns.deviance(phi, rho, *none)[0] <= deviance + 1e-2:
            gamma, beta = none
            break
    s = columns.deviance(phi, rho, gamma, beta)[1]
    return NoiseCovariance(
        s=s,
        phi=phi,
        gain=s * gamma / scale,
        offset=s * beta,
        source=source,
        contrasts=len(contrasts),
        samples=sum(len(c.d) for c in contrasts),
        white=s * rho,
    )


def _search(
    columns: _Columns, starts: Sequence[Sequence[float]], with_white: bool
) -> tuple[float, float, float, float, float]:
    """phi, rho, gamma, beta and deviance of the most likely covariance."""

    def unpack(p: Array) -> tuple[float, float, float, float]:
        rho = float(np.exp(p[1])) if with_white else 0.0
        gamma, beta = (float(v) for v in np.exp(p[-2:]))
        return float(_PHI_LIMIT * np.tanh(p[0])), rho, gamma, beta

    def at(p: Array) -> _Likelihood:
        phi, rho, gamma, beta = unpack(p)
        return _with_record_scatter(*columns.products(phi, rho), np.array([gamma]), np.array([beta]), len(columns.V))

    def deviance_and_slopes(p: Array) -> tuple[float, Array]:
        here = at(p)
        of_samples = [(at(p + _STEP * e).deviance[0] - here.deviance[0]) / _STEP for e in np.eye(len(p))[:-2]]
        return float(here.deviance[0]), np.array([*of_samples, here.by_gain[0], here.by_offset[0]])

    bounds = [(-3.0, 4.0), *([_LOG_BOUNDS] if with_white else []), _LOG_BOUNDS, _LOG_BOUNDS]
    fits = [minimize(deviance_and_slopes, start, jac=True, method="L-BFGS-B", bounds=bounds) for start in starts]
    best = min(fits, key=lambda fit: fit.fun)
    phi, rho, *_ = unpack(best.x)
    # far out gain and offset have no slope that leads back: look for a better pair where samples are as found
    logs, finer = _finest(*columns.products(phi, rho), len(columns.V))
    if finer < best.fun - _WORTH_POLISH:
        again = minimize(deviance_and_slopes, [*best.x[:-2], *logs], jac=True, method="L-BFGS-B", bounds=bounds)
        best = min(best, again, key=lambda fit: fit.fun)
    return *unpack(best.x), float(best.fun)


def _finest(P: Array, log_det: float, n: int) -> tuple[list[float], float]:
    """ln gamma and ln beta of the lowest point of a fine grid, and its deviance."""
    gamma, beta = _grid(np.linspace(*_LOG_BOUNDS, 43))
    deviance = _with_record_scatter(P, log_det, gamma, beta, n).deviance
    k = int(np.argmin(deviance))
    return _logs(gamma[k], beta[k]), float(deviance[k])


def _grid(logs: Array) -> tuple[Array, Array]:
    """gamma and beta at all pairs of logarithms."""
    gamma, beta = np.meshgrid(np.exp(logs), np.exp(logs), indexing="ij")
    return gamma.ravel(), beta.ravel()


def _starts(columns: _Columns, lag_one: float) -> list[list[float]]:
    """Where a grid of phi, gamma and beta without a white part has its lowest valleys, best first."""
    phis = np.clip(np.unique([*_GRID_PHI, lag_one]), -0.9, 0.95)
    logs = _GRID_LOGS
    gamma, beta = _grid(logs)
    grid = np.array(
        [_with_record_scatter(*columns.products(phi, 0.0), gamma, beta, len(columns.V)).deviance for phi in phis]
    ).reshape(len(phis), len(logs), len(logs))
    padded = np.pad(grid, 1, constant_values=np.inf)
    lowest = np.min([np.roll(padded, k, axis) for axis in range(3) for k in (-1, 1)], axis=0)[1:-1, 1:-1, 1:-1]
    valleys = np.argwhere(grid <= lowest)
    best = sorted(valleys, key=lambda v: float(grid[tuple(v)]))[:_POLISHED]
    return [[float(np.arctanh(phis[i] / _PHI_LIMIT)), float(logs[j]), float(logs[k])] for i, j, k in best]


def _logs(*values: float) -> list[float]:
    return [float(np.clip(np.log(v), *_LOG_BOUNDS)) for v in values]


def _lag_one(contrasts: Sequence[Contrast]) -> float:
    """Autocorrelation of neighbouring samples after the mean of every contrast is taken away."""
    centred = [c.d - c.d.mean() for c in contrasts]
    return float(sum(x[1:] @ x[:-1] for x in centred) / max(sum(x @ x for x in centred), np.finfo(float).tiny))

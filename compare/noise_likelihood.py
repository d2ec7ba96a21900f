r"""Maximum likelihood of the noise covariance from contrasts of repeats.

A contrast d of repeats, (y1 - y2)/sqrt 2 for a pair, holds no signal and has the covariance C of one record,

.. math::  C = s^2 [A(\varphi) + \gamma^2 m m^T + \beta^2 1 1^T], \qquad g = s\gamma,\; b = s\beta .

With V = (d, m, 1) the products V^T A^-1 V = (G0 - phi G1 + phi^2 G2) / (1 - phi^2) are polynomials in phi whose three
3x3 coefficients are summed once, so that one evaluation of the likelihood does not depend on the number of samples; s
follows in closed form. Source: profile likelihood, Pinheiro & Bates 2000 (doi 10.1007/b98882), sections 2.2 and 5.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from compare.noise_covariance import NoiseCovariance
from geometry.errors import InputError

Array = NDArray[np.float64]
_PHI_LIMIT = 0.995
_LOG_BOUNDS = (-7.0, 7.0)  # of gain and offset over sample scatter: from nothing to a thousand times
_STARTS = ((-3.0, -3.0), (0.0, -3.0), (-3.0, 0.0), (0.0, 0.0))


@dataclass(frozen=True)
class Contrast:
    """A signal-free combination d of repeats, shape (n,), and their signal m on the same samples."""

    d: Array
    m: Array


@dataclass(frozen=True)
class _Products:
    """Coefficients (k, 3, 3) of V^T A^-1 V in phi for k contrasts, and their lengths n (k,)."""

    G0: Array
    G1: Array
    G2: Array
    n: Array

    @classmethod
    def of(cls, contrasts: Sequence[Contrast], scale: float) -> _Products:
        G = np.empty((3, len(contrasts), 3, 3))
        for i, contrast in enumerate(contrasts):
            V = np.column_stack([contrast.d, contrast.m / scale, np.ones(len(contrast.d))])
            lag = V[1:].T @ V[:-1]
            G[:, i] = V.T @ V, lag + lag.T, V[1:-1].T @ V[1:-1]
        return cls(G[0], G[1], G[2], np.array([len(c.d) for c in contrasts], dtype=float))

    def deviance(self, phi: float, gamma: float, beta: float) -> tuple[float, float]:
        """-2 log likelihood up to a constant, with s at its best, and that s."""
        P = (self.G0 - phi * self.G1 + phi**2 * self.G2) / (1 - phi**2)
        D = np.array([gamma, beta])
        M = np.eye(2) + D[:, None] * P[:, 1:, 1:] * D
        cross = D * P[:, 0, 1:]
        square = P[:, 0, 0] - np.sum(cross * np.linalg.solve(M, cross[..., None])[..., 0], axis=1)
        total = self.n.sum()
        variance = max(square.sum() / total, np.finfo(float).tiny)
        log_det = np.sum((self.n - 1) * np.log1p(-(phi**2))) + np.log(np.linalg.det(M)).sum()
        return float(total * np.log(variance) + log_det), float(np.sqrt(variance))


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
    products = _Products.of(contrasts, scale)

    def deviance(p: Array) -> float:
        return products.deviance(_PHI_LIMIT * np.tanh(p[0]), *np.exp(p[1:]))[0]

    bounds = [(-3.0, 4.0), _LOG_BOUNDS, _LOG_BOUNDS]
    start = np.arctanh(np.clip(_lag_one(contrasts), -0.9, 0.9))
    fits = [minimize(deviance, [start, *logs], method="L-BFGS-B", bounds=bounds) for logs in _STARTS]
    best = min(fits, key=lambda fit: fit.fun)
    phi = float(_PHI_LIMIT * np.tanh(best.x[0]))
    gamma, beta = (float(v) for v in np.exp(best.x[1:]))
    for none in ((0.0, 0.0), (gamma, 0.0), (0.0, beta)):
        if products.deviance(phi, *none)[0] <= best.fun + 1e-2:
            gamma, beta = none
            break
    s = products.deviance(phi, gamma, beta)[1]
    return NoiseCovariance(
        s=s,
        phi=phi,
        gain=s * gamma / scale,
        offset=s * beta,
        source=source,
        contrasts=len(contrasts),
        samples=sum(len(c.d) for c in contrasts),
    )


def _lag_one(contrasts: Sequence[Contrast]) -> float:
    """Autocorrelation of neighbouring samples after the mean of every contrast is taken away."""
    centred = [c.d - c.d.mean() for c in contrasts]
    return float(sum(x[1:] @ x[:-1] for x in centred) / max(sum(x @ x for x in centred), np.finfo(float).tiny))

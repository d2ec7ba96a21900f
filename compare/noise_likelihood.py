r"""Maximum likelihood of the noise covariance from contrasts of repeats.

A contrast d of repeats, (y1 - y2)/sqrt 2 for a pair, holds no signal and has the covariance C of one record,

.. math::  C = s^2 [A(\varphi) + \rho^2 I + \gamma^2 m m^T + \beta^2 1 1^T], \qquad w = s\rho,\; g = s\gamma,\; b = s\beta .

With V = (d, m, 1) one needs the 3x3 products V^T [A + rho^2 I]^-1 V of every contrast, from one pass of the innovations;
the terms of gain and offset and the best s follow from them in closed form. The white part is kept only where it makes
the data clearly more likely. Source: profile likelihood, Pinheiro & Bates 2000 (doi 10.1007/b98882), sections 2.2 and 5.3.
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
_STARTS = ((-3.0, -3.0), (0.0, -3.0), (-3.0, 0.0), (0.0, 0.0))


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
        P = np.zeros((len(self.begin) - 1, 3, 3))
        log_det = products(self.V, self.begin, phi, rho**2, P)
        D = np.array([gamma, beta])
        M = np.eye(2) + D[:, None] * P[:, 1:, 1:] * D
        cross = D * P[:, 0, 1:]
        square = P[:, 0, 0] - np.sum(cross * np.linalg.solve(M, cross[..., None])[..., 0], axis=1)
        variance = max(square.sum() / len(self.V), np.finfo(float).tiny)
        log_det += float(np.log(np.linalg.det(M)).sum())
        return float(len(self.V) * np.log(variance) + log_det), float(np.sqrt(variance))


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
    lag_one = np.arctanh(np.clip(_lag_one(contrasts), -0.9, 0.9))
    plain = _search(columns, [[lag_one, *logs] for logs in _STARTS], with_white=False)
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

    bounds = [(-3.0, 4.0), *([_LOG_BOUNDS] if with_white else []), _LOG_BOUNDS, _LOG_BOUNDS]
    fits = [
        minimize(lambda p: columns.deviance(*unpack(p))[0], start, method="L-BFGS-B", bounds=bounds) for start in starts
    ]
    best = min(fits, key=lambda fit: fit.fun)
    return *unpack(best.x), float(best.fun)


def _logs(*values: float) -> list[float]:
    return [float(np.clip(np.log(v), *_LOG_BOUNDS)) for v in values]


def _lag_one(contrasts: Sequence[Contrast]) -> float:
    """Autocorrelation of neighbouring samples after the mean of every contrast is taken away."""
    centred = [c.d - c.d.mean() for c in contrasts]
    return float(sum(x[1:] @ x[:-1] for x in centred) / max(sum(x @ x for x in centred), np.finfo(float).tiny))

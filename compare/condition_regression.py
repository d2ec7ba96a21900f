r"""Regression of a number of every record on the conditions under which the records were taken.

.. math::  z_i = x_i^T \beta + \delta_i + e_i,\qquad \operatorname{var} e_i = \sigma_i^2,\; \operatorname{var}\delta_i = \tau^2

sigma_i is what noise alone gives; tau, the scatter that the line does not explain, is the one at which the weighted square
residual equals its degrees of freedom (Paule & Mandel 1982, doi 10.6028/jres.087.022), or zero. The slope is judged by
Student's t, and its standard deviation is widened so that value +- 2 std holds 95 %. Conditions enter the line one after
the other, the surest first, while they are significant at 5 %. Repeats are averaged before: a line through a model that
fails does not get surer by repeating the failure.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc, fdtrc, ndtr, ndtri, stdtr, stdtrit

Array = NDArray[np.float64]
_TIED = 0.8
_ENTERS = 0.05
_LEAST_RATIO = 1.1  # largest over smallest from which a condition varies
_LEAST_KELVIN = 2.0
_SCATTER_ROUNDS = 40


@dataclass(frozen=True)
class Slope:
    """A coefficient and its standard deviation (value +- 2 std holds 95 %).

    `chance` is that of so much if the truth were zero but scattered; `by_noise` if there were noise alone.
    """

    value: float
    std: float
    chance: float
    by_noise: float


@dataclass(frozen=True)
class ConditionSlope:
    """Slope per unit of the scale of a condition (see :func:`scale`), and the conditions that vary with it."""

    condition: str
    slope: Slope
    tied: tuple[tuple[str, float], ...]
    beside: tuple[str, ...]


def fit_line(z: Array, std: Array, X: Array, dof_of_noise: int = 0) -> list[Slope] | None:
    """All coefficients of z (n,) with noise std (n,) on the columns of X (n, p); None without a point to spare.

    Examples
    --------
    >>> found = fit_line(np.array([1.0, 2.0, 3.0]), np.full(3, 0.1), np.array([[1, 0], [1, 1], [1, 2]]))
    >>> [round(s.value, 6) for s in found]
    [1.0, 1.0]
    """
    n, p = X.shape
    dof = n - p
    if dof < 1 or np.linalg.matrix_rank(X / np.fmax(np.abs(X).max(axis=0), 1e-300)) < p:
        return None
    tau2 = _scatter(z, std, X, dof)
    beta, covariance, _ = _weighted(z, std**2 + tau2, X)
    se = np.sqrt(np.diag(covariance))
    known = dof if tau2 > 0 else dof + dof_of_noise
    wide = float(stdtrit(known, 0.975) / ndtri(0.975))
    chance = 2 * stdtr(known, -np.abs(beta) / se)
    plain, covariance, _ = _weighted(z, std**2, X)
    t = np.abs(plain) / np.sqrt(np.diag(covariance))
    by_noise = 2 * stdtr(dof_of_noise, -t) if dof_of_noise else 2 * ndtr(-t)
    return [Slope(*map(float, row)) for row in zip(beta, se * wide, chance, by_noise, strict=True)]


def differ(z: Array, std: Array, dof_of_noise: int = 0) -> float:
    """Chance that noise alone makes numbers (n,) so different from each other."""
    dof = len(z) - 1
    if dof < 1:
        return 1.0
    square = _weighted(z, std**2, np.ones((len(z), 1)))[2]
    return float(fdtrc(dof, dof_of_noise, square / dof) if dof_of_noise else chdtrc(dof, square))


def _weighted(z: Array, variance: Array, X: Array) -> tuple[Array, Array, float]:
    """Coefficients, their covariance, and the weighted square residual."""
    weighted = X / variance[:, None]
    covariance = np.linalg.pinv(X.T @ weighted)
    beta = covariance @ (weighted.T @ z)
    return beta, np.asarray(covariance, dtype=float), float(np.sum((z - X @ beta) ** 2 / variance))


def _scatter(z: Array, std: Array, X: Array, dof: int) -> float:
    """tau^2 at which the weighted square residual is `dof`."""
    if _weighted(z, std**2, X)[2] <= dof:
        return 0.0
    low, high = 0.0, float(np.sum((z - X @ np.linalg.lstsq(X, z, rcond=None)[0]) ** 2)) / dof
    for _ in range(_SCATTER_ROUNDS):
        middle = (low + high) / 2
        if _weighted(z, std**2 + middle, X)[2] > dof:
            low = middle
        else:
            high = middle
    return high


def scale(condition: str, values: Array) -> Array:
    """Doublings (logarithm to base 2), or for a temperature steps of 10 K."""
    return values / 10.0 if condition == "temperature" else np.log2(values)


def varies(condition: str, values: Array) -> bool:
    """Whether a condition is known everywhere and not the same everywhere."""
    if not np.isfinite(values).all() or len(values) < 3:
        return False
    if condition == "temperature":
        return bool(np.ptp(values) > _LEAST_KELVIN)
    return bool(values.min() > 0 and values.max() > _LEAST_RATIO * values.min())


def over_conditions(
    z: Array, std: Array, conditions: Mapping[str, Array], dof_of_noise: int = 0
) -> list[ConditionSlope]:
    """Slopes of z (n,) over each condition that varies, beside the others as far as they can be told apart.

    Parameters
    ----------
    z, std : (n,) arrays
        One number per condition of the bench, and its standard deviation from noise alone.
    conditions : mapping of str to (n,) array
        NaN where unknown.
    dof_of_noise : int
        From how many values the noise is known.
    """
    table = {name: scale(name, v) for name, v in conditions.items() if varies(name, v)}
    chosen = _chosen(z, std, table, dof_of_noise)
    found = []
    for name in table:
        tied = tuple((k, r) for k in table if k != name and abs(r := _correlation(table[name], table[k])) > _TIED)
        beside = tuple(k for k in chosen if k != name and k not in dict(tied))
        slope = _slope(z, std, [table[k] for k in (name, *beside)], dof_of_noise)
        if slope is not None:
            found.append(ConditionSlope(name, slope, tied, beside))
    return found


def _slope(z: Array, std: Array, columns: Sequence[Array], dof_of_noise: int) -> Slope | None:
    """Slope over the first of the columns beside the others."""
    centred = [c - c.mean() for c in columns]
    lines = fit_line(z, std, np.column_stack([*centred, np.ones(len(z))]), dof_of_noise)
    return None if lines is None else lines[0]


def _chosen(z: Array, std: Array, table: Mapping[str, Array], dof_of_noise: int) -> list[str]:
    """Conditions in the order in which they enter the line, two points always to spare."""
    chosen: list[str] = []
    while len(z) - (len(chosen) + 2) >= 2:
        slopes = {
            name: _slope(z, std, [table[k] for k in (name, *chosen)], dof_of_noise)
            for name in table
            if all(abs(_correlation(table[name], table[k])) <= _TIED for k in chosen)
        }
        known = {name: s.chance for name, s in slopes.items() if s is not None and name not in chosen}
        best = min(known, key=lambda name: known[name], default=None)
        if best is None or known[best] > _ENTERS:
            break
        chosen.append(best)
    return chosen


def _correlation(a: Array, b: Array) -> float:
    return float(np.corrcoef(a, b)[0, 1])


def average_repeats(groups: Sequence[str], numbers: Sequence[tuple[float, float]]) -> tuple[list[str], Array, Array]:
    """Names of the groups in the order in which they come, weighted means of their numbers, and the std of these."""
    names = list(dict.fromkeys(groups))
    value, std = np.empty(len(names)), np.empty(len(names))
    for i, name in enumerate(names):
        own = np.array([x for g, x in zip(groups, numbers, strict=True) if g == name])
        weight = 1 / own[:, 1] ** 2
        value[i], std[i] = np.sum(weight * own[:, 0]) / weight.sum(), 1 / np.sqrt(weight.sum())
    return names, value, std

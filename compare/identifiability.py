r"""What a set of targets fixes of the inputs: uncertainties, correlations, stiff and sloppy directions.

Near the optimum the weighted misfit is :math:`\tfrac12 d^T H d` with :math:`H = J^T J`, J the derivatives of the residuals,
each divided by its standard error. The range of a parameter is a prior of its own: uniform, of standard deviation
(h - l) / sqrt 12, so that

.. math::  \mathrm{cov} = (J^T J + D^{-2})^{-1}, \qquad D = \mathrm{diag}\,(h - l) / \sqrt{12}

exists where the targets leave a direction open. Directions are the eigenvectors of D J^T J D: along one with the eigenvalue
lambda the targets shrink the prior by 1 / sqrt(1 + lambda); below `OPEN` they say nothing worth (sloppy: Gutenkunst et al.,
PLoS Comput. Biol. 3 (2007) e189).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
OPEN = 1.0
"""Eigenvalue below which the prior is shrunk by less than 30 %: the direction is open."""
_SHOWN = 0.25


@dataclass(frozen=True)
class Direction:
    """Combination of parameters: eigenvalue of the scaled J^T J, its vector (p,) in parameters over their prior, and words."""

    eigenvalue: float
    vector: Array
    spread: float
    words: str

    @property
    def is_open(self) -> bool:
        """Whether the targets do not fix it."""
        return self.eigenvalue < OPEN


@dataclass(frozen=True)
class Identifiability:
    """Posterior of the parameters, in the coordinates of the search (logarithms where they are positive).

    Attributes
    ----------
    names : tuple of str
    standard_error, prior : (p,) arrays
        With and without the targets.
    correlation : (p, p) array
    directions : tuple of Direction
        The stiffest first.
    at_bound : tuple of str
        Parameters that stand at an end of their range.
    """

    names: tuple[str, ...]
    standard_error: Array = field(repr=False)
    prior: Array = field(repr=False)
    correlation: Array = field(repr=False)
    directions: tuple[Direction, ...]
    at_bound: tuple[str, ...]


def identifiability(
    jacobian: Array, x: Array, low: Array, high: Array, names: Sequence[str], logarithmic: Sequence[bool] | None = None
) -> Identifiability:
    """Uncertainties and directions from the derivatives (n, p) of the weighted residuals at x (p,).

    Examples
    --------
    >>> J = np.array([[10.0, -10.0]])  # one target that sees only the difference
    >>> found = identifiability(J, np.zeros(2), -np.ones(2), np.ones(2), ("a", "b"))
    >>> [d.is_open for d in found.directions], round(float(found.correlation[0, 1]), 2)
    ([False, True], 0.97)
    >>> print(found.directions[0].words)
    a / b is fixed to 9.9 %
    """
    log = np.ones(len(names), dtype=bool) if logarithmic is None else np.array(logarithmic, dtype=bool)
    prior = (high - low) / np.sqrt(12.0)
    H = jacobian.T @ jacobian
    covariance = np.linalg.inv(H + np.diag(prior**-2.0))
    error = np.sqrt(np.diag(covariance))
    values, vectors = np.linalg.eigh(prior[:, None] * H * prior)
    directions = []
    for k in np.argsort(values)[::-1]:
        v = vectors[:, k] * np.sign(vectors[np.abs(vectors[:, k]).argmax(), k])
        value = max(float(values[k]), 0.0)
        directions.append(_direction(value, v, prior, names, log))
    edge = 1e-3 * (high - low)
    at_bound = tuple(n for n, a, b, c, e in zip(names, x, low, high, edge, strict=True) if a < b + e or a > c - e)
    return Identifiability(tuple(names), error, prior, covariance / np.outer(error, error), tuple(directions), at_bound)


def _direction(value: float, v: Array, prior: Array, names: Sequence[str], log: NDArray[np.bool_]) -> Direction:
    """A direction in words: the covector v / prior is what the targets see, so that products and quotients stand in it."""
    seen = v / prior
    shown: list[int] = [
        i for i in np.argsort(-np.abs(v).round(9), kind="stable").tolist() if abs(v[i]) > _SHOWN * np.abs(v).max()
    ]
    largest = np.abs(seen[shown]).max()
    spread = float(1 / np.sqrt(1 + value) / largest)
    if value < OPEN:
        up = [names[i] for i in shown if v[i] > 0]
        down = [names[i] for i in shown if v[i] < 0]
        what = " with ".join(up) + (f" against {' with '.join(down)}" if down else "")
        return Direction(value, v, spread, f"{what}: not fixed by these data")
    powers = [(names[i], seen[i] / largest, bool(log[i])) for i in shown]
    text = _product(powers)
    return Direction(
        value,
        v,
        spread,
        f"{text} is fixed to {100 * spread:.2g} %" if log[shown].all() else f"{text}: fixed to {spread:.2g}",
    )


def _product(powers: Sequence[tuple[str, float, bool]]) -> str:
    def factor(name: str, power: float) -> str:
        return name if abs(abs(power) - 1) < 0.05 else f"{name}^{abs(power):.2g}"

    over = [factor(n, p) for n, p, _ in powers if p > 0]
    under = [factor(n, p) for n, p, _ in powers if p < 0]
    text = " ".join(over) or "1"
    return text + (f" / {' '.join(under)}" if len(under) == 1 else f" / ({' '.join(under)})" if under else "")


@dataclass(frozen=True)
class Profile:
    """Least misfit along a direction: steps (m,) in prior standard deviations, places (m, p), cost (m,)."""

    direction: Direction
    step: Array
    x: Array = field(repr=False)
    cost: Array


def profile(
    residual: Callable[[Array], Array], x: Array, low: Array, high: Array, direction: Direction, steps: int = 5
) -> Profile:
    """Misfit as far as the box allows along a direction from the optimum, everything across it fitted anew.

    The place moves by t D v; across it the search is held to the plane v . (y - x)/D = t by a stiff residual.
    """
    from scipy.optimize import least_squares  # slow to load, needed here only

    prior = (high - low) / np.sqrt(12.0)
    v, stiff = direction.vector, 1e3 * np.sqrt(1 + direction.eigenvalue)
    reach = []
    for sign in (-1.0, 1.0):
        with np.errstate(divide="ignore"):
            limit = np.where(sign * v > 0, high - x, low - x) / (sign * v * prior + 1e-300)
        reach.append(sign * float(np.min(np.where(np.abs(v) > 0.1, limit, np.inf))))
    wanted = np.unique(np.concatenate([np.linspace(reach[0], 0, steps), np.linspace(0, reach[1], steps)]))
    places, costs = [], []
    for t in wanted:

        def held(y: Array, t: float = float(t)) -> Array:
            return np.append(residual(y), stiff * (v @ ((y - x) / prior) - t))

        start = np.clip(x + t * v * prior, low + 1e-9 * prior, high - 1e-9 * prior)
        run = least_squares(held, start, bounds=(low, high), x_scale=prior, max_nfev=100)
        places.append(run.x)
        costs.append(0.5 * float(residual(run.x) @ residual(run.x)))
    return Profile(direction, wanted, np.array(places), np.array(costs))

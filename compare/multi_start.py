r"""Bounded least squares from many starts.

.. math::  \min_x \tfrac12 |r(x)|^2, \qquad l \le x \le h

Starts fill the box as a scrambled Sobol sequence (Sobol, USSR Comput. Math. Math. Phys. 7 (1967) 86-112); from each a
trust-region step that respects the bounds (Branch, Coleman, Li, SIAM J. Sci. Comput. 21 (1999) 1-23, as in
scipy.optimize.least_squares). Minima that agree are one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Residual = Callable[[Array], Array]
_SAME_COST = 1e-3
_SAME_FALL = 1e-6
"""Relative fall of the cost, or step, at which a search ends: along a sloppy direction it would go on for long."""


@dataclass(frozen=True)
class Minimum:
    """A minimum: place x (p,), cost |r|^2 / 2, residuals (n,), their derivatives (n, p), and how many starts led there."""

    x: Array
    cost: float
    residual: Array
    jacobian: Array
    starts: int = 1


def sobol_starts(low: Array, high: Array, count: int, seed: int = 0) -> Array:
    """Places (count, p) that fill a box evenly; the first is its middle.

    Examples
    --------
    >>> sobol_starts(np.zeros(2), np.ones(2), 4).shape
    (4, 2)
    """
    from scipy.stats import qmc  # slow to load, needed here only

    options: dict[str, Any] = {"seed": seed}  # newer scipy calls it rng and still takes this
    drawn = qmc.Sobol(len(low), **options).random_base2(max(0, int(np.ceil(np.log2(max(count, 1))))))[:count]
    drawn[0] = 0.5
    return low + drawn * (high - low)


def multi_start(
    residual: Residual,
    low: Array,
    high: Array,
    *,
    count: int = 32,
    first: Array | None = None,
    seed: int = 0,
    progress: Callable[[float, str], None] | None = None,
) -> list[Minimum]:
    """Minima of |r|^2 / 2 in a box, the lowest first.

    Parameters
    ----------
    residual : callable
        r(x), (n,); n may be smaller than p, when the minimum is a set and each start ends at its own place of it.
    low, high : (p,) arrays
    count, first, seed : starts of the sequence (0 for none), places (p,) or (k, p) to start from before them, seed of the sequence
    progress : callable, optional

    Examples
    --------
    >>> found = multi_start(lambda x: np.array([x[0] ** 2 - 1, x[1]]), np.full(2, -2.0), np.full(2, 2.0), count=8)
    >>> sorted(float(np.round(m.x[0])) for m in found)
    [-1.0, 1.0]
    """
    from scipy.optimize import least_squares  # slow to load, needed here only

    starts = sobol_starts(low, high, count, seed) if count else np.zeros((0, len(low)))
    if first is not None:
        starts = np.vstack([np.clip(np.atleast_2d(first), low, high), starts])
    margin = 1e-9 * (high - low)
    found: list[Minimum] = []
    for i, x in enumerate(starts):
        inside = np.clip(x, low + margin, high - margin)
        run = least_squares(
            residual, inside, bounds=(low, high), x_scale=high - low, ftol=_SAME_FALL, xtol=_SAME_FALL, max_nfev=100
        )
        found.append(Minimum(run.x, float(run.cost), run.fun, run.jac))
        if progress is not None:
            progress(
                (i + 1) / len(starts), f"start {i + 1} of {len(starts)}, least misfit {min(m.cost for m in found):.3g}"
            )
    return _distinct(sorted(found, key=lambda m: m.cost), high - low)


def _distinct(found: list[Minimum], span: Array) -> list[Minimum]:
    kept: list[Minimum] = []
    for m in found:
        for i, k in enumerate(kept):
            close = np.abs((m.x - k.x) / span).max() < 0.02
            if close and abs(m.cost - k.cost) <= _SAME_COST * max(k.cost, 1e-12) + 1e-9:
                kept[i] = Minimum(k.x, k.cost, k.residual, k.jacobian, k.starts + 1)
                break
        else:
            kept.append(m)
    return kept

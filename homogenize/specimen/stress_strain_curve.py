r"""The average stress-strain line of a specimen: load steps, a straight line through them, its slope and R2.

.. math::  \sigma = a + k\,\varepsilon, \qquad R^2 = 1 - \frac{\sum (\sigma_i - a - k \varepsilon_i)^2}{\sum (\sigma_i - \bar\sigma)^2} .

A linear specimen gives R2 = 1; what is below 1 in a measured or nonlinear curve is curvature.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.errors import SpecError


@dataclass(frozen=True)
class StressStrainCurve:
    """Mean strain and mean stress [Pa] after each load step, with the fitted line: `slope` [Pa], `intercept` [Pa], `R2`."""

    strain: NDArray[np.float64]
    stress: NDArray[np.float64]
    slope: float
    intercept: float
    R2: float


def stress_strain_curve(strain: ArrayLike, stress: ArrayLike) -> StressStrainCurve:
    """Fit a line to load steps.

    Raises
    ------
    SpecError
        If there are fewer than two steps or they do not differ.

    Examples
    --------
    >>> curve = stress_strain_curve([0.0, 0.01, 0.02], [0.0, 1.4e6, 2.8e6])
    >>> round(curve.slope / 1e6, 6), round(curve.R2, 6)
    (140.0, 1.0)
    """
    e, s = np.asarray(strain, dtype=float), np.asarray(stress, dtype=float)
    if (
        e.shape != s.shape
        or e.ndim != 1
        or len(e) < 2
        or not (np.isfinite(e).all() and np.isfinite(s).all())
        or np.ptp(e) == 0
    ):
        raise SpecError("a stress-strain line needs at least two load steps with different finite strains.")
    slope, intercept = np.polyfit(e, s, 1)
    rest = s - intercept - slope * e
    spread = ((s - s.mean()) ** 2).sum()
    R2 = 1.0 - float((rest**2).sum() / spread) if spread > 0 else float("nan")
    return StressStrainCurve(e, s, float(slope), float(intercept), R2)


def proportional_curve(strain: float, stress: float, steps: int = 10) -> StressStrainCurve:
    """The curve of a linear specimen whose load grows in equal steps to a last strain and stress."""
    share = np.arange(1, steps + 1) / steps
    return stress_strain_curve(strain * share, stress * share)

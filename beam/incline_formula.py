r"""The towing force of the published formulas (22) and (23): weight, friction and inertia of the cable that is dragged.

.. math:: F_{up} = m(t)\,[g \sin\theta + \mu g \cos\theta + a], \qquad
          F_{down} = m(t)\,[\mu g \cos\theta - g \sin\theta + a].

m(t) is the mass that moves with the shearer. The formulas know neither the bend nor the tension that reaches it.
Source: M. Ge et al., PLoS ONE 18(2) e0281136 (2023), formulas (22), (23), reconstructed from the text.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

STANDARD_GRAVITY = 9.81
"""m/s^2, the value used throughout."""


def towing_force_up(
    mass: ArrayLike,
    inclination: float,
    friction: float,
    acceleration: ArrayLike = 0.0,
    gravity: float = STANDARD_GRAVITY,
) -> NDArray[np.float64]:
    """Formula (22): force [N] to tow `mass` [kg] up a slope of `inclination` [rad].

    Examples
    --------
    >>> float(towing_force_up(100.0, 0.0, 0.3).round(6))
    294.3
    """
    along = np.sin(inclination) + friction * np.cos(inclination)
    return np.asarray(mass, dtype=float) * (gravity * along + np.asarray(acceleration, dtype=float))


def towing_force_down(
    mass: ArrayLike,
    inclination: float,
    friction: float,
    acceleration: ArrayLike = 0.0,
    gravity: float = STANDARD_GRAVITY,
) -> NDArray[np.float64]:
    """Formula (23): force [N] to tow `mass` [kg] down a slope of `inclination` [rad]; negative if it must be held back."""
    return towing_force_up(mass, -inclination, friction, acceleration, gravity)

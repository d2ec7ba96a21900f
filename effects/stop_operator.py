r"""The stop (Prandtl) operator: what follows a motion p within +-d, the friction of an elastic bristle that slides.

.. math:: \mathrm{d}z = \mathrm{d}p, \qquad |z| \le d

Its complement p - z is play (Visintin, Differential Models of Hysteresis, 1994, ch. III); a weighted sum of stops is Iwan's model.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel

Array = NDArray[np.float64]


@kernel
def sum_of_stops(p: Array, limit: Array, weight: Array) -> Array:
    """Sum of weight z/limit (m,) of stops that follow p (m,) from 0."""
    total = np.zeros(len(p))
    for k in range(len(limit)):
        if weight[k] > 0:
            z = 0.0
            for i in range(1, len(p)):
                z = min(max(z + p[i] - p[i - 1], -limit[k]), limit[k])
                total[i] += weight[k] * z / limit[k]
    return total


@kernel
def stop(p: Array, limit: float, start: float) -> Array:
    """z (m,) that follows p within +-limit, from `start`."""
    z = np.empty(len(p))
    z[0] = start
    for i in range(1, len(p)):
        z[i] = min(max(z[i - 1] + p[i] - p[i - 1], -limit), limit)
    return z

r"""What a contact does with its sliding speed v: friction that falls with it, and viscous drag.

.. math::

    \mu(v) = \mu + \Delta\mu\, e^{-(v/v_s)^p} \;(p > 0), \qquad \mu + \frac{\Delta\mu}{1 + (v/v_s)^2} \;(p = 0), \qquad
    f = -c\,v

The law of :class:`beam.axial_chain.AxialChain`, which names its sources. v is the speed of the contact point along the surface
and relative to it, at the end of the step, in the cone mu(v) f_n of :mod:`beam.contact_force`. The drag, per length, is that
of a film between cable and surface: it acts where the two touch, beside the cone and whatever the normal force.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel

Array = NDArray[np.float64]

FALL, FALL_SPEED, FALL_POWER, DRAG = 26, 27, 28, 29
"""Places of the law's numbers among the parameters of a surface, after those of :mod:`beam.contact_force`."""


@kernel
def friction_coefficient(p: Array, speed: float) -> float:
    """mu(v) of the surface `p` at a sliding speed of zero or more [m/s]."""
    if p[26] == 0.0:
        return p[3]
    x = speed / p[27]
    if p[28] == 0.0:
        return p[3] + p[26] / (1.0 + x * x)
    if p[28] == 2.0:
        x = x * x
    elif p[28] != 1.0:
        x = x ** p[28]
    return p[3] + p[26] * np.exp(-x)


@kernel
def coefficient_slope(p: Array, speed: float) -> float:
    """d mu / d v [s/m]."""
    if p[26] == 0.0:
        return 0.0
    x = speed / p[27]
    if p[28] == 0.0:
        return -2.0 * p[26] * x / (p[27] * (1.0 + x * x) ** 2)
    if p[28] == 1.0:
        return -p[26] / p[27] * np.exp(-x)
    x = max(x, 1e-12)
    return -p[26] * p[28] / p[27] * x ** (p[28] - 1.0) * np.exp(-(x ** p[28]))


@kernel
def speed_tangent(
    p: Array, u: Array, n: Array, closing: float, fn: float, factor: float, fade: Array, K: Array
) -> float:
    """mu at the relative velocity `u`; writes what its fall does to the limit, -f_n d(mu)/dx, into `fade`, adds the drag to `K`."""
    if p[26] == 0.0 and p[29] == 0.0:
        return p[3]
    total = 0.0
    for i in range(3):
        fade[i] = u[i] + closing * n[i]
        total += fade[i] * fade[i]
    speed = np.sqrt(total)
    change = -fn * coefficient_slope(p, speed) * factor / max(speed, 1e-300)
    for i in range(3):
        fade[i] *= change
        for j in range(3):
            K[i, j] += p[29] * factor * ((1.0 if i == j else 0.0) - n[i] * n[j])
    return friction_coefficient(p, speed)

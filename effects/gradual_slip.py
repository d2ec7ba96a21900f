r"""A stick-slip element that gives way gradually: it is stiff after every turn of the path and runs to its limit exponentially.

Measured in strain, with the limit x r,

.. math::  \frac{ds}{d\varepsilon} = 1 - \frac{s}{x\,r}\,\operatorname{sgn}(d\varepsilon)

which is Dahl's friction and, for metals, the kinematic hardening of Armstrong and Frederick without an elastic range. A step
of the strain is integrated exactly. Source: Dahl, AIAA J. 14 (1976) 1675; Armstrong & Frederick, CEGB report RD/B/N731
(1966), reprinted Mater. High Temp. 24 (2007) 1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel

Array = NDArray[np.float64]


@kernel
def _gradual_record(strain: Array, slip_strain: float, ratio: Array) -> Array:
    n = strain.size
    stress = np.empty((n, 1))
    s, before = 0.0, 0.0
    for i in range(n):
        step = strain[i] - before
        before = strain[i]
        limit = max(slip_strain * ratio[i], 1e-300)
        s = min(max(s, -limit), limit)
        towards = limit if step > 0.0 else -limit
        s = towards + (s - towards) * np.exp(-abs(step) / limit)
        stress[i, 0] = s
    return stress


def gradual_record(strain: Array, slip_strain: float, ratio: Array) -> Array:
    """Stress (n, 1) over stiffness along a record that starts at rest, unstrained; `ratio` (n,) multiplies the limit.

    Examples
    --------
    >>> gradual_record(np.array([0.0, 1.0, 100.0]), 1.0, np.ones(3)).round(3).ravel()
    array([0.   , 0.632, 1.   ])
    """
    return _gradual_record(np.ascontiguousarray(strain, dtype=float), float(slip_strain), ratio)


def gradual_step(stress: Array, step: Array, slip_strain: float, ratio: Array) -> Array:
    """Stress (n, 1) of one element at n points after a strain step (n,); `ratio` (n,) is that at the end of the step."""
    limit = np.maximum(slip_strain * ratio, 1e-300)
    held = np.clip(stress[:, 0], -limit, limit)
    towards = np.where(step > 0.0, limit, -limit)
    return (towards + (held - towards) * np.exp(-np.abs(step) / limit))[:, None]

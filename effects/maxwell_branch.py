r"""Maxwell branches in parallel: a spring and a dashpot in line, whose stress fades while the strain stands still.

Measured in strain, the stress q of a branch with relaxation time tau follows

.. math::  \dot q = \dot\varepsilon - q/\tau, \qquad
           q_n = e^{-h/\tau} q_{n-1} + \Delta\varepsilon_n\,\frac{1 - e^{-h/\tau}}{h/\tau},

exact where the strain is straight over each step h. A sudden strain, h = 0, is taken up in full.
Source: Maxwell 1867; the step is that of Taylor, Pister & Goudreau, Int. J. Numer. Meth. Eng. 2 (1970) 45-59.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel

Array = NDArray[np.float64]


@kernel
def _maxwell_record(strain: Array, time: Array, tau: Array) -> Array:
    n, m = strain.size, tau.size
    stress = np.empty((n, m))
    if n > 0:
        stress[0] = strain[0]
    keep, take, known = np.ones(m), np.ones(m), 0.0
    for i in range(1, n):
        h = time[i] - time[i - 1]
        if abs(h - known) > 1e-9 * known or h == 0.0:  # evenly sampled: the same factors again
            known = h
            for j in range(m):
                keep[j] = math.exp(-h / tau[j])
                take[j] = -math.expm1(-h / tau[j]) * tau[j] / h if h > 0.0 else 1.0
        step = strain[i] - strain[i - 1]
        for j in range(m):
            stress[i, j] = keep[j] * stress[i - 1, j] + take[j] * step
    return stress


def maxwell_record(strain: Array, time: Array, tau: Array) -> Array:
    """Stress (n, m) over stiffness of branches with relaxation times tau (m,) [s] > 0, at rest before the first sample.

    Examples
    --------
    >>> relaxed = maxwell_record(np.ones(3), np.array([0.0, 1.0, 2.0]), np.array([1.0]))
    >>> relaxed.ravel().round(4)
    array([1.    , 0.3679, 0.1353])
    """
    return _maxwell_record(np.ascontiguousarray(strain, dtype=float), np.ascontiguousarray(time, dtype=float), tau)


def maxwell_step(stress: Array, step: Array, dt: float, tau: Array) -> Array:
    """Stress (n, m) of m branches at n points after a strain step (n,) that took dt [s]."""
    x = dt / tau
    take = -np.expm1(-x) / x if dt > 0.0 else np.ones_like(tau)
    return np.exp(-x) * stress + take * step[:, None]

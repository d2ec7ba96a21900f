r"""Stick-slip elements in parallel: each sticks, and slips where its stress reaches a limit.

Measured in strain, the stress s of one element follows the stop operator,

.. math::  s_n = \min\bigl(\max(s_{n-1} + \Delta\varepsilon_n,\; -x\,r_n),\; x\,r_n\bigr),

x is the slip strain, r a factor on the limit of the moment. It is elastic and perfectly plastic, does not depend on
rate, and its branches obey Masing's rule; elements with different x in parallel give every smooth loop that does.
Source: Prandtl 1928; Iwan, J. Appl. Mech. 33 (1966) 893-900; Visintin, Differential Models of Hysteresis (1994).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel

Array = NDArray[np.float64]


@kernel
def _slip_record(strain: Array, slip_strain: Array, ratio: Array) -> Array:
    n, m = strain.size, slip_strain.size
    stress = np.empty((n, m))
    before = 0.0
    for i in range(n):
        step = strain[i] - before
        before = strain[i]
        for j in range(m):
            limit = slip_strain[j] * ratio[i]
            s = step + (stress[i - 1, j] if i > 0 else 0.0)
            s = limit if s > limit else s
            stress[i, j] = -limit if s < -limit else s
    return stress


def slip_record(strain: Array, slip_strain: Array, ratio: Array) -> Array:
    """Stress (n, m) over stiffness of m elements along a record that starts at rest, unstrained.

    Parameters
    ----------
    strain : (n,) array
    slip_strain : (m,) array
    ratio : (n,) array
        Factor on the slip limits at every sample.

    Examples
    --------
    >>> slip_record(np.array([1.0, 3.0, 2.0, 0.0]), np.array([2.0]), np.ones(4)).ravel()
    array([ 1.,  2.,  1., -1.])
    """
    return _slip_record(np.ascontiguousarray(strain, dtype=float), slip_strain, ratio)


def slip_step(stress: Array, step: Array, slip_strain: Array, ratio: Array) -> Array:
    """Stress (n, m) of m elements at n points after a strain step (n,); `ratio` (n,) is that at the end of the step."""
    limit = slip_strain * ratio[:, None]
    return np.clip(stress + step[:, None], -limit, limit)


@kernel
def _hardening_record(strain: Array, slip_strain: float, hardening: float) -> Array:
    n = strain.size
    stress = np.empty((n, 1))
    s, limit, before = 0.0, slip_strain, 0.0
    for i in range(n):
        s += strain[i] - before
        before = strain[i]
        over = abs(s) - limit
        if over > 0.0:
            limit += hardening * over / (1.0 + hardening)
            s = limit if s > 0.0 else -limit
        stress[i, 0] = s
    return stress


def hardening_record(strain: Array, slip_strain: float, hardening: float) -> Array:
    """Stress (n, 1) of an element whose limit grows by `hardening` times the slip it has gone through.

    Isotropic hardening by exact return mapping; Simo & Hughes, Computational Inelasticity (1998), section 1.4.
    """
    return _hardening_record(np.ascontiguousarray(strain, dtype=float), float(slip_strain), float(hardening))


def hardening_step(
    stress: Array, growth: Array, step: Array, slip_strain: float, hardening: float
) -> tuple[Array, Array]:
    """Stress (n,) of hardening elements after a strain step (n,), and by how much their limit has grown so far (n,)."""
    trial = stress + step
    over = np.maximum(np.abs(trial) - (slip_strain + growth), 0.0)
    growth = growth + hardening * over / (1.0 + hardening)
    limit = slip_strain + growth
    return np.clip(trial, -limit, limit), growth

"""Which element the kernels of a step work on: told by the unknowns of a node, 12 for the rod and 6 for the ANCF cable.

The functions have the arguments of their namesakes in :mod:`beam.element` and :mod:`beam.element_tangent`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam import element, element_tangent
from beam.ancf_cable_element import CABLE_DOF, add_line_mass, cable_force, cable_tangent, line_kinetic_energy

Array = NDArray[np.float64]

_rod_force = element.internal_force
_rod_tangent, _rod_mass = element_tangent.internal_tangent, element_tangent.add_mass
_NO_SHIFT, _NOT_APART = np.zeros(9), np.zeros((0, 0, 0))


def internal_force(
    q: Array, v: Array, a: Array, moving: bool, damped: bool, lengths: Array, H: Array, w: Array, C: Array,
    C_damping: Array, E0: Array, m: float, J: Array, mass: Array, F: Array, S: Array,
) -> tuple[float, float, float]:  # fmt: skip
    """Internal force and inertia of either element; elastic energy, damping power, kinetic energy (if `moving`)."""
    if q.shape[1] == CABLE_DOF:
        energy, power = cable_force(q, v, a, moving, damped, lengths, C, C_damping, m, mass, F, S)
        return energy, power, line_kinetic_energy(v, lengths, m, mass) if moving else 0.0
    return _rod_force(q, v, a, moving, lengths, H, w, C, C_damping, E0, m, J, F, S, _NO_SHIFT, 0.0, 0.0, _NOT_APART)


def internal_tangent(
    q: Array, v: Array, a: Array, moving: bool, factor: float, factor_a: float, lengths: Array, x: Array, H: Array,
    w: Array, C: Array, C_damping: Array, E0: Array, m: float, J: Array, mass: Array, D: Array, U: Array, L: Array,
) -> None:  # fmt: skip
    """Tangent of either element."""
    if q.shape[1] == CABLE_DOF:
        cable_tangent(q, v, moving, factor, factor_a, lengths, C, C_damping, m, mass, D, U, L)
    else:
        _rod_tangent(q, v, a, moving, factor, factor_a, lengths, x, H, w, C, C_damping, E0, m, J, mass, D, U, L)


def add_mass(
    factor: float, lengths: Array, w: Array, H: Array, m: float, J: Array, mass: Array, D: Array, U: Array, L: Array
) -> None:
    """Mass matrix of either element, of the rod with unturned sections."""
    if D.shape[1] == CABLE_DOF:
        add_line_mass(factor, lengths, m, mass, D, U, L)
    else:
        _rod_mass(factor, lengths, w, H, m, J, mass, D, U, L)

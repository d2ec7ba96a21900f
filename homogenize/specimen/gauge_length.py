r"""Strain over a gauge length in the middle of a specimen, as an extensometer reads it, and the modulus it gives.

.. math::  \varepsilon = \frac{\bar u_z(z_2) - \bar u_z(z_1)}{z_2 - z_1}, \qquad E = \frac{F}{A\,\varepsilon},

with the mean displacement over the section. Far from the ends it approaches the long cable's value with free twist, where the
displacement of the loaded end does not.
"""

from __future__ import annotations

import numpy as np

from geometry.errors import SpecError
from homogenize.section_field import FloatArray
from homogenize.specimen.apparent_modulus import node_weights
from homogenize.specimen.specimen_solution import SpecimenSolution


def mean_axial_displacement(solution: SpecimenSolution, z: FloatArray) -> FloatArray:
    """(z, loads) mean of u_z over the section at heights [m]."""
    field = solution.system.field
    at_stations = np.einsum("n,nmk->mk", node_weights(field), solution.nodal[:, 2]) / field.area
    N, _ = solution.operator.axial.at(np.asarray(z, dtype=float))
    return N @ at_stations


def gauge_modulus(solution: SpecimenSolution, load: int = 0, part: float = 0.2) -> float:
    """E [Pa] from the strain over the middle `part` of the length, under a tension.

    Raises
    ------
    SpecError
        If the part is not between 0 and 1, or the load is not a tension.
    """
    case, L = solution.loads[load], solution.specimen.length
    if not 0 < part <= 1:
        raise SpecError(f"a gauge length is a part of the specimen between 0 and 1, found {part:g}.")
    if case.kind != "tension":
        raise SpecError(f"a gauge length reads the strain of a tension, found the load {case.name}.")
    low, high = mean_axial_displacement(solution, np.array([0.5 - part / 2, 0.5 + part / 2]) * L)[:, load]
    return float(case.size / solution.system.field.area * part * L / (high - low))

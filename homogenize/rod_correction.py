r"""What a member of a cable bends: its local curvature for every strain of the cable, and the stiffness that follows from it.

A helical member with the bending stiffness EI that is drawn as a solid of another bending stiffness EI_drawn changes the energy of the
cable per length, for the same displacements, by (EI - EI_drawn) (kappa_n^2 + kappa_b^2) / (2 cos beta). With the curvatures linear in the
strains of the cable, kappa = J psi,

.. math::  C_{corrected} = C + \sum \frac{EI - EI_{drawn}}{\cos\beta} J^T J .

The displacements are those of the drawn section, so that by the principle of least energy C_corrected is an upper bound of
what a new solution would give, and exact where the member is thin and what is round it is soft: it follows the cable whatever its EI.
J comes from the field: curvature is the first moment of the strain e_tt along the member over its normal section,

.. math::  \kappa_n = \int e_{tt}\, d_n \,dA \Big/ \int d_n^2 \,dA ,

d_n and d_b the distances from the centre line along its normal and binormal.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geometry import Part
from homogenize.helical_cell import HelicalCell


def local_curvature(cell: HelicalCell, region: int, part: Part) -> NDArray[np.float64]:
    """J (2, 6): curvature of a member about its binormal and its normal per strain of the cable, rotating axes at phase zero."""
    tau = cell.field.twist_rate
    centre = part.centre_radius * np.array([np.cos(part.phase), np.sin(part.phase), 0.0])
    tangent = np.array([-tau * centre[1], tau * centre[0], 1.0])
    tangent /= np.linalg.norm(tangent)
    normal = np.array([np.cos(part.phase), np.sin(part.phase), 0.0])
    inside = cell.field.region_of == region
    X, Y = cell.field.position[:, inside] - centre[:2, None, None]
    distance = np.stack([v[0] * X + v[1] * Y for v in (normal, np.cross(tangent, normal))])
    weight = cell.field.weight[inside]
    distance = distance - (distance * weight).sum(axis=(1, 2), keepdims=True) / weight.sum()
    moment = np.linalg.inv(np.einsum("aeq,beq,eq->ab", distance, distance, weight))
    t = tangent
    along = np.array([t[0] ** 2, t[1] ** 2, t[2] ** 2, t[1] * t[2], t[0] * t[2], t[0] * t[1]])
    per_force = np.stack([cell.strain(unit)[inside] @ along for unit in np.eye(6)], axis=-1)
    return moment @ np.einsum("aeq,eq,eqf->af", distance, weight, per_force) @ cell.stiffness.C


def bending_correction(cell: HelicalCell, region: int, part: Part, excess: float) -> NDArray[np.float64]:
    """Change (6, 6) of the stiffness of the cable at phase zero, for a member whose EI [N m^2] is larger by `excess` than drawn."""
    J = local_curvature(cell, region, part)
    return excess / np.cos(part.lay_angle) * J.T @ J

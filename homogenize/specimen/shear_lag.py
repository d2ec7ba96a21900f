r"""How the load passes from part to part along a specimen: the axial force in each part.

.. math::  N_p(z) = \int_{A_p} \sigma_{zz}\, dA, \qquad \sum_p N_p = F .

A load that enters the rubber of the end-section is handed over to the conductors by shear within a transfer length; for two
coaxial cylinders the shares approach those of a long bar as exp(-z / l), see the tests for the closed form (Cox, Br. J. Appl. Phys. 3
(1952) 72-79; Volkersen 1938).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from homogenize.section_field import FloatArray
from homogenize.specimen.apparent_modulus import section_integrals
from homogenize.specimen.specimen_solution import SpecimenSolution


@dataclass(frozen=True)
class ShearLag:
    """Axial forces along a specimen.

    Attributes
    ----------
    z : (g,) heights [m]
    parts : names
    force : (parts, g) axial force in each part [N]
    load : name of the load case
    """

    z: FloatArray
    parts: tuple[str, ...]
    force: FloatArray
    load: str

    @property
    def share(self) -> FloatArray:
        """(parts, g) part of the whole axial force; for loads with a tension."""
        return self.force / self.force.sum(axis=0)

    def half_length(self, part: str, from_end: float) -> float:
        """Distance [m] from the loaded end, at height `from_end`, in which a part takes up half the share it has at mid-length."""
        share = self.share[self.parts.index(part)]
        middle = float(np.interp(from_end / 2, self.z, share))
        depth, rising = (from_end - self.z)[::-1], share[::-1]
        reached = np.flatnonzero((depth <= from_end / 2) & (rising >= middle / 2))
        return float(depth[reached[0]]) if len(reached) else float("nan")


def shear_lag(solution: SpecimenSolution, load: int = 0) -> ShearLag:
    """Axial force of every part at the Gauss points of the length, under one load case.

    Each layer's forces are replaced by the parabola nearest to them: at the rim between two materials of the loaded face the stress is
    singular, and polynomials of a higher degree swing about it.
    """
    field, T = solution.system.field, solution.system.T
    z, weight, N, D = solution.operator.axial.quadrature
    U = solution.U[:, :, load]
    forces = []
    for number in range(len(solution.mesh.regions)):
        inner, across = (a[2] for a in section_integrals(field, field.region_of == number, stress=True))
        if T is not None:
            inner, across = T.T @ inner, T.T @ across
        forces.append(N @ (inner @ U) + D @ (across @ U))
    names = tuple(region.name for region in solution.mesh.regions)
    smooth = _parabolas(z, weight, solution.operator.axial.layers)
    return ShearLag(
        z,
        names,
        np.einsum("lgh,plh->plg", smooth, np.array(forces).reshape(len(names), *smooth.shape[:2])).reshape(
            len(names), -1
        ),
        solution.loads[load].name,
    )


def _parabolas(z: FloatArray, weight: FloatArray, layers: int) -> FloatArray:
    """(layers, g, g) from values at the Gauss points of a layer to those of the parabola of least squares."""
    z, weight = z.reshape(layers, -1), weight.reshape(layers, -1)
    x = (z - z.mean(axis=1, keepdims=True)) / np.ptp(z, axis=1)[:, None]
    A = x[:, :, None] ** np.arange(3)
    B = A.transpose(0, 2, 1) * weight[:, None, :]
    return A @ np.linalg.solve(B @ A, B)


def grouped(lag: ShearLag, kind_of: dict[str, str]) -> ShearLag:
    """Parts of one group added up; `kind_of` names the group of each part."""
    groups = tuple(dict.fromkeys(kind_of[p] for p in lag.parts))
    force = np.array([sum(f for p, f in zip(lag.parts, lag.force) if kind_of[p] == g) for g in groups])
    return ShearLag(lag.z, groups, force, lag.load)

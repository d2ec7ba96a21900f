r"""Moduli by volume averages, and the energy values beside them.

Formula (3) of Ge et al., PLoS ONE 18(2) e0281136 (2023), doi 10.1371/journal.pone.0281136: the equivalent modulus is the mean
stress over the mean strain, :math:`\langle q \rangle = \frac1V \sum_i V_i q_i`. Every section of a long cable is the same
up to its angle, so the volume average over a piece of cable is the area average over the section.

* Axial: :math:`E = \langle\sigma_{zz}\rangle / \langle\varepsilon_{zz}\rangle`, once with the twist blocked, once with the torque zero.
* Shear: the sides of the cable carry the tractions of a uniform shear stress :math:`\Sigma_{xz}`, so that every section has
  the shear force :math:`A \Sigma_{xz}`, no bending moment, and :math:`\langle\tau_{xz}\rangle = \Sigma_{xz}`. Then
  :math:`G_{yoz} = \langle\tau_{xz}\rangle / \langle\gamma_{xz}\rangle` with
  :math:`\gamma_{xz} = \partial_z u_x + \partial_x u_z`; G_xoz the same along y.
  The section warps freely (the warping is finite and the same in every section); its mean rotation is the area mean of
  :math:`\partial_x u_z`, so that in the frame in which the mean rotation is zero the mean shear strain is the slope of the axis.
  For these loads :math:`\langle\sigma : \varepsilon\rangle = \langle\sigma\rangle : \langle\varepsilon\rangle` (Hill), hence G > 0.
  The source pairs the +-X tests with the plane yoz and the +-Y tests with xoz.

This G is a property of the material mix. The shear stiffness of the beam, GA, is another quantity: it includes the moment that a
shear force builds up along the cable, see :mod:`homogenize.helical_cell`.

Where parts slide, the mean axial strain inside the parts misses the jumps between them (by 1 to 8 % on the built-in cables); E is
then EA / A, which is what the mean over parts and jumps would give. Under uniform shear the jumps cancel over a pitch: Hill's lemma
holds with the strains inside the parts, which a test checks.

The mean shear strains are a symmetric 2x2 matrix S per unit mean shear stress. A section turned by the angle phi has
R S R^T; the average over a pitch of the cable is tr S / 2 for both planes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from homogenize.helical_cell import HelicalCell
from homogenize.section_stiffness import pitch_average


@dataclass(frozen=True)
class VolumeAverage:
    """Moduli [Pa] of a long cable by formula (3), all referred to the area of the section (2D cell: the mesh area).

    ``E_blocked_twist`` and ``E_free_twist``; ``G_yoz`` and ``G_xoz`` averaged over the pitch; ``shear`` (2, 2) [1/Pa], mean shear
    strain (gamma_x, gamma_y) per mean shear stress (x, y) at phase zero.
    """

    E_blocked_twist: float
    E_free_twist: float
    G_yoz: float
    G_xoz: float
    shear: NDArray[np.float64]

    def shear_moduli_at(self, phase: float) -> tuple[float, float]:
        """(G_yoz, G_xoz) [Pa] of the section turned by `phase` [rad] about z."""
        c, s = np.cos(phase), np.sin(phase)
        R = np.array([[c, -s], [s, c]])
        turned = R @ self.shear @ R.T
        return float(1.0 / turned[0, 0]), float(1.0 / turned[1, 1])


def volume_average(cell: HelicalCell) -> VolumeAverage:
    """Formula (3) on the solved cell: mean stress over mean strain for tension and for shear.

    Parameters
    ----------
    cell : HelicalCell
        Solved cross-section.

    Returns
    -------
    VolumeAverage
        Moduli in Pa.
    """
    shear = _mean_shear(cell)
    if cell.interface != "bonded":
        section = pitch_average(cell.stiffness)
        blocked, free = section.E_blocked_twist, section.E_free_twist
    else:
        tension, torque = np.eye(6)[2], np.eye(6)[5]  # no other force or moment
        F = cell.stiffness.compliance
        blocked = _axial(cell, tension - F[5, 2] / F[5, 5] * torque)  # with the torque that keeps the twist zero
        free = _axial(cell, tension)
    mean = float(1.0 / (0.5 * np.trace(shear)))
    return VolumeAverage(blocked, free, mean, mean, shear)


def _mean_shear(cell: HelicalCell) -> NDArray[np.float64]:
    """Mean shear strain per mean shear stress, (2, 2)."""
    weight = cell.field.weight / cell.field.area
    shear = np.einsum("eq,eqic->ic", weight, cell.shear_strain())[[4, 3]]
    return 0.5 * (shear + shear.T)


def _axial(cell: HelicalCell, section_forces: NDArray[np.float64]) -> float:
    stress, strain = _means(cell, section_forces)
    return float(stress[2] / strain[2])


def _means(cell: HelicalCell, section_forces: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Area means of stress and strain, each (6,)."""
    weight = cell.field.weight / cell.field.area
    strain, stress = cell.strain(section_forces), cell.stress(section_forces)
    return np.einsum("eq,eqi->i", weight, stress), np.einsum("eq,eqi->i", weight, strain)

r"""What a linear specimen answers to a newton of tension and of shear, and the published numbers made of it.

Held all over z = 0, loaded by a uniform traction on z = L. With the loads in the axes X, Y of the loaded section one
tension and two shears serve every phase and every transverse direction, because the held end does not know how the section
stood there. With a bar for the mean over the loaded end and brackets for that over the volume

.. math::  E = \frac{F L}{A\, \bar u_z}, \qquad
           G_x = \frac{F}{A \,(\bar u_x / L + \langle \partial_x u_z \rangle)},

which are formula (3) of Ge et al., PLoS ONE 18(2) e0281136 (2023), since <s_zz> = F / A and <t_xz> = F / A by equilibrium.
G_yoz belongs to the force along x, G_xoz to that along y; u is the largest displacement along the force.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from homogenize.section_field import FloatArray, SectionField
from homogenize.specimen.apparent_modulus import node_weights
from homogenize.specimen.axial_basis import AxialBasis
from homogenize.specimen.load_case import LoadCase
from homogenize.specimen.specimen_solution import SpecimenSolution

UNIT_LOADS = (LoadCase("tension", 1.0), LoadCase("shear", 1.0, "x"), LoadCase("shear", 1.0, "y"))
"""Tension and two shears of 1 N; with the phase -tau_0 L they act along the axes of the loaded section."""


@dataclass(frozen=True)
class UnitResponse:
    """Response of a specimen to a newton of each load, in the axes of the loaded section.

    Attributes
    ----------
    area, length : [m^2], [m]
    top : (nodes, 3, 3) displacement of the loaded end per newton: node, component, load
    mean : (3, 3) mean displacement of the loaded end per newton: component, load
    tilt : (2, 3) volume average of (du_z/dx, du_z/dy) per newton
    """

    area: float
    length: float
    top: FloatArray
    mean: FloatArray
    tilt: FloatArray

    def outputs(self, tension: float, shear: float, angle: float = 0.0) -> dict[str, float]:
        """Moduli by volume averages [Pa] and largest displacements [m]; `angle` [rad] of x before X at the loaded end."""
        A, L = self.area, self.length
        found = {
            "E": L / (A * self.mean[2, 0]),
            "u_z": abs(tension) * float(np.abs(self.top[:, 2, 0]).max()),
        }
        c, s = np.cos(angle), np.sin(angle)
        for name, modulus, d in (("u_x", "G_yoz", np.array([c, -s])), ("u_y", "G_xoz", np.array([s, c]))):
            load = self.mean[:2, 1:] @ d, self.tilt[:, 1:] @ d
            found[modulus] = float(1 / (A * (d @ load[0] / L + d @ load[1])))
            found[name] = abs(shear) * float(np.abs(np.einsum("nxk,x,k->n", self.top[:, :2, 1:], d, d)).max())
        return found


def unit_response(solution: SpecimenSolution) -> UnitResponse:
    """The response of a specimen that was solved for UNIT_LOADS at the phase -tau_0 L."""
    field, axial, nodal = solution.system.field, solution.operator.axial, solution.nodal
    top = nodal[:, :, -1]
    flat = nodal.reshape(-1, *nodal.shape[2:])
    local = np.einsum("dn,nmk->dmk", area_derivatives(field), flat) / field.area
    mean = np.einsum("n,nxk->xk", node_shares(field), top)
    return UnitResponse(
        field.area, solution.specimen.length, top, mean, mean_tilt(local, axial, solution.mesh.twist_rate)
    )


def mean_tilt(local: FloatArray, axial: AxialBasis, twist_rate: float) -> FloatArray:
    """Volume average (2, loads) of the in-plane gradient of u_z in the axes of the loaded section, from its means over the
    section at the stations, `local` (2, m, loads), in rotating axes."""
    z, w, N, _ = axial.quadrature
    at = np.einsum("gm,dmk->gdk", N, local)
    angle = twist_rate * (z - axial.levels[-1])
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    turned = np.stack([c * at[:, 0] - s * at[:, 1], s * at[:, 0] + c * at[:, 1]])
    return np.einsum("g,dgk->dk", w, turned) / axial.levels[-1]


def node_shares(field: SectionField) -> FloatArray:
    """(nodes,) share of each node in the area: the nodal forces of a uniform traction of resultant one."""
    return node_weights(field) / field.area


def area_derivatives(field: SectionField) -> FloatArray:
    """(2, unknowns): integrals over the section of dN/dX and dN/dY on the axial component."""
    found = np.zeros((2, field.unknowns))
    for d in range(2):
        local = np.einsum("aeq,eq->ae", field.gradient[d], field.weight)
        np.add.at(found[d], 3 * field.cells + 2, local)
    return found

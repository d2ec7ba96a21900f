r"""What every cell result must satisfy, checked on each run and shown beside the result.

* Lower bound: a straight part that holds the axis shares the strain, so :math:`EA \ge E_c A_c` at blocked and at free twist,
  whatever the interfaces (Jensen's inequality on its uniaxial energy).
* Upper bound: the field of unit stretch with one common lateral strain e is admissible, so

  .. math:: EA \le \min_e \int \lambda (1 + 2 e)^2 + 2 G (1 + 2 e^2)\, dA ,

  which is the sum of E A plus the Poisson mismatch between the parts.
* Reciprocity: the torque of unit stretch equals the tension of unit twist; both are integrated from the local stresses.
* Energy = work: the strain energy integrated over the section equals half the section forces times the section strains.
* Equilibrium: the reactions of the pinned unknowns vanish.

Bounds: Hill, J. Mech. Phys. Solids 11 (1963) 357-372, doi 10.1016/0022-5096(63)90036-X.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from homogenize.helical_cell import REACTION_LIMIT, HelicalCell
from homogenize.section_stiffness import pitch_average

ROUND_OFF = 1e-7
"""Relative difference allowed between two integrals of the same solution."""


@dataclass(frozen=True)
class Check:
    """A statement checked on the result: its `name`, the `sentence` with the numbers, and whether it `holds`."""

    name: str
    sentence: str
    holds: bool


def axial_bounds(mesh: CrossSectionMesh, cell: HelicalCell) -> tuple[float, float]:
    """Lower and upper bound [N] of the axial stiffness; the lower one is 0 if no part is centred on the axis."""
    area = np.bincount(mesh.region_of, cell.field.weight.sum(axis=1), len(mesh.regions))
    E, G, lame = np.array([(r.material.E, r.material.G, r.material.lame) for r in mesh.regions]).T
    a, b = float(lame @ area), float(G @ area)
    e = -a / (2 * (a + b))
    upper = a * (1 + 2 * e) ** 2 + 2 * b * (1 + 2 * e**2)
    central = _central_region(mesh, cell)
    lower = 0.0 if central is None else float(E[central] * area[central])
    return lower, float(upper)


def check_cell(mesh: CrossSectionMesh, cell: HelicalCell) -> tuple[Check, ...]:
    """All checks on a solved cell; see the module docstring for each statement."""
    section = pitch_average(cell.stiffness)
    lower, upper = axial_bounds(mesh, cell)
    blocked, free = section.EA_blocked_twist, section.EA_free_twist
    rule = sum(
        r.material.E * a
        for r, a in zip(mesh.regions, np.bincount(mesh.region_of, cell.field.weight.sum(axis=1)), strict=True)
    )
    torque, tension = reciprocal_couplings(cell)
    energy, work = _energy_and_work(cell)
    symmetry = abs(torque - tension) / np.sqrt(section.C[2, 2] * section.C[5, 5])
    balance = abs(energy - work) / work
    slack = 1 + ROUND_OFF
    least = f"E A of the central part {lower / 1e6:.4g} MN" if lower > 0 else "no part fills the axis; 0"
    return (
        Check(
            "lower bound",
            f"{least} <= EA free twist {free / 1e6:.4g} MN <= blocked {blocked / 1e6:.4g} MN",
            lower <= free * slack and free <= blocked * slack,
        ),
        Check(
            "upper bound",
            f"EA blocked twist {blocked / 1e6:.5g} MN <= {upper / 1e6:.5g} MN (sum of E A {rule / 1e6:.5g} MN plus Poisson mismatch)",
            blocked <= upper * slack,
        ),
        Check(
            "reciprocity",
            f"torque per stretch {torque:.6g} N m, tension per twist {tension:.6g} N m; difference {symmetry:.1e} of sqrt(EA GJ)",
            bool(symmetry < ROUND_OFF),
        ),
        Check("energy = work", f"strain energy and work differ by {balance:.1e}", bool(balance < ROUND_OFF)),
        Check(
            "equilibrium",
            f"reactions at the pins {cell.reaction:.1e} of the nodal forces",
            cell.reaction < REACTION_LIMIT,
        ),
    )


def _central_region(mesh: CrossSectionMesh, cell: HelicalCell) -> int | None:
    """The region that fills a circle about the axis, if there is one (a lobed region has no bound of this kind)."""
    x, y = cell.field.position
    region = int(mesh.region_of[int(np.argmin((x**2 + y**2).min(axis=1)))])
    inside = mesh.region_of == region
    area = float(cell.field.weight[inside].sum())
    radius = float(np.linalg.norm(cell.field.nodes[:, cell.field.cells[:, inside]], axis=0).max())
    return region if abs(area / (np.pi * radius**2) - 1) < 0.02 else None


def _resultants(cell: HelicalCell, section_forces: NDArray[np.float64]) -> tuple[float, float]:
    """Tension and torque integrated from the local stresses."""
    stress = cell.stress(section_forces)
    x, y = cell.field.position
    w = cell.field.weight
    return float((w * stress[..., 2]).sum()), float((w * (x * stress[..., 3] - y * stress[..., 4])).sum())


def reciprocal_couplings(cell: HelicalCell) -> tuple[float, float]:
    """Torque of unit stretch and tension of unit twist, each from its own stress field; no transverse forces or moments."""
    pair = np.linalg.inv(cell.stiffness.compliance[np.ix_([2, 5], [2, 5])])
    stretch, twist = np.zeros(6), np.zeros(6)
    stretch[[2, 5]], twist[[2, 5]] = pair[:, 0], pair[:, 1]
    return _resultants(cell, stretch)[1], _resultants(cell, twist)[0]


def _energy_and_work(cell: HelicalCell) -> tuple[float, float]:
    """Twice the energy per length from local fields, and resultants of the stress times section strains, for a mixed load."""
    diagonal = np.diag(cell.stiffness.C)
    load = np.zeros(6)
    load[2], load[5] = np.sqrt(diagonal[2]), np.sqrt(diagonal[5])
    strain, stress = cell.strain(load), cell.stress(load)
    energy = float(np.einsum("eq,eqi,eqi->", cell.field.weight, strain, stress))
    if cell.interface_compliance is not None:
        energy += float(load @ cell.interface_compliance @ load)
    tension, torque = _resultants(cell, load)
    psi = cell.stiffness.compliance @ load
    return energy, tension * psi[2] + torque * psi[5]

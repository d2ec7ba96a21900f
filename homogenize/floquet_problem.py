r"""One group of loads on the three-dimensional cell: unit section strains, then shear.

For each unit section strain the displacement is the macroscopic field plus a part that repeats with the factor of its
load, u = u_macro + R v, and minimises the energy of the cell of height H:

.. math:: R^H K R\, v = -R^H K u_{macro}, \qquad C_{ij} = \tfrac1H\, u_i^H K u_j .

Shear is the generalised eigenvector: with the fields u_M of unit moments, :math:`u_T(Q x + H e_z) = s\,Q\,[u_T(x) + H\,u_M(x)\,M']` up to
a rigid motion, and balance of the forces across the seam reads

.. math:: R^H K u_T = -H\, (K u_M)_{bottom}\, M' .

The compliance of shear is the energy of u_T - u_M M(z), what is left when the field of the moment that acts at each height is taken
off, per length and averaged over the cell: the definition of :mod:`homogenize.helical_cell`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geometry.cell_mesh import SliceMesh, SweptCell
from geometry.errors import ConvergenceError
from homogenize.floquet_load import LoadGroup, macroscopic_fields
from homogenize.helical_periodicity import reduced_matrix, reduction
from homogenize.mean_dilatation import bricks, element_energies
from homogenize.multigrid import Multigrid, Solution

Progress = Callable[[float, str], None]
Mesh = SliceMesh | SweptCell


@dataclass(frozen=True)
class SolvedGroup:
    """Solved loads of one group.

    Attributes
    ----------
    names : of the load cases
    stiffness : (m, m) section forces per unit section strain, without shear
    compliance : (m + k, m + k) of the section forces of the group and of its shear forces
    fields : (m, 3n) displacement per unit section strain
    solutions : of the linear systems, in the order of `names`
    unknowns : free displacement components
    complexity : of the multigrid hierarchy
    """

    names: tuple[str, ...]
    stiffness: NDArray
    compliance: NDArray
    fields: NDArray
    solutions: tuple[Solution, ...]
    unknowns: int
    complexity: float


def solve_group(
    mesh: Mesh, K: sp.bsr_array, group: LoadGroup, tolerance: float, max_iterations: int, tell: Progress
) -> SolvedGroup:
    """Solve all loads of a group on one hierarchy; K is the matrix of the unconstrained cell.

    Raises
    ------
    ConvergenceError
        If conjugate gradients stop before the tolerance; the message names the load.
    """
    system = _System(mesh, K, group, tolerance, max_iterations, tell)
    shears = ("shear",) if group.shears.shape[1] == 1 else ("shear along x", "shear along y")[: group.shears.shape[1]]
    names = (*group.names, *shears)
    macro = macroscopic_fields(mesh.points, group.forces)
    loads = _products(K, macro)
    parts = np.array(
        [system.solve(name, -f, i, len(names)) for i, (name, f) in enumerate(zip(names, loads, strict=False))]
    )
    fields = macro + parts
    stiffness = fields.conj() @ _products(K, fields).T / mesh.height
    stiffness = 0.5 * (stiffness + stiffness.conj().T)
    compliance = np.linalg.inv(stiffness)
    if group.shears.size:
        strains = compliance @ group.growth  # per length and unit shear force, columns
        unit = compliance.T @ fields
        bent = strains.T @ parts
        particular = macroscopic_fields(mesh.points, group.forces @ strains, order=2).astype(fields.dtype)
        particular += system.jump(mesh.height * bent)
        seam = mesh.height * system.bottom_forces(strains.T @ fields)
        rhs = [-f - s for f, s in zip(_products(K, particular), seam, strict=True)]
        shear = particular + np.array(
            [system.solve(names[len(macro) + j], f, len(macro) + j, len(names)) for j, f in enumerate(rhs)]
        )
        mean = macro.conj() @ _products(K, shear).T / mesh.height
        compliance = _compliance(mesh, unit, shear, group.growth, mean)
    return SolvedGroup(
        names, stiffness, compliance, fields, tuple(system.solutions), system.unknowns, system.multigrid.complexity
    )


def _compliance(mesh: Mesh, unit: NDArray, shear: NDArray, growth: NDArray, mean: NDArray) -> NDArray:
    """Mean energy per length of the unit forces and of the shear forces, each without the moment that acts at its height."""
    m, k = len(unit), len(shear)
    energy = element_energies(mesh, np.concatenate([unit, shear]))
    z = mesh.points[bricks(mesh).corners, 2].mean(axis=1) - 0.5 * mesh.height
    take = np.zeros((len(z), m + k, m + k), dtype=energy.dtype)
    take[:, range(m + k), range(m + k)] = 1.0
    take[:, :m, m:] = -(growth * z[:, None, None] + mean)
    F = np.einsum("eji,ejl,elk->ik", take.conj(), energy, take, optimize=True) / mesh.height
    return 0.5 * (F + F.conj().T)


class _System:
    """The reduced problem of one group, with its hierarchy."""

    def __init__(
        self, mesh: Mesh, K: sp.bsr_array, group: LoadGroup, tolerance: float, max_iterations: int, tell: Progress
    ) -> None:
        self.mesh, self.K, self.tell = mesh, K, tell
        self.tolerance, self.max_iterations = tolerance, max_iterations
        angle = mesh.twist_rate * mesh.height
        c, s = np.cos(angle), np.sin(angle)
        motion = group.factor * np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        self.motion = motion if group.circular else motion.real
        self.R, free = reduction(len(mesh.points), mesh.bottom, mesh.top, self.motion)
        self.unknowns = 3 * len(free)
        tell(0.0, f"building the multigrid hierarchy for {self.unknowns} unknowns")
        reduced = reduced_matrix(K, mesh.bottom, mesh.top, self.motion)
        self.multigrid = Multigrid(reduced, mesh.points[free], mesh.height)
        self.solutions: list[Solution] = []

    def solve(self, name: str, load: NDArray, number: int, total: int) -> NDArray:
        """The repeating field (3n,) under nodal forces (3n,) on the unconstrained cell."""
        begin = 0.2 + 0.8 * number / total

        def watch(count: int, residual: float) -> None:
            if count % 5 == 0:
                done = min(1.0, np.log(max(residual, self.tolerance)) / np.log(self.tolerance))
                self.tell(
                    begin + 0.8 * done / total, f"solving {name}: residual {residual:.0e} after {count} iterations"
                )

        found = self.multigrid.solve(self.R.conj().T @ load, self.tolerance, self.max_iterations, watch)
        if not found.residual <= 10 * self.tolerance:
            raise ConvergenceError(
                f"the {name} problem of the cell stopped at a relative residual of {found.residual:.1e} after {found.iterations} "
                f"iterations (wanted {self.tolerance:.0e}); Poisson's ratios above 0.49 make it slow: try 0.49, or a finer mesh."
            )
        self.solutions.append(found)
        return self.R @ found.unknowns

    def jump(self, fields: NDArray) -> NDArray:
        """Fields (k, 3n) that are zero but on the top, where they are what is carried there from the bottom."""
        out = np.zeros_like(fields).reshape(len(fields), -1, 3)
        out[:, self.mesh.top] = fields.reshape(len(fields), -1, 3)[:, self.mesh.bottom] @ self.motion.T
        return out.reshape(len(fields), -1)

    def bottom_forces(self, fields: NDArray) -> NDArray:
        """Nodal forces (k, 3n) of the fields on the bottom, zero elsewhere."""
        forces = _products(self.K, fields).reshape(len(fields), -1, 3)
        out = np.zeros_like(forces)
        out[:, self.mesh.bottom] = forces[:, self.mesh.bottom]
        return out.reshape(len(fields), -1)


def _products(K: sp.bsr_array, fields: NDArray) -> NDArray:
    """K u for every field (m, 3n); K stays real."""
    if not np.iscomplexobj(fields):
        return np.array([K @ u for u in fields])
    return np.array([(K @ np.ascontiguousarray(u.real)) + 1j * (K @ np.ascontiguousarray(u.imag)) for u in fields])

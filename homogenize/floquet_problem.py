r"""One group of loads on the three-dimensional cell: unit section strains, then shear.

For each unit section strain the displacement is the macroscopic field plus a part that repeats with the factor of its
load, u = u_macro + R v, and minimises the energy of the cell of height H:

.. math:: R^H K R\, v = -R^H K u_{macro}, \qquad C_{ij} = \tfrac1H\, u_i^H K u_j .

Shear is the generalised eigenvector: with the fields u_M of unit moments, :math:`u_T(Q x + H e_z) = s\,Q\,[u_T(x) + H\,u_M(x)\,M']` up to
a rigid motion, and balance of the forces across the seam reads

.. math:: R^H K u_T = -H\, (K u_M)_{bottom}\, M' .

The compliance of shear is the energy of u_T - u_M M(z), what is left when the field of the moment that acts at each height is taken
off, per length and averaged over the cell: the definition of :mod:`homogenize.helical_cell`. Near-incompressible elements carry
pressures beside u (:mod:`homogenize.element_pressure`); K then stands for the matrix of both.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.cell_mesh import SliceMesh, SweptCell
from geometry.errors import ConvergenceError
from homogenize.cell_operator import CellOperator
from homogenize.energy_gmres import Solution, energy_gmres
from homogenize.floquet_load import LoadGroup, macroscopic_fields
from homogenize.helical_periodicity import reduced_matrix, reduction
from homogenize.mean_dilatation import bricks
from homogenize.multigrid import Multigrid

Progress = Callable[[float, str], None]
Mesh = SliceMesh | SweptCell

MOMENTS = 1e-2
"""Share of the tolerance for moments that shear follows: its stiffness errs as their fields do, not as the square."""
SHEARS = 0.05
"""Share of the tolerance for shear, whose field is large against what is left of it without the moment at each height."""
ROUNDING = 1e-10
"""Tolerance below which no load is asked for more than the others."""


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
    mesh: Mesh, M: CellOperator, group: LoadGroup, tolerance: float, max_iterations: int, tell: Progress
) -> SolvedGroup:
    """Solve all loads of a group on one hierarchy; M is the operator of the unconstrained cell.

    Raises
    ------
    ConvergenceError
        If the iteration stops before the tolerance; the message names the load.
    """
    system = _System(mesh, M, group, max_iterations, tell)
    shears = ("shear",) if group.shears.shape[1] == 1 else ("shear along x", "shear along y")[: group.shears.shape[1]]
    names = (*group.names, *shears)
    macro = M.with_pressures(macroscopic_fields(mesh.points, group.forces))
    loads = M.products(macro)
    fine = tolerance if not group.shears.size else min(tolerance, max(MOMENTS * tolerance, ROUNDING))
    parts = np.array(
        [system.solve(name, -f, i, len(names), fine) for i, (name, f) in enumerate(zip(names, loads, strict=False))]
    )
    fields = macro + parts
    stiffness = fields.conj() @ M.products(fields).T / mesh.height
    stiffness = 0.5 * (stiffness + stiffness.conj().T)
    compliance = np.linalg.inv(stiffness)
    if group.shears.size:
        strains = compliance @ group.growth  # per length and unit shear force, columns
        unit = compliance.T @ fields
        bent = strains.T @ parts
        second = macroscopic_fields(mesh.points, group.forces @ strains, order=2)
        particular = M.with_pressures(second.astype(fields.dtype))
        particular += system.jump(mesh.height * bent)
        seam = mesh.height * system.bottom_forces(strains.T @ fields)
        rhs = [-f - s for f, s in zip(M.products(particular), seam, strict=True)]
        fine = min(tolerance, max(SHEARS * tolerance, ROUNDING))
        shear = particular + np.array(
            [system.solve(names[len(macro) + j], f, len(macro) + j, len(names), fine) for j, f in enumerate(rhs)]
        )
        # macro^H M u_T, by balance: errors of u_T enter with those of the moments only
        mean = (fields.conj() @ M.products(shear).T + parts.conj() @ seam.T) / mesh.height
        compliance = _compliance(M, unit, shear, group.growth, mean)
    return SolvedGroup(
        names,
        stiffness,
        compliance,
        fields[:, : M.displacements],
        tuple(system.solutions),
        system.unknowns,
        system.multigrid.complexity,
    )


def _compliance(M: CellOperator, unit: NDArray, shear: NDArray, growth: NDArray, mean: NDArray) -> NDArray:
    """Mean energy per length of the unit forces and of the shear forces, each without the moment that acts at its height."""
    m, k = len(unit), len(shear)
    mesh, energy = M.mesh, M.energies(np.concatenate([unit, shear]))
    z = mesh.points[bricks(mesh).corners, 2].mean(axis=1) - 0.5 * mesh.height
    take = np.zeros((len(z), m + k, m + k), dtype=energy.dtype)
    take[:, range(m + k), range(m + k)] = 1.0
    take[:, :m, m:] = -(growth * z[:, None, None] + mean)
    F = np.einsum("eji,ejl,elk->ik", take.conj(), energy, take, optimize=True) / mesh.height
    return 0.5 * (F + F.conj().T)


class _System:
    """The reduced problem of one group, with its hierarchy."""

    def __init__(self, mesh: Mesh, M: CellOperator, group: LoadGroup, max_iterations: int, tell: Progress) -> None:
        self.mesh, self.M, self.tell = mesh, M, tell
        self.max_iterations = max_iterations
        angle = mesh.twist_rate * mesh.height
        c, s = np.cos(angle), np.sin(angle)
        motion = group.factor * np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        self.motion = motion if group.circular else motion.real
        self.R, free = reduction(len(mesh.points), mesh.bottom, mesh.top, self.motion)
        self.RH = self.R.conj().T.tocsr()
        self.unknowns = 3 * len(free)
        tell(0.0, f"building the multigrid hierarchy for {self.unknowns} unknowns")
        reduced = reduced_matrix(M.stiffness, mesh.bottom, mesh.top, self.motion)
        self.multigrid = Multigrid(reduced, mesh.points[free], mesh.height)
        self.solutions: list[Solution] = []

    def solve(self, name: str, load: NDArray, number: int, total: int, tolerance: float) -> NDArray:
        """The repeating field (size,) under loads (size,) on the unconstrained cell."""
        begin, done = 0.2 + 0.8 * number / total, 0.0

        def watch(count: int, residual: float) -> None:
            nonlocal done
            if count % 5 == 0:
                done = max(done, min(1.0, np.log(max(residual, tolerance)) / np.log(tolerance)))
                self.tell(
                    begin + 0.8 * done / total, f"solving {name}: residual {residual:.0e} after {count} iterations"
                )

        rhs = self._triangular(self._shared(load.astype(self.motion.dtype)))
        found = energy_gmres(self._product, self._inverse, rhs, tolerance, self.max_iterations, watch)
        if not found.residual <= 10 * tolerance:
            raise ConvergenceError(
                f"the {name} problem of the cell stopped at a relative residual of {found.residual:.1e} after {found.iterations} "
                f"iterations (wanted {tolerance:.0e}); try a mesh with better shaped elements, or a larger tolerance."
            )
        self.solutions.append(found)
        return self._spread(found.unknowns)

    def _spread(self, x: NDArray) -> NDArray:
        """The field (size,) of the cell that belongs to the free unknowns."""
        return np.concatenate([self.R @ x[: self.unknowns], x[self.unknowns :]])

    def _shared(self, f: NDArray) -> NDArray:
        """Its adjoint: forces on the cell as forces on the free unknowns."""
        n = self.M.displacements
        return np.concatenate([self.RH @ f[:n], f[n:]])

    def _product(self, x: NDArray) -> NDArray:
        return self._triangular(self._shared(self.M.product(self._spread(x))))

    def _triangular(self, r: NDArray) -> NDArray:
        """L r: what the pressures leave of the forces, and minus the volume changes."""
        n, pressure = self.unknowns, self.M.pressure
        if pressure is None:
            return r
        p = -r[n:] / pressure.schur
        return np.concatenate([r[:n] - self.RH @ pressure.transposed.product(p[:, None]).ravel(), -r[n:]])

    def _inverse(self, h: NDArray) -> NDArray:
        """H^-1 h: a multigrid cycle for the displacements, the diagonal for the pressures."""
        n, pressure = self.unknowns, self.M.pressure
        u = self.multigrid.precondition(h[:n])
        return u if pressure is None else np.concatenate([u, h[n:] / pressure.schur])

    def jump(self, fields: NDArray) -> NDArray:
        """Fields (k, size) that are zero but on the top, where they are what is carried there from the bottom."""
        u = fields[:, : self.M.displacements].reshape(len(fields), -1, 3)
        out = np.zeros_like(u)
        out[:, self.mesh.top] = u[:, self.mesh.bottom] @ self.motion.T
        return self.M.with_pressures(out.reshape(len(fields), -1))

    def bottom_forces(self, fields: NDArray) -> NDArray:
        """Nodal forces (k, size) of the fields on the bottom, zero elsewhere."""
        forces = self.M.products(fields)[:, : self.M.displacements].reshape(len(fields), -1, 3)
        out = np.zeros_like(forces)
        out[:, self.mesh.bottom] = forces[:, self.mesh.bottom]
        return self.M.with_pressures(out.reshape(len(fields), -1))

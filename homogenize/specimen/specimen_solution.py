r"""A finite specimen of a cable under loads at its end: what is solved, and what every solution must satisfy.

The end z = 0 is held, the end z = L loaded; K u = f with K of :mod:`homogenize.specimen.swept_operator`. After the solution

* reactions at z = 0, and at a plate's blocked motions, balance the load: sum of forces and of moments;
* the work of the load equals twice the stored energy: f.u = u.K u;
* the residual at the unknowns that are free is small beside the load.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import ConvergenceError, SpecError
from homogenize.cell_checks import Check
from homogenize.interface_choice import Interfaces
from homogenize.section_field import FloatArray
from homogenize.section_system import SectionSystem, section_system
from homogenize.specimen.axial_basis import AxialBasis
from homogenize.specimen.axial_grading import AxialGrading
from homogenize.specimen.balanced_solver import BalancedSolver
from homogenize.specimen.end_condition import EndMap, Held, Plate, Traction, held_end, loaded_end, region_mask
from homogenize.specimen.load_case import LoadCase, nodal_forces, turn
from homogenize.specimen.rod_motions import rod_basis
from homogenize.specimen.swept_operator import SweptOperator

Progress = Callable[[float, str], None]
MOST_TURN = (0.05, 0.2, 0.75, 1.0)
"""Angle [rad] by which the section turns in one layer, at most, with polynomials of degree 1 to 4. A rigid rotation of the specimen is a
sine of this angle: at 0.42 rad and degree 2 forces were out of balance by a tenth, and a cantilever's deflection 15 % low."""
BALANCE_LIMIT = 1e-2
"""Largest allowed imbalance of forces, of moments over the length, and of work against energy, relative to the load's. A motion of
the specimen as a whole is not a polynomial in the turning frame, so that forces balance to the error of the axial polynomials."""


@dataclass(frozen=True)
class Specimen:
    """A finite specimen and how it is held.

    Parameters
    ----------
    length : [m]
    loaded : Traction or Plate, the end z = L
    held : Held, the end z = 0
    interface : str or Interfaces, as for the long cable
    phase : angle by which the drawn section stands turned at z = 0 [rad]
    grading : layers along the length
    large_displacement : follow the load with large displacements

    Raises
    ------
    SpecError
        If the length or the phase is not usable.
    """

    length: float
    loaded: Traction | Plate = field(default_factory=Traction)
    held: Held = field(default_factory=Held)
    interface: str | Interfaces = "bonded"
    phase: float = 0.0
    grading: AxialGrading = field(default_factory=AxialGrading)
    large_displacement: bool = False

    def __post_init__(self) -> None:
        if not (np.isfinite(self.length) and self.length > 0):
            raise SpecError(f"the length of a specimen must be positive, found {self.length:g} m.")
        if not np.isfinite(self.phase):
            raise SpecError(f"the phase of a specimen must be an angle, found {self.phase:g}.")


@dataclass(frozen=True)
class SpecimenSolution:
    """A solved specimen; arrays have the loads as their last axis, in the order of `loads`.

    Attributes
    ----------
    specimen, mesh, loads : what was asked
    system : the section with its interfaces
    operator : the stiffness
    ends : maps of the free unknowns at z = 0 and z = L
    F, U : (n, m, loads) forces and unknowns at the stations, in rotating components
    iterations : of the linear solver
    error : estimate of the error of the displacements in energy, sqrt of the relative value
    seconds : wall time
    """

    specimen: Specimen
    mesh: CrossSectionMesh
    loads: tuple[LoadCase, ...]
    system: SectionSystem
    operator: SweptOperator
    ends: tuple[EndMap, EndMap]
    F: FloatArray
    U: FloatArray
    iterations: int
    error: float
    seconds: float

    @property
    def unknowns(self) -> int:
        """Free displacement components."""
        n, m = self.operator.shape
        return n * (m - 2) + sum(end.free for end in self.ends)

    @cached_property
    def nodal(self) -> FloatArray:
        """(nodes, 3, stations, loads) displacement in rotating components [m]; copies of a node on a sliding interface are apart."""
        T = self.system.T
        n, m, loads = self.U.shape
        u = self.U.reshape(n, -1)
        return (u if T is None else np.asarray(T @ u)).reshape(-1, 3, m, loads)

    @cached_property
    def angles(self) -> FloatArray:
        """(stations,) angle of the section against fixed axes [rad]."""
        return self.specimen.phase + self.mesh.twist_rate * self.operator.axial.stations

    @cached_property
    def displacement(self) -> FloatArray:
        """(nodes, 3, stations, loads) displacement in fixed axes [m]."""
        Q = np.array([turn(angle) for angle in self.angles])
        return np.einsum("mxy,nymk->nxmk", Q, self.nodal, optimize=True)

    @cached_property
    def forces(self) -> FloatArray:
        """(n, m, loads) K U: nodal forces, reactions included."""
        return self.operator.apply(self.U)

    @cached_property
    def energy(self) -> FloatArray:
        """(loads,) stored energy [J]."""
        return 0.5 * np.einsum("nmk,nmk->k", self.U, self.forces)

    @cached_property
    def reactions(self) -> FloatArray:
        """(6, loads) resultant on the held end about its centre, in fixed axes [N], [N m]."""
        R = self.forces[:, 0] - self.F[:, 0]
        Q = np.kron(np.eye(2), turn(float(self.angles[0])))
        return Q @ (self.system.pencil.Z.T @ R)

    @cached_property
    def applied(self) -> FloatArray:
        """(6, loads) resultant of all forces on z = L, reactions of a plate included, about the centre of that section."""
        Q = np.kron(np.eye(2), turn(float(self.angles[-1])))
        return Q @ (self.system.pencil.Z.T @ self.forces[:, -1])

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """Balance of forces and moments, of work and energy, and the residual."""
        L, force, moment = self.specimen.length, self.applied[:3], self.applied[3:]
        lever = np.array([0.0, 0.0, L])
        carried = moment + np.cross(lever, force, axisa=0, axisb=0, axisc=0)
        scale = np.maximum(np.linalg.norm(force, axis=0), np.linalg.norm(carried, axis=0) / L)
        forces = np.abs(self.reactions[:3] + force).max(axis=0) / scale
        moments = np.abs(self.reactions[3:] + carried).max(axis=0) / (L * scale)
        work = np.einsum("nmk,nmk->k", self.F, self.U)
        energy = np.abs(work - 2 * self.energy) / np.abs(work)
        rest = self.forces - self.F
        rest[:, 0], rest[:, -1] = (end.project(rest[:, k]) for k, end in zip((0, -1), self.ends))
        residual = np.abs(rest).max(axis=(0, 1)) / np.abs(self.F).max(axis=(0, 1))
        found = (
            ("forces in balance", float(forces.max())),
            ("moments in balance", float(moments.max())),
            ("work equals energy", float(energy.max())),
            ("residual", float(residual.max()) * BALANCE_LIMIT),
        )
        return tuple(
            Check(
                name, f"{value / (BALANCE_LIMIT if name == 'residual' else 1):.1e} of the load", value < BALANCE_LIMIT
            )
            for name, value in found
        )


def solve_specimen(
    specimen: Specimen,
    mesh: CrossSectionMesh,
    loads: Sequence[LoadCase],
    *,
    tolerance: float = 1e-4,
    progress: Progress | None = None,
) -> SpecimenSolution:
    """Displacements of a specimen under loads at its end z = L, each by itself.

    Parameters
    ----------
    specimen : Specimen
    mesh : CrossSectionMesh
        Quadratic triangles are meant; of a few thousand nodes, see :func:`specimen_mesh`.
    loads : sequence of LoadCase
    tolerance : error of the displacements in energy
    progress : called with a fraction and a sentence

    Raises
    ------
    SpecError, MeshError
        If a part, an interface or a load is not usable.
    ConvergenceError
        If the solver does not reach the tolerance or the solution is not in balance.
    """
    if specimen.large_displacement:
        raise SpecError("solve_specimen is linear; follow_specimen follows a load with large displacements.")
    if not loads:
        raise SpecError("a specimen needs at least one load.")
    tell = progress or (lambda fraction, sentence: None)
    start = time.perf_counter()
    tell(0.0, "assembling the section")
    system = section_system(mesh, specimen.interface)
    axial = specimen_axis(specimen, mesh)
    operator = SweptOperator(system.pencil, axial)
    ends = held_end(specimen.held, system, mesh), loaded_end(specimen.loaded, system, mesh)
    F = specimen_forces(specimen, mesh, system, axial, loads)
    n, m = operator.shape
    tell(0.05, f"factoring the section for {n * (m - 1)} unknowns")
    diameter = 2 * np.sqrt(system.field.area / np.pi)
    solver = BalancedSolver(operator, rod_basis(system, mesh, diameter), ends)
    watch = _watch(tell, tolerance)
    found = solver.solve(F, tolerance, watch)
    seconds = time.perf_counter() - start
    solution = SpecimenSolution(
        specimen, mesh, tuple(loads), system, operator, ends, F, found.U, found.iterations, found.error, seconds
    )
    failed = [check for check in solution.checks if not check.holds]
    if failed:
        raise ConvergenceError(
            f"the specimen is out of balance, {failed[0].name}: {failed[0].sentence}; try a smaller tolerance or a finer mesh."
        )
    tell(1.0, f"specimen solved, {found.iterations} iterations")
    return solution


def specimen_axis(specimen: Specimen, mesh: CrossSectionMesh) -> AxialBasis:
    """The layers of a specimen, graded by the diameter of its mesh, and no thicker than the lay allows."""
    diameter = 2 * float(np.hypot(*mesh.points.T).max())
    grading, turning = specimen.grading, abs(mesh.twist_rate) * diameter
    if isinstance(grading, AxialGrading) and turning * grading.largest > MOST_TURN[grading.degree - 1]:
        largest = MOST_TURN[grading.degree - 1] / turning
        grading = replace(grading, largest=largest, end_size=min(grading.end_size, largest))
    return grading.basis(specimen.length, diameter)


def specimen_forces(
    specimen: Specimen, mesh: CrossSectionMesh, system: SectionSystem, axial: AxialBasis, loads: Sequence[LoadCase]
) -> FloatArray:
    """Nodal forces (n, m, loads) in the unknowns of the section."""
    loaded = region_mask(specimen.loaded.parts, mesh)
    angle = specimen.phase + mesh.twist_rate * specimen.length
    f = np.array([nodal_forces(load, system.field, loaded, angle) for load in loads]).T
    F = np.zeros((len(system.pencil.Z), len(axial.stations), len(loads)))
    F[:, -1] = f if system.T is None else system.T.T @ f
    return F


def _watch(tell: Progress, tolerance: float) -> Callable[[int, float], None]:
    def watch(count: int, error: float) -> None:
        if count % 5 == 0 and 0 < error < np.inf:
            done = float(np.clip(np.log(error) / np.log(tolerance), 0.0, 1.0))
            tell(0.2 + 0.75 * done, f"solving: {error:.0e} after {count} iterations")

    return watch

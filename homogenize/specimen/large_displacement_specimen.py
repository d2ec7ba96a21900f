r"""A bonded specimen followed with large displacements: the same section, layers, ends and loads as the linear one.

The tangent at rest is that of :mod:`homogenize.specimen.swept_operator`. Small specimens share its factor; for large ones the solver of
the linear specimen (coarse rods Q, strips B) preconditions every Newton step, :math:`M = Q + (I - Q K) B (I - K Q)`.

Loads of both signs show what is of second order directly: the even part of the displacement.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import SpecError
from homogenize.section_field import FloatArray
from homogenize.section_system import section_system
from homogenize.specimen.balanced_solver import BalancedSolver
from homogenize.specimen.end_condition import Traction, held_end, loaded_end
from homogenize.specimen.large_displacement import LargeDisplacement, large_displacement
from homogenize.specimen.load_case import LoadCase, turn
from homogenize.specimen.rod_motions import rod_basis
from homogenize.specimen.specimen_solution import Specimen, specimen_axis, specimen_forces
from homogenize.specimen.swept_operator import SweptOperator
from homogenize.specimen.wedge18 import Wedges

Progress = Callable[[float, str], None]

DIRECT = 60_000
"""Unknowns up to which the tangent at rest is factored and shared by all loads; above that the linear specimen's solver serves."""


@dataclass(frozen=True)
class FollowedLoad:
    """One load followed through its shares.

    Attributes
    ----------
    load : LoadCase
    shares : (s,) of the load
    largest : (s,) largest displacement along the load's direction, of any node [m]
    end_mean : (s, 3) mean displacement of the loaded end in fixed axes [m]
    gradient : (s, 3, 3) volume average of the displacement gradient in fixed axes
    path : the equilibria
    """

    load: LoadCase
    shares: FloatArray
    largest: FloatArray
    end_mean: FloatArray
    gradient: FloatArray
    path: LargeDisplacement

    def apparent_modulus(self, area: float) -> FloatArray:
        """(s,) secant of average stress over average strain: E for tension, G of the plane of the force and the axis for shear [Pa]."""
        axis = int(np.argmax(np.abs(self.load.direction)))
        strain = self.gradient[:, axis, 2] + (self.gradient[:, 2, axis] if axis < 2 else 0.0)
        return self.shares * self.load.size / area / strain


def follow_specimen(
    specimen: Specimen,
    mesh: CrossSectionMesh,
    loads: Collection[LoadCase],
    *,
    shares: tuple[float, ...] = (0.5, 1.0),
    volume_strain: str = "linear",
    neo_hookean: Collection[str] = (),
    progress: Progress | None = None,
) -> tuple[FollowedLoad, ...]:
    """Follow forces on a bonded specimen with large displacements, each from rest.

    Parameters
    ----------
    specimen : Specimen
        Fixed at z = 0, loaded by a traction of fixed direction.
    mesh : CrossSectionMesh
        Six-node triangles.
    loads : forces, not moments
    shares : growing shares of each load
    volume_strain, neo_hookean : see :class:`~homogenize.specimen.wedge18.Wedges`

    Raises
    ------
    SpecError
        If the ends, the interface or a load are of another kind.
    ConvergenceError
        If a load cannot be followed; says how far, and which part.
    """
    if not isinstance(specimen.loaded, Traction) or specimen.held.parts or specimen.interface != "bonded":
        raise SpecError(
            "large displacements are followed on a bonded specimen, fixed at one end and with a traction on the other."
        )
    if not all(load.is_force for load in loads):
        raise SpecError("large displacements are followed for forces; a moment would have to follow its section.")
    system = section_system(mesh, "bonded")
    axis = specimen_axis(specimen, mesh)
    wedges = Wedges(system.field, mesh.regions, axis, volume_strain, tuple(neo_hookean))
    operator = SweptOperator(system.pencil, axis)
    ends = held_end(specimen.held, system, mesh), loaded_end(specimen.loaded, system, mesh)
    small = (len(axis.stations) - 1) * operator.shape[0] <= DIRECT
    solver = (
        None
        if small
        else BalancedSolver(operator, rod_basis(system, mesh, 2 * float(np.hypot(*mesh.points.T).max())), ends)
    )
    forces = specimen_forces(specimen, mesh, system, axis, list(loads))
    inverse = None if solver is None else _balanced(solver)
    found: list[FollowedLoad] = []
    for i, load in enumerate(loads):

        def tell(fraction: float, sentence: str, i: int = i, load: LoadCase = load) -> None:
            if progress:
                progress((i + fraction) / len(loads), f"{load.name}: {sentence}")

        path = large_displacement(wedges, forces[:, :, i].T.ravel(), shares, preconditioner=inverse, progress=tell)
        inverse = path.preconditioner
        found.append(_followed(wedges, load, specimen.phase, path))
    return tuple(found)


def _followed(wedges: Wedges, load: LoadCase, phase: float, path: LargeDisplacement) -> FollowedLoad:
    Q = turn(phase)
    weight = wedges.face_area() / wedges.section.area
    displacement = [wedges.fixed_components(state.u) @ Q.T for state in path.states]
    return FollowedLoad(
        load=load,
        shares=np.array([state.share for state in path.states]),
        largest=np.array([float((u @ load.direction).max()) for u in displacement]),
        end_mean=np.array([weight @ u[-1] for u in displacement]),
        gradient=np.array([Q @ wedges.mean_gradient(state.u) @ Q.T for state in path.states]),
        path=path,
    )


def _balanced(solver: BalancedSolver) -> Callable[[NDArray], NDArray]:
    """The linear specimen's solver as a symmetric preconditioner on all unknowns but those of the held end."""
    n, m = solver.operator.shape

    def apply(rhs: FloatArray) -> FloatArray:
        R = np.zeros((n, m, 1))
        R[:, 1:, 0] = rhs.reshape(m - 1, n).T
        x = solver.rods.solve(R)
        Z = solver.strips.apply(R - solver.rods.forces(x))
        y = solver.rods.solve(solver.operator.apply(Z))
        U = Z + solver.rods.displacement(x - y)
        return np.ascontiguousarray(U[:, 1:, 0].T).ravel()

    return apply

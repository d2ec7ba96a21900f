r"""Bodies of a specimen apart from each other, and how their surfaces give way to forces on the jumps between them.

Where every separated interface can open, the doubled nodes of its sides (:mod:`homogenize.doubled_nodes`) share no unknown: the stiffness K
of the specimen without contacts falls into one block for each body, each of them held at its end. With J the jumps (g, s_a, s_b) of
displacements and A the free unknowns of the two ends, :math:`K_f = A^T K A`,

.. math::  F = J A K_f^{-1} A^T J^T, \qquad j_f = J A K_f^{-1} A^T f .

One sparse factor of each block, and one solve for each jump on it: a third of the work on the joined specimen.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import SpecError
from homogenize.section_problem import SectionPencil, gauge_unknowns
from homogenize.section_system import SectionSystem
from homogenize.sliding_interface import SlidingField
from homogenize.specimen.axial_basis import AxialBasis
from homogenize.specimen.end_condition import EndMap, held_end, loaded_end
from homogenize.specimen.load_case import LoadCase, turn
from homogenize.specimen.specimen_solution import Specimen, specimen_forces

FloatArray = NDArray[np.float64]

_BLOCK = 96
_SYMMETRIC = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}


@dataclass(frozen=True)
class SeparateBodies:
    """The bodies of a specimen, not in contact.

    Attributes
    ----------
    system : the section with doubled nodes and without links
    axis : polynomials along the specimen
    K : stiffness of all unknowns, station by station
    A : all unknowns from the free ones
    forces : (unknowns, loads)
    first : first station with jumps; 1 where z = 0 does not move at all
    jumps : J (3 p, unknowns), station by station, link by link: g, s_a, s_b
    """

    system: SectionSystem
    axis: AxialBasis
    K: sp.csr_array
    A: sp.csr_array
    forces: FloatArray
    first: int
    jumps: sp.csr_array

    @property
    def count(self) -> int:
        """Number of jumps, 3 p."""
        return len(self.jumps.indptr) - 1

    def flexibility(
        self, rows: sp.csr_array, watch: Callable[[int, int], None]
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """F (3 p, 3 p), `rows` of the displacements per unit jump force (r, 3 p), j_f (3 p, loads), the rows under the loads (r, loads).

        `watch` is called with the number of solves that are done, and of all.
        """
        free = sp.csr_array(self.A.T @ self.K @ self.A)
        seen = sp.csc_array(sp.vstack([self.jumps, rows]) @ self.A)
        forces = np.asarray(self.A.T @ self.forces)
        p = self.count
        count = p + len(rows.indptr) - 1
        found, base = np.zeros((count, p)), np.zeros((count, len(forces[0])))
        bodies, body = sp.csgraph.connected_components(free, directed=False)
        done = 0
        for k in range(bodies):
            mine = np.flatnonzero(body == k)
            factor = spla.splu(sp.csc_matrix(free[mine][:, mine]), **_SYMMETRIC)
            view = sp.csr_array(seen[:, mine])
            touched = np.flatnonzero(np.diff(view.indptr))
            view = view[touched]
            base[touched] += view @ factor.solve(np.ascontiguousarray(forces[mine]))
            jumps = touched[touched < p]
            pull = sp.csc_array(view[: len(jumps)].T)
            for start in range(0, len(jumps), _BLOCK):
                watch(done + start, 2 * p)
                some = slice(start, start + _BLOCK)
                found[np.ix_(touched, jumps[some])] += view @ factor.solve(pull[:, some].toarray())
            done += len(jumps)
        F = found[:p]
        return 0.5 * (F + F.T), found[p:], base[:p], base[p:]


def separate_bodies(
    specimen: Specimen, mesh: CrossSectionMesh, sliding: SlidingField, axis: AxialBasis, loads: Sequence[LoadCase]
) -> SeparateBodies:
    """Take a specimen apart at its interfaces.

    Raises
    ------
    SpecError
        If the end z = 0 leaves a body unheld.
    """
    system = _unlinked(sliding)
    n, m = system.field.unknowns, len(axis.stations)
    held, loaded = held_end(specimen.held, system, mesh), loaded_end(specimen.loaded, system, mesh)
    _check_held(held, system, mesh)
    forces = specimen_forces(specimen, mesh, system, axis, loads).transpose(1, 0, 2).reshape(n * m, -1)
    A = sp.csr_array(sp.block_diag([held.A, sp.eye_array(n * (m - 2)), loaded.A]))
    first = int(held.closed)
    at = sp.eye_array(m - first, m, k=first)
    J = sp.csr_array(sp.kron(at, _jumps_of_section(sliding)))
    return SeparateBodies(system, axis, _stiffness(system, axis), A, forces, first, J)


def _unlinked(sliding: SlidingField) -> SectionSystem:
    """The section in the unknowns of its doubled nodes, nothing between them."""
    field = sliding.field
    E0, E1, E2 = field.matrices()
    pencil = SectionPencil(E0, sp.csr_array(E1.T - E1), E1, E2, field.rigid_motion(), field.area**0.5)
    gauge = gauge_unknowns(field.nodes, np.ones(field.nodes.shape[1], dtype=bool))
    return SectionSystem(field, pencil, gauge, None, np.zeros(field.unknowns))


def _check_held(held: EndMap, system: SectionSystem, mesh: CrossSectionMesh) -> None:
    """Every body must have a node that does not move at z = 0."""
    cells = system.field.cells
    nodes = system.field.nodes.shape[1]
    links = sp.csr_array(
        (np.ones(cells[1:].size), (np.tile(cells[0], len(cells) - 1), cells[1:].ravel())), shape=(nodes, nodes)
    )
    bodies, body = sp.csgraph.connected_components(links, directed=False)
    moving = np.asarray(abs(held.A).sum(axis=1)).reshape(-1, 3).max(axis=1) > 0
    for k in range(bodies):
        if moving[body == k].all():
            region = system.field.region_of[np.flatnonzero(body[cells[0]] == k)[0]]
            raise SpecError(
                f"{mesh.regions[region].name} is held by nothing at z = 0 once its contacts open: hold it there, or the whole end-section."
            )


def _jumps_of_section(sliding: SlidingField) -> sp.csr_array:
    """g, s_a, s_b of each opening link from the doubled nodes: the copy moves by a s_a + b s_b - N g beyond its partner."""
    doubled, links = sliding.doubled, sliding.opening
    count = len(links)
    signed = doubled.frame[:, :, links] * np.array([-1.0, 1.0, 1.0])[:, None, None]
    rows = np.broadcast_to((3 * np.arange(count)[None, None, :] + np.arange(3)[:, None, None]), signed.shape)
    sides = []
    for nodes, sign in ((doubled.child[links], 1.0), (doubled.parent[links], -1.0)):
        columns = np.broadcast_to(3 * nodes[None, None, :] + np.arange(3)[None, :, None], signed.shape)
        sides.append((sign * signed.ravel(), rows.ravel(), columns.ravel()))
    values, row, column = (np.concatenate(part) for part in zip(*sides))
    return sp.csr_array((values, (row, column)), shape=(3 * count, sliding.field.unknowns))


def _stiffness(system: SectionSystem, axis: AxialBasis) -> sp.csr_array:
    M, C, S = (sp.csr_array(A) for A in axis.matrices)
    p = system.pencil
    parts = ((M, p.E2), (C, p.E1), (C.T, p.E1.T), (S, p.E0))
    return sp.csr_array(sum(sp.kron(a, E, format="csr") for a, E in parts))


def face_rows(specimen: Specimen, mesh: CrossSectionMesh, bodies: SeparateBodies) -> sp.csr_array:
    """Displacements of the nodes of the loaded end in fixed axes, of all unknowns (3 nodes, unknowns)."""
    nodes, m = bodies.system.field.nodes.shape[1], len(bodies.axis.stations)
    Q = turn(specimen.phase + mesh.twist_rate * specimen.length)
    last = sp.csr_array(([1.0], ([0], [m - 1])), shape=(1, m))
    return sp.csr_array(sp.kron(last, sp.kron(sp.eye_array(nodes), sp.csr_array(Q))))


def strain_rows(specimen: Specimen, mesh: CrossSectionMesh, bodies: SeparateBodies) -> sp.csr_array:
    """Volume averages of e_zz, g_xz, g_yz in fixed axes, of all unknowns (3, unknowns)."""
    field, axis = bodies.system.field, bodies.axis
    sums = []
    for B in (field.strain_s, field.strain_z):
        local = np.einsum("eq,eqik->eik", field.weight, np.broadcast_to(B, (len(field.weight), *B.shape[1:])))
        flat = np.zeros((3, field.unknowns))
        for row, component in enumerate((4, 3, 2)):  # xz, yz, zz
            np.add.at(flat[row], field.element_dofs.ravel(), local[:, component].ravel())
        sums.append(flat)
    z, weight, values, slopes = axis.quadrature
    turns = np.array([turn(specimen.phase + mesh.twist_rate * float(height)) for height in z])
    total = sum(
        np.einsum("g,gxy,gk,yn->xkn", weight, turns, at, flat, optimize=True)
        for at, flat in ((values, sums[0]), (slopes, sums[1]))
    )
    return sp.csr_array(np.reshape(total, (3, -1))[[2, 0, 1]] / (field.area * specimen.length))


def resultant_rows(specimen: Specimen, mesh: CrossSectionMesh, bodies: SeparateBodies) -> sp.csr_array:
    """Forces and moments that the held end receives and that the loaded end brings, both in fixed axes about the centre of z = 0, of all
    unknowns (12, unknowns). Contacts act on both sides of a place alike and leave no resultant."""
    n, m = bodies.system.field.unknowns, len(bodies.axis.stations)
    found = []
    for station, height in ((0, 0.0), (m - 1, specimen.length)):
        Q = np.kron(np.eye(2), turn(specimen.phase + mesh.twist_rate * height))
        rows = Q @ bodies.system.pencil.Z.T @ bodies.K[station * n : (station + 1) * n]
        rows[3], rows[4] = rows[3] - height * rows[1], rows[4] + height * rows[0]
        found.append(rows)
    return sp.csr_array(np.concatenate(found))

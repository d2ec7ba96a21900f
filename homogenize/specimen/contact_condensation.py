r"""A specimen condensed onto the jumps of its opening interfaces, once, whatever its contacts do later.

The unknowns x of a specimen hold the jumps (g, s_a, s_b) of its interfaces at every station (:mod:`homogenize.sliding_interface`), and a
contact puts its forces on just these: K x + a f(jump) = load, a the surface of each point (Simpson's rule along the trace and along z).
With springs k a on all jumps the matrix :math:`\tilde K = K + k a` is that of a specimen in which everything holds, and

.. math::
   j = j_0 + \tilde C\, q(j), \qquad q = k a\, j - a f(j), \qquad o = o_0 + \tilde V q ,

C~ = (K~^-1) on the jumps, V~ the observed displacements per unit force on a jump, j_0 and o_0 the answer of the holding specimen
to each load. One factor of K~ and one solve for each jump. q vanishes where a point is closed and sticks.
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
from homogenize.section_system import SectionSystem, section_system
from homogenize.specimen.axial_basis import AxialBasis
from homogenize.specimen.end_condition import held_end, loaded_end
from homogenize.specimen.frictional_contact import ContactConstants, FrictionalContact
from homogenize.specimen.load_case import LoadCase, turn
from homogenize.specimen.specimen_solution import Specimen, specimen_axis, specimen_forces

FloatArray = NDArray[np.float64]
Progress = Callable[[float, str], None]

MOST_JUMPS = 9000
"""Three for each contact point; their matrix is dense (0.65 GB at this number)."""
_BLOCK = 48


@dataclass(frozen=True)
class ContactSpecimen:
    """A specimen with its contacts condensed; p contact points, three jumps each.

    Attributes
    ----------
    specimen, mesh, loads : what was asked
    constants : the contact law at every point
    area : (p,) surface of each point [m^2]
    place : (p, 3) X, Y in the rotating frame and z [m]
    link : (p,) number of the interface node of the section
    parts : (p,) the two parts in words
    compliance : C~ (3 p, 3 p) [m/N]
    jump : j_0 (3 p, loads) [m]
    observed : o_0 (o, loads)
    columns : V~ (o, 3 p)
    faces : number of nodes of the loaded end; the first 3 `faces` observations are their displacements in fixed axes, node by node,
        the last three the volume averages of e_zz, g_xz and g_yz
    face_weight : (faces,) area of each node of the loaded end [m^2]
    """

    specimen: Specimen
    mesh: CrossSectionMesh
    loads: tuple[LoadCase, ...]
    constants: ContactConstants
    area: FloatArray
    place: FloatArray
    link: NDArray[np.int64]
    parts: tuple[tuple[str, str], ...]
    compliance: FloatArray
    jump: FloatArray
    observed: FloatArray
    columns: FloatArray
    faces: int
    face_weight: FloatArray

    def springs(self) -> FloatArray:
        """k a of every jump (3 p,) [N/m]."""
        c = self.constants
        return (np.stack([c.normal, c.tangential, c.tangential], axis=1) * self.area[:, None]).ravel()


def contact_specimen(
    specimen: Specimen, mesh: CrossSectionMesh, loads: Sequence[LoadCase], progress: Progress | None = None
) -> ContactSpecimen:
    """Condense a specimen whose interfaces are all :class:`~homogenize.specimen.frictional_contact.FrictionalContact`.

    Raises
    ------
    SpecError
        If an interface has another law, or there are too many jumps.
    """
    laws = getattr(specimen.interface, "laws", {})
    if not laws or not all(isinstance(law, FrictionalContact) for law in laws.values()):
        raise SpecError(
            "a specimen with opening contacts needs FrictionalContact(...) on each interface that is named."
        )
    tell = progress or (lambda fraction, sentence: None)
    system = section_system(mesh, specimen.interface, history=True, opening=True)
    sliding = system.sliding
    assert sliding is not None
    axis = specimen_axis(specimen, mesh)
    n, m, links = len(sliding.Z), len(axis.stations), len(sliding.opening)
    if 3 * links * (m - 1) > MOST_JUMPS:
        raise SpecError(
            f"{links} nodes on the interfaces and {m - 1} stations make {3 * links * (m - 1)} jumps, more than {MOST_JUMPS}: "
            "name fewer parts, or take larger elements or layers."
        )
    in_section = np.column_stack(
        [sliding.first_opening + np.arange(links), sliding.slips_of(sliding.opening).reshape(-1, 2)]
    )
    constants = _constants(sliding.constant_of_links, sliding.opening, m - 1)
    station = axis.matrices[0].sum(axis=1)[1:]
    area = (station[:, None] * sliding.doubled.surface[sliding.opening]).ravel()
    jumps = (np.arange(1, m)[:, None, None] * n + in_section).ravel()
    springs = (np.stack([constants.normal, constants.tangential, constants.tangential], axis=1) * area[:, None]).ravel()
    free, forces = _free(specimen, mesh, system, axis, loads)
    tell(0.0, f"factoring {int(free.sum())} unknowns")
    K = _stiffness(system, axis) + sp.csr_array((springs, (jumps, jumps)), shape=(n * m, n * m))
    inverse = _Inverse(K, free)
    observed = (_face_rows(specimen, mesh, system, axis), _strain_rows(specimen, mesh, system, axis))
    rows = sp.csr_array(sp.vstack(observed))
    compliance, columns = np.empty((len(jumps), len(jumps))), np.empty((len(rows.indptr) - 1, len(jumps)))
    for start in range(0, len(jumps), _BLOCK):
        some = slice(start, start + _BLOCK)
        tell(0.1 + 0.9 * start / len(jumps), f"condensing {len(jumps)} jumps")
        unit = np.zeros((n * m, len(jumps[some])))
        unit[jumps[some], np.arange(len(jumps[some]))] = 1.0
        found = inverse(unit)
        compliance[:, some], columns[:, some] = found[jumps], rows @ found
    base = inverse(forces)
    X, Y = sliding.doubled.nodes[:, sliding.doubled.child[sliding.opening]]
    names = [mesh.regions[r].name for r in range(len(mesh.regions))]
    sides = sliding.doubled.regions[sliding.opening]
    return ContactSpecimen(
        specimen=specimen,
        mesh=mesh,
        loads=tuple(loads),
        constants=constants,
        area=area,
        place=np.column_stack([np.tile(X, m - 1), np.tile(Y, m - 1), np.repeat(axis.stations[1:], links)]),
        link=np.tile(np.arange(links), m - 1),
        parts=tuple((names[a], names[b]) for a, b in sides) * (m - 1),
        compliance=0.5 * (compliance + compliance.T),
        jump=base[jumps],
        observed=rows @ base,
        columns=columns,
        faces=system.field.nodes.shape[1],
        face_weight=np.bincount(
            system.field.cells.T.ravel(),
            (system.field.weight @ system.field.shape.T).ravel(),
            system.field.nodes.shape[1],
        ).astype(np.float64),
    )


def _constants(of_links: Callable[[str], FloatArray], opening: NDArray[np.int64], stations: int) -> ContactConstants:
    names = ("friction", "grip", "gap", "normal", "tangential")
    return ContactConstants(*(np.tile(of_links(name)[opening], stations) for name in names))


def _free(
    specimen: Specimen, mesh: CrossSectionMesh, system: SectionSystem, axis: AxialBasis, loads: Sequence[LoadCase]
) -> tuple[NDArray[np.bool_], FloatArray]:
    """Free unknowns (stations x n,) and forces (stations x n, loads); the held end must be held altogether, the other one free."""
    n, m = len(system.pencil.Z), len(axis.stations)
    if not held_end(specimen.held, system, mesh).closed or loaded_end(specimen.loaded, system, mesh).free != n:
        raise SpecError(
            "a specimen with opening contacts is fixed at one end-section and loaded by a traction on the other."
        )
    free = np.arange(n * m) >= n
    F = specimen_forces(specimen, mesh, system, axis, loads)
    return free, F.transpose(1, 0, 2).reshape(n * m, -1)


def _stiffness(system: SectionSystem, axis: AxialBasis) -> sp.csr_array:
    M, C, S = (sp.csr_array(A) for A in axis.matrices)
    p = system.pencil
    parts = ((M, p.E2), (C, p.E1), (C.T, p.E1.T), (S, p.E0))
    return sp.csr_array(sum(sp.kron(a, E, format="csr") for a, E in parts))


class _Inverse:
    """K^-1 on the free unknowns, zero elsewhere."""

    def __init__(self, K: sp.csr_array, free: NDArray[np.bool_]) -> None:
        self.free = free
        self.factor = spla.splu(
            sp.csc_matrix(K[free][:, free]),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )

    def __call__(self, rhs: FloatArray) -> FloatArray:
        out = np.zeros(rhs.shape)
        out[self.free] = self.factor.solve(np.ascontiguousarray(rhs[self.free]))
        return out


def _face_rows(specimen: Specimen, mesh: CrossSectionMesh, system: SectionSystem, axis: AxialBasis) -> sp.csr_array:
    """Displacements of the nodes of the loaded end in fixed axes, of all unknowns."""
    nodes = system.field.nodes.shape[1]
    Q = turn(specimen.phase + mesh.twist_rate * specimen.length)
    last = sp.csr_array(([1.0], ([0], [len(axis.stations) - 1])), shape=(1, len(axis.stations)))
    assert system.T is not None
    return sp.csr_array(sp.kron(last, sp.kron(sp.eye_array(nodes), sp.csr_array(Q)) @ system.T))


def _strain_rows(specimen: Specimen, mesh: CrossSectionMesh, system: SectionSystem, axis: AxialBasis) -> sp.csr_array:
    """Volume averages of e_zz, g_xz, g_yz in fixed axes, of all unknowns (3, unknowns)."""
    field = system.field
    assert system.T is not None
    sums = []
    for B in (field.strain_s, field.strain_z):
        local = np.einsum("eq,eqik->eik", field.weight, np.broadcast_to(B, (len(field.weight), *B.shape[1:])))
        flat = np.zeros((3, field.unknowns))
        for row, component in enumerate((4, 3, 2)):  # xz, yz, zz
            np.add.at(flat[row], field.element_dofs.ravel(), local[:, component].ravel())
        sums.append((system.T.T @ flat.T).T)
    z, weight, values, slopes = axis.quadrature
    total = np.zeros((3, len(axis.stations), sums[0].shape[1]))
    for g, height in enumerate(z):
        Q = turn(specimen.phase + mesh.twist_rate * float(height)) * weight[g]
        near = np.flatnonzero(values[g]) if np.any(values[g]) else []
        near = np.union1d(near, np.flatnonzero(slopes[g]))
        for k in near:
            total[:, k] += Q @ (values[g, k] * sums[0] + slopes[g, k] * sums[1])
    total = total.reshape(3, -1)[[2, 0, 1]] / (field.area * specimen.length)
    return sp.csr_array(total)

r"""A specimen condensed onto the jumps of its opening interfaces, once, whatever its contacts do later.

The unknowns x of a specimen hold the jumps (g, s_a, s_b) of its interfaces at every station (:mod:`homogenize.sliding_interface`), and a
contact puts its forces on just these: K x + a f(jump) = load, a the surface of each point (Simpson's rule along the trace and along z).
With springs D = k a on all jumps the matrix :math:`\tilde K = K + D` is that of a specimen in which everything holds, and

.. math::
   j = j_0 + \tilde C\, q(j), \qquad q = D j - a f(j), \qquad o = o_0 + \tilde V q ,

C~ = (K~^-1) on the jumps, V~ the observed displacements per unit force on a jump, j_0 and o_0 the answer of the holding specimen
to each load. q vanishes where a point is closed and sticks. All four come from the bodies without contact, which are factored apart
(:mod:`homogenize.specimen.body_flexibility`: F, V, j_f, o_f), by one dense inverse of :math:`G = D^{-1} + F` (Woodbury):

.. math::
   \tilde C = D^{-1} - D^{-1} G^{-1} D^{-1}, \quad \tilde V = V G^{-1} D^{-1}, \quad j_0 = D^{-1} G^{-1} j_f,
   \quad o_0 = o_f - V G^{-1} j_f .
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import ConvergenceError, SpecError
from homogenize.section_system import section_system
from homogenize.specimen.axial_basis import AxialBasis
from homogenize.specimen.axial_grading import AxialGrading
from homogenize.specimen.body_flexibility import (
    SeparateBodies,
    face_rows,
    resultant_rows,
    separate_bodies,
    strain_rows,
)
from homogenize.specimen.frictional_contact import ContactConstants, FrictionalContact
from homogenize.specimen.load_case import LoadCase
from homogenize.specimen.specimen_solution import BALANCE_LIMIT, MOST_TURN, Specimen, specimen_axis

FloatArray = NDArray[np.float64]
Progress = Callable[[float, str], None]

MOST_JUMPS = 9000
"""Three for each contact point; their two matrices are dense (0.65 GB each at this number)."""
CONTACT_GRADING = AxialGrading(end_size=0.24, largest=0.9, growth=4.0, degree=3)
"""Few layers whose forces are still in balance within a percent: 19 stations on 182 mm of a cable of 50 mm laid in 388 mm."""


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
    flexibility : F (3 p, 3 p) of the bodies apart from each other [m/N]
    jump : j_0 (3 p, loads) [m]
    observed : o_0 (o, loads)
    columns : V~ (o, 3 p)
    faces : number of nodes of the loaded end; the first 3 `faces` observations are their displacements in fixed axes, node by node,
        then come the volume averages of e_zz, g_xz and g_yz, and the forces and moments about the centre of z = 0 that the held end (6)
        and the loaded end (6) bring, in fixed axes
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
    flexibility: FloatArray
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

    :data:`CONTACT_GRADING` is meant for its layers. The balance of forces and moments is checked while everything holds.

    Raises
    ------
    SpecError
        If an interface has another law, a body is held by nothing once its contacts open, or there are too many jumps.
    ConvergenceError
        If the layers are too thick for the lay, so that reactions do not balance the load.
    """
    laws = getattr(specimen.interface, "laws", {})
    if not laws or not all(isinstance(law, FrictionalContact) for law in laws.values()):
        raise SpecError(
            "a specimen with opening contacts needs FrictionalContact(...) on each interface that is named."
        )
    if not loads:
        raise SpecError("a specimen needs at least one load.")
    tell = progress or (lambda fraction, sentence: None)
    sliding = section_system(mesh, specimen.interface, history=True, opening=True).sliding
    assert sliding is not None
    axis, links = specimen_axis(specimen, mesh), len(sliding.opening)
    bodies = separate_bodies(specimen, mesh, sliding, axis, loads)
    stations = axis.stations[bodies.first :]
    if 3 * links * len(stations) > MOST_JUMPS:
        raise SpecError(
            f"{links} nodes on the interfaces and {len(stations)} stations make {3 * links * len(stations)} jumps, more than {MOST_JUMPS}: "
            "name fewer parts, or take larger elements or layers."
        )
    constants = _constants(sliding.constant_of_links, sliding.opening, len(stations))
    length_of_station = axis.matrices[0].sum(axis=1)[bodies.first :]
    area = (length_of_station[:, None] * sliding.doubled.surface[sliding.opening]).ravel()
    springs = (np.stack([constants.normal, constants.tangential, constants.tangential], axis=1) * area[:, None]).ravel()
    compliance, flexibility, columns, jump, observed = _condensed(specimen, mesh, bodies, springs, tell)
    X, Y = sliding.doubled.nodes[:, sliding.doubled.child[sliding.opening]]
    names = [region.name for region in mesh.regions]
    field = bodies.system.field
    weight = np.bincount(field.cells.T.ravel(), (field.weight @ field.shape.T).ravel(), field.nodes.shape[1])
    found = ContactSpecimen(
        specimen=specimen,
        mesh=mesh,
        loads=tuple(loads),
        constants=constants,
        area=area,
        place=np.column_stack([np.tile(X, len(stations)), np.tile(Y, len(stations)), np.repeat(stations, links)]),
        link=np.tile(np.arange(links), len(stations)),
        parts=tuple((names[a], names[b]) for a, b in sliding.doubled.regions[sliding.opening]) * len(stations),
        compliance=compliance,
        flexibility=flexibility,
        jump=jump,
        observed=observed,
        columns=columns,
        faces=field.nodes.shape[1],
        face_weight=weight.astype(np.float64),
    )
    _check_balance(found, axis)
    return found


def _constants(of_links: Callable[[str], FloatArray], opening: NDArray[np.int64], stations: int) -> ContactConstants:
    names = ("friction", "grip", "gap", "normal", "tangential")
    return ContactConstants(*(np.tile(of_links(name)[opening], stations) for name in names))


def _condensed(
    specimen: Specimen, mesh: CrossSectionMesh, bodies: SeparateBodies, springs: FloatArray, tell: Progress
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    """C~, F, V~, j_0, o_0."""
    tell(0.0, "factoring the bodies apart from each other")
    rows = sp.csr_array(sp.vstack([make(specimen, mesh, bodies) for make in (face_rows, strain_rows, resultant_rows)]))

    def watch(done: int, count: int) -> None:
        tell(0.1 + 0.8 * done / count, f"condensing {len(springs)} jumps")

    F, V, j_f, o_f = bodies.flexibility(rows, watch)
    tell(0.9, f"joining the bodies by {len(springs)} springs")
    give = 1 / springs
    inverse = F.copy(order="F")
    inverse[np.diag_indices_from(F)] += give
    inverse = _inverse(inverse)
    pull = inverse @ j_f
    observed = o_f - V @ pull
    columns = (V @ inverse) * give
    inverse *= -give
    inverse *= give[:, None]
    inverse[np.diag_indices_from(inverse)] += give
    return inverse, F, columns, give[:, None] * pull, observed


def _inverse(G: FloatArray) -> FloatArray:
    """Inverse of a symmetric positive matrix, which is overwritten."""
    potrf, potri = la.get_lapack_funcs(("potrf", "potri"), (G,))
    factor, failed = potrf(G, lower=1, overwrite_a=1)
    if failed:
        raise ConvergenceError(
            "the bodies of the specimen could not be joined: one of them is held too loosely at z = 0 once its contacts open; "
            "hold the whole end-section."
        )
    half, _ = potri(factor, lower=1, overwrite_c=1)
    half = np.tril(half)
    return half + np.tril(half, -1).T


def imbalance(resultants: FloatArray, length: float) -> FloatArray:
    """Larger of what is missing in forces, and in moments over the length, over the load's; resultants (12, ...) as observed."""
    held, loaded = resultants[:6], resultants[6:]
    missing = np.abs(held + loaded)
    force, moment = (np.linalg.norm(part, axis=0) for part in (loaded[:3], loaded[3:]))
    scale = np.maximum(force, moment / length)
    return np.maximum(missing[:3].max(axis=0), missing[3:].max(axis=0) / length) / np.where(scale > 0, scale, 1.0)


def _check_balance(found: ContactSpecimen, axis: AxialBasis) -> None:
    """Refuse layers in which a motion of the whole specimen cannot be told."""
    off = imbalance(found.observed[-12:], found.specimen.length)
    if off.max() < BALANCE_LIMIT:
        return
    twist, thick = abs(found.mesh.twist_rate), float(np.diff(axis.levels).max())
    degree = getattr(axis, "degree", 0)
    thin = min(0.7 * thick, MOST_TURN[degree - 1] / twist if twist else np.inf)
    diameter = 2 * float(np.hypot(*found.mesh.points.T).max())
    raise ConvergenceError(
        f"the specimen is out of balance by {100 * off.max():.2g} % of the load ({found.loads[int(off.argmax())].name}; "
        f"{100 * BALANCE_LIMIT:g} % is allowed): in a layer of {1e3 * thick:.3g} mm the section turns by {twist * thick:.2g} rad, too much "
        f"for polynomials of degree {degree}; take layers of {1e3 * thin:.2g} mm and less (grading with largest={thin / diameter:.2g})"
        f"{', or degree 3' if degree < 3 else ''}."
    )

r"""Sections whose parts rub or part, condensed for loops of tension, torsion and bending.

Tension and torsion: harmonic 0, every section of the cable slips alike.

Bending about a fixed axis: in the turning frame the curvature (kappa_x, kappa_y) is Re[(kappa_x - i kappa_y) (1, i) exp(i tau_0 z)],
and the slips vary along the pitch. Stiffness does not couple the harmonics exp(i k tau_0 z); friction and contact, local at every station
along the pitch, do.

* Closed interfaces (:func:`bending_friction`). Half a pitch on, the curvature is reversed in the turning frame; with a grip that is the
  same at all z, so are the slips, and only the odd harmonics k = 1, 3, .. 2 K - 1 appear, on 2 K stations along half a pitch. The grip is
  that of the axial load (or given) and is not changed by bending; tangential tractions that the axial load itself leaves on the
  interfaces are not in the cone.
* Interfaces that open (:func:`contact_section`). Parts open on one side of the bend and press on the other: all harmonics 0 .. K on
  2 K + 1 stations, and stretch and twist go with the curvature, so that a tension, its pressures and its friction are in the same problem.

Layered strands in bending, for comparison: Papailiou, J. Eng. Mech. 123 (1997) 570-579 and IEEE Trans. Power Deliv. 12 (1997)
1576-1588, doi 10.1109/61.634178.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import SpecError
from homogenize.contact_step import NodeLaws
from homogenize.coulomb_interface import Coulomb
from homogenize.interface_choice import Interfaces
from homogenize.interface_condensation import CondensedHarmonic, Progress, condense_all, force_driven, without_torque
from homogenize.interface_operator import InterfaceOperator
from homogenize.section_field import FloatArray
from homogenize.section_system import section_system

AXIAL_STRAINS, AXIAL_FORCES = ("stretch", "twist"), ("N", "M_z")
BENDING_STRAINS, BENDING_FORCES = ("kappa_x", "kappa_y"), ("M_x", "M_y")


@dataclass(frozen=True)
class RubbingSection:
    """A section condensed onto the slips and openings of its interfaces (m nodes).

    Attributes
    ----------
    operator : stiffness of jumps and strains
    strains, forces : names of the strains and of the forces that answer
    surface : (m,) surface of each node per length of cable [m]
    friction : (m,) friction coefficient
    rubs, opens : (m,) whether a node has slips, and an opening, among the unknowns of the operator
    gap : (m,) of the unloaded parts, negative for an interference [m]
    position : (2, m) in the rotating frame at phase zero [m]
    normal : (3, m) of the interface, out of the first of its two parts
    parts : (m,) names of the two parts
    """

    operator: InterfaceOperator
    strains: tuple[str, ...]
    forces: tuple[str, ...]
    surface: FloatArray
    friction: FloatArray
    rubs: NDArray[np.bool_]
    opens: NDArray[np.bool_]
    gap: FloatArray
    position: FloatArray
    normal: FloatArray
    parts: tuple[tuple[str, str], ...]

    @property
    def bonded(self) -> FloatArray:
        """Stiffness (p, p) of the strains while everything that rubs sticks and nothing opens."""
        return self.operator.stiffness

    @property
    def frictionless(self) -> FloatArray:
        """Stiffness (p, p) of the strains when every slip is free and nothing opens."""
        slips = slice(0, 2 * int(self.rubs.sum()))
        closed = [CondensedHarmonic(h.order, h.C, h.A[slips], h.S[slips, slips]) for h in self.operator.harmonics]
        return self.operator.in_strains([h.frictionless for h in closed])

    @property
    def open(self) -> FloatArray:
        """Stiffness (p, p) when every slip is free and all that can open is open."""
        return self.operator.in_strains([h.frictionless for h in self.operator.harmonics])

    @property
    def laws(self) -> NodeLaws:
        """The laws of the nodes, in the order of the operator's unknowns."""
        number = np.where(self.opens, np.cumsum(self.opens) - 1, -1)
        return NodeLaws(self.friction[self.rubs], number[self.rubs], self.gap[self.opens])

    def forced(self, drives: Sequence[str] | None) -> NDArray[np.bool_]:
        """Which of the strains (p,) are found from a given force; `drives` names for each the strain or the force.

        Raises
        ------
        SpecError
            If a name does not fit.
        """
        names = self.strains if drives is None else tuple(drives)
        if len(names) != len(self.strains) or any(n not in pair for n, pair in zip(names, self._pairs(), strict=False)):
            wanted = ", ".join(f"{e} or {F}" for e, F in self._pairs())
            raise SpecError(f"what drives a load path is {wanted}; found {', '.join(names)}.")
        forced = np.array([n == F for n, F in zip(names, self.forces, strict=True)])
        if "kappa_x" in self.strains and forced[-2] != forced[-1]:
            raise SpecError("both bendings are driven alike: kappa_x and kappa_y, or M_x and M_y.")
        return forced

    def driven(self, drives: Sequence[str] | None) -> InterfaceOperator:
        """The operator whose loads are given strains or forces.

        Raises
        ------
        SpecError
            If a name does not fit.
        """
        forced = self.forced(drives)
        if not forced.any():
            return self.operator
        found = [force_driven(h, forced[-1:] if h.order else forced[: len(h.C)]) for h in self.operator.harmonics]
        return InterfaceOperator(tuple(found), self.operator.rubbing)

    def _pairs(self) -> list[tuple[str, str]]:
        return list(zip(self.strains, self.forces, strict=True))


def axial_friction(
    mesh: CrossSectionMesh, interfaces: Interfaces, free_twist: bool = False, progress: Progress | None = None
) -> RubbingSection:
    """Condense a section for loops of (stretch, twist rate), or of the stretch alone with ends that are free to turn.

    Parameters
    ----------
    mesh : CrossSectionMesh
        Six-node triangles.
    interfaces : Interfaces
        At least one of them :class:`~homogenize.coulomb_interface.Coulomb`; the others keep their laws.
    free_twist : bool
        The torque is zero and the twist follows.

    Raises
    ------
    SpecError, MeshError
        If nothing rubs, an interface can open (see :func:`contact_section`), or names do not fit the parts.
    """
    _refuse_without_friction(interfaces)
    section = _condensed(mesh, interfaces, (0,), progress)
    return free_to_turn(section) if free_twist else section


def free_to_turn(section: RubbingSection) -> RubbingSection:
    """A section of (stretch, twist) with the stretch alone: no torque, and the twist follows."""
    released = InterfaceOperator((without_torque(section.operator.harmonics[0]),), section.operator.rubbing)
    return replace(section, operator=released, strains=("stretch",), forces=("N",))


def bending_friction(
    mesh: CrossSectionMesh, interfaces: Interfaces, harmonics: int = 4, progress: Progress | None = None
) -> RubbingSection:
    """Condense a section for loops of curvature (kappa_x, kappa_y) about fixed axes.

    Parameters
    ----------
    mesh, interfaces : as in :func:`axial_friction`
    harmonics : int
        K: odd harmonics 1 .. 2 K - 1, on 4 K stations a pitch.

    Raises
    ------
    SpecError, MeshError
        If nothing rubs, an interface can open, the cable is not laid, or names do not fit the parts.
    """
    _refuse_without_friction(interfaces)
    _refuse_without_lay(mesh, harmonics)
    return _condensed(mesh, interfaces, tuple(range(1, 2 * harmonics, 2)), progress)


def contact_section(
    mesh: CrossSectionMesh, interfaces: Interfaces, harmonics: int = 0, progress: Progress | None = None
) -> RubbingSection:
    """Condense a section whose parts can open, with or without friction, for loops of tension, torsion and bending.

    Parameters
    ----------
    mesh : CrossSectionMesh
        Six-node triangles.
    interfaces : Interfaces
        At least one of them :class:`~homogenize.opening_contact.Unilateral`; the others keep their laws.
    harmonics : int
        0: strains (stretch, twist). K >= 1: strains (stretch, twist, kappa_x, kappa_y), harmonics 0 .. K on 2 K + 1 stations a pitch.

    Raises
    ------
    SpecError, MeshError
        If nothing can open, the cable is to be bent and is not laid, or names do not fit the parts.
    """
    if not any(getattr(law, "opens", False) for law in interfaces.laws.values()):
        raise SpecError("no interface can open: give at least one of them the law Unilateral().")
    if harmonics:
        _refuse_without_lay(mesh, harmonics)
    return _condensed(mesh, interfaces, tuple(range(harmonics + 1)), progress, opening=True)


def _refuse_without_friction(interfaces: Interfaces) -> None:
    if not any(isinstance(law, Coulomb) for law in interfaces.laws.values()):
        raise SpecError("no interface rubs: give at least one of them the law Coulomb(friction).")


def _refuse_without_lay(mesh: CrossSectionMesh, harmonics: int) -> None:
    if mesh.twist_rate == 0.0:
        raise SpecError(
            "friction in bending needs a lay: in a straight cable no section ever unloads its slip along z."
        )
    if harmonics < 1:
        raise SpecError(f"bending needs at least one harmonic along the pitch, found {harmonics}.")


def _condensed(
    mesh: CrossSectionMesh,
    interfaces: Interfaces,
    orders: tuple[int, ...],
    progress: Progress | None,
    opening: bool = False,
) -> RubbingSection:
    system = section_system(mesh, interfaces, history=True, opening=opening)
    sliding = system.sliding
    assert sliding is not None
    doubled = sliding.doubled
    opens = np.zeros(len(doubled.child), dtype=bool)
    opens[sliding.opening] = True
    friction = sliding.constant_of_links("friction")
    rubs = opens & (friction > 0)
    rubs[sliding.links_of(Coulomb)] = True
    jumps = np.concatenate(
        [sliding.slips_of(np.flatnonzero(rubs)), sliding.first_opening + np.arange(len(sliding.opening))]
    )
    links = np.flatnonzero(rubs | opens)
    axial, bending = 0 in orders, 1 in orders
    return RubbingSection(
        operator=InterfaceOperator(condense_all(system, jumps, orders, progress), int(rubs.sum())),
        strains=axial * AXIAL_STRAINS + bending * BENDING_STRAINS,
        forces=axial * AXIAL_FORCES + bending * BENDING_FORCES,
        surface=doubled.surface[links],
        friction=friction[links],
        rubs=rubs[links],
        opens=opens[links],
        gap=sliding.constant_of_links("gap")[links],
        position=doubled.nodes[:, doubled.child[links]],
        normal=doubled.frame[0][:, links],
        parts=tuple((mesh.regions[a].name, mesh.regions[b].name) for a, b in doubled.regions[links]),
    )

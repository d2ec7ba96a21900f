r"""Sections that rub, condensed for loops of tension and torsion, and of bending.

Tension and torsion: harmonic 0, every section of the cable slips alike.

Bending about a fixed axis: in the turning frame the curvature (kappa_x, kappa_y) is Re[(kappa_x - i kappa_y) (1, i) exp(i tau_0 z)],
and the slips vary along the pitch. Stiffness does not couple the harmonics exp(i k tau_0 z);
friction, local at every station along the pitch, does.
Half a pitch on, the curvature is reversed in the turning frame; with a grip that is the same at all z, so are the slips, and only the
odd harmonics k = 1, 3, .. 2 K - 1 appear, on 2 K stations along half a pitch.

Limits: the grip is that of the axial load (or given) and is not changed by bending; the parts do not open; tangential tractions that the
axial load itself leaves on the interfaces are not in the cone.

Layered strands in bending, for comparison: Papailiou, J. Eng. Mech. 123 (1997) 570-579 and IEEE Trans. Power Deliv. 12 (1997)
1576-1588, doi 10.1109/61.634178.
"""

from __future__ import annotations

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import SpecError
from homogenize.coulomb_interface import Coulomb, SlipOperator
from homogenize.friction_loop import Progress, RubbingSection
from homogenize.interface_choice import Interfaces
from homogenize.interface_condensation import condense_all, without_torque
from homogenize.section_system import section_system


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
        If nothing rubs, or names do not fit the parts.
    """
    section = _rubbing(mesh, interfaces, (0,), progress)
    if not free_twist:
        return section
    released = SlipOperator((without_torque(section.operator.harmonics[0]),))
    return RubbingSection(
        released,
        ("stretch",),
        ("N",),
        section.surface,
        section.friction,
        section.position,
        section.normal,
        section.parts,
        False,
    )


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
        If nothing rubs, the cable is not laid, or names do not fit the parts.
    """
    if mesh.twist_rate == 0.0:
        raise SpecError(
            "friction in bending needs a lay: in a straight cable no section ever unloads its slip along z."
        )
    if harmonics < 1:
        raise SpecError(f"bending needs at least one harmonic along the pitch, found {harmonics}.")
    return _rubbing(mesh, interfaces, tuple(range(1, 2 * harmonics, 2)), progress)


def _rubbing(
    mesh: CrossSectionMesh, interfaces: Interfaces, orders: tuple[int, ...], progress: Progress | None
) -> RubbingSection:
    if not any(isinstance(law, Coulomb) for law in interfaces.laws.values()):
        raise SpecError("no interface rubs: give at least one of them the law Coulomb(friction).")
    system = section_system(mesh, interfaces, history=True)
    sliding = system.sliding
    assert sliding is not None
    links = sliding.links_of(Coulomb)
    doubled = sliding.doubled
    bending = orders[0] == 1
    return RubbingSection(
        operator=SlipOperator(condense_all(system, sliding.slips_of(links), orders, progress)),
        strains=("kappa_x", "kappa_y") if bending else ("stretch", "twist"),
        forces=("M_x", "M_y") if bending else ("N", "M_z"),
        surface=doubled.surface[links],
        friction=sliding.constant_of_links("friction")[links],
        position=doubled.nodes[:, doubled.child[links]],
        normal=doubled.frame[0][:, links],
        parts=tuple((mesh.regions[a].name, mesh.regions[b].name) for a, b in doubled.regions[links]),
        complex_strain=bending,
    )

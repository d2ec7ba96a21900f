r"""The assembled section with its interfaces: what the solvers of tension, torsion, bending and friction start from.

With the slips s among the unknowns (:mod:`homogenize.sliding_interface`) the matrices are T^T E_i T, and an elastic interface adds its
k_t w on the diagonal of E2 (:mod:`homogenize.elastic_interface`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import SpecError
from homogenize.elastic_interface import Elastic
from homogenize.free_motion import check_connected
from homogenize.interface_choice import Interfaces
from homogenize.section_field import FloatArray, SectionField, section_field
from homogenize.section_problem import SectionPencil, gauge_unknowns
from homogenize.sliding_interface import Frictionless, SlidingField, sliding_field

INTERFACES = ("bonded", "frictionless")
"""Interfaces that have a word of their own."""


@dataclass(frozen=True)
class SectionSystem:
    """The section's matrices and what to pin.

    Attributes
    ----------
    field : the finite element field, with doubled nodes where parts slide
    pencil : its matrices in the free unknowns
    gauge : six unknowns pinned against motions of the whole section
    sliding : interfaces and unknowns; None when all parts are bonded
    slip_stiffness : (unknowns,) k_t w of elastic interfaces, on the diagonal of E2 already
    """

    field: SectionField
    pencil: SectionPencil
    gauge: tuple[int, ...]
    sliding: SlidingField | None
    slip_stiffness: FloatArray

    @property
    def T(self) -> sp.csr_array | None:
        """Nodal values from the free unknowns; None for the identity."""
        return None if self.sliding is None else self.sliding.T

    @property
    def slip_pins(self) -> tuple[int, ...]:
        """Unknowns pinned in the z-independent problem against free motions of parts."""
        return () if self.sliding is None else self.sliding.slip_pins

    @property
    def free_motions(self) -> tuple[str, ...]:
        """The motions that ``slip_pins`` stop, in words."""
        return () if self.sliding is None else self.sliding.free_motions


def section_system(
    mesh: CrossSectionMesh, interface: str | Interfaces = "bonded", history: bool = False, opening: bool = False
) -> SectionSystem:
    """Assemble a section; `history` says that the caller follows laws that depend on the history of the load, `opening` that it
    follows interfaces that open.

    Raises
    ------
    SpecError, MeshError
        See :func:`homogenize.helical_cell.solve_helical_cell`.
    """
    interfaces = _interfaces(interface)
    field = section_field(mesh)
    check_connected(field, mesh)
    if interfaces is None:
        gauge = gauge_unknowns(field.nodes, np.ones(field.nodes.shape[1], dtype=bool))
        E0, E1, E2 = field.matrices()
        pencil = SectionPencil(E0, sp.csr_array(E1.T - E1), E1, E2, field.rigid_motion(), field.area**0.5)
        return SectionSystem(field, pencil, gauge, None, np.zeros(field.unknowns))
    opens = [name for name, law in interfaces.laws.items() if getattr(law, "opens", False)]
    if opens and not opening:
        raise SpecError(
            f'the interface "{opens[0]}" can open, its stiffness depends on the load: follow a path of stretch and twist with '
            "opening_section and opening_path, or close it with Frictionless()."
        )
    remembers = [
        name
        for name, law in interfaces.laws.items()
        if not isinstance(law, Frictionless | Elastic) and name not in opens
    ]
    if remembers and not history:
        raise SpecError(
            f'the friction of "{remembers[0]}" has no single stiffness, its slip depends on the history of the load: '
            "follow a load path with friction_loop (`helicable loop`), or use Frictionless() or Elastic(k_t)."
        )
    sliding = sliding_field(field, mesh, interfaces)
    E0, E1, E2 = (sp.csr_array(sliding.T.T @ E @ sliding.T) for E in sliding.field.matrices())
    stiffness = np.zeros(len(sliding.Z))
    stiffness[sliding.first_slip : sliding.first_opening] = np.repeat(
        sliding.constant_of_links("stiffness") * sliding.doubled.surface, 2
    )
    E2 = sp.csr_array(E2 + sp.diags_array(stiffness))
    pencil = SectionPencil(E0, sp.csr_array(E1.T - E1), E1, E2, sliding.Z, sliding.field.area**0.5)
    gauge = gauge_unknowns(field.nodes, sliding.anchored)
    return SectionSystem(sliding.field, pencil, gauge, sliding, stiffness)


def _interfaces(interface: str | Interfaces) -> Interfaces | None:
    """The interfaces that a word stands for; None for bonded."""
    if isinstance(interface, Interfaces):
        return interface
    if interface not in INTERFACES:
        raise SpecError(f'the interface "{interface}" is not known; choose {" or ".join(INTERFACES)}.')
    return None if interface == "bonded" else Interfaces({"conductor-insulation": Frictionless()})

r"""Strand, conductor, core, cable: each stage replaced by its equivalent before the next one is solved.

1. Strand of wires: a cylinder with :math:`E A = E_{wire} \sum A_{wire} \cos^3\beta`. The cable file states the measured modulus,
   which the next stages use; that of the wires is shown beside it.
2. Conductor of strands: its 6x6 by the helical cell of the bare rope, strands bonded or sliding (:mod:`homogenize.strand_section`).
3. The conductor as a cylinder with helical fibres and the same EA, coupling and GJ (:mod:`homogenize.equivalent_cylinder`).
4. Core: that cylinder in its insulation and screen, straight (shown; the cable holds the layers themselves).
5. Cable: the helical cell of the section with these cylinders, and the bending stiffness that the cylinders have too much of
   taken off (:mod:`homogenize.rod_correction`).

Conductors without strands stay what the cable file says. The stages are one way: the rope is solved with free sides and pure
section strains, so that local contact with the insulation is not seen; benchmarks/two_stage.py shows the difference to a cell
with all strands.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from geometry import Cable, CrossSectionMesh, Part, Strand, cross_section_mesh, lay_angle
from geometry.cable import ring_moments
from geometry.errors import SpecError
from homogenize.equivalent_cylinder import EquivalentCylinder, equivalent_cylinder
from homogenize.helical_cell import HelicalCell, solve_helical_cell
from homogenize.rod_correction import bending_correction
from homogenize.section_stiffness import SectionStiffness, pitch_average
from homogenize.strand_section import StrandSection, strand_section

Progress = Callable[[float, str], None]
WIRE_MODULUS = 112e9
"""Copper wire [Pa]: what makes a fill of 0.713 come to the measured 80 GPa of the power strand."""


@dataclass(frozen=True)
class Stage:
    """One line of the table: what was replaced, and the constants of what stands for it; SI, None where it has none."""

    name: str
    what: str
    area: float
    EA_blocked_twist: float
    EA_free_twist: float | None = None
    coupling: float | None = None
    GJ: float | None = None
    EI: float | None = None

    @property
    def E(self) -> float:
        """EA with the twist blocked over the area [Pa]."""
        return self.EA_blocked_twist / self.area


@dataclass(frozen=True)
class TwoStage:
    """Result of the two-stage route.

    Attributes
    ----------
    stages : the table, from the strands to the cable
    section : 6x6 of a cable longer than a pitch; `phase_zero` at phase zero
    single_cylinder : the same with every conductor as one isotropic cylinder, as the cable file gives it
    cell, mesh : the cable with its equivalent cylinders, before the bending correction
    strands, interface : how the strands, and the conductors in their insulation, hold together
    """

    cable: Cable
    stages: tuple[Stage, ...]
    section: SectionStiffness
    phase_zero: SectionStiffness
    single_cylinder: SectionStiffness
    cell: HelicalCell
    mesh: CrossSectionMesh
    strands: str
    interface: str


def strand_modulus(strand: Strand, wire_modulus: float = WIRE_MODULUS) -> float:
    """E [Pa] of the cylinder for a strand: that of its wires, each with the cube of the cosine of its lay.

    Examples
    --------
    >>> power = Strand("power", 0.49e-3, (3, 9, 15), 40e-3, "Z", 8900.0, 80e9, 0.34)
    >>> round(strand_modulus(power) / power.E, 3)
    0.959
    """
    cubes = np.dot(strand.layers, [np.cos(lay_angle(radius, strand.lay)) ** 3 for radius in strand.radii])
    return float(wire_modulus * np.pi * strand.wire_diameter**2 / 4 * cubes / strand.area)


def two_stage(
    cable: Cable,
    strands: str = "bonded",
    interface: str = "bonded",
    size: float | None = None,
    wire_modulus: float = WIRE_MODULUS,
    progress: Progress | None = None,
) -> TwoStage:
    """Section stiffness of a cable with its stranded conductors by their equivalents.

    Parameters
    ----------
    cable : Cable
        With at least one conductor of strands.
    strands : str
        ``"bonded"`` or ``"frictionless"``: between the strands of a conductor.
    interface : str
        The same between the conductors and what is round them.
    size : float, optional
        Edge length in the section of the cable [m].
    wire_modulus : float
        Of the wires in the strands [Pa], for the first lines of the table only.
    progress : callable, optional
        Called with a fraction and a sentence.

    Returns
    -------
    TwoStage

    Raises
    ------
    SpecError
        If no conductor has strands, or an interface is not known.
    MeshError, GeometryError, ConvergenceError
        As the cells of the stages.
    """
    tell = progress or (lambda fraction, sentence: None)
    used = {part.conductor for part in cable.parts if part.conductor is not None}
    stranded = [
        c for name, c in cable.conductors.items() if name in used and c.strand is not None and sum(c.layers) > 1
    ]
    if not stranded:
        raise SpecError(
            f"no conductor of {cable.name} has strands, so that there is nothing to replace: use the helical cell."
        )
    ropes: dict[str, tuple[StrandSection, EquivalentCylinder]] = {}
    for k, conductor in enumerate(stranded):
        tell(0.4 * k / len(stranded), f"solving the strands of conductor {conductor.name}")
        rope = strand_section(conductor, strands)
        ropes[conductor.name] = rope, equivalent_cylinder(rope)
    tell(0.4, "meshing the cross-section")
    plain = cross_section_mesh(cable, size=size)
    mesh = _with_cylinders(cable, plain, ropes)
    tell(0.5, f"solving the cable, {3 * len(mesh.points)} unknowns")
    cell = solve_helical_cell(mesh, interface)
    phase_zero = _bending_put_right(cable, cell, ropes)
    tell(0.75, "solving the cable with single cylinders")
    single = pitch_average(solve_helical_cell(plain, interface).stiffness)
    section = pitch_average(phase_zero)
    tell(0.9, "solving the cores")
    stages = (
        *_strand_stages(stranded, wire_modulus),
        *_rope_stages(ropes),
        *(_core_stage(cable, member, ropes) for member in _members(cable, ropes)),
        _stage("cable", "of these cylinders, bending put right", section),
        _stage("cable", "of single isotropic cylinders", single),
    )
    tell(1.0, "stages solved")
    return TwoStage(cable, stages, section, phase_zero, single, cell, mesh, strands, interface)


def _with_cylinders(cable: Cable, mesh: CrossSectionMesh, ropes: dict) -> CrossSectionMesh:
    """The section with the equivalent of each stranded conductor as the material of its region."""
    regions = list(mesh.regions)
    for number, region in enumerate(regions):
        part = cable.part(region.name)
        if part.conductor in ropes:
            regions[number] = replace(region, material=_laid(ropes[part.conductor][1], part))
    return replace(mesh, regions=tuple(regions))


def _laid(cylinder: EquivalentCylinder, part: Part):
    """Material of a cylinder laid in a cable: its fibres turn with the core, and about it at their rate per arc length.

    The rate is counted in the frame of parallel transport of the core, which turns at -tau cos^2 beta per arc length in that of the core.
    """
    cosine = np.cos(part.lay_angle)
    own = cylinder.material.turn_rate or 0.0
    in_core = (own - part.twist_rate * cosine**2) / cosine if part.centre_radius > 0 else own - part.twist_rate
    centre = part.centre_radius * np.cos(part.phase), part.centre_radius * np.sin(part.phase)
    return replace(
        cylinder.material, centre=(float(centre[0]), float(centre[1])), turn_rate=float(in_core + part.twist_rate)
    )


def _bending_put_right(cable: Cable, cell: HelicalCell, ropes: dict) -> SectionStiffness:
    C = cell.stiffness.C.copy()
    for number, part in enumerate(cable.parts):
        if part.conductor in ropes:
            rope, cylinder = ropes[part.conductor]
            C += bending_correction(cell, number, part, rope.stiffness.EI_x - cylinder.stiffness.EI_x)
    return SectionStiffness(C, cell.stiffness.area)


def _stage(name: str, what: str, s: SectionStiffness) -> Stage:
    return Stage(name, what, s.area, s.EA_blocked_twist, s.EA_free_twist, s.coupling, s.GJ, s.EI_x)


def _strand_stages(stranded: list, wire_modulus: float) -> list[Stage]:
    found = {}
    for conductor in stranded:
        s = conductor.strand
        found[f"{s.name} strand", f"wires of {wire_modulus / 1e9:.4g} GPa"] = s.area, strand_modulus(s, wire_modulus)
        found[f"{s.name} strand", "as the cable file says"] = s.area, s.E
    return [Stage(name, what, area, E * area) for (name, what), (area, E) in found.items()]


def _rope_stages(ropes: dict) -> list[Stage]:
    found = []
    for name, (rope, cylinder) in ropes.items():
        found.append(_stage(f"{name} conductor", f"rope of {rope.strands} strands", rope.stiffness))
        found.append(_stage(f"{name} conductor", "equivalent cylinder", cylinder.stiffness))
    return found


def _members(cable: Cable, ropes: dict) -> list[str]:
    """One member for each kind of stranded conductor that has layers of its own."""
    first = {part.conductor: part.member for part in reversed(cable.parts) if part.conductor in ropes}
    return [m for m in dict.fromkeys(first.values()) if sum(p.member == m for p in cable.parts) > 1]


def _core_stage(cable: Cable, member: str, ropes: dict) -> Stage:
    """A core by itself, straight, its conductor as the equivalent cylinder."""
    parts = []
    for part in (p for p in cable.parts if p.member == member):
        moments = tuple(ring_moments(0.0, 0.0, part.inner_radius, part.outer_radius, 0.0).tolist())
        parts.append(replace(part, centre_radius=0.0, phase=0.0, twist_rate=0.0, moments=moments))
    radius = parts[-1].outer_radius
    core = replace(cable, name=member, parts=tuple(parts), lay=None, outer_radius=radius, laid_up_radius=radius)
    mesh = cross_section_mesh(core)
    conductor = next(part for part in parts if part.conductor in ropes)
    cylinder = ropes[conductor.conductor][1]
    rate = cylinder.material.turn_rate or 0.0
    mesh = replace(_with_cylinders(core, mesh, ropes), twist_rate=rate)
    return _stage(member, "cylinder, insulation and screen", pitch_average(solve_helical_cell(mesh).stiffness))

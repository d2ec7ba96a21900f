"""From a meshed cable to the stiffness of its beam section.

The path: a cross-section mesh -> :func:`solve_helical_cell` (2D, full 6x6) or a slice or nested cell -> :func:`solve_periodic_cell` (3D,
full 6x6) -> :class:`SectionStiffness`, with :func:`volume_average` for the moduli of the published procedure and
:func:`check_cell` for what every result must satisfy.
"""

from homogenize.cell_checks import Check, axial_bounds, check_cell
from homogenize.coulomb_interface import Coulomb
from homogenize.elastic_interface import Elastic
from homogenize.friction_loop import FrictionLoop, friction_loop
from homogenize.grip_pressure import grip_per_tension
from homogenize.helical_cell import INTERFACES, HelicalCell, solve_helical_cell
from homogenize.homogenization import Homogenization, homogenize_cable, slice_stiffness, strand_stiffness
from homogenize.interface_choice import Interfaces
from homogenize.opening_contact import OpeningPath, Unilateral, opening_path, opening_section
from homogenize.periodic_cell import PeriodicCell, solve_periodic_cell
from homogenize.rubbing_section import axial_friction, bending_friction, contact_section
from homogenize.section_stiffness import ORDER, SectionInertia, SectionStiffness, pitch_average
from homogenize.sliding_interface import Frictionless
from homogenize.stiffness_bounds import LooseStiffness, StiffnessRange, allowed_stiffness, loose_stiffness
from homogenize.two_stage import TwoStage, two_stage
from homogenize.volume_average import VolumeAverage, volume_average

__all__ = [
    "INTERFACES",
    "ORDER",
    "Check",
    "Coulomb",
    "Elastic",
    "FrictionLoop",
    "Frictionless",
    "HelicalCell",
    "Homogenization",
    "Interfaces",
    "LooseStiffness",
    "OpeningPath",
    "PeriodicCell",
    "SectionInertia",
    "SectionStiffness",
    "StiffnessRange",
    "TwoStage",
    "Unilateral",
    "VolumeAverage",
    "allowed_stiffness",
    "axial_bounds",
    "axial_friction",
    "bending_friction",
    "check_cell",
    "contact_section",
    "friction_loop",
    "grip_per_tension",
    "homogenize_cable",
    "loose_stiffness",
    "opening_path",
    "opening_section",
    "pitch_average",
    "slice_stiffness",
    "solve_helical_cell",
    "solve_periodic_cell",
    "strand_stiffness",
    "two_stage",
    "volume_average",
]

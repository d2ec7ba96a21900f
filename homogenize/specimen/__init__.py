"""The finite specimen: a piece of cable, held at one end and loaded at the other, as the published moduli were found."""

from homogenize.specimen.axial_grading import AxialGrading
from homogenize.specimen.coarse_section import coarse_section
from homogenize.specimen.contact_condensation import ContactSpecimen, contact_specimen
from homogenize.specimen.end_condition import Held, Plate, Traction, read_end
from homogenize.specimen.frictional_contact import FrictionalContact
from homogenize.specimen.large_displacement_specimen import FollowedLoad, follow_specimen
from homogenize.specimen.load_case import LoadCase
from homogenize.specimen.opening_specimen import ContactStep, contact_path, initial_state
from homogenize.specimen.specimen_solution import Specimen, SpecimenSolution, solve_specimen

__all__ = [
    "AxialGrading",
    "ContactSpecimen",
    "ContactStep",
    "FollowedLoad",
    "FrictionalContact",
    "Held",
    "LoadCase",
    "Plate",
    "Specimen",
    "SpecimenSolution",
    "Traction",
    "coarse_section",
    "contact_path",
    "contact_specimen",
    "follow_specimen",
    "initial_state",
    "read_end",
    "solve_specimen",
]

"""The finite specimen: a piece of cable, held at one end and loaded at the other, as the published moduli were found."""

from homogenize.specimen.axial_grading import AxialGrading
from homogenize.specimen.end_condition import Held, Plate, Traction, read_end
from homogenize.specimen.load_case import LoadCase
from homogenize.specimen.specimen_solution import Specimen, SpecimenSolution, solve_specimen

__all__ = [
    "AxialGrading",
    "Held",
    "LoadCase",
    "Plate",
    "Specimen",
    "SpecimenSolution",
    "Traction",
    "read_end",
    "solve_specimen",
]

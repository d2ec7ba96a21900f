"""The published load cases of a finite specimen: 2000 N along the cable, 500 N in +X, -X, +Y and -Y.

Ge M. et al., PLoS ONE 18(2) e0281136 (2023), doi 10.1371/journal.pone.0281136: moduli are slopes of the average stress-strain lines,
displacements the largest of each case. The length and the drawing of the specimen are not published. The pairing of the +-X tests with
the plane yoz is the source's.

A cable NAME whose file has no table [specimen] is represented by the cable NAME-specimen, where one ships: its constructed section with
the inputs that are not published calibrated to these numbers.
"""

from __future__ import annotations

from dataclasses import dataclass

from geometry import Cable, read_cable
from geometry.cable_file import cable_files
from helicable.published import G_XOZ, G_YOZ, E
from homogenize.specimen import LoadCase
from homogenize.specimen.apparent_modulus import ApparentModulus

SUFFIX = "-specimen"
LOADS = (
    LoadCase("tension", 2000.0),
    LoadCase("shear", 500.0, "x"),
    LoadCase("shear", -500.0, "x"),
    LoadCase("shear", 500.0, "y"),
    LoadCase("shear", -500.0, "y"),
)
DISPLACEMENTS = {"tension": 4.1e-3, "shear +x": 6.95e-3, "shear -x": 7.96e-3, "shear +y": 7.71e-3, "shear -y": 7.02e-3}


def specimen_cable(name: str) -> tuple[Cable, str]:
    """The cable whose specimen stands for the published test of `name`, and a sentence that says which; "" where it is the cable itself.

    Examples
    --------
    >>> specimen_cable("mcpt-1.9-3.3-3x35")[0].name
    'mcpt-1.9-3.3-3x35-specimen'
    """
    cable = read_cable(name)
    other = f"{name}{SUFFIX}"
    if cable.specimen is not None or other not in cable_files():
        return cable, ""
    return read_cable(other), (
        f"{name} is represented by {other}: the section of the published specimen is not known; this one is constructed, and what is not "
        "published in it was calibrated to these very numbers, each inside its range"
    )


@dataclass(frozen=True)
class PublishedRow:
    """A published number beside the computed one, in `unit` "Pa" or "m"."""

    quantity: str
    published: float
    computed: float
    unit: str

    @property
    def ratio(self) -> float:
        """Computed over published."""
        return self.computed / self.published


def published_rows(found: tuple[ApparentModulus, ...]) -> list[PublishedRow]:
    """E, G_yoz, G_xoz (means over both signs) and the five displacements, for moduli in the order of LOADS."""
    by = {a.load: a for a in found}
    rows = [
        PublishedRow("E", E, by["tension"].modulus, "Pa"),
        PublishedRow("G_yoz", G_YOZ, (by["shear +x"].modulus + by["shear -x"].modulus) / 2, "Pa"),
        PublishedRow("G_xoz", G_XOZ, (by["shear +y"].modulus + by["shear -y"].modulus) / 2, "Pa"),
    ]
    return rows + [PublishedRow(f"u, {name}", u, by[name].u_max, "m") for name, u in DISPLACEMENTS.items()]

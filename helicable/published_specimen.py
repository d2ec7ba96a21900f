"""The published load cases of a finite specimen: 2000 N along the cable, 500 N in +X, -X, +Y and -Y.

Ge M. et al., PLoS ONE 18(2) e0281136 (2023), doi 10.1371/journal.pone.0281136: moduli are slopes of the average stress-strain lines,
displacements the largest of each case. The length and the drawing of the specimen are not published. The pairing of the +-X tests with
the plane yoz is the source's.
"""

from __future__ import annotations

from dataclasses import dataclass

from helicable.published import G_XOZ, G_YOZ, E
from homogenize.specimen import LoadCase
from homogenize.specimen.apparent_modulus import ApparentModulus

LENGTH = 0.1823
"""Length [m] that was fitted to the published numbers; not published itself."""
LOADS = (
    LoadCase("tension", 2000.0),
    LoadCase("shear", 500.0, "x"),
    LoadCase("shear", -500.0, "x"),
    LoadCase("shear", 500.0, "y"),
    LoadCase("shear", -500.0, "y"),
)
DISPLACEMENTS = {"tension": 4.1e-3, "shear +x": 6.95e-3, "shear -x": 7.96e-3, "shear +y": 7.71e-3, "shear -y": 7.02e-3}


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

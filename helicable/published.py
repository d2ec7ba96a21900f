"""What Ge et al. (2023) published, beside what is computed here, and why the two differ.

Ge M. et al., PLoS ONE 18(2) e0281136 (2023), doi 10.1371/journal.pone.0281136: E = 142 MPa from a finite specimen pulled by 2000 N
(slope 1.421 MPa per %, R2 0.996), G_yoz = 53 MPa and G_xoz = 45 MPa from 500 N across it (R2 0.993 and 0.972).
"""

from __future__ import annotations

from dataclasses import dataclass

from homogenize import Homogenization

CABLE_TYPE = "mcpt-1.9-3.3"
E = 142e6
G_YOZ = 53e6
G_XOZ = 45e6


@dataclass(frozen=True)
class Row:
    """A published number, the computed one, their ratio, and the reason of the difference."""

    quantity: str
    published: float
    computed: float
    unit: str
    why: str

    @property
    def ratio(self) -> float:
        """Computed over published."""
        return self.computed / self.published


def modulus_rows(result: Homogenization) -> list[Row]:
    """Published moduli beside those of the long cable; none for a cable of another type than the published one."""
    if not result.cable.name.startswith(CABLE_TYPE):
        return []
    end = (
        "published: a finite specimen of unstated length, probably one in which the soft layer at its loaded end-section is measured; "
        "computed: a long cable, whose conductors carry the load. The straight earth conductor alone gives "
        f"{result.bounds[0] / result.section.area / 1e6:.0f} MPa, a lower bound for any long cable"
    )
    shear = (
        "published: transverse load on that specimen, bending included; computed: mean shear stress over mean shear strain "
        "of a long cable, which is that of the rubber between the conductors"
    )
    return [
        Row("E, twist blocked", E, result.average.E_blocked_twist, "Pa", end),
        Row("E, ends free to twist", E, result.average.E_free_twist, "Pa", end),
        Row("G_yoz, pitch average", G_YOZ, result.average.G_yoz, "Pa", shear),
        Row("G_xoz, pitch average", G_XOZ, result.average.G_xoz, "Pa", shear),
    ]

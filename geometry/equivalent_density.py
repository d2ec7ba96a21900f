r"""Equivalent density of a concentric strand: mass of its wires over a volume, which must be said.

.. math::  \rho = \rho_w\, \frac{\tfrac{\pi}{4} \sum_i d^2 / \cos\beta_i}{A}, \qquad
           A = \tfrac{\pi}{4} D^2 \;\text{(cylinder)}, \qquad
           A = S_n R^2 + p\, d/2 + \tfrac{\pi}{4} d^2 \;\text{(hull)}

beta_i is the lay angle of wire i, zero for the density *without lay*; D the diameter over the outer layer. The hull is the
tightest convex curve about the n wires of the outer layer, centred on the circle R: their polygon (area S_n R^2,
S_n = (n/2) sin(2 pi/n), perimeter p = 2 n R sin(pi/n)), moved outwards by half a wire (Steiner's formula).

Published (Ge et al., PLoS ONE 18(2) e0281136, 2023): 6343 kg/m3 for power and ground strands, 6041 kg/m3 for the control
strand. The first is the cylinder without lay of 27 wires, 3 + 9 + 15, to 1 kg/m3 with copper of 8900 kg/m3; the hull gives
6488. The second is that of no concentric strand of round wires; :func:`nearest_make_ups` says how near they come.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from geometry.errors import GeometryError, SpecError
from geometry.strand import Strand

VOLUMES = ("cylinder", "hull")


def equivalent_density(strand: Strand, volume: str = "cylinder", lay: bool = False) -> float:
    """Mass of the wires over the volume of the strand [kg/m^3].

    Parameters
    ----------
    strand : Strand
    volume : str
        ``"cylinder"`` over the outer wires, or their convex ``"hull"``.
    lay : bool
        Whether the longer way of the wires along their helices is counted.

    Raises
    ------
    SpecError
        If the volume is not known.

    Examples
    --------
    >>> power = Strand("power", 0.49e-3, (3, 9, 15), 40e-3, "Z", 8900.0, 80e9, 0.34)
    >>> [round(equivalent_density(power, v)) for v in VOLUMES], round(equivalent_density(power, lay=True))
    ([6344, 6488], 6429)
    """
    if volume not in VOLUMES:
        raise SpecError(f'volume "{volume}" is not known; choose {" or ".join(VOLUMES)}.')
    area = strand.area if volume == "cylinder" else hull_area(strand)
    longer = strand.lay_factor if lay else 1.0
    return strand.wire_density * strand.metal_area * longer / area


def hull_area(strand: Strand) -> float:
    """Area of the convex hull of the wires of the outer layer [m^2].

    Examples
    --------
    >>> one = Strand("rod", 2.0, (1,), None, "Z", 1.0, 1.0, 0.3)
    >>> round(hull_area(one) / np.pi, 12)
    1.0
    """
    n, R, d = strand.layers[-1], strand.radii[-1], strand.wire_diameter
    polygon = 0.5 * n * R**2 * np.sin(2 * np.pi / n) if n > 2 else 0.0
    perimeter = 2 * n * R * np.sin(np.pi / n) if n > 1 else 0.0
    return float(polygon + perimeter * d / 2 + np.pi * d**2 / 4)


@dataclass(frozen=True)
class MakeUp:
    """Layers of a concentric strand, the volume and lay that its density is taken with, and the density [kg/m^3]."""

    layers: tuple[int, ...]
    volume: str
    lay: bool
    density: float


def nearest_make_ups(density: float, strand: Strand, most: int = 5) -> list[MakeUp]:
    """Concentric strands whose equivalent density comes nearest to a published one, the nearest first.

    One to five wires in the middle and up to three full layers about them, each with six wires more than the one below it;
    wire, lay and metal as in `strand`.

    Examples
    --------
    >>> power = Strand("power", 0.49e-3, (3, 9, 15), None, "Z", 8900.0, 80e9, 0.34)
    >>> nearest_make_ups(6343.0, power, most=1)[0].layers
    (3, 9, 15)
    """
    found = []
    for middle, layers in product(range(1, 6), range(4)):
        counts = (middle, *((6 if middle == 1 else middle + 6) + 6 * k for k in range(layers)))
        made = replace(strand, layers=counts)
        try:
            found += [
                MakeUp(counts, volume, lay, equivalent_density(made, volume, lay))
                for volume, lay in product(VOLUMES, (False, True) if strand.lay else (False,))
            ]
        except GeometryError:  # a layer without room
            continue
    return sorted(found, key=lambda made: abs(made.density - density))[:most]

"""Layers along a specimen: thin at its ends, where the load enters the rubber first, thick between.

The displacement of the loaded end arises to 87 % in the last radius of the specimen (uniform traction on a bonded cable), so that
equal layers make it 2-6 % too stiff. Layers grow from `end_size` by the factor `growth` until `largest`; those between are equal.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import SpecError
from homogenize.specimen.axial_basis import AxialBasis

MOST_LAYERS = 2000


@dataclass(frozen=True)
class AxialGrading:
    """How a specimen is divided along its length.

    Parameters
    ----------
    end_size : height of the first and last layer, over the outer diameter
    largest : of all layers, over the outer diameter
    growth : ratio of neighbouring layers near the ends
    degree : of the polynomials in a layer

    Raises
    ------
    SpecError
        If a size or the growth is not usable.

    Examples
    --------
    >>> heights = AxialGrading(end_size=0.04).heights(0.1823, 0.05)
    >>> float(round(1e3 * heights[0], 3)), float(round(1e3 * sum(heights), 6))
    (2.0, 182.3)
    """

    end_size: float = 0.08
    largest: float = 1.0
    growth: float = 2.5
    degree: int = 4

    def __post_init__(self) -> None:
        if not (0 < self.end_size <= self.largest and np.isfinite(self.largest)):
            raise SpecError(
                f"the layers of a specimen need 0 < end_size <= largest, found {self.end_size:g} and {self.largest:g} diameters."
            )
        if not 1 <= self.growth <= 4:
            raise SpecError(f"layers may grow by a factor from 1 to 4, found {self.growth:g}.")

    def heights(self, length: float, diameter: float) -> NDArray[np.float64]:
        """Heights of the layers from one end to the other, (layers,) [m]; both ends alike."""
        first, largest = self.end_size * diameter, min(self.largest * diameter, length / 2)
        if length / largest > MOST_LAYERS:
            raise SpecError(
                f"a specimen of {length:.4g} m needs {length / largest:.0f} layers of {1e3 * largest:.3g} mm, more than {MOST_LAYERS}: "
                "take a larger `largest`."
            )
        end: list[float] = []
        while self.growth > 1 and (not end or end[-1] * self.growth < largest):
            h = end[-1] * self.growth if end else first
            if 2 * (sum(end) + h) >= length:
                break
            end.append(h)
        rest = length - 2 * sum(end)
        if end and rest < end[-1]:  # no room for one more layer between
            return np.array(end + end[::-1]) * length / (2 * sum(end))
        between = max(1, int(np.ceil(rest / (largest if end else first) - 1e-9)))
        return np.array([*end, *[rest / between] * between, *end[::-1]])

    def basis(self, length: float, diameter: float) -> AxialBasis:
        """The polynomials along a specimen of a length and a diameter [m]."""
        levels = np.concatenate([[0.0], np.cumsum(self.heights(length, diameter))])
        levels[-1] = length
        return AxialBasis(levels, self.degree)

"""Linear isotropic material.

Two constants are given, Young's modulus E and Poisson's ratio nu; the others follow:
G = E / (2 (1 + nu)), Lame lambda = E nu / ((1 + nu)(1 - 2 nu)).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import SpecError


@dataclass(frozen=True)
class Material:
    """Isotropic material: `E` [Pa], `nu` [-], `density` [kg/m^3].

    Raises
    ------
    SpecError
        If E <= 0, density <= 0, or nu outside (-1, 0.5).

    Examples
    --------
    >>> steel = Material("steel", E=210e9, nu=0.3, density=7850.0)
    >>> round(steel.G / 1e9, 3)
    80.769
    """

    name: str
    E: float
    nu: float
    density: float

    def __post_init__(self) -> None:
        if not self.E > 0:
            raise SpecError(f"material {self.name}: E = {self.E:g} Pa must be positive.")
        if not -1.0 < self.nu < 0.5:
            raise SpecError(
                f"material {self.name}: Poisson's ratio {self.nu:g} must lie between -1 and 0.5; "
                "for a nearly incompressible rubber try 0.4999."
            )
        if not self.density > 0:
            raise SpecError(f"material {self.name}: density {self.density:g} kg/m^3 must be positive.")

    @property
    def G(self) -> float:
        """Shear modulus [Pa]."""
        return self.E / (2.0 * (1.0 + self.nu))

    @property
    def lame(self) -> float:
        """First Lame constant [Pa]."""
        return self.E * self.nu / ((1.0 + self.nu) * (1.0 - 2.0 * self.nu))

    def elasticity(self) -> NDArray[np.float64]:
        """Stiffness matrix, shape (6, 6) [Pa], order xx yy zz yz xz xy with engineering shear strains."""
        C = np.diag([2 * self.G] * 3 + [self.G] * 3)
        C[:3, :3] += self.lame
        return C

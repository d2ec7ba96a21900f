r"""A helical wire that stands alone is a spring: Kirchhoff's rod, exact for a wire that is thin beside its helix.

Wire of radius a on a helix of radius r, lay angle beta from the axis, s = cos beta, c = sin beta. Compliance of (force, moment about
the axis) per axial length, without shear:

.. math::
   C_{FF} = \frac{s^2/EA + r^2 c^2/GJ + r^2 s^2/EI}{s}, \quad
   C_{FM} = \frac{r s c\,(1/GJ - 1/EI)}{s}, \quad C_{MM} = \frac{s^2/GJ + c^2/EI}{s}, \quad K = C^{-1} .

Bending by a moment across the axis: :math:`1/EI_{spring} = [c^2/(2 GJ) + (1 - c^2/2)/EI]/s`.

Source: A. E. H. Love, Mathematical Theory of Elasticity, chapter XIX. Right-handed helix, force, moment and twist positive about +z.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def spring_stiffness(beta: float, r: float, a: float, E: float = 1.0, nu: float = 0.3) -> NDArray[np.float64]:
    """K, shape (2, 2), of (stretch, twist per length); the radius is free.

    Examples
    --------
    >>> spring_stiffness(np.radians(45), 10.0, 1.0).round(7).tolist()
    [[0.0049074, -0.0064009], [-0.0064009, 0.4912711]]
    """
    EA, EI = E * np.pi * a**2, E * np.pi * a**4 / 4
    GJ = EI / (1 + nu)
    s, c = np.cos(beta), np.sin(beta)
    FF = (s**2 / EA + r**2 * c**2 / GJ + r**2 * s**2 / EI) / s
    FM = r * s * c * (1 / GJ - 1 / EI) / s
    MM = (s**2 / GJ + c**2 / EI) / s
    return np.linalg.inv(np.array([[FF, FM], [FM, MM]]))


def spring_bending_stiffness(beta: float, a: float, E: float = 1.0, nu: float = 0.3) -> float:
    """EI of the spring under a constant moment across its axis."""
    EI = E * np.pi * a**4 / 4
    c2 = np.sin(beta) ** 2
    return float(np.cos(beta) / (c2 * (1 + nu) / (2 * EI) + (1 - c2 / 2) / EI))

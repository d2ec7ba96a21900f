r"""The elastic interface: a tangential traction in proportion to the slip, no opening.

.. math::  t = k_t\, [u]_t, \qquad N \cdot [u] = 0, \qquad
           W = \tfrac12 \int k_t\, |[u]_t|^2 \sqrt{1 + \tau_0^2 (n_X Y - n_Y X)^2}\; ds

per length of cable (the root is the surface per length along z and along the trace). k_t -> 0 is the frictionless interface,
k_t -> infinity the bonded one. N, [u] and k_t do not depend on z in the rotating frame, so that the energy enters E2 alone and
one term serves tension, torsion, bending and shear. The integral is taken at the nodes by Simpson's rule, positive and exact for cubics.

Goodman, Taylor, Brekke, J. Soil Mech. Found. Div. ASCE 94 (1968) 637-659 (the joint element without thickness).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geometry.errors import SpecError


@dataclass(frozen=True)
class Elastic:
    """Tangential stiffness per area `stiffness` [Pa/m] between two parts; the normal jump is zero.

    Raises
    ------
    SpecError
        If the stiffness is negative or not finite.

    Examples
    --------
    >>> Elastic(1e9).describe()
    'elastic, 1e+09 Pa/m'
    """

    stiffness: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.stiffness) and self.stiffness >= 0):
            raise SpecError(
                f"the stiffness of an elastic interface must be zero or a positive number of Pa/m, found {self.stiffness:g}; "
                "for no slip leave the interface out, all parts are then bonded there."
            )

    @property
    def holds(self) -> bool:
        """Whether the interface resists a slip."""
        return self.stiffness > 0

    def describe(self) -> str:
        """The law in words."""
        return f"elastic, {self.stiffness:g} Pa/m"

r"""Coulomb's law on an interface that stays closed.

The traction stays inside the cone |t| <= mu p; where the parts slide it is mu p against the slip. The pressure p is given (a grip) or grows
with the tension (:mod:`homogenize.friction_loop`). Over a load step the slips s of all nodes minimise

.. math::
   \tfrac12 \langle s, S s \rangle + \langle s, A e \rangle + \sum_i c_i\, |s_i - s_i^{old}|, \qquad c_i = \mu\, p_i\, w_i ,

w_i the surface of node i per length (the principle of maximal dissipation, implicit in time; for given p the flow is associated and the sum
convex). Solved by :mod:`homogenize.contact_step`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geometry.errors import SpecError


@dataclass(frozen=True)
class Coulomb:
    """Friction coefficient `friction` between two parts that do not open.

    Raises
    ------
    SpecError
        If the coefficient is negative or not finite.

    Examples
    --------
    >>> Coulomb(0.3).describe()
    'Coulomb friction 0.3'
    """

    friction: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.friction) and self.friction >= 0):
            raise SpecError(f"a friction coefficient must be zero or positive, found {self.friction:g}.")

    @property
    def holds(self) -> bool:
        """Resists a small slip wherever it is pressed; without friction it does not."""
        return self.friction > 0

    def describe(self) -> str:
        """The law in words."""
        return f"Coulomb friction {self.friction:g}"

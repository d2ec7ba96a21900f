r"""Thin helical conductors in rubber that strains evenly: which of the two holds the cable together.

Conductors with S0 = sum of E A on radius r, lay angle beta, s = sin beta, c = cos beta, S = S0 / c; rubber of area A_r with Lame's
constants l, m; one lateral strain e_r; J = A_r^2 / (2 pi). Energy per length

.. math::
   W = \tfrac S2 (c^2 \varepsilon + s^2 e_r + s c\, r \tau)^2
     + A_r \left[\tfrac l2 (\varepsilon + 2 e_r)^2 + m (\varepsilon^2 + 2 e_r^2)\right] + \tfrac12 m J \tau^2 .

Minimising over e_r (twist blocked) or over e_r and tau (ends free to twist) gives EA. Limits of the blocked value: stiff
radius S0 c^3; incompressible rubber (S0 / c) (c^2 - s^2 / 2)^2 and 3 m A_r of the rubber itself; soft radius 4 (l + m) A_r cot^4 beta.
Of the
free value, incompressible: m J cot^2 beta / r^2 and 3 m A_r. Quadratic form of Spencer's fibre-reinforced solid, Continuum
Theory of the Mechanics of Fibre-Reinforced Composites, 1984, for one family of fibres.

Even strain holds for conductors at the surface of the rubber. Conductors inside it, at r < R, press on the rubber within their
ring, while the rubber outside gives way: :class:`RubberRing` lets it, with u = e_r x up to r and u = B x + C / x beyond (Lame),
B + C / r^2 = e_r, no pressure at R; its term in the energy is

.. math::
   \pi (R^2 - r^2) \left[\tfrac l2 (\varepsilon + 2 B)^2 + m (\varepsilon^2 + 2 B^2)\right] + 2 \pi m C^2 (1/r^2 - 1/R^2) .

This is the limit of many thin conductors; few of them also press into the rubber one by one, a compliance that falls with 1 / n.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geometry.material import Material


@dataclass(frozen=True)
class RubberFilledCable:
    """Conductors: sum of E A [N] on radius r [m] at lay angle beta [rad]; rubber: its material and area [m^2]."""

    conductors: float
    r: float
    beta: float
    rubber: Material
    area: float

    def _hessian(self) -> np.ndarray:
        """Second derivatives of W by (eps, e_r, tau)."""
        s, c = np.sin(self.beta), np.cos(self.beta)
        fibre = np.array([c**2, s**2, s * c * self.r])
        G, lame, A = self.rubber.G, self.rubber.lame, self.area
        bulk = np.array([1.0, 2.0, 0.0])
        rubber = A * (lame * np.outer(bulk, bulk) + np.diag([2 * G, 4 * G, 0.0]))
        rubber[2, 2] = G * A**2 / (2 * np.pi)
        return self.conductors / c * np.outer(fibre, fibre) + rubber

    def EA(self, free_twist: bool = False) -> float:
        """Axial stiffness [N], minimum over the lateral strain, and over the twist if the ends are free."""
        return _minimised(self._hessian(), free_twist)

    @property
    def stiff_radius(self) -> float:
        """S0 cos^3 beta [N]."""
        return float(self.conductors * np.cos(self.beta) ** 3)

    @property
    def soft_radius(self) -> float:
        """4 (l + m) A_r cot^4 beta [N]: the conductors are inextensible beside the rubber."""
        return float(4 * (self.rubber.lame + self.rubber.G) * self.area / np.tan(self.beta) ** 4)

    @property
    def incompressible(self) -> float:
        """(S0 / c) (c^2 - s^2 / 2)^2 [N], the rubber's own 3 m A_r not included."""
        s, c = np.sin(self.beta), np.cos(self.beta)
        return float(self.conductors / c * (c**2 - s**2 / 2) ** 2)

    @property
    def incompressible_free_twist(self) -> float:
        """m J cot^2 beta / r^2 + 3 m A_r [N]: the conductors unwind instead of stretching."""
        G, J = self.rubber.G, self.area**2 / (2 * np.pi)
        return float(G * J / (np.tan(self.beta) * self.r) ** 2 + 3 * G * self.area)


@dataclass(frozen=True)
class RubberRing:
    """Conductors smeared over a ring in a cylinder of rubber: sum of E A [N] on radius r [m] at lay angle beta [rad]; `outer_radius` R [m].

    Examples
    --------
    >>> rubber = Material("rubber", 8e6, 0.45, 1000.0)
    >>> even = RubberFilledCable(26.8e6, 16e-3, 0.2, rubber, np.pi * 16e-3**2).EA()
    >>> bool(np.isclose(RubberRing(26.8e6, 16e-3, 0.2, rubber, 16e-3).EA(), even))
    True
    """

    conductors: float
    r: float
    beta: float
    rubber: Material
    outer_radius: float

    def _hessian(self) -> np.ndarray:
        """Second derivatives of the energy by (eps, e_r, tau)."""
        G, lame, r, R = self.rubber.G, self.rubber.lame, self.r, self.outer_radius
        W = RubberFilledCable(self.conductors, r, self.beta, self.rubber, np.pi * r**2)._hessian()
        W[2, 2] += G * np.pi * (R**4 - r**4) / 2
        if R > r:
            conditions = [[1, 1 / r**2], [2 * lame + 2 * G, -2 * G / R**2]]
            B, C = np.linalg.solve(conditions, [[0.0, 1.0, 0.0], [-lame, 0.0, 0.0]])
            along, bulk = np.array([1.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0]) + 2 * B
            even = lame * np.outer(bulk, bulk) + 2 * G * np.outer(along, along) + 4 * G * np.outer(B, B)
            W += np.pi * (R**2 - r**2) * even + 4 * np.pi * G * (1 / r**2 - 1 / R**2) * np.outer(C, C)
        return W

    def EA(self, free_twist: bool = False) -> float:
        """Axial stiffness [N], minimum over the lateral strains, and over the twist if the ends are free."""
        return _minimised(self._hessian(), free_twist)


def _minimised(W: np.ndarray, free_twist: bool) -> float:
    rest = [1, 2] if free_twist else [1]
    return float(W[0, 0] - W[0, rest] @ np.linalg.solve(W[np.ix_(rest, rest)], W[rest, 0]))

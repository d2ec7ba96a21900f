"""A layer of equal members with its lay, the same layer with its lay adjusted to a period, and the period itself.

The search for a period is in period_search.py, the equation and the ways in are in common_period.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geometry.bent_lay import lay_rate
from geometry.errors import GeometryError
from geometry.helix import lay_angle


@dataclass(frozen=True)
class LayeredLay:
    """A layer of `fold` equal members at the `radius` [m] from the line they are laid on.

    Attributes
    ----------
    name : for reports
    radius : of the members' centres about the cable axis, or about the centre line of their conductor [m]
    lay : [m], None for straight members; hand "Z" or "S"
    fold : rotational symmetry, the number of members in the layer
    core_radius : radius [m] of the core helix on which the conductor lies; 0 on the cable axis
    """

    name: str
    radius: float
    lay: float | None
    hand: str
    fold: int
    core_radius: float = 0.0

    def __post_init__(self) -> None:
        lay_rate(self.lay, self.hand)
        if not (np.isfinite(self.radius) and self.radius > 0 and self.core_radius >= 0):
            raise GeometryError(f"{self.name}: the radius of a layer must be positive, found {self.radius:g} m.")
        if self.fold < 1 or int(self.fold) != self.fold:
            raise GeometryError(f"{self.name}: a layer needs a whole number of members, found {self.fold}.")

    @property
    def lay_angle(self) -> float:
        """Lay angle [rad], not signed."""
        return lay_angle(self.radius, self.lay)


@dataclass(frozen=True)
class MatchedLay:
    """A layer whose `lay` [m] has been adjusted to a period, in which it goes on by `turns` / fold of a turn.

    `nominal` is the layer as it was; `change` [rad] of its lay angle, positive where it became steeper.
    """

    nominal: LayeredLay
    turns: int
    lay: float | None
    hand: str
    change: float

    @property
    def name(self) -> str:
        """Name of the layer."""
        return self.nominal.name

    @property
    def fold(self) -> int:
        """Rotational symmetry of the layer."""
        return self.nominal.fold

    @property
    def lay_angle(self) -> float:
        """Adjusted lay angle [rad], not signed."""
        return lay_angle(self.nominal.radius, self.lay)


@dataclass(frozen=True)
class CommonPeriod:
    """The period: `height` [m], `twist_rate` [rad/m] of the motion that joins the ends of the cell, and the matched layers."""

    height: float
    twist_rate: float
    layers: tuple[MatchedLay, ...]

    @property
    def largest_change(self) -> float:
        """Largest change of a lay angle [rad], not signed; 0 without layers."""
        return max((abs(layer.change) for layer in self.layers), default=0.0)

    def layer(self, name: str, core_radius: float | None = None) -> MatchedLay:
        """The layer of that name, on that core radius [m] if several cores carry the same conductor.

        Raises
        ------
        GeometryError
            If there is none.
        """
        for layer in self.layers:
            if layer.name == name and (core_radius is None or abs(layer.nominal.core_radius - core_radius) < 1e-9):
                return layer
        raise GeometryError(
            f'the common period has no layer "{name}"; known are {", ".join(item.name for item in self.layers)}.'
        )

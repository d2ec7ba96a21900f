"""The nominal beam section that a campaign states, without a cross-section behind it.

It offers the stiffnesses of :class:`homogenize.section_stiffness.SectionStiffness` under the same names, so that a
bench model takes either. It has no area, because a stated EA was divided by none: moduli cannot be asked of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Protocol

from geometry.errors import SpecError


class BenchSection(Protocol):
    """The stiffnesses that a bench experiment can see; a SectionStiffness offers them all.

    EA_blocked_twist [N], coupling [N m], GJ, EI_x, EI_y [N m^2], GA_x, GA_y [N].
    """

    @property
    def EA_blocked_twist(self) -> float: ...
    @property
    def coupling(self) -> float: ...
    @property
    def GJ(self) -> float: ...
    @property
    def EI_x(self) -> float: ...
    @property
    def EI_y(self) -> float: ...
    @property
    def GA_x(self) -> float: ...
    @property
    def GA_y(self) -> float: ...


@dataclass(frozen=True)
class NominalSection:
    """Table [section] of campaign.toml.

    Parameters
    ----------
    stated : mapping of str to float
        What the table gives of EA, GA [N], EI, GJ [N m^2] and mass_per_length [kg/m].
    base : BenchSection, optional
        The section of the campaign's cable; it answers for what the table leaves out, and for the coupling.

    Examples
    --------
    >>> section = NominalSection({"EA": 4.0e5, "EI": 95.0})
    >>> section.EA_blocked_twist, section.EI_y, section.coupling
    (400000.0, 95.0, 0.0)
    >>> section.GJ
    Traceback (most recent call last):
    ...
    geometry.errors.SpecError: campaign.toml, [section]: GJ is needed and not given; add it, or name a cable.
    """

    stated: Mapping[str, float]
    base: BenchSection | None = None

    def completed_by(self, base: BenchSection) -> NominalSection:
        """The same section, with the cable's own value wherever the campaign states none."""
        return replace(self, base=base)

    def _value(self, key: str, of_base: str) -> float:
        if key in self.stated:
            return self.stated[key]
        if self.base is None:
            raise SpecError(f"campaign.toml, [section]: {key} is needed and not given; add it, or name a cable.")
        return float(getattr(self.base, of_base))

    @property
    def EA_blocked_twist(self) -> float:
        """EA [N]."""
        return self._value("EA", "EA_blocked_twist")

    @property
    def EA_free_twist(self) -> float:
        """EA - coupling^2 / GJ [N]."""
        return self.EA_blocked_twist - (self.coupling**2 / self.GJ if self.coupling else 0.0)

    @property
    def coupling(self) -> float:
        """Torque per unit stretch [N m]: zero unless a cable stands behind the section."""
        return self.base.coupling if self.base is not None else 0.0

    @property
    def GJ(self) -> float:
        """GJ [N m^2]."""
        return self._value("GJ", "GJ")

    @property
    def EI_x(self) -> float:
        """EI about x [N m^2]."""
        return self._value("EI", "EI_x")

    @property
    def EI_y(self) -> float:
        """EI about y [N m^2]."""
        return self._value("EI", "EI_y")

    @property
    def GA_x(self) -> float:
        """GA along x [N]."""
        return self._value("GA", "GA_x")

    @property
    def GA_y(self) -> float:
        """GA along y [N]."""
        return self._value("GA", "GA_y")

    @property
    def mass_per_length(self) -> float | None:
        """Mass per length [kg/m], None where the table gives none."""
        return self.stated.get("mass_per_length")

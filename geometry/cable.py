r"""A cable as the sum of its parts: round layers about the axis, round cores laid about it, and what fills the gaps.

Every part is a ring (inner to outer radius, in the plane normal to its own centre line) on a helix of radius
`centre_radius` and the cabling lay. Its area in the plane z = const is exactly pi (R^2 - r^2) / cos beta
(wire_trace.py), so that per length of cable

.. math::  m = \sum \varrho A, \qquad J_x = \sum \varrho \int y^2 dA, \quad J_z = J_x + J_y .
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from geometry.errors import MeshError
from geometry.helix import HANDS, lay_angle
from geometry.material import Material
from geometry.specimen_case import SpecimenCase
from geometry.strand import Conductor
from geometry.wire_trace import WireTrace

KINDS = (
    "conductor",
    "insulation",
    "screen",
    "cover",
    "interstices",
    "armour",
    "wire",
    "bedding",
    "tape",
    "wrap",
    "sheath",
)


class MarkedNumber(NamedTuple):
    """A number of the cable file with where it comes from.

    `value` (and `low`, `high`, its range, or None) in SI `unit`; `status` published, deduced, assumed or computed.
    """

    key: str
    value: float | tuple[int, ...]
    unit: str
    status: str
    source: str
    low: float | None = None
    high: float | None = None


class RotaryInertia(NamedTuple):
    """Rotary inertia per length [kg m] about x, y (bending) and z (spin), about the cable axis."""

    J_x: float
    J_y: float
    J_z: float


@dataclass(frozen=True)
class Part:
    """One named region of the cross-section.

    Attributes
    ----------
    name : unique, such as "power core 1 insulation"
    kind : one of KINDS
    member : what it belongs to, such as "power core 1"; its own name for layers about the axis
    centre_radius, phase : centre in the section z = 0 [m, rad]
    inner_radius, outer_radius : in the plane normal to its own centre line [m]; for the interstices the radii between
        which they lie
    twist_rate : 2 pi / lay [rad/m], signed
    moments : (A, Sx, Sy, Sxx, Syy, Sxy) in the plane z = 0 [m^2 .. m^4]
    conductor : name in ``Cable.conductors`` of its make-up; None for everything else
    layer : name of the layer of wires that it is one of; None for everything else
    """

    name: str
    kind: str
    member: str
    material: Material
    centre_radius: float
    phase: float
    inner_radius: float
    outer_radius: float
    twist_rate: float
    moments: tuple[float, ...]
    conductor: str | None = None
    layer: str | None = None

    @property
    def area(self) -> float:
        """Area in the plane z = const [m^2], closed form."""
        return self.moments[0]

    @property
    def lay_sign(self) -> int:
        """+1 right-handed (Z), -1 left-handed (S), 0 straight."""
        return int(np.sign(self.twist_rate)) if self.centre_radius > 0 else 0

    @property
    def lay_angle(self) -> float:
        """Angle of the part's centre line to the cable axis [rad]."""
        return float(np.arctan(abs(self.twist_rate) * self.centre_radius))

    @property
    def outer_trace(self) -> WireTrace:
        """The curve that bounds the part on the outside, in the plane z = 0."""
        return WireTrace(self.centre_radius, self.phase, self.outer_radius, self.twist_rate)

    @property
    def inner_trace(self) -> WireTrace | None:
        """The curve that bounds the part on the inside; None for a full round."""
        if self.inner_radius == 0:
            return None
        return WireTrace(self.centre_radius, self.phase, self.inner_radius, self.twist_rate)

    @property
    def mass_per_length(self) -> float:
        """Mass per length of cable [kg/m]."""
        return self.material.density * self.area


@dataclass(frozen=True)
class Cable:
    """A cable: an optional centre, cores laid about it, then rings and layers of wires.

    Attributes
    ----------
    parts : from the centre outwards, cores in their order round the axis (the first at the angle `phase` from x)
    conductors : make-up of the conductors by name
    lay : cabling lay [m], None for a straight cable; hand "Z" or "S"; without cores those of the innermost laid wires
    pitch_circle_radius : of the first core, without cores of the innermost layer of wires [m]
    laid_up_radius : outer radius of the laid-up cores, without cores of the centre [m]
    data_sheet : what a data sheet says, by the name of the attribute: outer_diameter, mass_per_length
    data_sheet_source : which sheet that is
    specimen : the finite specimen that the file stands for, if it names one
    numbers : every number of the file with its mark
    """

    name: str
    title: str
    parts: tuple[Part, ...]
    conductors: Mapping[str, Conductor]
    lay: float | None
    hand: str
    pitch_circle_radius: float
    laid_up_radius: float
    outer_radius: float
    numbers: tuple[MarkedNumber, ...]
    notes: tuple[str, ...] = ()
    data_sheet: Mapping[str, MarkedNumber] = field(default_factory=dict)
    data_sheet_source: str = ""
    specimen: SpecimenCase | None = None

    @property
    def twist_rate(self) -> float:
        """2 pi / lay [rad/m], positive for Z, negative for S, zero for a straight cable."""
        return 0.0 if self.lay is None else HANDS[self.hand] * 2 * np.pi / self.lay

    @property
    def outer_diameter(self) -> float:
        """Diameter over all parts [m]."""
        return 2 * self.outer_radius

    @property
    def area(self) -> float:
        """Area of the outer circle [m^2], the reference area of the moduli."""
        return float(np.pi * self.outer_radius**2)

    @property
    def lay_angle(self) -> float:
        """Lay angle on the pitch circle of the cores [rad]."""
        return lay_angle(self.pitch_circle_radius, self.lay)

    @property
    def lay_ratio(self) -> float | None:
        """Cabling lay over laid-up diameter; None for a straight cable."""
        return None if self.lay is None else self.lay / (2 * self.laid_up_radius)

    @property
    def mass_per_length(self) -> float:
        """Mass per length [kg/m], lays included."""
        return float(sum(part.mass_per_length for part in self.parts))

    @property
    def rotary_inertia(self) -> RotaryInertia:
        """Rotary inertia per length [kg m] of the section z = 0 about the cable axis."""
        J_y, J_x = (float(sum(part.material.density * part.moments[i] for part in self.parts)) for i in (3, 4))
        return RotaryInertia(J_x, J_y, J_x + J_y)

    @property
    def assumed(self) -> tuple[MarkedNumber, ...]:
        """The numbers that are assumptions: sweep these."""
        return tuple(number for number in self.numbers if number.status == "assumed")

    @property
    def lays(self) -> tuple[float, ...]:
        """Signed twist rates [rad/m] that differ among the parts off the axis, in their order; round layers have none."""
        return tuple(dict.fromkeys(part.twist_rate for part in self.parts if part.centre_radius > 0))

    @property
    def single_lay(self) -> bool:
        """Whether all parts off the axis turn at one rate, so that one section, turned, is the whole cable."""
        return len(self.lays) <= 1

    def check_single_lay(self) -> None:
        """Refuse what serves one lay only.

        Raises
        ------
        MeshError
            If layers have different lays; names them, and what to try.
        """
        if self.single_lay:
            return
        layers = {p.layer or "the cores": p.twist_rate for p in self.parts if p.centre_radius > 0}
        told = [f"{name} {lay_words(rate)}" for name, rate in layers.items()]
        raise MeshError(
            f"{self.name} has layers of several lays ({', '.join(told)}), so that no one section, turned, is the whole "
            "cable, and no mesh of hexahedra follows layers that cross in points: describe one layer at a time in a file of its own."
        )

    def conductor_of(self, part: Part) -> Conductor | None:
        """Make-up of the conductor that a part is; None for every other part."""
        return None if part.conductor is None else self.conductors[part.conductor]

    def part(self, name: str) -> Part:
        """The part of that name; KeyError if there is none."""
        return {part.name: part for part in self.parts}[name]


def lay_words(rate: float) -> str:
    """A twist rate [rad/m] as lay and hand, such as "234 mm Z", or "straight"."""
    return f"{2e3 * np.pi / abs(rate):.5g} mm {'Z' if rate > 0 else 'S'}" if rate else "straight"


def ring_moments(
    centre_radius: float, phase: float, inner: float, outer: float, twist_rate: float
) -> NDArray[np.float64]:
    """Area and moments of the trace of a ring, shape (6,), as WireTrace.moments."""
    moments = WireTrace(centre_radius, phase, outer, twist_rate).moments()
    return moments - WireTrace(centre_radius, phase, inner, twist_rate).moments() if inner > 0 else moments

r"""Strands and ropes of round wires: diameter, fill, density and stiffness of the equivalent cylinder.

A concentric strand of round wires d with layers n0 + n1 + n2 ... has the diameter d0 + 2 d k, where the innermost n0 wires
touch each other on a circle of radius d / (2 sin(pi / n0)) (d0 = d (1 + 1 / sin(pi / n0)), d0 = d for one wire).

* fill = (number of wires) d^2 / D^2, equivalent density = fill x density of the metal;
* lay factor = length of wire per length of strand, the mean of 1 / cos beta over the wires;
* axial stiffness of members laid at beta, ends not turning, radial contraction neglected: E A cos^3 beta each
  (Costello, Theory of Wire Rope, 2nd ed. 1997, chapter 3). So a rope of strands as one cylinder of area A has
  E = E_strand A_strand (sum over strands of cos^3 beta) / A.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geometry.errors import GeometryError
from geometry.helix import lay_angle
from geometry.material import Material


def layer_radii(layers: tuple[int, ...], diameter: float, what: str) -> tuple[float, ...]:
    """Pitch-circle radii [m] of concentric layers of round members of one `diameter` [m], from the inside.

    Raises
    ------
    GeometryError
        If a layer holds more members than its circle has room for.

    Examples
    --------
    >>> [round(r, 4) for r in layer_radii((3, 9, 15), 1.0, "strand")]
    [0.5774, 1.5774, 2.5774]
    """
    first = 0.0 if layers[0] == 1 else diameter / (2 * np.sin(np.pi / layers[0]))
    radii = tuple(float(first + k * diameter) for k in range(len(layers)))
    for count, radius in zip(layers[1:], radii[1:], strict=True):
        room = int(np.pi / np.arcsin(diameter / (2 * radius)) + 1e-9)
        if count > room:
            raise GeometryError(
                f"{what}: a layer of {count} members of {diameter * 1e3:.3g} mm does not fit on its circle of "
                f"{2e3 * radius:.4g} mm, which has room for {room}."
            )
    return radii


@dataclass(frozen=True)
class Strand:
    """Concentric strand of round wires.

    Parameters
    ----------
    name : str
    wire_diameter : float [m]
    layers : wires in each layer from the inside, such as (3, 9, 15)
    lay : float or None [m], None for straight wires
    hand : "Z" or "S"
    wire_density : float [kg/m^3]
    E, nu : modulus [Pa] and Poisson's ratio of the strand as a cylinder of its outer diameter
    stated_lay_factor : wire length per strand length where the source states it; else computed from the lay

    Examples
    --------
    >>> s = Strand("power", 0.49e-3, (3, 9, 15), 40e-3, "Z", 8900.0, 80e9, 0.34)
    >>> round(s.density)
    6344
    """

    name: str
    wire_diameter: float
    layers: tuple[int, ...]
    lay: float | None
    hand: str
    wire_density: float
    E: float
    nu: float
    stated_lay_factor: float | None = None

    @property
    def radii(self) -> tuple[float, ...]:
        """Pitch-circle radius of each layer [m]."""
        return layer_radii(self.layers, self.wire_diameter, f"strand {self.name}")

    @property
    def diameter(self) -> float:
        """Diameter over the outer layer [m]."""
        return 2 * self.radii[-1] + self.wire_diameter

    @property
    def metal_area(self) -> float:
        """Metal [m^2], normal sections of the wires added."""
        return sum(self.layers) * np.pi * self.wire_diameter**2 / 4

    @property
    def area(self) -> float:
        """Area of the cylinder of the outer diameter [m^2]."""
        return np.pi * self.diameter**2 / 4

    @property
    def fill(self) -> float:
        """Metal area over cylinder area, without lay."""
        return self.metal_area / self.area

    @property
    def density(self) -> float:
        """Equivalent density of the cylinder [kg/m^3], fill x density of the wire, without lay."""
        return self.fill * self.wire_density

    @property
    def computed_lay_factor(self) -> float:
        """Mean of 1 / cos beta over the wires."""
        return _mean_over_layers(self.layers, self.radii, self.lay, -1)

    @property
    def lay_factor(self) -> float:
        """Wire length per strand length: as stated by the source, else as computed."""
        return self.computed_lay_factor if self.stated_lay_factor is None else self.stated_lay_factor


@dataclass(frozen=True)
class Conductor:
    """Conductor of a core as one homogeneous cylinder.

    `density` counts the true mass per length of the conductor, lay included; `density_without_lay` is metal area x
    density of the metal over the cylinder. `strand` is None where the make-up is not modelled; `wires` counts its wires, 1 for a solid
    rod, 0 where they are not known. `flat_width` [m] is that of the flats on which strands touch, None where it is not stated;
    `voids` what fills the space between the strands, None where it is empty: it adds to the mass, not to `E`.
    """

    name: str
    diameter: float
    metal_area: float
    E: float
    nu: float
    density_without_lay: float
    lay_factor: float
    strand: Strand | None = None
    layers: tuple[int, ...] = ()
    lay: float | None = None
    hand: str = "Z"
    wires: int = 0
    flat_width: float | None = None
    voids: Material | None = None

    @property
    def area(self) -> float:
        """Area of the cylinder [m^2]."""
        return np.pi * self.diameter**2 / 4

    @property
    def fill(self) -> float:
        """Metal area over cylinder area, without lay."""
        return self.metal_area / self.area

    @property
    def density(self) -> float:
        """Mass per length of conductor over the cylinder area, lay included [kg/m^3]."""
        metal = self.density_without_lay * self.lay_factor
        return metal if self.voids is None else metal + self.voids.density * self.void_share

    @property
    def void_share(self) -> float:
        """Space between the strands over the cylinder area; the voids inside a strand are not counted."""
        if self.strand is None:
            return 0.0
        radii = layer_radii(self.layers, self.strand.diameter, self.name)
        return 1 - sum(self.layers) * self.strand.area * _mean_over_layers(self.layers, radii, self.lay, -1) / self.area

    @property
    def material(self) -> Material:
        """The cylinder as a material."""
        return Material(f"{self.name} conductor", E=self.E, nu=self.nu, density=self.density)

    @property
    def strand_lay_angle(self) -> float:
        """Lay angle of the outermost strands in the conductor [rad]; zero without strands."""
        if self.strand is None:
            return 0.0
        return lay_angle(layer_radii(self.layers, self.strand.diameter, self.name)[-1], self.lay)


def stranded_conductor(
    name: str,
    strand: Strand,
    layers: tuple[int, ...],
    lay: float | None,
    hand: str,
    diameter: float | None,
    flat_width: float | None = None,
    voids: Material | None = None,
) -> Conductor:
    """Conductor made of equal strands in concentric layers, as one cylinder.

    Parameters
    ----------
    layers : strands in each layer from the inside, such as (1, 6)
    lay : rope lay [m], None for straight strands
    diameter : float or None [m]; None takes the diameter over the outer strands
    flat_width, voids : as of :class:`Conductor`

    Raises
    ------
    GeometryError
        If a layer has no room, or the stated diameter is more than 3 % away from that of the strands.
    """
    radii = layer_radii(layers, strand.diameter, f"conductor {name}")
    over = 2 * radii[-1] + strand.diameter
    if diameter is None:
        diameter = over
    elif abs(diameter / over - 1) > 0.03:
        raise GeometryError(
            f"conductor {name}: the stated diameter {diameter * 1e3:.4g} mm differs by {100 * (diameter / over - 1):+.1f} % from "
            f"{over * 1e3:.4g} mm, the diameter over its {sum(layers)} strands: correct one of them, or leave the diameter out."
        )
    area = np.pi * diameter**2 / 4
    count = sum(layers)
    cubes = count * _mean_over_layers(layers, radii, lay, 3)
    return Conductor(
        name=name,
        diameter=diameter,
        metal_area=count * strand.metal_area,
        E=strand.E * strand.area * cubes / area,
        nu=strand.nu,
        density_without_lay=count * strand.metal_area * strand.wire_density / area,
        lay_factor=strand.lay_factor * _mean_over_layers(layers, radii, lay, -1),
        strand=strand,
        layers=layers,
        lay=lay,
        hand=hand,
        wires=count * sum(strand.layers),
        flat_width=flat_width,
        voids=voids,
    )


def _mean_over_layers(layers: tuple[int, ...], radii: tuple[float, ...], lay: float | None, power: int) -> float:
    """Mean over the members of cos(beta)**power."""
    cosines = np.cos([lay_angle(radius, lay) for radius in radii])
    return float(np.average(cosines**power, weights=layers))

r"""Helical layers of a cable: cores round the centre, strands in conductors, wires in strands.

n members EA at the radius r and the lay angle beta follow the bending of what they are wound on, if they stick, with the stiffness
:math:`\tfrac12 n\,EA\,r^2\cos^3\beta\;\eta`; :mod:`effects.layer_slip` derives it and the soft seat's share eta. A member in a member
takes the strain of its host, cos^2 of the host's lay angle, and bends with it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geometry import Cable, Part
from geometry.helix import lay_angle
from geometry.strand import Conductor, layer_radii
from geometry.wire_layer import wire_layers
from homogenize.stiffness_bounds import conductor_of, spring_bending, wire_modulus


@dataclass(frozen=True)
class HelicalLayer:
    """Equal members on one radius.

    Parameters
    ----------
    name : str
    count : int
        Members in the layer.
    radius, lay_angle : float
        [m], [rad] from the axis of what it is wound on.
    EA : float
        Of one member [N].
    seat : float
        Shear stiffness of what the member sits in [N/m^2]; infinite in direct contact.
    strain_share : float
        Axial strain of what it is wound on over that of the cable.
    copies : float
        How often the layer occurs in the cable, times the bending of its host over that of a straight one.
    group : str
        Layers of one group press on the ones further in.
    """

    name: str
    count: int
    radius: float
    lay_angle: float
    EA: float
    seat: float = np.inf
    strain_share: float = 1.0
    copies: float = 1.0
    group: str = ""

    @property
    def eta(self) -> float:
        """Share of the stick force that the seat hands on."""
        return float(1 / (1 + self.EA * np.sin(self.lay_angle) ** 2 / (self.seat * self.radius**2)))

    @property
    def axial_stiffness(self) -> float:
        """Of one member along what it is wound on, EA cos^3 [N]."""
        return self.EA * float(np.cos(self.lay_angle)) ** 3

    @property
    def stick_stiffness(self) -> float:
        """k [N m^2]."""
        return float(self.copies * 0.5 * self.count * self.axial_stiffness * self.radius**2 * self.eta)


def layers_of(cable: Cable) -> tuple[HelicalLayer, ...]:
    """Cores round the centre, strands in conductors, wires in strands and layers of wires, as far as the cable file knows them."""
    cores: dict[str, list[Part]] = {}
    for part in cable.parts:
        if part.kind == "conductor":
            cores.setdefault(f"{part.material.name} {part.centre_radius:.6g}", []).append(part)
    layers: list[HelicalLayer] = []
    for parts in cores.values():
        first, count = parts[0], len(parts)
        conductor = conductor_of(first, cable)
        if first.centre_radius > 0 and cable.lay is not None:
            EA = sum(p.material.E * np.pi * (p.outer_radius**2 - p.inner_radius**2) for p in _core(first, cable))
            layers.append(
                HelicalLayer(
                    f"{conductor.name} cores", count, first.centre_radius, first.lay_angle, float(EA), _seat(first, cable),
                    group="cores",
                )
            )  # fmt: skip
        layers += _inside(conductor, first.lay_angle, count)
    return (*layers, *_wires(cable))


def _wires(cable: Cable) -> list[HelicalLayer]:
    """Laid layers of armour or of single wires; they press on the cores as outer layers do."""
    found = []
    for name, wires in wire_layers(cable).items():
        first = wires[0]
        if first.lay_angle > 0:
            EA = first.material.E * np.pi * first.outer_radius**2
            found.append(HelicalLayer(name, len(wires), first.centre_radius, first.lay_angle, float(EA), group="cores"))
    return found


def _core(conductor: Part, cable: Cable) -> list[Part]:
    return [part for part in cable.parts if part.member == conductor.member]


def _seat(conductor: Part, cable: Cable) -> float:
    rings = [part for part in _core(conductor, cable) if part.kind != "conductor"]
    compliance = sum(np.log(p.outer_radius / p.inner_radius) / (2 * np.pi * p.material.G) for p in rings)
    return float(1 / compliance) if compliance > 0 else np.inf


def _inside(conductor: Conductor, beta: float, count: int) -> list[HelicalLayer]:
    """Strands in a conductor that is laid at `beta` and occurs `count` times, and wires in its strands."""
    strand = conductor.strand
    if strand is None:
        return []
    share, copies = float(np.cos(beta)) ** 2, count * spring_bending(beta, strand.nu)
    found = []
    radii = layer_radii(conductor.layers, strand.diameter, f"conductor {conductor.name}")
    wire = wire_modulus(strand) * np.pi * strand.wire_diameter**2 / 4
    for i, (strands, radius) in enumerate(zip(conductor.layers, radii, strict=True)):
        angle = lay_angle(radius, conductor.lay)
        label = f"{conductor.name} strands"
        if radius > 0 and angle > 0:
            EA = strand.E * strand.area
            found.append(
                HelicalLayer(f"{label}, layer {i + 1}", strands, radius, angle, EA, np.inf, share, copies, label)
            )
        for j, (wires, r) in enumerate(zip(strand.layers, strand.radii, strict=True)):
            gamma = lay_angle(r, strand.lay)
            if r == 0 or gamma == 0:
                continue
            inner = f"wires of {label}, layer {i + 1}"
            inside = share * float(np.cos(angle)) ** 2
            times = copies * strands * spring_bending(angle, strand.nu)
            found.append(HelicalLayer(f"{inner}, {j + 1}", wires, r, gamma, wire, np.inf, inside, times, inner))
    return found

r"""A layer of equal round wires, laid side by side about the cable axis.

n wires of diameter d on a helix of radius r and lay p clear each other by

.. math::  g = \min_\delta \sqrt{2 r^2 (1 - \cos(2\pi/n + \delta)) + (p\,\delta / 2\pi)^2} - d

(clearance.py; all neighbours are alike, so one pair stands for the layer). The layer locks where g = 0: the lay can be no shorter
and the count no larger. For thin wires this is n d = 2 pi r cos(beta).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geometry.cable import Cable, Part, ring_moments
from geometry.clearance import TOUCH, Clearance, Member, clearances, helix_distance, neighbour_gap, shortest_lay
from geometry.errors import GeometryError
from geometry.material import Material

CORE_KINDS = ("conductor", "insulation", "screen", "cover")
"""Kinds of the parts of cores and of the centre."""


@dataclass(frozen=True)
class WireLayer:
    """`count` wires of `diameter` [m] on the circle of `radius` [m]; `kind` "armour" or "wire", `twist_rate` signed [rad/m].

    `phase` is the angle of the first wire from x [rad], `filler` the material between the wires, None for empty gaps.
    """

    name: str
    kind: str
    count: int
    diameter: float
    material: Material
    radius: float
    phase: float
    twist_rate: float
    filler: Material | None = None

    @property
    def lay(self) -> float | None:
        """Lay [m], None for straight wires."""
        return 2 * np.pi / abs(self.twist_rate) if self.twist_rate else None

    @property
    def lay_angle(self) -> float:
        """Angle of the wires to the cable axis [rad]."""
        return float(np.arctan(abs(self.twist_rate) * self.radius))

    @property
    def inner_radius(self) -> float:
        """Radius of the circle that the wires touch from outside [m]."""
        return self.radius - self.diameter / 2

    @property
    def outer_radius(self) -> float:
        """Radius of the circle round all wires [m]."""
        return self.radius + self.diameter / 2

    @property
    def gap(self) -> float:
        """Gap between neighbouring wires along the lay [m], negative where they overlap."""
        return neighbour_gap(self.count, self.radius, self.diameter, self.lay)


def largest_count(radius: float, diameter: float, lay: float | None) -> int:
    """Most wires of `diameter` [m] that find room on a circle of `radius` [m] at a `lay` [m], None for straight.

    Examples
    --------
    >>> largest_count(39.467e-3, 4e-3, None), largest_count(39.467e-3, 4e-3, 0.678)
    (61, 58)
    """
    if diameter > 2 * radius:
        return 1
    count = int(np.pi / np.arcsin(diameter / (2 * radius)) + 1e-9)  # straight; a lay only takes room away
    while count > 1 and neighbour_gap(count, radius, diameter, lay) < -TOUCH:
        count -= 1
    return count


def check_layer(layer: WireLayer, below: Sequence[Part]) -> None:
    """Raise if the wires overlap each other or what is below them.

    Raises
    ------
    GeometryError
        Names the layer, the overlap, and the lay, the count or the radius that would fit.
    """
    _check_neighbours(layer)
    over = _envelope(below)
    if layer.inner_radius >= over - TOUCH:
        return
    cut = over - layer.inner_radius
    worst = max(below, key=lambda part: part.centre_radius + part.outer_radius)
    alike = [part for part in below if part.centre_radius > 0 and part.twist_rate == layer.twist_rate]
    crossing = _envelope([part for part in below if part not in alike])
    if alike and layer.inner_radius >= crossing - TOUCH:  # wires of one lay may lie in the valleys of the layer below
        worst = max(alike, key=lambda part: _overlap(layer, part))
        cut = _overlap(layer, worst)
        if cut <= TOUCH:
            return
    raise GeometryError(
        f"{layer.name}: its wires lie on a radius of {1e3 * layer.radius:.5g} mm and cut {worst.name} below them by "
        f"{1e3 * cut:.3g} mm: enlarge the radius to {1e3 * (over + layer.diameter / 2):.5g} mm, or leave it out."
    )


def layer_parts(layer: WireLayer, below: float) -> list[Part]:
    """One part for each wire, and one for the filler between them, which lies on the circle of radius `below` [m].

    Raises
    ------
    GeometryError
        If a filler is asked for where wires lie in the valleys of the layer below.
    """
    parts = []
    for i in range(layer.count):
        phase = layer.phase + 2 * np.pi * i / layer.count
        moments = ring_moments(layer.radius, phase, 0.0, layer.diameter / 2, layer.twist_rate)
        name = f"{layer.name} wire {i + 1}"
        parts.append(
            Part(
                name, layer.kind, name, layer.material, layer.radius, phase, 0.0, layer.diameter / 2, layer.twist_rate,
                tuple(moments.tolist()), layer=layer.name,
            )
        )  # fmt: skip
    if layer.filler is None:
        return parts
    if layer.inner_radius < below - TOUCH:
        raise GeometryError(
            f"{layer.name}: wires that lie in the valleys of the layer below cannot have a filler of their own: leave it out."
        )
    around = ring_moments(0.0, 0.0, below, layer.outer_radius, layer.twist_rate)
    left = around - np.sum([part.moments for part in parts], axis=0)
    name = f"{layer.name} filler"
    filler = Part(
        name, "interstices", name, layer.filler, 0.0, 0.0, below, layer.outer_radius, layer.twist_rate, tuple(left.tolist())
    )  # fmt: skip
    return [*parts, filler]


def wire_layers(cable: Cable) -> dict[str, tuple[Part, ...]]:
    """The wires of each layer of a cable, by the name of the layer, from the inside."""
    found: dict[str, list[Part]] = {}
    for part in cable.parts:
        if part.layer is not None:
            found.setdefault(part.layer, []).append(part)
    return {name: tuple(parts) for name, parts in found.items()}


def lay_of(part: Part) -> float | None:
    """Lay of a part [m], None if it is straight."""
    return 2 * np.pi / abs(part.twist_rate) if part.twist_rate else None


def neighbour_clearances(cable: Cable) -> list[Clearance]:
    """Gaps along the lay [m], smallest first: between cores and the centre that are near each other, inside each layer of wires,
    and from each layer of wires to what is below it."""
    outer = {p.member: p for p in cable.parts if p.kind in CORE_KINDS}  # the last part of a member is its outermost
    members = [Member(name, p.centre_radius, p.phase, p.outer_radius) for name, p in outer.items()]
    laid = [p for p in outer.values() if p.centre_radius > 0]
    near = 0.9 * max((p.outer_radius for p in laid), default=0.0)
    found = [c for c in clearances(members, lay_of(laid[0])) if c.gap < near] if laid else []
    for name, wires in wire_layers(cable).items():
        w, count = wires[0], len(wires)
        gap = neighbour_gap(count, w.centre_radius, 2 * w.outer_radius, lay_of(w))
        if np.isfinite(gap):
            found.append(Clearance(f"{name} wire", "the next wire" if count > 1 else "its next turn", gap))
        under = cable.parts[: cable.parts.index(w)]
        top = max(under, key=lambda p: p.centre_radius + p.outer_radius, default=None)
        gap = w.centre_radius - w.outer_radius - _envelope(under)
        if top is not None and gap >= -TOUCH:  # wires in the valleys of a layer of their own lay are checked at reading
            found.append(Clearance(f"{name} wire", top.layer or top.name, gap))
    return sorted(found, key=lambda c: c.gap)


def _check_neighbours(layer: WireLayer) -> None:
    if layer.diameter / 2 > layer.radius:
        raise GeometryError(
            f"{layer.name}: wires of {1e3 * layer.diameter:.4g} mm on a radius of {1e3 * layer.radius:.4g} mm reach over "
            "the axis: enlarge the radius."
        )
    gap = layer.gap
    if gap >= -TOUCH:
        return
    wires = f"its {layer.count} wires" if layer.count > 1 else "its 1 wire"
    at = f"on {'their' if layer.count > 1 else 'its'} circle of radius {1e3 * layer.radius:.5g} mm"
    advice = []
    fitting = shortest_lay(layer.count, layer.radius, layer.diameter, layer.lay)
    if fitting is not None and layer.lay is not None:
        at += f" at a lay of {1e3 * layer.lay:.5g} mm ({np.degrees(layer.lay_angle):.1f} deg)"
        advice.append(f"lengthen the lay to at least {1e3 * np.ceil(1e4 * fitting) / 1e4:.1f} mm")
    elif layer.lay is not None:
        at += ", at any lay"
    if layer.count > 1:
        room = largest_count(layer.radius, layer.diameter, layer.lay)
        advice.append(f"take at most {room} wire{'s' if room > 1 else ''}")
    overlap = "overlap" if layer.count > 1 else "overlaps itself"
    raise GeometryError(
        f"{layer.name}: {wires} of {1e3 * layer.diameter:.4g} mm {overlap} by {-1e3 * gap:.3g} mm {at}: {', or '.join(advice)}."
    )


def _envelope(parts: Sequence[Part]) -> float:
    """Radius of the circle about the axis that holds all parts [m]."""
    return max((part.centre_radius + part.outer_radius for part in parts), default=0.0)


def _overlap(layer: WireLayer, part: Part) -> float:
    """By how much the nearest wire of the layer cuts a part of the same lay [m]."""
    step = 2 * np.pi / layer.count
    angle = (part.phase - layer.phase + step / 2) % step - step / 2
    distance = helix_distance(layer.radius, part.centre_radius, float(angle), layer.lay)
    return layer.diameter / 2 + part.outer_radius - distance

"""Laying up: where the cores go, and the parts that result.

The cores stand at equal angles and rest on the centre member; without one they move inwards until they touch each other.
The laid-up circle encloses them; rings and layers of wires (wire_layer.py) follow. The fit of the cores is checked here.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from geometry.cable import Part, ring_moments
from geometry.clearance import Member, check_clearance, touching_radius
from geometry.errors import GeometryError, SpecError
from geometry.material import Material


@dataclass(frozen=True)
class Layer:
    """One ring of a round member: its kind, material, outer radius [m], and the name of its conductor if it is one."""

    kind: str
    material: Material
    outer_radius: float
    conductor: str | None = None


@dataclass(frozen=True)
class Round:
    """Round member: `name` and its layers from the inside; a `bare` one is a single part of that name."""

    name: str
    layers: tuple[Layer, ...]
    bare: bool = False

    @property
    def radius(self) -> float:
        """Outer radius [m]."""
        return self.layers[-1].outer_radius


@dataclass(frozen=True)
class LayUp:
    """The laid-up parts (without what is round them), pitch-circle radius of the first core and laid-up radius [m]."""

    parts: tuple[Part, ...]
    pitch_circle_radius: float
    laid_up_radius: float


def lay_up(
    centre: Round | None,
    cores: Sequence[Round],
    lay: float | None,
    twist_rate: float,
    phase: float,
    filler: Material | None,
    pitch_circle_radius: float | None = None,
) -> LayUp:
    """Lay `cores` round `centre`.

    Parameters
    ----------
    lay, twist_rate : cabling lay [m] (None for straight) and its signed rate 2 pi / lay [rad/m]
    phase : angle of the first core from x [rad]
    filler : material of the interstices, None to leave them empty
    pitch_circle_radius : radius of all core centres [m]; None lets the cores rest on the centre or on each other

    Raises
    ------
    GeometryError
        If parts overlap; the message names them, the overlap and what would fit.
    """
    if not cores and centre is None:
        raise SpecError("a cable needs at least one core or a centre.")
    if centre is None and len(cores) == 1 and pitch_circle_radius is None:
        centre, cores = cores[0], ()
    cores = _numbered(cores)
    inner = 0.0 if centre is None else centre.radius
    angles = [phase + 2 * np.pi * i / len(cores) for i in range(len(cores))]

    def place(inner_radius: float) -> list[Member]:
        radii = [pitch_circle_radius or inner_radius + core.radius for core in cores]
        return [Member(c.name, r, a, c.radius) for c, r, a in zip(cores, radii, angles, strict=True)]

    def with_centre(grow: float) -> list[Member]:
        return ([Member(centre.name, 0.0, 0.0, inner + grow / 2)] if centre else []) + place(inner + grow / 2)

    if centre is None and pitch_circle_radius is None:
        inner = touching_radius(place, lay, 10 * sum(core.radius for core in cores))
    check_clearance(with_centre(0.0), lay, with_centre if centre and pitch_circle_radius is None else None)
    members = place(inner)
    laid_up = max([inner if centre else 0.0] + [m.centre_radius + m.radius for m in members])
    parts = _ring_parts(centre, 0.0, 0.0, twist_rate) if centre else []
    for core, member in zip(cores, members, strict=True):
        parts += _ring_parts(core, member.centre_radius, member.phase, twist_rate)
    if cores and filler is not None:
        parts.append(_interstices(parts, centre.radius if centre else 0.0, laid_up, filler, twist_rate))
    return LayUp(tuple(parts), members[0].centre_radius if members else 0.0, laid_up)


def ring_part(kind: str, name: str, material: Material, radius: float, wall: float, rate: float) -> Part:
    """Ring about the axis, `radius` to `radius + wall` [m]; `rate` is that of the cable, which a ring does not show."""
    moments = tuple(ring_moments(0.0, 0.0, radius, radius + wall, rate).tolist())
    return Part(kind=kind, name=name, member=name, material=material, centre_radius=0.0, phase=0.0, inner_radius=radius,
                outer_radius=radius + wall, twist_rate=rate, moments=moments)  # fmt: skip


def check_names(parts: Sequence[Part]) -> None:
    """Raise a SpecError if two parts have one name."""
    repeated = [name for name, count in Counter(p.name for p in parts).items() if count > 1]
    if repeated:
        raise SpecError(
            f'two parts of the cable are named "{repeated[0]}": rename the core, the conductor or the layer.'
        )


def _numbered(cores: Sequence[Round]) -> list[Round]:
    """Cores named "power core 1", "power core 2"; a single one of its kind is not numbered."""
    total, seen = Counter(core.name for core in cores), Counter()
    named = []
    for core in cores:
        seen[core.name] += 1
        named.append(replace(core, name=f"{core.name} {seen[core.name]}") if total[core.name] > 1 else core)
    return named


def _ring_parts(member: Round, centre_radius: float, phase: float, twist_rate: float) -> list[Part]:
    parts, inner = [], 0.0
    for layer in member.layers:
        if layer.outer_radius <= inner:
            raise GeometryError(
                f"{member.name} {layer.kind}: its outer radius must be larger than {inner * 1e3:.4g} mm."
            )
        moments = tuple(ring_moments(centre_radius, phase, inner, layer.outer_radius, twist_rate).tolist())
        name = member.name if member.bare else f"{member.name} {layer.kind}"
        parts.append(
            Part(
                name,
                layer.kind,
                member.name,
                layer.material,
                centre_radius,
                phase,
                inner,
                layer.outer_radius,
                twist_rate,
                moments,
                layer.conductor,
            )
        )
        inner = layer.outer_radius
    return parts


def _interstices(parts: Sequence[Part], inner: float, outer: float, filler: Material, rate: float) -> Part:
    circle = ring_moments(0.0, 0.0, 0.0, outer, rate)
    moments = tuple((circle - np.sum([part.moments for part in parts], axis=0)).tolist())
    return Part("interstices", "interstices", "interstices", filler, 0.0, 0.0, inner, outer, rate, moments)

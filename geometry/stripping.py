"""Where each layer of a cut-open cable ends: stripped back one after the other, each further than the one below it.

From the outside: rings and layers of wires about the axis, what fills the gaps between the cores, then the layers of the
cores, the conductors last. The length that a step shows is weighted by its kind.
"""

from __future__ import annotations

from dataclasses import dataclass

from geometry.cable import Cable, Part

WEIGHTS = {
    "sheath": 1.5,
    "wrap": 0.6,
    "tape": 0.6,
    "bedding": 0.7,
    "interstices": 0.75,
    "cover": 0.3,
    "insulation": 0.9,
}
"""Relative length that a step shows; 1 for other kinds. The outermost step shows half as much again."""
HIDDEN = 0.04
"""Share of the length that wires and conductors run on under their cover, so that nothing ends in sight."""
CORE_KINDS = ("conductor", "insulation", "screen", "cover")


@dataclass(frozen=True)
class Step:
    """Parts that end at the same place: `title`, and `begin`, `end` of what is seen, as shares of the length."""

    title: str
    parts: tuple[Part, ...]
    begin: float
    end: float


def stripped_steps(cable: Cable) -> tuple[Step, ...]:
    """The steps of a cut-open cable from the outermost layer to the conductors."""
    groups = [*_about_axis(cable), *_in_cores(cable)]
    weights = [WEIGHTS.get(parts[0].kind, 1.0) for _, parts in groups]
    weights[0] *= 1.5
    steps, begin = [], 0.0
    for (title, parts), weight in zip(groups, weights, strict=True):
        end = begin + weight / sum(weights)
        steps.append(Step(title, tuple(parts), begin, min(end, 1.0)))
        begin = end
    return tuple(steps)


def drawn_from(part: Part, steps: tuple[Step, ...]) -> float:
    """Where a part comes out from under what covers it, as a share of the length, a little earlier for round wires."""
    ends = [step.end for step in steps for p in step.parts if _covers(p, part)]
    loose = part.kind in ("conductor", "wire", "armour")
    return max([0.0, *(end - (HIDDEN if loose else 0.001) for end in ends)])


def laid_in_core(part: Part) -> bool:
    """Whether a part belongs to a core or to the centre; else it is a layer about the axis."""
    return part.layer is None and (part.centre_radius > 0 or part.kind in CORE_KINDS)


def bare(part: Part) -> bool:
    """Whether a part is a laid core without any layer of its own, such as the wire of a strand."""
    return laid_in_core(part) and part.centre_radius > 0 and part.member == part.name


def _about_axis(cable: Cable) -> list[tuple[str, list[Part]]]:
    """Rings, layers of wires and fillers, the outermost first; the filler of a layer of wires ends with its wires."""
    layers: dict[str, list[Part]] = {}
    for part in cable.parts:
        if not laid_in_core(part):
            owner = part.name.removesuffix(" filler") if part.kind == "interstices" else None
            layers.setdefault(part.layer or (owner if owner in layers else part.name), []).append(part)
    return sorted(layers.items(), key=lambda item: -max(p.centre_radius + p.outer_radius for p in item[1]))


def _in_cores(cable: Cable) -> list[tuple[str, list[Part]]]:
    """Kinds of the layers of the cores, the outermost first; the cover of the centre ends with the outermost."""
    depth: dict[str, int] = {}
    members: dict[str, list[Part]] = {}
    for part in (p for p in cable.parts if laid_in_core(p)):
        layers = members.setdefault(part.member, [])
        layers.append(part)
        if part.kind != "cover":
            depth[part.kind] = max(depth.get(part.kind, 0), len(layers) - 1)
    kinds = sorted(depth, key=lambda kind: -depth[kind])
    groups = [(kind, [p for layers in members.values() for p in layers if p.kind == kind]) for kind in kinds]
    if any(bare(p) for _, parts in groups for p in parts):  # the centre is the last step of its own
        centre = [(kind, [p for p in parts if p.centre_radius == 0]) for kind, parts in groups]
        groups = [(kind, [p for p in parts if p.centre_radius > 0]) for kind, parts in groups]
        groups = [group for group in [*groups, *centre] if group[1]]
    covers = [p for layers in members.values() for p in layers if p.kind == "cover"]
    if covers and len(groups) > 1:
        groups[0][1].extend(covers)
    elif covers:
        groups.insert(0, ("cover", covers))
    return groups


def _covers(outer: Part, inner: Part) -> bool:
    """Whether a part hides another one that lies under it."""
    if bare(outer) and inner.centre_radius == 0:
        return True
    if outer.member == inner.member and laid_in_core(outer):
        return outer.outer_radius > inner.outer_radius
    if laid_in_core(outer) or (outer.layer is not None and outer.layer == inner.layer):
        return False
    if outer is inner:
        return False
    if outer.kind == "interstices" and laid_in_core(inner):
        return True
    inside = outer.centre_radius if outer.centre_radius > 0 else outer.inner_radius * (1 + 1e-9)
    return inside >= inner.centre_radius + inner.outer_radius

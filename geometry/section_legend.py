"""The words beside the drawing of a cross-section: one block for each kind of member, with the point it speaks of.

Cores that are alike, and the wires of one layer, share a block.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.cable import Cable, Part
from geometry.colour_scheme import KIND_TITLES, STEEL, part_colour
from geometry.stripping import laid_in_core

DEGREE = np.pi / 180


@dataclass(frozen=True)
class LegendRow:
    """A part: `name`, `size` in words, `colour`."""

    name: str
    size: str
    colour: str


@dataclass(frozen=True)
class Block:
    """Words on one kind of member: `title` (empty for a single part), rows, `note`, and `anchor` (2,) [m] in the section."""

    title: str
    rows: tuple[LegendRow, ...]
    anchor: NDArray[np.float64]
    note: str = ""

    @property
    def lines(self) -> int:
        """Number of lines of text."""
        return len(self.rows) + bool(self.title) + bool(self.note)


def legend_blocks(cable: Cable) -> list[Block]:
    """All blocks: cores and centre, then the layers about the axis from the outside."""
    cores = list(_core_blocks(cable))
    lines = [sum(b.lines + 2 for b in cores if (b.anchor[0] > 0) == side) for side in (False, True)]
    return [*cores, *_layer_blocks(cable, lines)]


def lay_words(cable: Cable) -> str:
    """The lays of a cable in words."""
    if cable.single_lay:
        return "straight" if cable.lay is None else f"lay {1e3 * cable.lay:.4g} mm ({cable.hand})"
    lays = [f"{2e3 * np.pi / abs(rate):.4g} {'Z' if rate > 0 else 'S'}" for rate in cable.lays if rate]
    return f"lays {', '.join(lays)} mm"


def _core_blocks(cable: Cable) -> Iterator[Block]:
    members: dict[str, list[Part]] = {}
    for part in cable.parts:
        if laid_in_core(part):
            members.setdefault(part.member, []).append(part)
    alike: dict[tuple[object, ...], list[str]] = {}
    for name, layers in members.items():
        sizes = tuple((p.kind, p.inner_radius, p.outer_radius, p.material.name) for p in layers)
        alike.setdefault((_base(name), round(layers[0].centre_radius, 9), sizes), []).append(name)
    for names in alike.values():
        layers = members[names[0]]
        title = names[0] if len(names) == 1 else f"{_base(names[0])} 1\u2013{len(names)}"
        rows = [
            LegendRow(KIND_TITLES[p.kind].removeprefix("conductor "), _size(p), _colour(p)) for p in reversed(layers)
        ]
        note = _make_up(cable, layers[0])
        yield Block(title, tuple(rows), _core_anchor(layers[-1]), note)


def _layer_blocks(cable: Cable, lines: list[int]) -> Iterator[Block]:
    """Rings and layers of wires, the outermost first, on the side (left, right) that has fewer `lines` so far."""
    layers: dict[str, list[Part]] = {}
    for part in cable.parts:
        if not laid_in_core(part):
            layers.setdefault(part.layer or part.name, []).append(part)
    order = sorted(layers.items(), key=lambda item: -max(p.centre_radius + p.outer_radius for p in item[1]))
    for k, (name, parts) in enumerate(order):
        right = lines[1] <= lines[0]
        lines[right] += 5 if parts[0].layer is not None else 3
        tilt = (20.0 + 50.0 * k / len(order)) * DEGREE
        angle = -tilt if right else np.pi + tilt
        first = parts[0]
        if first.layer is not None:
            yield _wire_block(name, parts, angle)
            continue
        if first.kind == "interstices":
            anchor = _gap_point(cable, first, angle)
        else:
            anchor = 0.5 * (first.inner_radius + first.outer_radius) * np.array([np.cos(angle), np.sin(angle)])
        title = "interstices" if name == "interstices" else name
        yield Block("", (LegendRow(title, _size(first), _colour(first)),), anchor)


def _wire_block(name: str, parts: list[Part], angle: float) -> Block:
    first = parts[0]
    near = min(parts, key=lambda p: abs((p.phase - angle + np.pi) % (2 * np.pi) - np.pi))
    anchor = near.centre_radius * np.array([np.cos(near.phase), np.sin(near.phase)])
    size = f"{len(parts)} \u00d7 \u2300 {2e3 * first.outer_radius:.2f} mm"
    note = _lay(first)
    return Block(name, (LegendRow(KIND_TITLES[first.kind], size, _colour(first)),), anchor, note)


def _make_up(cable: Cable, part: Part) -> str:
    """Strands and wires of a conductor in words; empty if they are not known. Bare laid wires tell their lay."""
    conductor = cable.conductor_of(part)
    if conductor is not None and conductor.strand is not None and conductor.layers:
        strand = conductor.strand
        return f"{sum(conductor.layers)} strands of {sum(strand.layers)} wires of {1e3 * strand.wire_diameter:.3g} mm"
    return _lay(part) if part.centre_radius > 0 and part.member == part.name else ""


def _lay(part: Part) -> str:
    if not part.twist_rate:
        return "straight"
    pitch, hand = 2e3 * np.pi / abs(part.twist_rate), "Z" if part.twist_rate > 0 else "S"
    return f"lay {pitch:.4g} mm {hand}, {part.lay_angle / DEGREE:.1f}\u00b0"


def _size(part: Part) -> str:
    wall = 1e3 * (part.outer_radius - part.inner_radius)
    if part.kind == "interstices":
        return f"{1e6 * part.area:.0f} mm\u00b2"
    diameter = f"\u2300 {2e3 * part.outer_radius:.2f} mm"
    return diameter if part.inner_radius == 0 else f"{diameter}, wall {wall:.2f}"


def _core_anchor(part: Part) -> NDArray[np.float64]:
    """A point of the outermost layer of a core where its leader line starts."""
    middle = 0.0 if part.inner_radius == 0 else 0.5 * (part.inner_radius + part.outer_radius)
    direction = np.array([np.cos(part.phase), np.sin(part.phase)])
    if part.centre_radius == 0:
        return max(middle, 0.6 * part.outer_radius) * np.array([np.cos(2.6), np.sin(2.6)])
    sideways = np.array([1.0 if direction[0] > -0.5 else -1.0, 0.25])
    return part.centre_radius * direction + middle * sideways / np.linalg.norm(sideways)


def _gap_point(cable: Cable, filler: Part, angle: float) -> NDArray[np.float64]:
    """The widest place of a filler near an angle."""
    turn, radius = np.meshgrid(
        angle + np.linspace(-0.7, 0.7, 61), np.linspace(filler.inner_radius, filler.outer_radius, 60)[1:-1]
    )
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=-1).reshape(-1, 2)
    room = np.minimum(radius - filler.inner_radius, filler.outer_radius - radius).ravel()
    for p in (p for p in cable.parts if p.centre_radius > 0):
        centre = p.centre_radius * np.array([np.cos(p.phase), np.sin(p.phase)])
        room = np.minimum(room, np.linalg.norm(points - centre, axis=1) - p.outer_radius)
    return points[int(np.argmax(room))]


def _colour(part: Part) -> str:
    return part_colour(part.kind, part.material.density, part.material.E)


def _row_name(part: Part) -> str:
    """Kind of a layer of a core; a conductor of steel is no conductor."""
    return "steel" if _colour(part) == STEEL else KIND_TITLES[part.kind].removeprefix("conductor ")


def _base(name: str) -> str:
    return name.rstrip("0123456789 ") or name

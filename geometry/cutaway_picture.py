"""The cable in space, cut open as in a maker's drawing: every layer ends before the one below it, the conductors last.

Bare conductors show their strands and wires on their double and triple helices. Rendered off-screen (rendered_scene.py).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geometry.cable import Cable, Part
from geometry.colour_scheme import KIND_TITLES, part_colour
from geometry.errors import GeometryError
from geometry.helix import Helix
from geometry.laid_member import STRAIGHT, part_helix, stranded, strands
from geometry.nested_helix import CentreLine, wound_on
from geometry.rendered_scene import Label, Surface, View, rendered, write_picture
from geometry.section_legend import lay_words
from geometry.strand import Conductor
from geometry.stripping import Step, bare, drawn_from, laid_in_core, stripped_steps
from geometry.swept_surface import SIDES, swept_surface, wire_surfaces

GLOSS = {
    "conductor": (0.7, 25),
    "armour": (0.6, 22),
    "wire": (0.6, 22),
    "wrap": (0.35, 15),
    "screen": (0.45, 20),
    "sheath": (0.25, 12),
}
MOST_WIRES = 4000
"""Above this number conductors show their strands, not their wires."""


def draw_cutaway(
    cable: Cable, path: str | Path, length: float | None = None, wires: bool = True, size: tuple[int, int] = (1800, 900)
) -> Path:
    """Render the cable with its layers stripped back step by step.

    Parameters
    ----------
    path : picture to write (png)
    length : length shown [m]; None takes 3.5 to 6 outer diameters, more for more layers
    wires : draw the wires inside the strands where conductors are bare; else round strands
    size : pixels

    Raises
    ------
    GeometryError
        If nothing can be rendered here, or the file cannot be written.
    """
    steps = stripped_steps(cable)
    length = shown_length(cable, steps) if length is None else float(length)
    if not (np.isfinite(length) and length > 0):
        raise GeometryError(f"the length shown must be positive, found {length:g} m.")
    view = View(cable.outer_radius, length, size)
    image = rendered(list(cutaway_surfaces(cable, length, wires)), view)
    labels = [_label(step, length, view) for step in steps]
    return write_picture(image, view, cable.title, _facts(cable, length), labels, path)


def shown_length(cable: Cable, steps: tuple[Step, ...]) -> float:
    """Length [m] that shows every step: 3.5 to 6 outer diameters; at least 1.2 lays of a lone helix."""
    D = cable.outer_diameter
    if len(steps) == 1 and cable.lay is not None:
        return max(4.2 * D, min(1.2 * cable.lay, 10 * D))
    return float(np.clip(0.7 * len(steps), 3.5, 6.0)) * D


def cutaway_surfaces(cable: Cable, length: float, wires: bool = True) -> Iterator[Surface]:
    """All surfaces of the cut-open cable of a length [m]; what is covered is left out."""
    steps = stripped_steps(cable)
    for step in steps:
        laid = [p for p in step.parts if p.layer is not None]
        if laid:
            yield from _round_wires(laid, length * drawn_from(laid[0], steps), length * step.end)
        for part in (p for p in step.parts if p.layer is None):
            yield from _part_surfaces(
                cable, part, length * drawn_from(part, steps), length * step.end, bool(laid), wires
            )


def _part_surfaces(
    cable: Cable, part: Part, begin: float, end: float, among_wires: bool, wires: bool
) -> Iterator[Surface]:
    conductor = stranded(cable, part)
    if conductor is not None and conductor.strand is not None:
        count = sum(conductor.layers) * sum(conductor.strand.layers)
        alike = sum(p.conductor == part.conductor for p in cable.parts)
        yield from _strand_surfaces(cable, part, conductor, begin, end, wires and count * alike <= MOST_WIRES)
        return
    if part.kind == "interstices" and among_wires:  # wires lie half in it
        part = replace(part, outer_radius=0.5 * (part.inner_radius + part.outer_radius))
    if part.centre_radius > 0 and part.inner_radius == 0:
        yield from _round_wires([part], begin, end)
        return
    colour, gloss = _colour(part), GLOSS.get(part.kind, (0.15, 8))
    points, quads = swept_surface(part.outer_trace, begin, end)
    yield Surface(points, quads, colour, gloss=gloss)
    yield _cap(part, end, colour)


def _colour(part: Part) -> str:
    return part_colour(part.kind, part.material.density, part.material.E)


def _cap(part: Part, z: float, colour: str) -> Surface:
    """Flat end of a part. What lies between the cores ends as a full disc, through which the cores come."""
    turn = part.twist_rate * z
    phi = np.linspace(0, 2 * np.pi, SIDES, endpoint=False)
    outer = part.outer_trace.point(phi)
    full = part.inner_trace is None or (part.kind == "interstices" and part.member == "interstices")
    inner = np.zeros_like(outer) if full or part.inner_trace is None else part.inner_trace.point(phi)
    if full and part.centre_radius > 0:
        inner = np.broadcast_to(part.centre_radius * np.array([np.cos(part.phase), np.sin(part.phase)]), outer.shape)
    both = np.vstack([outer, inner])
    c, s = np.cos(turn), np.sin(turn)
    points = np.column_stack([c * both[:, 0] - s * both[:, 1], s * both[:, 0] + c * both[:, 1], np.full(len(both), z)])
    k = np.arange(SIDES)
    following = (k + 1) % SIDES
    return Surface(points, np.stack([k, following, following + SIDES, k + SIDES], axis=-1), colour, smooth=False)


def _round_wires(parts: list[Part], begin: float, end: float) -> Iterator[Surface]:
    """Full rounds of one lay, such as a layer of wires, with ends normal to their centre lines."""
    helices = [part_helix(part) for part in parts]
    turns = (end - begin) / helices[0].pitch
    z = np.linspace(begin, end, max(2, int(np.ceil(72 * turns)) + 1))
    lines = [_helix_line(helix, z) for helix in helices]
    sides = 72 if len(parts) < 10 else 24 if len(parts) < 200 else 12
    yield from _tubes(lines, parts[0].outer_radius, _colour(parts[0]), GLOSS.get(parts[0].kind, (0.5, 20)), sides)


def _helix_line(helix: Helix, z: NDArray[np.float64]) -> CentreLine:
    return CentreLine(z, helix.position(z), helix.frenet_frame(z), z / np.cos(helix.lay_angle))


def _strand_surfaces(
    cable: Cable, part: Part, conductor: Conductor, begin: float, end: float, wires: bool
) -> Iterator[Surface]:
    """Bare strands of a conductor, or their wires: helix on a helix on a helix."""
    strand = conductor.strand
    assert strand is not None
    finest = min(strand.lay or end if wires else end, conductor.lay or end, 4 * (end - begin))
    z = np.linspace(begin, end, max(24, int(72 * (end - begin) / finest)))
    axes = [member.centre_line(z) for member in strands(part, conductor)]
    if not wires:
        yield from _tubes(axes, strand.diameter / 2, _colour(part), GLOSS["conductor"], 20)
        return
    lines = []
    for axis in axes:
        for n, radius in zip(strand.layers, strand.radii, strict=True):
            wound = [Helix(radius, strand.lay or STRAIGHT, strand.hand, 2 * np.pi * j / n) for j in range(n)]
            lines += [wound_on(axis, wire, transport=False) for wire in wound]
    yield from _tubes(lines, strand.wire_diameter / 2, _colour(part), GLOSS["conductor"], 8)


def _tubes(
    lines: list[CentreLine], radius: float, colour: str, gloss: tuple[float, float], sides: int
) -> Iterator[Surface]:
    points, normals, quads = wire_surfaces(lines, radius, sides)
    yield Surface(points, quads, colour, normals, gloss=gloss)
    rims = points.reshape(len(lines), -1, sides, 3)[:, -1].reshape(-1, 3)
    fans = np.arange(len(rims)).reshape(len(lines), sides)
    yield Surface(rims, fans, colour, smooth=False, gloss=(0.2, 8))


def _label(step: Step, length: float, view: View) -> Label:
    """Name of a step at a visible point of it, the one nearest the eye."""
    z = 0.5 * (step.begin + step.end) * length
    eye = view.axes[2]
    outward = np.array([eye[0], eye[1], 0.0]) / np.hypot(eye[0], eye[1])
    parts = [p for p in step.parts if p.kind == step.parts[0].kind]
    spots = []
    for part in parts:
        turn = part.phase + part.twist_rate * z
        centre = np.array([part.centre_radius * np.cos(turn), part.centre_radius * np.sin(turn), z])
        spots.append(centre + part.outer_radius * outward)
    return Label(_title(step), max(spots, key=lambda spot: float(spot @ eye)))


def _title(step: Step) -> str:
    """Name of a step; layers of wires with their number, size and hand."""
    first = step.parts[0]
    hand = {1: "Z", -1: "S", 0: "straight"}[first.lay_sign]
    size = f"\u2300 {2e3 * first.outer_radius:.2f} mm"
    if bare(first):
        return f"{first.name.rstrip('0123456789 ')}\n{len(step.parts)} \u00d7 {size}, {hand}"
    if laid_in_core(first):
        lone = first.centre_radius == 0 and len(step.parts) == 1 and first.kind == "conductor"
        return f"{first.member}\n{size}" if lone else KIND_TITLES.get(first.kind, first.kind)
    wires = [p for p in step.parts if p.layer is not None]
    return f"{step.title}\n{len(wires)} \u00d7 {size}, {hand}" if wires else KIND_TITLES.get(step.title, step.title)


def _facts(cable: Cable, length: float) -> str:
    facts = [f"\u2300 {1e3 * cable.outer_diameter:.1f} mm", lay_words(cable), f"{cable.mass_per_length:.3g} kg/m"]
    return " \u00b7 ".join([*facts, f"length shown {1e3 * length:.0f} mm"])

"""The drawing of the cross-section z = 0: every part named and dimensioned, strands and wires where they are cut.

matplotlib is loaded inside the functions only.
"""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import Any

import numpy as np

from geometry.cable import Cable
from geometry.colour_scheme import INK, SOFT, VOID, kind_colour, part_colour
from geometry.errors import GeometryError
from geometry.pipe_trace import Trace, section_traces
from geometry.section_legend import Block, lay_words, legend_blocks

ROW = 0.085
"""Height of a line of text, as a share of the outer radius."""
SMALLEST_WIRE = 1 / 220
"""Wires thinner than this share of the outer diameter are not drawn one by one."""
DARK = {"conductor": "#7a4118", "wire": "#4b5258", "armour": "#4b5258"}


def draw_cross_section(cable: Cable, path: str | Path, dpi: int = 200) -> Path:
    """Draw the section z = 0 with every part coloured, named and dimensioned.

    Parameters
    ----------
    path : file to write; the ending chooses the format (png, svg, pdf)

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    GeometryError
        If the file cannot be written.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 6.9), facecolor="white")
    axes = figure.add_axes((0.0, 0.05, 1.0, 0.83))
    R = 1e3 * cable.outer_radius
    axes.set(xlim=(-2.82 * R, 2.82 * R), ylim=(-1.32 * R, 1.08 * R), aspect="equal")
    axes.axis("off")
    _fillers(axes, cable)
    colours = {p.name: part_colour(p.kind, p.material.density, p.material.E) for p in cable.parts}
    traces = section_traces(cable, _depth(cable))
    stranded = {name for trace in traces if trace.level == "strand" for name in colours if trace.name.startswith(name)}
    for trace in traces:
        _draw(axes, trace, colours.get(trace.name, kind_colour(trace.kind)), trace.name in stranded)
    if all(part.centre_radius > 0 for part in cable.parts):
        _axis(axes, R)
    _legend(axes, legend_blocks(cable), R)
    _dimension(axes, R)
    _headline(figure, cable, traces)
    return saved(figure, path, dpi)


def _depth(cable: Cable) -> str:
    """How deep conductors are taken apart in a drawing of this size."""
    wires = [c.strand.wire_diameter for c in cable.conductors.values() if c.strand is not None]
    return "wire" if wires and min(wires) > SMALLEST_WIRE * cable.outer_diameter else "strand"


def _fillers(axes: Any, cable: Cable) -> None:
    """What lies between cores or wires, the outermost first; everything else is drawn on it."""
    from matplotlib.patches import Circle

    for part in sorted((p for p in cable.parts if p.kind == "interstices"), key=lambda p: -p.outer_radius):
        axes.add_patch(Circle((0, 0), 1e3 * part.outer_radius, facecolor=kind_colour(part.kind), linewidth=0))
        if part.inner_radius > 0:
            axes.add_patch(Circle((0, 0), 1e3 * part.inner_radius, facecolor="white", linewidth=0))


def _draw(axes: Any, trace: Trace, colour: str, stranded: bool) -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Curve

    loops = [np.vstack([loop, loop[:1]]) for loop in (trace.points, trace.hole) if loop is not None]
    outline = Curve.make_compound_path(*(Curve(1e3 * loop, closed=True) for loop in loops))
    face = VOID if stranded or trace.level == "strand" else colour
    edge, width = {"part": (INK, 0.6), "strand": (DARK["conductor"], 0.5), "wire": (DARK["conductor"], 0.2)}[
        trace.level
    ]
    if trace.level == "strand":
        face = colour
    if trace.level == "part" and trace.kind in ("wire", "armour"):
        edge, width = DARK[trace.kind], 0.5
    axes.add_artist(PathPatch(outline, facecolor=face, edgecolor=edge, linewidth=width))


def _axis(axes: Any, R: float) -> None:
    """Axis and outer circle of a cable that has nothing about its axis."""
    from matplotlib.patches import Circle

    axes.add_patch(Circle((0, 0), R, facecolor="none", edgecolor=SOFT, linewidth=0.6, linestyle=(0, (6, 4))))
    for x, y in (((-0.08 * R, 0.08 * R), (0, 0)), ((0, 0), (-0.08 * R, 0.08 * R))):
        axes.plot(x, y, color=SOFT, linewidth=0.6)


def _legend(axes: Any, blocks: list[Block], R: float) -> None:
    """One block of text for every kind of member, with a leader line, in a column left and right."""
    right = sorted((b for b in blocks if b.anchor[0] > 1e-9), key=lambda b: -b.anchor[1])
    left = sorted((b for b in blocks if b.anchor[0] <= 1e-9), key=lambda b: -b.anchor[1])
    for side, column in ((1, right), (-1, left)):
        free = min((2.1 - sum(b.lines for b in column) * ROW) / max(len(column), 1), 0.35)
        total = sum(b.lines * ROW + max(free, 0.02) for b in column)
        y = min(1.0, 0.5 * total) * R - 0.5 * ROW * R
        for block in column:
            _block(axes, block, side, y, R)
            y -= (block.lines * ROW + max(free, 0.02)) * R


def _block(axes: Any, block: Block, side: int, y: float, R: float) -> None:
    from matplotlib.patches import Rectangle
    from matplotlib.patheffects import withStroke

    anchor = 1e3 * block.anchor
    x = side * 1.33 * R
    halo = [withStroke(linewidth=2.0, foreground="white")]
    bend = [anchor[0], side * 1.12 * R, x - side * 0.03 * R]
    axes.plot(bend, [anchor[1], y, y], color=INK, linewidth=0.7, zorder=5, path_effects=halo)
    axes.plot(*anchor, marker="o", markersize=3.4, color="white", markeredgecolor=INK, markeredgewidth=0.8, zorder=6)
    column = x if side > 0 else x - 1.36 * R
    if block.title:
        axes.text(column, y, block.title, va="center", fontsize=9.5, fontweight="bold", color=INK)
    for k, row in enumerate(block.rows, 1 if block.title else 0):
        height = y - ROW * R * k
        box = Rectangle(
            (column, height - 0.026 * R), 0.06 * R, 0.052 * R, facecolor=row.colour, edgecolor=INK, linewidth=0.5
        )
        axes.add_patch(box)
        weight = "normal" if block.title else "bold"
        axes.text(column + 0.09 * R, height, row.name, va="center", fontsize=8.8, fontweight=weight, color=INK)
        axes.text(column + 0.56 * R, height, row.size, va="center", fontsize=8.8, color=SOFT)
    if block.note:
        height = y - ROW * R * (block.lines - 1)
        axes.text(column + 0.09 * R, height, block.note, va="center", fontsize=8.8, color=SOFT)


def _dimension(axes: Any, R: float) -> None:
    y = -1.17 * R
    for x in (-R, R):
        axes.plot([x, x], [-0.12 * R, y - 0.05 * R], color=SOFT, linewidth=0.5, zorder=0)
    axes.annotate(
        "",
        (-R, y),
        (R, y),
        arrowprops={"arrowstyle": "<|-|>", "color": INK, "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0},
    )
    axes.text(
        0,
        y,
        f"\u2300 {2 * R:.1f} mm",
        ha="center",
        va="center",
        fontsize=10,
        color=INK,
        bbox={"facecolor": "white", "edgecolor": "none"},
    )
    start, bottom = 1.33 * R, y - 0.07 * R
    bar = max(b for k in range(-3, 4) for b in (10.0**k, 2 * 10.0**k, 5 * 10.0**k) if b <= 0.5 * R)
    axes.plot([start, start + bar], [bottom, bottom], color=INK, linewidth=2.2, solid_capstyle="butt")
    axes.text(start + bar + 0.06 * R, bottom, f"{bar:g} mm", va="center", fontsize=9, color=INK)
    arrow = {"arrowstyle": "-|>", "color": SOFT, "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0}
    x0, y0 = -2.69 * R, y - 0.07 * R
    for dx, dy, name in ((0.22, 0, "x"), (0, 0.22, "y")):
        axes.annotate("", (x0 + dx * R, y0 + dy * R), (x0, y0), arrowprops=arrow)
        axes.text(x0 + 1.22 * dx * R, y0 + 1.22 * dy * R, name, fontsize=9, color=SOFT, ha="center", va="center")


def _headline(figure: Any, cable: Cable, traces: list[Trace]) -> None:
    lay = lay_words(cable)
    if cable.single_lay and cable.lay is not None:
        lay += f", lay angle {np.degrees(cable.lay_angle):.1f}\u00b0"
        if cable.lay_ratio is not None and any(p.kind == "insulation" and p.centre_radius > 0 for p in cable.parts):
            lay += f", lay ratio {cable.lay_ratio:.1f}"
    title = "\n".join(textwrap.wrap(cable.title, 95))
    figure.text(0.03, 0.945, title, fontsize=12.5, fontweight="bold", color=INK, va="center")
    facts = f"section z = 0 \u00b7 {lay} \u00b7 {cable.mass_per_length:.3g} kg/m"
    figure.text(0.03, 0.895, facts, fontsize=10, color=SOFT, va="center")
    note = "Diameters are normal to each part's own centre line; in the section, what is laid at an angle appears wider along its tangent."
    if any(trace.level == "strand" for trace in traces):
        note += "\nStrands and wires are drawn where their helices meet the section, round as laid, before they are pressed together."
    figure.text(0.03, 0.03, note, fontsize=8, color=SOFT, va="center")


def saved(figure: Any, path: str | Path, dpi: int) -> Path:
    """Write a figure; GeometryError if that is not possible."""
    path = Path(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=dpi)
    except (OSError, ValueError) as error:
        raise GeometryError(
            f'the picture cannot be written to "{path}": {error}; try a name that ends in .png.'
        ) from None
    return path


def grouped(number: int) -> str:
    """A count with thin spaces between its thousands."""
    return f"{number:,}".replace(",", "\u2009")

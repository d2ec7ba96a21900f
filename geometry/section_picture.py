"""Pictures of the cross-section: the drawing with every part named, and the mesh. matplotlib is loaded here only."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.cable import Cable, Part
from geometry.cell_mesh import CrossSectionMesh
from geometry.colour_scheme import KIND_TITLES, kind_colour
from geometry.errors import GeometryError
from geometry.mesh_quality import scaled_jacobian
from geometry.strand import layer_radii

INK = "#22262b"
SOFT = "#6b7178"


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
    axes.set(xlim=(-2.75 * R, 2.75 * R), ylim=(-1.32 * R, 1.08 * R), aspect="equal")
    axes.axis("off")
    for part in cable.parts:
        if part.kind == "interstices":
            _fill(axes, np.array([[0.0, 0.0]]), part, background=cable.laid_up_radius)
    for part in cable.parts:
        if part.kind != "interstices":
            _fill(axes, 1e3 * _ring(part), part)
            if part.kind == "conductor":
                _strands(axes, cable, part)
    _labels(axes, cable, R)
    _dimension(axes, R)
    _headline(figure, cable)
    return _saved(figure, path, dpi)


def draw_mesh(section: CrossSectionMesh, path: str | Path, title: str = "", dpi: int = 200) -> Path:
    """Draw the mesh of the section, regions in the colours of their kinds.

    Raises
    ------
    GeometryError
        If the file cannot be written.
    """
    from matplotlib.collections import PolyCollection
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    corners = {
        "triangle": [0, 1, 2],
        "triangle6": [0, 3, 1, 4, 2, 5],
        "quad": [0, 1, 2, 3],
        "quad9": [0, 4, 1, 5, 2, 6, 3, 7],
    }
    polygons = 1e3 * section.points[section.cells[:, corners[section.cell_kind]]]
    kinds = [section.regions[r].kind for r in section.region_of]
    figure = Figure(figsize=(9.0, 8.2), facecolor="white")
    axes = figure.add_axes((0.07, 0.06, 0.70, 0.84))
    axes.add_collection(
        PolyCollection(
            list(polygons),
            facecolors=[kind_colour(k) for k in kinds],
            edgecolors=["#aab2bb" if k in ("sheath", "cover") else INK for k in kinds],
            linewidths=0.25,
        )
    )
    reach = 1.02 * np.abs(polygons).max()
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xlabel="x [mm]", ylabel="y [mm]")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    seen = list(dict.fromkeys(region.kind for region in section.regions))
    handles = [Patch(facecolor=kind_colour(k), edgecolor=INK, linewidth=0.5, label=KIND_TITLES.get(k, k)) for k in seen]
    figure.legend(handles=handles, loc="center left", bbox_to_anchor=(0.785, 0.5), frameon=False, fontsize=9)
    quality = scaled_jacobian(section)
    figure.text(0.07, 0.955, title or "Mesh of the cross-section", fontsize=13, fontweight="bold", color=INK)
    figure.text(
        0.07,
        0.922,
        f"{_grouped(len(section.cells))} elements ({section.cell_kind}) \u00b7 {_grouped(len(section.points))} nodes \u00b7 "
        f"{_grouped(3 * len(section.points))} displacement unknowns \u00b7 scaled Jacobian at least {quality.min():.2f}, "
        f"median {np.median(quality):.2f}",
        fontsize=9,
        color=SOFT,
    )
    return _saved(figure, path, dpi)


def _grouped(number: int) -> str:
    return f"{number:,}".replace(",", "\u2009")


def _ring(part: Part) -> NDArray[np.float64]:
    """Closed polygon of the part, the inner boundary walked backwards [m]."""
    phi = np.linspace(0, 2 * np.pi, 181)
    outer = part.outer_trace.point(phi)
    return outer if part.inner_trace is None else np.vstack([outer, part.inner_trace.point(phi[::-1])])


def _fill(axes: Any, polygon: NDArray[np.float64], part: Part, background: float | None = None) -> None:
    from matplotlib.patches import Circle, Polygon

    style = {"facecolor": kind_colour(part.kind), "linewidth": 0}
    if background is not None:
        axes.add_patch(Circle((0, 0), 1e3 * background, **style))
        return
    axes.add_patch(Polygon(polygon, closed=True, **style))
    phi = np.linspace(0, 2 * np.pi, 181)
    axes.plot(*(1e3 * part.outer_trace.point(phi)).T, color=INK, linewidth=0.6)


def _strands(axes: Any, cable: Cable, part: Part) -> None:
    """Thin circles where the strands of a conductor lie; the model takes them as one cylinder."""
    material = part.material.name.removesuffix(" conductor")
    conductor = cable.conductors.get(material)
    if conductor is None or conductor.strand is None:
        return
    centre = part.centre_radius * np.array([np.cos(part.phase), np.sin(part.phase)])
    phi = np.linspace(0, 2 * np.pi, 61)
    circle = conductor.strand.diameter / 2 * np.column_stack([np.cos(phi), np.sin(phi)])
    radii = layer_radii(conductor.layers, conductor.strand.diameter, conductor.name)
    for count, radius in zip(conductor.layers, radii, strict=True):
        for k in range(count):
            turn = part.phase + 2 * np.pi * k / count
            place = centre + radius * np.array([np.cos(turn), np.sin(turn)])
            axes.plot(*(1e3 * (place + circle)).T, color="#7a4118", linewidth=0.45, alpha=0.8)


def _labels(axes: Any, cable: Cable, R: float) -> None:
    """One block of text for every member, with a leader line, in a column left and right."""
    blocks = []
    for member in dict.fromkeys(part.member for part in cable.parts):
        layers = [part for part in cable.parts if part.member == member]
        blocks.append((layers, _anchor(layers[-1], cable)))
    right = sorted((b for b in blocks if b[1][0] > 1e-9), key=lambda b: -b[1][1])
    left = sorted((b for b in blocks if b[1][0] <= 1e-9), key=lambda b: -b[1][1])
    for side, column in ((1, right), (-1, left)):
        total = sum(_block_height(layers) for layers, _ in column)
        free = (2.1 - total * 0.085) / max(len(column), 1)
        y = 1.05 * R - 0.5 * max(free, 0.0) * R
        for layers, anchor in column:
            _block(axes, layers, anchor, side, y, R)
            y -= (_block_height(layers) * 0.085 + max(free, 0.02)) * R


def _block_height(layers: list[Part]) -> int:
    return len(layers) + (1 if layers[0].member != layers[0].name else 0)


def _anchor(part: Part, cable: Cable) -> NDArray[np.float64]:
    """Point [mm] inside the part where its leader line starts."""
    middle = 0.5 * (part.inner_radius + part.outer_radius)
    if part.centre_radius > 0:
        direction = np.array([np.cos(part.phase), np.sin(part.phase)])
        sideways = np.array([1.0 if direction[0] > -0.5 else -1.0, 0.25])
        return 1e3 * (part.centre_radius * direction + middle * sideways / np.linalg.norm(sideways))
    angle = {"sheath": -0.55, "wrap": np.pi + 0.62, "interstices": np.pi - 0.72, "cover": np.pi + 0.78}.get(
        part.kind, 2.6
    )
    if part.kind == "interstices":
        middle = 0.86 * cable.laid_up_radius
    return 1e3 * middle * np.array([np.cos(angle), np.sin(angle)])


def _block(axes: Any, layers: list[Part], anchor: NDArray[np.float64], side: int, y: float, R: float) -> None:
    from matplotlib.patches import Rectangle
    from matplotlib.patheffects import withStroke

    x = side * 1.33 * R
    titled = layers[0].member != layers[0].name
    lines = [(layers[0].member, "", None)] if titled else []
    lines += [(part.kind if titled else part.name, _size(part), part.kind) for part in reversed(layers)]
    halo = [withStroke(linewidth=2.0, foreground="white")]
    bend = [anchor[0], side * 1.12 * R, x - side * 0.03 * R]
    axes.plot(bend, [anchor[1], y, y], color=INK, linewidth=0.7, zorder=5, path_effects=halo)
    axes.plot(*anchor, marker="o", markersize=3.4, color="white", markeredgecolor=INK, markeredgewidth=0.8, zorder=6)
    column = x if side > 0 else x - 1.30 * R
    for k, (name, size, kind) in enumerate(lines):
        row = y - 0.085 * R * k
        if kind is None:
            axes.text(column, row, name, va="center", fontsize=9.5, fontweight="bold", color=INK)
            continue
        box = Rectangle(
            (column, row - 0.026 * R), 0.06 * R, 0.052 * R, facecolor=kind_colour(kind), edgecolor=INK, linewidth=0.5
        )
        axes.add_patch(box)
        weight = "normal" if titled else "bold"
        axes.text(column + 0.09 * R, row, name, va="center", fontsize=8.8, fontweight=weight, color=INK)
        axes.text(column + 0.52 * R, row, size, va="center", fontsize=8.8, color=SOFT)


def _size(part: Part) -> str:
    wall = 1e3 * (part.outer_radius - part.inner_radius)
    if part.kind == "interstices":
        return f"{1e6 * part.area:.0f} mm\u00b2"
    diameter = f"\u2300 {2e3 * part.outer_radius:.2f} mm"
    return diameter if part.inner_radius == 0 else f"{diameter}, wall {wall:.2f}"


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
    x0, y0 = -2.6 * R, y - 0.07 * R
    for dx, dy, name in ((0.22, 0, "x"), (0, 0.22, "y")):
        axes.annotate("", (x0 + dx * R, y0 + dy * R), (x0, y0), arrowprops=arrow)
        axes.text(x0 + 1.22 * dx * R, y0 + 1.22 * dy * R, name, fontsize=9, color=SOFT, ha="center", va="center")


def _headline(figure: Any, cable: Cable) -> None:
    lay = (
        "straight"
        if cable.lay is None
        else (
            f"lay {1e3 * cable.lay:.4g} mm ({cable.hand}), lay ratio {cable.lay_ratio:.1f}, "
            f"lay angle {np.degrees(cable.lay_angle):.1f}\u00b0"
        )
    )
    figure.text(
        0.03, 0.945, "\n".join(textwrap.wrap(cable.title, 95)), fontsize=12.5, fontweight="bold", color=INK, va="center"
    )
    figure.text(
        0.03,
        0.895,
        f"section z = 0 \u00b7 {lay} \u00b7 {cable.mass_per_length:.2f} kg/m",
        fontsize=10,
        color=SOFT,
        va="center",
    )
    note = "Diameters are normal to each part's own centre line; in the section, cores laid at an angle appear wider along their tangent."
    if any(c.strand for c in cable.conductors.values()):
        note += "\nThin circles mark the strands, which the model takes as one cylinder."
    figure.text(0.03, 0.03, note, fontsize=8, color=SOFT, va="center")


def _saved(figure: Any, path: str | Path, dpi: int) -> Path:
    path = Path(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=dpi)
    except (OSError, ValueError) as error:
        raise GeometryError(
            f'the picture cannot be written to "{path}": {error}; try a name that ends in .png.'
        ) from None
    return path

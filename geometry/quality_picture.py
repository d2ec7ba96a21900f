"""Picture of the quality of a mesh: how many elements of each kind have which scaled Jacobian. matplotlib is loaded here only."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geometry.cell_mesh import CrossSectionMesh, SliceMesh, SweptCell
from geometry.mesh_quality import block_quality, quality_histogram
from geometry.section_picture import grouped, saved

INK = "#22262b"
SOFT = "#6b7178"
GOOD, POOR = "#4d7ea8", "#c8553d"
LIMIT = 0.2
"""Elements below are drawn in another colour."""
TITLES = {
    "hexahedron": "hexahedra",
    "wedge": "prisms",
    "pyramid": "pyramids",
    "tetra": "tetrahedra",
    "quad": "quadrilaterals",
    "quad9": "curved quadrilaterals",
    "triangle": "triangles",
    "triangle6": "curved triangles",
}


def draw_quality(
    mesh: CrossSectionMesh | SliceMesh | SweptCell, path: str | Path, bins: int = 50, dpi: int = 200
) -> Path:
    """Draw one histogram of the scaled Jacobian for every kind of element, counts on a logarithmic scale.

    Parameters
    ----------
    path : file to write; the ending chooses the format (png, svg, pdf)
    bins : steps between 0 and 1

    Raises
    ------
    GeometryError
        If the file cannot be written.
    """
    from matplotlib.figure import Figure

    path, count = Path(path), len(mesh.blocks)
    figure = Figure(figsize=(8.0, 1.5 + 1.75 * count), facecolor="white")
    rows = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
    figure.subplots_adjust(
        left=0.1, right=0.97, top=1 - 0.8 / (1.5 + 1.75 * count), bottom=0.65 / (1.5 + 1.75 * count), hspace=0.45
    )
    worst = 1.0
    for axes, block in zip(rows, mesh.blocks, strict=True):
        quality = block_quality(mesh.points, block.cells, block.kind)
        worst = min(worst, float(quality.min()))
        counts, edges = quality_histogram(quality, bins)
        colours = [POOR if edge < LIMIT - 1e-9 else GOOD for edge in edges[1:-1]]
        axes.bar(
            edges[1:-1], counts[1:], np.diff(edges[1:]), align="edge", color=colours, edgecolor="white", linewidth=0.4
        )
        if counts[0]:
            axes.bar(-0.02, counts[0], 0.02, align="edge", color=POOR)
        axes.set(yscale="log", ylim=(0.5, 3 * max(counts.max(), 2)), xlim=(-0.02, 1.0), ylabel="elements")
        text = f"{grouped(len(quality))} {TITLES[block.kind]} \u00b7 at least {quality.min():.2f}, median {np.median(quality):.2f}"
        axes.set_title(text, fontsize=9, color=SOFT, loc="left")
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
    rows[-1].set_xlabel("scaled Jacobian (1 perfect, 0 flat)")
    total = grouped(sum(len(block.cells) for block in mesh.blocks))
    figure.text(
        0.1,
        1 - 0.3 / (1.5 + 1.75 * count),
        f"Quality of {total} elements, the worst {worst:.2f}",
        fontsize=13,
        fontweight="bold",
        color=INK,
    )
    return saved(figure, path, dpi)

"""Pictures of meshes: the cross-section in the plane, and the swept cell in space, cut open so that its regions can be seen."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh, SliceMesh, SweptCell
from geometry.colour_scheme import INK, KIND_TITLES, SOFT, kind_colour, part_colour
from geometry.mesh_quality import scaled_jacobian
from geometry.rendered_scene import Label, Surface, View, rendered, write_picture
from geometry.section_picture import grouped, saved
from geometry.stripping import WEIGHTS

FACES = {
    "hexahedron": ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
    "wedge": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
}
"""Corners of the faces of a cell in meshio order, seen from outside anticlockwise."""
LAST = ("wire", "conductor", "strand")
"""Kinds that stick out furthest, in this order."""


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
        f"{grouped(len(section.cells))} elements ({section.cell_kind}) \u00b7 {grouped(len(section.points))} nodes \u00b7 "
        f"{grouped(3 * len(section.points))} displacement unknowns \u00b7 scaled Jacobian at least {quality.min():.2f}, "
        f"median {np.median(quality):.2f}",
        fontsize=9,
        color=SOFT,
    )
    return saved(figure, path, dpi)


def draw_swept_cell(
    cell: SweptCell | SliceMesh, path: str | Path, title: str = "", size: tuple[int, int] = (1600, 1050)
) -> Path:
    """Render the mesh of a cell cut open: every region ends before the one below it, with the edges of its elements.

    Parameters
    ----------
    path : picture to write (png)
    size : pixels

    Raises
    ------
    GeometryError
        If nothing can be rendered here, or the file cannot be written.
    """
    ends = region_ends(cell)
    radius = float(np.linalg.norm(cell.points[:, :2], axis=1).max())
    view = View(radius, cell.height, size, towards=(-0.62, 0.42, 0.66))
    image = rendered(list(cell_surfaces(cell, ends)), view)
    blocks = _blocks(cell)
    counts = [f"{grouped(len(cells))} {kind}" + ("s" if kind != "tetra" else "") for kind, cells, _ in blocks]
    counts = [c.replace("hexahedrons", "hexahedra") for c in counts]
    facts = f"{', '.join(counts)} \u00b7 {grouped(len(cell.points))} nodes \u00b7 height {1e3 * cell.height:.4g} mm"
    return write_picture(image, view, title or "Mesh of the cell", facts, _cell_labels(cell, ends, view), path)


def region_ends(cell: SweptCell | SliceMesh) -> dict[str, float]:
    """Where each kind of region ends in the cut-open cell, as a share of its height; the outermost kind first."""
    reach: dict[str, float] = {}
    for _, cells, region_of in _blocks(cell):
        for r in np.unique(region_of):
            kind = cell.regions[r].kind
            nodes = cell.points[cells[region_of == r].ravel(), :2]
            reach[kind] = max(reach.get(kind, 0.0), float(np.linalg.norm(nodes, axis=1).max()))
    order = {"interstices": 1, "cover": -1}  # between cores of the same reach, and with the centre
    kinds = sorted(
        reach,
        key=lambda k: (
            LAST.index(k) if k in LAST else -1,
            order.get(k, 0) == -1,
            -round(reach[k], 7),
            -order.get(k, 0),
        ),
    )
    weights = [max(WEIGHTS.get(k, 1.0), 0.6) for k in kinds if k not in LAST[:-1] or LAST[-1] not in kinds]
    weights += [0.0] * (len(kinds) - len(weights))
    ends = dict(zip(kinds, (np.cumsum(weights) / sum(weights)).tolist(), strict=True))
    return {kind: 1.0 if kind in LAST else end for kind, end in ends.items()}


def cell_surfaces(cell: SweptCell | SliceMesh, ends: dict[str, float]) -> Iterator[Surface]:
    """Outer faces of what is left of the cell when every kind of region is cut at its end; one colour for each kind."""
    found: dict[int, list[tuple[NDArray[np.int64], NDArray[np.int64]]]] = {3: [], 4: []}
    for kind, cells, region_of in _blocks(cell):
        cut = np.array([ends[region.kind] for region in cell.regions]) * cell.height
        kept = cell.points[cells, 2].min(1) < cut[region_of] - 1e-6 * cell.height  # whole layers of cells
        for face in FACES[kind]:
            found[len(face)].append((cells[kept][:, face], region_of[kept]))
    weights = np.random.default_rng(0).integers(1, 2**62, len(cell.points), dtype=np.uint64)
    for pieces in found.values():
        if not pieces:
            continue
        faces, region = (np.concatenate(x) for x in zip(*pieces, strict=True))
        _, first, count = np.unique(weights[faces].sum(1), return_index=True, return_counts=True)
        outer = first[count == 1]
        yield from _coloured(cell, faces[outer], region[outer])


def _coloured(cell: SweptCell | SliceMesh, faces: NDArray[np.int64], region: NDArray[np.int64]) -> Iterator[Surface]:
    colours = np.array([part_colour(r.kind, r.material.density, r.material.E) for r in cell.regions])
    for colour in np.unique(colours[region]):
        mine = faces[colours[region] == colour]
        nodes, numbered = np.unique(mine, return_inverse=True)
        yield Surface(
            cell.points[nodes], numbered.reshape(mine.shape), str(colour), smooth=False, gloss=(0.0, 1), edges=True
        )


def _cell_labels(cell: SweptCell | SliceMesh, ends: dict[str, float], view: View) -> list[Label]:
    """Each kind at its node nearest the eye in the middle of what is seen of it."""
    labels, begin = [], 0.0
    for kind, end in ends.items():
        wanted = [k for k, region in enumerate(cell.regions) if region.kind == kind]
        nodes = np.unique(
            np.concatenate([cells[np.isin(region_of, wanted)].ravel() for _, cells, region_of in _blocks(cell)])
        )
        points = cell.points[nodes]
        middle = 0.5 * (begin + end) * cell.height
        near = points[np.abs(points[:, 2] - middle) <= np.abs(points[:, 2] - middle).min() + 1e-9]
        if kind != "cover" and not (kind == "conductor" and "strand" in ends):
            labels.append(Label(KIND_TITLES.get(kind, f"{kind}s"), near[np.argmax(near @ view.axes[2])]))
            begin = end
    return labels


def _blocks(cell: SweptCell | SliceMesh) -> list[tuple[str, NDArray[np.int64], NDArray[np.int64]]]:
    if isinstance(cell, SliceMesh):
        return [(cell.cell_kind, cell.cells, cell.region_of)]
    return [(block.kind, block.cells, block.region_of) for block in cell.blocks]

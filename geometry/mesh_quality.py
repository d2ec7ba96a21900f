r"""Size and quality of mesh elements.

The scaled Jacobian of an element is the smallest over its corners of

.. math::  \det(e_1, \dots, e_d) / (|e_1| \cdots |e_d|),

e_k the edges that leave the corner, divided by its value for the regular element (sqrt 3 / 2 for triangles and
wedges, 1 for quadrilaterals and hexahedra, 1 / sqrt 2 for tetrahedra); 1 is perfect, 0 flat, negative inside out. Definition
as in Stimpson et al., The Verdict Geometric Quality Library, Sandia report SAND2007-1751. Four edges meet at the apex of a
pyramid, so that only the corners of its base count, divided by 1 / sqrt 2, their value for the pyramid of eight equal edges;
slender pyramids, which would come out above 1, count as 1. For curved elements it is the scaled Jacobian of their corners.

Sizes (area or volume) are integrated by Gauss rules that are exact for the element (reference_gradients.py).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh, SliceMesh, SweptCell
from geometry.errors import MeshError
from geometry.reference_gradients import reference_gradients

AnyMesh = CrossSectionMesh | SliceMesh | SweptCell
CORNERS = {
    "triangle": [(0, 1, 2), (1, 2, 0), (2, 0, 1)],
    "quad": [(0, 1, 3), (1, 2, 0), (2, 3, 1), (3, 0, 2)],
    "wedge": [(0, 1, 2, 3), (1, 2, 0, 4), (2, 0, 1, 5), (3, 5, 4, 0), (4, 3, 5, 1), (5, 4, 3, 2)],
    "hexahedron": [
        (0, 1, 3, 4),
        (1, 2, 0, 5),
        (2, 3, 1, 6),
        (3, 0, 2, 7),
        (4, 7, 5, 0),
        (5, 4, 6, 1),
        (6, 5, 7, 2),
        (7, 6, 4, 3),
    ],
    "pyramid": [(0, 1, 3, 4), (1, 2, 0, 4), (2, 3, 1, 4), (3, 0, 2, 4)],
    "tetra": [(0, 1, 2, 3), (1, 2, 0, 3), (2, 0, 1, 3), (3, 0, 2, 1)],
}
LINEAR = {"triangle6": "triangle", "quad9": "quad"}
REGULAR = {
    "triangle": np.sqrt(3) / 2,
    "quad": 1.0,
    "wedge": np.sqrt(3) / 2,
    "hexahedron": 1.0,
    "pyramid": np.sqrt(0.5),
    "tetra": np.sqrt(0.5),
}
AT_ONCE = 20_000
"""Elements taken together: large enough for numpy, small enough for the processor's cache."""


def scaled_jacobian(mesh: AnyMesh) -> NDArray[np.float64]:
    """Scaled Jacobian of every element, shape (m,); of a swept cell one block after the other."""
    return np.concatenate([block_quality(mesh.points, block.cells, block.kind) for block in mesh.blocks])


def block_quality(points: NDArray[np.float64], cells: NDArray[np.int64], kind: str) -> NDArray[np.float64]:
    """Scaled Jacobian of the `cells` (m, nodes) of one `kind`, shape (m,)."""
    kind = LINEAR.get(kind, kind)
    quality = np.empty(len(cells))
    for part in _parts(len(cells)):
        nodes = points[cells[part]]
        worst = np.full(len(nodes), np.inf)
        for first, *others in CORNERS[kind]:
            edges = [nodes[:, k] - nodes[:, first] for k in others]
            lengths = np.sqrt(np.prod([np.einsum("ed,ed->e", e, e) for e in edges], axis=0))
            with np.errstate(divide="ignore", invalid="ignore"):
                worst = np.minimum(worst, np.where(lengths > 0, _determinant(edges) / lengths, 0.0))
        quality[part] = np.minimum(worst / REGULAR[kind], 1.0)
    return quality


def element_sizes(mesh: AnyMesh) -> NDArray[np.float64]:
    """Area [m^2] or volume [m^3] of every element, shape (m,); negative if inside out; block after block."""
    return np.concatenate([block_sizes(mesh.points, block.cells, block.kind) for block in mesh.blocks])


def block_sizes(points: NDArray[np.float64], cells: NDArray[np.int64], kind: str) -> NDArray[np.float64]:
    """Area [m^2] or volume [m^3] of the `cells` (m, nodes) of one `kind`, shape (m,)."""
    gradients, weights = reference_gradients(kind)
    sizes = np.zeros(len(cells))
    for part in _parts(len(cells)):
        nodes = points[cells[part]]
        for gradient, weight in zip(gradients, weights, strict=True):
            columns = [np.einsum("ekx,k->ex", nodes, g) for g in gradient.T]
            sizes[part] += weight * _determinant(columns)
    return sizes


def region_sizes(mesh: AnyMesh) -> NDArray[np.float64]:
    """Area [m^2] or volume [m^3] of every region, in the order of ``mesh.regions``."""
    region_of = np.concatenate([block.region_of for block in mesh.blocks])
    sizes = np.zeros(len(mesh.regions))
    np.add.at(sizes, region_of, element_sizes(mesh))
    return sizes


def quality_histogram(
    mesh: AnyMesh | NDArray[np.float64], bins: int = 10
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Number of elements by scaled Jacobian.

    Parameters
    ----------
    mesh : a mesh, or the scaled Jacobians themselves
    bins : steps between 0 and 1

    Returns
    -------
    counts : (bins + 1,)
        First the elements that are inside out, then those in `bins` equal steps from 0 to 1.
    edges : (bins + 2,)
        -1, 0, ..., 1; a value on an edge counts above it.

    Raises
    ------
    MeshError
        If `bins` is not positive.
    """
    if bins < 1:
        raise MeshError(f"a histogram needs at least one bin, found {bins}.")
    edges = np.concatenate([[-1.0], np.arange(bins + 1) / bins])
    quality = mesh if isinstance(mesh, np.ndarray) else scaled_jacobian(mesh)
    counts, _ = np.histogram(np.clip(quality, -1.0, 1.0), edges)
    return counts.astype(np.int64), edges


def share_below(mesh: AnyMesh | NDArray[np.float64], limit: float = 0.2) -> float:
    """Share of the elements, by number, whose scaled Jacobian is below `limit`; of a mesh, or of the scaled Jacobians themselves."""
    quality = mesh if isinstance(mesh, np.ndarray) else scaled_jacobian(mesh)
    return float((quality < limit).mean())


def _parts(count: int) -> Iterator[slice]:
    return (slice(start, start + AT_ONCE) for start in range(0, count, AT_ONCE))


def _determinant(columns: list[NDArray[np.float64]]) -> NDArray[np.float64]:
    """det of the 2 x 2 or 3 x 3 matrices whose columns (or rows) are given as arrays (m, d)."""
    if len(columns) == 2:
        (a, b), (c, d) = columns[0].T, columns[1].T
        return a * d - b * c
    a, (x, y, z) = columns[0].T, columns[1].T
    u, v, w = columns[2].T
    return a[0] * (y * w - z * v) + a[1] * (z * u - x * w) + a[2] * (x * v - y * u)

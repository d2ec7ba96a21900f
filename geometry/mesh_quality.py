r"""Size and quality of mesh elements.

The scaled Jacobian of an element is the smallest over its corners of

.. math::  \det(e_1, \dots, e_d) / (|e_1| \cdots |e_d|),

e_k the edges that leave the corner, divided by its value for the regular element (sqrt 3 / 2 for triangles and
wedges, 1 for quadrilaterals and hexahedra); 1 is perfect, 0 flat, negative inside out. Definition as in
Stimpson et al., The Verdict Geometric Quality Library, Sandia report SAND2007-1751. For curved elements it is that of their corners.
Sizes (area or volume) are integrated by Gauss rules that are exact for the element.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh, SliceMesh

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
}
LINEAR = {"triangle6": "triangle", "quad9": "quad"}
REGULAR = {"triangle": np.sqrt(3) / 2, "quad": 1.0, "wedge": np.sqrt(3) / 2, "hexahedron": 1.0}
GAUSS3 = np.array([-np.sqrt(0.6), 0.0, np.sqrt(0.6)]), np.array([5.0, 8.0, 5.0]) / 9
TRIANGLE = np.array([[1 / 6, 1 / 6], [2 / 3, 1 / 6], [1 / 6, 2 / 3]]), np.full(3, 1 / 6)


def scaled_jacobian(mesh: CrossSectionMesh | SliceMesh) -> NDArray[np.float64]:
    """Scaled Jacobian of every element, shape (m,)."""
    kind = LINEAR.get(mesh.cell_kind, mesh.cell_kind)
    corners = mesh.points[mesh.cells]
    worst = np.full(len(corners), np.inf)
    for first, *others in CORNERS[kind]:
        edges = np.stack([corners[:, k] - corners[:, first] for k in others], axis=1)
        worst = np.minimum(worst, np.linalg.det(edges) / np.prod(np.linalg.norm(edges, axis=2), axis=1))
    return worst / REGULAR[kind]


def element_sizes(mesh: CrossSectionMesh | SliceMesh) -> NDArray[np.float64]:
    """Area [m^2] or volume [m^3] of every element, shape (m,); negative if inside out."""
    gradients, weights = _reference(mesh.cell_kind)
    sizes = np.zeros(len(mesh.cells))
    for gradient, weight in zip(gradients, weights, strict=True):
        jacobian = np.einsum("eax,ad->exd", mesh.points[mesh.cells], gradient)
        sizes += weight * np.linalg.det(jacobian)
    return sizes


def region_sizes(mesh: CrossSectionMesh | SliceMesh) -> NDArray[np.float64]:
    """Area [m^2] or volume [m^3] of every region, in the order of ``mesh.regions``."""
    sizes = np.zeros(len(mesh.regions))
    np.add.at(sizes, mesh.region_of, element_sizes(mesh))
    return sizes


def _reference(kind: str) -> tuple[list[NDArray[np.float64]], list[float]]:
    """Shape-function gradients (nodes, dim) and weights at the Gauss points."""
    if kind in ("triangle", "triangle6"):
        gradient = _triangle if kind == "triangle" else _triangle6
        return [gradient(*p) for p in TRIANGLE[0]], list(TRIANGLE[1])
    if kind == "wedge":
        points = [(p, z, w * wz) for (p, w) in zip(*TRIANGLE, strict=True) for z, wz in zip(*GAUSS3, strict=True)]
        return [_wedge(p[0], p[1], z) for p, z, _ in points], [w for *_, w in points]
    nodes = {"quad": 4, "quad9": 9, "hexahedron": 8}[kind]
    dim = 3 if kind == "hexahedron" else 2
    grid = list(itertools.product(zip(*GAUSS3, strict=True), repeat=dim))
    return (
        [_tensor(np.array([x for x, _ in g]), nodes) for g in grid],
        [float(np.prod([w for _, w in g])) for g in grid],
    )


def _triangle(r: float, s: float) -> NDArray[np.float64]:
    return np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])


def _triangle6(r: float, s: float) -> NDArray[np.float64]:
    t = 1 - r - s
    return np.array(
        [
            [1 - 4 * t, 1 - 4 * t],
            [4 * r - 1, 0],
            [0, 4 * s - 1],
            [4 * (t - r), -4 * r],
            [4 * s, 4 * r],
            [-4 * s, 4 * (t - s)],
        ]
    )


def _wedge(r: float, s: float, z: float) -> NDArray[np.float64]:
    shape, slope = np.array([1 - r - s, r, s], dtype=float), _triangle(r, s)
    low, high = (1 - z) / 2, (1 + z) / 2
    return np.vstack([np.column_stack([low * slope, -shape / 2]), np.column_stack([high * slope, shape / 2])])


def _tensor(x: NDArray[np.float64], nodes: int) -> NDArray[np.float64]:
    """Lagrange elements on [-1, 1]^d in gmsh/meshio order."""
    places = {
        4: [(-1, -1), (1, -1), (1, 1), (-1, 1)],
        9: [(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0), (0, 0)],
        8: [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)],
    }[nodes]
    one = _quadratic if nodes == 9 else _linear
    table = np.empty((nodes, len(x)))
    for a, place in enumerate(places):
        values = [one(position, xi) for position, xi in zip(place, x, strict=True)]
        for d in range(len(x)):
            table[a, d] = np.prod([value[1 if k == d else 0] for k, value in enumerate(values)])
    return table


def _linear(position: float, x: float) -> tuple[float, float]:
    return (1 + position * x) / 2, position / 2


def _quadratic(position: float, x: float) -> tuple[float, float]:
    return (1 - x * x, -2 * x) if position == 0 else (x * (x + position) / 2, x + position / 2)

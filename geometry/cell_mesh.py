"""The meshes that leave this package: the cross-section (2D), the helical slice and the swept cell (3D).

Axes: z along the cable. The cross-section is the plane z = 0; at height z it stands turned by the angle
``twist_rate * z`` about z, twist_rate = 2 pi / pitch, positive for a right-handed (Z) lay, zero for a straight cable.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import MeshError
from geometry.material import Material

NODES_PER_CELL = {
    "triangle": 3,
    "triangle6": 6,
    "quad": 4,
    "quad9": 9,
    "wedge": 6,
    "hexahedron": 8,
    "pyramid": 5,
    "tetra": 4,
}


@dataclass(frozen=True)
class Region:
    """A named part of the cross-section: its `material`, its `kind`, and its `closed_form_area` [m^2] (nan if none is known)."""

    name: str
    kind: str
    material: Material
    closed_form_area: float


@dataclass(frozen=True)
class CrossSectionMesh:
    """Mesh of the section z = 0; regions share their nodes on every interface.

    Attributes
    ----------
    points : (n, 2) [m]
    cells : (m, k) node numbers, in gmsh/meshio order; k by `cell_kind`: "triangle" 3, "triangle6" 6, "quad" 4, "quad9" 9
    region_of : (m,) index into `regions`
    twist_rate : 2 pi / pitch [rad/m], signed
    """

    points: NDArray[np.float64]
    cells: NDArray[np.int64]
    cell_kind: str
    region_of: NDArray[np.int64]
    regions: tuple[Region, ...]
    twist_rate: float

    def __post_init__(self) -> None:
        _check(self.points, self.cells, self.cell_kind, self.region_of, self.regions, 2)

    @property
    def blocks(self) -> tuple[CellBlock, ...]:
        """The cells as one block, as a swept cell gives them."""
        return (CellBlock(self.cell_kind, self.cells, self.region_of),)


@dataclass(frozen=True)
class SliceMesh:
    """Helical slice of the cable between z = 0 and z = `height`.

    The end faces match node for node under the helical motion x -> Q x + height e_z, Q = rotation by twist_rate * height:
    node ``top[i]`` is the image of node ``bottom[i]``.

    Attributes
    ----------
    points : (n, 3) [m]
    cells : (m, k) node numbers; `cell_kind` "wedge" 6 or "hexahedron" 8, in meshio order
    region_of : (m,) index into `regions`
    bottom, top : (b,) matching node numbers
    """

    points: NDArray[np.float64]
    cells: NDArray[np.int64]
    cell_kind: str
    region_of: NDArray[np.int64]
    regions: tuple[Region, ...]
    twist_rate: float
    height: float
    bottom: NDArray[np.int64]
    top: NDArray[np.int64]

    def __post_init__(self) -> None:
        _check(self.points, self.cells, self.cell_kind, self.region_of, self.regions, 3)

    @property
    def blocks(self) -> tuple[CellBlock, ...]:
        """The cells as one block, as a swept cell gives them."""
        return (CellBlock(self.cell_kind, self.cells, self.region_of),)

    def matching_gap(self) -> float:
        """Largest distance [m] between a top node and the image of its bottom partner under the helical motion."""
        return _matching_gap(self)


@dataclass(frozen=True)
class CellBlock:
    """Cells of one kind: `kind` "hexahedron", "wedge", "pyramid" or "tetra"; `cells` (m, k) node numbers in meshio order;
    `region_of` (m,) index into the regions of the mesh."""

    kind: str
    cells: NDArray[np.int64]
    region_of: NDArray[np.int64]


@dataclass(frozen=True)
class SweptCell:
    """Cell of a cable between z = 0 and z = `height` in which parts of several lays are swept; hexahedra, with pyramids and
    tetrahedra where two sweeps slide past each other.

    The end faces match node for node under the cell's motion x -> Q x + height e_z, Q = rotation by twist_rate * height:
    node ``top[i]`` is the image of node ``bottom[i]``. A strand may continue as another strand of its conductor there.

    Attributes
    ----------
    points : (n, 3) [m]
    blocks : one for each kind of cell, hexahedra first
    regions : `closed_form_area` is the exact volume over `height` [m^2]
    bottom, top : (b,) matching node numbers
    notes : sentences on what the mesh could and could not do as asked
    """

    points: NDArray[np.float64]
    blocks: tuple[CellBlock, ...]
    regions: tuple[Region, ...]
    twist_rate: float
    height: float
    bottom: NDArray[np.int64]
    top: NDArray[np.int64]
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not self.blocks:
            raise MeshError("a swept cell needs at least one block of cells.")
        for block in self.blocks:
            _check(self.points, block.cells, block.kind, block.region_of, self.regions, 3)

    def matching_gap(self) -> float:
        """Largest distance [m] between a top node and the image of its bottom partner under the cell's motion."""
        return _matching_gap(self)

    def count(self, kind: str) -> int:
        """Number of cells of a kind; 0 if there are none."""
        return sum(len(block.cells) for block in self.blocks if block.kind == kind)


def _matching_gap(mesh: SliceMesh | SweptCell) -> float:
    angle = mesh.twist_rate * mesh.height
    Q = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1.0]])
    image = mesh.points[mesh.bottom] @ Q.T + [0.0, 0.0, mesh.height]
    return float(np.linalg.norm(mesh.points[mesh.top] - image, axis=1).max())


def _check(
    points: NDArray, cells: NDArray, kind: str, region_of: NDArray, regions: tuple[Region, ...], dim: int
) -> None:
    if kind not in NODES_PER_CELL:
        raise MeshError(f'cell kind "{kind}" is not one of {", ".join(NODES_PER_CELL)}.')
    if points.ndim != 2 or points.shape[1] != dim or not np.isfinite(points).all():
        raise MeshError(f"points must be a finite array of shape (n, {dim}), found shape {points.shape}.")
    if cells.ndim != 2 or cells.shape[1] != NODES_PER_CELL[kind] or len(cells) == 0:
        raise MeshError(f"cells of kind {kind} need shape (m, {NODES_PER_CELL[kind]}), found {cells.shape}.")
    if cells.min() < 0 or cells.max() >= len(points):
        raise MeshError(f"a cell names node {cells.max()}, but there are {len(points)} nodes.")
    if region_of.shape != (len(cells),) or region_of.min() < 0 or region_of.max() >= len(regions):
        raise MeshError(f"region_of must give one of the {len(regions)} regions for each of the {len(cells)} cells.")

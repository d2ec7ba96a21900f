"""Write a mesh to a file: VTU for ParaView, MSH for gmsh and finite-element codes. The one door to meshio.

VTU: cell data "region" (number, from 0, in the order of ``mesh.regions``), and for every region one array of
its name that is 1 inside and 0 outside. MSH (format 2.2, which every reader knows): one named physical group per region, numbered from 1.

Interfaces come as faces after the volumes: in VTU with "region" -1 and "interface" their number (-1 for volumes), again with one
array for each name; in MSH as physical groups of dimension 2. An interface "a | b" is seen from a outwards; of a parted
mesh both sides are written, the other one as "b | a", with its own nodes and seen from b outwards.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh, SliceMesh, SweptCell
from geometry.doubled_nodes import FacePairs
from geometry.errors import MeshError
from geometry.interface import Interface

FORMATS = {".vtu": "vtu", ".msh": "gmsh22"}
Blocks = list[tuple[str, NDArray[np.int64], NDArray[np.int64]]]
"""Kind, cells, and the number of the group of each cell: regions first, then interfaces."""


def write_mesh(
    mesh: CrossSectionMesh | SliceMesh | SweptCell, path: str | Path, surfaces: Sequence[Interface | FacePairs] = ()
) -> Path:
    """Write a mesh with its regions; the ending of `path` chooses the format (.vtu, .msh).

    Parameters
    ----------
    surfaces : interfaces of the mesh, or the face pairs of a parted mesh, to be written with it

    Raises
    ------
    MeshError
        If the ending is not known or the file cannot be written.
    """
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        raise MeshError(
            f'a mesh cannot be written to "{path.name}": choose a name that ends in {" or ".join(FORMATS)}.'
        )
    import meshio

    dim = mesh.points.shape[1]
    points = mesh.points if dim == 3 else np.column_stack([mesh.points, np.zeros(len(mesh.points))])
    sides = _sides(surfaces)
    blocks: Blocks = [(block.kind, block.cells, block.region_of) for block in mesh.blocks]
    blocks += _surface_blocks(sides, len(mesh.regions))
    names = [region.name for region in mesh.regions] + [name for name, _ in sides]
    if FORMATS[path.suffix.lower()] == "vtu":
        data, groups = _vtu_data(blocks, names, len(mesh.regions)), {}
    else:
        tags: list[Any] = [(group + 1).astype(np.int32) for *_, group in blocks]
        data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
        dims = [dim] * len(mesh.regions) + [2] * len(sides)
        groups = {name: np.array([k + 1, d], dtype=np.int32) for k, (name, d) in enumerate(zip(names, dims))}
    content = meshio.Mesh(points, [(kind, cells) for kind, cells, _ in blocks], cell_data=data, field_data=groups)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        content.write(path, file_format=FORMATS[path.suffix.lower()])
    except (OSError, meshio.WriteError) as error:
        raise MeshError(f'the mesh cannot be written to "{path}": {error}.') from None
    return path


def _vtu_data(blocks: Blocks, names: list[str], regions: int) -> dict[str, Any]:
    group_of = [group for *_, group in blocks]
    data: dict[str, Any] = {"region": [np.where(g < regions, g, -1).astype(np.int32) for g in group_of]}
    if len(names) > regions:
        data["interface"] = [np.where(g < regions, -1, g - regions).astype(np.int32) for g in group_of]
    return data | {name: [(g == k).astype(np.uint8) for g in group_of] for k, name in enumerate(names)}


def _sides(surfaces: Sequence[Interface | FacePairs]) -> list[tuple[str, NDArray[np.int64]]]:
    """Names and faces; a parted interface has two sides."""
    found = []
    for surface in surfaces:
        if isinstance(surface, FacePairs):
            name = surface.interface.name
            found += [(name, surface.side_a), (" | ".join(name.split(" | ")[::-1]), surface.side_b[:, ::-1])]
        else:
            found.append((surface.name, surface.faces))
    return found


def _surface_blocks(sides: list[tuple[str, NDArray[np.int64]]], first: int) -> Blocks:
    """All faces as one block of quadrilaterals and one of triangles, whichever there are."""
    kinds: dict[str, list[tuple[NDArray[np.int64], NDArray[np.int64]]]] = {"quad": [], "triangle": []}
    for number, (_, faces) in enumerate(sides, start=first):
        repeated = np.sort(faces, axis=1)
        flat = (repeated[:, 1:] == repeated[:, :-1]).any(axis=1) | (faces.shape[1] == 3)
        kinds["quad"].append((faces[~flat], np.full(int((~flat).sum()), number)))
        corners = np.array([_triangle(face) for face in faces[flat]], dtype=np.int64).reshape(-1, 3)
        kinds["triangle"].append((corners, np.full(len(corners), number)))
    return [
        (kind, np.vstack([faces for faces, _ in found if len(faces)]), np.concatenate([group for _, group in found]))
        for kind, found in kinds.items()
        if any(len(faces) for faces, _ in found)
    ]


def _triangle(face: NDArray[np.int64]) -> list[int]:
    """The three different nodes in their order."""
    return list(dict.fromkeys(face.tolist()))

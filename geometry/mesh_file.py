"""Write a mesh to a file: VTU for ParaView, MSH for gmsh and finite-element codes. The one door to meshio.

VTU: cell data "region" (number, from 0, in the order of ``mesh.regions``), and for every region one array of
its name that is 1 inside and 0 outside. MSH (format 2.2, which every reader knows): one named physical group per region, numbered from 1.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from geometry.cell_mesh import CrossSectionMesh, SliceMesh
from geometry.errors import MeshError

FORMATS = {".vtu": "vtu", ".msh": "gmsh22"}


def write_mesh(mesh: CrossSectionMesh | SliceMesh, path: str | Path) -> Path:
    """Write a mesh with its regions; the ending of `path` chooses the format (.vtu, .msh).

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

    points = mesh.points if mesh.points.shape[1] == 3 else np.column_stack([mesh.points, np.zeros(len(mesh.points))])
    region = mesh.region_of.astype(np.int32)
    dim = mesh.points.shape[1]
    data: dict[str, list[Any]]
    if FORMATS[path.suffix.lower()] == "vtu":
        data = {"region": [region]}
        data |= {r.name: [(region == k).astype(np.uint8)] for k, r in enumerate(mesh.regions)}
        groups = {}
    else:
        data = {"gmsh:physical": [region + 1], "gmsh:geometrical": [region + 1]}
        groups = {r.name: np.array([k + 1, dim], dtype=np.int32) for k, r in enumerate(mesh.regions)}
    content = meshio.Mesh(points, [(mesh.cell_kind, mesh.cells)], cell_data=data, field_data=groups)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        content.write(path, file_format=FORMATS[path.suffix.lower()])
    except (OSError, meshio.WriteError) as error:
        raise MeshError(f'the mesh cannot be written to "{path}": {error}.') from None
    return path

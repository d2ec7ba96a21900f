"""Helical slice: the section mesh swept along the lay, z from 0 to a height.

Every layer is the section turned by twist_rate * z, so that the top face is the image of the bottom face, node for
node, under the helical motion. Triangles become wedges, quadrilaterals hexahedra. The height is free for axial load and
twist; bending in a fixed plane needs the full pitch.
"""

from __future__ import annotations

import numpy as np

from geometry.cell_mesh import CrossSectionMesh, SliceMesh
from geometry.errors import MeshError

SWEPT = {"triangle": "wedge", "quad": "hexahedron"}
LARGEST = 20_000_000


def helical_slice(section: CrossSectionMesh, height: float, layers: int) -> SliceMesh:
    """Sweep a section mesh along the lay.

    Parameters
    ----------
    section : CrossSectionMesh
        Of triangles or quadrilaterals (first order).
    height : float
        Height of the slice [m].
    layers : int
        Elements along z, at least 1.

    Returns
    -------
    SliceMesh
        ``bottom[i]`` and ``top[i]`` are partners under the helical motion.

    Raises
    ------
    MeshError
        If the section is of second order, height or layers are not positive, a layer turns by more than 30 degrees, or more
        than 20 million elements would result.
    """
    if section.cell_kind not in SWEPT:
        raise MeshError(
            f'a section of "{section.cell_kind}" cannot be swept: mesh it with "triangle" (wedges) or "quad" (hexahedra).'
        )
    if not (np.isfinite(height) and height > 0):
        raise MeshError(f"the height of a slice must be a positive length, found {height:g} m.")
    if isinstance(layers, bool) or layers != int(layers) or layers < 1:
        raise MeshError(f"the number of layers must be a whole number from 1, found {layers!r}.")
    layers = int(layers)
    if layers * len(section.cells) > LARGEST:
        raise MeshError(
            f"{layers} layers of {len(section.cells)} elements make {layers * len(section.cells):.2e} elements, more than {LARGEST:.0e}: "
            f"try at most {max(1, LARGEST // len(section.cells))} layers or a coarser section."
        )
    turn = abs(section.twist_rate) * height / layers
    if turn > np.pi / 6 * (1 + 1e-9):
        raise MeshError(
            f"each layer would turn by {np.degrees(turn):.0f} degrees: take at least "
            f"{int(np.ceil(6 * abs(section.twist_rate) * height / np.pi - 1e-9))} layers for this height."
        )
    n = len(section.points)
    z = np.linspace(0.0, height, layers + 1)
    c, s = np.cos(section.twist_rate * z)[:, None], np.sin(section.twist_rate * z)[:, None]
    x, y = section.points.T
    points = np.stack([c * x - s * y, s * x + c * y, np.broadcast_to(z[:, None], (layers + 1, n))], axis=-1).reshape(
        -1, 3
    )
    shift = n * np.arange(layers)[:, None, None]
    cells = np.concatenate([section.cells + shift, section.cells + shift + n], axis=2).reshape(
        layers * len(section.cells), -1
    )
    bottom = np.arange(n, dtype=np.int64)
    return SliceMesh(
        points=points,
        cells=cells,
        cell_kind=SWEPT[section.cell_kind],
        region_of=np.tile(section.region_of, layers),
        regions=section.regions,
        twist_rate=section.twist_rate,
        height=float(height),
        bottom=bottom,
        top=bottom + n * layers,
    )

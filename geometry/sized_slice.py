"""A helical slice of at least a given number of elements, and its record for machines."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable
from typing import Any

import numpy as np

from geometry.cable import Cable
from geometry.cell_mesh import SliceMesh
from geometry.errors import MeshError
from geometry.helical_slice import SWEPT, helical_slice
from geometry.mesh_quality import region_sizes, scaled_jacobian
from geometry.section_mesh import DEFAULT_SIZE, cross_section_mesh

logger = logging.getLogger(__name__)
LARGEST = 20_000_000
BYTES_PER_ELEMENT = 700
"""Measured peak of meshing, quality and export together, per hexahedron."""


def slice_of_size(
    cable: Cable,
    elements: int,
    height: float | None = None,
    cell_kind: str = "hexahedron",
    progress: Callable[[float, str], None] | None = None,
) -> SliceMesh:
    """Helical slice with at least `elements` volume elements.

    The section is refined until the layers are no thinner than a third of its edge length.

    Parameters
    ----------
    height : float or None
        Height of the slice [m]; None takes an eighth of the lay, or half the diameter of a straight cable.
    cell_kind : "hexahedron" (default) or "wedge"
    progress : called with (fraction, sentence)

    Raises
    ------
    MeshError
        If the number is not positive or larger than 20 million (with an estimate of the memory), or the kind unknown.
    """
    base = {swept: flat for flat, swept in SWEPT.items()}
    if cell_kind not in base:
        raise MeshError(f'a slice cannot be made of "{cell_kind}": choose hexahedron or wedge.')
    if isinstance(elements, bool) or elements != int(elements) or elements < 1:
        raise MeshError(f"the number of elements must be a whole number from 1, found {elements!r}.")
    if elements > LARGEST:
        raise MeshError(
            f"{elements:.2g} elements need about {elements * BYTES_PER_ELEMENT / 1e9:.0f} GB of memory; at most {LARGEST:.0e} are made: "
            "try fewer, for axial load and torsion 100000 are plenty."
        )
    if height is None:
        height = cable.outer_diameter / 2 if cable.lay is None else cable.lay / 8
    if not (np.isfinite(height) and height > 0):
        raise MeshError(f"the height of a slice must be a positive length, found {height:g} m.")
    size = cable.outer_diameter * DEFAULT_SIZE
    fewest = int(np.ceil(6 * abs(cable.twist_rate) * height / np.pi - 1e-9))
    for attempt in range(6):
        if progress:
            progress(0.15 * attempt, f"meshing the cross-section with edges of {1e3 * size:.2f} mm")
        section = cross_section_mesh(cable, size, base[cell_kind])
        layers = max(int(np.ceil(elements / len(section.cells))), int(np.ceil(height / (3 * size))), fewest, 1)
        thin = height / layers / size
        if thin >= 1 / 3 or layers == fewest:
            break
        size *= float(np.clip((2 * thin) ** (1 / 3), 0.5, 0.95))
    if progress:
        progress(0.95, f"sweeping {layers} layers of {len(section.cells)} elements")
    logger.info("section edges %.3g mm, %d layers of %d elements", 1e3 * size, layers, len(section.cells))
    return helical_slice(section, height, layers)


def slice_record(cable: Cable, mesh: SliceMesh, seconds: float) -> dict[str, Any]:
    """What the command ``helicable mesh`` reports, ready for JSON; SI units.

    `closed_form` is the exact volume of every region; `peak_memory` is that of the process [bytes], None where the system does
    not tell.
    """
    volumes = region_sizes(mesh)
    counted = {"hexahedron": "hexes", "wedge": "prisms"}[mesh.cell_kind]
    return {
        "schema": 1,
        "cable": cable.name,
        "elements": len(mesh.cells),
        "hexes": 0,
        "prisms": 0,
        "tets": 0,
        counted: len(mesh.cells),
        "nodes": len(mesh.points),
        "min_scaled_jacobian": float(scaled_jacobian(mesh).min()),
        "height": mesh.height,
        "matched_faces": bool(mesh.matching_gap() < 1e-9 * cable.outer_diameter),
        "regions": {
            region.name: {"volume": float(volume), "closed_form": float(region.closed_form_area * mesh.height)}
            for region, volume in zip(mesh.regions, volumes, strict=True)
        },
        "seconds": float(seconds),
        "peak_memory": _peak_memory(),
    }


def _peak_memory() -> int | None:
    try:
        import resource
    except ImportError:  # Windows
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return int(peak) if sys.platform == "darwin" else int(peak) * 1024

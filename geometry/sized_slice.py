"""A helical slice of at least a given number of elements, and its record for machines."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from geometry.cable import Cable
from geometry.cell_mesh import SliceMesh, SweptCell
from geometry.doubled_nodes import DoubledMesh
from geometry.errors import MeshError
from geometry.helical_slice import SWEPT, helical_slice
from geometry.interface import Interface, interfaces
from geometry.mesh_memory import check_element_count
from geometry.mesh_quality import quality_histogram, region_sizes, scaled_jacobian, share_below
from geometry.section_mesh import DEFAULT_SIZE, cross_section_mesh

if TYPE_CHECKING:
    from geometry.common_period import CommonPeriod

logger = logging.getLogger(__name__)
STEEPEST_LAYER = np.radians(5.0)
"""Largest turn of a layer: straight edges between turned layers lose a sixth of its square, 0.13 % of the volume."""
COUNTED = {"hexahedron": "hexes", "wedge": "prisms", "tetra": "tets", "pyramid": "pyramids"}


def slice_of_size(
    cable: Cable,
    elements: int,
    height: float | None = None,
    cell_kind: str = "hexahedron",
    progress: Callable[[float, str], None] | None = None,
) -> SliceMesh:
    """Helical slice with at least `elements` volume elements.

    The section is refined until the layers are no thinner than a third of its edge length. No layer turns by more than 5 degrees.

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
    elements = check_element_count(elements)
    if height is None:
        height = cable.outer_diameter / 2 if cable.lay is None else cable.lay / 8
    if not (np.isfinite(height) and height > 0):
        raise MeshError(f"the height of a slice must be a positive length, found {height:g} m.")
    size = cable.outer_diameter * DEFAULT_SIZE
    fewest = max(1, int(np.ceil(abs(cable.twist_rate) * height / STEEPEST_LAYER - 1e-9)))
    for attempt in range(6):
        if progress:
            progress(0.15 * attempt, f"meshing the cross-section with edges of {1e3 * size:.2f} mm")
        section = cross_section_mesh(cable, size, base[cell_kind])
        layers = max(int(np.ceil(elements / len(section.cells))), int(np.ceil(height / (3 * size))), fewest)
        thin = height / layers / size
        if thin >= 1 / 3 or layers == fewest:
            break
        size *= float(np.clip((2 * thin) ** (1 / 3), 0.5, 0.95))
    if progress:
        progress(0.95, f"sweeping {layers} layers of {len(section.cells)} elements")
    logger.info("section edges %.3g mm, %d layers of %d elements", 1e3 * size, layers, len(section.cells))
    return helical_slice(section, height, layers)


def slice_record(
    cable: Cable,
    mesh: SliceMesh | SweptCell | DoubledMesh,
    seconds: float,
    period: CommonPeriod | None = None,
) -> dict[str, Any]:
    """What the command ``helicable mesh`` reports, ready for JSON; SI units.

    Parameters
    ----------
    mesh : slice, cell, or either parted along interfaces, which then are listed as `separated` with their areas too
    seconds : that it took
    period : of a cell with several lays; they are listed as `lays`, nominal and adjusted, angles in rad

    Returns
    -------
    dict
        `closed_form` is the exact volume of every region, `interfaces` the areas by the kinds of their sides, `quality` the
        histogram of the scaled Jacobian (its first bin holds elements inside out), `peak_memory` that of the process [bytes],
        None where the system does not tell.
    """
    parted = [pair.interface for pair in mesh.pairs] if isinstance(mesh, DoubledMesh) else []
    mesh = mesh.mesh if isinstance(mesh, DoubledMesh) else mesh
    quality = scaled_jacobian(mesh)
    counts, edges = quality_histogram(quality)
    record = {
        "schema": 1,
        "cable": cable.name,
        "elements": len(quality),
        **{
            name: sum(len(block.cells) for block in mesh.blocks if block.kind == kind) for kind, name in COUNTED.items()
        },
        "nodes": len(mesh.points),
        "min_scaled_jacobian": float(quality.min()),
        "quality": {"histogram": counts.tolist(), "edges": edges.tolist(), "below_0.2": share_below(quality, 0.2)},
        "height": mesh.height,
        "matched_faces": bool(mesh.matching_gap() < 1e-9 * cable.outer_diameter),
        "regions": {
            region.name: {"volume": float(volume), "closed_form": float(region.closed_form_area * mesh.height)}
            for region, volume in zip(mesh.regions, region_sizes(mesh), strict=True)
        },
        "notes": list(getattr(mesh, "notes", ())),
        "interfaces": _areas([*interfaces(mesh), *parted]),
        "separated": _areas(parted),
        "seconds": float(seconds),
        "peak_memory": _peak_memory(),
    }
    return record if period is None else record | {"lays": [_lay(layer) for layer in period.layers]}


def _areas(found: list[Interface]) -> dict[str, float]:
    """Area [m^2] by the kinds of the two sides, "strand-insulation"."""
    areas: dict[str, float] = {}
    for interface in found:
        name = "-".join(interface.kinds)
        areas[name] = areas.get(name, 0.0) + interface.area
    return areas


def _lay(layer: Any) -> dict[str, Any]:
    """A matched lay of the period."""
    nominal = layer.nominal
    return {
        "name": layer.name,
        "fold": layer.fold,
        "turns": layer.turns,
        "hand": layer.hand,
        "nominal_lay": nominal.lay,
        "lay": layer.lay,
        "nominal_lay_angle": float(nominal.lay_angle),
        "lay_angle": float(layer.lay_angle),
        "change": float(layer.change),
    }


def _peak_memory() -> int | None:
    try:
        import resource
    except ImportError:  # Windows
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return int(peak) if sys.platform == "darwin" else int(peak) * 1024

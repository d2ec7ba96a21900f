r"""Section of everything but the stranded conductors: quadrilaterals with a round hole for each of them.

A hole of radius R stands about every stranded conductor, in the layer round it. Its N nodes are put where the slip ring wants them
(slip_ring.py): on the trace of the tube of radius R at the angles phi_j of

.. math::  \phi_j - \omega R s \sin\phi_j = 2 \pi j / N .
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from geometry.cable import Cable, Part, ring_moments
from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import MeshError
from geometry.mesh_quality import scaled_jacobian
from geometry.section_mesh import cross_section_mesh
from geometry.slip_ring import kepler_angle


@dataclass(frozen=True)
class Hole:
    """Hole round a conductor: `radius` [m] in its normal planes, number of `nodes` (even), and the `turn_rate` omega [rad/m]
    of the strands against the frame of their core."""

    radius: float
    nodes: int
    turn_rate: float


@dataclass(frozen=True)
class HostSection:
    """Section with holes: `mesh`, with the regions of the cable (those of the holes have no cells), and the node numbers
    round every hole, anticlockwise from phi = 0, by the name of the conductor's part."""

    mesh: CrossSectionMesh
    rings: Mapping[str, NDArray[np.int64]]


def layer_round(cable: Cable, conductor: Part) -> Part:
    """The layer in which the slip ring of a conductor runs.

    Raises
    ------
    MeshError
        If the conductor is bare.
    """
    for part in cable.parts:
        if part.member == conductor.member and part.inner_radius == conductor.outer_radius:
            return part
    raise MeshError(
        f"{conductor.name} has strands but no layer round it, in which they could turn against the rest of the cable: "
        "give it an insulation or a cover."
    )


def host_section(cable: Cable, holes: Mapping[str, Hole], size: float | None = None) -> HostSection:
    """Mesh the section z = 0 of a cable without its stranded conductors.

    Parameters
    ----------
    holes : by name of the conductor's part
    size : edge length in the bulk [m], as for ``cross_section_mesh``

    Raises
    ------
    MeshError
        If a hole does not lie inside the layer round its conductor, has an odd number of nodes, or gmsh fails.
    """
    for name, hole in holes.items():
        conductor = cable.part(name)
        layer = layer_round(cable, conductor)
        if not conductor.outer_radius < hole.radius < layer.outer_radius:
            raise MeshError(
                f"the hole round {name} must have a radius between {1e3 * conductor.outer_radius:.4g} and "
                f"{1e3 * layer.outer_radius:.4g} mm, found {1e3 * hole.radius:.4g} mm."
            )
        if hole.nodes < 4 or hole.nodes % 2:
            raise MeshError(f"the hole round {name} needs an even number of nodes from 4, found {hole.nodes}.")
    widened = _widened(cable, holes)
    angles = {name: _node_angles(cable.part(name), hole) for name, hole in holes.items()}
    mesh = cross_section_mesh(widened, size, "quad", {name: phi[::2] for name, phi in angles.items()})
    points, rings = mesh.points.copy(), {}
    for name in holes:
        rings[name] = _ring_nodes(mesh, widened.part(name), angles[name])
        points[rings[name]] = widened.part(name).outer_trace.point(angles[name])
    regions = tuple(
        replace(region, closed_form_area=part.area) for region, part in zip(mesh.regions, cable.parts, strict=True)
    )
    mesh = replace(mesh, points=points, regions=regions)
    if scaled_jacobian(mesh).min() <= 0:
        raise MeshError("an element beside a slip ring is turned inside out: try a smaller size.")
    return HostSection(mesh, rings)


def _widened(cable: Cable, holes: Mapping[str, Hole]) -> Cable:
    """The cable with its stranded conductors widened to the holes, at the cost of the layers round them."""

    def resized(part: Part, inner: float, outer: float) -> Part:
        moments = ring_moments(part.centre_radius, part.phase, inner, outer, part.twist_rate)
        return replace(part, inner_radius=inner, outer_radius=outer, moments=tuple(moments.tolist()))

    parts = {part.name: part for part in cable.parts}
    for name, hole in holes.items():
        layer = layer_round(cable, parts[name])
        parts[layer.name] = resized(layer, hole.radius, layer.outer_radius)
        parts[name] = resized(parts[name], 0.0, hole.radius)
    return replace(cable, parts=tuple(parts.values()))


def _node_angles(conductor: Part, hole: Hole) -> NDArray[np.float64]:
    """Angles phi of the nodes round a hole, from 0, growing within one turn."""
    eccentricity = hole.turn_rate * hole.radius * np.sin(conductor.outer_trace.lay_angle)
    return kepler_angle(2 * np.pi * np.arange(hole.nodes) / hole.nodes, eccentricity)


def _ring_nodes(mesh: CrossSectionMesh, conductor: Part, angles: NDArray[np.float64]) -> NDArray[np.int64]:
    """Nodes round a hole in the order of `angles`, from which they may be a little away."""
    free = _free_nodes(mesh)
    spots = conductor.outer_trace.point(angles)
    distance = np.linalg.norm(mesh.points[free] - spots[:, None], axis=2)
    nearest = distance.argmin(axis=1)
    edge = np.linalg.norm(np.diff(spots, axis=0), axis=1).min()
    if distance.min(axis=1).max() > 0.25 * edge or len(np.unique(nearest)) < len(angles):
        raise MeshError(f"gmsh has not put {len(angles)} nodes round {conductor.name}: try another size.")
    return free[nearest]


def _free_nodes(mesh: CrossSectionMesh) -> NDArray[np.int64]:
    """Nodes on edges of one quadrilateral only."""
    edges = np.sort(mesh.cells[:, [0, 1, 1, 2, 2, 3, 3, 0]].reshape(-1, 2), axis=1)
    found, count = np.unique(edges, axis=0, return_counts=True)
    return np.unique(found[count == 1])

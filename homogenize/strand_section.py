r"""A stranded conductor by itself: the section of its strands, and its stiffness as a beam.

The strands are cylinders about helices of the rope lay; one plane section, turned, is the whole conductor, so that the helical cell
(:mod:`homogenize.helical_cell`) gives its 6x6. The mesh is that of the cell of the cable with all its strands
(geometry.conductor_section), each quadrilateral cut in four triangles at its middle, so that both have the same lines of contact.
Strands are bonded there, or they slide without friction and without opening. Straight strands that slide share the strain and
nothing else, in closed form

.. math:: EA = \sum E A_i, \quad EI = \sum E I_i, \quad GJ = \sum G J_i, \quad GA = \sum k G A_i, \quad
          1/k = \tfrac76 + \tfrac16 \left(\tfrac{\nu}{1+\nu}\right)^2 .

(k: shear coefficient of the circle by energy, as the helical cell has it.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry import Conductor, CrossSectionMesh, Material, Region, conductor_section
from geometry.errors import SpecError
from geometry.helix import HANDS
from geometry.nested_plan import ring_nodes
from homogenize.helical_cell import INTERFACES, solve_helical_cell
from homogenize.section_stiffness import SectionStiffness, pitch_average

DEFAULT_SIZE = 0.3
"""Distance of nodes on the outline of a strand over its radius."""


@dataclass(frozen=True)
class StrandSection:
    """A conductor as a rope of strands: its mesh (None where the closed form serves), 6x6, and how the strands hold together."""

    conductor: Conductor
    mesh: CrossSectionMesh | None
    stiffness: SectionStiffness
    strands: str


def turn_rate(conductor: Conductor) -> float:
    """2 pi / lay of the strands [rad/m], signed; zero for straight strands."""
    return 0.0 if conductor.lay is None else HANDS[conductor.hand] * 2 * np.pi / conductor.lay


def strand_section(conductor: Conductor, strands: str = "bonded", size: float | None = None) -> StrandSection:
    """Section stiffness of a bare conductor of strands, averaged over its lay.

    Parameters
    ----------
    conductor : Conductor
        With `strand` and `layers`.
    strands : str
        ``"bonded"`` or ``"frictionless"``.
    size : float, optional
        Distance of nodes on a strand [m]; three tenths of its radius if not given.

    Raises
    ------
    SpecError
        If the conductor has no strands, or the interface is not known.
    MeshError, GeometryError
        If the strands do not fit.

    Examples
    --------
    >>> from geometry import read_cable
    >>> earth = strand_section(read_cable("mcpt-1.9-3.3-3x35").conductors["earth"], "frictionless")
    >>> round(earth.stiffness.EA_blocked_twist / 1e6, 3)
    1.714
    """
    if strands not in INTERFACES:
        raise SpecError(f'strands "{strands}" is not known; choose {" or ".join(INTERFACES)}.')
    strand = conductor.strand
    if strand is None or sum(conductor.layers) < 2:
        raise SpecError(f"conductor {conductor.name} is given as one cylinder: there are no strands to put together.")
    if strands == "frictionless" and turn_rate(conductor) == 0:
        return StrandSection(conductor, None, _straight_and_free(conductor), strands)
    mesh = strand_mesh(conductor, size)
    cell = solve_helical_cell(mesh, strands)
    C = pitch_average(cell.stiffness).C
    return StrandSection(conductor, mesh, SectionStiffness(C, conductor.area), strands)


def strand_mesh(conductor: Conductor, size: float | None = None) -> CrossSectionMesh:
    """Triangles of the strands of a conductor, one region a strand; then of what fills its voids, if anything does."""
    strand = conductor.strand
    assert strand is not None
    radius, rate = strand.diameter / 2, turn_rate(conductor)
    size = DEFAULT_SIZE * radius if size is None else size
    nodes = ring_nodes(conductor, size, conductor.diameter)
    filled = conductor.voids is not None
    section = conductor_section(
        conductor.layers, radius, conductor.diameter / 2, rate, nodes, size, conductor.flat_width, filled
    )
    material = Material(f"{strand.name} strand", strand.E, strand.nu, strand.density * strand.lay_factor)
    regions = tuple(
        Region(f"strand {k + 1}", "conductor", material, float(np.pi * radius**2 * np.hypot(1, rate * p.centre_radius)))
        for k, p in enumerate(section.strands)
    )
    region_of = np.repeat(section.strand_of, 4)
    if conductor.voids is not None:
        region_of = np.concatenate([region_of, np.full(len(section.void_cells), len(regions))])
        area = conductor.area - sum(region.closed_form_area for region in regions)
        regions = (*regions, Region("voids", "interstices", conductor.voids, float(area)))
    points, cells = quadratic_triangles(section.points, section.cells, section.void_cells)
    return CrossSectionMesh(points, cells, "triangle6", region_of, regions, rate)


def quadratic_triangles(
    points: NDArray, quads: NDArray[np.int64], others: NDArray[np.int64]
) -> tuple[NDArray, NDArray[np.int64]]:
    """Six-node triangles with straight edges, four for each quadrilateral (m, 4), then one for each of the `others` (t, 3)."""
    middle = len(points) + np.arange(len(quads))
    sides = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1)
    triangles = np.concatenate([sides, np.broadcast_to(middle[:, None, None], (len(quads), 4, 1))], axis=-1)
    used, corners = np.unique(np.concatenate([triangles.reshape(-1, 3), others]), return_inverse=True)
    points, corners = np.concatenate([points, points[quads].mean(axis=1)])[used], corners.reshape(-1, 3)
    edges = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    unique, number = np.unique(edges, axis=0, return_inverse=True)
    cells = np.concatenate([corners, len(points) + number.reshape(-1, 3)], axis=1)
    return np.concatenate([points, points[unique].mean(axis=1)]), cells.astype(np.int64)


def _straight_and_free(conductor: Conductor) -> SectionStiffness:
    strand, count = conductor.strand, sum(conductor.layers)
    assert strand is not None
    G, second = strand.E / (2 * (1 + strand.nu)), np.pi * strand.diameter**4 / 64
    shear = G * strand.area / (7 / 6 + (strand.nu / (1 + strand.nu)) ** 2 / 6)
    return SectionStiffness.uncoupled(
        EA=count * strand.E * strand.area,
        GA_x=count * shear,
        GA_y=count * shear,
        EI_x=count * strand.E * second,
        EI_y=count * strand.E * second,
        GJ=count * 2 * G * second,
        area=conductor.area,
    )

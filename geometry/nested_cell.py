r"""Cell of a cable with stranded conductors: strands on double helices, meshed with hexahedra over a common period.

Two kinds of sweeps are joined. The host, all parts but the strands, is a section of quadrilaterals swept along the
cabling lay (host_section.py). Each conductor is a section of its strands swept along its core while it turns
(turning_conductor.py). Between them runs a slip ring (slip_ring.py), part of the insulation or cover. Over the period H
(common_period.py) a conductor turns by a whole multiple of its rotational symmetry, so that the end faces match,
strand i continuing as another strand.

The exact volume of a strand of radius rho is pi rho^2 times the arc length of its centre line (Pappus), given as area = volume / H.
The voids between the strands are empty, or filled with wedges of the material that the cable file names.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.cable import Cable, Part
from geometry.cell_mesh import CellBlock, Region, SweptCell
from geometry.host_section import HostSection
from geometry.material import Material
from geometry.nested_plan import NestedPlan, plan_of_cell
from geometry.slip_ring import SlipRing, slip_ring
from geometry.turning_conductor import TurningConductor

logger = logging.getLogger(__name__)
Progress = Callable[[float, str], None]


def nested_cell(
    cable: Cable,
    elements: int | None = None,
    size: float | None = None,
    height: float | None = None,
    layers: int | None = None,
    lay_tolerance: float | None = None,
    flat_width: float | None = None,
    progress: Progress | None = None,
) -> SweptCell:
    """Mesh a cable with all its strands over a common period of its lays.

    Parameters
    ----------
    elements : at least so many hexahedra; None leaves the number to `size` and `layers`
    size : edge length in the bulk of the section [m]; None takes what `elements` asks for, or 1/26 of the outer diameter
    height : height [m], a whole multiple of the common period; None takes the period, where every height is one an
        eighth of the lay (half the diameter of a straight cable)
    layers : elements along z; None takes layers about as high as the section's elements are wide
    lay_tolerance : largest change of a lay angle [rad] that may be made to have a common period; None takes half a degree
    flat_width : width [m] of the flats on which strands touch each other, of all conductors; None takes what the cable file says, or
        0.3 strand radii (strand_contact.py). The mesh keeps it as soon as its edges are short enough; `notes` of the cell tell.
    progress : called with (fraction, sentence)

    Returns
    -------
    SweptCell
        Regions "power core 1 strand 1" .. of the kind "strand" instead of the stranded conductors, all others as the parts of the cable;
        "power core 1 voids" of the kind "interstices" where voids are filled.

    Raises
    ------
    GeometryError
        If the lays have no common period within the tolerance.
    MeshError
        If the height is not a period, a stranded conductor is bare, a number is not usable, or more than 20 million elements would result.
    """
    plan = plan_of_cell(cable, elements, size, height, layers, lay_tolerance, progress, flat_width)
    if progress:
        progress(0.8, f"sweeping {plan.layers} layers of {plan.cells_per_layer} elements")
    cell = _Builder(cable, plan).cell()
    logger.info("%d hexahedra in %d layers, cell of %.4g mm", cell.count("hexahedron"), plan.layers, 1e3 * plan.height)
    for conductor in plan.conductors:
        if not conductor.section.flats_as_wanted:
            logger.warning("%s", conductor.section.flat_sentence(conductor.part.name))
    return cell


@dataclass(frozen=True)
class _Builder:
    """Numbers the nodes: every plane has those of the host, then those of the conductors; the rings' own nodes come last."""

    cable: Cable
    plan: NestedPlan

    @property
    def host(self) -> HostSection:
        return self.plan.host

    @property
    def z(self) -> NDArray[np.float64]:
        return np.linspace(0.0, self.plan.height, self.plan.layers + 1)

    @property
    def starts(self) -> NDArray[np.int64]:
        """First node of the host and of each conductor in a plane, and the number of nodes in a plane."""
        counts = [len(self.host.mesh.points)] + [len(c.section.points) for c in self.plan.conductors]
        return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)

    def cell(self) -> SweptCell:
        regions, host_region, strand_regions = regions_of_cell(self.cable, self.plan.conductors, self.plan.height)
        starts, mesh = self.starts, self.host.mesh
        swept = [(mesh.cells, host_region[mesh.region_of])]
        filled: list[tuple[NDArray[np.int64], NDArray[np.int64]]] = []
        rings, first = [], int(starts[-1]) * (self.plan.layers + 1)
        for c, start, strands in zip(self.plan.conductors, starts[1:-1], strand_regions, strict=True):
            swept.append((c.section.cells + start, strands[c.section.strand_of]))
            filled.append((c.section.void_cells + start, np.full(len(c.section.void_cells), strands[-1])))
            ring = self._ring(c, int(start), first)
            rings.append((ring, int(host_region[self._layer_number(c)])))
            first += len(ring.divided)
        planes = np.concatenate([self._host_nodes()] + [c.nodes(self.z) for c in self.plan.conductors], axis=1)
        points = planes.reshape(-1, 3)
        points = np.concatenate([points] + [points[ring.divided].mean(axis=1) for ring, _ in rings])
        bottom, top = self._partners()
        notes = tuple(c.section.flat_sentence(c.part.name) for c in self.plan.conductors)
        return SweptCell(
            points,
            tuple(self._blocks(swept, filled, rings)),
            regions,
            mesh.twist_rate,
            self.plan.height,
            bottom,
            top,
            notes,
        )

    def _layer_number(self, conductor: TurningConductor) -> int:
        names = [part.name for part in self.cable.parts]
        return names.index(conductor.layer_name)

    def _host_nodes(self) -> NDArray[np.float64]:
        mesh, z = self.host.mesh, self.z
        x, y = mesh.points.T
        cos, sin = np.cos(mesh.twist_rate * z)[:, None], np.sin(mesh.twist_rate * z)[:, None]
        return np.stack([cos * x - sin * y, sin * x + cos * y, np.broadcast_to(z[:, None], (len(z), len(x)))], axis=-1)

    def _ring(self, conductor: TurningConductor, start: int, first: int) -> SlipRing:
        planes = self.starts[-1] * np.arange(self.plan.layers + 1)[:, None]
        inner = planes + start + conductor.section.ring
        outer = planes + self.host.rings[conductor.part.name]
        return slip_ring(inner, outer, conductor.steps(self.plan.height), first)

    def _blocks(
        self,
        swept: list[tuple[NDArray[np.int64], NDArray[np.int64]]],
        filled: list[tuple[NDArray[np.int64], NDArray[np.int64]]],
        rings: list[tuple[SlipRing, int]],
    ) -> list[CellBlock]:
        found = []
        for kind, name in (
            ("hexahedron", "hexahedra"),
            ("wedge", ""),
            ("pyramid", "pyramids"),
            ("tetra", "tetrahedra"),
        ):
            pieces = [
                (getattr(ring, name), np.full(len(getattr(ring, name)), region)) for ring, region in rings if name
            ]
            own = {"hexahedron": swept, "wedge": filled}.get(kind, [])
            pieces = ([self._swept(own)] if own else []) + pieces
            if sum(len(cells) for cells, _ in pieces):
                cells, numbers = (np.concatenate(parts) for parts in zip(*pieces, strict=True))
                found.append(CellBlock(kind, cells, numbers.astype(np.int64)))
        return found

    def _swept(
        self, flat: list[tuple[NDArray[np.int64], NDArray[np.int64]]]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Cells between the planes over the cells of a plane, and their regions."""
        layers, stride = self.plan.layers, int(self.starts[-1])
        cells = np.concatenate([cells for cells, _ in flat])
        shift = stride * np.arange(layers)[:, None, None]
        solid = np.concatenate([cells + shift, cells + shift + stride], axis=2)
        return solid.reshape(-1, solid.shape[2]), np.tile(np.concatenate([region for _, region in flat]), layers)

    def _partners(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        starts = self.starts
        top = np.arange(starts[-1], dtype=np.int64)
        bottom = top.copy()
        for c, start in zip(self.plan.conductors, starts[1:-1], strict=True):
            bottom[start : start + len(c.section.points)] = start + c.partners(self.plan.height)
        return bottom, top + starts[-1] * self.plan.layers


def regions_of_cell(
    cable: Cable, conductors: tuple[TurningConductor, ...], height: float
) -> tuple[tuple[Region, ...], NDArray[np.int64], list[NDArray[np.int64]]]:
    """Regions; the region of every part of the cable (-1 for stranded conductors); those of the strands of each conductor, that
    of its voids last if they are filled."""
    turning = {c.part.name: c for c in conductors}
    regions: list[Region] = []
    of_part, of_strands = np.full(len(cable.parts), -1, dtype=np.int64), {}
    for number, part in enumerate(cable.parts):
        if part.name not in turning:
            of_part[number] = len(regions)
            regions.append(Region(part.name, part.kind, part.material, part.area))
            continue
        conductor = turning[part.name]
        areas = conductor.strand_areas(height)
        of_strands[part.name] = np.arange(len(regions), len(regions) + len(areas))
        material = strand_material(part, conductor)
        regions += [
            Region(f"{part.member} strand {k + 1}", "strand", material, float(area)) for k, area in enumerate(areas)
        ]
        if conductor.make_up.voids is not None:
            of_strands[part.name] = np.append(of_strands[part.name], len(regions))
            void = float(part.area - areas.sum())
            regions.append(Region(f"{part.member} voids", "interstices", conductor.make_up.voids, void))
    return tuple(regions), of_part, [of_strands[c.part.name] for c in conductors]


def strand_material(part: Part, conductor: TurningConductor) -> Material:
    """A strand as a cylinder: its modulus, and the density that gives its true mass, lay of the wires included."""
    strand = conductor.make_up.strand
    assert strand is not None
    return Material(f"{conductor.make_up.name} strand", strand.E, strand.nu, strand.density * strand.lay_factor)

r"""Quadrilaterals of a stranded conductor in the plane normal to its axis, in the frame that turns with its strands.

A strand of radius rho about the helix of radius r appears as the exact trace of a round wire (wire_trace.py), of area

.. math::  A = \pi \rho^2 / \cos\beta_2, \qquad \beta_2 = \arctan(\omega r),

omega the turn rate of the strands. Strands touch along lines, which a mesh that holds together cannot show: they share narrow
flats of a stated width instead (strand_contact.py), and the outermost share edges with the circle about the conductor. The rest
of the outline follows the trace, moved outwards evenly until the polygon has the area A exactly; metal that a flat takes away
thus reappears beside it. The ring about the conductor is a polygon of N nodes with the area of its circle,

.. math::  R_N^2 = R^2 \frac{2\pi/N}{\sin(2\pi/N)} .

The voids between the strands stay empty, or are filled with triangles (strand_void.py). The section is built from the strands of
one sector and turned by 2 pi / fold, so that it maps on itself node for node; fold is the greatest common divisor of the layers, a
single centre strand apart.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from geometry.disc_grid import disc_grid, node_multiple
from geometry.errors import GeometryError, MeshError
from geometry.strand import layer_radii
from geometry.strand_contact import (
    FLAT,
    NARROWEST,
    REACH,
    RING,
    WIDEST,
    Contact,
    StrandPlace,
    centre_of,
    find_contacts,
    turned,
)
from geometry.strand_outline import StrandOutline, run_into, strand_outline
from geometry.strand_void import fill_voids
from geometry.wire_trace import WireTrace

MISFIT = 0.03
"""Largest misfit of a stated conductor radius, as a fraction of the radius over the strands."""
PATCH = 0.8
"""Longest distance of ring nodes over the strand radius: longer ones stand off the strand by a fifth of its radius."""
COARSEST = 0.6
"""Largest distance of the nodes on a strand over its radius."""
FLAT_MISFIT = 0.01
"""Largest difference of a flat's width from the one that was asked for that is not told."""
FINER = (1.0, 0.7, 0.5)
"""Fractions of the wanted distance that are tried in turn until the outlines are clear of each other."""


@dataclass(frozen=True)
class ConductorSection:
    """Quadrilateral mesh of the strands of a conductor.

    Attributes
    ----------
    points : (n, 2) [m]
    cells : (m, 4) node numbers, counter-clockwise
    strand_of : (m,) strand number: from the inside, counter-clockwise from angle 0 in each layer
    ring : (N,) nodes of the circle about the conductor at the angles 2 pi j / N; some belong to no cell
    fold : the section maps on itself, node for node, when turned by 2 pi / fold
    strands : place of each strand; `radius` is the stated one, `centre_radius` as it is used
    contacts : pairs of strand numbers that share edges, the smaller first; (-1, b) for a strand on the ring
    conductor_radius : R [m]
    strand_scale : conductor radius over the radius over its strands; the pattern was scaled by it, the areas were not
    closed_gap : widest gap [m] between two traces that was closed to a contact; negative if all of them overlap
    flat_width : width [m] of the flats that strands share; 0 for a single strand
    flat_wanted : the width that was asked for, or follows from the strand radius [m]
    edge : distance of the nodes on a strand [m]
    void_cells : (t, 3) triangles in the voids, counter-clockwise; none if they are empty
    """

    points: NDArray[np.float64]
    cells: NDArray[np.int64]
    strand_of: NDArray[np.int64]
    ring: NDArray[np.int64]
    fold: int
    strands: tuple[StrandPlace, ...]
    contacts: tuple[tuple[int, int], ...]
    conductor_radius: float
    strand_scale: float
    closed_gap: float
    flat_width: float = 0.0
    flat_wanted: float = 0.0
    edge: float = 0.0
    void_cells: NDArray[np.int64] = field(default_factory=lambda: np.empty((0, 3), dtype=np.int64))

    @property
    def flats_as_wanted(self) -> bool:
        """Whether the flats have the width that was asked for."""
        return abs(self.flat_width - self.flat_wanted) <= FLAT_MISFIT * self.flat_wanted

    def flat_sentence(self, name: str) -> str:
        """The width of the flats in words, and why it is not the one that was asked for."""
        used, wanted = 1e3 * self.flat_width, 1e3 * self.flat_wanted
        if self.flats_as_wanted:
            return f"{name}: strands touch each other on flats {used:.3g} mm wide."
        if self.flat_width > max(self.flat_wanted, 2 * NARROWEST * self.edge) * (1 + FLAT_MISFIT):
            return (
                f"{name}: strands overlap where they touch, so that flats of {used:.3g} mm are used, not {wanted:.3g} mm: make the strands "
                "thinner or lengthen their lay if they should be narrower."
            )
        if self.flat_width > self.flat_wanted:
            return (
                f"{name}: flats {wanted:.3g} mm wide between strands are too narrow for edges of {1e3 * self.edge:.3g} mm: "
                f"{used:.3g} mm is used; ask for more elements, or state a wider flat."
            )
        return f"{name}: flats {wanted:.3g} mm wide leave the strands no free surface between their contacts: {used:.3g} mm is used."


def conductor_section(
    layers: tuple[int, ...],
    strand_radius: float,
    conductor_radius: float,
    turn_rate: float,
    ring_nodes: int,
    size: float | None = None,
    flat_width: float | None = None,
    filled: bool = False,
) -> ConductorSection:
    """Mesh the strands of a conductor in the plane normal to its axis.

    Parameters
    ----------
    layers : strands in each layer from the inside, such as (1, 6); all have one lay
    strand_radius, conductor_radius : [m]; the conductor's may differ by up to 3 % from the radius over the strands
    turn_rate : 2 pi / lay per arc length of the conductor [rad/m], signed; 0 for straight strands
    ring_nodes : N, nodes of the circle about the conductor; even and a multiple of the fold
    size : distance [m] of the nodes on the outline of a strand; None takes that of the ring nodes. Values above 0.6 strand
        radii change nothing any more.
    flat_width : width [m] of the flats that touching strands share; None takes 0.3 strand radii. Hertz's width for a known force:
        line_contact.hertz_half_width.
    filled : mesh the voids between the strands as well, as `void_cells`

    Raises
    ------
    GeometryError
        If the strands do not fit into each other or into the conductor.
    MeshError
        If the number of ring nodes does not suit the strands.

    Examples
    --------
    >>> section = conductor_section((1, 6), 1.5e-3, 4.5e-3, 2 * np.pi / 0.127, 48)
    >>> section.fold, len(section.contacts)
    (6, 18)
    """
    if not (strand_radius > 0 and conductor_radius > 0):
        raise GeometryError(
            f"the radii of a conductor and of its strands must be positive, found {1e3 * conductor_radius:g} mm and "
            f"{1e3 * strand_radius:g} mm."
        )
    if not layers or min(layers) < 1:
        raise GeometryError(f"every layer of a conductor needs at least one strand, found the layers {layers}.")
    radii = layer_radii(layers, 2 * strand_radius, "conductor")
    scale = conductor_radius / (radii[-1] + strand_radius)
    if abs(scale - 1) > MISFIT:
        raise GeometryError(
            f"the {sum(layers)} strands of a conductor reach out to {1e3 * conductor_radius / scale:.4g} mm, but its radius is "
            f"stated as {1e3 * conductor_radius:.4g} mm ({100 * (scale - 1):+.1f} %): correct one of them."
        )
    fold = section_fold(layers, ring_nodes)
    _check_ring(ring_nodes, fold, conductor_radius, strand_radius * scale, sum(layers) == 1)
    size = 2 * np.pi * conductor_radius / ring_nodes if size is None else size
    if not size > 0:
        raise MeshError(f"the distance of the nodes on a strand must be positive, found {1e3 * size:g} mm.")
    wanted = 2 * FLAT * strand_radius if flat_width is None else flat_width
    if not 0 < wanted <= 2 * WIDEST * strand_radius:
        raise GeometryError(
            f"flats between strands of {2e3 * strand_radius:.4g} mm cannot be {1e3 * wanted:.4g} mm wide: state a width above zero "
            f"and up to {2e3 * WIDEST * strand_radius:.3g} mm."
        )
    ring = _ring(conductor_radius, ring_nodes)
    if sum(layers) == 1:
        return _whole_disc(ring, fold, conductor_radius, scale)
    places = tuple(
        StrandPlace(k, radius * scale, 2 * np.pi * i / count, strand_radius)
        for k, (count, radius) in enumerate(zip(layers, radii, strict=True))
        for i in range(count)
    )
    traces = [WireTrace(p.centre_radius, p.phase, p.radius * scale, turn_rate) for p in places]
    sector = _sector(layers, fold)
    contacts, outlines, edge = _fitting_outlines(places, traces, layers, sector, ring, size, wanted)
    points, cells, strand_of = _turned_copies(outlines, sector, places, fold, ring)
    found = fill_voids(points, cells, np.arange(ring_nodes), fold) if filled else None
    points, void_cells = (points, np.empty((0, 3), dtype=np.int64)) if found is None else found
    return ConductorSection(
        points=points,
        cells=cells,
        strand_of=strand_of,
        ring=np.arange(ring_nodes),
        fold=fold,
        strands=places,
        contacts=tuple(sorted((c.first, c.second) for c in contacts)),
        conductor_radius=conductor_radius,
        strand_scale=scale,
        closed_gap=max((c.gap for c in contacts if c.first != RING), default=0.0),
        flat_width=max(
            (float(np.linalg.norm(c.nodes[-1] - c.nodes[0])) for c in contacts if c.first != RING), default=0.0
        ),
        flat_wanted=wanted,
        edge=edge,
        void_cells=void_cells,
    )


def section_fold(layers: tuple[int, ...], ring_nodes: int) -> int:
    """Turns of 2 pi / fold map the section on itself; for a single strand, whose pattern must suit the ring, 6, 4, 5 or 3.

    >>> section_fold((1, 6, 12), 48), section_fold((3, 9, 15), 48), section_fold((1,), 32)
    (6, 3, 4)
    """
    if tuple(layers) == (1,):
        return next((k for k in (6, 4, 5, 3) if ring_nodes % node_multiple(k) == 0), 4)
    return math.gcd(*(layers[1:] if layers[0] == 1 else layers))


def _check_ring(ring_nodes: int, fold: int, conductor_radius: float, radius: float, single: bool) -> None:
    """Raise if the ring nodes do not suit the fold, or are too few for edges shared with the outer strands."""
    step = math.lcm(2, fold) if not single else node_multiple(fold)
    fewest = step * math.ceil(2 * np.pi * conductor_radius / (PATCH * radius) / step - 1e-9)
    if ring_nodes < 1 or ring_nodes % step:
        raise MeshError(
            f"the ring about a conductor whose strands repeat {fold} times a turn needs a number of nodes that is a multiple "
            f"of {step}, found {ring_nodes}: take {max(fewest, step * max(1, round(ring_nodes / step)))}."
        )
    if ring_nodes < fewest and not single:
        raise MeshError(
            f"{ring_nodes} nodes on the ring about a conductor of {1e3 * conductor_radius:.4g} mm are too far apart for edges "
            f"shared with strands of {1e3 * radius:.4g} mm: take at least {fewest}."
        )


def _ring(radius: float, count: int) -> NDArray[np.float64]:
    """Nodes of a polygon with the area of the circle."""
    step = 2 * np.pi / count
    angle = step * np.arange(count)
    return radius * np.sqrt(step / np.sin(step)) * np.column_stack([np.cos(angle), np.sin(angle)])


def _whole_disc(ring: NDArray[np.float64], fold: int, radius: float, scale: float) -> ConductorSection:
    grid = disc_grid(ring, fold)
    strand_of = np.zeros(len(grid.cells), dtype=np.int64)
    place = (StrandPlace(0, 0.0, 0.0, radius),)
    nodes = np.arange(len(ring))
    return ConductorSection(grid.points, grid.cells, strand_of, nodes, fold, place, ((RING, 0),), radius, scale, 0.0)


def _sector(layers: tuple[int, ...], fold: int) -> dict[int, list[int]]:
    """Strands of one sector, each with its images under turns of 0, 1, 2 ... times 2 pi / fold; the centre has but itself."""
    sector, start = {}, 0
    for layer in layers:
        if start == 0 and layer == 1:
            sector[0] = [0]
        else:
            share = layer // fold
            sector |= {start + k: [start + k + share * copy for copy in range(fold)] for k in range(share)}
        start += layer
    return sector


def _fitting_outlines(
    places: Sequence[StrandPlace],
    traces: Sequence[WireTrace],
    layers: tuple[int, ...],
    sector: dict[int, list[int]],
    ring: NDArray[np.float64],
    size: float,
    flat: float,
) -> tuple[list[Contact], dict[int, StrandOutline], float]:
    """Contacts, outlines of the strands of one sector, with finer edges where coarse ones run into each other, and their length."""
    fold = section_fold(layers, len(ring))
    size = min(size, COARSEST * traces[0].radius)
    for finer in FINER:
        contacts = find_contacts(places, traces, layers, fold, ring, finer * size, flat)
        outlines = {
            k: _outline(k, places[k], traces[k], contacts, _pattern(k, places, fold), finer * size) for k in sector
        }
        hit = _collision(outlines, sector, places, fold, ring)
        if hit is None:
            return contacts, outlines, finer * size
    raise MeshError(f"{hit}: take more ring nodes or a smaller size.")


def _pattern(strand: int, places: Sequence[StrandPlace], fold: int) -> int:
    """Sectors of the disc grid of a strand: the square, but in the centre one that has the symmetry of the section."""
    return fold if places[strand].centre_radius == 0 and fold not in (1, 2, 4) else 4


def _outline(
    strand: int, place: StrandPlace, trace: WireTrace, contacts: Sequence[Contact], pattern: int, size: float
) -> StrandOutline:
    exact_area = WireTrace(place.centre_radius, place.phase, place.radius, trace.twist_rate).area
    touching = [c for c in contacts if strand in (c.first, c.second)]
    return strand_outline(strand, trace, touching, exact_area, node_multiple(pattern), size)


def _collision(
    outlines: dict[int, StrandOutline],
    sector: dict[int, list[int]],
    places: Sequence[StrandPlace],
    fold: int,
    ring: NDArray[np.float64],
) -> str | None:
    """The first strand with a free node inside a neighbour or outside the ring, in words; None if there is none."""
    radius = places[0].radius
    for strand, outline in outlines.items():
        free = outline.nodes[outline.free]
        name = f"strand {strand} of a conductor, as a polygon of {len(outline.nodes)} nodes, runs into"
        if not run_into(free, ring).all():
            return f"{name} the ring"
        for other, images in sector.items():
            for copy, image in enumerate(images):
                apart = float(np.linalg.norm(centre_of(places[image]) - centre_of(places[strand])))
                near = image != strand and apart < REACH * radius
                if near and run_into(free, turned(outlines[other].nodes, 2 * np.pi * copy / fold)).any():
                    return f"{name} strand {image}"
    return None


def _turned_copies(
    outlines: dict[int, StrandOutline],
    sector: dict[int, list[int]],
    places: Sequence[StrandPlace],
    fold: int,
    ring: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
    """Points (the ring first), cells, and the strand of each cell: the strands of one sector meshed and turned into place."""
    points, cells, strand_of, count = [ring], [], [], len(ring)
    for strand, images in sector.items():
        try:
            grid = disc_grid(outlines[strand].nodes, _pattern(strand, places, fold))
        except MeshError as error:
            raise MeshError(f"strand {strand} of a conductor: {error}") from error
        for copy, image in enumerate(images):
            points.append(turned(grid.points, 2 * np.pi * copy / fold))
            cells.append(grid.cells + count)
            strand_of.append(np.full(len(grid.cells), image))
            count += len(grid.points)
    merged, number = _merged(np.vstack(points), 1e-6 * places[0].radius)
    return merged, number[np.vstack(cells)], np.concatenate(strand_of)


def _merged(points: NDArray[np.float64], tolerance: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Points without repetition, and the new number of each; the first of several is kept."""
    from scipy.spatial import KDTree  # slow to load, needed here only

    first = np.arange(len(points))
    for i, j in sorted(KDTree(points).query_pairs(tolerance)):
        first[j] = min(first[j], first[i])
    kept, number = np.unique(first, return_inverse=True)
    return points[kept], number.astype(np.int64)

"""Sections with known answers, meshed without gmsh: rectangle, rings, wires on their exact traces, slices of them.

Rings and wires are six-node triangles whose edges are curved on the interfaces and straight inside.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

import numpy as np

from geometry.cell_mesh import CrossSectionMesh, Region, SliceMesh
from geometry.material import Material
from geometry.wire_trace import WireTrace
from homogenize.strand_theory import Strand16

Constants = tuple[float, float]
Shape = Callable[[float, float], tuple[float, float]]


def regions(*constants: Constants) -> tuple[Region, ...]:
    """One region for each (E [Pa], nu)."""
    return tuple(
        Region(f"part {i}", "conductor", Material(f"m{i}", E, nu, 1000.0), float("nan"))
        for i, (E, nu) in enumerate(constants)
    )


def rectangle(
    nx: int,
    ny: int,
    width: float,
    height: float,
    *constants: Constants,
    split_x: float | None = None,
    twist_rate: float = 0.0,
) -> CrossSectionMesh:
    """Rectangle centred on the axis, nx times ny squares of two triangles; the second material where x > split_x."""
    x, y = np.meshgrid(np.linspace(-width / 2, width / 2, nx + 1), np.linspace(-height / 2, height / 2, ny + 1))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    corner = (np.arange(nx) + (nx + 1) * np.arange(ny)[:, None]).ravel()
    a, b, c, d = corner, corner + 1, corner + nx + 2, corner + nx + 1
    cells = np.concatenate([np.stack([a, b, d], axis=1), np.stack([b, c, d], axis=1)])
    middle = points[cells].mean(axis=1)[:, 0]
    region_of = np.zeros(len(cells), dtype=int) if split_x is None else (middle > split_x).astype(int)
    return CrossSectionMesh(points, cells, "triangle", region_of, regions(*constants), twist_rate)


def rings(
    radii: Sequence[float],
    *constants: Constants,
    per_ring: int = 2,
    around: int = 24,
    centre: tuple[float, float] = (0.0, 0.0),
    twist_rate: float = 0.0,
    shape: Shape | None = None,
) -> CrossSectionMesh:
    """Concentric regions with outer radii `radii` about `centre`.

    `radii[0]` is the inner radius of a tube if len(radii) == len(constants) + 1. `shape` maps polar (rho, phi) to the plane; a circle if
    not given. `per_ring` elements across each region, `around` elements along the circle.
    """
    tube = len(radii) == len(constants) + 1
    layers = list(itertools.pairwise(radii)) if tube else list(zip((0.0, *radii[:-1]), radii, strict=True))
    edges = np.concatenate([np.linspace(a, b, per_ring + 1)[(0 if i == 0 else 1) :] for i, (a, b) in enumerate(layers)])
    layer_of = np.repeat(np.arange(len(constants)), per_ring)
    nodes = _RingNodes(edges, radii, around, shape or _circle(centre))
    cells, region_of = [], []
    for i, layer in enumerate(layer_of):
        for j in range(around):
            a, b, c, d = (2 * i, 2 * j), (2 * i + 2, 2 * j), (2 * i + 2, 2 * j + 2), (2 * i, 2 * j + 2)
            for t in [(a, b, c)] if nodes.solid and i == 0 else [(a, b, c), (a, c, d)]:
                middles = [nodes.middle(p, q) for p, q in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))]
                cells.append([*(nodes.corner(*p) for p in t), *middles])
                region_of.append(layer)
    return CrossSectionMesh(
        np.array(nodes.points), np.array(cells), "triangle6", np.array(region_of), regions(*constants), twist_rate
    )


def _circle(centre: tuple[float, float]) -> Shape:
    return lambda rho, phi: (centre[0] + rho * np.cos(phi), centre[1] + rho * np.sin(phi))


class _RingNodes:
    """Numbers the nodes at (i, j), i in half radial and j in half angular steps, as they are asked for."""

    def __init__(self, edges: np.ndarray, radii: Sequence[float], around: int, shape: Shape) -> None:
        self.edges, self.radii, self.around, self.shape = edges, radii, around, shape
        self.solid = bool(edges[0] == 0)
        self.points: list[tuple[float, float]] = []
        self.number: dict[tuple[int, int], int] = {}

    def corner(self, i: int, j: int) -> int:
        """A node on a ring; all angles are one at the centre of a solid circle."""
        key = (i, 0 if self.solid and i == 0 else j % (2 * self.around))
        if key not in self.number:
            self.number[key] = len(self.points)
            self.points.append(self.shape(float(self.edges[i // 2]), np.pi * key[1] / self.around))
        return self.number[key]

    def middle(self, p: tuple[int, int], q: tuple[int, int]) -> int:
        """The node between two corners: on the curve of an interface, half way between them elsewhere."""
        between = (p[1] + q[1]) // 2
        if self.solid and 0 in (p[0], q[0]):
            between = q[1] if p[0] == 0 else p[1]
        key = ((p[0] + q[0]) // 2, between)
        if p[0] == q[0] and np.isclose(self.edges[p[0] // 2], self.radii).any():
            return self.corner(*key)
        ends = [self.points[self.corner(*e)] for e in (p, q)]
        if key not in self.number:
            self.number[key] = len(self.points)
            self.points.append((0.5 * (ends[0][0] + ends[1][0]), 0.5 * (ends[0][1] + ends[1][1])))
        return self.number[key]


def wire_trace(wire_radius: float, helix_radius: float, twist_rate: float, phase: float = 0.0) -> Shape:
    """Exact cut of a round helical wire by a plane z = const, as a `shape` for :func:`rings`."""

    def shape(rho: float, phi: float) -> tuple[float, float]:
        if rho == 0:
            return float(helix_radius * np.cos(phase)), float(helix_radius * np.sin(phase))
        x, y = WireTrace(helix_radius, phase, rho, twist_rate).point(phi)
        return float(x), float(y)

    return shape


def strand_section(strand: Strand16, per_ring: int = 4, around: int = 24, joined: bool = True) -> CrossSectionMesh:
    """A 1 + m strand: each wire on its exact trace, meeting the core in one shared node (its contact line); wires apart.

    The core's nodes come first. `around` must be an even multiple of the number of wires, so that a node lies at every contact;
    `joined` = False leaves two nodes there.
    """
    tau, constants = strand.twist_rate, (strand.E, strand.nu)
    parts = [rings((strand.core,), constants, per_ring=per_ring, around=around)]
    for k in range(strand.wires):
        shape = wire_trace(strand.wire, strand.helix_radius, tau, 2 * np.pi * k / strand.wires)
        parts.append(rings((strand.wire,), constants, per_ring=per_ring, around=around, shape=shape))
    points = np.concatenate([p.points for p in parts])
    start = np.cumsum([0, *(len(p.points) for p in parts)])
    cells = np.concatenate([p.cells + s for p, s in zip(parts, start)])
    if joined:
        inner, outer = strand_contacts(strand, points)
        number = np.arange(len(points))
        number[outer] = inner
        used, packed = np.unique(number[cells], return_inverse=True)
        points, cells = points[used], packed.reshape(cells.shape)
    material = Material("wire", *constants, 7850.0)
    names = ["core", *(f"wire {k + 1}" for k in range(strand.wires))]
    return CrossSectionMesh(
        points,
        cells,
        "triangle6",
        np.concatenate([np.full(len(p.cells), i) for i, p in enumerate(parts)]),
        tuple(Region(name, "conductor", material, float("nan")) for name in names),
        tau,
    )


def strand_contacts(strand: Strand16, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Node numbers of the core and of the wires at the contacts of a strand that is not joined."""
    angle = 2 * np.pi * np.arange(strand.wires) / strand.wires
    place = strand.core * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    pairs = np.sort(np.argsort(np.linalg.norm(points[:, None] - place, axis=2), axis=0)[:2], axis=0)
    return pairs[0], pairs[1]


def linear(section: CrossSectionMesh) -> CrossSectionMesh:
    """The same section with straight three-node triangles."""
    corners, numbers = np.unique(section.cells[:, :3], return_inverse=True)
    return CrossSectionMesh(
        section.points[corners],
        numbers.reshape(-1, 3),
        "triangle",
        section.region_of,
        section.regions,
        section.twist_rate,
    )


def swept(section: CrossSectionMesh, height: float, layers: int) -> SliceMesh:
    """Wedges between turned copies of a three-node triangle section."""
    n = len(section.points)
    points = []
    for z in height * np.arange(layers + 1) / layers:
        angle = section.twist_rate * z
        Q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        points.append(np.column_stack([section.points @ Q.T, np.full(n, z)]))
    cells = np.concatenate([np.hstack([section.cells + k * n, section.cells + (k + 1) * n]) for k in range(layers)])
    return SliceMesh(
        np.concatenate(points),
        cells,
        "wedge",
        np.tile(section.region_of, layers),
        section.regions,
        section.twist_rate,
        height,
        np.arange(n),
        np.arange(n) + layers * n,
    )

"""Small meshes with known answers, made without gmsh."""

from __future__ import annotations

import itertools

import numpy as np
import skfem

from geometry.cell_mesh import CrossSectionMesh, Region, SliceMesh
from geometry.material import Material


def regions(*constants: tuple[float, float]) -> tuple[Region, ...]:
    """One region for each (E, nu)."""
    return tuple(
        Region(f"part {i}", "conductor", Material(f"m{i}", E, nu, 1000.0), float("nan"))
        for i, (E, nu) in enumerate(constants)
    )


def rectangle(nx, ny, width, height, *constants, split_x=None, twist_rate=0.0) -> CrossSectionMesh:
    """Rectangle centred on the axis, triangles; the second material where x > split_x."""
    m = skfem.MeshTri.init_tensor(
        np.linspace(-width / 2, width / 2, nx + 1), np.linspace(-height / 2, height / 2, ny + 1)
    )
    x = m.p[:, m.t].mean(axis=1)[0]
    region_of = (x > split_x).astype(int) if split_x is not None else np.zeros(m.t.shape[1], dtype=int)
    return CrossSectionMesh(m.p.T.copy(), m.t.T.astype(int), "triangle", region_of, regions(*constants), twist_rate)


def rings(radii, *constants, per_ring=2, around=24, centre=(0.0, 0.0), twist_rate=0.0, shape=None) -> CrossSectionMesh:
    """Concentric regions with outer radii `radii` about `centre` as triangle6, edges curved on the interfaces and straight inside.

    radii[0] may be the inner radius of a tube if len(radii) == len(constants) + 1.
    `shape` maps polar (rho, phi) to the plane; a circle if not given.
    """
    tube = len(radii) == len(constants) + 1
    edges = np.concatenate(
        [np.linspace(a, b, per_ring + 1)[(0 if i == 0 else 1) :] for i, (a, b) in enumerate(_layers(radii, tube))]
    )
    layer_of = np.repeat(np.arange(len(constants)), per_ring)
    shape = shape or (lambda rho, phi: (centre[0] + rho * np.cos(phi), centre[1] + rho * np.sin(phi)))
    points: dict[tuple[int, int], int] = {}
    coordinates: list[tuple[float, float]] = []

    def node(i: int, j: int) -> int:  # i in half radial steps, j in half angular steps
        j = 0 if edges[0] == 0 and i == 0 else j % (2 * around)
        if (i, j) not in points:
            points[i, j] = len(coordinates)
            coordinates.append(shape(edges[i // 2], np.pi * j / around))
        return points[i, j]

    def middle(p, q):
        on_interface = p[0] == q[0] and np.isclose(edges[p[0] // 2], radii).any()
        key = _between(p, q, solid=edges[0] == 0)
        if on_interface:
            return node(*key)
        ends = node(*p), node(*q)
        if key not in points:
            points[key] = len(coordinates)
            coordinates.append(tuple(np.mean([coordinates[e] for e in ends], axis=0)))
        return points[key]

    cells, region_of = [], []
    for i, layer in enumerate(layer_of):
        for j in range(around):
            a, b, c, d = (2 * i, 2 * j), (2 * i + 2, 2 * j), (2 * i + 2, 2 * j + 2), (2 * i, 2 * j + 2)
            triangles = [(a, b, c)] if edges[0] == 0 and i == 0 else [(a, b, c), (a, c, d)]
            for t in triangles:
                mids = [middle(p, q) for p, q in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))]
                cells.append([*(node(*p) for p in t), *mids])
                region_of.append(layer)
    return CrossSectionMesh(
        np.array(coordinates), np.array(cells), "triangle6", np.array(region_of), regions(*constants), twist_rate
    )


def _between(p, q, solid):
    """Half-way steps; the centre of a solid circle has no angle of its own."""
    j = q[1] if solid and p[0] == 0 else p[1] if solid and q[0] == 0 else (p[1] + q[1]) // 2
    return (p[0] + q[0]) // 2, j


def _layers(radii, tube):
    return list(itertools.pairwise(radii)) if tube else list(zip((0.0, *radii[:-1]), radii, strict=True))


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


def wire_trace(wire_radius: float, helix_radius: float, twist_rate: float):
    """Exact cut of a round helical wire by a plane z = const, as a `shape` for `rings`."""
    beta = np.arctan(twist_rate * helix_radius)
    s, c = np.sin(beta), np.cos(beta)

    def shape(rho, phi):
        x, y = helix_radius + rho * np.cos(phi), rho * c * np.sin(phi)
        angle = twist_rate * rho * s * np.sin(phi)
        return x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)

    return shape

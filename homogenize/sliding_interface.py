r"""Interfaces that slide without friction and without opening.

The nodes of an interface are doubled. With the surface normal of the helical interface in the rotating frame,

.. math:: N = (n_X,\, n_Y,\, \tau_0 (n_X Y - n_Y X)) / |\cdot| ,

(n the normal of its trace; N is orthogonal to the trace and to the helix direction (-tau_0 Y, tau_0 X, 1)), the jump obeys
N . [u] = 0. The condition is built into the unknowns, u = T (u_outer, s): the inner node shares the normal component of its
partner and has two tangential ones of its own, so that K becomes T^T K T and no penalty is needed. N does not depend on z: the
same T serves tension, torsion, bending and shear.

A part that slides in its hole can move freely along the helix: u = (-tau_0 Y, tau_0 X, 1), and a part that is centred on the axis can
also turn about it. These motions store no energy and no load does work on them; they are pinned in the z-independent problem.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import MeshError
from homogenize.section_field import FloatArray, SectionField

_EDGES = ((0, 3, 1), (1, 4, 2), (2, 5, 0))  # corner, middle, corner of a six-node triangle


@dataclass(frozen=True)
class SlidingField:
    """A section field whose parts slide, and the unknowns that are left.

    Attributes
    ----------
    field : with doubled nodes
    T : (3 n, unknowns) values of the doubled field from the free unknowns
    Z : (unknowns, 6) rigid motions in the free unknowns
    slip_pins : unknowns that are pinned in the z-independent problem, one for each free motion of a part
    anchored : (n_original,) nodes that do not belong to a sliding part, for the gauge of the whole section
    """

    field: SectionField
    T: sp.csr_array
    Z: FloatArray
    slip_pins: tuple[int, ...]
    anchored: NDArray[np.bool_]


def sliding_field(field: SectionField, mesh: CrossSectionMesh, kind: str = "conductor") -> SlidingField:
    """Let every part of one `kind` slide in what surrounds it; where two of them touch, the outer one slides on the inner one.

    Raises
    ------
    MeshError
        If the mesh is not made of six-node triangles, no part is of that kind, or none of them touches another part.
    """
    if field.cells.shape[0] != 6:
        raise MeshError("sliding interfaces need a mesh of triangles; mesh the cross-section with kind triangle6.")
    sliding = [i for i, region in enumerate(mesh.regions) if region.kind == kind]
    if not sliding:
        known = ", ".join(sorted({region.kind for region in mesh.regions}))
        raise MeshError(f'no part is of kind "{kind}", so that nothing can slide; the kinds here are {known}.')
    n = field.nodes.shape[1]
    cells, nodes, outer, normals = field.cells.copy(), [field.nodes], [], []
    anchored = np.ones(n, dtype=bool)
    pins: list[int] = []
    total = n
    fixed = np.ones(field.cells.shape[1], dtype=bool)  # cells of parts that do not slide yet
    for region in _from_outside(field, sliding):
        inside = field.region_of == region
        fixed &= ~inside
        shared = np.intersect1d(field.cells[:, inside], field.cells[:, fixed])
        if not len(shared):  # all that touches it slides on it already
            continue
        anchored[field.cells[:, inside]] = False
        number = np.arange(n)
        number[shared] = total + np.arange(len(shared))
        cells[:, inside] = number[field.cells[:, inside]]
        total += len(shared)
        nodes.append(field.nodes[:, shared])
        outer.append(shared)
        normals.append(_normals(field, inside, shared))
        interior = np.setdiff1d(field.cells[:, inside], shared)
        pins += _pins(field, interior)
    if not outer:
        raise MeshError(f'no part of kind "{kind}" touches another part, so that nothing can slide; choose bonded.')
    anchored[np.concatenate(outer)] = True  # the outer copies of the interface nodes
    doubled = replace(field, nodes=np.concatenate(nodes, axis=1), cells=cells)
    T, Z = _tie(field, np.concatenate(outer), np.concatenate(normals, axis=1))
    return SlidingField(doubled, T, Z, tuple(pins), anchored)


def _from_outside(field: SectionField, regions: list[int]) -> list[int]:
    """Regions by the distance of their centre from the axis, the outermost first."""

    def distance(region: int) -> float:
        nodes = np.unique(field.cells[:, field.region_of == region])
        return float(np.hypot(*field.nodes[:, nodes].mean(axis=1)))

    return sorted(regions, key=distance, reverse=True)


def _normals(field: SectionField, inside: NDArray[np.bool_], shared: NDArray[np.int64]) -> FloatArray:
    """Unit outward normals (2, nodes) of the trace of a part at its interface nodes, from its quadratic edges."""
    n = field.nodes.shape[1]
    on_interface = np.zeros(n, dtype=bool)
    on_interface[shared] = True
    total = np.zeros((2, n))
    cells = field.cells[:, inside]
    for corners in _EDGES:
        a, m, b = cells[list(corners)]
        edge = on_interface[a] & on_interface[m] & on_interface[b]
        a, m, b = a[edge], m[edge], b[edge]
        A, M, B = field.nodes[:, a], field.nodes[:, m], field.nodes[:, b]
        centroid = field.nodes[:, cells[:3][:, edge]].mean(axis=1)
        away = np.sign(_cross(B - A, centroid - A))
        for node, tangent in ((a, -3 * A + 4 * M - B), (m, B - A), (b, A - 4 * M + 3 * B)):
            np.add.at(total[0], node, away * tangent[1])
            np.add.at(total[1], node, -away * tangent[0])
    chosen = total[:, shared]
    return chosen / np.linalg.norm(chosen, axis=0)


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[0] * b[1] - a[1] * b[0]


def _tie(field: SectionField, outer: NDArray[np.int64], normals: FloatArray) -> tuple[sp.csr_array, FloatArray]:
    """T and Z: inner nodes share the normal component of their outer partner and keep two tangential ones."""
    n, pairs = field.nodes.shape[1], len(outer)
    X, Y = field.nodes[:, outer]
    nX, nY = normals
    N = np.stack([nX, nY, field.twist_rate * (nX * Y - nY * X)])
    N /= np.linalg.norm(N, axis=0)
    a = np.stack([-nY, nX, np.zeros(pairs)])
    b = np.cross(N, a, axis=0)
    inner = 3 * n + 3 * np.arange(pairs)
    own = 3 * n + 2 * np.arange(pairs)
    rows, columns, values = [np.arange(3 * n)], [np.arange(3 * n)], [np.ones(3 * n)]
    for x in range(3):
        for y in range(3):
            rows.append(inner + x)
            columns.append(3 * outer + y)
            values.append(N[x] * N[y])
        for k, direction in enumerate((a, b)):
            rows.append(inner + x)
            columns.append(own + k)
            values.append(direction[x])
    shape = (3 * (n + pairs), 3 * n + 2 * pairs)
    T = sp.coo_array((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=shape).tocsr()
    Z = field.rigid_motion()
    local = Z.reshape(n, 3, 6)[outer]
    tangential = np.stack([np.einsum("xp,pxj->pj", d, local) for d in (a, b)], axis=1).reshape(2 * pairs, 6)
    return T, np.concatenate([Z, tangential])


def _pins(field: SectionField, interior: NDArray[np.int64]) -> list[int]:
    """One unknown of an inner node for each free motion of a part: along its helix, and its turn where it is centred or straight."""
    X, Y = field.nodes[:, interior]
    x, y = X.mean(), Y.mean()
    middle = int(interior[np.argmin((X - x) ** 2 + (Y - y) ** 2)])
    centred = np.hypot(x, y) < 1e-2 * np.ptp(X)
    if not centred and field.twist_rate != 0.0:
        return [3 * middle + 2]
    right = int(interior[np.argmax((X - x) - np.abs(Y - y))])
    return [3 * middle + 2, 3 * right + 1]

"""Shape functions, their gradients and quadrature weights on a mesh, from scikit-fem, which is imported here only.

Plane meshes carry quadratic fields (6-node triangles, 9-node quads) on straight or curved elements; solid meshes carry linear
fields (8-node bricks, 6-node wedges). Quadrature: exact for products of quadratic gradients in the plane; 2 x 2 x 2 Gauss points in the
brick; 3 points of the triangle times 2 in height in the wedge.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import skfem
from numpy.typing import NDArray

from geometry.errors import MeshError

FloatArray = NDArray[np.float64]

_KINDS = {
    "triangle": (skfem.MeshTri1, skfem.ElementTriP2()),
    "triangle6": (skfem.MeshTri2, skfem.ElementTriP2()),
    "quad": (skfem.MeshQuad1, skfem.ElementQuad2()),
    "quad9": (skfem.MeshQuad2, skfem.ElementQuad2()),
    "hexahedron": (skfem.MeshHex1, skfem.ElementHex1()),
    "wedge": (skfem.MeshWedge1, skfem.ElementWedge1()),
}
_NODE_ORDER = {"hexahedron": [6, 2, 5, 7, 1, 3, 4, 0]}  # scikit-fem's corners in the order of the mesh file


@dataclass(frozen=True)
class ElementBasis:
    """What assembly needs, d dimensions, k shape functions, e elements, q quadrature points.

    Attributes
    ----------
    nodes : (d, n) [m]
    cells : (k, e) node numbers of the field (for linear fields those of the mesh)
    shape : (k, q)
    gradient : (d, k, e, q) [1/m]
    weight : (e, q) [m^d]
    position : (d, e, q) [m]
    """

    nodes: FloatArray
    cells: NDArray[np.int64]
    shape: FloatArray
    gradient: FloatArray
    weight: FloatArray
    position: FloatArray


def element_basis(
    points: FloatArray, cells: NDArray[np.int64], kind: str, describe: Callable[[int], str] = "element {}".format
) -> ElementBasis:
    """Evaluate the shape functions of a mesh.

    Parameters
    ----------
    points : (n, d) [m]
    cells : (e, nodes of the element), in meshio order
    kind : "triangle", "triangle6", "quad", "quad9" (quadratic field), "hexahedron", "wedge" (linear field)
    describe : names an element for the error

    Raises
    ------
    MeshError
        If an element is folded (its Jacobian changes sign) or the kind is not known.
    """
    if kind not in _KINDS:
        raise MeshError(f'no field is known for "{kind}" cells; use one of {", ".join(_KINDS)}.')
    make, element = _KINDS[kind]
    order = _NODE_ORDER.get(kind, list(range(cells.shape[1])))
    mesh = make(np.ascontiguousarray(points.T), np.ascontiguousarray(cells[:, order].T))
    basis = skfem.CellBasis(mesh, element, intorder=4, quadrature=_quadrature(kind))
    weight = np.asarray(basis.dx)
    jacobian = np.broadcast_to(np.asarray(basis.mapping.detDF(basis.X)), weight.shape)
    folded = jacobian.min(axis=1) * jacobian.max(axis=1) <= 0
    if folded.any():
        e = int(np.argmax(folded))
        x = ", ".join(f"{1e3 * c:.2f}" for c in points[cells[e]].mean(axis=0))
        raise MeshError(
            f"{describe(e)} near ({x}) mm is turned inside out; ask for smaller elements or thinner layers."
        )
    fields = [basis.basis[a][0] for a in range(basis.Nbfun)]
    return ElementBasis(
        nodes=np.asarray(basis.doflocs),
        cells=np.asarray(basis.element_dofs, dtype=np.int64),
        shape=np.array([np.broadcast_to(np.asarray(f), weight.shape)[0] for f in fields]),
        gradient=np.stack([np.asarray(f.grad) for f in fields], axis=1),
        weight=weight,
        position=np.asarray(basis.global_coordinates()),
    )


def _quadrature(kind: str) -> tuple[FloatArray, FloatArray] | None:
    """Points (3, q) and weights (q,) for solids; None lets scikit-fem choose.

    The wedge rule of scikit-fem 12.0.2 is not used: its weights add up to 1/4 instead of the volume 1/2.
    """
    line = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3)
    if kind == "hexahedron":
        return np.array(np.meshgrid(line, line, line, indexing="ij")).reshape(3, -1), np.full(8, 1 / 8)
    if kind == "wedge":
        triangle = np.array([[1 / 6, 1 / 6], [2 / 3, 1 / 6], [1 / 6, 2 / 3]]).T
        points = np.concatenate([np.vstack([triangle, np.full((1, 3), z)]) for z in line], axis=1)
        return points, np.full(6, 1 / 12)
    return None

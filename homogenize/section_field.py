r"""Displacement fields on the cross-section and the strain operators of a helical cable.

In the frame that turns with the cable (X, Y at the angle ``twist_rate * z``) a vector field u(X, Y, z) in rotating components
has the axial derivative

.. math::  D_z u = \partial_z u + S u, \qquad
           S u = \tau_0 (Y \partial_X - X \partial_Y) u + \tau_0\, e_z \times u, \qquad \tau_0 = 2 \pi / p ,

so that the strain splits into :math:`\varepsilon = B_s u + B_z \partial_z u` with operators that do not depend on z: the
whole cable is one two-dimensional problem. Strain order xx yy zz yz xz xy, engineering shears.

Helical invariance in beam homogenisation: Frikha, Cartraud, Treyssede, Int. J. Solids Struct. 50 (2013) 1373-1382,
doi 10.1016/j.ijsolstr.2013.01.014; Treyssede, Laguerre, J. Sound Vib. 329 (2010) 1702-1716, doi 10.1016/j.jsv.2009.11.021.

Einsum letters: e element, q quadrature point, a b node of the element, i j strain component, x y displacement component.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from homogenize.element_basis import ElementBasis, element_basis
from homogenize.transverse_isotropy import TransverseIsotropy

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class SectionField:
    """Quadratic finite element field with three displacement components a node on a cross-section mesh.

    Attributes
    ----------
    nodes : (2, n) positions of the nodes in the rotating frame [m]
    cells : (k, e) node numbers of each element
    shape : (k, q) shape functions at the quadrature points of the reference element
    gradient : (2, k, e, q) their derivatives by X and Y [1/m]
    weight : (e, q) quadrature weight times area [m^2]
    position : (2, e, q) quadrature points [m]
    elasticity : (e, 6, 6) stiffness of the material [Pa]; where the fibres of a material turn, its mean over the element
    twist_rate : tau_0 [rad/m]
    turning_elasticity : (e, q, 6, 6), with the fibres as they lie at each point; None where all materials are isotropic
    """

    nodes: FloatArray
    cells: NDArray[np.int64]
    shape: FloatArray
    gradient: FloatArray
    weight: FloatArray
    position: FloatArray
    elasticity: FloatArray
    region_of: NDArray[np.int64]
    twist_rate: float
    turning_elasticity: FloatArray | None = None

    @property
    def point_elasticity(self) -> FloatArray:
        """Stiffness at the quadrature points, shape (e, q, 6, 6), or (e, 1, 6, 6) where it is the same in all of an element."""
        return self.elasticity[:, None] if self.turning_elasticity is None else self.turning_elasticity

    @property
    def unknowns(self) -> int:
        """Number of displacement components."""
        return 3 * self.nodes.shape[1]

    @property
    def area(self) -> float:
        """Area of the mesh [m^2]."""
        return float(self.weight.sum())

    @cached_property
    def strain_z(self) -> FloatArray:
        """B_z, shape (e, q, 6, 3k): strain per unit axial derivative of the nodal values."""
        k, q = self.shape.shape
        B = np.zeros((1, q, 6, k, 3))
        B[0, :, 2, :, 2] = B[0, :, 3, :, 1] = B[0, :, 4, :, 0] = self.shape.T
        return B.reshape(1, q, 6, 3 * k)

    @cached_property
    def strain_s(self) -> FloatArray:
        """B_s, shape (e, q, 6, 3k): strain of a field that does not depend on z."""
        dX, dY = np.moveaxis(self.gradient, 1, -1)  # (e, q, k)
        X, Y = self.position[..., None]
        N = self.shape.T
        turn = self.twist_rate * (Y * dX - X * dY)
        B = np.zeros((*self.weight.shape, 6, N.shape[1], 3))
        B[:, :, 0, :, 0] = B[:, :, 5, :, 1] = dX
        B[:, :, 1, :, 1] = B[:, :, 5, :, 0] = dY
        B[:, :, 2, :, 2] = turn
        B[:, :, 3, :, 2] = dY
        B[:, :, 3, :, 1] = B[:, :, 4, :, 0] = turn
        B[:, :, 3, :, 0] = self.twist_rate * N
        B[:, :, 4, :, 1] = -self.twist_rate * N
        B[:, :, 4, :, 2] = dX
        return B.reshape(*self.weight.shape, 6, -1)

    @cached_property
    def element_dofs(self) -> NDArray[np.int64]:
        """Unknowns of each element, shape (e, 3k): node by node, X Y Z."""
        return (3 * self.cells.T[:, :, None] + np.arange(3)).reshape(self.cells.shape[1], -1)

    def matrices(self) -> tuple[sp.csr_array, sp.csr_array, sp.csr_array]:
        """E0 = int B_z^T C B_z, E1 = int B_z^T C B_s, E2 = int B_s^T C B_s, each (3n, 3n), sparse."""
        return (
            _gram(self, self.strain_z, self.strain_z),
            _gram(self, self.strain_z, self.strain_s),
            _gram(self, self.strain_s, self.strain_s),
        )

    def rigid_motion(self) -> FloatArray:
        """Z, shape (3n, 6): nodal values of unit translations and of unit rotations about x, y, z."""
        n = self.nodes.shape[1]
        X, Y = self.nodes
        Z = np.zeros((n, 3, 6))
        Z[:, 0, 0] = Z[:, 1, 1] = Z[:, 2, 2] = 1.0
        Z[:, 2, 3], Z[:, 2, 4] = Y, -X
        Z[:, 0, 5], Z[:, 1, 5] = -Y, X
        return Z.reshape(3 * n, 6)

    def strain(self, u: FloatArray, du_dz: FloatArray) -> FloatArray:
        """Strain at the quadrature points, shape (e, q, 6, loads), of nodal values u and du_dz, shape (3n, loads)."""
        local, local_z = u[self.element_dofs], du_dz[self.element_dofs]
        return np.matmul(self.strain_s, local[:, None]) + np.matmul(self.strain_z, local_z[:, None])


def section_field(mesh: CrossSectionMesh) -> SectionField:
    """Quadratic displacement field on a cross-section mesh, with curved elements where the mesh has curved edges.

    Raises
    ------
    MeshError
        If an element is turned inside out; the message names its region and place.
    """
    basis = element_basis(
        mesh.points, mesh.cells, mesh.cell_kind, lambda e: f"an element of {mesh.regions[mesh.region_of[e]].name}"
    )
    C = np.array([region.material.elasticity() for region in mesh.regions])[mesh.region_of]
    turning = _turning(mesh, basis, C)
    if turning is not None:
        C = np.einsum("eq,eqij->eij", basis.weight / basis.weight.sum(axis=1, keepdims=True), turning)
    return SectionField(
        nodes=basis.nodes,
        cells=basis.cells,
        shape=basis.shape,
        gradient=basis.gradient,
        weight=basis.weight,
        position=basis.position,
        elasticity=C,
        region_of=mesh.region_of,
        twist_rate=mesh.twist_rate,
        turning_elasticity=turning,
    )


def _turning(mesh: CrossSectionMesh, basis: ElementBasis, C: FloatArray) -> FloatArray | None:
    """Stiffness (e, q, 6, 6) in rotating components where some material has helical fibres, from that of each element (e, 6, 6)."""
    fibrous = [n for n, region in enumerate(mesh.regions) if isinstance(region.material, TransverseIsotropy)]
    if not fibrous:
        return None
    turning = np.repeat(C[:, None], basis.weight.shape[1], axis=1)
    for number in fibrous:
        material, inside = mesh.regions[number].material, mesh.region_of == number
        assert isinstance(material, TransverseIsotropy)
        X, Y = basis.position[:, inside]
        turning[inside] = material.elasticity_at(X, Y, mesh.twist_rate)
    return turning


def _gram(field: SectionField, left: FloatArray, right: FloatArray) -> sp.csr_array:
    """Assembled int left^T C right."""
    e, q = field.weight.shape
    k3 = right.shape[-1]
    weighted = field.weight[:, :, None, None] * np.matmul(field.point_elasticity, right)
    left = np.broadcast_to(left, (e, *left.shape[1:]))
    blocks = np.matmul(left.reshape(e, q * 6, k3).transpose(0, 2, 1), weighted.reshape(e, q * 6, k3))
    dofs = field.element_dofs
    rows = np.broadcast_to(dofs[:, :, None], blocks.shape)
    cols = np.broadcast_to(dofs[:, None, :], blocks.shape)
    n = field.unknowns
    return sp.coo_array((blocks.ravel(), (rows.ravel(), cols.ravel())), shape=(n, n)).tocsr()

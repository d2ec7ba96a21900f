r"""The 18-node wedge swept along the helix: a quadratic triangle of the section times a quadratic piece of the axis.

In the frame that turns with the cable the displacement is :math:`u(X, Y, z) = \sum_k M_k(z)\, u_k(X, Y)`, u_k a field of the section
(:mod:`homogenize.section_field`) in rotating components. Its gradient, column by column,

.. math::
   H = \big[\partial_X u,\ \partial_Y u,\ \partial_z u + S u\big], \qquad
   S u = \tau_0 (Y \partial_X - X \partial_Y) u + \tau_0 e_z \times u ,

is exact for the helical shape, and its operators are the same in every layer. So force and tangent of an element are made from those of
the section at the Gauss points of the axis: with P = [A_s, A_z] (the operators on u and on du/dz), stress T and tangent D per H,

.. math::
   f_k = \sum_g w_g (M_k\, A_s^T T + M_k'\, A_z^T T), \qquad
   K_{kl} = \sum_g w_g (M_k M_l\, D_{ss} + M_k M_l'\, D_{sz} + M_k' M_l\, D_{zs} + M_k' M_l'\, D_{zz}) .

Against volumetric locking the volume strain theta of each element is replaced by its least-squares fit with 1, X, Y, z
(selective projection; Simo, Taylor, Pister, Comput. Methods Appl. Mech. Eng. 51 (1985) 177-208, doi 10.1016/0045-7825(85)90033-7).
A wedge brings 12 unknowns for these 4 conditions, the ratio of the continuum.

Letters: e element of the section, q its quadrature points, g Gauss points of a layer, k l planes of a layer.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geometry.cell_mesh import Region
from geometry.errors import MeshError, SpecError
from geometry.material import Material
from homogenize.section_field import FloatArray, SectionField
from homogenize.specimen.axial_basis import AxialBasis
from homogenize.specimen.hyperelastic_law import PointState, point_state

VOLUME_STRAINS = ("linear", "full")
"""How the volume strain is taken in an element: fitted with 1, X, Y, z, or as it is at each point."""


@dataclass(frozen=True)
class Wedges:
    """All wedges between z = 0 and the end of a piece of cable.

    Unknown 3 (n p + a) + x is the rotating component x of node a (of n in the section) in plane p, a station of the axial basis:
    with degree 2 the ends and the middle of every layer.

    Attributes
    ----------
    section : field of the cross-section
    regions : its regions
    axis : layers and polynomials along z; degree 2 is the 18-node wedge
    volume_strain : "linear" (does not lock) or "full"
    neo_hookean : names of the regions that follow the neo-Hookean law; the others are St Venant-Kirchhoff
    """

    section: SectionField
    regions: tuple[Region, ...]
    axis: AxialBasis
    volume_strain: str = "linear"
    neo_hookean: Collection[str] = field(default_factory=tuple)

    def __post_init__(self) -> None:
        if self.section.cells.shape[0] != 6:
            raise MeshError("swept wedges need a mesh of triangles; mesh the cross-section with kind triangle6.")
        if self.volume_strain not in VOLUME_STRAINS:
            raise SpecError(f'the volume strain "{self.volume_strain}" is not known; choose linear or full.')
        unknown = sorted(set(self.neo_hookean) - {r.name for r in self.regions})
        if unknown:
            raise SpecError(
                f'no region is called "{unknown[0]}"; choose from {", ".join(r.name for r in self.regions)}.'
            )
        stiff = [r.name for r in self.regions if r.name in self.neo_hookean and not isinstance(r.material, Material)]
        if stiff:
            raise SpecError(f"{stiff[0]} is not isotropic, the neo-Hookean law cannot describe it; leave it out.")

    @property
    def planes(self) -> FloatArray:
        """z of all planes [m]."""
        return self.axis.stations

    @property
    def plane_unknowns(self) -> int:
        """Unknowns of one plane."""
        return self.section.unknowns

    @property
    def unknowns(self) -> int:
        """Number of displacement components."""
        return self.plane_unknowns * len(self.planes)

    @cached_property
    def operators(self) -> FloatArray:
        """P = [A_s, A_z], shape (e, q, 9, 36)."""
        s = self.section
        dX, dY = np.moveaxis(s.gradient, 1, -1)
        X, Y = s.position[..., None]
        N = np.broadcast_to(s.shape.T, dX.shape)
        P = np.zeros((*s.weight.shape, 3, 3, 2, 6, 3))  # e q, component, direction, (u, du/dz), node, component
        for x in range(3):
            P[:, :, x, 0, 0, :, x], P[:, :, x, 1, 0, :, x] = dX, dY
            P[:, :, x, 2, 0, :, x] = s.twist_rate * (Y * dX - X * dY)
            P[:, :, x, 2, 1, :, x] = N
        P[:, :, 0, 2, 0, :, 1] -= s.twist_rate * N
        P[:, :, 1, 2, 0, :, 0] += s.twist_rate * N
        return P.reshape(*s.weight.shape, 9, 36)

    def axial(self, layer: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """M (planes of the layer, g), M' (planes, g) [1/m] and weights (g,) [m] of a layer."""
        d = self.axis.degree
        _, weight, values, slopes = self.axis.quadrature
        points = slice(layer * (d + 1), (layer + 1) * (d + 1))
        planes = slice(layer * d, layer * d + d + 1)
        return values[points, planes].T, slopes[points, planes].T, weight[points]

    def local(self, u: FloatArray, layer: int) -> FloatArray:
        """Displacement and axial derivative at the Gauss points of a layer, element by element, shape (e, 36, g)."""
        M, slope, _ = self.axial(layer)
        planes = u.reshape(-1, self.plane_unknowns)[self._planes_of(layer)]
        values = planes[:, self.section.element_dofs]  # (k, e, 18)
        return np.concatenate([np.einsum("kei,kg->eig", values, m) for m in (M, slope)], axis=1)

    def gradient(self, u: FloatArray, layer: int) -> FloatArray:
        """H at the points of a layer in rotating components, shape (e, q, g, 9)."""
        e, q = self.section.weight.shape
        H = np.matmul(self.operators.reshape(e, q * 9, 36), self.local(u, layer))
        return H.reshape(e, q, 9, -1).transpose(0, 1, 3, 2)

    def smallest_volume(self, u: FloatArray) -> float:
        """Smallest det F at any point; not positive where an element is turned inside out."""
        layers = (self.gradient(u, layer).reshape(-1, 3, 3) for layer in range(self.axis.layers))
        return min(float(np.linalg.det(H + np.eye(3)).min()) for H in layers)

    def energy(self, u: FloatArray) -> float:
        """Strain energy [J]; nan where a neo-Hookean element is turned inside out."""
        total = 0.0
        for layer in range(self.axis.layers):
            weight, state, smooth = self._layer_state(u, layer)
            total += float((weight * (state.energy + 0.5 * self._lame[2] * smooth**2)).sum())
        return total

    def force(self, u: FloatArray) -> FloatArray:
        """Nodal forces of the stress, the derivative of the energy, (unknowns,) [N]."""
        return self._assemble(u, False)[0]

    def force_and_tangent(self, u: FloatArray) -> tuple[FloatArray, sp.csr_array]:
        """Nodal forces, and their derivative (unknowns, unknowns) [N/m]."""
        f, K = self._assemble(u, True)
        assert K is not None
        return f, K

    def face_area(self) -> FloatArray:
        """Share of each node of the section in the area, (n,) [m^2]: the nodal forces of a unit traction."""
        s = self.section
        return np.asarray(np.bincount(s.cells.T.ravel(), (s.weight @ s.shape.T).ravel(), s.nodes.shape[1]), dtype=float)

    def turned(self, vectors: FloatArray, z: FloatArray | float, back: bool = False) -> FloatArray:
        """Rotating components of vectors (..., 3) given in fixed axes at heights z (...); with `back` the other way."""
        angle = self.section.twist_rate * np.asarray(z) * (-1 if back else 1)
        c, s = np.cos(angle), np.sin(angle)
        x, y, w = np.moveaxis(vectors, -1, 0)
        return np.stack([c * x + s * y, -s * x + c * y, np.broadcast_to(w, x.shape)], axis=-1)

    def fixed_components(self, u: FloatArray) -> FloatArray:
        """Displacements (planes, n, 3) in fixed axes of unknowns u."""
        values = u.reshape(len(self.planes), -1, 3)
        return self.turned(values, self.planes[:, None], back=True)

    def rotating(self, displacement: FloatArray) -> FloatArray:
        """Unknowns of displacements (planes, n, 3) in fixed axes."""
        return self.turned(displacement, self.planes[:, None]).ravel()

    def places(self) -> FloatArray:
        """Nodes at rest in fixed axes, shape (planes, n, 3) [m]."""
        flat = np.concatenate([self.section.nodes, np.zeros((1, self.section.nodes.shape[1]))]).T
        at = np.broadcast_to(flat, (len(self.planes), *flat.shape)).copy()
        at[:, :, 2] = self.planes[:, None]
        return self.turned(at, self.planes[:, None], back=True)

    def mean_gradient(self, u: FloatArray) -> FloatArray:
        """Volume average of the displacement gradient in fixed axes, (3, 3), row component, column direction."""
        total, volume = np.zeros((3, 3)), 0.0
        for layer in range(self.axis.layers):
            H = self.gradient(u, layer)
            _, _, wg = self.axial(layer)
            heights = self.axis.quadrature[0][layer * len(wg) : (layer + 1) * len(wg)]
            sums = np.einsum("eq,eqgi->gi", self.section.weight, H).reshape(-1, 3, 3)
            for g, (z, w) in enumerate(zip(heights, wg)):
                angle = self.section.twist_rate * z
                c, s = np.cos(angle), np.sin(angle)
                Q = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
                total += w * Q @ sums[g] @ Q.T
            volume += float(self.section.area * wg.sum())
        return total / volume

    # ------------------------------------------------------------------------------------------------ assembly

    @cached_property
    def _pattern(self) -> tuple[sp.csr_array, NDArray, NDArray, NDArray, NDArray]:
        """Sum of element entries into the entries of one pair of planes; their rows and columns; the order of all pairs' entries
        in the rows of the whole matrix, and its row pointer."""
        dofs, n = self.section.element_dofs, self.plane_unknowns
        key = (dofs[:, :, None] * n + dofs[:, None, :]).ravel()
        pairs, where = np.unique(key, return_inverse=True)
        gather = sp.csr_array((np.ones(len(key)), (where, np.arange(len(key)))), shape=(len(pairs), len(key)))
        row, column = pairs // n, pairs % n
        first, second = self._plane_pairs
        rows = (first[:, None] * n + row).ravel()
        columns = (second[:, None] * n + column).ravel()
        order = np.lexsort((columns, rows))
        pointer = np.concatenate([[0], np.cumsum(np.bincount(rows, minlength=self.unknowns))])
        return gather, columns[order].astype(np.int32), order, pointer.astype(np.int32), pairs

    @cached_property
    def _plane_pairs(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Pairs of planes that share a layer."""
        count = len(self.planes)
        key = np.unique(np.concatenate([self._layer_keys(layer) for layer in range(self.axis.layers)]))
        return key // count, key % count

    @cached_property
    def _lame(self) -> tuple[FloatArray, FloatArray, FloatArray, NDArray[np.bool_]]:
        """C' (e, q, g, 6, 6) as a view, G, lambda (e, q, g), and which elements are neo-Hookean."""
        s = self.section
        isotropic = np.array([isinstance(r.material, Material) for r in self.regions])[s.region_of]
        lame = np.where(isotropic, s.elasticity[:, 0, 1], 0.0)
        C = (
            np.repeat(s.elasticity[:, None], s.weight.shape[1], axis=1)
            if s.turning_elasticity is None
            else s.turning_elasticity
        )
        C = C.copy()
        C[:, :, :3, :3] -= lame[:, None, None, None]
        rubber = np.array([r.name in self.neo_hookean for r in self.regions])[s.region_of]
        return C, s.elasticity[:, 3, 3], lame[:, None, None], rubber

    @cached_property
    def _projection(self) -> tuple[FloatArray, FloatArray]:
        """Functions 1, X, Y, z of each element at its points (e, 4, q, g), z over half the layer, and the inverse of their products
        (e, 4, 4) for a layer of height 2."""
        s = self.section
        X = s.position - (s.weight * s.position).sum(axis=-1, keepdims=True) / s.weight.sum(axis=-1)[:, None]
        X = X / np.sqrt(s.weight.sum(axis=-1))[:, None]
        t, w = np.polynomial.legendre.leggauss(self.axis.degree + 1)
        shape = (*s.weight.shape, len(t))
        p = np.stack([np.ones(shape), *(np.broadcast_to(x[..., None], shape) for x in X), np.broadcast_to(t, shape)], 1)
        products = np.einsum("eaqg,ebqg,eq,g->eab", p, p, s.weight, w, optimize=True)
        return p, np.linalg.inv(products)

    def _layer_state(self, u: FloatArray, layer: int) -> tuple[FloatArray, PointState, FloatArray]:
        """Weights (e, q, g), the state at the points (its arrays with leading e q g), and the smoothed theta (e, q, g)."""
        C, G, _, rubber = self._lame
        H = self.gradient(u, layer)
        shape = H.shape[:3]
        weight = self.section.weight[:, :, None] * self.axial(layer)[2]
        wide = np.broadcast_to(C[:, :, None], (*shape, 6, 6)).reshape(-1, 6, 6)
        flat = np.ascontiguousarray(H.reshape(-1, 9))
        soft = np.broadcast_to(rubber[:, None, None], shape).ravel()
        shear = np.broadcast_to(G[:, None, None], shape).ravel()
        state = point_state(flat, wide, shear, soft).reshaped(*shape)
        if self.volume_strain == "full":
            return weight, state, state.theta
        p, inverse = self._projection
        half = self.axial(layer)[2].sum() / 2
        moments = np.einsum("eaqg,eqg->ea", p, weight * state.theta) / half
        return weight, state, np.einsum("ea,eab,ebqg->eqg", moments, inverse, p, optimize=True)

    def _assemble(self, u: FloatArray, tangent: bool) -> tuple[FloatArray, sp.csr_array | None]:
        f = np.zeros((len(self.planes), self.plane_unknowns))
        first, second = self._plane_pairs
        data = np.zeros((len(first), len(self._pattern[4]))) if tangent else None
        for layer in range(self.axis.layers):
            local, matrices = self._element(u, layer, tangent)
            for k, plane in enumerate(self._planes_of(layer)):
                f[plane] += np.bincount(self.section.element_dofs.ravel(), local[:, k].ravel(), self.plane_unknowns)
            if data is not None and matrices is not None:
                sums = self._pattern[0] @ matrices.reshape(len(matrices) ** 2, -1).T
                at = np.searchsorted(first * len(self.planes) + second, self._layer_keys(layer))
                data[at] += sums.T
        if data is None:
            return f.ravel(), None
        _, columns, order, pointer, _ = self._pattern
        K = sp.csr_array((data.ravel()[order], columns, pointer), shape=(self.unknowns, self.unknowns))
        return f.ravel(), K

    def _layer_keys(self, layer: int) -> NDArray[np.int64]:
        planes = self._planes_of(layer)
        return (planes[:, None] * len(self.planes) + planes).ravel()

    def _planes_of(self, layer: int) -> NDArray[np.int64]:
        return self.axis.degree * layer + np.arange(self.axis.degree + 1)

    def _element(self, u: FloatArray, layer: int, tangent: bool) -> tuple[FloatArray, FloatArray | None]:
        """Forces (e, k, 18) and matrices (k, l, e, 18, 18) of the wedges of a layer."""
        e, q = self.section.weight.shape
        M, slope, wg = self.axial(layer)
        weight, state, smooth = self._layer_state(u, layer)
        lame = self._lame[2]
        area = self.section.weight[:, :, None, None]
        P = self.operators.reshape(e, q * 9, 36)
        T = (state.stress + (lame * smooth)[..., None] * state.slope) * area
        both = np.matmul(P.transpose(0, 2, 1), T.transpose(0, 1, 3, 2).reshape(e, q * 9, -1))  # (e, 36, g)
        axial = np.stack([M, slope]) * wg  # (s or z, k, g)
        f = np.einsum("esig,skg->eki", both.reshape(e, 2, 18, -1), axial, optimize=True)
        if not tangent:
            return f, None
        D = state.tangent + (lame * smooth)[..., None, None] * state.curve
        if self.volume_strain == "full":
            D = D + lame[..., None, None] * state.slope[..., :, None] * state.slope[..., None, :]
        K = np.zeros((len(M), len(M), e, 18, 18))
        for g, w in enumerate(wg):
            DP = np.matmul(D[:, :, g] * area, self.operators).reshape(e, q * 9, 36)
            blocks = np.matmul(P.transpose(0, 2, 1), DP).reshape(e, 2, 18, 2, 18)
            at = np.stack([M[:, g], slope[:, g]])
            K += w * np.einsum("esitj,sk,tl->kleij", blocks, at, at, optimize=True)
        if self.volume_strain == "linear":
            K += self._projected_tangent(state, weight, layer, axial)
        return f, K

    def _projected_tangent(self, state: PointState, weight: FloatArray, layer: int, axial: FloatArray) -> FloatArray:
        """lambda b^T (int p p)^-1 b with b the moments of d theta by 1, X, Y, z; shape (k, l, e, 18, 18)."""
        e, q = self.section.weight.shape
        p, inverse = self._projection
        half = self.axial(layer)[2].sum() / 2
        slope = state.slope * self.section.weight[:, :, None, None]
        moment = p.transpose(0, 1, 3, 2)[..., None] * slope.transpose(0, 2, 1, 3)[:, None]  # e a g q i
        shape = moment.shape[:3]
        both = np.matmul(moment.reshape(e, -1, q * 9), self.operators.reshape(e, q * 9, 36))
        b = np.einsum("eagsi,skg->eaki", both.reshape(*shape, 2, 18), axial, optimize=True).reshape(e, 4, -1)
        scaled = np.matmul(inverse * (self._lame[2] / half), b)
        K = np.matmul(b.transpose(0, 2, 1), scaled).reshape(e, axial.shape[1], 18, axial.shape[1], 18)
        return K.transpose(1, 3, 0, 2, 4)

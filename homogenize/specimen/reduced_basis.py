r"""A specimen in milliseconds: Galerkin projection on a few full solutions.

At fixed section mesh the stiffness is polynomial in everything that a calibration moves. With groups g of parts that take
their moduli together (factor c_g), tau the turn of the cable, L the length, and the matrices of a unit length,

.. math::  K = \sum_g c_g \bigl[ L M \otimes (E_2^{g0} + \tau E_2^{g1} + \tau^2 E_2^{g2})
           + (C \otimes (E_1^{g0} + \tau E_1^{g1}) + \text{transpose}) + S \otimes E_0^g / L \bigr].

With V the solutions at a few places, made orthonormal, V^T K V is the same sum of small matrices. The approximation is the
nearest in energy among combinations of V (Cea), so that it is stiffer than the specimen, and exact at the places themselves.
The place to add next is the one whose residual is largest (Prud'homme et al., J. Fluids Eng. 124 (2002) 70-80).

The three loads (tension, and shear along X and Y of the *loaded* section) make every phase and every transverse direction,
because a specimen held all over its end z = 0 does not know how it was turned: exact.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import SpecError
from homogenize.section_field import FloatArray, SectionField
from homogenize.section_system import section_system
from homogenize.specimen.axial_basis import AxialBasis
from homogenize.specimen.snapshot_store import SnapshotStore
from homogenize.specimen.specimen_solution import Specimen, SpecimenSolution, solve_specimen, specimen_axis
from homogenize.specimen.unit_response import UNIT_LOADS, UnitResponse, area_derivatives, mean_tilt, node_shares


@dataclass(frozen=True)
class ReducedPlace:
    """Where a specimen is wanted: factors on the moduli of the groups (g,), twist rate [rad/m], length [m]."""

    factors: tuple[float, ...]
    twist_rate: float
    length: float


class ReducedBasis:
    """Snapshots of a specimen, and the small matrices of their combinations.

    Parameters
    ----------
    mesh : CrossSectionMesh
        At twist rate and moduli of the base place.
    groups : (regions,) ints
        Group of every region; -1 for those that keep their moduli (they make a last group of factor 1).
    specimen : Specimen
        Bonded, held all over its end, free and loaded all over the other.
    tolerance : of the full solutions, in energy
    store : where solutions are kept and found again

    Raises
    ------
    SpecError
        If the specimen is of another kind.
    """

    def __init__(
        self,
        mesh: CrossSectionMesh,
        groups: Sequence[int],
        specimen: Specimen,
        tolerance: float = 1e-4,
        store: SnapshotStore | None = None,
    ) -> None:
        if specimen.interface != "bonded" or specimen.held.parts or getattr(specimen.loaded, "parts", True):
            raise SpecError(
                "a reduced basis needs a bonded specimen, held and loaded all over its ends; take the full model."
            )
        self.mesh, self.specimen, self.tolerance, self.store = mesh, specimen, tolerance, store
        self.groups = np.asarray(groups, dtype=np.int64)
        self.count = int(self.groups.max()) + 1
        basis = specimen_axis(specimen, mesh)
        self.axial = AxialBasis(basis.levels / specimen.length, basis.degree)  # of unit length
        system = section_system(mesh)
        self.field = system.field
        self.terms = _section_terms(system.field, np.where(self.groups < 0, self.count, self.groups), self.count + 1)
        self.weights = node_shares(system.field)
        self.load = np.zeros((system.field.unknowns, 3))
        for k, component in enumerate((2, 0, 1)):
            self.load[component::3, k] = self.weights
        stations = len(self.axial.stations)
        self.V = np.zeros((system.field.unknowns * stations, 0))
        self.places: list[ReducedPlace] = []
        self._small: dict[tuple[str, int], FloatArray] = {}
        self._slopes = area_derivatives(system.field)
        self._tilt = np.zeros((2, stations, 0))

    @property
    def layers(self) -> Layers:
        """The layers of every specimen of this basis, as shares of its length; stands where a grading does."""
        return Layers(self.axial)

    def full(self, place: ReducedPlace) -> SpecimenSolution:
        """The full solution on this mesh; loads of 1 N in the axes of the loaded section."""
        regions = tuple(
            r if g < 0 else replace(r, material=replace(r.material, E=r.material.E * place.factors[g]))  # pyright: ignore
            for r, g in zip(self.mesh.regions, self.groups, strict=True)
        )
        mesh = replace(self.mesh, regions=regions, twist_rate=place.twist_rate)
        specimen = replace(
            self.specimen, length=place.length, phase=-place.twist_rate * place.length, grading=self.layers
        )
        return solve_specimen(specimen, mesh, UNIT_LOADS, tolerance=self.tolerance)

    def add(self, place: ReducedPlace) -> None:
        """Solve the specimen at a place and take its three solutions into the basis."""
        shape = (self.field.unknowns, len(self.axial.stations), len(UNIT_LOADS))
        key = {"place": f"{place}", "shape": f"{shape}"}
        U = None if self.store is None else self.store.displacements(key, shape)
        if U is None:
            U = self.full(place).U
            if self.store is not None:
                self.store.keep_displacements(key, U)
        self.take(place, U)

    def take(self, place: ReducedPlace, U: FloatArray) -> None:
        """Take solutions U (n, m, 3) into the basis."""
        new = U.reshape(-1, U.shape[2])
        scale = np.linalg.norm(new, axis=0)
        new = new / scale
        for _ in range(2):
            new = new - self.V @ (self.V.T @ new)
        Q, s, _ = np.linalg.svd(new, full_matrices=False)
        if (s > 1e-9).any():
            self._extend(Q[:, s > 1e-9])
        self.places.append(place)

    def _extend(self, new: FloatArray) -> None:
        """The small matrices with new columns: those of the old ones stay as they are."""
        n, m = self.field.unknowns, len(self.axial.stations)
        old = self.V
        self.V = np.concatenate([old, new], axis=1)
        r, k = old.shape[1], new.shape[1]
        q = new.reshape(n, m, k)
        M, C, S = self.axial.matrices
        for (kind, power), matrices in self.terms.items():
            axial = {"E2": M, "E1": C, "E0": S}[kind]
            small = np.zeros((len(matrices), r + k, r + k))
            if (kind, power) in self._small:
                small[:, :r, :r] = self._small[kind, power]
            right = np.matmul(axial, q).reshape(n, m * k)
            small[:, :, r:] = _products(self.V, matrices, right, k)
            if kind == "E1":
                left = np.matmul(axial.T, q).reshape(n, m * k)
                transposed = [sp.csr_array(E.T) for E in matrices]
                small[:, r:, :r] = _products(old, transposed, left, k).transpose(0, 2, 1)
            else:  # symmetric
                small[:, r:, :r] = small[:, :r, r:].transpose(0, 2, 1)
            self._small[kind, power] = small
        self._top = self.V.reshape(n, m, -1)[:, -1]
        self._load = self.load.T @ self._top
        tilt = np.array([np.tensordot(f, q, axes=(0, 0)) for f in self._slopes])
        self._tilt = np.concatenate([self._tilt, tilt], axis=2)  # (2, m, r)

    def stiffness(self, place: ReducedPlace) -> FloatArray:
        """V^T K V at a place."""
        c = np.append(place.factors, 1.0)
        t, L = place.twist_rate, place.length
        K = 0.0
        for (kind, power), small in self._small.items():
            part = np.tensordot(c, small, axes=(0, 0)) * t**power * {"E2": L, "E1": 1.0, "E0": 1 / L}[kind]
            K = K + (part + part.T if kind == "E1" else part)
        return np.asarray(K)

    def amplitudes(self, place: ReducedPlace) -> FloatArray:
        """Amplitudes (basis, 3) of the three unit loads."""
        K = self.stiffness(place)
        d = 1 / np.sqrt(np.diag(K))
        return d[:, None] * np.linalg.solve(d[:, None] * K * d, d[:, None] * self._load.T)

    def evaluate(self, place: ReducedPlace) -> UnitResponse:
        """The approximate response at a place."""
        x = self.amplitudes(place)
        top = (self._top @ x).reshape(-1, 3, 3)
        mean = np.einsum("n,nxk->xk", self.weights, top)
        turn = place.twist_rate * place.length  # over the unit length
        return UnitResponse(
            self.field.area,
            place.length,
            top,
            mean,
            mean_tilt(np.einsum("dmr,rk->dmk", self._tilt, x) / self.field.area, self.axial, turn),
        )

    def residual(self, place: ReducedPlace) -> float:
        """|f - K V x| / |f| over all free unknowns, of the worst load."""
        x = self.amplitudes(place)
        U = (self.V @ x).reshape(self.field.unknowns, -1, 3)
        R = -self._apply(place, U)
        R[:, 0] = 0.0
        R[:, -1] += self.load
        return float((np.linalg.norm(R, axis=(0, 1)) / np.linalg.norm(self.load, axis=0)).max())

    def _apply(self, place: ReducedPlace, U: FloatArray) -> FloatArray:
        c = np.append(place.factors, 1.0)
        t, L = place.twist_rate, place.length
        M, C, S = self.axial.matrices
        n, m, k = U.shape
        total = np.zeros_like(U)
        for (kind, power), matrices in self.terms.items():
            E = sp.csr_array(sum(f * A for f, A in zip(c, matrices, strict=True)) * t**power)
            if kind == "E1":
                total += (E @ np.matmul(C, U).reshape(n, -1)).reshape(n, m, k)
                total += (E.T @ np.matmul(C.T, U).reshape(n, -1)).reshape(n, m, k)
            else:
                axial = L * M if kind == "E2" else S / L
                total += (E @ np.matmul(axial, U).reshape(n, -1)).reshape(n, m, k)
        return total


@dataclass(frozen=True)
class Layers:
    """Layers at the same shares of every length."""

    axial: AxialBasis

    def basis(self, length: float, diameter: float) -> AxialBasis:
        del diameter
        return AxialBasis(self.axial.levels * length, self.axial.degree)


def _products(V: FloatArray, matrices: Sequence[sp.csr_array], columns: FloatArray, k: int) -> FloatArray:
    """V^T (E x) of each section matrix E for k columns x held as (n, m k): (matrices, r, k)."""
    stacked = np.concatenate([(E @ columns).reshape(-1, k) for E in matrices], axis=1)
    return (V.T @ stacked).reshape(V.shape[1], len(matrices), k).transpose(1, 0, 2)


def grow(
    basis: ReducedBasis,
    candidates: Sequence[ReducedPlace],
    count: int,
    progress: Callable[[float, str], None] | None = None,
) -> list[float]:
    """Add up to `count` of the candidates, always the one of the largest residual; the residuals in their order."""
    left, found = list(candidates), []
    for i in range(min(count, len(left))):
        gaps = [basis.residual(place) for place in left] if basis.places else [np.inf] + [0.0] * (len(left) - 1)
        worst = int(np.argmax(gaps))
        found.append(float(gaps[worst]))
        basis.add(left.pop(worst))
        if progress is not None:
            progress((i + 1) / count, f"snapshot {i + 1} of {count}, residual before it {found[-1]:.1e}")
    return found


def _section_terms(
    field: SectionField, group_of: NDArray[np.int64], count: int
) -> dict[tuple[str, int], list[sp.csr_array]]:
    """E_i of each group by powers of the twist rate, by interpolation at rates 0, +t, -t: exact, E_i are polynomials."""
    t = 1.0 / np.sqrt(field.area)
    rates = (0.0, t, -t)
    terms: dict[tuple[str, int], list[sp.csr_array]] = {
        ("E2", 0): [],
        ("E2", 1): [],
        ("E2", 2): [],
        ("E1", 0): [],
        ("E1", 1): [],
        ("E0", 0): [],
    }
    for g in range(count):
        elements = group_of[field.region_of] == g
        if not elements.any():
            for matrices in terms.values():
                matrices.append(sp.csr_array((field.unknowns, field.unknowns)))
            continue
        part = replace(
            field,
            cells=field.cells[:, elements],
            gradient=field.gradient[:, :, elements],
            weight=field.weight[elements],
            position=field.position[:, elements],
            elasticity=field.elasticity[elements],
            region_of=field.region_of[elements],
            turning_elasticity=None,
        )
        at = [replace(part, twist_rate=rate).matrices() for rate in rates]
        E0, E1, E2 = zip(*at, strict=True)
        terms["E0", 0].append(sp.csr_array(E0[0]))
        terms["E1", 0].append(sp.csr_array(E1[0]))
        terms["E1", 1].append(sp.csr_array((E1[1] - E1[2]) / (2 * t)))
        terms["E2", 0].append(sp.csr_array(E2[0]))
        terms["E2", 1].append(sp.csr_array((E2[1] - E2[2]) / (2 * t)))
        terms["E2", 2].append(sp.csr_array((E2[1] + E2[2] - 2 * E2[0]) / (2 * t**2)))
    return terms

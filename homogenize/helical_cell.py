r"""The full 6x6 compliance of a helical section from two problems on its cross-section.

Displacement u = Z r + v (rigid motion r of the section plus warping v), generalised strains psi, strain
:math:`\varepsilon = B_z (Z\psi + v') + B_s v`. Section forces theta = (T_x, T_y, N, M_x, M_y, M_z) obey T' = 0 and
M' = -e_z x T, in rotating components theta' = A theta. With v = X theta and psi = Y theta equilibrium reads

.. math::
   E_2 X + (E_1^T - E_1) X A - E_0 X A^2 + E_1^T Z Y - E_0 Z Y A = 0, \qquad
   Z^T [E_0 Z Y + E_0 X A + E_1 X] = I .

A has the eigenvalues 0 (N, M_z) and +-i tau_0 (bending, and shear as its generalised vector: the moment varies
linearly under a shear force). So one real problem gives tension and torsion, one complex Hermitian problem of the same size gives bending
and shear, at any pitch. Without lay all four are real. The compliance is the energy of these fields per length,

.. math::  F = X^T E_2 X + X^T E_1^T V + V^T E_1 X + V^T E_0 V, \qquad V = X A + Z Y, \qquad C = F^{-1} .

The six free rigid motions are fixed by pinning six unknowns; their reactions vanish when the solution is in equilibrium,
which is checked on every run.

Prismatic limit: Giavotto et al., Comput. Struct. 16 (1983) 403-413, doi 10.1016/0045-7949(83)90179-7;
Blasques, Stolpe, Compos. Struct. 94 (2012) 3278-3289, doi 10.1016/j.compstruct.2012.05.013 (BECAS).
The transverse shear compliance depends on this definition (energy per length on planes z = const with the varying moment
included); stretch, twist, bending and their couplings do not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import ConvergenceError, SpecError
from homogenize.section_field import FloatArray, SectionField, section_field
from homogenize.section_stiffness import SectionStiffness
from homogenize.sliding_interface import sliding_field

ComplexArray = NDArray[np.complex128]

INTERFACES = ("bonded", "frictionless")

REACTION_LIMIT = 1e-6
"""Largest allowed reaction of the pinned unknowns, relative to the largest nodal force of the same load."""


@dataclass(frozen=True)
class HelicalCell:
    """Solved cross-section: its stiffness in the rotating frame at phase zero, and the fields behind it.

    Attributes
    ----------
    field : the finite element field
    stiffness : C, with the section standing as drawn (phase zero)
    X, V : (3n, 6) warping and axial derivative of the displacement per unit section force
    X_shear, V_shear : (3n, 2) the same per unit mean shear stress xz and yz, see :mod:`homogenize.volume_average`
    reaction : largest relative reaction of the pinned unknowns (a check of equilibrium)
    interface : "bonded" or "frictionless"
    """

    field: SectionField
    stiffness: SectionStiffness
    X: FloatArray
    V: FloatArray
    X_shear: FloatArray
    V_shear: FloatArray
    reaction: float
    interface: str = "bonded"

    def strain(self, section_forces: FloatArray) -> FloatArray:
        """Local strain, shape (e, q, 6), order xx yy zz yz xz xy, under section forces (6,) in the rotating frame."""
        theta = np.asarray(section_forces, dtype=float)[:, None]
        return self.field.strain(self.X @ theta, self.V @ theta)[..., 0]

    def stress(self, section_forces: FloatArray) -> FloatArray:
        """Local stress [Pa], shape (e, q, 6), order xx yy zz yz xz xy."""
        return np.matmul(self.field.point_elasticity, self.strain(section_forces)[..., None])[..., 0]

    def shear_strain(self) -> FloatArray:
        """Local strain, shape (e, q, 6, 2), per unit mean shear stress xz and yz [1/Pa]."""
        return self.field.strain(self.X_shear, self.V_shear)


@dataclass(frozen=True)
class _Pencil:
    """The matrices of the section problem."""

    E0: sp.csr_array
    skew: sp.csr_array  # E1^T - E1
    E1: sp.csr_array
    E2: sp.csr_array
    Z: FloatArray
    length: float  # square root of the area: turns a force of uniform strain into a nodal force for comparison


def solve_helical_cell(mesh: CrossSectionMesh, interface: str = "bonded") -> HelicalCell:
    """Stiffness of the beam section equivalent to a long helical cable.

    Parameters
    ----------
    mesh : CrossSectionMesh
        Cross-section with its regions, materials and twist rate.
    interface : str
        ``"bonded"``, or ``"frictionless"``: the conductors slide in what surrounds them, without friction and without opening.

    Returns
    -------
    HelicalCell
        ``stiffness.C`` (6, 6) in N, N m, N m^2 at phase zero; see :func:`homogenize.pitch_average` for its mean over a pitch.

    Raises
    ------
    SpecError
        If the interface is not known.
    ConvergenceError
        If the linear solution is not in equilibrium, for instance because a part is not connected to the rest.
    """
    if interface not in INTERFACES:
        raise SpecError(f'the interface "{interface}" is not known; choose {" or ".join(INTERFACES)}.')
    field = section_field(mesh)
    tau = mesh.twist_rate
    if interface == "bonded":
        T, Z, pins = None, field.rigid_motion(), ()
        gauge = _gauge(field.nodes, np.ones(field.nodes.shape[1], dtype=bool))
    else:
        parts = sliding_field(field, mesh)
        gauge = _gauge(field.nodes, parts.anchored)
        field, T, Z, pins = parts.field, parts.T, parts.Z, parts.slip_pins
    E0, E1, E2 = field.matrices()
    if T is not None:
        E0, E1, E2 = (sp.csr_array(T.T @ E @ T) for E in (E0, E1, E2))
    pencil = _Pencil(E0, sp.csr_array(E1.T - E1), E1, E2, Z, field.area**0.5)
    axial = _Solver(pencil, 0.0, (*gauge, *pins))
    harmonic = axial if tau == 0.0 else _Solver(pencil, 1j * tau, gauge)
    loads, reaction = _solve_loads(axial, harmonic)
    X, V = _real_columns(loads, pencil.Z)
    X_shear, V_shear, shear_reaction = _solve_uniform_shear(field, harmonic, T)
    C = np.linalg.inv(_compliance(pencil, X, V))
    stiffness = SectionStiffness(0.5 * (C + C.T), field.area)
    if T is not None:
        X, V, X_shear, V_shear = (T @ u for u in (X, V, X_shear, V_shear))
    return HelicalCell(field, stiffness, X, V, X_shear, V_shear, max(reaction, shear_reaction), interface)


def _gauge(nodes: FloatArray, usable: NDArray[np.bool_]) -> tuple[int, ...]:
    """Six unknowns to pin: uX uY uZ at the node nearest the axis, uY uZ at one far along +X from it, uZ at one far along +Y."""
    X, Y = np.where(usable, nodes, np.nan)
    centre = int(np.nanargmin(X**2 + Y**2))
    dX, dY = X - X[centre], Y - Y[centre]
    right, top = int(np.nanargmax(dX - np.abs(dY))), int(np.nanargmax(dY - np.abs(dX)))
    return 3 * centre, 3 * centre + 1, 3 * centre + 2, 3 * right + 1, 3 * right + 2, 3 * top + 2


CIRCULAR = np.array([1.0, 1j, 0.0]) / np.sqrt(2)
"""A vector that turns with the section: L a = -i a, so that loads a exp(i tau_0 z) are constant in fixed axes."""

COMPLEX_LOADS = {
    "N": np.eye(6)[2],
    "Mz": np.eye(6)[5],
    "M+": np.concatenate([np.zeros(3), CIRCULAR]),
    "T+": np.concatenate([CIRCULAR, np.zeros(3)]),
}


def _solve_loads(axial: _Solver, harmonic: _Solver) -> tuple[dict[str, tuple], float]:
    """Solutions (x, y, XA part) for N, M_z, M_+ and T_+, and the largest relative reaction at the pins."""
    pencil, lam = harmonic.pencil, harmonic.lam
    loads: dict[str, tuple] = {}
    nothing = np.zeros(pencil.Z.shape[0])
    x_N, y_N, r_N = axial.solve(nothing, COMPLEX_LOADS["N"])
    x_Mz, y_Mz, r_Mz = axial.solve(nothing, COMPLEX_LOADS["Mz"])
    loads["N"], loads["Mz"] = (x_N, y_N, 0 * x_N), (x_Mz, y_Mz, 0 * x_Mz)
    x_M, y_M, r_M = harmonic.solve(nothing.astype(complex), COMPLEX_LOADS["M+"])
    f = -1j * (pencil.skew @ x_M - 2 * lam * (pencil.E0 @ x_M)) + 1j * (pencil.E0 @ (pencil.Z @ y_M))
    t = COMPLEX_LOADS["T+"] - 1j * (pencil.Z.T @ (pencil.E0 @ x_M))
    x_T, y_T, r_T = harmonic.solve(f, t)
    loads["M+"], loads["T+"] = (x_M, y_M, lam * x_M), (x_T, y_T, lam * x_T + 1j * x_M)
    return loads, max(r_N, r_Mz, r_M, r_T)


def _solve_uniform_shear(
    field: SectionField, harmonic: _Solver, T: sp.csr_array | None
) -> tuple[FloatArray, FloatArray, float]:
    """Fields of the tractions s.n of a uniform shear stress s on the sides: the moment stays zero, every section is alike.

    The nodal forces are int (B_s + lam B_z)^H s; the section carries the shear force A s.
    """
    lam = harmonic.lam
    a = CIRCULAR
    stress = np.array([0, 0, 0, a[1], a[0], 0])
    f_s, f_z = (_nodal_forces(field, B, stress) for B in (field.strain_s, field.strain_z))
    if T is not None:
        f_s, f_z = T.T @ f_s, T.T @ f_z
    x, y, reaction = harmonic.solve(f_s - lam * f_z, harmonic.pencil.Z.T @ f_z)
    v = lam * x + harmonic.pencil.Z @ y
    inverse = np.linalg.inv(np.array([a[:2], a[:2].conj()]).T)
    X, V = (np.array([w, w.conj()]).T @ inverse for w in (x, v))
    return np.ascontiguousarray(X.real), np.ascontiguousarray(V.real), reaction


def _nodal_forces(field: SectionField, B: FloatArray, stress: NDArray) -> ComplexArray:
    """Nodal forces int B^T stress of a uniform stress."""
    local = np.einsum("eq,eqik,i->ek", field.weight, np.broadcast_to(B, (len(field.weight), *B.shape[1:])), stress)
    f = np.zeros(field.unknowns, dtype=complex)
    np.add.at(f, field.element_dofs.ravel(), local.ravel())
    return f


class _Solver:
    """Factor of K(lam) = E2 + lam (E1^T - E1) - lam^2 E0 without the pinned unknowns, with the six strains y by Schur complement."""

    def __init__(self, pencil: _Pencil, lam: complex, pinned: tuple[int, ...]) -> None:
        self.pencil, self.lam = pencil, lam
        self.free = np.ones(pencil.Z.shape[0], dtype=bool)
        self.free[list(pinned)] = False
        K = pencil.E2 if lam == 0 else pencil.E2 + lam * pencil.skew - lam**2 * pencil.E0
        self.K = sp.csr_array(K)
        R = pencil.E1.T @ pencil.Z - lam * (pencil.E0 @ pencil.Z)
        self.R = R.real if lam == 0 else R
        free = self.free
        inner = sp.csc_matrix(self.K[free][:, free])
        try:
            self.factor = spla.splu(
                inner, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
            )
        except RuntimeError:
            raise ConvergenceError(
                "the section problem is singular: some part of the section is not connected to the rest; "
                "check that every region shares nodes with a neighbour."
            ) from None
        self.X_R = self._back(self.R)
        self.schur = pencil.Z.T @ (pencil.E0 @ pencil.Z) - self.R.conj().T @ self.X_R

    def _back(self, rhs: NDArray) -> NDArray:
        out = np.zeros(rhs.shape, dtype=np.result_type(rhs, self.K.dtype))
        free = self.free
        b = np.ascontiguousarray(rhs[free].astype(out.dtype))
        if np.iscomplexobj(b) and not np.iscomplexobj(self.K.data):
            out[free] = self.factor.solve(np.real(b).copy()) + 1j * self.factor.solve(np.imag(b).copy())
        else:
            out[free] = self.factor.solve(b)
        return out

    def solve(self, f: NDArray, t: NDArray) -> tuple[NDArray, NDArray, float]:
        """x, y of [K R; R^H Q0][x; y] = [f; t], and the relative reaction at the pins."""
        x_f = self._back(f)
        y = np.linalg.solve(self.schur, t - self.R.conj().T @ x_f)
        x = x_f - self.X_R @ y
        load = self.R @ y
        residual = self.K @ x + load - f
        uniform = np.abs(self.pencil.E0 @ (self.pencil.Z @ y)).max() / self.pencil.length
        scale = max(np.abs(load).max(), np.abs(f).max(), uniform)
        reaction = float(np.abs(residual).max() / scale)
        if not reaction < REACTION_LIMIT:
            raise ConvergenceError(
                f"the section problem is out of balance by {reaction:.1e} of its nodal forces (allowed {REACTION_LIMIT:.0e}); "
                "check for parts that are not connected, or for a contrast of moduli above 1e9."
            )
        return x, y, reaction


def _real_columns(loads: dict[str, tuple], Z: FloatArray) -> tuple[FloatArray, FloatArray]:
    """X and V = XA + ZY per unit (T_x, T_y, N, M_x, M_y, M_z) from the solutions per complex load."""
    columns, values_x, values_v = [], [], []
    for name, (x, y, xa) in loads.items():
        v = xa + Z @ y
        columns.append(COMPLEX_LOADS[name])
        values_x.append(x)
        values_v.append(v)
        if name.endswith("+"):
            columns.append(COMPLEX_LOADS[name].conj())
            values_x.append(x.conj())
            values_v.append(v.conj())
    inverse = np.linalg.inv(np.array(columns).T)
    X, V = np.array(values_x).T @ inverse, np.array(values_v).T @ inverse
    return np.ascontiguousarray(X.real), np.ascontiguousarray(V.real)


def _compliance(pencil: _Pencil, X: FloatArray, V: FloatArray) -> FloatArray:
    mixed = X.T @ (pencil.E1.T @ V)
    F = X.T @ (pencil.E2 @ X) + mixed + mixed.T + V.T @ (pencil.E0 @ V)
    return 0.5 * (F + F.T)

r"""The full 6x6 compliance of a helical section from two problems on its cross-section.

Displacement u = Z r + v (rigid motion r of the section plus warping v), generalised strains psi, strain
:math:`\varepsilon = B_z (Z\psi + v') + B_s v`. Section forces theta = (T_x, T_y, N, M_x, M_y, M_z) obey T' = 0 and
M' = -e_z x T, in rotating components theta' = A theta. With v = X theta and psi = Y theta equilibrium reads

.. math::
   E_2 X + (E_1^T - E_1) X A - E_0 X A^2 + E_1^T Z Y - E_0 Z Y A = 0, \qquad
   Z^T [E_0 Z Y + E_0 X A + E_1 X] = I .

A has the eigenvalues 0 (N, M_z) and +-i tau_0 (bending, and shear as its generalised vector: the moment varies linearly
under a shear force). So one real problem gives tension and torsion, one complex Hermitian problem of the same size gives bending
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
from geometry.errors import ConvergenceError
from homogenize.section_field import FloatArray, SectionField, section_field
from homogenize.section_stiffness import SectionStiffness

ComplexArray = NDArray[np.complex128]

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
    reaction : largest relative reaction of the pinned unknowns (a check of equilibrium)
    """

    field: SectionField
    stiffness: SectionStiffness
    X: FloatArray
    V: FloatArray
    reaction: float

    def strain(self, section_forces: FloatArray) -> FloatArray:
        """Local strain, shape (e, q, 6), order xx yy zz yz xz xy, under section forces (6,) in the rotating frame."""
        theta = np.asarray(section_forces, dtype=float)[:, None]
        return self.field.strain(self.X @ theta, self.V @ theta)[..., 0]

    def stress(self, section_forces: FloatArray) -> FloatArray:
        """Local stress [Pa], shape (e, q, 6), order xx yy zz yz xz xy."""
        return np.matmul(self.field.elasticity[:, None], self.strain(section_forces)[..., None])[..., 0]


@dataclass(frozen=True)
class _Pencil:
    """The matrices of the section problem and the pinned gauge."""

    E0: sp.csr_array
    skew: sp.csr_array  # E1^T - E1
    E1: sp.csr_array
    E2: sp.csr_array
    Z: FloatArray
    free: NDArray[np.bool_]
    length: float  # square root of the area: turns a force of uniform strain into a nodal force for comparison


def solve_helical_cell(mesh: CrossSectionMesh) -> HelicalCell:
    """Stiffness of the beam section equivalent to a long helical cable, all interfaces bonded.

    Parameters
    ----------
    mesh : CrossSectionMesh
        Cross-section with its regions, materials and twist rate.

    Returns
    -------
    HelicalCell
        ``stiffness.C`` (6, 6) in N, N m, N m^2 at phase zero; see :func:`homogenize.pitch_average` for its mean over a pitch.

    Raises
    ------
    ConvergenceError
        If the linear solution is not in equilibrium, for instance because a part is not connected to the rest.
    """
    field = section_field(mesh)
    E0, E1, E2 = field.matrices()
    pencil = _Pencil(E0, sp.csr_array(E1.T - E1), E1, E2, field.rigid_motion(), _free_unknowns(field), field.area**0.5)
    tau = mesh.twist_rate
    loads, reaction = _solve_loads(pencil, tau)
    X, V = _real_columns(loads, pencil.Z, tau)
    F = _compliance(pencil, X, V)
    C = np.linalg.inv(F)
    return HelicalCell(field, SectionStiffness(0.5 * (C + C.T), field.area), X, V, reaction)


def _free_unknowns(field: SectionField) -> NDArray[np.bool_]:
    """All unknowns but six: uX uY uZ at the node nearest the axis, uY uZ at one far along +X from it, uZ at one far along +Y."""
    X, Y = field.nodes
    centre = int(np.argmin(X**2 + Y**2))
    dX, dY = X - X[centre], Y - Y[centre]
    right, top = int(np.argmax(dX - np.abs(dY))), int(np.argmax(dY - np.abs(dX)))
    free = np.ones(field.unknowns, dtype=bool)
    free[[3 * centre, 3 * centre + 1, 3 * centre + 2, 3 * right + 1, 3 * right + 2, 3 * top + 2]] = False
    return free


def _solve_loads(pencil: _Pencil, tau: float) -> tuple[dict[str, tuple], float]:
    """Solutions (x, y, x' part) for N, M_z, M_+ and T_+."""
    a = np.array([1.0, 1j, 0.0]) / np.sqrt(2)
    zero3 = np.zeros(3)
    n = pencil.Z.shape[0]
    axial = _Solver(pencil, 0.0)
    loads: dict[str, tuple] = {}
    reaction = 0.0
    for name, t in (("N", np.eye(6)[2]), ("Mz", np.eye(6)[5])):
        x, y, r = axial.solve(np.zeros(n), t)
        loads[name] = (x, y, 0 * x)
        reaction = max(reaction, r)
    lam = 1j * tau
    harmonic = axial if tau == 0.0 else _Solver(pencil, lam)
    x_M, y_M, r_M = harmonic.solve(np.zeros(n, complex), np.concatenate([zero3, a]))
    f = -1j * (pencil.skew @ x_M - 2 * lam * (pencil.E0 @ x_M)) + 1j * (pencil.E0 @ (pencil.Z @ y_M))
    t = np.concatenate([a, zero3]) - 1j * (pencil.Z.T @ (pencil.E0 @ x_M))
    x_T, y_T, r_T = harmonic.solve(f, t)
    loads["M+"] = (x_M, y_M, lam * x_M)
    loads["T+"] = (x_T, y_T, lam * x_T + 1j * x_M)
    return loads, max(reaction, r_M, r_T)


class _Solver:
    """Factor of K(lam) = E2 + lam (E1^T - E1) - lam^2 E0 without the pinned unknowns, with the six strains y by Schur complement."""

    def __init__(self, pencil: _Pencil, lam: complex) -> None:
        self.pencil = pencil
        K = pencil.E2 if lam == 0 else pencil.E2 + lam * pencil.skew - lam**2 * pencil.E0
        self.K = sp.csr_array(K)
        R = pencil.E1.T @ pencil.Z - lam * (pencil.E0 @ pencil.Z)
        self.R = R.real if lam == 0 else R
        free = pencil.free
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
        free = self.pencil.free
        b = np.ascontiguousarray(rhs[free].astype(out.dtype))
        if np.iscomplexobj(b) and not np.iscomplexobj(self.K.data):
            out[free] = self.factor.solve(b.real.copy()) + 1j * self.factor.solve(b.imag.copy())
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


def _real_columns(loads: dict[str, tuple], Z: FloatArray, tau: float) -> tuple[FloatArray, FloatArray]:
    """X and V = XA + ZY per unit (T_x, T_y, N, M_x, M_y, M_z) from the solutions per complex load."""
    a = np.array([1.0, 1j, 0.0]) / np.sqrt(2)
    zero3 = np.zeros(3)
    q = {
        "N": np.eye(6)[2],
        "Mz": np.eye(6)[5],
        "M+": np.concatenate([zero3, a]),
        "T+": np.concatenate([a, zero3]),
    }
    columns, values_x, values_v = [], [], []
    for name, (x, y, xa) in loads.items():
        v = xa + Z @ y
        columns.append(q[name])
        values_x.append(x)
        values_v.append(v)
        if name.endswith("+"):
            columns.append(q[name].conj())
            values_x.append(x.conj())
            values_v.append(v.conj())
    inverse = np.linalg.inv(np.array(columns).T)
    X, V = np.array(values_x).T @ inverse, np.array(values_v).T @ inverse
    return np.ascontiguousarray(X.real), np.ascontiguousarray(V.real)


def _compliance(pencil: _Pencil, X: FloatArray, V: FloatArray) -> FloatArray:
    mixed = X.T @ (pencil.E1.T @ V)
    F = X.T @ (pencil.E2 @ X) + mixed + mixed.T + V.T @ (pencil.E0 @ V)
    return 0.5 * (F + F.T)

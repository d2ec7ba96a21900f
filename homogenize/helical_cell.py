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
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import ConvergenceError
from homogenize.interface_choice import Interfaces
from homogenize.section_field import FloatArray, SectionField
from homogenize.section_problem import REACTION_LIMIT, SectionPencil, SectionSolver
from homogenize.section_stiffness import SectionStiffness
from homogenize.section_system import INTERFACES, section_system

ComplexArray = NDArray[np.complex128]

__all__ = ["INTERFACES", "REACTION_LIMIT", "HelicalCell", "solve_helical_cell"]


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
    interface : "bonded", "frictionless", or the interfaces in words
    free_motions : motions of parts that cost nothing and were held, in words
    interface_compliance : (6, 6) part of C^-1 that is the energy of elastic interfaces; None where all parts are bonded
    """

    field: SectionField
    stiffness: SectionStiffness
    X: FloatArray
    V: FloatArray
    X_shear: FloatArray
    V_shear: FloatArray
    reaction: float
    interface: str = "bonded"
    free_motions: tuple[str, ...] = ()
    interface_compliance: FloatArray | None = None

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


def solve_helical_cell(mesh: CrossSectionMesh, interface: str | Interfaces = "bonded") -> HelicalCell:
    """Stiffness of the beam section equivalent to a long helical cable.

    Parameters
    ----------
    mesh : CrossSectionMesh
        Cross-section with its regions, materials and twist rate.
    interface : str or Interfaces
        ``"bonded"``; ``"frictionless"``: the conductors slide in what surrounds them, without friction and without opening; or
        :class:`~homogenize.interface_choice.Interfaces`, which names the parts that slide and the law of each interface.

    Returns
    -------
    HelicalCell
        ``stiffness.C`` (6, 6) in N, N m, N m^2 at phase zero; see :func:`homogenize.pitch_average` for its mean over a pitch.

    Raises
    ------
    SpecError
        If the interface is not known, or its law depends on the history of the load.
    MeshError
        If the interface names parts that are not there or do not touch, or a part touches nothing.
    ConvergenceError
        If the linear solution is not in equilibrium.
    """
    system = section_system(mesh, interface)
    pencil, T, tau = system.pencil, system.T, mesh.twist_rate
    axial = SectionSolver(pencil, 0.0, (*system.gauge, *system.slip_pins))
    harmonic = axial if tau == 0.0 else SectionSolver(pencil, 1j * tau, system.gauge)
    try:
        loads, reaction = _solve_loads(axial, harmonic)
    except ConvergenceError:
        if tau == 0.0 and system.free_motions:
            raise ConvergenceError(
                f"the cable is straight and {system.free_motions[0]} without resistance, so that its bending has no steady state: the slip "
                "grows along the whole cable; give the cable a lay, or the interface a stiffness, Elastic(k_t)."
            ) from None
        raise
    X, V = _real_columns(loads, pencil.Z)
    X_shear, V_shear, shear_reaction = _solve_uniform_shear(system.field, harmonic, T)
    C = np.linalg.inv(_compliance(pencil, X, V))
    stiffness = SectionStiffness(0.5 * (C + C.T), system.field.area)
    slips = None
    if T is not None:
        slips = X.T @ (system.slip_stiffness[:, None] * X)
        X, V, X_shear, V_shear = (T @ u for u in (X, V, X_shear, V_shear))
    words = interface if isinstance(interface, str) else interface.describe()
    worst = max(reaction, shear_reaction)
    return HelicalCell(system.field, stiffness, X, V, X_shear, V_shear, worst, words, system.free_motions, slips)


CIRCULAR = np.array([1.0, 1j, 0.0]) / np.sqrt(2)
"""A vector that turns with the section: L a = -i a, so that loads a exp(i tau_0 z) are constant in fixed axes."""

COMPLEX_LOADS = {
    "N": np.eye(6)[2],
    "Mz": np.eye(6)[5],
    "M+": np.concatenate([np.zeros(3), CIRCULAR]),
    "T+": np.concatenate([CIRCULAR, np.zeros(3)]),
}


def _solve_loads(axial: SectionSolver, harmonic: SectionSolver) -> tuple[dict[str, tuple], float]:
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
    field: SectionField, harmonic: SectionSolver, T: sp.csr_array | None
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


def _compliance(pencil: SectionPencil, X: FloatArray, V: FloatArray) -> FloatArray:
    mixed = X.T @ (pencil.E1.T @ V)
    F = X.T @ (pencil.E2 @ X) + mixed + mixed.T + V.T @ (pencil.E0 @ V)
    return 0.5 * (F + F.T)

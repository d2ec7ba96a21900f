r"""The linear problem on the cross-section at one axial wave number, and the six strains of the beam beside it.

With E0, E1, E2 and the rigid motions Z of :mod:`homogenize.helical_cell`, a field v exp(lam z) and strains y exp(lam z) obey

.. math::
   \begin{bmatrix} K & R \\ R^H & Q_0 \end{bmatrix} \begin{bmatrix} x \\ y \end{bmatrix}
   = \begin{bmatrix} f \\ t \end{bmatrix}, \qquad
   K = E_2 + \lambda (E_1^T - E_1) - \lambda^2 E_0, \quad R = (E_1^T - \lambda E_0) Z, \quad Q_0 = Z^T E_0 Z .

Six unknowns are pinned against rigid motion and y follows from the Schur complement; the reactions at the pins vanish when the
section is in equilibrium, which is checked on every solution.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from numpy.typing import NDArray

from geometry.errors import ConvergenceError
from homogenize.section_field import FloatArray

REACTION_LIMIT = 1e-6
"""Largest allowed reaction of the pinned unknowns, relative to the largest nodal force of the same load."""


@dataclass(frozen=True)
class SectionPencil:
    """The matrices of the section problem.

    ``skew`` is E1^T - E1; ``length`` the square root of the area, which turns a force of uniform strain into a nodal force.
    """

    E0: sp.csr_array
    skew: sp.csr_array
    E1: sp.csr_array
    E2: sp.csr_array
    Z: FloatArray
    length: float


def gauge_unknowns(nodes: FloatArray, usable: NDArray[np.bool_]) -> tuple[int, ...]:
    """Six unknowns to pin: uX uY uZ at the node nearest the axis, uY uZ at one far along +X from it, uZ at one far along +Y."""
    X, Y = np.where(usable, nodes, np.nan)
    centre = int(np.nanargmin(X**2 + Y**2))
    dX, dY = X - X[centre], Y - Y[centre]
    right, top = int(np.nanargmax(dX - np.abs(dY))), int(np.nanargmax(dY - np.abs(dX)))
    return 3 * centre, 3 * centre + 1, 3 * centre + 2, 3 * right + 1, 3 * right + 2, 3 * top + 2


class SectionSolver:
    """Factor of K(lam) without the pinned unknowns, with the six strains y by Schur complement.

    Attributes
    ----------
    X_R : K^-1 R on the free unknowns, zero at the pins
    schur : Q0 - R^H K^-1 R, the (6, 6) stiffness of the strains y
    """

    def __init__(self, pencil: SectionPencil, lam: complex, pinned: tuple[int, ...]) -> None:
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
        self.X_R = self.back(self.R)
        self.schur = pencil.Z.T @ (pencil.E0 @ pencil.Z) - self.R.conj().T @ self.X_R

    def back(self, rhs: NDArray) -> NDArray:
        """K^-1 rhs on the free unknowns, zero at the pinned ones; rhs (unknowns,) or (unknowns, columns)."""
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
        x_f = self.back(f)
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

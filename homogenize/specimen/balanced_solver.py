r"""Conjugate gradients for the specimen, several loads at once, balanced by the rods' motions.

With Q the coarse solve and B the strips' inverse the directions are :math:`z = (I - Q K) B r`, and the start :math:`u_0 = Q f` makes
every residual orthogonal to the coarse space. One product with K in an iteration. The iteration stops when the energy of the
correction falls below `tolerance`^2 of the energy of the solution: sqrt(r.z) <= tolerance sqrt(f.u).

The strips do not couple the plane volume strain with du_z/dz, so that iterations grow with the square root of the ratio of bulk to shear
modulus where Poisson's ratio comes near 0.5.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from geometry.errors import ConvergenceError
from homogenize.section_field import FloatArray
from homogenize.specimen.end_condition import EndMap
from homogenize.specimen.rod_motions import RodMotions
from homogenize.specimen.strip_preconditioner import StripPreconditioner
from homogenize.specimen.swept_operator import SweptOperator

MOST_ITERATIONS = 1000


@dataclass(frozen=True)
class BalancedSolution:
    """Displacements (n, m, loads), iterations, and sqrt(r.z / f.u) of the worst load."""

    U: FloatArray
    iterations: int
    error: float


class BalancedSolver:
    """Everything that is factored once for a specimen; any number of loads after that."""

    def __init__(self, operator: SweptOperator, W: FloatArray, ends: tuple[EndMap, EndMap]) -> None:
        self.operator, self.ends = operator, ends
        self.rods = RodMotions(operator, W, ends)
        self.strips = StripPreconditioner(operator, ends)

    def solve(
        self, F: FloatArray, tolerance: float = 1e-6, watch: Callable[[int, float], None] | None = None
    ) -> BalancedSolution:
        """Displacements of forces F (n, m, loads).

        Raises
        ------
        ConvergenceError
            If the iteration does not come below the tolerance.
        """
        x = self.rods.solve(F)
        U, R = self.rods.displacement(x), F - self.rods.forces(x)
        Z = KZ = P = Q = np.zeros(0)
        rz = np.ones(F.shape[2])
        error = np.inf
        for count in range(MOST_ITERATIONS + 1):
            Z, KZ = self._direction(R)
            new = np.einsum("nmk,nmk->k", R, Z)
            work = np.einsum("nmk,nmk->k", F, U)
            error = float(np.sqrt(np.abs(new).max(initial=0.0) and (np.abs(new) / (work + np.abs(new))).max()))
            if watch is not None:
                watch(count, error)
            if error <= tolerance:
                return BalancedSolution(U, count, error)
            P, Q = (Z, KZ) if count == 0 else (Z + (new / rz) * P, KZ + (new / rz) * Q)
            rz = new
            curvature = np.einsum("nmk,nmk->k", P, Q)
            step = np.where(curvature > 0, rz / np.where(curvature > 0, curvature, 1.0), 0.0)
            U = U + step * P
            R = R - step * Q
        raise ConvergenceError(
            f"the specimen's displacements are known to {error:.1e} only after {MOST_ITERATIONS} iterations (wanted {tolerance:.0e}). "
            "The nearer Poisson's ratio of a rubber is to 0.5 the more it needs, eight times as many at 0.4999 as at 0.49: "
            "try 0.49 (the moduli of a specimen change by 3 % and less), or a larger tolerance."
        )

    def _direction(self, R: FloatArray) -> tuple[FloatArray, FloatArray]:
        Z = self.strips.apply(R)
        KZ = self.operator.apply(Z)
        x = self.rods.solve(KZ)
        return Z - self.rods.displacement(x), KZ - self.rods.forces(x)

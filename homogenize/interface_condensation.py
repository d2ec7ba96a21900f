r"""The section condensed onto its slips, one axial harmonic at a time.

For slips s exp(i k tau_0 z) on the rubbing interfaces everything else is in equilibrium. With B for all other unknowns (the slip free of
force on frictionless and elastic interfaces included) and lam = i k tau_0,

.. math::
   \bar S = K_{ss} - K_{sB} K_{BB}^{-1} K_{Bs}, \quad \bar A = R_s - K_{sB} K_{BB}^{-1} R_B, \quad
   \bar C = Q_0 - R_B^H K_{BB}^{-1} R_B .

The strains y of the beam depend on how rigid motions were fixed; the forces q that are in equilibrium in this harmonic (N and M_z
for k = 0; a moment that stands still in fixed axes, (0; a) with a = (1, i, 0)/sqrt 2, for k = 1; none for k >= 2) do work on strains
that do not, e = Q^H y. Eliminating y under t = Q F leaves the energy per length

.. math::
   W = \tfrac12 e^H C e + \mathrm{Re}\; s^H A\, e + \tfrac12 s^H S s, \qquad
   C = (Q^H \bar C^{-1} Q)^{-1}, \; G = \bar A \bar C^{-1} Q, \; A = G C, \; S = \bar S - \bar A \bar C^{-1} \bar A^H + G C G^H ,

section forces F = C e + A^H s, and the force A e + S s that friction must put on the slipping part. C is the
bonded stiffness; C - A^H S^+ A the stiffness without friction. One factor and one solve
for each slip unknown per harmonic; no solve later, whatever the load path.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from homogenize.section_problem import SectionSolver
from homogenize.section_system import SectionSystem

Progress = Callable[[float, str], None]

AXIAL = np.eye(6)[:, [2, 5]]
"""The forces in equilibrium at k = 0: N and M_z."""
BENDING = np.array([[0, 0, 0, 1, 1j, 0]]).T / np.sqrt(2)
"""The moment in equilibrium at k = 1: constant in fixed axes."""
_BLOCK = 64


@dataclass(frozen=True)
class CondensedHarmonic:
    """Energy of harmonic `order`: `C` (p, p), `A` (2m, p), `S` (2m, 2m) for m slipping nodes; p = 2, 1 or 0 strains."""

    order: int
    C: NDArray
    A: NDArray
    S: NDArray

    @property
    def frictionless(self) -> NDArray:
        """C - A^H S^+ A (p, p): the stiffness when every slip is free."""
        values, vectors = np.linalg.eigh(self.S)
        kept = values > 1e-9 * values.max(initial=0.0)
        part = vectors[:, kept].conj().T @ self.A
        return self.C - part.conj().T @ (part / values[kept, None])


def condense(system: SectionSystem, slips: NDArray[np.int64], order: int) -> CondensedHarmonic:
    """Condense a section onto slip unknowns in the harmonic exp(i order tau_0 z).

    Raises
    ------
    ConvergenceError
        If the section with these slips blocked is not connected.
    """
    pencil = system.pencil
    lam = 1j * order * system.field.twist_rate if order else 0.0
    pinned = [*slips.tolist()]
    if order <= 1:
        pinned += system.gauge
    if order == 0:
        pinned += system.slip_pins
    solver = SectionSolver(pencil, lam, tuple(dict.fromkeys(pinned)))
    columns = solver.K[:, slips].tocsc()
    S = solver.K[slips][:, slips].toarray()
    for start in range(0, len(slips), _BLOCK):
        some = slice(start, start + _BLOCK)
        S[:, some] -= columns.conj().T @ solver.back(columns[:, some].toarray())
    S = 0.5 * (S + S.conj().T)
    nothing = np.zeros((len(slips), 0), dtype=S.dtype)
    if order > 1:
        return CondensedHarmonic(order, np.zeros((0, 0), dtype=S.dtype), nothing, S)
    Q = AXIAL if order == 0 else BENDING
    A = solver.R[slips] - columns.conj().T @ solver.X_R
    compliance = np.linalg.inv(solver.schur)
    C = np.linalg.inv(Q.conj().T @ compliance @ Q)
    G = A @ compliance @ Q
    S = S - A @ compliance @ A.conj().T + G @ C @ G.conj().T
    return CondensedHarmonic(order, 0.5 * (C + C.conj().T), G @ C, 0.5 * (S + S.conj().T))


def condense_all(
    system: SectionSystem, slips: NDArray[np.int64], orders: tuple[int, ...], progress: Progress | None = None
) -> tuple[CondensedHarmonic, ...]:
    """All harmonics that are asked for, one after another."""
    found = []
    for i, order in enumerate(orders):
        if progress:
            progress(i / len(orders), f"condensing harmonic {order} onto {len(slips)} slips")
        found.append(condense(system, slips, order))
    return tuple(found)


def without_torque(harmonic: CondensedHarmonic) -> CondensedHarmonic:
    """Harmonic 0 with the stretch alone: the twist eliminated under M_z = 0."""
    C, A = harmonic.C, harmonic.A
    ratio = C[1, 0] / C[1, 1]
    return CondensedHarmonic(
        0,
        np.array([[C[0, 0] - C[0, 1] * ratio]]),
        A[:, :1] - A[:, 1:] * ratio,
        harmonic.S - np.outer(A[:, 1], A[:, 1]) / C[1, 1],
    )


def force_driven(harmonic: CondensedHarmonic, forced: NDArray[np.bool_]) -> CondensedHarmonic:
    """The same energy with some forces f given in the place of their strains (a partial Legendre transform).

    With G(e_s, F_f, x) = min over e_f of W - F_f e_f the loads are (e_s, F_f), in the places of their strains; C y + A^H x are the
    forces at the strains that are left, and minus the strains where the force is given.
    """
    if not np.any(forced) or not len(harmonic.C):
        return harmonic
    C, A = harmonic.C, harmonic.A
    f, s = np.flatnonzero(forced), np.flatnonzero(~forced)
    soft = np.linalg.inv(C[np.ix_(f, f)])
    across = soft @ C[np.ix_(f, s)]
    new_C, new_A = np.zeros_like(C), np.zeros_like(A)
    new_C[np.ix_(s, s)] = C[np.ix_(s, s)] - C[np.ix_(s, f)] @ across
    new_C[np.ix_(f, s)], new_C[np.ix_(s, f)] = across, across.conj().T
    new_C[np.ix_(f, f)] = -soft
    new_A[:, s] = A[:, s] - A[:, f] @ across
    new_A[:, f] = A[:, f] @ soft
    return CondensedHarmonic(harmonic.order, new_C, new_A, harmonic.S - A[:, f] @ soft @ A[:, f].conj().T)

r"""Coulomb friction on the slips of a condensed section: one load step as a convex minimum.

Over a step the slips s of all nodes minimise

.. math::
   \tfrac12 \langle s, S s \rangle + \langle s, A e \rangle + \sum_i c_i\, |s_i - s_i^{old}|, \qquad c_i = \mu\, p_i\, w_i ,

p_i the grip pressure, w_i the surface of node i per length: stick where the traction stays inside the cone |t_i| <= mu p_i, else slip
along the traction with |t_i| = mu p_i (the principle of maximal dissipation, implicit in time; for given p the flow is associated
and the sum convex). Sticking is exact, there is no penalty.

Solved by splitting (alternating directions): an elastic step with all slips free but tied to a trial z by springs rho L_i,
and a return mapping at every node, all at once,

.. math::
   (S + \rho L)\, d = \rho L (z - u) - r, \qquad v = \alpha d + (1 - \alpha) z + u, \qquad
   z_i \leftarrow v_i \max(0,\ 1 - c_i / (\rho L_i |v_i|)), \qquad u \leftarrow v - z ,

d and z the slip increment, -rho L u the friction force on the slipping part, r the force of the load on the old slips, L_i a
bound of S at the node. The springs are an aid of the iteration: at its end d = z. rho is small because slips at full friction are
governed by soft, long-ranged motions (whole parts that slide), which the elastic step takes exactly. Boyd, Parikh, Chu, Peleato,
Eckstein, Found. Trends Mach. Learn. 3 (2011) 1-122, doi 10.1561/2200000016.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import ConvergenceError, SpecError
from homogenize.interface_condensation import CondensedHarmonic
from homogenize.section_field import FloatArray

TOLERANCE = 1e-6
"""Largest imbalance of a nodal force at the end of a step, relative to the largest friction force."""
MOST_ITERATIONS = 4000
_SPRING = 0.015
"""rho at the start; from measurements on a cable with four cores."""
_RELAXATION = 1.6
_SMALL = 1e-3
"""Friction forces below this share of the load's forces are not resolved any better than those of this size."""
_PATIENCE = 120
"""Iterations after which rho is changed."""


@dataclass(frozen=True)
class Coulomb:
    """Friction coefficient `friction` between two parts that do not open.

    Raises
    ------
    SpecError
        If the coefficient is negative or not finite.

    Examples
    --------
    >>> Coulomb(0.3).describe()
    'Coulomb friction 0.3'
    """

    friction: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.friction) and self.friction >= 0):
            raise SpecError(f"a friction coefficient must be zero or positive, found {self.friction:g}.")

    @property
    def holds(self) -> bool:
        """Resists a small slip wherever it is pressed; without friction it does not."""
        return self.friction > 0

    def describe(self) -> str:
        """The law in words."""
        return f"Coulomb friction {self.friction:g}"


class SlipOperator:
    """S and A of all harmonics, on slips given at stations along the pitch.

    Slips are real, shape (stations, 2 m). With one harmonic 0 there is one station. With odd harmonics k = 1, 3, .. 2 K - 1 the
    stations are the 2 K points at the angles pi j / (2 K) of the first half of a pitch; on the second half the slips are
    the negative. The stations and harmonics are a complete pair: nothing is truncated between them.
    """

    def __init__(self, harmonics: tuple[CondensedHarmonic, ...]) -> None:
        self.harmonics = harmonics
        orders = np.array([h.order for h in harmonics])
        self.stations = 1 if orders[0] == 0 else 2 * len(orders)
        self.factor = 1.0 if orders[0] == 0 else 2.0
        self.angles = np.pi * np.arange(self.stations) / self.stations
        self.wave = np.exp(1j * np.outer(self.angles, orders)) if orders[0] else np.ones((1, 1))
        self.S = np.stack([h.S for h in harmonics])
        self.bound = self._bound()
        self._inverse: dict[float, NDArray] = {}

    def amplitudes(self, slip: FloatArray) -> NDArray:
        """Amplitude of each harmonic, (harmonics, 2 m)."""
        return self.wave.conj().T @ slip / self.stations

    def force(self, slip: FloatArray) -> FloatArray:
        """S s at the stations [N/m]."""
        amplitudes = np.matmul(self.S, self.amplitudes(slip)[:, :, None])[:, :, 0]
        return self.factor * np.real(self.wave @ amplitudes)

    def sprung(self, rho: float, force: FloatArray) -> FloatArray:
        """(S + rho L)^-1 of forces at the stations."""
        if rho not in self._inverse:
            springs = np.diag(rho * np.repeat(self.bound, 2))
            self._inverse[rho] = np.linalg.inv(self.S + springs)
        amplitudes = np.matmul(self._inverse[rho], self.amplitudes(force)[:, :, None])[:, :, 0]
        return self.factor * np.real(self.wave @ amplitudes)

    def free(self, force: FloatArray) -> FloatArray:
        """S^+ of forces at the stations: slips without friction, the smallest where parts are free to move."""
        amplitudes = [np.linalg.lstsq(S, f, rcond=1e-9)[0] for S, f in zip(self.S, self.amplitudes(force))]
        return self.factor * np.real(self.wave @ np.array(amplitudes))

    def load(self, strain: NDArray) -> FloatArray:
        """A e at the stations [N/m]; e is the amplitude of the first harmonic's strains."""
        return self.factor * np.real(np.outer(self.wave[:, 0], self.harmonics[0].A @ strain))

    def section_force(self, strain: NDArray, slip: FloatArray) -> NDArray:
        """C e + A^H s, the amplitude of the first harmonic's section forces."""
        first = self.harmonics[0]
        return first.C @ strain + first.A.conj().T @ self.amplitudes(slip)[0]

    def _bound(self) -> FloatArray:
        """L_i (m,): a multiple of the largest diagonal of every node, so that diag(L) - S_k >= 0 for each k."""
        diagonal = np.abs(np.einsum("kii->ki", self.S)).max(axis=0).reshape(-1, 2).max(axis=1)
        scale = 1 / np.sqrt(np.repeat(diagonal, 2))
        largest = max(np.linalg.eigvalsh(S * np.outer(scale, scale))[-1] for S in self.S)
        return 1.001 * largest * diagonal


def slip_step(
    operator: SlipOperator, load: FloatArray, old: FloatArray, cap: FloatArray, guess: FloatArray, friction: FloatArray
) -> tuple[FloatArray, int]:
    """Slips after one load step, and the number of iterations.

    Parameters
    ----------
    load : (stations, 2 m) A e [N/m]
    old : (stations, 2 m) slips before the step [m]
    cap : (m,) friction force of each node per length [N/m]
    guess, friction : (stations, 2 m) slip increment [m], and friction forces on the other part [N/m], to start from

    Raises
    ------
    ConvergenceError
        With how far the iteration came.
    """
    L = np.repeat(operator.bound, 2)
    base = operator.force(old) + load
    scale = max(float(cap.max(initial=0.0)), _SMALL * float(np.abs(base).max(initial=0.0)))
    if not cap.any():
        return old - operator.free(base), 0
    rho, z, u = _SPRING, guess, friction / (_SPRING * L)
    off = np.inf
    for iteration in range(1, MOST_ITERATIONS + 1):
        d = operator.sprung(rho, rho * L * (z - u) - base)
        v = _RELAXATION * d + (1 - _RELAXATION) * z + u
        new = _shrunk(v, (cap / (rho * operator.bound))[:, None])
        u = v - new
        apart, moved = float(np.abs((d - new) * L).max()), rho * float(np.abs((new - z) * L).max())
        z, off = new, max(apart, moved)
        if off <= TOLERANCE * scale:
            return old + z, iteration
        if iteration % _PATIENCE == 0:
            factor = 2.0 if rho * apart > moved else 0.5
            rho, u = rho * factor, u / factor
    raise ConvergenceError(
        f"the slips of a load step did not settle in {MOST_ITERATIONS} iterations: forces are still out of balance by "
        f"{off / scale:.1e} of the largest friction force (allowed {TOLERANCE:.0e}); take smaller load steps."
    )


def _shrunk(v: FloatArray, shrink: FloatArray) -> FloatArray:
    """Every 2-vector of (stations, 2 m) shortened by its `shrink` (m, 1), to zero at most."""
    pairs = v.reshape(len(v), -1, 2)
    length = np.sqrt(pairs[..., 0] ** 2 + pairs[..., 1] ** 2)[..., None]
    keep = np.maximum(0.0, 1.0 - shrink / np.maximum(length, 1e-300))
    return (pairs * keep).reshape(v.shape)

r"""Coulomb friction on the slips of a condensed section: one load step as a convex minimum.

Over a step the slips s of all nodes minimise

.. math::
   \tfrac12 \langle s, S s \rangle + \langle s, A e \rangle + \sum_i c_i\, |s_i - s_i^{old}|, \qquad c_i = \mu\, p_i\, w_i ,

p_i the grip pressure, w_i the surface of node i per length: stick where the traction stays inside the cone |t_i| <= mu p_i, else slip
along the traction with |t_i| = mu p_i (the principle of maximal dissipation, implicit in time; for given p the flow is associated
and the sum convex). Sticking is exact, there is no penalty.

Solved by proximal gradient steps, which are a return mapping at every node, all at once: with L_i >= S in the sense of quadratic forms

.. math::   v_i = d_i - r_i / L_i, \qquad d_i \leftarrow v_i\, \max(0,\ 1 - c_i / (L_i |v_i|)), \qquad d = s - s^{old} ,

accelerated with momentum that is dropped whenever it points uphill. Beck, Teboulle, SIAM J. Imaging Sci. 2 (2009) 183-202, doi
10.1137/080716542; O'Donoghue, Candes, Found. Comput. Math. 15 (2015) 715-732, doi 10.1007/s10208-013-9150-3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import ConvergenceError, SpecError
from homogenize.interface_condensation import CondensedHarmonic
from homogenize.section_field import FloatArray

TOLERANCE = 1e-7
"""Largest change of a nodal force in the last iteration, relative to the largest friction force."""
MOST_ITERATIONS = 20_000


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

    def amplitudes(self, slip: FloatArray) -> NDArray:
        """Amplitude of each harmonic, (harmonics, 2 m)."""
        return self.wave.conj().T @ slip / self.stations

    def force(self, slip: FloatArray) -> FloatArray:
        """S s at the stations [N/m]."""
        amplitudes = np.matmul(self.S, self.amplitudes(slip)[:, :, None])[:, :, 0]
        return self.factor * np.real(self.wave @ amplitudes)

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


def slip_step(operator: SlipOperator, load: FloatArray, old: FloatArray, cap: FloatArray, guess: FloatArray) -> tuple[FloatArray, int]:
    """Slips after one load step, and the number of iterations.

    Parameters
    ----------
    load : (stations, 2 m) A e [N/m]
    old : (stations, 2 m) slips before the step [m]
    cap : (m,) friction force of each node per length [N/m]
    guess : (stations, 2 m) slip increment to start from

    Raises
    ------
    ConvergenceError
        With how far the iteration came.
    """
    L = np.repeat(operator.bound, 2)
    shrink = np.asarray(cap / operator.bound)[:, None]
    base = operator.force(old) + load
    scale = max(float(cap.max(initial=0.0)), 1e-9 * float(np.abs(base).max(initial=0.0)))
    if scale == 0.0:
        return old.copy(), 0
    d, momentum, inertia, change = guess, guess, 1.0, np.inf
    for iteration in range(1, MOST_ITERATIONS + 1):
        v = momentum - (base + operator.force(momentum)) / L
        new = _shrunk(v, shrink)
        moved = momentum - new
        change = float(np.abs(moved * L).max())
        if change <= TOLERANCE * scale:
            return old + new, iteration
        if (moved * L * (new - d)).sum() > 0:
            momentum, inertia = new, 1.0
        else:
            after = (1 + np.sqrt(1 + 4 * inertia**2)) / 2
            momentum = new + (inertia - 1) / after * (new - d)
            inertia = after
        d = new
    raise ConvergenceError(
        f"the slips of a load step did not settle in {MOST_ITERATIONS} iterations: the friction forces still change by "
        f"{change / scale:.1e} of the largest (allowed {TOLERANCE:.0e}); take smaller load steps."
    )


def _shrunk(v: FloatArray, shrink: FloatArray) -> FloatArray:
    """Every 2-vector of (stations, 2 m) shortened by its `shrink` (m, 1), to zero at most."""
    pairs = v.reshape(len(v), -1, 2)
    length = np.sqrt(pairs[..., 0] ** 2 + pairs[..., 1] ** 2)[..., None]
    keep = np.maximum(0.0, 1.0 - shrink / np.maximum(length, 1e-300))
    return (pairs * keep).reshape(v.shape)

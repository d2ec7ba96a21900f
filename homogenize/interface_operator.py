r"""The condensed section as an operator on the jumps of its interfaces, given at stations along the pitch.

Jumps x are real, shape (stations, u): two slips for each node that rubs, then one opening for each node that can part. Stiffness is
diagonal in the harmonics exp(i k tau_0 z) (:mod:`homogenize.interface_condensation`), contact and friction are local at the stations;
the two sets are complete pairs, nothing is truncated between them:

* harmonic 0: one station;
* odd harmonics k = 1, 3, .. 2 K - 1: the 2 K points at the angles pi j / (2 K) of half a pitch, the other half being the negative;
* harmonics 0, 1, .. K: the 2 K + 1 points at the angles 2 pi j / (2 K + 1) of the pitch.

A field x = x_0 + 2 Re sum x_k exp(i k theta) has the energy W_0 + 2 sum W_k per length. The loads y are those of harmonic 0 (stretch and
twist, or the forces in their place), then a vector (y_x, y_y) that stands still in space, the harmonic-1 amplitude
(y_x - i y_y) / sqrt 2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from homogenize.interface_condensation import CondensedHarmonic
from homogenize.section_field import FloatArray


@dataclass(frozen=True)
class InterfaceOperator:
    """Stiffness of jumps and loads in a set of harmonics.

    Attributes
    ----------
    harmonics : of the orders (0,), (1, 3, ..) or (0, 1, 2, ..)
    rubbing : number of nodes with two slips each, the first unknowns; the rest are openings
    """

    harmonics: tuple[CondensedHarmonic, ...]
    rubbing: int
    S: NDArray = field(init=False)
    wave: NDArray = field(init=False)
    angles: FloatArray = field(init=False)
    factor: FloatArray = field(init=False)
    bound: FloatArray = field(init=False)
    _inverse: dict[float, NDArray] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        orders = np.array([h.order for h in self.harmonics])
        half = orders[0] > 0
        stations = 2 * len(orders) if half else 2 * len(orders) - 1
        angles = (np.pi if half else 2 * np.pi) * np.arange(stations) / stations
        alone = not orders.any()
        values = {
            "S": np.stack([np.real(h.S) if alone else h.S for h in self.harmonics]),
            "wave": np.ones((1, 1)) if alone else np.exp(1j * np.outer(angles, orders)),
            "angles": angles,
            "factor": np.where(orders > 0, 2.0, 1.0),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)
        object.__setattr__(self, "bound", self._bound())

    @property
    def stations(self) -> int:
        """Number of stations."""
        return len(self.angles)

    @property
    def unknowns(self) -> int:
        """Number of jumps at a station."""
        return self.S.shape[1]

    @property
    def stiffness(self) -> FloatArray:
        """C of the loads (p, p): no jump anywhere."""
        return self.in_strains([h.C for h in self.harmonics])

    def amplitudes(self, jumps: FloatArray) -> NDArray:
        """Amplitude of each harmonic, (harmonics, u)."""
        return self.wave.conj().T @ jumps / self.stations

    def force(self, jumps: FloatArray) -> FloatArray:
        """S x at the stations [N/m]."""
        return self._at_stations(np.matmul(self.S, self.amplitudes(jumps)[:, :, None])[:, :, 0])

    def sprung(self, rho: float, force: FloatArray) -> FloatArray:
        """(S + rho L)^-1 of forces at the stations."""
        if rho not in self._inverse:
            self._inverse[rho] = np.linalg.inv(self.S + np.diag(rho * self.bound))
        return self._at_stations(np.matmul(self._inverse[rho], self.amplitudes(force)[:, :, None])[:, :, 0])

    def free(self, force: FloatArray) -> FloatArray:
        """S^+ of forces at the stations: jumps that meet no force, the smallest where parts are free to move."""
        amplitudes = [np.linalg.lstsq(S, f, rcond=1e-9)[0] for S, f in zip(self.S, self.amplitudes(force))]
        return self._at_stations(np.array(amplitudes))

    def load(self, y: FloatArray) -> FloatArray:
        """A y at the stations [N/m]."""
        parts = [h.A @ e for h, e in zip(self.harmonics, self._split(y))]
        return self._at_stations(np.array(parts), len(parts))

    def answer(self, y: FloatArray, jumps: FloatArray) -> FloatArray:
        """C y + A^H x: the forces (or, where a force is given, minus the strains) that belong to the loads (p,)."""
        amplitudes = self.amplitudes(jumps)
        found: list[float] = []
        for h, e, x in zip(self.harmonics, self._split(y), amplitudes):
            F = h.C @ e + h.A.conj().T @ x
            found += [*np.real(F)] if h.order == 0 else [np.sqrt(2) * F[0].real, -np.sqrt(2) * F[0].imag]
        return np.array(found)

    def _split(self, y: FloatArray) -> list[NDArray]:
        """The amplitudes of the loads, of the harmonics 0 and 1 as far as they are there."""
        found: list[NDArray] = []
        for h in self.harmonics:
            if h.order == 0:
                found.append(y[: h.C.shape[0]])
            elif h.order == 1:
                found.append(np.array([y[-2] - 1j * y[-1]]) / np.sqrt(2))
        return found

    def _at_stations(self, amplitudes: NDArray, count: int | None = None) -> FloatArray:
        return np.real((self.wave * self.factor)[:, :count] @ amplitudes)

    def in_strains(self, blocks: Sequence[NDArray]) -> FloatArray:
        """One matrix of the loads (p, p) from one block for each harmonic."""
        parts = [
            np.real(C) if h.order == 0 else np.eye(2) * C[0, 0].real
            for h, C in zip(self.harmonics, blocks, strict=True)
            if C.size
        ]
        return np.asarray(scipy.linalg.block_diag(*parts), dtype=float)

    def _bound(self) -> FloatArray:
        """L (u,): a multiple of the largest diagonal of every node, so that diag(L) - S_k >= 0 for each k."""
        diagonal = np.abs(np.einsum("kii->ki", self.S)).max(axis=0)
        slips = diagonal[: 2 * self.rubbing].reshape(-1, 2).max(axis=1)
        diagonal = np.concatenate([np.repeat(slips, 2), diagonal[2 * self.rubbing :]])
        scale = 1 / np.sqrt(diagonal)
        largest = max(np.linalg.eigvalsh(S * np.outer(scale, scale))[-1] for S in self.S)
        return 1.001 * largest * diagonal

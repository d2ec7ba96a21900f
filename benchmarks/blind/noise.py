"""Noise of one record: white, autoregressive, heavy-tailed, growing with the load, 1/f, and scatter of specimens.

Sizes are relative to the rms of the channel over the open records. Every kind also whitens, with the covariance that it
was drawn from, so that a distance between two responses can be given in units of the noise.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular, toeplitz
from scipy.signal import lfilter

Array = NDArray[np.float64]
KINDS = ("white", "ar", "heavy-tail", "heteroscedastic", "scatter", "one-over-f")
_PHI = 0.7
_LONGEST = 400
_PINK = (0.5, 0.8, 0.92, 0.97, 0.99, 0.996)
"""Autoregressive parts of equal variance, octaves apart: their sum has a spectrum like 1/f."""


@lru_cache(maxsize=1)
def _pink_factor() -> Array:
    lag = np.arange(_LONGEST)
    return np.linalg.cholesky(toeplitz(np.mean([p**lag for p in _PINK], axis=0)))


def _autoregressive(rng: np.random.Generator, n: int, phi: float) -> Array:
    e = rng.standard_normal(n) * np.sqrt(1 - phi**2)
    e[0] = rng.standard_normal()
    return np.asarray(lfilter([1.0], [1.0, -phi], e))


@dataclass(frozen=True)
class Noise:
    """Of one kind and size [relative to the rms of the channel]; gain is relative, offset relative to the rms."""

    kind: str
    size: float
    gain: float = 0.0
    offset: float = 0.0

    def spread(self, clean: Array, rms: float) -> Array:
        """Standard deviation of every sample without gain and offset."""
        s = np.full(len(clean), self.size * rms)
        return s * (0.4 + 0.8 * np.abs(clean) / rms) if self.kind == "heteroscedastic" else s

    def draw(self, rng: np.random.Generator, clean: Array, rms: float) -> Array:
        """One record of noise on the clean signal."""
        n = len(clean)
        if self.kind == "ar":
            e = _autoregressive(rng, n, _PHI)
        elif self.kind == "heavy-tail":
            e = rng.standard_t(3, n) / np.sqrt(3)
        elif self.kind == "one-over-f":
            e = np.mean([_autoregressive(rng, n, p) for p in _PINK], axis=0) * np.sqrt(len(_PINK))
        else:
            e = rng.standard_normal(n)
        scatter = self.gain * rng.standard_normal() * clean + self.offset * rms * rng.standard_normal()
        return self.spread(clean, rms) * e + scatter

    def whiten(self, x: Array, clean: Array, rms: float) -> Array:
        """Columns (n, k) in units of the noise of a record with that clean signal."""
        white = self._whiten_samples(x, clean, rms)
        if not (self.gain or self.offset):
            return white
        U = np.column_stack([self.gain * clean, np.full(len(clean), self.offset * rms)])
        Q, S, _ = np.linalg.svd(self._whiten_samples(U, clean, rms), full_matrices=False)
        return white - Q @ ((1 - 1 / np.sqrt(1 + S**2))[:, None] * (Q.T @ white))

    def _whiten_samples(self, x: Array, clean: Array, rms: float) -> Array:
        white = x / self.spread(clean, rms)[:, None]
        if self.kind == "ar":
            white = np.vstack([white[:1], (white[1:] - _PHI * white[:-1]) / np.sqrt(1 - _PHI**2)])
        elif self.kind == "one-over-f":
            white = solve_triangular(_pink_factor()[: len(x), : len(x)], white, lower=True)
        return white

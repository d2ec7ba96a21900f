"""Section laws that feel the rate: viscous damping with any exponent, relaxation with many times or none of its own."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.signal import fftconvolve

from benchmarks.blind.bench import Array, Bench
from benchmarks.blind.truth import Truth


def highest_rate(bench: Bench) -> float:
    """Strain rate of a sine of the largest strain at the highest frequency."""
    return float(2 * np.pi * bench.frequency.max() * bench.scale)


def hereditary(bench: Bench, strain: Array, integral: Callable[[Array], Array]) -> Array:
    """Integral of G(t - s) de(s), exact for straight steps; `integral` is that of G from 0."""
    n = strain.shape[1]
    edges = np.arange(n + 1) * bench.step
    G = np.diff(integral(edges), axis=1) / bench.step
    d = bench.increments(strain)
    out = np.zeros_like(strain)
    out[:, 1:] = fftconvolve(d[:, 1:], G, axes=1)[:, : n - 1]
    return out


class ViscousDamping(Truth):
    """Resultant proportional to a power of the strain rate."""

    effect = "viscous-damping"
    variants = ("linear", "power-0.8", "power-0.9", "power-1.2")

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {
            "rate": highest_rate(bench),
            "scale": bench.scale,
            "power": 1.0 if variant == "linear" else float(variant[6:]),
        }

    def extra(self, bench: Bench, strain: Array) -> Array:
        rate = np.gradient(strain, axis=1) / bench.step / self.numbers["rate"]
        return self.size * self.numbers["scale"] * np.sign(rate) * np.abs(rate) ** self.numbers["power"]


class Viscoelasticity(Truth):
    """Relaxation: four Maxwell branches, a power law in time, a stretched exponential, one branch."""

    effect = "viscoelasticity"
    variants = ("prony-4", "fractional", "stretched", "prony-1")

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        middle = 1 / (2 * np.pi * np.exp(np.mean(np.log(bench.frequency)))) * np.exp(rng.uniform(-0.7, 0.7))
        spread = np.array([-1.2, -0.4, 0.4, 1.2]) * rng.uniform(0.7, 1.1) if variant == "prony-4" else np.zeros(1)
        weight = rng.uniform(0.5, 1.5, len(spread))
        return {
            "times": middle * 10**spread,
            "weight": weight / weight.sum(),
            "order": rng.uniform(0.15, 0.35),
            "beta": rng.uniform(0.45, 0.7),
        }

    def _integral(self, s: Array) -> Array:
        tau = self.numbers["times"]
        if self.variant == "fractional":
            return s ** (1 - self.numbers["order"]) * tau[0] ** self.numbers["order"] / (1 - self.numbers["order"])
        if self.variant == "stretched":
            u = np.geomspace(
                1e-3, 1e2, 24
            )  # stretched exponential as a sum of exponentials, by its known series weights
            b = self.numbers["beta"]
            w = u**b * np.exp(-(u**b)) if b < 1 else np.ones_like(u)
            w /= w.sum()
            return np.zeros(1) + sum(
                wi * tau[0] * ui * (1 - np.exp(-s / (tau[0] * ui))) for wi, ui in zip(w, u, strict=True)
            )
        return np.zeros(1) + sum(w * t * (1 - np.exp(-s / t)) for w, t in zip(self.numbers["weight"], tau, strict=True))

    def extra(self, bench: Bench, strain: Array) -> Array:
        return self.size * hereditary(bench, strain, self._integral)


TRUTHS = (ViscousDamping, Viscoelasticity)

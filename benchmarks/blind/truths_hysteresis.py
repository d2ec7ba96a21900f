"""Rate-independent hysteresis: slip between layers, whose limit grows with the grip, and yielding, whose limit does not.

Slip of one layer round the section follows Papailiou: the wire at the angle theta from the neutral axis carries
sin^2(theta) of the stick stiffness and slips at a curvature that grows with (exp(m theta) - 1) / (m sin theta), m = friction
coefficient x sine of the lay angle. Source: Papailiou, IEEE Trans. Power Delivery 12(4), 1997, doi 10.1109/61.634188.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from benchmarks.blind.bench import Array, Bench
from benchmarks.blind.truth import Truth


def sliders(bench: Bench, strain: Array, weight: Array, limit: Array, grip: Array) -> Array:
    """Sum of stick-slip elements: stiffness weight_j, slip strain limit_j times grip (C, n) or (C, 1)."""
    d = bench.increments(strain)
    n = strain.shape[1]
    grip = np.broadcast_to(grip, strain.shape)
    x = np.zeros((len(strain), len(limit)))
    out = np.empty_like(strain)
    for i in range(n):
        top = limit * grip[:, i : i + 1]
        x += d[:, i : i + 1]
        np.minimum(x, top, out=x)
        np.maximum(x, -top, out=x)
        out[:, i] = x @ weight
    return out


def round_the_section(rng: np.random.Generator, positions: int, onset: float) -> tuple[Array, Array]:
    """Weights and slip strains of one layer."""
    theta = (np.arange(positions) + 0.5) * np.pi / 2 / positions
    m = rng.uniform(0.15, 0.5) * np.sin(np.deg2rad(rng.uniform(12, 20)))
    return np.sin(theta) ** 2, onset * (np.exp(m * theta) - 1) / (m * np.sin(theta))


def bouc_wen(bench: Bench, strain: Array, limit: Array, power: float) -> Array:
    """Smooth stick-slip: dz = de - |z/z_y|^n z-directed slip."""
    d = bench.increments(strain)
    top = np.broadcast_to(np.maximum(limit, 1e-12), strain.shape)
    z = np.zeros(len(strain))
    out = np.empty_like(strain)
    parts = 4
    for i in range(strain.shape[1]):
        y, h = top[:, i], d[:, i] / parts
        for _ in range(parts):
            r = np.minimum(np.abs(z) / y, 1.0) ** power
            z = np.clip(z + h * (1 - r * (1 + np.sign(z * h)) / 2), -y, y)
        out[:, i] = z
    return out


class InterlayerFriction(Truth):
    """Slip between layers; the limit grows with the tension as base + (1 - base) N/N0, or by another law."""

    effect = "interlayer-friction"
    variants = ("two-layer", "papailiou-smooth", "three-layer", "bouc-wen")
    largest: ClassVar[float] = 6.0

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        law = str(rng.choice(["linear", "power", "saturating"], p=[0.6, 0.2, 0.2]))
        base = {"law": law, "base": rng.uniform(0.1, 0.35), "power": rng.uniform(0.7, 1.0)}
        first = rng.uniform(0.15, 0.35) * bench.scale
        if variant == "bouc-wen":
            return {**base, "limit": 1.3 * first, "n": rng.uniform(1.0, 2.0)}
        layers = {
            "two-layer": [(8, 1.0), (8, 2.4)],
            "papailiou-smooth": [(24, 1.4)],
            "three-layer": [(8, 1.0), (8, 1.7), (8, 2.6)],
        }
        weights, limits = [], []
        for positions, later in layers[variant]:
            w, k = round_the_section(rng, positions, first * later * rng.uniform(0.85, 1.15))
            weights.append(w * rng.uniform(0.6, 1.4))
            limits.append(k)
        weight = np.concatenate(weights)
        return {**base, "weight": weight / weight.sum(), "limit": np.concatenate(limits)}

    def grip_law(self, bench: Bench, strain: Array) -> Array:
        """Slip limit over its value at the typical tension."""
        N, base = bench.grip(strain), self.numbers["base"]
        rise = {"linear": N, "power": N ** self.numbers["power"], "saturating": 2 * N / (1 + N)}[self.numbers["law"]]
        return base + (1 - base) * rise

    def extra(self, bench: Bench, strain: Array) -> Array:
        grip = self.grip_law(bench, strain)
        if self.variant == "bouc-wen":
            return self.size * bouc_wen(bench, strain, self.numbers["limit"] * grip, self.numbers["n"])
        return self.size * sliders(bench, strain, self.numbers["weight"], self.numbers["limit"], grip)


class Plasticity(Truth):
    """Metal yields: many yield strains, a Ramberg-Osgood curve, or Armstrong-Frederick hardening."""

    effect = "plasticity"
    variants = ("multi-yield", "ramberg-osgood", "armstrong-frederick")
    largest: ClassVar[float] = 6.0

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        first = rng.uniform(0.2, 0.45) * bench.scale
        if variant == "armstrong-frederick":
            return {"limit": first}
        if variant == "multi-yield":
            limit = first * np.geomspace(1, rng.uniform(1.8, 3.0), 6)
            return {"limit": limit, "weight": np.full(6, 1 / 6)}
        grid = first * np.geomspace(
            0.4, 6.0, 15
        )  # kinks of the backbone; slopes of strain = s + (s/first)^n become sliders
        n = rng.uniform(4, 8)
        stress = np.geomspace(1e-3, 4 * first, 4000)
        backbone = np.interp(np.r_[0, grid], stress + 0.4 * first * (stress / first) ** n, stress)
        slope = np.diff(backbone) / np.diff(np.r_[0, grid])
        weight = -np.diff(np.r_[slope, 0.0])
        return {"limit": grid, "weight": np.maximum(weight, 0) / np.maximum(weight, 0).sum()}

    def extra(self, bench: Bench, strain: Array) -> Array:
        if self.variant == "armstrong-frederick":
            return self.size * bouc_wen(bench, strain, np.full((1, 1), self.numbers["limit"]), 1.0)
        return self.size * sliders(bench, strain, self.numbers["weight"], self.numbers["limit"], np.ones((1, 1)))


TRUTHS = (InterlayerFriction, Plasticity)

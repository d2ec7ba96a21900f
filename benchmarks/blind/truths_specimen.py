"""How the specimen is held: end load introduction, play, slipping grips, a frame that stretches."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from benchmarks.blind.bench import Array, Bench
from benchmarks.blind.truth import Truth


class EndLoadIntroduction(Truth):
    """Apparent stiffness K / (1 + c/L), or the shear-lag form K (1 - (c/L) tanh(L/c))."""

    effect = "end-load-introduction"
    variants = ("inverse-length", "shear-lag")
    kinds = ("tension", "torsion")
    largest: ClassVar[float] = 5.0

    def factor(self, bench: Bench, strain: Array) -> Array:
        x = max(self.size, 1e-9) / bench.length[:, None]
        return 1 / (1 + x) if self.variant == "inverse-length" else 1 - x * np.tanh(1 / x)


class RigCompliance(Truth):
    """The frame stretches with the load: linearly, or stiffer the more it is loaded."""

    effect = "rig-compliance"
    variants = ("linear", "hardening")
    kinds = ("tension", "torsion")
    largest: ClassVar[float] = 1.2

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"load": bench.stiffness * bench.scale, "bend": rng.uniform(0.05, 0.2)}

    def give(self, bench: Bench, load: Array) -> Array:
        x = load / bench.stiffness
        if self.variant == "hardening":
            x = x / (1 + self.numbers["bend"] * np.abs(load) / self.numbers["load"])
        return self.size * x / bench.length[:, None]


class Backlash(Truth):
    """Free play round zero load, sharp or with rounded corners; the size is the play over (largest strain x 1 m)."""

    effect = "backlash"
    variants = ("sharp", "rounded")
    largest: ClassVar[float] = 0.5

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"scale": bench.scale, "round": rng.uniform(0.1, 0.3)}

    def fixture(self, bench: Bench, strain: Array) -> Array:
        play = self.size * self.numbers["scale"] / bench.length[:, None]
        x = np.abs(strain)
        if self.variant == "sharp" or self.size == 0:
            return np.sign(strain) * np.maximum(x - play, 0)
        w = self.numbers["round"] * play
        return np.sign(strain) * w * (np.logaddexp(0, (x - play) / w) - np.logaddexp(0, -play / w))


class GripSlip(Truth):
    """The grip slides under load and does not come back; the size is a slip length over (largest strain x 1 m)."""

    effect = "grip-slip"
    variants = ("threshold", "jump", "progressive")
    kinds = ("tension", "torsion")
    largest: ClassVar[float] = 1.5

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"scale": bench.scale, "from": rng.uniform(0.2, 0.35), "power": rng.uniform(1.3, 2.0)}

    def _slid(self, load: Array) -> Array:
        """Slip in one direction, of a load over the largest linear one."""
        most = np.maximum.accumulate(np.maximum(load, 0), axis=1)
        over = np.maximum(most - self.numbers["from"], 0)
        if self.variant == "threshold":
            return over
        if self.variant == "jump":
            return 0.35 * (most > self.numbers["from"]) + 0.0
        return over ** self.numbers["power"]

    def fixture(self, bench: Bench, strain: Array) -> Array:
        x = strain / self.numbers["scale"]
        slip = self._slid(x) - self._slid(-x)
        return strain - self.size * self.numbers["scale"] * slip / bench.length[:, None]


TRUTHS = (EndLoadIntroduction, RigCompliance, Backlash, GripSlip)

"""Truths that no bench library has: the right answer to each is *unknown*."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from benchmarks.blind.bench import Array, Bench
from benchmarks.blind.truth import Truth


class Outside(Truth):
    """Base of the truths outside the library."""

    variants = ("plain",)


class PathRipple(Outside):
    """A ripple that is periodic in the path, as of a toothed drive or a strand passing a jaw."""

    effect = "path-ripple"

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"wave": rng.uniform(0.12, 0.3) * bench.scale, "scale": bench.scale, "phase": rng.uniform(0.3, 1.2)}

    def extra(self, bench: Bench, strain: Array) -> Array:
        phase = self.numbers["phase"]
        ripple = np.sin(2 * np.pi * strain / self.numbers["wave"] + phase) - np.sin(phase)
        return self.size * self.numbers["scale"] * ripple


class Clipping(Outside):
    """The amplifier saturates; the size is how much of the range is lost."""

    effect = "sensor-clipping"
    largest: ClassVar[float] = 0.8

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"range": bench.stiffness * bench.scale}

    def sensor(self, bench: Bench, load: Array) -> Array:
        top = (1 - self.size) * self.numbers["range"]
        return np.clip(load, -top, top) if self.size else load


class Quantisation(Outside):
    """A converter of very few bits; the size is its step over the largest load."""

    effect = "quantisation"
    largest: ClassVar[float] = 1.0

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"range": bench.stiffness * bench.scale}

    def sensor(self, bench: Bench, load: Array) -> Array:
        step = self.size * self.numbers["range"]
        return np.round(load / step) * step if step else load


class Ringing(Outside):
    """The frame rings after every kink of the path: an underdamped oscillation driven by the acceleration."""

    effect = "rig-ringing"

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"period": rng.uniform(7, 14), "damping": rng.uniform(0.02, 0.06), "scale": bench.scale}

    def extra(self, bench: Bench, strain: Array) -> Array:
        w = 2 * np.pi / self.numbers["period"]
        kick = bench.increments(bench.increments(strain))
        kick[:, 1] = bench.increments(strain)[:, 1]
        # a second-order recursion with poles r exp(+- i w)
        r = np.exp(-self.numbers["damping"] * w)
        out = np.zeros_like(strain)
        for i in range(2, strain.shape[1]):
            out[:, i] = 2 * r * np.cos(w) * out[:, i - 1] - r**2 * out[:, i - 2] + kick[:, i - 1]
        return self.size * out


class PinchedLoops(Outside):
    """Bouc-Wen hysteresis that is pinched round zero strain, as of a loose bolted joint."""

    effect = "pinched-hysteresis"

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"limit": rng.uniform(0.1, 0.25) * bench.scale, "waist": rng.uniform(0.25, 0.4) * bench.scale}

    def extra(self, bench: Bench, strain: Array) -> Array:
        d, y = bench.increments(strain), self.numbers["limit"]
        middle = 0.0 if bench.kind != "tension" else 0.5 * bench.scale
        z, out = np.zeros(len(strain)), np.empty_like(strain)
        for i in range(strain.shape[1]):
            z = np.clip(z + d[:, i], -y, y)
            out[:, i] = z
        return self.size * out * (1 - np.exp(-(((strain - middle) / self.numbers["waist"]) ** 2)))


class StiffnessFadesInTime(Outside):
    """Thixotropy: the stiffness fades with the time since the start of the record and comes back before the next."""

    effect = "thixotropy"
    largest: ClassVar[float] = 0.9

    def factor(self, bench: Bench, strain: Array) -> Array:
        cycles = bench.time * bench.frequency[:, None]
        return 1 - self.size * (1 - np.exp(-cycles))


class SnapThrough(Outside):
    """A reversible bump of negative stiffness at one strain of both signs."""

    effect = "snap-through"

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {
            "at": rng.uniform(0.2, 0.28) * bench.scale,
            "width": rng.uniform(0.03, 0.05) * bench.scale,
            "scale": bench.scale,
        }

    def extra(self, bench: Bench, strain: Array) -> Array:
        x = (np.abs(strain) - self.numbers["at"]) / self.numbers["width"]
        return self.size * self.numbers["scale"] * np.sign(strain) * np.exp(-(x**2) / 2)


class MainsHum(Outside):
    """A hum that is locked to the start of the record, a few periods per cycle of the path."""

    effect = "hum"

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"per_cycle": rng.uniform(5.3, 9.7), "unit": bench.stiffness * bench.scale}

    def sensor(self, bench: Bench, load: Array) -> Array:
        cycles = bench.time * bench.frequency[:, None]
        return load + self.size * self.numbers["unit"] * np.sin(2 * np.pi * self.numbers["per_cycle"] * cycles)


class MidFrequencyPeak(Outside):
    """The stiffness is larger at the middle frequency only, as near a resonance."""

    effect = "mid-frequency-peak"
    largest: ClassVar[float] = 1.5

    def factor(self, bench: Bench, strain: Array) -> Array:
        levels = np.unique(bench.frequency)
        peak = np.isclose(bench.frequency, levels[len(levels) // 2])[:, None]
        return np.asarray(1 + self.size * peak, dtype=np.float64)


class WarmAndColdSofter(Outside):
    """The stiffness is largest at 20 degC and falls to both sides."""

    effect = "temperature-peak"
    largest: ClassVar[float] = 0.9

    def factor(self, bench: Bench, strain: Array) -> Array:
        away = np.abs(bench.temperature - 20)[:, None] / 20
        return 1 - self.size * away


class LongerStiffnessFalls(Outside):
    """The apparent stiffness falls with specimen length, which neither end load nor frame can do."""

    effect = "length-weakening"
    kinds = ("tension", "torsion")
    largest: ClassVar[float] = 1.5

    def factor(self, bench: Bench, strain: Array) -> Array:
        return (1 / bench.length[:, None]) ** self.size


class TensionSoftening(Outside):
    """Bending or torsion stiffness falls with tension."""

    effect = "tension-softening"
    kinds = ("torsion", "bending")
    largest: ClassVar[float] = 0.4

    def factor(self, bench: Bench, strain: Array) -> Array:
        return 1 - self.size * (bench.tension / bench.typical_tension - 1)[:, None]


class TravelRipple(Outside):
    """A sensor that answers to the path travelled: a bias periodic in the arc length, reversal after reversal."""

    effect = "travel-ripple"

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"wave": rng.uniform(0.5, 0.9) * bench.scale, "unit": bench.stiffness * bench.scale}

    def sensor(self, bench: Bench, load: Array) -> Array:
        travelled = np.cumsum(np.abs(bench.increments(bench.strain)), axis=1)
        return load + self.size * self.numbers["unit"] * np.sin(2 * np.pi * travelled / self.numbers["wave"])


TRUTHS = (
    PathRipple, Clipping, Quantisation, Ringing, PinchedLoops, StiffnessFadesInTime, SnapThrough, MainsHum,
    MidFrequencyPeak, WarmAndColdSofter, LongerStiffnessFalls, TensionSoftening, TravelRipple,
)  # fmt: skip

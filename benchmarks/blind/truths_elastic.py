"""Reversible section laws: stiffening, slack, asymmetry, temperature, tension; and softening by the largest strain."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from scipy.special import erf

from benchmarks.blind.bench import Array, Bench
from benchmarks.blind.truth import Truth


class Stiffening(Truth):
    """Reversible stiffening: Gent's locking, a quintic, a power 1.5, a hyperbolic sine, a cubic."""

    effect = "stiffening"
    variants = ("gent", "quintic", "power-1.5", "sinh", "cubic")
    largest: ClassVar[float] = 20.0

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"scale": bench.scale, "lock": rng.uniform(1.7, 2.2), "rise": rng.uniform(1.0, 2.5)}

    def elastic(self, bench: Bench, strain: Array) -> Array:
        x = strain / self.numbers["scale"]
        shape = {
            "gent": lambda: x / (1 - np.minimum((x / self.numbers["lock"]) ** 2, 0.98)) - x,
            "quintic": lambda: 0.3 * x**3 + x**5,
            "power-1.5": lambda: x * np.sqrt(np.abs(x)),
            "sinh": lambda: np.sinh(self.numbers["rise"] * x) / self.numbers["rise"] - x,
            "cubic": lambda: x**3,
        }[self.variant]()
        return self.size * self.numbers["scale"] * shape


class Slack(Truth):
    """Soft toe before the layers bed in; the size is the toe strain over the largest strain."""

    effect = "slack"
    variants = ("exponential-toe", "quadratic-toe", "rounded-corner")
    kinds = ("tension",)
    largest: ClassVar[float] = 0.6

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"scale": bench.scale, "depth": rng.uniform(0.6, 0.95), "round": rng.uniform(0.06, 0.2)}

    def elastic(self, bench: Bench, strain: Array) -> Array:
        toe = max(self.size, 1e-9) * self.numbers["scale"]
        x = np.maximum(strain, 0.0)
        if self.variant == "exponential-toe":
            lost = toe * (1 - np.exp(-x / toe))
        elif self.variant == "quadratic-toe":
            lost = np.where(x < toe, x - x**2 / (2 * toe), toe / 2)
        else:
            w = self.numbers["round"] * toe
            lost = x - w * (np.logaddexp(0, (x - toe) / w) - np.logaddexp(0, -toe / w))
        return -self.numbers["depth"] * lost


class CyclicSoftening(Truth):
    """Stiffness falls with the largest strain seen so far (Mullins)."""

    effect = "cyclic-softening"
    variants = ("exponential", "linear", "threshold", "ogden-roxburgh")
    largest: ClassVar[float] = 0.9

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {
            "scale": bench.scale,
            "early": rng.uniform(0.25, 0.5),
            "from": rng.uniform(0.2, 0.4),
            "width": rng.uniform(0.3, 0.7),
        }

    def factor(self, bench: Bench, strain: Array) -> Array:
        x = np.abs(strain) / self.numbers["scale"]
        most = np.maximum.accumulate(x, axis=1)
        if self.variant == "exponential":
            lost = 1 - np.exp(-most / self.numbers["early"])
        elif self.variant == "linear":
            lost = np.minimum(most, 1.5) / 1.5
        elif self.variant == "threshold":
            lost = 1 - np.exp(-np.maximum(most - self.numbers["from"], 0) / 0.4)
        else:
            lost = erf((most**2 - x**2) / (self.numbers["width"] * (most**2 + 0.2)))
        return 1 - self.size * lost


class ThermalSoftening(Truth):
    """Stiffness falls with temperature; 20 degC is the reference."""

    effect = "thermal-softening"
    variants = ("exponential", "sigmoid", "linear", "arrhenius")
    largest: ClassVar[float] = 0.95

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"middle": rng.uniform(15, 30), "width": rng.uniform(5, 10), "energy": rng.uniform(3000, 6000)}

    def factor(self, bench: Bench, strain: Array) -> Array:
        T = bench.temperature[:, None]
        if self.variant == "exponential":
            return np.exp(-self.size * (T - 20) / 20)
        if self.variant == "linear":
            return 1 - self.size * (T - 20) / 20
        if self.variant == "arrhenius":
            E = self.numbers["energy"]
            flow = np.exp(-E * (1 / (T + 273.15) - 1 / 293.15))
            return 1 - self.size * (flow - 1) / (1 + flow)
        w, middle = self.numbers["width"], self.numbers["middle"]
        return 1 - self.size * (1 / (1 + np.exp(-(T - middle) / w)) - 1 / (1 + np.exp(-(20 - middle) / w)))


class TensionStiffening(Truth):
    """Bending or torsion stiffness grows with axial tension."""

    effect = "tension-stiffening"
    variants = ("linear", "square-root", "saturating")
    kinds = ("torsion", "bending")
    largest: ClassVar[float] = 3.0

    def factor(self, bench: Bench, strain: Array) -> Array:
        x = (bench.tension / bench.typical_tension)[:, None]
        shape = {"linear": x - 1, "square-root": np.sqrt(x) - 1, "saturating": 2 * x / (1 + x) - 1}[self.variant]
        return 1 + self.size * shape


class TensionTorsionCoupling(Truth):
    """Torque under pure extension, force under pure twist."""

    effect = "tension-torsion-coupling"
    variants = ("linear", "with-quadratic", "hardening")
    kinds = ("tension", "torsion")

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"scale": bench.scale, "sign": float(rng.choice([-1, 1])), "curve": rng.uniform(0.1, 0.35)}

    def cross(self, bench: Bench, strain: Array) -> Array:
        x, curve = strain / self.numbers["scale"], self.numbers["curve"]
        bent = {"linear": x, "with-quadratic": x + curve * x * np.abs(x), "hardening": x + curve * x**3}[self.variant]
        return self.size * self.numbers["sign"] * self.numbers["scale"] * bent


class DirectionAsymmetry(Truth):
    """Different stiffness for the two signs of the load."""

    effect = "direction-asymmetry"
    variants = ("sharp", "tanh", "arctangent")
    kinds = ("torsion", "bending")
    largest: ClassVar[float] = 0.8

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"sign": float(rng.choice([-1, 1])), "width": rng.uniform(0.03, 0.12) * bench.scale}

    def factor(self, bench: Bench, strain: Array) -> Array:
        x = strain / self.numbers["width"]
        side = {"sharp": np.sign(strain), "tanh": np.tanh(x), "arctangent": 2 / np.pi * np.arctan(2 * x)}[self.variant]
        return 1 + self.size * self.numbers["sign"] * side


TRUTHS = (
    Stiffening, Slack, CyclicSoftening, ThermalSoftening, TensionStiffening, TensionTorsionCoupling, DirectionAsymmetry,
)  # fmt: skip

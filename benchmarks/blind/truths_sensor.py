"""What a sensor adds: a constant bias, a bias that grows with time, a lag of first or second order."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from benchmarks.blind.bench import Array, Bench
from benchmarks.blind.truth import Truth


def low_pass(x: Array, step: Array, tau: float) -> Array:
    """First-order lag from rest, exact for straight steps; x (C, n), step (C, 1)."""
    if tau <= 0:
        return x
    r = step[:, 0] / tau
    keep = np.exp(-r)
    new = 1 - (1 - keep) / r
    old = 1 - keep - new
    out = np.zeros_like(x)
    for i in range(1, x.shape[1]):
        out[:, i] = keep * out[:, i - 1] + old * x[:, i - 1] + new * x[:, i]
    return out


def _unit(bench: Bench) -> float:
    """Size of the measured channel."""
    return bench.scale if bench.load_control else bench.stiffness * bench.scale


class SensorOffset(Truth):
    """One constant for all records."""

    effect = "sensor-offset"
    variants = ("constant",)

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"unit": _unit(bench) * float(rng.choice([-1, 1]))}

    def sensor(self, bench: Bench, load: Array) -> Array:
        return load + self.size * self.numbers["unit"]


class SensorDrift(Truth):
    """Zero at the start of every record, then linear, as a square root, or saturating in time."""

    effect = "sensor-drift"
    variants = ("linear", "square-root", "exponential")

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        longest = float(bench.time.max())
        return {"unit": _unit(bench) * float(rng.choice([-1, 1])), "span": longest, "settle": rng.uniform(0.2, 0.6)}

    def sensor(self, bench: Bench, load: Array) -> Array:
        x = bench.time / self.numbers["span"]
        shape = {
            "linear": x,
            "square-root": np.sqrt(x),
            "exponential": 1 - np.exp(-x / self.numbers["settle"]),
        }[self.variant]
        return load + self.size * self.numbers["unit"] * shape


class SensorLag(Truth):
    """First order, or two equal first orders in a row; the size is the time constant over the shortest 1/(2 pi f)."""

    effect = "sensor-lag"
    variants = ("first-order", "second-order")
    largest: ClassVar[float] = 3.0

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {"time": 1 / (2 * np.pi * float(bench.frequency.max()))}

    def sensor(self, bench: Bench, load: Array) -> Array:
        tau = self.size * self.numbers["time"]
        if self.variant == "first-order":
            return low_pass(load, bench.step, tau)
        return low_pass(low_pass(load, bench.step, tau / 2), bench.step, tau / 2)


TRUTHS = (SensorOffset, SensorDrift, SensorLag)

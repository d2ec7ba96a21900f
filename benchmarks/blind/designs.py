"""Designs of experiments: which amplitudes, frequencies, temperatures, tensions and lengths are tested together.

Eight open conditions and a sealed one at 1.45 times the largest amplitude, each twice; two of the open ones are kept
for validation. Paths are sines, growing sines, triangles and holds, of zero mean or, in tension, one-sided.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.blind.bench import Array, Bench

DESIGNS = (
    "rich", "amplitude-only", "amplitude-rate", "one-tension", "one-length", "one-temperature", "tied", "no-clock",
    "load-controlled",
)  # fmt: skip
AMPLITUDES = np.array([1.0, 2.0, 3.2]) / 3.2
RATES = np.array([1.0, 20 / 3, 100 / 3])
TEMPERATURES = np.array([5.0, 20.0, 40.0])
TENSIONS = np.array([0.3, 1.0, 2.2])
LENGTHS = np.array([0.5, 1.0, 2.0])
_SEALED = 1.45
_CONDITIONS = 8
_MOST_CORRELATED = 0.6


@dataclass(frozen=True)
class Levels:
    """Level 0, 1, 2 of each factor in each of the nine conditions, the last one sealed; (9,) arrays of int."""

    amplitude: NDArray[np.int_]
    rate: NDArray[np.int_]
    temperature: NDArray[np.int_]
    tension: NDArray[np.int_]
    length: NDArray[np.int_]


def _mixed(rng: np.random.Generator) -> NDArray[np.int_]:
    levels = np.array([0, 0, 1, 1, 2, 2, *rng.integers(0, 3, 2)])
    return np.append(rng.permutation(levels), rng.integers(0, 3))


def _well_mixed(factors: list[NDArray[np.int_]]) -> bool:
    fitted = [f[: _CONDITIONS - 2] for f in factors if len(np.unique(f)) > 1]
    if any(len(np.unique(f)) < 3 for f in fitted):
        return False
    return len(fitted) < 2 or bool(np.abs(np.triu(np.corrcoef(fitted), 1)).max() < _MOST_CORRELATED)


def draw_levels(rng: np.random.Generator, design: str, kind: str, count_lengths: bool) -> Levels:
    """Levels of a design; factors that it holds stand at level 1."""
    fixed = np.ones(_CONDITIONS + 1, dtype=int)
    grips = kind in ("torsion", "bending")
    free = (
        {"amplitude", "rate", "temperature"}
        | ({"tension"} if grips else set())
        | ({"length"} if count_lengths else set())
    )
    held = {
        "amplitude-only": {"rate", "temperature", "tension", "length"},
        "amplitude-rate": {"rate"},
        "one-tension": {"tension"},
        "one-length": {"length"},
        "one-temperature": {"temperature"},
        "tied": {"temperature", "tension", "length"},
        "no-clock": {"rate"},
    }.get(design, set())
    for _ in range(2000):
        levels = {name: _mixed(rng) if name in free - held else fixed for name in Levels.__dataclass_fields__}
        if _well_mixed(list(levels.values())):
            break
    if design == "amplitude-rate":
        levels["rate"] = 2 - levels["amplitude"]
    if design == "tied":  # cold goes with high tension or with long specimens: two causes, one covariate
        two = np.append(rng.permutation([0, 0, 0, 2, 2, 2]), [*rng.permutation([0, 2]), 0])
        levels["temperature"] = two
        levels["tension" if grips else "length"] = 2 - two
    return Levels(**levels)


def two_sided(rng: np.random.Generator, shape: str) -> tuple[float, Callable[[Array], Array]]:
    """Cycles, and the path of amplitude 1 over the phase in cycles."""
    if shape == "growing":
        return 3.0, lambda p: np.sin(2 * np.pi * p) * np.array([0.45, 0.75, 1.0])[np.minimum(p.astype(int), 2)]
    if shape == "triangle":
        return 3.0, lambda p: 2 / np.pi * np.arcsin(np.sin(2 * np.pi * p))
    if shape == "hold":
        knots = np.array([0, 0.25, 0.5, 1.0, 1.25, 1.75, 2.0, 2.5, 2.75])
        return 2.75, lambda p: np.interp(p, knots, [0, 1, 1, -1, -1, 1, 1, -1, 0])
    return float(rng.choice([2.0, 3.0])), lambda p: np.sin(2 * np.pi * p)


def one_sided(rng: np.random.Generator, shape: str, low: float) -> tuple[float, Callable[[Array], Array]]:
    """The same, from 0 to 1 and then between `low` and 1."""

    def swing(p: Array) -> Array:
        return (1 + low) / 2 - (1 - low) / 2 * np.cos(2 * np.pi * p)

    def wave(p: Array) -> Array:
        return np.where(p < 0.5, (1 - np.cos(2 * np.pi * p)) / 2, swing(p))

    if shape == "growing":
        tops = np.array([0.45, 0.75, 1.0])

        def growing(p: Array) -> Array:
            half = np.minimum((2 * p).astype(int), 5)
            ends = np.array([0, tops[0], low * tops[0], tops[1], low * tops[1], tops[2], low * tops[2]])
            share = (1 - np.cos(np.pi * (2 * p - half))) / 2
            return ends[half] + (ends[half + 1] - ends[half]) * share

        return 3.0, growing
    if shape == "triangle":
        return 2.5, lambda p: np.interp(p, np.arange(6) / 2, [0, 1, low, 1, low, 1])
    if shape == "hold":
        return 3.0, lambda p: np.interp(p, [0, 0.5, 1.5, 2.0, 2.5, 3.0], [0, 1, 1, low, low, 1])
    return 2.5, wave


_RANGES = {
    "tension": ((0.004, 0.009), (4e5, 2e6)),
    "torsion": ((0.4, 1.4), (30.0, 120.0)),
    "bending": ((0.8, 2.5), (30.0, 120.0)),
    "shear": ((0.02, 0.06), (500.0, 3000.0)),
}
"""Largest path per length, and stiffness."""


def make_bench(rng: np.random.Generator, kind: str, design: str, load_control: bool = False) -> Bench:
    """Draw the conditions of one kind of experiment."""
    by_length = (
        kind == "tension"
        or (kind == "torsion" and bool(rng.random() < 0.8))
        or (kind == "torsion" and design == "tied")
    )
    levels = draw_levels(rng, design, kind, by_length)
    (low, high), (soft, stiff) = _RANGES[kind]
    largest = rng.uniform(low, high)
    amplitude = largest * AMPLITUDES[levels.amplitude]
    amplitude[-1] = _SEALED * largest
    frequency = np.exp(rng.uniform(np.log(0.007), np.log(0.032))) * RATES[levels.rate]
    shapes = rng.permutation(["sine", "growing", "triangle", "hold"] * 2)
    shapes = [*shapes, rng.choice(["sine", "growing"])]
    floor = rng.uniform(0.0, 0.35)
    one_way = kind == "tension"
    paths, times, counts = [], [], rng.integers(236, 344, _CONDITIONS + 1)
    for a, f, shape, n in zip(amplitude, frequency, shapes, counts, strict=True):
        cycles, path = one_sided(rng, str(shape), floor) if one_way else two_sided(rng, str(shape))
        dt = cycles / f / (n - 1)
        t = np.arange(counts.max()) * dt
        phase = np.minimum(t * f, cycles - 1e-9)
        paths.append(a * path(phase))
        times.append(t)
    sets = ["calibrate"] * (_CONDITIONS - 2) + ["validate"] * 2 + ["sealed"]
    length = LENGTHS[levels.length] if by_length else np.full(_CONDITIONS + 1, rng.choice([0.5, 1.0, 1.5]))
    typical = float(rng.choice([2000.0, 4000.0, 6000.0], p=[0.2, 0.6, 0.2]))
    bench = Bench(
        kind, np.array(paths), np.array(times), counts, length, typical * TENSIONS[levels.tension],
        TEMPERATURES[levels.temperature], frequency, float(np.exp(rng.uniform(np.log(soft), np.log(stiff)))),
        tuple(sets), typical, load_control,
    )  # fmt: skip
    if kind == "tension":
        bench = replace(bench, tension=np.zeros(_CONDITIONS + 1))
    return bench


def varies(bench: Bench, factor: str) -> bool:
    """Whether a factor has more than one level among the conditions that are fitted."""
    return len(np.unique(np.round(getattr(bench, factor)[bench.fitted_rows], 9))) > 1

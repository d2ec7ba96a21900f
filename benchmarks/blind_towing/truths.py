"""What may be hidden in a towing campaign, in forms of its own: half of them richer than any form that explains them.

A truth changes the trough, the drive, or what is read. Its `size` is a plain number near 1 that stands for a strength one
would meet; every variant scales with it.

| effect | variants |
|---|---|
| trough-friction-stribeck | exponential, Lorentz 1/(1 + (v/v0)^2), a step of Hill's law 1/(1 + (v/v0)^4) |
| viscous-drag | whole, part of the length, power |v|^0.85 |
| added-load | whole, part of the length, two heaps |
| roller-resistance | capstan exp(mu phi) - 1, bearing (proportional); mobilised over a travel of its own |
| clamp-backlash | play at the clamp followed by a soft one (first-order lag of 30 ms) |
| polygon-effect | pure, with a second harmonic |
| trolley-ratio-error | plain |
| sensor-offset, sensor-drift, sensor-lag | one channel: the tension at the towed end |
| outside the library: rough-patch, breakaway, quadratic-drag, clipped-reading | |
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.blind_towing.towed_line import Drive, Line, Trough

Array = NDArray[np.float64]
Reading = Callable[[Array, Array, Array], Array]
"""Clock (n,), told position (n,) and tensions (channels, n) to what the sensors say (channels, n)."""


@dataclass(frozen=True)
class Hidden:
    """What differs from the line that campaign.toml describes."""

    trough: Trough = field(default_factory=Trough)
    drive: Callable[[Drive], Drive] = lambda told: told
    reading: Reading = lambda t, p, y: y


@dataclass(frozen=True)
class Truth:
    """Name, variant, its numbers at size 1, and the size."""

    name: str
    variant: str
    build: Callable[[Line, float], Hidden] = field(repr=False)
    size: float = 1.0

    def of_size(self, size: float) -> Truth:
        return replace(self, size=size)

    def hidden(self, line: Line) -> Hidden:
        return self.build(line, self.size)


def _stribeck(rng: np.random.Generator, variant: str) -> Callable[[Line, float], Hidden]:
    fall, v0 = 0.06, float(np.exp(rng.uniform(np.log(0.06), np.log(0.25))))
    shape = {
        "exponential": lambda x: np.exp(-x),
        "lorentz": lambda x: 1 / (1 + x**2),
        "hill": lambda x: 1 / (1 + x**4),
    }[variant]
    return lambda line, size: Hidden(Trough(more=lambda v, way, s: size * fall * shape(v / v0)))


def _stretch(rng: np.random.Generator, line: Line) -> Array:
    """1 on a stretch of 35 to 65 % of the length, 0 elsewhere; softly at its ends."""
    width = line.length * rng.uniform(0.35, 0.65)
    begin = rng.uniform(0.05, 0.95 - width / line.length) * line.length
    s, soft = line.centres, line.length / 80
    return (np.tanh((s - begin) / soft) - np.tanh((s - begin - width) / soft)) / 2


def _drag(rng: np.random.Generator, variant: str) -> Callable[[Line, float], Hidden]:
    seed = int(rng.integers(1 << 30))

    def build(line: Line, size: float) -> Hidden:
        if variant == "part":
            return Hidden(Trough(drag=size * 8.0 * _stretch(np.random.default_rng(seed), line)))
        if variant == "power":  # as a friction coefficient, so that it opposes the motion
            weight = line.mass * 9.81
            return Hidden(Trough(more=lambda v, way, s: size * 5.0 * v**0.85 / weight))
        return Hidden(Trough(drag=size * 5.0))

    return build


def _load(rng: np.random.Generator, variant: str) -> Callable[[Line, float], Hidden]:
    seed = int(rng.integers(1 << 30))

    def build(line: Line, size: float) -> Hidden:
        r = np.random.default_rng(seed)
        if variant == "whole":
            return Hidden(Trough(load=0.5 * size))
        heaps = [_stretch(r, line) for _ in range(1 if variant == "part" else 2)]
        return Hidden(Trough(load=size * sum((0.8 / len(heaps)) * one for one in heaps)))

    return build


def mobilised(p: Array, travel: float) -> Array:
    """-1 to 1: direction of motion, 0 before the first one, with a soft turn over `travel` (Dahl, dz = dp (1 - z sign dp)/d)."""
    z = np.zeros_like(p)
    for n in range(1, len(p)):
        step = p[n] - p[n - 1]
        sign = np.sign(step)
        z[n] = sign + (z[n - 1] - sign) * np.exp(-abs(step) / travel)
    return z


def _roller(rng: np.random.Generator, variant: str) -> Callable[[Line, float], Hidden]:
    travel = float(rng.uniform(3e-4, 2e-3))

    def build(line: Line, size: float) -> Hidden:
        def read(t: Array, p: Array, y: Array) -> Array:
            z = mobilised(p, travel)
            factor = np.exp(0.05 * size * z) if variant == "capstan" else 1 + 0.05 * size * z
            return np.vstack([y[:1] * factor, y[1:]])

        return Hidden(reading=read)

    return build


def _sampled(told: Drive, change: Callable[[Array, Array], Array]) -> Drive:
    """A drive whose position is a function of the whole told path, taken at the fine instants; speeds by differences."""

    def drive(t: Array) -> tuple[Array, Array, Array]:
        p = change(t, told(t)[0])
        v = np.gradient(p, t)
        return p, v, np.gradient(v, t)

    return drive


def play(p: Array, width: float, first: float) -> Array:
    """Output of a play of that width, whose follower first stands `first` widths before it is pushed uphill."""
    out = np.empty_like(p)
    x = p[0] + first * width
    for n, pusher in enumerate(p):
        x = min(max(x, pusher), pusher + width)
        out[n] = x
    return out - out[0]


def lagged(t: Array, x: Array, tau: float) -> Array:
    """First-order lag of a signal that is straight between its samples."""
    out, decay = np.empty_like(x), float(np.exp(-(t[1] - t[0]) / tau))
    ramp = 1 - (1 - decay) * tau / (t[1] - t[0])
    out[0] = x[0]
    for n in range(1, len(x)):
        out[n] = decay * out[n - 1] + (1 - decay) * x[n - 1] + ramp * (x[n] - x[n - 1])
    return out


def _backlash(rng: np.random.Generator, variant: str) -> Callable[[Line, float], Hidden]:
    tau = 0.03 if variant == "soft" else 0.01
    return lambda line, size: Hidden(
        drive=lambda told: _sampled(told, lambda t, p: lagged(t, play(p, 0.012 * size, 0.0), tau))
    )


def _polygon(rng: np.random.Generator, variant: str) -> Callable[[Line, float], Hidden]:
    pitch, phases = float(rng.uniform(0.10, 0.22)), rng.uniform(0, 2 * np.pi, 2)
    second = 0.35 if variant == "harmonic" else 0.0

    def build(line: Line, size: float) -> Hidden:
        def ripple(p: Array) -> Array:
            parts = [(0.06 * size, 1, phases[0]), (0.06 * size * second, 2, phases[1])]
            w = 2 * np.pi / pitch
            return sum(r / (k * w) * (np.sin(k * w * p + f) - np.sin(f)) for r, k, f in parts)  # type: ignore[return-value]

        return Hidden(drive=lambda told: _sampled(told, lambda t, p: p + ripple(p)))

    return build


def _ratio(rng: np.random.Generator, variant: str) -> Callable[[Line, float], Hidden]:
    sign = float(rng.choice([-1.0, 1.0]))

    def build(line: Line, size: float) -> Hidden:
        e = 0.08 * sign * size

        def drive(told: Drive) -> Drive:
            return lambda t: tuple((1 + e) * x for x in told(t))  # type: ignore[return-value]

        return Hidden(drive=drive)

    return build


def _sensor(name: str) -> Callable[[np.random.Generator, str], Callable[[Line, float], Hidden]]:
    def draw(rng: np.random.Generator, variant: str) -> Callable[[Line, float], Hidden]:
        sign = float(rng.choice([-1.0, 1.0]))

        def build(line: Line, size: float) -> Hidden:
            unit = 0.1 * line.mass * line.length * 9.81 * sign * size

            def read(t: Array, p: Array, y: Array) -> Array:
                first = {
                    "sensor-offset": lambda: y[0] + 0.3 * unit,
                    "sensor-drift": lambda: y[0] + 0.5 * unit * t / t[-1],
                    "sensor-lag": lambda: lagged(t, y[0], 0.12 * size),
                    "clipped-reading": lambda: np.minimum(y[0], np.quantile(y[0], 1 - 0.25 * min(size, 3.0))),
                }[name]()
                return np.vstack([first[None], y[1:]])

            return Hidden(reading=read)

        return build

    return draw


def _rough_patch(rng: np.random.Generator, variant: str) -> Callable[[Line, float], Hidden]:
    begin, width = rng.uniform(0.1, 0.5), rng.uniform(0.15, 0.3)

    def build(line: Line, size: float) -> Hidden:
        def more(v: Array, way: Array, s: Array) -> Array:
            inside = (s > begin * line.length) & (s < (begin + width) * line.length)
            return np.where(inside, 0.15 * size, 0.0)

        return Hidden(Trough(more=more))

    return build


def _breakaway(rng: np.random.Generator, variant: str) -> Callable[[Line, float], Hidden]:
    travel = float(rng.uniform(0.05, 0.15))
    return lambda line, size: Hidden(Trough(more=lambda v, way, s: 0.12 * size * np.exp(-way / travel)))


def _quadratic(rng: np.random.Generator, variant: str) -> Callable[[Line, float], Hidden]:
    return lambda line, size: Hidden(Trough(quadratic=12.0 * size))


Draw = Callable[[np.random.Generator, str], Callable[[Line, float], Hidden]]
LIBRARY: dict[str, tuple[Draw, tuple[str, ...]]] = {
    "trough-friction-stribeck": (_stribeck, ("exponential", "lorentz", "hill")),
    "viscous-drag": (_drag, ("whole", "part", "power")),
    "added-load": (_load, ("whole", "part", "heaps")),
    "roller-resistance": (_roller, ("capstan", "bearing")),
    "clamp-backlash": (_backlash, ("sharp", "soft")),
    "polygon-effect": (_polygon, ("pure", "harmonic")),
    "trolley-ratio-error": (_ratio, ("plain",)),
    "sensor-offset": (_sensor("sensor-offset"), ("plain",)),
    "sensor-drift": (_sensor("sensor-drift"), ("plain",)),
    "sensor-lag": (_sensor("sensor-lag"), ("plain",)),
}
OUTSIDE: dict[str, tuple[Draw, tuple[str, ...]]] = {
    "rough-patch": (_rough_patch, ("cable",)),
    "breakaway": (_breakaway, ("travel",)),
    "quadratic-drag": (_quadratic, ("whole",)),
    "clipped-reading": (_sensor("clipped-reading"), ("plain",)),
}


def draw(rng: np.random.Generator, name: str, variant: str | None = None) -> Truth:
    """A truth of that name with random numbers, and a random variant if none is given."""
    law, variants = (LIBRARY | OUTSIDE)[name]
    chosen = variant or str(rng.choice(list(variants)))
    if chosen not in variants:
        raise ValueError(f"{name} has no variant {chosen}; it has {', '.join(variants)}")
    return Truth(name, chosen, law(rng, chosen))


def combined(hidden: list[Hidden]) -> Hidden:
    """All at once: friction, drag and load add; drives and readings one after the other."""
    trough = Trough(
        more=lambda v, way, s: sum((h.trough.more(v, way, s) for h in hidden), np.zeros(())),
        drag=sum((np.asarray(h.trough.drag) for h in hidden), np.zeros(())),
        load=sum((np.asarray(h.trough.load) for h in hidden), np.zeros(())),
        quadratic=sum(h.trough.quadratic for h in hidden),
    )

    def drive(told: Drive) -> Drive:
        for h in hidden:
            told = h.drive(told)
        return told

    def reading(t: Array, p: Array, y: Array) -> Array:
        for h in hidden:
            y = h.reading(t, p, y)
        return y

    return Hidden(trough, drive, reading)

"""Small bench campaigns made in memory by the forward model, with effects of known parameters and known noise."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from made_campaign import NOMINAL, UNIT
from numpy.typing import NDArray

from compare import BenchModel, Campaign, Channel, Experiment, NominalSection, Record
from compare.bench_path import bench_paths
from effects.effect import ActiveEffect
from effects.library import find

Array = NDArray[np.float64]
Noise = Callable[[np.random.Generator, Array], Array]
MODEL = BenchModel(NominalSection(NOMINAL))
LARGEST = {"tension": 4e-3, "torsion": 0.4, "bending": 1.0, "shear": 0.1}
LOAD = {"tension": "force", "torsion": "torque", "bending": "moment", "shear": "force"}
PATH = {"tension": "strain", "torsion": "twist", "bending": "curvature", "shear": "deflection"}


@dataclass(frozen=True)
class Condition:
    """One condition: amplitude over the largest, period [s], tension [N], temperature [K], length [m], side or sides."""

    amplitude: float = 1.0
    period: float = 20.0
    tension: float = 1000.0
    temperature: float = 293.15
    length: float = 1.0
    both: bool = True
    set: str = "calibrate"


RICH = (
    Condition(1.0),
    Condition(0.3),
    Condition(0.6, period=5.0),
    Condition(1.0, period=5.0, tension=2000.0),
    Condition(0.6, tension=500.0, temperature=313.15),
    Condition(1.0, tension=500.0, length=2.0),
    Condition(0.8, period=80.0, temperature=313.15, length=2.0),
    Condition(0.8, period=10.0, tension=2000.0, temperature=303.15),
)
"""Amplitude, rate, tension, temperature and length, each varied on its own."""


def one_sided(plan: Sequence[Condition]) -> list[Condition]:
    """The same conditions pulled and never pushed."""
    return [replace(c, both=False) for c in plan]


def switched(name: str, kind: str, shape: Sequence[float] = (), strength: Sequence[float] = (), form: int = 0,
             channel: str | None = None) -> ActiveEffect:  # fmt: skip
    """An effect of the library with values."""
    effect = find(name)
    return ActiveEffect(effect, effect.forms[form], kind, channel, tuple(shape), tuple(strength))


def white(level: float) -> Noise:
    """Independent samples, their scatter `level` times the rms of the channel in its largest record."""
    return lambda rng, signal: level * rng.normal(size=signal.size)


def blank(
    kind: str, plan: Sequence[Condition], n: int = 120, repeats: int = 2, also: Sequence[str] = ()
) -> list[Experiment]:
    """The experiments of a plan, two cycles each, with channels that are still zero."""
    experiments = []
    for g, c in enumerate(plan):
        time = np.linspace(0.0, 2 * c.period, n)
        phase = 2 * np.pi * time / c.period
        strain = c.amplitude * LARGEST[kind] * (np.sin(phase) if c.both else (1 - np.cos(phase)) / 2)
        path = strain * (c.length if kind == "shear" else 1.0)
        conditions = {"temperature": c.temperature, "specimen length": c.length}
        if kind != "tension":
            conditions["axial tension"] = c.tension
        for r in range(repeats):
            names = (LOAD[kind], *also)
            channels = {PATH[kind]: path, **{name: np.zeros(n) for name in names}}
            table = Record(time, PATH[kind], names, {k: Channel(k, UNIT[k], v) for k, v in channels.items()})
            id, of = f"{kind[0]}{g + 1:02d}{'abcd'[r]}", f"{kind[0]}{g + 1:02d}a" if r else None
            experiments.append(Experiment(id, kind, f"{id}.csv", "S1", c.set, conditions, of, sha256=id, table=table))
    return experiments


def refer(effects: Sequence[ActiveEffect], experiments: Sequence[Experiment], model: BenchModel = MODEL) -> BenchModel:
    """The model with effects whose scales are those of the experiments of the set calibrate."""
    known = [e for e in experiments if e.set == "calibrate"]
    paths = bench_paths(known, model)
    of_kind = {kind: next(paths[e.id].path for e in known if e.kind == kind) for kind in {e.kind for e in known}}
    return replace(model, effects=tuple(replace(a, reference=of_kind[a.kind]) for a in effects))


def measured(
    truth: BenchModel,
    experiments: Sequence[Experiment],
    noise: Noise | None,
    seed: int,
    scale: Mapping[str, float] | None = None,
) -> Campaign:
    """A campaign of what the truth says, with noise of one part of the largest rms of each channel of a kind."""
    rng = np.random.default_rng(seed)
    clean = [truth.predict(e, experiments) if truth.effects else truth.predict(e) for e in experiments]
    sizes: dict[tuple[str, str], float] = {}
    for e, readings in zip(experiments, clean):
        for name, y in readings.items():
            key = (e.kind, name)
            sizes[key] = max(sizes.get(key, 0.0), float(np.sqrt(np.mean(y**2))))
    done = []
    for e, readings in zip(experiments, clean):
        channels = dict(e.record.channels)
        for name, y in readings.items():
            size = (scale or {}).get(name, sizes[e.kind, name]) or 1.0
            noisy = y if noise is None else y + size * noise(rng, y / size)
            channels[name] = replace(channels[name], values=noisy)
        done.append(replace(e, table=replace(e.record, channels=channels)))
    return Campaign(Path("."), "made", None, NominalSection(NOMINAL), {}, {}, tuple(done))


def made(
    effects: Sequence[ActiveEffect],
    kind: str = "bending",
    plan: Sequence[Condition] = RICH,
    noise: Noise | None = None,
    seed: int = 0,
    n: int = 120,
    also: Sequence[str] = (),
    ratio: float = 1.1,
    scale: Mapping[str, float] | None = None,
) -> Campaign:
    """A campaign of one kind whose cable is `ratio` times as stiff as its nominal section, with these effects."""
    experiments = blank(kind, plan, n, also=also)
    model = MODEL.with_ratios(dict.fromkeys(NOMINAL, ratio))
    return measured(refer(effects, experiments, model), experiments, noise or white(0.01), seed, scale)

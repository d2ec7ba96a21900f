"""Suggest and do: the experiment that `explain` proposes for a bench campaign is made by the generator and added to the campaign.

The control is an experiment of the same cost (as :mod:`compare.next_experiment` counts it: one condition beyond what was
tested, or another rate) that is drawn at random instead.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from benchmarks.blind.bench import Bench
from benchmarks.blind.generator import Hidden

_CYCLES = 2.0


def extended(bench: Bench, conditions: Mapping[str, float]) -> Bench:
    """The bench with one more condition to calibrate: two sine cycles, with the values of experiments.csv or the middle of the others.

    `conditions` holds ``largest ... [unit]`` and ``largest rate [...]``, and may hold ``axial tension [N]``, ``temperature [degC]``
    and ``specimen length [m]``.
    """
    sizes = {k.split(" [")[0]: v for k, v in conditions.items() if k.startswith("largest ")}
    rate = sizes.pop("largest rate", None)
    (amplitude,) = sizes.values()
    n = bench.strain.shape[1]
    frequency = rate / (2 * np.pi * amplitude) if rate else float(np.median(bench.frequency))
    t = np.linspace(0.0, _CYCLES / frequency, n)

    def with_last(values: np.ndarray, name: str) -> np.ndarray:
        return np.append(values, conditions.get(name, float(np.median(values))))

    return replace(
        bench,
        strain=np.vstack([bench.strain, amplitude * np.sin(2 * np.pi * frequency * t)]),
        time=np.vstack([bench.time, t]),
        count=np.append(bench.count, n),
        length=with_last(bench.length, "specimen length [m]"),
        tension=with_last(bench.tension, "axial tension [N]"),
        temperature=with_last(bench.temperature, "temperature [degC]"),
        frequency=np.append(bench.frequency, frequency),
        set_names=(*bench.set_names, "calibrate"),
    )


def done(made: Hidden, conditions: Mapping[str, float]) -> Hidden:
    """The campaign with the experiment added to its first kind."""
    return replace(made, benches=(extended(made.benches[0], conditions), *made.benches[1:]))


def at_random(rng: np.random.Generator, made: Hidden, conditions: Mapping[str, float]) -> dict[str, float]:
    """An experiment of the same cost: amplitude and rate drawn within what was done, and hotter by 20 K instead of the proposed step."""
    bench = made.benches[0]
    path = next(k for k in conditions if k.startswith("largest ") and "rate" not in k)
    speed = next((k for k in conditions if k.startswith("largest rate")), None)
    amplitude = float(rng.uniform(0.4, 1.0) * bench.scale)
    drawn = {path: amplitude, "temperature [degC]": float(bench.temperature.max()) + 20.0}
    if speed:
        drawn[speed] = float(
            2 * np.pi * amplitude * np.exp(rng.uniform(*np.log([bench.frequency.min(), bench.frequency.max()])))
        )
    return drawn

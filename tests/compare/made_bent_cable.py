"""Bending campaigns made in memory: a grid of conditions in pairs, a law that is given, and the noise that is wanted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from made_campaign import NOMINAL, made_campaign, made_experiment
from numpy.typing import NDArray

from compare import BenchModel, Campaign, Comparison, NominalSection, compare

Array = NDArray[np.float64]
EI = 80.0


@dataclass(frozen=True)
class Bent:
    """What a law sees: curvature and its rate, time, and the conditions of the record."""

    k: Array
    rate: Array
    t: Array
    amplitude: float
    frequency: float
    tension: float
    temperature: float


Law = Callable[[Bent], Array]
GRID = [
    (0.4, 0.02, 1000.0, 283.15), (0.4, 0.2, 4000.0, 303.15), (0.8, 0.02, 4000.0, 293.15), (0.8, 0.2, 1000.0, 303.15),
    (0.8, 0.06, 2000.0, 283.15), (1.6, 0.02, 1000.0, 303.15), (1.6, 0.2, 4000.0, 283.15), (1.6, 0.06, 2000.0, 293.15),
]  # fmt: skip
"""amplitude [1/m], frequency [Hz], tension [N], temperature [K]: no two vary together."""


def bent_campaign(
    law: Law, seed: int = 0, noise: float = 0.2, grid: list | None = None, one_sided: bool = False, n: int = 200,
    scatter: float = 0.0,
) -> Campaign:  # fmt: skip
    """Two records per condition; the last condition is also measured once more at another amplitude to validate."""
    rng = np.random.default_rng(seed)
    experiments = []
    conditions = [*(GRID if grid is None else grid), (1.2, 0.06, 2000.0, 293.15)]
    for g, (amplitude, frequency, tension, temperature) in enumerate(conditions):
        t = np.linspace(0, 2 / frequency, n)
        w = 2 * np.pi * frequency
        k = amplitude * ((1 - np.cos(w * t)) / 2 if one_sided else np.sin(w * t))
        rate = amplitude * w * (np.sin(w * t) / 2 if one_sided else np.cos(w * t))
        clean = law(Bent(k, rate, t, amplitude, frequency, tension, temperature))
        for r in (0, 1):
            moment = clean * (1 + scatter * rng.normal()) + rng.normal(0, noise, n)
            e = made_experiment(
                f"g{g}r{r}", "bending", "curvature", {"curvature": k, "moment": moment},
                repeat_of=f"g{g}r0" if r else None, set="calibrate" if g < len(conditions) - 1 else "validate",
                conditions={"axial tension": tension, "temperature": temperature, "specimen length": 1.0},
            )  # fmt: skip
            experiments.append(replace(e, table=replace(e.record, time=t)))
    return made_campaign(experiments, NominalSection(NOMINAL))


def compared(campaign: Campaign) -> Comparison:
    """The base model beside it."""
    return compare(BenchModel(campaign.section), campaign)

"""Campaigns made in memory, with known stiffness and known noise, for tests that need many of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from compare import Campaign, Channel, Experiment, NominalSection, Record

Array = NDArray[np.float64]
UNIT = {"strain": "1", "force": "N", "torque": "N m", "curvature": "1/m", "moment": "N m", "twist": "rad/m"}
UNIT |= {"deflection": "m", "extension": "m"}
NOMINAL = {"EA": 4.0e5, "GA": 1.6e5, "EI": 95.0, "GJ": 60.0}


def made_experiment(id: str, kind: str, prescribed: str, channels: Mapping[str, Array], **fields: object) -> Experiment:
    """An experiment with the record given as SI arrays."""
    measured = tuple(name for name in channels if name != prescribed)
    record = Record(None, prescribed, measured, {n: Channel(n, UNIT[n], v) for n, v in channels.items()})
    full: dict[str, object] = {"specimen": "S", "set": "calibrate", "conditions": {}, "sha256": id, **fields}
    return Experiment(id=id, kind=kind, file=f"{id}.csv", table=record, **full)  # type: ignore[arg-type]


def made_campaign(experiments: list[Experiment], section: NominalSection | None = None) -> Campaign:
    """A campaign of these experiments."""
    return Campaign(Path("."), "made", None, section or NominalSection(NOMINAL), {}, {}, tuple(experiments))


def null_pulls(
    rng: np.random.Generator, noise: Callable[[Array], Array], EA: float, groups: int, n: int = 80
) -> list[Experiment]:
    """Tension experiments in pairs, whose force is EA times strain and noise; nothing is missing."""
    pulls = []
    for g in range(groups):
        strain = rng.uniform(1e-3, 5e-3) * np.sin(np.linspace(0, 12, n)) ** 2
        for repeat in (0, 1):
            force = EA * strain + noise(EA * strain)
            of = f"g{g}r0" if repeat else None
            pulls.append(
                made_experiment(f"g{g}r{repeat}", "tension", "strain", {"strain": strain, "force": force}, repeat_of=of)
            )
    return pulls

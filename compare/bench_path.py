"""From the record of an experiment to the path that its specimen goes through.

The prescribed path is divided by the specimen length where it is one of a length. Where the load was prescribed, the
path is that of the model, load over stiffness. A record that goes on where another ended is led by the path of that one,
so that whatever has a memory knows what came before.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from compare.experiment import Experiment
from compare.kinds import KINDS
from compare.towing_setup import towing_path
from effects.effect import BenchPath

if TYPE_CHECKING:
    from compare.bench_model import BenchModel

Array = NDArray[np.float64]
_DIVIDED = ("extension", "rotation", "deflection")


@dataclass(frozen=True)
class LedPath:
    """A path, whose first `lead` samples belong to the records that this one continues."""

    path: BenchPath = field(repr=False)
    lead: int = 0


def path_length(experiment: Experiment, channel: str) -> float:
    """What a channel of the path is divided by to give the strain of its kind: the specimen length [m] or 1."""
    return experiment.length if channel in _DIVIDED else 1.0


def load_per_strain(model: BenchModel, experiment: Experiment) -> float:
    """Stiffness of the kind: load over path per length (EA, GJ, EI, of a cantilever force over deflection/length)."""
    over = experiment.length if experiment.kind == "shear" else 1.0
    return model.main_stiffness(experiment) * over


def load_controlled(experiment: Experiment) -> bool:
    """Whether the load was prescribed and the path measured."""
    return experiment.record.prescribed == KINDS[experiment.kind].load


def bench_paths(experiments: Sequence[Experiment], model: BenchModel) -> dict[str, LedPath]:
    """The path of every open experiment by id; scales are taken over all experiments of a kind.

    Parameters
    ----------
    experiments : sequence of Experiment
        Open bench experiments.
    model : BenchModel
        Its stiffness gives the strain where the load was prescribed, and the tension in a tension test.
    """
    own = {e.id: _own_path(e, model) for e in experiments}
    by_id = {e.id: e for e in experiments}
    for kind in dict.fromkeys(e.kind for e in experiments):
        members = [e.id for e in experiments if e.kind == kind]
        own.update({id: path for id, path in zip(members, _with_scales([own[id] for id in members]), strict=True)})
    return {id: _led(by_id[id], by_id, own) for id in own}


def _own_path(experiment: Experiment, model: BenchModel) -> BenchPath:
    if experiment.kind == "towing" and model.towing is not None:
        return towing_path(experiment, model.towing)
    record = experiment.record
    stiffness = load_per_strain(model, experiment)
    given = record[record.prescribed]
    strain = given / (stiffness if load_controlled(experiment) else path_length(experiment, record.prescribed))
    if experiment.kind == "tension":
        tension: Array | None = np.maximum(stiffness * strain, 0.0)
    elif "axial tension" in experiment.conditions:
        tension = np.full(len(strain), experiment.conditions["axial tension"])
    else:
        tension = None
    return BenchPath(
        experiment.kind,
        np.ascontiguousarray(strain, dtype=float),
        None if record.time is None else record.time - record.time[0],
        experiment.conditions.get("specimen length"),
        tension,
        experiment.conditions.get("temperature"),
        experiment.direction,
    )


def _with_scales(paths: Sequence[BenchPath]) -> list[BenchPath]:
    largest = max((float(np.abs(p.strain).max()) for p in paths), default=0.0) or 1.0
    tensions = [float(p.tension.mean()) for p in paths if p.tension is not None]
    temperatures = [p.temperature for p in paths if p.temperature is not None]
    return [
        replace(
            p,
            largest=largest,
            typical_tension=float(np.mean(tensions)) if tensions else 0.0,
            typical_temperature=float(np.mean(temperatures)) if temperatures else 293.15,
        )
        for p in paths
    ]


def _led(experiment: Experiment, by_id: Mapping[str, Experiment], own: Mapping[str, BenchPath]) -> LedPath:
    """The path with those of the records that it continues before it."""
    chain, seen = [experiment], {experiment.id}
    while (before := chain[0].continues) is not None and before in by_id and before not in seen:
        seen.add(before)
        chain.insert(0, by_id[before])
    path = own[experiment.id]
    if len(chain) == 1:
        return LedPath(path)
    parts = [own[e.id] for e in chain]
    times = None
    if all(p.time is not None for p in parts):
        clocks, now = [], 0.0
        for p in parts:
            assert p.time is not None
            clocks.append(p.time + now)
            now = float(clocks[-1][-1]) + (float(p.time[-1]) / max(len(p.time) - 1, 1))
        times = np.concatenate(clocks)
    tension = np.concatenate([p.tension for p in parts if p.tension is not None]) if path.tension is not None else None
    if tension is not None and len(tension) != sum(len(p.strain) for p in parts):
        tension = None
    strain = np.concatenate([p.strain for p in parts])
    return LedPath(replace(path, strain=strain, time=times, tension=tension), len(strain) - len(path.strain))

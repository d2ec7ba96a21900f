"""Towing records as the fits want them: readings, their noise, and the columns that :mod:`compare.towing_response` works out.

With the calibrated base f(1, 0) and its slope J over the friction ratio the target of a reading is y - f(1, 0) + J, so that
its base column J fits it with the ratio itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from compare.bench_design import Block, Reading, Whitener, repeat_groups
from compare.bench_model import BenchModel
from compare.bench_path import LedPath, bench_paths
from compare.experiment import Experiment
from compare.noise_floor import NoiseModel
from compare.towing_response import Shape, TowingResponse
from effects.effect import ActiveEffect, BenchPath

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TowingRecord:
    """One towing experiment with its readings; offers what :class:`compare.bench_design.BenchRecord` does."""

    experiment: Experiment
    led: LedPath = field(repr=False)
    readings: tuple[Reading, ...] = field(repr=False)
    response: TowingResponse = field(repr=False)

    def columns(self, terms: Sequence[ActiveEffect], only: int | None = None) -> list[Array]:
        """Columns of every reading, base first, then those of each term: (n, P); with `only` just those of one term."""
        return _only(self.response.columns(self, tuple(terms)), terms, only)

    def rough_columns(
        self, terms: Sequence[ActiveEffect], only: int | None = None, near: Shape | None = None
    ) -> list[Array]:
        """The same, but linear in the last term: as it acts at a small strength beside the others, which are corrected.

        With `near` the columns are corrected by what corrects them at that shape of the last term.
        """
        return _only(self.response.rough_columns(self, tuple(terms), near), terms, only)

    def inside(self, terms: Sequence[ActiveEffect]) -> BenchPath:
        """The told path."""
        return self.led.path

    def whitened(self, terms: Sequence[ActiveEffect], only: int | None = None) -> Array:
        """The columns of all readings one below the other, white: (N, P)."""
        return np.vstack([r.whiten(Z) for r, Z in zip(self.readings, self.columns(terms, only), strict=True)])

    @property
    def target(self) -> Array:
        """The measurements of all readings less the offset of the linear form, white: (N,)."""
        return np.concatenate([r.whiten(r.y[:, None])[:, 0] for r in self.readings])


def towing_block(experiments: Sequence[Experiment], model: BenchModel, noise: NoiseModel) -> Block:
    """The block of all towing experiments, about a calibrated base model."""
    assert model.towing is not None
    base = tuple(p.name for p in model.free_parameters(experiments))
    response = TowingResponse(model.towing, model.stiffness("friction coefficient"))
    paths = bench_paths(experiments, model)
    records = tuple(towing_record(e, paths[e.id], response, noise) for e in experiments)
    response.hold(records)
    return Block("towing", base, records, repeat_groups(experiments))  # type: ignore[arg-type]


def towing_record(
    experiment: Experiment, led: LedPath, response: TowingResponse, noise: NoiseModel | Sequence[Reading]
) -> TowingRecord:
    """A record with its readings; their noise from a noise model, or as that of other readings."""
    f, J = response.base(experiment)
    readings = []
    for i, channel in enumerate(experiment.record.measured):
        covariance = noise.of(experiment, channel) if isinstance(noise, NoiseModel) else noise[i].whiten.noise
        y = experiment.record[channel] - f[i] + J[i]
        whiten = Whitener.of(covariance, f[i])
        readings.append(Reading(channel, "tension", y, np.ones(1), 1.0, whiten, f[i]))
    return TowingRecord(experiment, led, tuple(readings), response)


def _only(columns: list[Array], terms: Sequence[ActiveEffect], only: int | None) -> list[Array]:
    """All columns, or those of one term."""
    if only is None:
        return columns
    begin = 1 + sum(len(t.form.strength) for t in terms[:only])
    return [Z[:, begin : begin + len(terms[only].form.strength)] for Z in columns]

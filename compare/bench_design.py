r"""The columns of a bench model: what is linear in it, whitened, record by record.

For given shapes every model of the bench is linear in its stiffness factors and its strengths,

.. math::  y_c = \sum_b x_b\, Z_b + \sum_j a_j\, Z_j, \qquad Z = \text{bias},\ \text{filter}[K_i\, \text{fixture}(\varepsilon)],
           \ \text{filter}[K_i\, c_j(\text{fixture}(\varepsilon))]

K_i is the stiffness of the calibrated linear model in record i, so that x_b is about 1. Where the load F was prescribed
and the path measured, the same line is read at the path of the model to first order: y = F - K_i (measured - model),
with the noise of the path times K_i. Each channel is whitened with its own noise covariance (:mod:`compare.noise_covariance`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from compare.bench_model import BenchModel
from compare.bench_path import LedPath, bench_paths, load_per_strain, path_length
from compare.experiment import Experiment
from compare.fit_store import FitStore
from compare.innovations import innovations
from compare.kinds import KINDS
from compare.noise_covariance import NoiseCovariance
from compare.noise_floor import NoiseModel
from effects.effect import ActiveEffect, BenchPath

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Whitener:
    """Makes the noise of one channel of one record white; the update for gain and offset is worked out once."""

    noise: NoiseCovariance
    factor: float
    Q: Array = field(repr=False)
    shrink: Array = field(repr=False)

    @classmethod
    def of(cls, noise: NoiseCovariance, signal: Array, factor: float = 1.0) -> Whitener:
        """For readings that are `factor` times the channel, whose signal is `signal` in its own unit."""
        Q, shrink = noise.update(signal)
        return cls(noise, factor, Q, shrink)

    def __call__(self, Z: Array) -> Array:
        """The columns of Z (n, k) in white coordinates."""
        return self.records(self.samples(Z))

    def records(self, white: Array) -> Array:
        """Sample-white columns with gain and offset of the record made white as well."""
        if not self.Q.shape[1]:
            return white
        return white - self.Q @ (self.shrink[:, None] * (self.Q.T @ white))

    def samples(self, Z: Array) -> Array:
        """The same for the noise of the samples alone, without gain and offset of the record."""
        white = np.empty(Z.shape)
        f = self.factor**2
        innovations(np.ascontiguousarray(Z), self.noise.s**2 * f, self.noise.phi, self.noise.white**2 * f, white)
        return white


@dataclass(frozen=True)
class Reading:
    """One measured channel of one record, ready to be compared: target y (n,) and the factors of the base columns.

    `signal` is what a random gain multiplies, in units of y. `role` is ``load`` for the main line and ``cross`` for the
    other load; `unit_bias` is what a bias of one unit of the channel does to y; `flipped` says that the path was measured.
    """

    channel: str
    role: str
    y: Array = field(repr=False)
    weights: Array
    stiffness: float
    whiten: Whitener = field(repr=False)
    signal: Array = field(repr=False)
    unit_bias: float = 1.0
    flipped: bool = False


@dataclass(frozen=True)
class BenchRecord:
    """One experiment, the path of its specimen and its readings."""

    experiment: Experiment
    led: LedPath = field(repr=False)
    readings: tuple[Reading, ...] = field(repr=False)

    def columns(self, terms: Sequence[ActiveEffect], only: int | None = None) -> list[Array]:
        """Columns of every reading, base first, then those of each term: (n, P); with `only` just those of one term."""
        path = self.inside(terms)
        inner = [
            _matrix(term.form.respond(path, *term.shape))
            if term.form.stage in ("section", "cross") and only in (None, i)
            else None
            for i, term in enumerate(terms)
        ]
        return [self._of_reading(reading, path, terms, inner, only) for reading in self.readings]

    def inside(self, terms: Sequence[ActiveEffect]) -> BenchPath:
        """The path that the section sees, inside all fixtures."""
        path = self.led.path
        for term in terms:
            if term.form.stage == "fixture":
                path = path.with_strain(term.form.respond(path, *term.shape))
        return path

    def _of_reading(
        self,
        reading: Reading,
        path: BenchPath,
        terms: Sequence[ActiveEffect],
        inner: Sequence[Array | None],
        only: int | None,
    ) -> Array:
        n, lead = len(reading.y), self.led.lead
        parts = [] if only is not None else [path.strain[lead:, None] * (reading.stiffness * reading.weights)]
        for i, term in enumerate(terms):
            if only not in (None, i) or not term.form.strength:
                continue
            columns = inner[i]
            role = "load" if term.form.stage == "section" else "cross"
            if columns is not None and role == reading.role:
                parts.append(reading.stiffness * columns[lead:])
            else:  # biases are filled in after the filters
                parts.append(np.zeros((n, len(term.form.strength))))
        Z = np.ascontiguousarray(np.hstack(parts)) if parts else np.zeros((n, 0))
        return self._sensed(reading, Z, terms, only)

    def _sensed(self, reading: Reading, Z: Array, terms: Sequence[ActiveEffect], only: int | None) -> Array:
        """What the sensor makes of the columns: its filters, then its biases."""
        path, lead = self.led.path, self.led.lead
        time = None if path.time is None else path.time[lead:] - path.time[lead]
        for term in terms:
            if term.form.stage == "filter" and term.channel == reading.channel:
                read = _matrix(term.form.respond(Z, time, *term.shape))
                Z = 2 * Z - read if reading.flipped else read
        own = BenchPath(path.kind, path.strain[lead:], time, path.length)
        at = 0 if only is not None else len(reading.weights)
        for i, term in enumerate(terms):
            k = len(term.form.strength)
            if only not in (None, i) or not k:
                continue
            if term.form.stage == "bias" and term.channel == reading.channel:
                Z[:, at : at + k] = reading.unit_bias * _matrix(term.form.respond(own, *term.shape))
            at += k
        return Z

    def whitened(self, terms: Sequence[ActiveEffect], only: int | None = None) -> Array:
        """The columns of all readings one below the other, white: (N, P)."""
        return np.vstack([r.whiten(Z) for r, Z in zip(self.readings, self.columns(terms, only), strict=True)])

    @property
    def target(self) -> Array:
        """The measurements of all readings, white: (N,)."""
        return np.concatenate([r.whiten(r.y[:, None])[:, 0] for r in self.readings])


@dataclass(frozen=True)
class Block:
    """All experiments of one kind that are looked at together.

    Attributes
    ----------
    base : tuple of str
        Stiffnesses that the first columns belong to.
    groups : tuple of tuple of int
        Records that repeat each other; a group is the unit that is left out.
    fits : FitStore or None
        Where finished searches are kept (:mod:`compare.fit_store`).
    """

    kind: str
    base: tuple[str, ...]
    records: tuple[BenchRecord, ...] = field(repr=False)
    groups: tuple[tuple[int, ...], ...]
    fits: FitStore | None = field(default=None, repr=False, compare=False)

    def pairs(self, members: Sequence[int]) -> list[tuple[int, int]]:
        """Pairs of records of a group that repeat each other sample by sample, and do not merely go on from each other."""
        of = repeat_roots([record.experiment for record in self.records])
        size = [[len(r.y) for r in record.readings] for record in self.records]
        return [(i, j) for k, i in enumerate(members) for j in members[:k] if of[i] == of[j] and size[i] == size[j]]

    @property
    def channels(self) -> tuple[str, ...]:
        """Measured channels of any of its records."""
        return tuple(dict.fromkeys(r.channel for record in self.records for r in record.readings))

    @property
    def paths(self) -> list[BenchPath]:
        """The path of every record."""
        return [record.led.path for record in self.records]

    @property
    def samples(self) -> int:
        """Number of readings in all."""
        return sum(len(r.y) for record in self.records for r in record.readings)


def make_blocks(experiments: Sequence[Experiment], model: BenchModel, noise: NoiseModel) -> tuple[Block, ...]:
    """One block per kind of experiment, about a calibrated linear model.

    Parameters
    ----------
    experiments : sequence of Experiment
        Open bench experiments.
    model : BenchModel
        Calibrated: the columns are taken at its stiffness.
    noise : NoiseModel
        Covariance of every channel.
    """
    paths = bench_paths(experiments, model)
    blocks = []
    for kind in dict.fromkeys(e.kind for e in experiments):
        members = [e for e in experiments if e.kind == kind]
        if kind == "towing":
            from compare.towing_design import towing_block

            blocks.append(towing_block(members, model, noise))
            continue
        base = tuple(p.name for p in model.free_parameters(members))
        records = tuple(BenchRecord(e, paths[e.id], _readings(e, base, model, noise, paths[e.id])) for e in members)
        blocks.append(Block(kind, base, records, repeat_groups(members)))
    return tuple(blocks)


def repeat_groups(experiments: Sequence[Experiment]) -> tuple[tuple[int, ...], ...]:
    """Indices of the experiments that repeat each other, or go on from each other.

    Where this joins everything into one group, as in a campaign that is one long run, only repeats are joined: parts of
    the run can then still be left out.
    """
    joined = _joined(experiments, True)
    return joined if len(joined) > 1 else _joined(experiments, False)


def repeat_roots(experiments: Sequence[Experiment]) -> list[str]:
    """For every experiment the id of the one that it repeats, or its own."""
    by_id, roots = {e.id: e for e in experiments}, []
    for e in experiments:
        while e.repeat_of is not None and e.repeat_of in by_id:
            e = by_id[e.repeat_of]
        roots.append(e.repeat_of or e.id)
    return roots


def _joined(experiments: Sequence[Experiment], continued: bool) -> tuple[tuple[int, ...], ...]:
    by_id = {e.id: e for e in experiments}

    def root(e: Experiment) -> str:
        seen = set()
        while (before := e.repeat_of or (e.continues if continued else None)) is not None and e.id not in seen:
            seen.add(e.id)
            if before not in by_id:
                return before
            e = by_id[before]
        return e.id

    found: dict[str, list[int]] = {}
    for i, e in enumerate(experiments):
        found.setdefault(root(e), []).append(i)
    return tuple(tuple(members) for members in found.values())


def _readings(
    experiment: Experiment, base: Sequence[str], model: BenchModel, noise: NoiseModel, led: LedPath
) -> tuple[Reading, ...]:
    record, K = experiment.record, load_per_strain(model, experiment)
    predicted = model.predict(experiment)
    strain = led.path.strain[led.lead :]
    readings = []
    for channel in record.measured:
        covariance = noise.of(experiment, channel)
        y, signal = record[channel], predicted[channel]
        weights = _weights(experiment, base, model, channel, K)
        if channel in KINDS[experiment.kind].paths:
            over = path_length(experiment, channel)
            target = record[record.prescribed] - K * (y / over - strain)
            whiten = Whitener.of(covariance, signal, K / over)
            readings.append(Reading(channel, "load", target, weights, K, whiten, K / over * signal, -K / over, True))
        else:
            role = "load" if channel == KINDS[experiment.kind].load else "cross"
            readings.append(Reading(channel, role, y, weights, K, Whitener.of(covariance, signal), signal))
    return tuple(readings)


def _weights(experiment: Experiment, base: Sequence[str], model: BenchModel, channel: str, K: float) -> Array:
    """Logarithmic derivative of a reading by each base stiffness, times the reading over K strain."""
    cross = channel != KINDS[experiment.kind].load and channel not in KINDS[experiment.kind].paths
    weights = np.zeros(len(base))
    for i, name in enumerate(base):
        if cross:
            weights[i] = model.stiffness("coupling") / K if name == "coupling" else 0.0
        elif experiment.kind == "shear" and name in ("EI", "GA"):
            L, direction = experiment.length, experiment.direction
            soft = {"EI": L**3 / (3 * model.stiffness("EI", direction)), "GA": L / model.stiffness("GA", direction)}
            weights[i] = soft[name] / (soft["EI"] + soft["GA"])
        else:
            weights[i] = 0.0 if name == "coupling" else 1.0
    return weights


def _matrix(columns: Array) -> Array:
    return columns[:, None] if columns.ndim == 1 else columns

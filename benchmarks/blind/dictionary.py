"""The library's effects as columns for the baselines: pooled samples, plain forms, shapes on a grid of starting values.

Readings are divided by the nominal-to-measured slope and by the largest strain, so that base, columns and target are of
size about 1. A fixture or a filter, which is not linear in its shape, enters by what it changes at that shape.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.typing import NDArray

from compare import BenchModel, Campaign, Experiment
from compare.bench_path import bench_paths, load_controlled, path_length
from compare.calibration import calibrate
from compare.kinds import KINDS
from compare.noise_floor import measure_noise
from effects import BenchPath, Effect, library

Array = NDArray[np.float64]
_SHAPES = 8


@dataclass(frozen=True)
class Term:
    """One effect at one shape: its columns over all samples, (n, k), and how many numbers were chosen for it."""

    effect: str
    columns: Array = field(repr=False)
    numbers: int


@dataclass(frozen=True)
class Dictionary:
    """Pooled samples of one campaign.

    Attributes
    ----------
    target : (n,) array
        Measured readings, scaled.
    base : (n, b) array
        One column per kind of experiment.
    terms : tuple of Term
        Candidates.
    group : (n,) array of int
        Condition of each sample; repeats share it.
    fitted : (n,) array of bool
        Samples of the set *calibrate*; the others are of *validate*.
    noise : float
        Standard deviation of the noise, from differences of repeats of the set *validate*; 0 if there are none.
    features : (n, f) array
        Path, its direction and the conditions, scaled to size 1, for a Gaussian process.
    """

    target: Array = field(repr=False)
    base: Array = field(repr=False)
    terms: tuple[Term, ...] = field(repr=False)
    group: NDArray[np.int_] = field(repr=False)
    fitted: NDArray[np.bool_] = field(repr=False)
    noise: float
    features: Array = field(repr=False)


@dataclass(frozen=True)
class _Piece:
    """One channel of one record."""

    experiment: Experiment
    path: BenchPath
    role: str
    y: Array
    time: Array | None


def _pieces(campaign: Campaign, model: BenchModel) -> list[_Piece]:
    experiments = [e for e in campaign.experiments if e.is_open]
    paths = bench_paths(experiments, model)
    pieces = []
    for e in experiments:
        kind, path = KINDS[e.kind], paths[e.id].path
        slope = model.main_stiffness(e) * (e.length if e.kind == "shear" else 1.0)
        for channel in e.record.measured:
            role = "load" if channel == kind.load or channel in kind.paths else "cross"
            over = path_length(e, channel) if load_controlled(e) else slope
            sign = -1.0 if load_controlled(e) else 1.0
            y = e.record[channel] / over / path.largest
            y = 2 * path.strain / path.largest - y if sign < 0 else y  # too long a path reads as too small a load
            pieces.append(_Piece(e, path, role, y, path.time))
    return pieces


def _grid(effect: Effect, paths: Sequence[BenchPath]) -> list[tuple[float, ...]]:
    """At most eight shapes of the plain form."""
    axes = [p.starts(paths) if p.starts else np.array([1.0]) for p in effect.forms[0].shape]
    shapes = [tuple(map(float, s)) for s in product(*axes)]
    keep = np.unique(np.linspace(0, len(shapes) - 1, min(_SHAPES, len(shapes))).round().astype(int))
    return [shapes[i] for i in keep]


def _column(effect: Effect, shape: tuple[float, ...], piece: _Piece) -> Array:
    """What the effect adds to one channel of one record, (n, k)."""
    form, path = effect.forms[0], piece.path
    k = max(len(form.strength), 1)
    nothing = np.zeros((len(path.strain), k))
    on_main = piece.role == "load"
    if (form.stage == "section" and on_main) or (form.stage == "cross" and not on_main):
        return np.reshape(form.respond(path, *shape), (-1, k)) / path.largest
    if form.stage == "fixture" and on_main:
        return (form.respond(path, *shape) - path.strain)[:, None] / path.largest
    if form.stage == "filter" and on_main and piece.time is not None:
        return (
            form.respond(path.strain[:, None], piece.time, *shape) / path.largest - path.strain[:, None] / path.largest
        )
    if form.stage == "bias" and on_main:
        return np.reshape(form.respond(path, *shape), (-1, k))
    return nothing


def _terms(pieces: Sequence[_Piece]) -> list[Term]:
    terms = []
    kinds = dict.fromkeys(p.experiment.kind for p in pieces)
    for effect in library():
        members = [p for p in pieces if p.experiment.kind in effect.kinds]
        paths = [p.path for p in members]
        if not members or all(
            effect.why_untestable([p.path for p in members if p.experiment.kind == kind])
            for kind in kinds
            if kind in effect.kinds
        ):
            continue
        for shape in _grid(effect, paths):
            k = max(len(effect.forms[0].strength), 1)
            rows = [_column(effect, shape, p) if p in members else np.zeros((len(p.y), k)) for p in pieces]
            columns = np.nan_to_num(np.vstack(rows))
            if np.any(np.abs(columns).max(axis=0) > 1e-9):
                terms.append(Term(effect.name, columns, k + len(shape)))
    return terms


def _noise(pieces: Sequence[_Piece]) -> float:
    by_id = {(p.experiment.id, p.role): p for p in pieces}
    squares, count = 0.0, 0
    for p in pieces:
        first = by_id.get((p.experiment.repeat_of or "", p.role))
        if p.experiment.set == "validate" and first is not None and len(first.y) == len(p.y):
            squares += float(np.sum((p.y - first.y) ** 2) / 2)
            count += len(p.y)
    return float(np.sqrt(squares / count)) if count else 0.0


def _features(piece: _Piece) -> Array:
    path = piece.path
    frequency = piece.experiment.conditions.get("frequency", 0.1)
    still = [
        np.log10(frequency),
        ((path.temperature or 293.15) - 293.15) / 20,
        float(np.mean(path.tension)) / (path.typical_tension or 1) if path.tension is not None else 0.0,
        np.log2(path.length or 1.0),
        1.0 if piece.role == "cross" else 0.0,
    ]
    strain = path.strain / path.largest
    return np.column_stack([2 * strain, 0.5 * np.sign(np.gradient(strain)), np.tile(still, (len(strain), 1))])


def make_dictionary(campaign: Campaign) -> Dictionary:
    """Pooled samples and columns of a campaign whose linear stiffness was calibrated."""
    assert campaign.section is not None
    experiments = [e for e in campaign.experiments if e.is_open]
    to_fit = [e for e in experiments if e.set == "calibrate"]
    model = calibrate(BenchModel(campaign.section), to_fit, measure_noise(campaign)).model
    pieces = _pieces(campaign, model)
    kinds = list(dict.fromkeys(p.experiment.kind for p in pieces))
    conditions = list(dict.fromkeys(p.experiment.repeat_of or p.experiment.id for p in pieces))
    base = [
        np.outer(
            p.path.strain / p.path.largest if p.role == "load" else 0 * p.path.strain,
            [p.experiment.kind == k for k in kinds],
        )
        for p in pieces
    ]

    counts = [len(p.y) for p in pieces]
    group = np.repeat([conditions.index(p.experiment.repeat_of or p.experiment.id) for p in pieces], counts)
    fitted = np.repeat([p.experiment.set == "calibrate" for p in pieces], counts)
    return Dictionary(
        np.concatenate([p.y for p in pieces]),
        np.vstack(base),
        tuple(_terms(pieces)),
        group,
        fitted,
        _noise(pieces),
        np.vstack([_features(p) for p in pieces]),
    )

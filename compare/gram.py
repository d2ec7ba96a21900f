r"""Gram matrices of whitened columns: all that fits, left-out scores and evidence need of the data.

With V = (Z, y) white, the residual of any coefficients x has the sum of squares (x, -1) V^T V (x, -1)^T. Summed within
groups of repeats, these small matrices give the fit on any subset of groups by addition. For repeats a and b

.. math::  \tfrac12 (V_a^T V_b + V_b^T V_a)

gives in the same way the part of the residual that repeats share: its expectation is the energy of the misfit alone,
whatever the variance and the shape of the noise, because the noise of two records is independent.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.bench_design import BenchRecord, Block
from compare.bounded_least_squares import solve_bounded
from effects.effect import ActiveEffect

Array = NDArray[np.float64]
Shape = tuple[float, ...]
_LARGEST_SIZE = 1e12  # of a column over the target, squared: where nothing was measured but zeros
_PRIOR_STRENGTH = 0.3  # prior standard deviation of an effect: its rms over that of the linear load


@dataclass(frozen=True)
class Scatter:
    """Random gain and offset of the readings of a block: variances D (R, 2), and the group of each reading (R,)."""

    D: Array = field(repr=False)
    group: NDArray[np.intp] = field(repr=False)
    groups: int
    contrasts: int = 0

    @classmethod
    def of(cls, block: Block) -> Scatter:
        """As the repeats showed it."""
        group_of = {i: g for g, members in enumerate(block.groups) for i in members}
        D, group = [], []
        for i, record in enumerate(block.records):
            for reading in record.readings:
                D.append((reading.whiten.noise.gain**2, reading.whiten.noise.offset**2))
                group.append(group_of[i])
        contrasts = min((r.whiten.noise.contrasts for record in block.records for r in record.readings), default=0)
        return cls(np.array(D), np.array(group, dtype=np.intp), len(block.groups), contrasts)

    def marginal(self, A: Array, inflation: Sequence[tuple[float, float]]) -> tuple[Array, Array]:
        """Gram matrices (v, ..., G, P + 1, P + 1) and log determinants (v, G) with gain and offset integrated out.

        Parameters
        ----------
        A : (..., R, P + 3, P + 3) array
            Of the readings, white but for gain and offset.
        inflation : sequence of (float, float)
            v amounts of further scatter of gain and offset, in standard errors of the gain and offset of one record.
        """
        U = np.reshape(A, (-1, *A.shape[-3:]))[0, :, -2:, -2:]
        unit = 1 / np.maximum(np.diagonal(U, axis1=1, axis2=2), 1e-300)
        S, dets = [], []
        for pair in inflation:
            root = np.sqrt(self.D + np.array(pair) ** 2 * unit)
            M = np.eye(2) + root[:, :, None] * U * root[:, None, :]
            W = root[:, :, None] * A[..., -2:, :-2]
            each = A[..., :-2, :-2] - np.swapaxes(W, -1, -2) @ (np.linalg.inv(M) @ W)
            S.append(self._summed(each))
            log_det = np.zeros(self.groups)
            np.add.at(log_det, self.group, np.linalg.slogdet(M)[1])
            dets.append(log_det)
        return np.array(S), np.array(dets)

    def surprise(self, A: Array, inflation: Sequence[tuple[float, float]]) -> Array:
        """How unlikely the repeats of the other half of the data are under so much scatter, in nats, (v,).

        A contrast shows gain and offset with the variance D and the standard error of one record; k of them follow
        chi-square. Half of them count, because the other half are in the data that are judged.
        """
        U = np.reshape(A, (-1, *A.shape[-3:]))[0, :, -2:, -2:]
        unit = 1 / np.maximum(np.diagonal(U, axis1=1, axis2=2), 1e-300)
        total = np.zeros(len(inflation))
        for i, pair in enumerate(inflation):
            ratio = np.median((self.D + (1 + np.array(pair) ** 2) * unit) / (self.D + unit), axis=0)
            total[i] = self.contrasts / 4 * float(np.sum(np.log(ratio) + 1 / ratio - 1))
        return total

    def measured(self, A: Array) -> Array:
        """Gram matrices (..., G, P + 1, P + 1) with the scatter that the repeats showed."""
        if not self.D.any():
            return self._summed(A[..., :-2, :-2])
        return self.marginal(A, [(0.0, 0.0)])[0][0]

    def _summed(self, each: Array) -> Array:
        """Sum over the readings of each group: (..., R, P, P) to (..., G, P, P)."""
        member = np.zeros((self.groups, len(self.group)))
        member[self.group, np.arange(len(self.group))] = 1.0
        flat = each.reshape(*each.shape[:-2], -1)
        return (member @ flat).reshape(*each.shape[:-3], self.groups, *each.shape[-2:])


@dataclass(frozen=True)
class Grams:
    """Of one block and one or more candidate models.

    Attributes
    ----------
    S : (..., G, P + 1, P + 1) array
        V^T V of every group of repeats; the last column is the target.
    X : (..., G, P + 1, P + 1) array
        The same from products of different repeats only, scaled to all records of the group.
    A : (..., R, P + 3, P + 3) array
        V^T V of every reading, white but for gain and offset, with the columns Z, y, signal and 1.
    n : (G,) array
        Readings in every group.
    repeated : (G,) array of bool
        Which groups have repeats.
    positive : (P,) array of bool
        Coefficients that may not be negative.
    base : int
        How many of the columns are stiffnesses (prior about 1); the others are strengths (prior about 0).
    scatter : Scatter
        Random gain and offset of every reading.
    """

    S: Array = field(repr=False)
    X: Array = field(repr=False)
    A: Array = field(repr=False)
    n: Array = field(repr=False)
    repeated: NDArray[np.bool_] = field(repr=False)
    positive: NDArray[np.bool_]
    base: int
    scatter: Scatter = field(repr=False)

    @property
    def P(self) -> int:
        """Number of coefficients."""
        return len(self.positive)

    def prior(self) -> tuple[Array, Array]:
        """Mean (P,) and precision (..., P) of the coefficients, weak: stiffness factors 1 +- 1, strengths 0 +- 30 %."""
        mean = np.zeros(self.P)
        mean[: self.base] = 1.0
        diagonal = np.diagonal(self.S, axis1=-2, axis2=-1).sum(axis=-2)
        size = np.clip(diagonal[..., :-1] / np.maximum(diagonal[..., -1:], 1e-200), 0.0, _LARGEST_SIZE)
        precision = np.ones_like(size)
        precision[..., self.base :] = np.maximum(size[..., self.base :], 1e-12) / _PRIOR_STRENGTH**2
        return mean, precision

    def fit(self, S: Array, prior: tuple[Array, Array] | None = None) -> Array:
        """Coefficients (..., P) that fit the summed Gram matrices S (..., P + 1, P + 1)."""
        mean, precision = self.prior() if prior is None else prior
        A = S[..., :-1, :-1].copy()
        diagonal = np.einsum("...ii->...i", A)
        diagonal += precision
        b = S[..., :-1, -1] + precision * mean
        x = np.empty(b.shape)
        P = self.P
        solve_bounded(
            np.ascontiguousarray(A.reshape(-1, P, P)),
            np.ascontiguousarray(b.reshape(-1, P)),
            self.positive,
            x.reshape(-1, P),
        )
        return x


def energy(S: Array, x: Array) -> Array:
    """(x, -1) S (x, -1)^T for S (..., P + 1, P + 1) and x (..., P), shapes broadcast."""
    Sx = np.einsum("...ij,...j->...i", S[..., :-1, :-1], x)
    return np.sum(x * (Sx - 2 * S[..., :-1, -1]), axis=-1) + S[..., -1, -1]


def total_cost(grams: Grams) -> Array:
    """Penalised square residual of all groups together, per shape; S is (m, G, ...) or (G, ...)."""
    S = grams.S.sum(axis=-3)
    mean, precision = grams.prior()
    x = grams.fit(S, (mean, precision))
    return energy(S, x) + np.sum(precision * (x - mean) ** 2, axis=-1)


def positive_flags(block: Block, terms: Sequence[ActiveEffect]) -> NDArray[np.bool_]:
    """Which coefficients of a model may not be negative: strengths whose lower bound is zero."""
    flags = [False] * len(block.base)
    for term in terms:
        flags += [p.low >= 0 for p in term.form.strength]
    return np.array(flags, dtype=np.bool_)


class Scan:
    """Gram matrices of many candidates beside the same accepted terms; what does not change is whitened once."""

    def __init__(self, block: Block, accepted: Sequence[ActiveEffect]) -> None:
        self.block, self.accepted = block, tuple(accepted)
        self._response: Any = getattr(block.records[0], "response", None)  # of towing records: runs that are kept
        self.scatter = Scatter.of(block)
        self._fixed = [_sample_white(record, self.accepted) for record in block.records]
        self._rest = [
            [
                r.whiten.samples(np.column_stack([r.y, r.signal, np.full(len(r.y), r.whiten.factor)]))
                for r in record.readings
            ]
            for record in block.records
        ]
        self._paths = [record.inside(self.accepted) for record in block.records]
        self._plain = not any(t.form.stage == "filter" for t in self.accepted)
        self._loads = [[(r.role == "load") for r in record.readings] for record in block.records]
        self._known = [
            [np.concatenate((Z, rest), axis=1) for Z, rest in zip(Zs, rests, strict=True)]
            for Zs, rests in zip(self._fixed, self._rest, strict=True)
        ]
        self._known_products = np.array([V.T @ V for known in self._known for V in known])

    def base(self) -> Grams:
        """Of the accepted terms alone."""
        return self._with(self.accepted, self._fixed)

    def candidate(self, term: ActiveEffect, near: Shape | None = None) -> Grams:
        """Of the accepted terms and one more, with what repeats share; `near` as in :meth:`cost_matrix`."""
        terms = (*self.accepted, term)
        return self._with(terms, self._columns(term, near is not None, near))

    def cost_matrix(self, term: ActiveEffect, rough: bool = False, near: Shape | None = None) -> Array:
        """A (R, P + 3, P + 3) of the accepted terms and one more.

        Where columns are dear, it is linear in the new term if `rough`, or corrected as it is at its shape `near`.
        """
        if term.form.stage != "section" or not self._plain:
            return self._products(self._columns(term, rough or near is not None, near))
        P, k = self._fixed[0][0].shape[1], len(term.form.strength)
        size = P + k + 3
        own, across = np.zeros((len(self._known_products), k, k)), np.zeros((len(self._known_products), k, P + 3))
        at = 0
        for i, known in enumerate(self._known):
            c = self._strain_columns(i, term)
            for reading, load, V in zip(self.block.records[i].readings, self._loads[i], known, strict=True):
                if load:
                    white = reading.whiten.samples(reading.stiffness * c)
                    own[at] = white.T @ white
                    across[at] = white.T @ V
                at += 1
        old = [*range(P), *range(P + k, size)]
        A = np.empty((len(own), size, size))
        A[:, P : P + k, P : P + k] = own
        A[np.ix_(range(len(own)), old, old)] = self._known_products
        A[:, P : P + k, old] = across
        A[:, old, P : P + k] = across.swapaxes(1, 2)
        return A

    def _strain_columns(self, i: int, term: ActiveEffect) -> Array:
        """Columns of a section effect in record i, in strain: (n, k)."""
        c = term.form.respond(self._paths[i], *term.shape)[self.block.records[i].led.lead :]
        return c[:, None] if c.ndim == 1 else c

    def grid(self, term: ActiveEffect, shapes: Sequence[tuple[float, ...]]) -> Grams:
        """Of one more term at several shapes: S and A of shape (m, ...); X, which no search needs, is left empty.

        Where columns are dear, those of a towing record, all shapes are rough but the best and those beside it: they are corrected
        until it stays, for a column that is linear at a strength far from that fitted can make a good shape look bad.
        """
        terms = [replace(term, shape=shape) for shape in shapes]
        if not self.dear:
            return self.of_matrix(term, np.stack([self.cost_matrix(t) for t in terms]))
        self._response.prepare([(*self.accepted, t) for t in terms])
        A = np.stack([self.cost_matrix(t, rough=True) for t in terms])
        corrected: set[int] = set()
        while todo := _beside(shapes, int(np.argmin(total_cost(self.of_matrix(term, A))))) - corrected:
            for i in todo:
                A[i] = self.cost_matrix(terms[i])
            corrected |= todo
        return self.of_matrix(term, A)

    def of_matrix(self, term: ActiveEffect, A: Array) -> Grams:
        """Gram matrices from those of the readings A (..., R, P + 3, P + 3), without what repeats share."""
        block, terms = self.block, (*self.accepted, term)
        n = np.array([sum(len(r.y) for i in g for r in block.records[i].readings) for g in block.groups], dtype=float)
        S = self.scatter.measured(A)
        return Grams(S, S[..., :0, :0], A, n, n > 0, positive_flags(block, terms), len(block.base), self.scatter)

    @property
    def dear(self) -> bool:
        """Whether a column takes runs of a model, as those of a towing record."""
        return self._response is not None

    def _columns(self, term: ActiveEffect, rough: bool = False, near: Shape | None = None) -> list[list[Array]]:
        """Sample-white columns of all terms, per record and reading."""
        terms = (*self.accepted, term)
        rough &= self.dear
        if rough:
            self._response.prepare([terms])
        if term.form.stage in ("fixture", "filter", "drive"):
            return [_sample_white(record, terms, None, rough, near) for record in self.block.records]
        if term.form.stage != "section" or not self._plain:
            own = [_sample_white(record, terms, len(self.accepted), rough, near) for record in self.block.records]
        else:
            own = [self._section_columns(i, term) for i in range(len(self.block.records))]
        return [
            [np.concatenate(z, axis=1) for z in zip(a, b, strict=True)] for a, b in zip(self._fixed, own, strict=True)
        ]

    def _section_columns(self, i: int, term: ActiveEffect) -> list[Array]:
        record, c = self.block.records[i], self._strain_columns(i, term)
        return [
            r.whiten.samples(r.stiffness * c) if load else np.zeros(c.shape)
            for r, load in zip(record.readings, self._loads[i], strict=True)
        ]

    def _products(self, columns: Sequence[Sequence[Array]]) -> Array:
        A = []
        for Zs, rests in zip(columns, self._rest, strict=True):
            for Z, rest in zip(Zs, rests, strict=True):
                V = np.concatenate((Z, rest), axis=1)
                A.append(V.T @ V)
        return np.array(A)

    def _with(self, terms: Sequence[ActiveEffect], columns: Sequence[Sequence[Array]]) -> Grams:
        block, rows = self.block, []
        for record, Zs, rests in zip(block.records, columns, self._rest, strict=True):
            white = [
                r.whiten.records(np.concatenate((Z, rest[:, :1]), axis=1))
                for r, Z, rest in zip(record.readings, Zs, rests, strict=True)
            ]
            rows.append(white[0] if len(white) == 1 else np.concatenate(white))
        A = self._products(columns)
        X, n, repeated = shared_products(block, rows)
        S = self.scatter.measured(A)
        return Grams(S, X, A, n, repeated, positive_flags(block, terms), len(block.base), self.scatter)


def _beside(shapes: Sequence[Shape], best: int) -> set[int]:
    """The best shape and its neighbours on the grid, one parameter apart."""
    axes = [sorted(set(values)) for values in zip(*shapes, strict=True)]
    at = np.array([[axis.index(v) for axis, v in zip(axes, shape, strict=True)] for shape in shapes]).reshape(
        len(shapes), -1
    )
    return set(np.flatnonzero(np.abs(at - at[best]).sum(axis=1) <= 1).tolist())


def _sample_white(
    record: BenchRecord,
    terms: Sequence[ActiveEffect],
    only: int | None = None,
    rough: bool = False,
    near: Shape | None = None,
) -> list[Array]:
    """Columns of every reading of a record, white but for gain and offset."""
    columns = record.rough_columns(terms, only, near) if rough else record.columns(terms, only)  # type: ignore[attr-defined]
    return [r.whiten.samples(Z) for r, Z in zip(record.readings, columns, strict=True)]


def shared_products(block: Block, V: Sequence[Array]) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Products of different repeats (G, P, P), readings (G,) and whether there are repeats (G,), from white rows V."""
    P = V[0].shape[1]
    X, n, repeated = np.zeros((len(block.groups), P, P)), np.zeros(len(block.groups)), []
    for g, members in enumerate(block.groups):
        pairs = block.pairs(members)
        n[g] = sum(len(V[i]) for i in members)
        for i, j in pairs:
            cross = V[i].T @ V[j]
            X[g] += (cross + cross.T) / 2
        X[g] *= len(members) / max(len(pairs), 1)
        repeated.append(len(pairs) > 0)
    return X, n, np.array(repeated, dtype=np.bool_)

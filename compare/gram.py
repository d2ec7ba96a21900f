r"""Gram matrices of whitened columns: all that fits, left-out scores and evidence need of the data.

With V = (Z, y) white, the residual of any coefficients x has the sum of squares (x, -1) V^T V (x, -1)^T. Summed within
groups of repeats, these small matrices give the fit on any subset of groups by addition. For repeats a and b

.. math::  \tfrac12 (V_a^T V_b + V_b^T V_a)

gives in the same way the part of the residual that repeats share: its expectation is the energy of the misfit alone,
whatever the variance and the shape of the noise, because the noise of two records is independent.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from compare.bench_design import Block
from compare.bounded_least_squares import solve_bounded
from effects.effect import ActiveEffect

Array = NDArray[np.float64]
_PRIOR_STRENGTH = 0.3  # prior standard deviation of an effect: its rms over that of the linear load


@dataclass(frozen=True)
class Grams:
    """Of one block and one or more candidate models.

    Attributes
    ----------
    S : (..., G, P + 1, P + 1) array
        V^T V of every group of repeats; the last column is the target.
    X : (..., G, P + 1, P + 1) array
        The same from products of different repeats only, scaled to all records of the group.
    n : (G,) array
        Readings in every group.
    repeated : (G,) array of bool
        Which groups have repeats.
    positive : (P,) array of bool
        Coefficients that may not be negative.
    base : int
        How many of the columns are stiffnesses (prior about 1); the others are strengths (prior about 0).
    """

    S: Array = field(repr=False)
    X: Array = field(repr=False)
    n: Array = field(repr=False)
    repeated: NDArray[np.bool_] = field(repr=False)
    positive: NDArray[np.bool_]
    base: int

    @property
    def P(self) -> int:
        """Number of coefficients."""
        return len(self.positive)

    def prior(self) -> tuple[Array, Array]:
        """Mean (P,) and precision (..., P) of the coefficients, weak: stiffness factors 1 +- 1, strengths 0 +- 30 %."""
        mean = np.zeros(self.P)
        mean[: self.base] = 1.0
        diagonal = np.diagonal(self.S, axis1=-2, axis2=-1).sum(axis=-2)
        size = diagonal[..., :-1] / np.maximum(diagonal[..., -1:], 1e-300)
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


def positive_flags(block: Block, terms: Sequence[ActiveEffect]) -> NDArray[np.bool_]:
    """Which coefficients of a model may not be negative: strengths whose lower bound is zero."""
    flags = [False] * len(block.base)
    for term in terms:
        flags += [p.low >= 0 for p in term.form.strength]
    return np.array(flags, dtype=np.bool_)


def grams(block: Block, terms: Sequence[ActiveEffect]) -> Grams:
    """Gram matrices of one model: S and X of shape (G, P + 1, P + 1)."""
    V = [np.column_stack([record.whitened(terms), record.target]) for record in block.records]
    return _assemble(block, terms, V)


class Scan:
    """Gram matrices of many candidates beside the same accepted terms; what does not change is whitened once."""

    def __init__(self, block: Block, accepted: Sequence[ActiveEffect]) -> None:
        self.block, self.accepted = block, tuple(accepted)
        self._fixed = [record.whitened(self.accepted) for record in block.records]
        self._target = [record.target for record in block.records]

    def base(self) -> Grams:
        """Of the accepted terms alone."""
        V = [np.column_stack([Z, y]) for Z, y in zip(self._fixed, self._target, strict=True)]
        return _assemble(self.block, self.accepted, V)

    def candidate(self, term: ActiveEffect) -> Grams:
        """Of the accepted terms and one more."""
        terms = (*self.accepted, term)
        if term.form.stage in ("fixture", "filter"):
            V = [
                np.column_stack([record.whitened(terms), y])
                for record, y in zip(self.block.records, self._target, strict=True)
            ]
        else:
            V = [
                np.column_stack([Z, record.whitened(terms, only=len(self.accepted)), y])
                for record, Z, y in zip(self.block.records, self._fixed, self._target, strict=True)
            ]
        return _assemble(self.block, terms, V)

    def grid(self, term: ActiveEffect, shapes: Sequence[tuple[float, ...]]) -> Grams:
        """Of one more term at several shapes: S and X of shape (m, G, P + 1, P + 1)."""
        from dataclasses import replace

        each = [self.candidate(replace(term, shape=shape)) for shape in shapes]
        return replace(each[0], S=np.stack([g.S for g in each]), X=np.stack([g.X for g in each]))


def _assemble(block: Block, terms: Sequence[ActiveEffect], V: Sequence[Array]) -> Grams:
    P = V[0].shape[1]
    S, X = np.zeros((len(block.groups), P, P)), np.zeros((len(block.groups), P, P))
    n, repeated = np.zeros(len(block.groups)), np.zeros(len(block.groups), dtype=np.bool_)
    for g, members in enumerate(block.groups):
        pairs = 0
        for k, i in enumerate(members):
            S[g] += V[i].T @ V[i]
            n[g] += len(V[i])
            for j in members[:k]:
                if len(V[i]) == len(V[j]):
                    cross = V[i].T @ V[j]
                    X[g] += (cross + cross.T) / 2
                    pairs += 1
        if pairs:
            X[g] *= len(members) / pairs
            repeated[g] = True
    return Grams(S, X, n, repeated, positive_flags(block, terms), len(block.base))

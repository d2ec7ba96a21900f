r"""Evidence for an effect: e-values that stay valid without knowing the scatter, and scores on experiments left out.

*e-value.* The groups of repeats are split into a first part A and the rest B. With the marginal likelihood m over
coefficients and shapes (weak Gaussian priors, half-normal for strengths that may not be negative),

.. math::  e = \frac{m_1(A \cup B)\,/\,m_1(A)}{\sup_0\, p(B)}

is the prediction of B by the model with the effect that has seen A, over the best that the model without it can do when
it is fitted to B itself, where also the random gain and offset of the records may be larger than the repeats showed.
If nothing is missing the expectation of e is at most 1, so that P(e > c) <= 1/c, without regularity conditions; the mean over
several splits is an e-value again. Source: universal inference, Wasserman, Ramdas & Balakrishnan, PNAS 117 (2020)
16880, doi 10.1073/pnas.1922664117, with a predictive mixture in the place of a plug-in estimate.

*Left-out score.* Every group is left out once; everything is fitted to the others; half the fall of the whitened square
residual of the left-out group, summed, is the gain in nats. It ranks effects.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr, logsumexp

from compare.bench_design import Block
from compare.gram import Grams, energy
from effects.effect import ActiveEffect

Array = NDArray[np.float64]
_SEED = 20230218
_SPLITS = 12
_INFLATION = (0.0, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0)  # extra scatter of records, in standard errors of one record's own


def splits(groups: int) -> NDArray[np.bool_]:
    """Which groups are in the first part of each split, shape (splits, G): a third to a half of them."""
    if groups < 2:
        return np.zeros((1, groups), dtype=np.bool_)
    rng = np.random.default_rng(_SEED)
    size = max(1, groups // 3) if groups > 3 else 1
    members = np.zeros((_SPLITS, groups), dtype=np.bool_)
    for row in members:
        row[rng.permutation(groups)[:size]] = True
    return np.unique(members, axis=0)


def log_marginal(grams: Grams, S: Array) -> Array:
    """Log marginal likelihood of summed Gram matrices S (..., P + 1, P + 1), up to a constant of the data alone."""
    mean, precision = grams.prior()
    while precision.ndim < S.ndim - 1:
        precision = precision[..., None, :]
    A = S[..., :-1, :-1] + precision[..., None] * np.eye(grams.P)
    b = S[..., :-1, -1] + precision * mean
    square = S[..., -1, -1] + np.sum(precision * mean**2, axis=-1)
    inverse = np.linalg.inv(A)
    x = np.einsum("...ij,...j->...i", inverse, b)
    value = -0.5 * (square - np.sum(b * x, axis=-1))
    value = value + 0.5 * (np.sum(np.log(precision), axis=-1) - np.linalg.slogdet(A)[1])
    if grams.positive.any():
        std = np.sqrt(np.maximum(np.einsum("...ii->...i", inverse), 1e-300))
        tail = np.log(2.0) + log_ndtr(x / std)
        value = value + np.sum(tail[..., grams.positive], axis=-1)
    return value


@dataclass(frozen=True)
class Scatter:
    """The model without the effect, for every amount of extra scatter between records: (v, G, ...) arrays."""

    S: Array = field(repr=False)
    log_det: Array = field(repr=False)
    grams: Grams = field(repr=False)

    def best(self, groups: NDArray[np.bool_]) -> float:
        """Largest log likelihood of these groups, relative to the determinant at the scatter of the repeats."""
        S = np.einsum("vgij,g->vij", self.S, groups.astype(float))
        x = self.grams.fit(S, prior=(np.ones(self.grams.P), np.full(self.grams.P, 1e-9)))
        log_det = (self.log_det - self.log_det[0]) @ groups
        return float(np.max(-0.5 * (energy(S, x) + log_det)))


def scatter_variants(block: Block, accepted: Sequence[ActiveEffect], grams: Grams) -> Scatter:
    """The accepted model under gains and offsets of the records that scatter more than the repeats showed.

    Only the small matrices of V = (Z, y, m, 1), white but for gain and offset, are needed: the rest is Woodbury.
    """
    v, G, P = len(_INFLATION) ** 2, len(block.groups), grams.P + 1
    S, log_det = np.zeros((v, G, P, P)), np.zeros((v, G))
    group_of = {i: g for g, members in enumerate(block.groups) for i in members}
    for i, record in enumerate(block.records):
        for reading, Z in zip(record.readings, record.columns(accepted), strict=True):
            noise, f = reading.whiten.noise, reading.whiten.factor
            signal = Z[:, : grams.base].sum(axis=1) / f
            V = np.column_stack([Z, reading.y, f * signal, np.full(len(Z), f)])
            W = reading.whiten.samples(V)
            A = W.T @ W
            unit = 1 / np.maximum(np.diag(A)[-2:], 1e-300)
            extra = np.array([(a**2, b**2) for a in _INFLATION for b in _INFLATION]) * unit
            D = extra + np.array([noise.gain**2, noise.offset**2])
            root = np.sqrt(D)
            M = np.eye(2) + root[:, :, None] * A[-2:, -2:] * root[:, None, :]
            U = root[:, :, None] * A[None, -2:, :-2]
            S[:, group_of[i]] += A[:-2, :-2] - np.swapaxes(U, 1, 2) @ np.linalg.solve(M, U)
            log_det[:, group_of[i]] += np.linalg.slogdet(M)[1]
    return Scatter(S, log_det, grams)


def log_e_value(candidate: Grams, null: Scatter, parts: NDArray[np.bool_]) -> float:
    """Log e-value of a scan of shapes S (m, G, ...), mean over the splits `parts` (splits, G)."""
    S = candidate.S
    whole = log_marginal(candidate, S.sum(axis=1))
    first = log_marginal(candidate, np.einsum("mgij,sg->msij", S, parts.astype(float)))
    ratio = logsumexp(whole) - logsumexp(first, axis=0)
    rest = np.array([null.best(~part) for part in parts])
    return float(logsumexp(ratio - rest) - np.log(len(parts)))


def leave_out(S: Array) -> Array:
    """Gram matrices of all groups but one: (..., G, P + 1, P + 1) from (..., G, P + 1, P + 1)."""
    return S.sum(axis=-3, keepdims=True) - S


@dataclass(frozen=True)
class LeftOut:
    """Whitened square residual of every left-out group, and the part of it that repeats share: (G,) each."""

    square: Array
    shared: Array


def left_out(grams: Grams) -> LeftOut:
    """Fit to all groups but one, read on that one; of several shapes the one that fits the others best.

    Parameters
    ----------
    grams : Grams
        With S of shape (m, G, ...) or (G, ...).
    """
    S = grams.S if grams.S.ndim == 4 else grams.S[None]
    X = grams.X if grams.X.ndim == 4 else grams.X[None]
    mean, precision = grams.prior()
    precision = precision.reshape(len(S), 1, -1)
    others = leave_out(S)
    x = grams.fit(others, (mean, precision))
    cost = energy(others, x) + np.sum(precision * (x - mean) ** 2, axis=-1)
    best = np.argmin(cost, axis=0)
    groups = np.arange(S.shape[1])
    square = energy(S, x)[best, groups]
    return LeftOut(square, energy(X, x)[best, groups])

r"""Evidence for an effect: e-values that stay valid without knowing the scatter, and scores on experiments left out.

*e-value.* The groups of repeats are split into a first part A and the rest B. With the marginal likelihood m over
coefficients and shapes (weak Gaussian priors, half-normal for strengths that may not be negative),

.. math::  e = \frac{m_1(A \cup B)\,/\,m_1(A)}{\sup_0\, p(B)}

is the prediction of B by the model with the effect that has seen A, over the best that the model without it can do when
it is fitted to B itself, where also the random gain and offset of the records may be larger than the repeats showed.
Strengths of effects that were accepted before are predicted from A on both sides. If nothing is missing the expectation
of e is at most 1, so that P(e > c) <= 1/c, without regularity conditions; the mean over several splits is an e-value
again. Source: universal inference, Wasserman, Ramdas & Balakrishnan, PNAS 117 (2020)
16880, doi 10.1073/pnas.1922664117, with a predictive mixture in the place of a plug-in estimate.

*Left-out score.* Every group is left out once; everything is fitted to the others; half the fall of the whitened square
residual of the left-out group, summed, is the gain in nats. It ranks effects.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr, logsumexp

from compare.gram import Grams, energy

Array = NDArray[np.float64]
_SEED = 20230218
_SPLITS = 12
_INFLATION = (0.0, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0)  # extra scatter of records, in standard errors of one record's own
_PREDICTED_WITH = (0.0, 2.0, 8.0, 32.0)


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
class Null:
    """The model without the effect, for every amount of extra scatter between records: (v, G, ...) arrays."""

    S: Array = field(repr=False)
    log_det: Array = field(repr=False)
    penalty: Array = field(repr=False)
    grams: Grams = field(repr=False)

    @classmethod
    def of(cls, grams: Grams) -> Null:
        """From the Gram matrices of the accepted model."""
        pairs = [(a, b) for a in _INFLATION for b in _INFLATION]
        return cls(*grams.scatter.marginal(grams.A, pairs), grams.scatter.surprise(grams.A, pairs), grams)

    def best(self, first: NDArray[np.bool_]) -> float:
        """Largest log likelihood of the groups that are not in `first`, up to a constant of the samples.

        Over scatter, and over the stiffness fitted to these groups themselves. Strengths of effects that were accepted
        before are predicted from the first groups, as they are in the model with the new effect.
        """
        rest = np.einsum("vgij,g->vij", self.S, (~first).astype(float))
        log_det = self.log_det @ (~first)
        if self.grams.P == self.grams.base:
            x = self.grams.fit(rest, prior=(np.ones(self.grams.P), np.full(self.grams.P, 1e-9)))
            value = -0.5 * (energy(rest, x) + log_det)
        else:
            seen = np.einsum("vgij,g->vij", self.S, first.astype(float))
            value = log_marginal(self.grams, seen + rest) - log_marginal(self.grams, seen) - 0.5 * log_det
        return float(np.max(value - self.penalty))


def log_e_value(candidate: Grams, null: Null, parts: NDArray[np.bool_]) -> float:
    """Log e-value of a scan of shapes (m, G, ...), mean over the splits `parts` (splits, G).

    The prediction is a mixture over shapes and over a few amounts of scatter, so that an effect of the right kind and a
    slightly wrong form still counts against a null that may call everything scatter.
    """
    S, log_det = candidate.scatter.marginal(candidate.A, [(f, f) for f in _PREDICTED_WITH])
    first = parts.astype(float)
    whole = log_marginal(candidate, S.sum(axis=2)) - 0.5 * log_det.sum(axis=1)[:, None]
    seen = log_marginal(candidate, np.einsum("vmgij,sg->svmij", S, first)) - 0.5 * (first @ log_det.T)[:, :, None]
    ratio = np.asarray(logsumexp(whole)) - np.asarray(logsumexp(seen, axis=(1, 2)))
    rest = np.array([null.best(part) for part in parts])
    return float(logsumexp(ratio - rest) - np.log(len(parts)))


def leave_out(S: Array) -> Array:
    """Gram matrices of all groups but one: (..., G, P + 1, P + 1) from (..., G, P + 1, P + 1)."""
    return S.sum(axis=-3, keepdims=True) - S


@dataclass(frozen=True)
class LeftOut:
    """Whitened square residual of every left-out group, and the part of it that repeats share: (G,) each.

    Where no group has repeats, the shared part is the square residual less what the assumed noise gives.
    """

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
    shared = energy(X, x)[best, groups] if grams.repeated.any() else square - grams.n
    return LeftOut(square, shared)

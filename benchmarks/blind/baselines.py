"""What is usually done instead: greedy AIC and BIC, orthogonal matching pursuit with cross-validation, sequentially
thresholded least squares, a Gaussian process, a refit.

All work on pooled samples with the columns of :mod:`benchmarks.blind.dictionary`. STLSQ is the optimiser of SINDy
(Brunton, Proctor & Kutz, PNAS 113 (2016) 3932) applied to the residual of the calibrated model with the library's columns;
PySINDy itself is not used. The Gaussian process and the refit name nothing: they are here for the held-out error.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.blind.dictionary import Dictionary, Term, make_dictionary
from compare import Campaign

Array = NDArray[np.float64]
_MOST_TERMS = 5
_THRESHOLD = 0.1
_RIDGE = 0.05
_FOLDS = 5
_GP_POINTS = 500


def _fit(A: Array, y: Array) -> Array:
    return np.asarray(np.linalg.lstsq(A, y, rcond=None)[0], dtype=np.float64)


def _design(d: Dictionary, chosen: Sequence[Term]) -> Array:
    return np.hstack([d.base, *(t.columns for t in chosen)])


def _held_out(d: Dictionary, predicted: Array) -> dict[str, float | None]:
    """Excess over the noise of the validation records before and after, and its ratio."""
    rows = ~d.fitted
    if not rows.any():
        return {"before": None, "after": None, "ratio": None}
    base = d.base @ _fit(d.base[d.fitted], d.target[d.fitted])
    floor = d.noise or 1e-9
    before, after = (float(np.mean((d.target - p)[rows] ** 2)) for p in (base, predicted))
    excess = max(before - floor**2, 0.0)
    ratio = float(np.sqrt(max(after - floor**2, 0.0) / excess)) if excess > 0 else None
    return {"before": float(np.sqrt(before)) / floor, "after": float(np.sqrt(after)) / floor, "ratio": ratio}


def _answer(d: Dictionary, chosen: Sequence[Term]) -> dict[str, Any]:
    A = _design(d, chosen)
    predicted = A @ _fit(A[d.fitted], d.target[d.fitted])
    names = list(dict.fromkeys(t.effect for t in chosen))
    held_out = _held_out(d, predicted) if names else {"before": None, "after": None, "ratio": None}
    return {"verdict": "identified" if names else "none", "effects": names, "confusable": [], **held_out}


def _explained(Q: Array, residual: Array, columns: Array) -> float:
    """Sum of squares that columns would take away from the residual of a fit with orthonormal Q."""
    outside = columns - Q @ (Q.T @ columns)
    q, r = np.linalg.qr(outside)
    return float(np.sum((q.T @ residual) ** 2)) if np.abs(np.diag(r)).min() > 1e-9 else 0.0


def _orthonormal(A: Array) -> Array:
    U, s, _ = np.linalg.svd(A, full_matrices=False)
    return U[:, s > 1e-10 * s[0]]


def _pursuit(d: Dictionary, rows: NDArray[np.bool_], most: int) -> list[Term]:
    """Terms in the order in which they take most from the residual, each effect once."""
    y, chosen = d.target[rows], []
    for _ in range(most):
        Q = _orthonormal(_design(d, chosen)[rows])
        residual = y - Q @ (Q.T @ y)
        names = {t.effect for t in chosen}
        left = [t for t in d.terms if t.effect not in names]
        if not left:
            break
        chosen.append(max(left, key=lambda t: _explained(Q, residual, t.columns[rows])))
    return chosen


def _greedy(penalty: Callable[[int], float]) -> Callable[[Dictionary], dict[str, Any]]:
    """Forward selection by an information criterion n ln RSS + penalty x numbers, samples taken as independent."""

    def method(d: Dictionary) -> dict[str, Any]:
        rows, n = d.fitted, int(d.fitted.sum())
        chosen = _pursuit(d, rows, _MOST_TERMS)
        scores = []
        for k in range(len(chosen) + 1):
            A = _design(d, chosen[:k])[rows]
            rss = float(np.sum((d.target[rows] - A @ _fit(A, d.target[rows])) ** 2))
            numbers = d.base.shape[1] + sum(t.numbers for t in chosen[:k])
            scores.append(n * np.log(rss / n) + penalty(n) * numbers)
        stop = next((k for k in range(len(chosen)) if scores[k + 1] >= scores[k]), len(chosen))
        return _answer(d, chosen[:stop])

    return method


def _omp_cv(d: Dictionary) -> dict[str, Any]:
    """Matching pursuit whose number of terms has the smallest error on conditions left out, five folds."""
    groups = np.unique(d.group[d.fitted])
    folds = [groups[i::_FOLDS] for i in range(min(_FOLDS, len(groups)))]
    error = np.zeros(_MOST_TERMS + 1)
    for fold in folds:
        out = d.fitted & np.isin(d.group, fold)
        rows = d.fitted & ~out
        chosen = _pursuit(d, rows, _MOST_TERMS)
        for k in range(_MOST_TERMS + 1):
            A = _design(d, chosen[:k])
            error[k] += float(np.sum((d.target[out] - A[out] @ _fit(A[rows], d.target[rows])) ** 2))
    return _answer(d, _pursuit(d, d.fitted, int(np.argmin(error))))


def _stlsq(d: Dictionary) -> dict[str, Any]:
    """Sequentially thresholded ridge regression of the residual on one best column set per effect, all of unit size."""
    rows = d.fitted
    Q = _orthonormal(d.base[rows])
    residual = d.target[rows] - Q @ (Q.T @ d.target[rows])
    best: dict[str, tuple[float, Term]] = {}
    for term in d.terms:
        gain = _explained(Q, residual, term.columns[rows])
        if gain > best.get(term.effect, (-1.0, term))[0]:
            best[term.effect] = (gain, term)
    terms = [t for _, t in best.values()]
    if not terms:
        return _answer(d, [])
    owner = np.concatenate([np.full(t.columns.shape[1], i) for i, t in enumerate(terms)])
    A = np.hstack([t.columns[rows] for t in terms])
    A = A - Q @ (Q.T @ A)
    A = A / np.fmax(np.sqrt(np.mean(A**2, axis=0)), 1e-12)
    y = residual / np.sqrt(np.mean(residual**2))
    active = np.ones(A.shape[1], dtype=bool)
    for _ in range(20):
        B = A[:, active]
        w = np.zeros(A.shape[1])
        w[active] = np.linalg.solve(B.T @ B + _RIDGE * np.eye(B.shape[1]), B.T @ y)
        new = np.abs(w) >= _THRESHOLD
        if (new == active).all() or not new.any():
            active = new
            break
        active = new
    return _answer(d, [terms[i] for i in np.unique(owner[active])])


def _kernel(a: Array, b: Array) -> Array:
    return np.exp(-0.5 * np.sum((a[:, None] - b[None]) ** 2, axis=-1))


def _gaussian_process(d: Dictionary) -> dict[str, Any]:
    """A Gaussian process on the residual over path, direction and conditions; the scale of its signal is the residual's."""
    base = d.base @ _fit(d.base[d.fitted], d.target[d.fitted])
    residual = d.target - base
    known = np.flatnonzero(d.fitted)
    known = known[:: max(1, len(known) // _GP_POINTS)]
    size = max(float(np.var(residual[known])) - d.noise**2, 1e-3 * float(np.var(residual[known])))
    K = size * _kernel(d.features[known], d.features[known]) + (d.noise**2 + 1e-12) * np.eye(len(known))
    weights = np.linalg.solve(K, residual[known])
    new = np.flatnonzero(~d.fitted)
    predicted = base.copy()
    predicted[new] += size * _kernel(d.features[new], d.features[known]) @ weights
    return {"verdict": "none", "effects": [], "confusable": [], **_held_out(d, predicted)}


def _refit(d: Dictionary) -> dict[str, Any]:
    """The linear model, refitted with the validation records as well."""
    return {"verdict": "none", "effects": [], "confusable": [], **_held_out(d, d.base @ _fit(d.base, d.target))}


_ON_DICTIONARY: dict[str, Callable[[Dictionary], dict[str, Any]]] = {
    "greedy-aic": _greedy(lambda n: 2.0),
    "greedy-bic": _greedy(lambda n: float(np.log(n))),
    "omp-cv": _omp_cv,
    "stlsq": _stlsq,
    "gaussian-process": _gaussian_process,
    "refit": _refit,
}


def all_baselines(folder: Path) -> dict[str, dict[str, Any]]:
    """Every baseline on one campaign; the columns are made once."""
    d = make_dictionary(Campaign.read(folder))
    return {name: method(d) for name, method in _ON_DICTIONARY.items()}

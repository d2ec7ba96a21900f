r"""Two ways to mend a model without physics, to be held against an effect that was found: a patch, and a refit.

The patch is a Gaussian process on the residual r of the calibrated linear model, per kind and channel,

.. math::  r(x) \sim \mathcal{GP}(0, \sigma^2 e^{-|x - x'|^2 / 2 l^2}), \qquad r_i = r(x_i) + e_i,\;
           \operatorname{var} e = \delta\sigma^2

over standardised features x: path, direction of motion, rate, largest path so far, tension, temperature, length. l and delta
are those of the largest marginal likelihood on a grid, sigma^2 follows in closed form; one eigendecomposition per l serves
all delta. It predicts within the range of its data, names nothing, and falls back to zero outside. The refit is the linear
model calibrated anew on the very records that it is judged on. Source: Rasmussen & Williams, Gaussian Processes for Machine
Learning, MIT Press 2006, sections 2.2 and 5.4.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from compare.bench_path import LedPath, bench_paths
from compare.calibration import calibrate
from compare.comparison import ChannelFit, Comparison
from geometry.errors import ConvergenceError

Array = NDArray[np.float64]
log = logging.getLogger(__name__)
_POINTS = 240
_LENGTHS = np.geomspace(0.3, 8.0, 7)  # in standard deviations of the features
_NOISES = np.geomspace(1e-6, 1e3, 46)  # variance of the noise over that of the signal


@dataclass(frozen=True)
class GaussianProcess:
    """A Gaussian process with its support points X (n, k), standardised by `centre` and `spread`."""

    X: Array = field(repr=False)
    weights: Array = field(repr=False)
    centre: Array = field(repr=False)
    spread: Array = field(repr=False)
    length: float
    noise: float

    @classmethod
    def fit(cls, X: Array, y: Array) -> GaussianProcess:
        """Learn y (n,) at X (n, k); features that do not vary are left out.

        Examples
        --------
        >>> x = np.linspace(0, 6, 60)[:, None]
        >>> gp = GaussianProcess.fit(x, np.sin(x[:, 0]))
        >>> round(float(gp(np.array([[1.5]]))[0]), 3) == round(float(np.sin(1.5)), 3)
        True
        """
        centre, spread = X.mean(axis=0), X.std(axis=0)
        spread = np.where(spread > 1e-9 * np.fmax(np.abs(centre), 1e-300), spread, np.inf)
        X = (X - centre) / spread
        distance = _square_distance(X, X)
        best = (np.inf, 1.0, 1.0, np.zeros(len(y)))
        for length in _LENGTHS:
            values, vectors = eigh(np.exp(-0.5 * distance / length**2))
            z = vectors.T @ y
            spectrum = np.fmax(values, 0.0) + _NOISES[:, None]
            size = np.fmax(np.mean(z**2 / spectrum, axis=1), np.finfo(float).tiny)
            deviance = len(y) * np.log(size) + np.log(spectrum).sum(axis=1)
            k = int(np.argmin(deviance))
            if deviance[k] < best[0]:
                best = (float(deviance[k]), float(length), float(_NOISES[k]), vectors @ (z / spectrum[k]))
        return cls(X, best[3], centre, spread, best[1], best[2])

    def __call__(self, X: Array) -> Array:
        """Expected values (m,) at X (m, k)."""
        new = (X - self.centre) / self.spread
        return np.exp(-0.5 * _square_distance(new, self.X) / self.length**2) @ self.weights


def _square_distance(a: Array, b: Array) -> Array:
    square = np.sum(a**2, axis=1)[:, None] + np.sum(b**2, axis=1) - 2 * (a @ b.T)
    return np.fmax(square, 0.0)


def patch_error(comparison: Comparison, set_name: str) -> float | None:
    """What a Gaussian process, taught on the set *calibrate*, leaves of the residual of a set, over its noise floor.

    Parameters
    ----------
    comparison : Comparison
        Of the base model.
    set_name : str
        ``calibrate``, ``validate`` or, once opened, ``sealed``.

    Returns
    -------
    float or None
        Comparable with :meth:`compare.comparison.Comparison.relative_error`; None if the set is empty.
    """
    fits = [fit for fit in comparison.fits if fit.experiment.set == set_name]
    if not fits:
        return None
    known = [fit for fit in comparison.fits if fit.experiment.set == "calibrate"]
    experiments = list({f.experiment.id: f.experiment for f in (*fits, *known)}.values())
    paths = bench_paths(experiments, comparison.model.linear)
    left = []
    processes: dict[tuple[str, str], GaussianProcess | None] = {}
    for fit in fits:
        key = fit.experiment.kind, fit.channel
        if key not in processes:
            processes[key] = _taught([f for f in known if (f.experiment.kind, f.channel) == key], paths)
        process, residual = processes[key], fit.measured - fit.model
        if process is not None:
            residual = residual - process(_features(fit, paths[fit.experiment.id]))
        left.append(residual)
    return _relative(fits, left)


def refit_error(comparison: Comparison, set_name: str) -> float | None:
    """Relative error of the linear model if it is calibrated on that very set; None if the set is empty."""
    fits = [fit for fit in comparison.fits if fit.experiment.set == set_name]
    if not fits:
        return None
    experiments = list({f.experiment.id: f.experiment for f in fits}.values())
    try:
        model = calibrate(comparison.nominal.linear, experiments, comparison.noise).model
    except ConvergenceError as error:
        log.warning("the linear model could not be calibrated on the set %s: %s", set_name, error)
        return None
    predicted = {e.id: model.predict(e) for e in experiments}
    return _relative(fits, [f.measured - predicted[f.experiment.id][f.channel] for f in fits])


def _relative(fits: Sequence[ChannelFit], left: Sequence[Array]) -> float:
    """Rms of residuals, each over the noise floor of its record."""
    square = sum(float(r @ r) / fit.noise_floor**2 for fit, r in zip(fits, left, strict=True))
    return float(np.sqrt(square / sum(len(r) for r in left)))


def _taught(fits: Sequence[ChannelFit], paths: dict[str, LedPath]) -> GaussianProcess | None:
    if not fits:
        return None
    X = np.vstack([_features(fit, paths[fit.experiment.id]) for fit in fits])
    y = np.concatenate([fit.measured - fit.model for fit in fits])
    support = np.unique(np.linspace(0, len(y) - 1, min(_POINTS, len(y))).astype(int))
    return GaussianProcess.fit(X[support], y[support])


def _features(fit: ChannelFit, led: LedPath) -> Array:
    """(n, 7): path, direction, rate, largest path so far, tension, temperature, length; the mean, or 0, where unknown."""
    path, lead = led.path, led.lead
    strain = path.strain / path.largest
    motion = np.zeros(len(strain))
    if len(strain) > 1:
        motion = np.gradient(strain) if path.time is None else np.gradient(strain, path.time)
    rate = np.zeros(len(strain)) if path.time is None else motion
    grip = fit.experiment.conditions.get("axial tension", path.typical_tension)
    constant = (
        grip,
        path.typical_temperature if path.temperature is None else path.temperature,
        0.0 if path.length is None else path.length,
    )
    own = [strain, np.sign(motion), rate, np.maximum.accumulate(np.abs(strain))]
    return np.column_stack([*own, *(np.full(len(strain), v) for v in constant)])[lead:]

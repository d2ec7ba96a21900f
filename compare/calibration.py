r"""Calibration of the linear stiffness by generalised least squares, and its uncertainty.

.. math::  \hat\theta = \arg\min \sum_i r_i^T C_i^{-1} r_i , \qquad r_i = y_i - f_i(\theta)

over the experiments of the set *calibrate*; theta are stiffness ratios. C_i holds the signal through the scatter of
the gain: it is taken from the model at the previous theta, never from the data, which would pull the fit low
(Peelle's pertinent puzzle).

Two standard deviations: sqrt diag (sum J^T C^-1 J)^-1, which knows the noise only, and a bootstrap over whole
experiments, drawn within each kind, which also sees that experiments disagree. The larger one is reported. A bootstrap of
n experiments is too small by sqrt((n - 1)/n), and known no better than from n - 1 values: it is multiplied by the
inverse of the one and by Student's t_{n-1} over the normal quantile at 97.5 %, so that value +- 2 std holds 95 %. Source:
Efron & Tibshirani, An Introduction to the Bootstrap, 1993, ch. 6, 9 and 12; linearised resampling (one Gauss-Newton
step) is exact here where the path was prescribed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.special import ndtri, stdtrit

from compare.bench_model import UNITS, BenchModel, StiffnessParameter
from compare.experiment import Experiment
from compare.kinds import KINDS
from compare.noise_floor import NoiseModel
from geometry.errors import ConvergenceError

Array = NDArray[np.float64]
_SEED = 20230218
_RESAMPLES = 1000
_ROUNDS = 3
_STEP = 1e-5
_SMALLEST_RATIO = 1e-4
_SEEN_BY = {
    "EA": ("tension",),
    "GJ": ("torsion",),
    "EI": ("bending", "shear"),
    "GA": ("shear",),
    "EI and GA": ("shear",),
}


@dataclass(frozen=True)
class CalibratedValue:
    """A calibrated stiffness: value, standard deviation and nominal value in `unit`, and the ratio value / nominal."""

    name: str
    value: float
    std: float
    std_noise_only: float
    unit: str
    nominal: float

    @property
    def ratio(self) -> float:
        """Calibrated over nominal."""
        return self.value / self.nominal


@dataclass(frozen=True)
class ParameterValue:
    """A parameter of an effect as it was found; `expected` is what the cable's own geometry would give, if known."""

    value: float
    std: float
    unit: str
    meaning: str = ""
    plausible: tuple[float, float] | None = None
    expected: str = ""


@dataclass(frozen=True)
class Calibration:
    """The calibrated model, the values that were found, how many numbers were free, and sentences about it.

    `parameters` holds those of effects, by ``effect: parameter``.
    """

    model: BenchModel
    values: Mapping[str, CalibratedValue]
    free: int
    notes: tuple[str, ...]
    parameters: Mapping[str, ParameterValue] = field(default_factory=dict)


def calibrate(model: BenchModel, experiments: Sequence[Experiment], noise: NoiseModel) -> Calibration:
    """Fit the stiffnesses that the experiments see.

    Parameters
    ----------
    model : BenchModel
        With the nominal stiffness as the starting point.
    experiments : sequence of Experiment
        Open bench experiments, all of which are used.
    noise : NoiseModel
        Covariance of every channel.

    Raises
    ------
    ConvergenceError
        If the fit does not come to rest.
    """
    parameters = model.free_parameters(experiments)
    if not parameters:
        return Calibration(model, {}, 0, ())
    theta = _start(model, parameters, experiments)
    for _ in range(_ROUNDS):
        theta = _fit(model, parameters, experiments, noise, theta)
    fitted = _moved(model, parameters, theta)
    J, r = _whitened(model, parameters, experiments, noise, theta)
    by_noise, by_bootstrap = noise_std(J), bootstrap_std(J, r, [e.kind for e in experiments])
    std = np.fmax(by_noise, by_bootstrap)
    values, notes = {}, []
    for k, parameter in enumerate(parameters):
        for name in parameter.moves:
            nominal = model.stiffness(name)
            values[name] = CalibratedValue(
                name,
                float(theta[k] * nominal),
                float(std[k] * abs(nominal)),
                float(by_noise[k] * abs(nominal)),
                UNITS[name],
                nominal,
            )
        notes += _remarks(parameter, float(theta[k]), float(std[k]))
    return Calibration(fitted, values, len(parameters), tuple(notes))


def _moved(model: BenchModel, parameters: Sequence[StiffnessParameter], theta: Array) -> BenchModel:
    return model.with_ratios(
        {
            name: model.ratios.get(name, 1.0) * float(t)
            for p, t in zip(parameters, theta, strict=True)
            for name in p.moves
        }
    )


def _start(model: BenchModel, parameters: Sequence[StiffnessParameter], experiments: Sequence[Experiment]) -> Array:
    """Starting ratio of each stiffness: the slope of the measured load over the one at the nominal stiffness."""
    sums: dict[str, list[float]] = {}
    for experiment in experiments:
        kind, record = KINDS[experiment.kind], experiment.record
        inverse = record.prescribed == kind.load
        channel = next(c for c in record.measured if c in kind.paths) if inverse else kind.load
        f, y = model.predict(experiment)[channel], record[channel]
        size = float(np.mean(y**2)) or 1.0
        total = sums.setdefault(experiment.kind, [0.0, 0.0])
        total[0] += float(np.mean(f * f if inverse else f * y)) / size
        total[1] += float(np.mean(f * y if inverse else f * f)) / size
    start = []
    for parameter in parameters:
        above, below = next((sums[kind] for kind in _SEEN_BY.get(parameter.name, ()) if kind in sums), (1.0, 1.0))
        start.append(above / below if min(above, below) > 0 else 1.0)
    return np.array(start)


def _fit(
    model: BenchModel,
    parameters: Sequence[StiffnessParameter],
    experiments: Sequence[Experiment],
    noise: NoiseModel,
    theta: Array,
) -> Array:
    """One generalised least squares fit with the covariance held at `theta`."""
    signals = [_moved(model, parameters, theta).predict(e) for e in experiments]
    nonlinear = any(e.kind in ("shear", "towing") or e.record.prescribed == KINDS[e.kind].load for e in experiments)

    def residuals(t: Array) -> Array:
        predicted = [_moved(model, parameters, t).predict(e) for e in experiments]
        return np.concatenate(
            [
                noise.of(e, c).whiten(e.record[c] - f[c], m[c])
                for e, f, m in zip(experiments, predicted, signals, strict=True)
                for c in e.record.measured
            ]
        )

    lowest = _SMALLEST_RATIO if nonlinear else -np.inf
    run = any(e.kind == "towing" for e in experiments)  # whose numbers carry the rounding of a time integration
    tolerance = 1e-8 if run else 1e-12
    solution = least_squares(
        residuals,
        np.fmax(theta, 2 * lowest),
        bounds=(lowest, np.inf),
        x_scale=np.abs(theta) + 1e-9,
        xtol=tolerance,
        ftol=tolerance,
        gtol=tolerance,
        diff_step=1e-4 if run else None,
    )
    if not (solution.success and np.isfinite(solution.x).all()):
        names = ", ".join(p.name for p in parameters)
        raise ConvergenceError(
            f"calibration of {names} did not come to rest after {solution.nfev} evaluations: {solution.message}"
        )
    return np.asarray(solution.x)


def _whitened(
    model: BenchModel,
    parameters: Sequence[StiffnessParameter],
    experiments: Sequence[Experiment],
    noise: NoiseModel,
    theta: Array,
) -> tuple[list[Array], list[Array]]:
    """Whitened Jacobian (n_i, p) and residual (n_i,) of every experiment."""
    at = [_moved(model, parameters, theta + step).predict for step in _steps(theta)]
    here = _moved(model, parameters, theta).predict
    jacobians, residuals = [], []
    for experiment in experiments:
        m = here(experiment)
        ahead = [f(experiment) for f in at]
        J, r = [], []
        for channel in experiment.record.measured:
            covariance = noise.of(experiment, channel)
            slopes = [
                (f[channel] - m[channel]) / step[k]
                for k, (f, step) in enumerate(zip(ahead, _steps(theta), strict=True))
            ]
            J.append(covariance.whiten(np.column_stack(slopes), m[channel]))
            r.append(covariance.whiten(experiment.record[channel] - m[channel], m[channel]))
        jacobians.append(np.concatenate(J))
        residuals.append(np.concatenate(r))
    return jacobians, residuals


def _steps(theta: Array) -> Array:
    """One row per parameter with a small step of that parameter alone."""
    return np.diag(_STEP * np.fmax(np.abs(theta), 1e-3))


def noise_std(J: Sequence[Array]) -> Array:
    H = np.sum([j.T @ j for j in J], axis=0)
    seen = np.diag(H) > 0
    return np.where(seen, np.sqrt(np.diag(np.linalg.pinv(H, hermitian=True))), np.inf)


def bootstrap_std(J: Sequence[Array], r: Sequence[Array], kinds: Sequence[str]) -> Array:
    """Standard deviation over resampled experiments, drawn within each kind; one Gauss-Newton step per resample."""
    rng = np.random.default_rng(_SEED)
    H = np.array([j.T @ j for j in J])
    g = np.array([j.T @ w for j, w in zip(J, r, strict=True)])
    weights = np.zeros((_RESAMPLES, len(J)))
    for kind in dict.fromkeys(kinds):
        members = np.flatnonzero([k == kind for k in kinds])
        weights[:, members] = rng.multinomial(len(members), np.full(len(members), 1 / len(members)), size=_RESAMPLES)
    resampled = np.linalg.pinv(np.tensordot(weights, H, 1), hermitian=True)
    steps = np.einsum("bij,bj->bi", resampled, weights @ g)
    n = np.count_nonzero(np.diagonal(H, axis1=1, axis2=2) > 0, axis=0)  # experiments that see each parameter
    few = np.sqrt(n / np.fmax(n - 1, 1)) * stdtrit(np.fmax(n - 1, 1), 0.975) / ndtri(0.975)
    return np.std(steps, axis=0) * few


def _remarks(parameter: StiffnessParameter, ratio: float, std: float) -> list[str]:
    remarks = []
    if not np.isfinite(std):
        remarks.append(
            f"{parameter.name} is not determined: what was prescribed is zero throughout; it keeps its nominal value."
        )
    elif ratio <= 2 * _SMALLEST_RATIO:
        remarks.append(f"calibrated {parameter.name} is not positive: check the signs of path and load in the tables.")
    elif std > 0.5 * ratio:
        remarks.append(
            f"{parameter.name} is hardly determined by these experiments: its ratio to nominal "
            f"is {ratio:.3g} +- {std:.2g}."
        )
    if len(parameter.moves) > 1:
        remarks.append("cantilevers of a single length show one number: EI and GA were scaled together.")
    return remarks

r"""Inputs of an expensive model that bring its outputs to targets: a cheap model searches, the full one decides.

With targets y_i of relative standard errors e_i the misfit is that of logarithms, r_i = ln(f_i(x) / y_i) / e_i. The cheap model
c is corrected so that it meets the full one f where that was run,

.. math::  \ln \hat f(x) = \ln c(x) + \sum_k w_k(x)\,\bigl(\ln f(x_k) - \ln c(x_k)\bigr), \qquad
           w_k \propto 1 / |x - x_k|^2, \quad \sum_k w_k = 1

(distances over the ranges). The optimum of the corrected model is run in full, the correction takes it in, and the search
goes on until the two agree there within `agreement`: space mapping (Bandler et al., IEEE Trans. Microw. Theory Tech. 52
(2004) 337-361). What is reported is the best full run, never a value of the cheap model.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from compare.evaluation_store import EvaluationStore
from compare.identifiability import Identifiability, Profile, identifiability, profile
from compare.multi_start import Minimum, multi_start
from compare.target_file import InputParameter, Target
from geometry.errors import ConvergenceError, InputError

Array = NDArray[np.float64]
Model = Callable[[Mapping[str, float]], Mapping[str, float]]
Progress = Callable[[float, str], None]


_FAR = 100.0
"""Times the target: no output of the search counts as more."""


@dataclass(frozen=True)
class FullRun:
    """One run of the full model: inputs and outputs (SI) by name, misfit |r|^2 / 2, and what the cheap model had promised."""

    inputs: dict[str, float]
    outputs: dict[str, float]
    cost: float
    promised: dict[str, float]

    @property
    def disagreement(self) -> float:
        """Largest |ln| between the promise and the run."""
        return max(abs(math.log(self.outputs[k] / v)) for k, v in self.promised.items())


@dataclass(frozen=True)
class InputCalibration:
    """Result of a calibration.

    Attributes
    ----------
    targets, parameters : what was asked
    best : FullRun
        The full run of the least misfit.
    runs : tuple of FullRun
        All of them, in their order.
    minima : tuple of Minimum
        Of the corrected cheap model at the last search.
    identifiability : Identifiability
        At the best run, with the derivatives of the corrected cheap model.
    profile : Profile
        Along the sloppiest direction.
    agreed : bool
        Whether cheap and full model agreed at the end.
    """

    targets: tuple[Target, ...]
    parameters: tuple[InputParameter, ...]
    best: FullRun
    runs: tuple[FullRun, ...] = field(repr=False)
    minima: tuple[Minimum, ...] = field(repr=False)
    identifiability: Identifiability
    profile: Profile
    agreed: bool

    @property
    def ratios(self) -> dict[str, float]:
        """Computed over target."""
        return {t.name: self.best.outputs[t.name] / t.value for t in self.targets}


class _Corrected:
    """The cheap model with the corrections of the full runs, in the coordinates of the search."""

    def __init__(self, cheap: Model, targets: Sequence[Target], parameters: Sequence[InputParameter]) -> None:
        self.cheap, self.targets, self.parameters = cheap, targets, parameters
        self.low, self.high = np.array([p.bounds for p in parameters]).T
        self.places: list[Array] = []
        self.gaps: list[Array] = []

    def values(self, x: Array) -> dict[str, float]:
        return {p.name: p.value(float(v)) for p, v in zip(self.parameters, x, strict=True)}

    def logs(self, outputs: Mapping[str, float]) -> Array:
        bad = [t.name for t in self.targets if not outputs.get(t.name, 0.0) > 0 or not math.isfinite(outputs[t.name])]
        if bad:
            raise ConvergenceError(
                f"the model gives {outputs.get(bad[0])!r} for {bad[0]}, which has no logarithm: narrow the ranges of the parameters."
            )
        return np.log([outputs[t.name] for t in self.targets])

    def take(self, x: Array, outputs: Mapping[str, float]) -> None:
        """Meet the full model at x."""
        self.gaps.append(self.logs(outputs) - self.logs(self.cheap(self.values(x))))
        self.places.append(x)

    def correction(self, x: Array) -> Array:
        if not self.places:
            return np.zeros(len(self.targets))
        squared = (((np.array(self.places) - x) / (self.high - self.low)) ** 2).sum(axis=1) + 1e-12
        weight = 1 / squared
        return weight @ np.array(self.gaps) / weight.sum()

    def _far(self, outputs: Mapping[str, float]) -> dict[str, float]:
        """Outputs of the search: one without a logarithm (a modulus past infinity) counts as far above its target."""
        far = {t.name: _FAR * t.value for t in self.targets}
        return {k: far[k] if k in far and not 0 < v < far[k] else v for k, v in outputs.items()}

    def residual(self, x: Array) -> Array:
        wanted = np.log([t.value for t in self.targets])
        logs = self.logs(self._far(self.cheap(self.values(x)))) + self.correction(x)
        return (logs - wanted) / np.array([t.error for t in self.targets])

    def promise(self, x: Array) -> dict[str, float]:
        logs = self.logs(self.cheap(self.values(x))) + self.correction(x)
        return {t.name: math.exp(v) for t, v in zip(self.targets, logs, strict=True)}

    def jacobian(self, x: Array) -> Array:
        """Central differences, the correction held: between two full runs that stand close it has no meaning of its own."""
        J = np.zeros((len(self.targets), len(x)))
        for j in range(len(x)):
            step = 1e-3 * (self.high[j] - self.low[j])
            ends = [np.clip(x[j] + s * step, self.low[j], self.high[j]) for s in (-1, 1)]
            both = []
            for end in ends:
                y = x.copy()
                y[j] = end
                both.append(self.logs(self.cheap(self.values(y))))
            J[:, j] = (both[1] - both[0]) / (ends[1] - ends[0])
        return J / np.array([[t.error] for t in self.targets])


def calibrate_inputs(
    targets: Sequence[Target],
    parameters: Sequence[InputParameter],
    cheap: Model,
    full: Model,
    *,
    store: EvaluationStore | None = None,
    identity: Mapping[str, str] | None = None,
    most_runs: int = 6,
    agreement: float = 0.01,
    starts: int = 32,
    first: Array | None = None,
    seed: int = 0,
    progress: Progress | None = None,
) -> InputCalibration:
    """Find the inputs inside their ranges whose full run comes nearest to the targets.

    Parameters
    ----------
    targets, parameters : sequences
    cheap, full : callables
        From inputs by name (SI) to outputs by name (SI).
    store : EvaluationStore, optional
        Where finished full runs are kept and found again.
    identity : mapping of str to str, optional
        What else decides the outputs of the full model (cable, mesh), part of the hash of a run.
    most_runs, agreement : int, float
        Full runs at most; largest |ln| between cheap and full model at which they agree.
    starts, first, seed : of the search; one more place to start from, in its coordinates
    progress : callable, optional

    Raises
    ------
    InputError
        If a target is not an output of the model.
    ConvergenceError
        If an output has no logarithm.

    Examples
    --------
    >>> target = Target("E", 6.0, "Pa", 0.01, "tension", "made up")
    >>> side = InputParameter("a", ("a",), 1.0, 5.0, "m", "assumed", "made up")
    >>> found = calibrate_inputs([target], [side], lambda v: {"E": 2 * v["a"]}, lambda v: {"E": 3 * v["a"]})
    >>> round(found.best.inputs["a"], 3), found.agreed
    (2.0, True)
    """
    tell = progress or (lambda fraction, sentence: None)
    store = EvaluationStore() if store is None else store
    model = _Corrected(cheap, targets, parameters)
    missing = [t.name for t in targets if t.name not in cheap(model.values((model.low + model.high) / 2))]
    if missing:
        raise InputError(f"the model has no output {missing[0]}; take it out of the targets.")
    runs: list[FullRun] = []
    minima: list[Minimum] = []
    x = (model.low + model.high) / 2 if first is None else first
    for k in range(most_runs):
        tell(k / most_runs, f"search {k + 1}, {starts} starts")
        minima = multi_start(model.residual, model.low, model.high, count=starts, first=x, seed=seed)
        x = minima[0].x
        promised = model.promise(x)
        tell(
            (k + 0.3) / most_runs,
            f"full run {k + 1} of at most {most_runs}, least misfit of the search {minima[0].cost:.3g}",
        )
        run = _run(model, full, store, dict(identity or {}), x, promised)
        runs.append(run)
        model.take(x, run.outputs)
        if run.disagreement <= agreement:
            break
    best = min(runs, key=lambda r: r.cost)
    x = model.places[runs.index(best)]
    tell(0.95, "what the targets fix")
    known = identifiability(
        model.jacobian(x), x, model.low, model.high, [p.name for p in parameters], [p.logarithmic for p in parameters]
    )
    along = profile(model.residual, x, model.low, model.high, known.directions[-1])
    tell(1.0, f"{len(runs)} full runs, {store.found_again} of them found again")
    return InputCalibration(
        tuple(targets),
        tuple(parameters),
        best,
        tuple(runs),
        tuple(minima),
        known,
        along,
        runs[-1].disagreement <= agreement,
    )


def _run(
    model: _Corrected,
    full: Model,
    store: EvaluationStore,
    identity: Mapping[str, str],
    x: Array,
    promised: dict[str, float],
) -> FullRun:
    inputs = model.values(x)
    key = {**identity, **{k: float(f"{v:.9g}") for k, v in inputs.items()}}
    outputs = store.get(key)
    if outputs is None:
        outputs = {k: float(v) for k, v in full(inputs).items()}
        store.put(key, outputs)
    errors = np.array([t.error for t in model.targets])
    residual = (model.logs(outputs) - np.log([t.value for t in model.targets])) / errors
    return FullRun(inputs, outputs, 0.5 * float(residual @ residual), promised)

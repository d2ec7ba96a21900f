r"""Inputs of an expensive model that bring its outputs to targets: a cheap model searches, the full one decides.

With targets y_i of relative standard errors e_i the misfit is that of logarithms, r_i = ln(f_i(x) / y_i) / e_i. The cheap model
c is corrected so that it meets the full one f where that was run,

.. math::  \ln \hat f(x) = \ln c(x) + \sum_k w_k(x)\,\bigl(\ln f(x_k) - \ln c(x_k)\bigr), \qquad
           w_k \propto 1 / |x - x_k|^2, \quad \sum_k w_k = 1

(distances over the ranges): space mapping (Bandler et al., IEEE Trans. Microw. Theory Tech. 52 (2004) 337-361). Three loops:

1. a cheap model that can be refined is refined at its optimum, and searched again, until its refinement there changes nothing;
2. the full model is run at that optimum, and the correction takes it in, until the promise holds within `agreement`;
3. the cheap model is refined by a step along every input, so that its derivatives hold there, and 1 and 2 are gone through once more.

What is reported is the best full run, never a value of the cheap model. An output past infinity (1/G through zero) goes on as a
straight line in 1/f, so that a search can come back from there.
"""

from __future__ import annotations

import logging
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

log = logging.getLogger(__name__)

Array = NDArray[np.float64]
Model = Callable[[Mapping[str, float]], Mapping[str, float]]
Progress = Callable[[float, str], None]
Refine = Callable[[Mapping[str, float]], None]

_FAR = 5.0
"""Times the target: above it the logarithm goes on as a straight line in the inverse of the output."""
_KEPT = 4
"""Minima that later searches start from."""
_MOST_REFINED = 8
"""Refinements of the cheap model before a full run."""
_STEP = 0.05
"""Of a range: step along which the cheap model is refined for its derivatives."""


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
        self.met: list[Array] = []
        self._gaps: Array | None = None

    def values(self, x: Array) -> dict[str, float]:
        return {p.name: p.value(float(v)) for p, v in zip(self.parameters, x, strict=True)}

    def logs(self, outputs: Mapping[str, float]) -> Array:
        bad = [t.name for t in self.targets if not outputs.get(t.name, 0.0) > 0 or not math.isfinite(outputs[t.name])]
        if bad:
            raise ConvergenceError(
                f"the model gives {outputs.get(bad[0])!r} for {bad[0]}, which has no logarithm: narrow the ranges of the parameters."
            )
        return np.log([outputs[t.name] for t in self.targets])

    def cheap_logs(self, x: Array) -> Array:
        """Logarithms of the cheap model, past infinity a straight line in the inverse."""
        outputs = self.cheap(self.values(x))
        wanted = np.array([t.value for t in self.targets])
        with np.errstate(divide="ignore"):
            inverse = wanted / np.array([outputs[t.name] for t in self.targets])
        near = 1 / _FAR
        line = -np.log(near) - (inverse - near) / near
        return np.log(wanted) + np.where(inverse > near, -np.log(np.maximum(inverse, near)), line)

    def take(self, x: Array, outputs: Mapping[str, float]) -> None:
        """Meet the full model at x."""
        self.met.append(self.logs(outputs))
        self.places.append(x)
        self.forget()

    def forget(self) -> None:
        """The cheap model is another one now."""
        self._gaps = None

    def correction(self, x: Array) -> Array:
        if not self.places:
            return np.zeros(len(self.targets))
        if self._gaps is None:
            self._gaps = np.array([f - self.cheap_logs(y) for f, y in zip(self.met, self.places, strict=True)])
        squared = (((np.array(self.places) - x) / (self.high - self.low)) ** 2).sum(axis=1) + 1e-12
        weight = 1 / squared
        return weight @ self._gaps / weight.sum()

    def corrected(self, x: Array) -> Array:
        return self.cheap_logs(x) + self.correction(x)

    def residual(self, x: Array) -> Array:
        wanted = np.log([t.value for t in self.targets])
        return (self.corrected(x) - wanted) / np.array([t.error for t in self.targets])

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
                both.append(self.cheap_logs(y))
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
    refine: Refine | None = None,
    recentre: Refine | None = None,
    most_runs: int = 8,
    agreement: float = 0.005,
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
    refine : callable, optional
        Makes the cheap model exact at inputs, and better near them.
    recentre : callable, optional
        Moves there what the cheap model knows about one place only.
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
    x = (model.low + model.high) / 2 if first is None else first
    search = _Search(model, refine, starts, seed, agreement)
    centre: Array | None = None
    for k in range(most_runs):
        x = search.optimum(x, lambda sentence, k=k: tell(k / most_runs, sentence))
        promised = model.promise(x)
        least = search.minima[0].cost
        tell((k + 0.7) / most_runs, f"full run {k + 1} of at most {most_runs}, least misfit of the search {least:.3g}")
        run = _run(model, full, store, dict(identity or {}), x, promised)
        runs.append(run)
        model.take(x, run.outputs)
        if run.disagreement <= agreement:
            if centre is not None or (refine is None and recentre is None):
                break
            tell((k + 0.9) / most_runs, "a step along every input")
            _around(model, x, refine, recentre)
            centre = x
    best = min(runs, key=lambda r: r.cost)
    x = model.places[runs.index(best)]
    tell(0.95, "what the targets fix")
    if centre is None or np.abs((x - centre) / (model.high - model.low)).max() > _STEP:
        _around(model, x, refine, recentre)
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
        tuple(search.minima),
        known,
        along,
        runs[-1].disagreement <= agreement,
    )


class _Search:
    """Optima of the corrected model, which is refined at each until that changes nothing."""

    def __init__(self, model: _Corrected, refine: Refine | None, starts: int, seed: int, agreement: float) -> None:
        self.model, self.refine, self.starts, self.seed, self.agreement = model, refine, starts, seed, agreement
        self.minima: list[Minimum] = []

    def optimum(self, first: Array, say: Callable[[str], None]) -> Array:
        """The best of a search from all starts, or later from the best minima so far and `first`."""
        model = self.model
        for step in range(_MOST_REFINED + 1):
            count = 0 if self.minima else self.starts
            say(f"search from {count} starts" if count else "search from the minima so far")
            places = np.array([*(m.x for m in self.minima[:_KEPT]), first])
            self.minima = multi_start(model.residual, model.low, model.high, count=count, first=places, seed=self.seed)
            x = self.minima[0].x
            if self.refine is None or step == _MOST_REFINED:
                break
            before = model.corrected(x)
            say(f"the cheap model is refined, least misfit {self.minima[0].cost:.3g}")
            self.refine(model.values(x))
            model.forget()
            change = float(np.abs(model.corrected(x) - before).max())
            log.info("refined at misfit %.4g, changes %.2g", self.minima[0].cost, change)
            if change <= self.agreement:
                break
        return self.minima[0].x


def _around(model: _Corrected, x: Array, refine: Refine | None, recentre: Refine | None) -> None:
    """Refine the cheap model at a place and by a step along every input from there, inwards at a bound."""
    if recentre is not None:
        recentre(model.values(x))
    if refine is not None:
        span = model.high - model.low
        for j in range(len(x)):
            y = x.copy()
            y[j] += _STEP * span[j] * (1 if model.high[j] - x[j] > x[j] - model.low[j] else -1)
            refine(model.values(y))
    model.forget()


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

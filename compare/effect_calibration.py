r"""Calibration of a model with effects: stiffness, strengths and shapes together, and how well each is known.

Two standard deviations as for the stiffness alone (:mod:`compare.calibration`): from the noise, sqrt diag (sum J^T J)^-1 of
the white Jacobian, and from a bootstrap over whole groups of repeats, which also sees that experiments disagree; the larger
one is reported. Strengths that a bound holds at zero have no standard deviation of their own and are left out of J.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from compare.bench_design import Block, make_blocks
from compare.bench_model import BenchModel
from compare.calibration import CalibratedValue, Calibration, ParameterValue, bootstrap_std, calibrate, noise_std
from compare.experiment import Experiment
from compare.noise_floor import NoiseModel
from compare.search import Attempt, Stage, polished
from effects.effect import ActiveEffect, Derived, Effect
from effects.library import find
from geometry.errors import InputError

Array = NDArray[np.float64]
_STEP = 1e-3
LOAD_UNITS = {"tension": "N", "torsion": "N m", "bending": "N m", "shear": "N"}


def calibrate_model(model: BenchModel, experiments: Sequence[Experiment], noise: NoiseModel) -> Calibration:
    """Fit whatever is free in a model: its stiffness, and the parameters of the effects that are switched on.

    Raises
    ------
    InputError
        If an effect cannot act in these experiments.
    ConvergenceError
        If the fit of the stiffness does not come to rest.
    """
    linear = calibrate(model.linear, experiments, noise)
    if not model.added and not model.effects:
        return linear
    if not experiments:
        raise InputError("no open bench experiment is in the set calibrate: no effect can be calibrated.")
    blocks = make_blocks(experiments, linear.model, noise)
    if model.effects:
        terms = [[replace(e, strength=()) for e in model.effects if e.kind == block.kind] for block in blocks]
        stage = Stage(blocks, polished(blocks, terms, alone=True), ())
    else:
        stage = switched_on(blocks, [find(name) for name in model.added])
    return calibration_of(stage, linear, model)


def switched_on(blocks: Sequence[Block], wanted: Sequence[Effect]) -> Stage:
    """The stage with effects added by hand, each in the form that predicts left-out experiments best."""
    stage = Stage(blocks, ((),) * len(blocks), tuple(wanted))
    for effect in wanted:
        attempts = stage.rich([effect.name])
        if not attempts:
            kinds = ", ".join(block.kind for block in blocks)
            raise InputError(f"{effect.name} cannot act in these experiments ({kinds}): it needs {effect.needs}.")
        stage = stage.with_attempt(attempts[0])
    return stage


@dataclass(frozen=True)
class _Spread:
    """Standard deviations of one block: of coefficients (P,) and of the shapes of every term."""

    coefficient: Array
    noise_only: Array
    shape: dict[tuple[int, int], float]
    begin: tuple[int, ...]
    covariance: Array
    """Of coefficients, then shapes in the order of `shape`, (P + s, P + s)."""


def calibration_of(stage: Stage, linear: Calibration, model: BenchModel) -> Calibration:
    """The calibrated model of a stage with its values, about the calibrated linear model."""
    values, parameters, free = dict(linear.values), {}, 0
    ratios = dict(linear.model.ratios)
    active: list[ActiveEffect] = []
    several = len(stage.blocks) > 1
    for block, terms, x in zip(stage.blocks, stage.accepted, stage.x, strict=True):
        spread = _spread(block, terms, x)
        free += len(x) + len(spread.shape)
        for k, name in enumerate(block.base):
            for own in name.split(" and "):
                ratios[own] = ratios.get(own, 1.0) * float(x[k])
                values[own] = _value(linear.values[own], x[k], spread.coefficient[k], spread.noise_only[k])
        scale = _scale(block, x)
        at = len(block.base)
        for i, term in enumerate(terms):
            k = len(term.form.strength)
            factor = 1.0 if term.form.stage == "bias" else scale
            own_x, own_std = x[at : at + k] / factor, spread.coefficient[at : at + k] / factor
            at += k
            reference = block.paths[0]
            if block.kind == "tension":
                reference = replace(reference, typical_tension=reference.typical_tension * scale)
            active.append(replace(term, strength=tuple(float(v) for v in own_x), reference=reference))
            parameters.update(_named(block, i, term, own_x, own_std, spread, several, scale * _stiffness(block)))
    fitted = replace(model.linear, ratios=ratios, added=model.added or stage.names, effects=tuple(active))
    return replace(linear, model=fitted, values=values, free=free, parameters=parameters)


def _scale(block: Block, x: Array) -> float:
    """New over old stiffness of the load channel, mean over the readings of a cantilever of several lengths."""
    weights = [r.weights for record in block.records for r in record.readings if r.role == "load"]
    return float(np.mean([w @ x[: len(w)] for w in weights])) if weights else 1.0


def _value(linear: CalibratedValue, ratio: float, std: float, noise_only: float) -> CalibratedValue:
    size = abs(linear.value)
    return replace(
        linear, value=linear.value * float(ratio), std=float(std) * size, std_noise_only=float(noise_only) * size
    )


def _spread(block: Block, terms: Sequence[ActiveEffect], x: Array) -> _Spread:
    """Standard deviations from the white Jacobian of every group."""
    columns = [record.whitened(terms) for record in block.records]
    residual = [record.target - Z @ x for record, Z in zip(block.records, columns, strict=True)]
    shapes = [(i, k) for i, t in enumerate(terms) for k in range(len(t.shape))]
    slopes = [_slopes(block, terms, x, columns, i, k) for i, k in shapes]
    held = np.array([not np.any([Z[:, j].any() for Z in columns]) for j in range(len(x))], dtype=bool)
    held |= (x == 0) & (np.arange(len(x)) >= len(block.base))
    free = np.flatnonzero(~held)
    J, r = [], []
    for members in block.groups:
        J.append(np.vstack([np.column_stack([columns[m][:, free], *[s[m] for s in slopes]]) for m in members]))
        r.append(np.concatenate([residual[m] for m in members]))
    by_noise = noise_std(J)
    both = np.fmax(by_noise, bootstrap_std(J, r, [block.kind] * len(J)))
    coefficient, noise_only = np.zeros(len(x)), np.zeros(len(x))
    coefficient[free], noise_only[free] = both[: len(free)], by_noise[: len(free)]
    known = [*free, *range(len(x), len(x) + len(shapes))]
    covariance = np.zeros((len(x) + len(shapes),) * 2)
    inverse = np.linalg.pinv(np.sum([j.T @ j for j in J], axis=0), hermitian=True)
    sure = np.isfinite(both) & (by_noise > 0)
    wider = np.divide(both, by_noise, out=np.ones(len(both)), where=sure)
    covariance[np.ix_(known, known)] = inverse * np.outer(wider, wider)
    of_shape = {key: float(v) for key, v in zip(shapes, both[len(free) :], strict=True)}
    begin = len(block.base) + np.cumsum([0, *[len(t.form.strength) for t in terms]])
    return _Spread(coefficient, noise_only, of_shape, tuple(int(b) for b in begin), covariance)


def _slopes(
    block: Block, terms: Sequence[ActiveEffect], x: Array, columns: Sequence[Array], i: int, k: int
) -> list[Array]:
    """Derivative of the white reading by one shape, per record."""
    value, parameter = terms[i].shape[k], terms[i].form.shape[k]
    step = _STEP * max(abs(value), 1e-12)
    step = -step if value + step > parameter.high else step
    shape = (*terms[i].shape[:k], value + step, *terms[i].shape[k + 1 :])
    moved = [replace(t, shape=shape) if j == i else t for j, t in enumerate(terms)]
    return [(record.whitened(moved) - Z) @ x / step for record, Z in zip(block.records, columns, strict=True)]


def _named(
    block: Block, i: int, term: ActiveEffect, x: Array, std: Array, spread: _Spread, several: bool, stiffness: float
) -> dict[str, ParameterValue]:
    """Parameters of a term by readable name; the kind and the channel are added where they are needed."""
    where = [w for w in (block.kind if several else "", term.channel or "") if w]
    tail = f" ({', '.join(where)})" if where else ""
    channel_unit = next((r.experiment.record.channels[term.channel].unit for r in block.records
                         if term.channel in r.experiment.record.channels), "1") if term.channel else "1"  # fmt: skip
    found = {
        f"{term.effect.name}: {name}{tail}": value
        for name, value in _derived(block, i, term, x, spread, stiffness).items()
    }
    for k, parameter in enumerate(term.form.shape):
        unit = parameter.unit_for(block.kind).replace("channel", channel_unit)
        found[f"{term.effect.name}: {parameter.name}{tail}"] = ParameterValue(
            float(term.shape[k]), spread.shape[i, k], unit, parameter.meaning, parameter.plausible
        )
    for k, parameter in enumerate(term.form.strength):
        if x[k] == 0 and len(x) > 1:
            continue  # an element of a distribution that is not there
        unit = parameter.unit_for(block.kind).replace("channel", channel_unit)
        found[f"{term.effect.name}: {parameter.name}{tail}"] = ParameterValue(
            float(x[k]), float(std[k]), unit, parameter.meaning, parameter.plausible
        )
    return found


def _stiffness(block: Block) -> float:
    """Stiffness of the load channel about which the columns were taken, mean over the records."""
    return float(
        np.mean([r.stiffness for record in block.records for r in record.readings if r.role == "load"] or [1.0])
    )


def _derived(
    block: Block, i: int, term: ActiveEffect, x: Array, spread: _Spread, stiffness: float
) -> dict[str, ParameterValue]:
    """What the parameters of a term amount to, with the standard deviation carried over to first order."""
    found = {}
    at = spread.begin[i]
    shapes = [n for n, key in enumerate(spread.shape) if key[0] == i]
    index = [*range(at, at + len(x)), *(len(spread.coefficient) + n for n in shapes)]
    covariance = spread.covariance[np.ix_(index, index)]
    for derived in term.form.derived:
        here = np.array([*x, *term.shape])

        def value(v: Array, derived: Derived = derived) -> float:
            return derived.value(tuple(v[len(x) :]), v[: len(x)], block.paths[0])

        steps = 1e-5 * np.maximum(np.abs(here), 1e-6)
        slope = np.array([(value(here + np.eye(len(here))[k] * h) - value(here)) / h for k, h in enumerate(steps)])
        factor = stiffness if derived.unit == "load" else 1.0
        unit = LOAD_UNITS.get(block.kind, "N") if derived.unit == "load" else derived.unit
        std = float(np.sqrt(max(slope @ covariance @ slope, 0.0)))
        found[derived.name] = ParameterValue(factor * value(here), factor * std, unit, derived.meaning)
    return found


def parameters_of(attempt: Attempt, stage: Stage) -> dict[str, ParameterValue]:
    """Parameters of an effect that was only tried, beside the accepted terms of a stage."""
    found: dict[str, ParameterValue] = {}
    several = len(stage.blocks) > 1
    for trial in attempt.trials:
        block = stage.blocks[trial.site.block]
        terms = (*stage.accepted[trial.site.block], trial.fit.term)
        spread = _spread(block, terms, trial.fit.x)
        k = len(trial.fit.term.form.strength)
        factor = 1.0 if trial.fit.term.form.stage == "bias" else _scale(block, trial.fit.x)
        std = spread.coefficient[len(trial.fit.x) - k :] / factor
        stiffness = factor * _stiffness(block)
        named = _named(
            block, len(terms) - 1, trial.fit.term, trial.fit.strength / factor, std, spread, several, stiffness
        )
        found.update({name.split(": ", 1)[1]: value for name, value in named.items()})
    return found

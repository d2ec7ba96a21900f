"""One form of one effect fitted to one kind of experiment: a grid of shapes, then the best shape to the last digit.

Strengths and stiffnesses follow from the Gram matrices for every shape (variable projection, Golub & Pereyra, SIAM J.
Numer. Anal. 10 (1973) 413), so that the search runs over the shapes alone, of which a form has none to three.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize, minimize_scalar

from compare.bench_design import Block
from compare.gram import Grams, Scan, Shape, energy, total_cost
from effects.effect import ActiveEffect, Effect, Form

Array = NDArray[np.float64]
_LARGEST_GRID = 90
_ON_A_LINE = 6
_AROUND = (-4.0, -2.0, -1.0, -0.5, 0.5, 1.0, 2.0, 4.0)  # standard errors
_SEARCHES, _CLOSER = 3, 0.15  # of the last width to either side
_MATTERS = 1.0  # twice the log likelihood


@dataclass(frozen=True)
class Site:
    """Where an effect may act: a kind of experiment, and for sensors one channel of it."""

    effect: Effect
    block: int
    kind: str
    channel: str | None = None

    def term(self, form: Form, shape: tuple[float, ...] = ()) -> ActiveEffect:
        """The effect at this place in that form, without strengths."""
        return ActiveEffect(self.effect, form, self.kind, self.channel, shape)


@dataclass(frozen=True)
class FormFit:
    """A form at its best shape: the term, its Gram matrices, all coefficients (P,) and the left square residual.

    `at_edge` names the shapes that would rather leave the range in which they are searched; `near` holds the Gram matrices
    of the shapes around the best one.
    """

    term: ActiveEffect
    grams: Grams = field(repr=False)
    x: Array
    square: float
    at_edge: tuple[str, ...] = ()
    near: Grams | None = field(default=None, repr=False)

    @property
    def strength(self) -> Array:
        """The coefficients of this term."""
        k = len(self.term.form.strength)
        return self.x[len(self.x) - k :]

    @property
    def active(self) -> ActiveEffect:
        """The term with its strengths, ready for a model."""
        return replace(self.term, strength=tuple(float(v) for v in self.strength))


def shape_grid(form: Form, block: Block) -> list[tuple[float, ...]]:
    """Shapes from which the search begins: every combination of the starts of the parameters, thinned to a limit."""
    axes = []
    for parameter in form.shape:
        values = parameter.starts(block.paths) if parameter.starts else np.array([1.0])
        axes.append(np.unique(np.clip(values, parameter.low, parameter.high)))
    while np.prod([len(a) for a in axes], initial=1.0) > _LARGEST_GRID:
        longest = max(range(len(axes)), key=lambda i: len(axes[i]))
        axes[longest] = axes[longest][::2] if len(axes[longest]) > 3 else axes[longest][:1]
    return [tuple(float(v) for v in shape) for shape in itertools.product(*axes)]


def fitted(grams: Grams, term: ActiveEffect) -> FormFit:
    """The fit at the shape of `term`, whose Gram matrices (G, ...) are given."""
    S = grams.S.sum(axis=0)
    x = grams.fit(S)
    return FormFit(term, grams, x, float(energy(S, x)))


def refine(scan: Scan, term: ActiveEffect, grid: Grams, shapes: Sequence[tuple[float, ...]]) -> FormFit:
    """The best shape of the grid, moved to the nearest minimum of the cost, with the fit there."""
    return searched(scan, best_shape(scan, term, grid, shapes), shapes)


def best_shape(scan: Scan, term: ActiveEffect, grid: Grams, shapes: Sequence[tuple[float, ...]]) -> ActiveEffect:
    """The term at the best shape of the grid, moved to the nearest minimum of the cost."""
    costs = np.atleast_1d(total_cost(grid))
    best = int(np.argmin(costs))
    here = replace(term, shape=shapes[best])
    if not term.form.shape:
        return here
    limits = _limits(term.form, shapes)
    around = _neighbours(shapes, best, limits)
    search = _search_and_correct if scan.dear else _search
    return search(scan, here, costs[best], around, limits)


def _search_and_correct(
    scan: Scan,
    here: ActiveEffect,
    cost: float,
    around: Sequence[tuple[float, float]],
    limits: Sequence[tuple[float, float]],
) -> ActiveEffect:
    """The search with columns that are corrected at its beginning; again from its end, closer by, until that is as foreseen."""
    for _ in range(_SEARCHES):
        found = _search(scan, here, cost, around, limits)
        if found.shape == here.shape:
            break
        foreseen, exact = _cost(scan, found, here.shape), _cost(scan, found)
        if exact < cost:
            here, cost = found, exact
        if abs(exact - foreseen) < _MATTERS:
            break
        around = [
            (max(low, v - _CLOSER * (b - a)), min(high, v + _CLOSER * (b - a)))
            for v, (a, b), (low, high) in zip(here.shape, around, limits, strict=True)
        ]
    return here


def _cost(scan: Scan, term: ActiveEffect, near: Shape | None = None) -> float:
    return float(total_cost(scan.of_matrix(term, scan.cost_matrix(term, near=near))))


def searched(scan: Scan, here: ActiveEffect, shapes: Sequence[tuple[float, ...]]) -> FormFit:
    """The fit at the best shape, which a search over the grid `shapes` has found, with the shapes around it."""
    if not here.form.shape:
        return fitted(scan.candidate(here), here)
    limits = _limits(here.form, shapes)
    fit = fitted(scan.candidate(here), here)
    return replace(fit, near=_near(scan, fit, limits), at_edge=_at_edge(scan, here, limits))


def _near(scan: Scan, fit: FormFit, limits: Sequence[tuple[float, float]]) -> Grams:
    """Gram matrices at the best shape and around it, from half to four standard errors to either side of every shape.

    Folds that leave data out choose among them, so that a shape is fitted again as a strength is.
    """
    here = float(total_cost(fit.grams))
    found = [fit.grams]
    for k, (low, high) in enumerate(limits):
        value = fit.term.shape[k]

        def moved(to: float, k: int = k, low: float = low, high: float = high) -> ActiveEffect:
            shape = fit.term.shape
            return replace(fit.term, shape=(*shape[:k], float(np.clip(to, low, high)), *shape[k + 1 :]))

        def cost(to: float) -> float:
            return _cost(scan, moved(to), fit.term.shape)

        step = 0.02 * (abs(value) if value != 0 else high - low)
        rise = max(cost(value + step), cost(value - step)) - here
        error = step / np.sqrt(max(rise, 1e-6)) if rise > 0 else step
        error = float(np.clip(error, 1e-6 * max(abs(value), 1e-300), 0.5 * max(abs(value), high - low)))
        found += [scan.candidate(moved(value + m * error), fit.term.shape) for m in _AROUND]
    return replace(fit.grams, S=np.stack([g.S for g in found]), X=np.stack([g.X for g in found]))


def _limits(form: Form, shapes: Sequence[tuple[float, ...]]) -> list[tuple[float, float]]:
    """Range of every shape: the starts and half a step of a factor of two beyond, inside the physical bounds."""
    limits = []
    for k, parameter in enumerate(form.shape):
        values = [s[k] for s in shapes]
        low, high = min(values), max(values)
        limits.append(
            (max(parameter.low, low / 2 if low > 0 else low), min(parameter.high, 2 * high if high > 0 else high))
        )
    return limits


def _at_edge(scan: Scan, term: ActiveEffect, limits: Sequence[tuple[float, float]]) -> tuple[str, ...]:
    """Shapes at an end of their range that matter: a step inwards costs more than half a nat."""

    def cost(shape: tuple[float, ...]) -> float:
        return _cost(scan, replace(term, shape=shape), term.shape)

    found = []
    for k, (low, high) in enumerate(limits):
        value, width = term.shape[k], high - low
        near = 0.02 * (width if low <= 0 else min(width, value))
        if width <= 0 or min(value - low, high - value) > near:
            continue
        inside = value + (0.2 if value - low <= near else -0.2) * (width if low <= 0 else min(width, value))
        moved = (*term.shape[:k], float(np.clip(inside, low, high)), *term.shape[k + 1 :])
        if cost(moved) - cost(term.shape) > _MATTERS:
            found.append(term.form.shape[k].name)
    return tuple(found)


def _neighbours(
    shapes: Sequence[tuple[float, ...]], best: int, limits: Sequence[tuple[float, float]]
) -> list[tuple[float, float]]:
    """For every shape parameter the next lower and higher value on the grid, or the limit at an end of it."""
    around = []
    for k, value in enumerate(shapes[best]):
        axis = [limits[k][0], *sorted({s[k] for s in shapes}), limits[k][1]]
        i = axis.index(value, 1)
        around.append((axis[i - 1], axis[i + 1]))
    return around


def _search(
    scan: Scan,
    term: ActiveEffect,
    cost: float,
    around: Sequence[tuple[float, float]],
    limits: Sequence[tuple[float, float]],
) -> ActiveEffect:
    parameters = term.form.shape
    logs = [value > 0 and low > 0 for value, (low, _) in zip(term.shape, around, strict=True)]

    def shape_of(u: Array) -> tuple[float, ...]:
        values = [float(np.exp(v)) if log else float(v) for v, log in zip(u, logs, strict=True)]
        return tuple(float(np.clip(v, low, high)) for v, (low, high) in zip(values, limits, strict=True))

    def cost_of(u: Array) -> float:
        return _cost(scan, replace(term, shape=shape_of(u)), term.shape)

    start = np.array([np.log(v) if log else v for v, log in zip(term.shape, logs, strict=True)])
    ends = np.array(
        [[np.log(v) if log else v for v in pair] for pair, log in zip(around, logs, strict=True)], dtype=float
    )
    start, best = _along_each(cost_of, start, ends, cost)
    if len(parameters) == 1:
        low, high = ends[0]
        if high <= low:
            return term
        u, value = _bounded(cost_of, low, high)
        if value >= cost:  # a kink in the way: the minimum that the grid has found lies close to it
            near = 0.1 * (high - low)
            u, value = _bounded(cost_of, max(low, start[0] - near), min(high, start[0] + near))
    else:
        step = np.maximum((ends[:, 1] - ends[:, 0]) / 4, 1e-3)
        simplex = np.vstack([start, start + np.diag(np.where(start + step > ends[:, 1], -step, step))])
        found = minimize(
            cost_of,
            start,
            method="Nelder-Mead",
            options={"initial_simplex": simplex, "maxfev": 25 * len(parameters), "xatol": 1e-3, "fatol": 1e-2},
        )
        u, value = (found.x, float(found.fun)) if found.fun < best else (start, best)
    return replace(term, shape=shape_of(u)) if value < cost else term


def _bounded(cost_of: Callable[[Array], float], low: float, high: float) -> tuple[Array, float]:
    """Minimum of a function of one shape between two values, to a thousandth of their distance."""
    options = {"xatol": 1e-3 * (high - low)}
    found = minimize_scalar(lambda v: cost_of(np.array([v])), bounds=(low, high), method="bounded", options=options)
    return np.array([found.x]), float(found.fun)


def _along_each(cost_of: Callable[[Array], float], start: Array, ends: Array, cost: float) -> tuple[Array, float]:
    """The best point on a line through the start along every axis in turn, for costs with jumps in the shapes."""
    here, best = start.copy(), cost
    if len(here) < 2:
        return here, best
    for k in range(len(here)):
        for value in np.linspace(ends[k, 0], ends[k, 1], _ON_A_LINE + 2)[1:-1]:
            trial = here.copy()
            trial[k] = value
            found = cost_of(trial)
            if found < best:
                here, best = trial, found
    return here, best


def sites(block: Block, index: int, library: Sequence[Effect]) -> list[Site]:
    """Every place in a block where an effect of the library may act."""
    found = []
    has_cross = any(r.role == "cross" for record in block.records for r in record.readings)
    for effect in library:
        if block.kind not in effect.kinds:
            continue
        if effect.stage in ("filter", "bias"):
            found += [Site(effect, index, block.kind, channel) for channel in block.channels]
        elif effect.stage != "cross" or has_cross:
            found.append(Site(effect, index, block.kind))
    return found

r"""The search for the missing effects: try, add, replace, check backwards.

One stage tries every effect at every place beside what is already accepted: its plain form first, its richer forms where
the plain one is not enough. What wins is added with everything recalibrated; the next stage begins.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from compare.bench_design import Block
from compare.evidence import LeftOut, Null, left_out, log_e_value, splits
from compare.form_fit import FormFit, Site, best_shape, fitted, refine, searched, shape_grid, sites, total_cost
from compare.gram import Grams, Scan
from compare.shared_misfit import SharedMisfit, shared_misfit
from effects.effect import ActiveEffect, Effect, Form

Array = NDArray[np.float64]
Terms = tuple[tuple[ActiveEffect, ...], ...]
_WORTH_A_SEARCH = 8.0  # fall of the square residual on the grid below which a shape is not searched further
_FAR_BEHIND = 0.1  # or below that part of the largest fall
_EDGE = 5.0  # nats that a shape at the end of its range costs in the ranking
_NO_EVIDENCE = -1e299
_WORTH_FORM = 5.0  # nats by which a richer form has to predict better
Progress = Callable[[float, str], None]


@dataclass(frozen=True)
class Trial:
    """One form of one effect at one place, beside the accepted terms of its block.

    `gain` (G,) is the left-out gain of every group in nats, `shared` (G,) the left-out misfit that repeats share.
    """

    site: Site
    fit: FormFit = field(repr=False)
    log_e: float
    gain: Array = field(repr=False)
    shared: Array = field(repr=False)

    @property
    def total(self) -> float:
        """Left-out gain of all groups."""
        return float(self.gain.sum())


@dataclass(frozen=True)
class Attempt:
    """An effect with the places where it is wanted, and what it does there altogether."""

    effect: Effect
    trials: tuple[Trial, ...]
    log_e: float
    gain: float
    share: float
    positive: int
    folds: int

    @property
    def rank(self) -> float:
        """Gain by which effects are ranked: less where a shape would rather leave its range.

        Not so the share of the tension in the grip in a tension test, where the tension is the load and does not vary by
        itself.
        """
        return self.gain - _EDGE * any(_leaves_its_range(t) for t in self.trials)

    @property
    def forms(self) -> tuple[str, ...]:
        """Names of the forms, one per place."""
        return tuple(t.fit.term.form.name for t in self.trials)


class Stage:
    """Everything about one set of accepted terms: its fit, its misfit, and what each effect would add.

    Parameters
    ----------
    blocks : sequence of Block
        One per kind of experiment.
    accepted : tuple of tuples of ActiveEffect
        Per block, shapes given.
    library : sequence of Effect
        What may be missing.
    alpha : float
        Chance that is allowed for naming anything where nothing is missing.
    """

    def __init__(
        self, blocks: Sequence[Block], accepted: Terms, library: Sequence[Effect], alpha: float = 0.05
    ) -> None:
        self.blocks, self.accepted, self.library = tuple(blocks), accepted, tuple(library)
        self.scans = [Scan(block, terms) for block, terms in zip(blocks, accepted, strict=True)]
        self.base: list[Grams] = [scan.base() for scan in self.scans]
        self.x = [g.fit(g.S.sum(axis=0)) for g in self.base]
        self.left: list[LeftOut] = [left_out(g) for g in self.base]
        self.sites = [s for i, block in enumerate(blocks) for s in sites(block, i, library)]
        self.needed = float(np.log(max(len(self.sites), 1) / alpha))
        self._null: dict[int, Null] = {}
        self._trials: dict[tuple[int, str, str | None, str], Trial] = {}
        self._grids: dict[tuple[int, str, str | None, str], tuple[Grams, list[tuple[float, ...]]]] = {}
        self._falls: dict[tuple[int, str, str | None, str], float] = {}
        self._largest_fall: dict[int, float] = {}

    def misfit(self) -> SharedMisfit:
        """The misfit that repeats share, all blocks together."""
        return shared_misfit(self.blocks, self.accepted, self.x)

    def null(self, block: int) -> Null:
        """The accepted model under more scatter, per block."""
        if block not in self._null:
            self._null[block] = Null.of(self.base[block])
        return self._null[block]

    def trial(self, site: Site, form: Form) -> Trial:
        """Try one form at one place (once)."""
        key = (site.block, site.effect.name, site.channel, form.name)
        if key not in self._trials:
            self._trials[key] = self._try(site, form)
        return self._trials[key]

    def _try(self, site: Site, form: Form) -> Trial:
        block, scan = self.blocks[site.block], self.scans[site.block]
        shapes, fall = shape_grid(form, block), self._fall(site, form)
        promising = fall > max(_WORTH_A_SEARCH, _FAR_BEHIND * self._largest_fall[site.block])
        beside, tried = self.accepted[site.block], (site.effect.name, form.name, site.kind, site.channel or "")
        known = block.fits.get(beside, tried, promising) if block.fits is not None else None
        if known is not None:
            fit = (
                searched(scan, site.term(form, known[0]), shapes)
                if promising
                else self._plain_fit(site, form, known[0])
            )
            log_e = known[1] if known[1] > _NO_EVIDENCE else -np.inf
        else:
            fit, log_e = self._searched(site, form, promising)
            if block.fits is not None:
                block.fits.put(beside, tried, promising, fit.term.shape, log_e)
        near = left_out(fit.near or fit.grams)
        gain = 0.5 * (self.left[site.block].square - near.square)
        return Trial(site, fit, log_e, gain, near.shared)

    def _plain_fit(self, site: Site, form: Form, shape: tuple[float, ...]) -> FormFit:
        term = site.term(form, shape)
        return fitted(self.scans[site.block].candidate(term), term)

    def _searched(self, site: Site, form: Form, promising: bool) -> tuple[FormFit, float]:
        """The best shape and its evidence; from the grid alone where that promises nothing."""
        block, scan = self.blocks[site.block], self.scans[site.block]
        grid, shapes = self._grid(site, form)
        if promising:
            fit = refine(scan, site.term(form, shapes[0]), grid, shapes)
        else:
            fit = self._plain_fit(site, form, shapes[int(np.argmin(np.atleast_1d(total_cost(grid))))])
        log_e = -np.inf
        if promising or not any(self.accepted):
            log_e = log_e_value(grid, self.null(site.block), splits(len(block.groups)))
        return fit, log_e

    def _fall(self, site: Site, form: Form) -> float:
        """How far the square residual falls over the starts of the shapes."""
        key = (site.block, site.effect.name, site.channel, form.name)
        if key not in self._falls:
            block, beside = self.blocks[site.block], self.accepted[site.block]
            tried = ("grid", site.effect.name, form.name, site.kind, site.channel or "")
            known = block.fits.get(beside, tried, False) if block.fits is not None else None
            if known is None:
                grid, _ = self._grid(site, form)
                fall = float(total_cost(self.base[site.block]) - np.min(total_cost(grid)))
                if block.fits is not None:
                    block.fits.put(beside, tried, False, (fall,), 0.0)
            else:
                fall = known[0][0]
            self._falls[key] = fall
            self._largest_fall[site.block] = max(self._largest_fall.get(site.block, 0.0), fall)
        return self._falls[key]

    def _grid(self, site: Site, form: Form) -> tuple[Grams, list[tuple[float, ...]]]:
        """Gram matrices over the starts of the shapes."""
        key = (site.block, site.effect.name, site.channel, form.name)
        if key not in self._grids:
            shapes = shape_grid(form, self.blocks[site.block])
            self._grids[key] = self.scans[site.block].grid(site.term(form, shapes[0]), shapes), shapes
        return self._grids[key]

    def plain(self) -> list[Attempt]:
        """Every effect in its plain form, best first."""
        return self._attempts({s: [s.effect.forms[0]] for s in self.sites})

    def rich(self, names: Sequence[str]) -> list[Attempt]:
        """The named effects in the best of all their forms, best first."""
        return self._attempts({s: s.effect.forms for s in self.sites if s.effect.name in names})

    def _attempts(self, forms: Mapping[Site, Sequence[Form]]) -> list[Attempt]:
        by_effect: dict[str, list[Trial]] = {}
        for site, choices in forms.items():
            for form in choices:
                self._fall(site, form)  # so that what is far behind need not be searched
        for site, choices in forms.items():
            best = max((self.trial(site, form) for form in choices), key=_worth_its_form)
            by_effect.setdefault(site.effect.name, []).append(best)
        attempts = [self.attempt(trials) for trials in by_effect.values()]
        return sorted(attempts, key=lambda a: -a.rank)

    def attempt(self, trials: Sequence[Trial]) -> Attempt:
        """Put the places of one effect together: those where it passes the gate, or else the best one."""
        wanted = [t for t in trials if t.log_e > self.needed and t.total > 0]
        wanted = wanted or [max(trials, key=lambda t: t.log_e)]
        log_e = float(np.sum([t.log_e for t in wanted])) if len(wanted) > 1 else wanted[0].log_e
        touched = {t.site.block for t in wanted}
        before = sum(float(self.left[b].shared.sum()) for b in touched)
        fall = sum(float(self.left[t.site.block].shared.sum() - t.shared.sum()) for t in wanted)
        gains = np.concatenate([t.gain for t in wanted])
        share = fall / before if before > 0 else 0.0
        return Attempt(
            trials[0].site.effect,
            tuple(wanted),
            log_e,
            float(sum(t.total for t in wanted)),
            float(np.clip(share, -9.99, 1.0)),
            int(np.count_nonzero(gains > 0)),
            len(gains),
        )

    def with_attempt(self, attempt: Attempt) -> Stage:
        """The stage after an effect is added, all shapes fitted again."""
        terms = [list(t) for t in self.accepted]
        for trial in attempt.trials:
            terms[trial.site.block].append(trial.fit.term)
        return Stage(self.blocks, polished(self.blocks, terms, leave_weak=True), self.library)

    def without(self, name: str) -> Stage:
        """The stage without one of its effects, the others in the shapes that they have."""
        terms = tuple(tuple(t for t in block if t.effect.name != name) for block in self.accepted)
        return Stage(self.blocks, terms, self.library)

    def upgraded(self, names: Sequence[str]) -> Stage:
        """The stage with the named effects in the forms that predict left-out experiments best.

        One after the other, and all at once in their freest forms, which need no search beside each other.
        """
        one_by_one = self._upgraded_one_by_one(names)
        if len(names) < 2:
            return one_by_one
        free = self._freest(names)
        return free if free.score < one_by_one.score - _WORTH_FORM * len(names) else one_by_one

    def _freest(self, names: Sequence[str]) -> Stage:
        terms = []
        for block, own in zip(self.blocks, self.accepted, strict=True):
            changed = []
            for term in own:
                form = plain_and_free(term.effect)[-1]
                if term.effect.name in names and form is not term.form and form.strength:
                    grid = shape_grid(form, block)
                    term = replace(term, form=form, shape=grid[len(grid) // 2])
                changed.append(term)
            terms.append(changed)
        return Stage(self.blocks, polished(self.blocks, terms), self.library)

    def _upgraded_one_by_one(self, names: Sequence[str]) -> Stage:
        stage = self
        for name in names:
            rest = stage.without(name)
            own = {(t.channel, t.kind): t.form.name for terms in stage.accepted for t in terms if t.effect.name == name}
            places = [s for s in rest.sites if s.effect.name == name and (s.channel, s.kind) in own]
            trials, better = [], False
            for place in places:
                now = next(f for f in place.effect.forms if f.name == own[place.channel, place.kind])
                current = rest.trial(place, now)
                best = max((rest.trial(place, form) for form in place.effect.forms), key=lambda t: t.total)
                change = best.total > current.total + _WORTH_FORM
                better |= change
                trials.append(best if change else current)
            if better:
                stage = rest.with_attempt(rest.attempt(trials))
        return stage

    def active(self) -> list[ActiveEffect]:
        """The accepted terms with their strengths."""
        found = []
        for block, terms, x in zip(self.blocks, self.accepted, self.x, strict=True):
            at = len(block.base)
            for term in terms:
                k = len(term.form.strength)
                found.append(replace(term, strength=tuple(float(v) for v in x[at : at + k]), reference=block.paths[0]))
                at += k
        return found

    @property
    def score(self) -> float:
        """Half the whitened square residual on left-out groups, in nats; smaller is better."""
        return 0.5 * sum(float(left.square.sum()) for left in self.left)

    @property
    def shared_left(self) -> float:
        """Misfit on left-out groups that repeats share."""
        return sum(float(left.shared.sum()) for left in self.left)

    @property
    def names(self) -> tuple[str, ...]:
        """Accepted effects in the order in which they were added."""
        return tuple(dict.fromkeys(t.effect.name for terms in self.accepted for t in terms))


def _leaves_its_range(trial: Trial) -> bool:
    excused = {"tension share"} if trial.site.kind == "tension" else set()
    return bool(set(trial.fit.at_edge) - excused)


def _worth_its_form(trial: Trial) -> float:
    """Gain of a trial, less what a form that is not the plain one has to earn."""
    return trial.total - _WORTH_FORM * (trial.fit.term.form is not trial.site.effect.forms[0])


def polished(
    blocks: Sequence[Block],
    terms: Sequence[Sequence[ActiveEffect]],
    sweeps: int = 2,
    alone: bool = False,
    leave_weak: bool = False,
) -> Terms:
    """Shapes of all terms fitted together, one after the other in turn.

    A term that stands alone in its block is left in its shape, which a search has found, unless `alone` says otherwise. Where
    columns are dear, a term is left beside others that stay as they were, and with `leave_weak` all are where the last one
    makes next to no difference.
    """
    result = []
    for block, own in zip(blocks, terms, strict=True):
        now = list(own)
        dear = Scan(block, ()).dear
        if (alone or len(now) > 1) and not (dear and leave_weak and _last_is_weak(block, now)):
            beside: dict[int, list[tuple[float, ...]]] = {}
            for _ in range(sweeps):
                for i, term in enumerate(now):
                    others = [t.shape for k, t in enumerate(now) if k != i]
                    if term.form.shape and not (dear and beside.get(i) == others):
                        now[i] = _moved(block, now, i)
                        beside[i] = others
        result.append(tuple(now))
    return tuple(result)


def _last_is_weak(block: Block, terms: Sequence[ActiveEffect]) -> bool:
    """Whether the square residual hardly falls by the last term, in the shape that it has."""
    with_it, without = (Scan(block, own).base() for own in (terms, terms[:-1]))
    return float(total_cost(without) - total_cost(with_it)) < _WORTH_A_SEARCH


def _moved(block: Block, terms: Sequence[ActiveEffect], i: int) -> ActiveEffect:
    """Term i at its best shape beside the others, searched near where it is."""
    others = [t for k, t in enumerate(terms) if k != i]
    scan, term = Scan(block, others), terms[i]
    near = [term.shape]
    for k, value in enumerate(term.shape):
        for factor in (0.7, 1.4):
            low, high = term.form.shape[k].low, term.form.shape[k].high
            near.append((*term.shape[:k], float(np.clip(value * factor, low, high)), *term.shape[k + 1 :]))
    return best_shape(scan, term, scan.grid(term, near), near)


def plain_and_free(effect: Effect) -> list[Form]:
    """The plain form, and the one with the most strengths where that is another one."""
    freest = max(effect.forms, key=lambda f: len(f.strength))
    return [effect.forms[0]] if freest is effect.forms[0] else [effect.forms[0], freest]

r"""From the search to one of five words, with sets instead of false winners and "unknown" instead of a proxy.

::

    gate: some log e > ln(K / alpha), K places and effects tried, alpha = 0.05
    closed and no misfit that repeats share        none
    closed, but repeats share a misfit             unknown
    open: add the best; rivals within 5 nats       confusable (the set)
          adequate or >= 95 % of the misfit gone   identified
          70 to 95 %                               family-identified
          below 70 %                               unknown, with the closest

The shares are those on experiments left out of the fit. Source of the thresholds: Markov's inequality on the e-value with
Bonferroni over what was tried; the others were set on simulated campaigns other than those of the scorecard
(benchmarks/blind).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from compare.bench_design import Block
from compare.effect_pairs import pair_gains
from compare.findings import Verdict
from compare.rivals import find_rivals, tied
from compare.search import Attempt, Progress, Stage
from compare.shared_misfit import ADEQUATE_Z, SharedMisfit
from effects.effect import Effect

CLEAR_Z = 5.0
CLEAR_F = 1.05
UNKNOWN_F = 2.0  # with a z above that of an adequate model
IDENTIFIED, FAMILY = 0.95, 0.85
_MOST = 3
_WORTH_FORM = 5.0
_SMALLEST_SECOND = 0.004  # of the gain of the first effect
_REST_LEFT = 0.4  # part of the misfit that a further effect may leave
_REST_LEFT_BY_RIGID = 0.75  # the same for a law of a single number that helps on every left-out group
_REST_LEFT_OF_LITTLE = 0.15  # the same where what is left is little: a mend of the form would leave more
_TRIED_TOGETHER = 3
_NEGLIGIBLE = 0.02  # of the first misfit


@dataclass(frozen=True)
class Taken:
    """One step: the attempt that was added, what it left, and which effects would have done as well."""

    attempt: Attempt
    after: Stage = field(repr=False)
    misfit: SharedMisfit


@dataclass(frozen=True)
class Outcome:
    """What the search ends with."""

    verdict: Verdict
    effects: tuple[str, ...]
    confusable: tuple[str, ...]
    closest: tuple[str, float] | None
    first: Stage = field(repr=False)
    final: Stage = field(repr=False)
    steps: tuple[Taken, ...]
    rivals: dict[str, tuple[Attempt, ...]] = field(repr=False)
    before: SharedMisfit
    after: SharedMisfit
    share: float


def decide(blocks: Sequence[Block], library: Sequence[Effect], progress: Progress | None = None) -> Outcome:
    """Search, add and judge.

    Parameters
    ----------
    blocks : sequence of Block
        The calibration experiments, one block per kind.
    library : sequence of Effect
        What may be missing.
    """
    tell = progress or (lambda _fraction, _sentence: None)
    first = Stage(blocks, ((),) * len(blocks), library)
    before = first.misfit()
    tell(0.0, "trying every effect beside the linear model")
    steps = _forward(first, before, tell)
    if not steps:
        unknown = (before.z > CLEAR_Z and before.F > CLEAR_F) or (before.z > ADEQUATE_Z and before.F > UNKNOWN_F)
        closest = None
        if unknown:
            best = max(first.plain(), key=lambda a: a.share)
            closest = (best.effect.name, float(np.clip(best.share, 0.0, 1.0)))
        return Outcome("unknown" if unknown else "none", (), (), closest, first, first, (), {}, before, before, 0.0)
    final = steps[-1].after
    tell(0.8, "looking for rivals of what was found")
    final, rivals = find_rivals(final)
    return _judge(first, final, steps, rivals, before)


def _forward(first: Stage, before: SharedMisfit, tell: Progress) -> list[Taken]:
    attempt = _first(first)
    if attempt is None:
        return []
    tell(0.2, f"adding {attempt.effect.name}")
    stage = first.with_attempt(attempt)
    steps = [Taken(attempt, stage, stage.misfit())]
    while len(steps) < _MOST:
        tell(0.2 + 0.2 * len(steps), "looking for a further effect")
        further = _further(steps, before)
        if further is None:
            break
        steps.append(further)
    steps = _backward(steps, before)
    left = steps[-1].misfit
    if not left.adequate and left.T > _NEGLIGIBLE * before.T:
        steps = _pair(first, steps, before) or steps
    return steps


def _backward(steps: list[Taken], before: SharedMisfit) -> list[Taken]:
    """Effects that the later ones have made unnecessary are taken out again."""
    for taken in steps[:-1]:
        if len(steps) < 2:
            break
        now = steps[-1].after
        rest = now.without(taken.attempt.effect.name)
        rest = rest.upgraded(rest.names)
        without = rest.misfit()
        adequate = without.adequate and without.T - steps[-1].misfit.T < ADEQUATE_Z * without.std
        adequate = len(steps) > 2 and (adequate or without.T < _NEGLIGIBLE * before.T)
        if adequate or rest.score - now.score < max(rest.needed, _SMALLEST_SECOND * steps[0].attempt.gain):
            steps = [s for s in steps if s is not taken]
            steps[-1] = replace(steps[-1], after=rest, misfit=without)
    return steps


def _first(stage: Stage) -> Attempt | None:
    """The effect to begin with, in the form that it needs, or None when the gate is closed."""
    plain = stage.plain()
    passing = [a for a in plain if a.log_e > stage.needed and a.gain > 0]
    if not passing:
        names = [a.effect.name for a in plain if a.gain > stage.needed]
        passing = [a for a in stage.rich(names) if a.log_e > stage.needed and a.gain > 0] if names else []
        return passing[0] if passing else None
    best = passing[0]
    if not stage.with_attempt(best).misfit().adequate:
        rich = [a for a in stage.rich([a.effect.name for a in plain]) if a.log_e > stage.needed]
        if rich and rich[0].gain > best.gain + _WORTH_FORM:
            best = rich[0]
    return best


def _further(steps: Sequence[Taken], before: SharedMisfit) -> Taken | None:
    """One more effect beside the accepted ones, these in richer forms if that makes it unnecessary."""
    stage, misfit = steps[-1].after, steps[-1].misfit
    plain = [a for a in stage.plain() if a.effect.name not in stage.names and a.gain > stage.needed]
    if misfit.adequate:
        plain = [a for a in plain if a.log_e > stage.needed]
    if not plain:
        return None
    alone = stage.upgraded(stage.names)
    left = alone.misfit()
    best: Taken | None = None
    for attempt in plain[:_TRIED_TOGETHER]:
        together = stage.with_attempt(attempt)
        together = together.upgraded(together.names)
        found = next(a for a in together.without(attempt.effect.name).rich([attempt.effect.name]))
        after = together.misfit()
        if not _worth(found, together, alone, left, after, steps[0].attempt.gain, before):
            continue
        if best is None or together.score < best.after.score:
            best = Taken(found, together, after)
        if after.adequate or after.T < _NEGLIGIBLE * left.T:
            break  # rivals for its place are looked for at the end
    return best


def _worth(
    found: Attempt,
    together: Stage,
    alone: Stage,
    left: SharedMisfit,
    after: SharedMisfit,
    energy: float,
    before: SharedMisfit,
) -> bool:
    """Whether a further effect is more than a mend of the forms of the others."""
    if found.log_e < together.needed or alone.score - together.score < together.needed:
        return False
    if alone.score - together.score < _SMALLEST_SECOND * energy:
        return False
    rigid = all(not t.fit.term.form.shape and len(t.fit.term.form.strength) == 1 for t in found.trials)
    rest_left = _REST_LEFT_BY_RIGID if rigid and found.positive == found.folds else _REST_LEFT
    if left.T < (1 - IDENTIFIED) * before.T:
        rest_left = min(rest_left, _REST_LEFT_OF_LITTLE)
    return left.adequate or after.adequate or after.T < rest_left * left.T


def _pair(first: Stage, steps: Sequence[Taken], before: SharedMisfit) -> list[Taken] | None:
    """Two other effects instead of those found, where they leave clearly less."""
    best, limit = None, _REST_LEFT * steps[-1].misfit.T
    known = {s.attempt.effect.name for s in steps[:2]}
    tried = 0
    for _, a, b in pair_gains(first):
        names = {a.effect.name, b.effect.name}
        if tried == _TRIED_TOGETHER:
            break
        if names == known:
            continue
        tried += 1
        one, two = (a, b) if a.gain >= b.gain else (b, a)
        stage = first.with_attempt(one).with_attempt(two)
        stage = stage.upgraded(stage.names)
        misfit = stage.misfit()
        if misfit.T >= limit:
            continue
        found = [stage.without(n).rich([n])[0] for n in (one.effect.name, two.effect.name)]
        if all(f.log_e > stage.needed for f in found):
            alone = first.with_attempt(one)
            best, limit = [Taken(one, alone, alone.misfit()), Taken(found[1], stage, misfit)], misfit.T
    return best


def _judge(
    first: Stage,
    final: Stage,
    steps: Sequence[Taken],
    rivals: dict[str, tuple[Attempt, ...]],
    before: SharedMisfit,
) -> Outcome:
    after = final.misfit()
    share = _left_out_share(first, final)
    sets = {name: tied(attempts, name, after) for name, attempts in rivals.items()}
    single = tuple(name for name in final.names if len(sets.get(name, ())) <= 1)
    union = tuple(dict.fromkeys(n for name in final.names if name not in single for n in sets[name]))
    adequate = after.adequate
    closest = None
    verdict: Verdict
    if not adequate and share < FAMILY and before.F >= 1.1:
        verdict, closest = "unknown", (final.names[0], float(np.clip(share, 0, 1)))
        single, union = (), ()
    elif union:
        verdict = "confusable"
    elif adequate or share >= IDENTIFIED:
        verdict = "identified"
    else:
        verdict = "family-identified"
    return Outcome(verdict, single, union, closest, first, final, tuple(steps), rivals, before, after, share)


def _left_out_share(first: Stage, final: Stage) -> float:
    """Part of the misfit on left-out experiments that the final model removes."""
    return 1 - final.shared_left / first.shared_left if first.shared_left > 0 else 0.0

r"""Rivals of what was found: every accepted effect is taken out, and all others are tried in its place.

Those whose left-out gain is within a tie are a set that the data cannot tell apart. An odds ratio of 33 (3.5 nats) is a tie
where the model is adequate; where it still misses something nats are worth less and the tie is F times as wide
(quasi-likelihood, Wedderburn, Biometrika 61 (1974) 439).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from compare.bench_design import Block
from compare.search import Attempt, Stage
from compare.shared_misfit import SharedMisfit
from effects.effect import ActiveEffect

TIE = 3.5
EXPLAINS_MOST = 0.85
_PRICE_OF_A_FORM = 5.0
_PROPORTIONAL = 1e-6


def find_rivals(final: Stage) -> tuple[Stage, dict[str, tuple[Attempt, ...]]]:
    """For every accepted effect what would do in its place, itself among them, best first.

    Where another one does clearly better it takes the place, once: what came first may have stood for what came later.
    """
    rivals: dict[str, tuple[Attempt, ...]] = {}
    for name in final.names:
        attempts = _in_place_of(final, name)
        best = attempts[0]
        mine = next((a for a in attempts if a.effect.name == name), None)
        if mine is not None and best is not mine and best.rank - mine.rank >= TIE:
            exchanged = final.without(name).with_attempt(best)
            if exchanged.score < final.score and exchanged.misfit().T < final.misfit().T:
                final = exchanged
                name, attempts = best.effect.name, _in_place_of(exchanged, best.effect.name)
        rivals[name] = attempts
    return final, {name: rivals[name] for name in final.names if name in rivals}


def _in_place_of(final: Stage, name: str) -> tuple[Attempt, ...]:
    rest = final.without(name)
    attempts = rest.plain()
    own = [t for terms in final.accepted for t in terms if t.effect.name == name]
    passing = [a.effect.name for a in attempts if a.log_e > rest.needed]
    if any(t.form is not t.effect.forms[0] for t in own):
        attempts = rest.rich([*passing, name])
    else:
        # a rival that explains most of it may need another form; where only conditions of whole records tell, no form counts
        near = [a.effect.name for a in attempts if a.share > EXPLAINS_MOST and a.log_e > rest.needed]
        if len(near) > 1:
            best = {a.effect.name: a for a in attempts}
            records = all(acts_per_record(rest.blocks, t) for t in own)
            for a in rest.rich(near):
                price = (
                    0.0
                    if records and all(acts_per_record(rest.blocks, t.fit.term) for t in a.trials)
                    else _PRICE_OF_A_FORM
                )
                if a.rank - price > best[a.effect.name].rank:
                    best[a.effect.name] = replace(a, gain=a.gain - price)
            attempts = sorted(best.values(), key=lambda a: -a.rank)
    return tuple(a for a in attempts if a.effect.name == name or a.effect.name not in final.names)


def acts_per_record(blocks: Sequence[Block], term: ActiveEffect) -> bool:
    """Whether an effect changes the stiffness of whole records and nothing else, as temperature or length do."""
    block = next(b for b in blocks if b.kind == term.kind)
    for record in block.records:
        if term.form.stage == "section":
            change = record.columns((term,), only=0)[0].sum(axis=1)
        elif term.form.stage == "fixture":
            change = record.columns((term,))[0].sum(axis=1)
        else:
            return False
        strain = record.led.path.strain[record.led.lead :]
        along = strain * (change @ strain) / max(float(strain @ strain), 1e-300)
        if float(np.sum((change - along) ** 2)) > _PROPORTIONAL * max(float(change @ change), 1e-300):
            return False
    return True


def tied(attempts: Sequence[Attempt], accepted: str, misfit: SharedMisfit) -> tuple[str, ...]:
    """Effects whose left-out gain is within the tie of the accepted one, itself among them.

    Where the model still misses something, nats are worth less: they are divided by the lack of fit F (quasi-likelihood).
    """
    tie = TIE * max(1.0, misfit.F)
    mine = next((a.rank for a in attempts if a.effect.name == accepted), attempts[0].rank)
    return tuple(a.effect.name for a in attempts if abs(mine - a.rank) < tie)

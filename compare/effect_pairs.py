"""All pairs of effects beside an accepted model, to first order in their shapes: two plain laws that a rich third one hides.

Every effect enters at the shape that fits alone, so that one product of the white columns of all of them gives every pair.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from compare.evidence import left_out
from compare.search import Attempt, Stage, Trial, plain_and_free

Array = NDArray[np.float64]


def pair_gains(stage: Stage) -> list[tuple[float, Attempt, Attempt]]:
    """All pairs of effects in one block, at the shapes that they have alone; left-out gain of both, best first.

    Each in its plain form and in the form with the most strengths, which can take on a new law beside the other effect
    without a new search. Fixtures and filters enter by the change that they make, which is exact at their own shape.
    """
    found: dict[frozenset[str], tuple[float, Attempt, Attempt]] = {}
    for b, block in enumerate(stage.blocks):
        trials = [stage.trial(s, form) for s in stage.sites if s.block == b for form in plain_and_free(s.effect)]
        columns, flags = _all_columns(stage, b, trials)
        V = [np.column_stack([Z, r.target]) for Z, r in zip(columns, block.records, strict=True)]
        S = np.array([sum(V[i].T @ V[i] for i in members) for members in block.groups])
        starts = np.cumsum([stage.base[b].P, *[f.size for f in flags]])
        for i in range(len(trials)):
            for j in range(i):
                names = frozenset((trials[i].site.effect.name, trials[j].site.effect.name))
                if len(names) < 2:
                    continue
                own = [*range(starts[i], starts[i + 1]), *range(starts[j], starts[j + 1])]
                gain = _pair_gain(stage, b, S, own, np.concatenate([flags[i], flags[j]]))
                if names not in found or gain > found[names][0]:
                    found[names] = (gain, stage.attempt([trials[i]]), stage.attempt([trials[j]]))
    return sorted(found.values(), key=lambda item: -item[0])


def _pair_gain(stage: Stage, b: int, S: Array, own: Sequence[int], flags: NDArray[np.bool_]) -> float:
    base = stage.base[b]
    index = np.array([*range(base.P), *own, S.shape[1] - 1])
    part = S[:, index[:, None], index]
    positive = np.concatenate([base.positive, flags])
    square = left_out(replace(base, S=part, X=part, positive=positive)).square
    return float(np.sum(0.5 * (stage.left[b].square - square)))


def _all_columns(stage: Stage, b: int, trials: Sequence[Trial]) -> tuple[list[Array], list[NDArray[np.bool_]]]:
    """White columns of the accepted terms and of every trial, per record; and which of each trial's must be positive."""
    block, accepted = stage.blocks[b], stage.accepted[b]
    flags = []
    parts: list[list[Array]] = [[record.whitened(accepted)] for record in block.records]
    x = stage.x[b]
    for trial in trials:
        term = trial.fit.term
        if term.form.strength:
            flags.append(np.array([p.low >= 0 for p in term.form.strength]))
            for part, record in zip(parts, block.records, strict=True):
                part.append(record.whitened((*accepted, term), only=len(accepted)))
        else:
            flags.append(np.array([True]))
            for part, record in zip(parts, block.records, strict=True):
                part.append(((record.whitened((*accepted, term)) - part[0]) @ x)[:, None])
    return [np.hstack(p) for p in parts], flags

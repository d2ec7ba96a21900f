"""Fit on some records, read on others: the residual in the unit of the measurement, one effect at a time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from compare.bench_design import Block
from compare.search import Stage, polished
from effects.effect import ActiveEffect, Effect, Form

Array = NDArray[np.float64]


def fitted_terms(block: Block, chosen: Sequence[tuple[Effect, Form]]) -> tuple[tuple[ActiveEffect, ...], Array]:
    """The chosen forms added one after the other, all shapes and coefficients fitted to the block."""
    library = list(dict.fromkeys(effect for effect, _ in chosen))
    stage = Stage((block,), ((),), library)
    for effect, form in chosen:
        site = next(s for s in stage.sites if s.effect is effect)
        terms = (*stage.accepted[0], stage.trial(site, form).fit.term)
        stage = Stage((block,), polished((block,), (terms,)), library)
    return stage.accepted[0], stage.x[0]


def residual(block: Block, terms: Sequence[ActiveEffect], x: Array) -> Array:
    """Measurement less model over all readings of a block, in the unit of the measurement.

    The block must stand about the same linear model as the one that was fitted, because x holds factors of it.
    """
    parts = []
    for record in block.records:
        for reading, Z in zip(record.readings, record.columns(terms), strict=True):
            parts.append(reading.y - Z @ x)
    return np.concatenate(parts)


def rms(values: Array) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))

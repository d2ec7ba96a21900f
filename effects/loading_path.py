"""What a set of loading paths shows: does it turn back, on which sides is it, how far do its conditions spread."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from effects.effect import BenchPath

Array = NDArray[np.float64]
_STANDSTILL = 0.02  # of the largest strain: less is no turn, no side


def grip_ratio(tension: Array | float | None, typical: float, n: int) -> Array:
    """Tension over the typical tension, shape (n,); 1 where none was recorded, 0 in compression."""
    if tension is None or typical <= 0.0:
        return np.ones(n)
    return np.broadcast_to(np.maximum(np.asarray(tension, dtype=float) / typical, 0.0), (n,))


def turns_back(paths: Sequence[BenchPath]) -> bool:
    """Whether some record comes back from a strain that it had reached, by more than 2 % of the largest strain."""
    return any(
        bool(np.any(np.maximum.accumulate(side) - side > _STANDSTILL * p.largest))
        for p in paths
        for side in (np.maximum(p.strain, 0.0), np.maximum(-p.strain, 0.0))
    )


def sides(paths: Sequence[BenchPath]) -> set[int]:
    """Signs of the load that occur, +1 and -1; a test in the direction ``x-`` or ``y-`` loads the other side."""
    found = set()
    for p in paths:
        sign = direction_sign(p.direction)
        if p.strain.max(initial=0.0) > _STANDSTILL * p.largest:
            found.add(sign)
        if p.strain.min(initial=0.0) < -_STANDSTILL * p.largest:
            found.add(-sign)
    return found


def direction_sign(direction: str | None) -> int:
    """-1 for ``x-`` and ``y-``, else 1."""
    return -1 if direction is not None and direction.endswith("-") else 1


def spread(values: Iterable[float]) -> float:
    """Largest over smallest value, infinite if the smallest is 0, and 1 without values."""
    known = np.array(list(values), dtype=float)
    if known.size == 0 or known.max() == known.min():
        return 1.0
    return float(known.max() / known.min()) if known.min() > 0.0 else np.inf


def mean_tensions(paths: Sequence[BenchPath]) -> list[float]:
    """Mean tension [N] of the records that have one."""
    return [float(np.mean(p.tension)) for p in paths if p.tension is not None and p.tension.size]

"""What a sign in the residual is made of: a number over the conditions, its chance by noise alone, and the sentence on it.

The rule is that of :mod:`compare.localisation`: a mean counts where noise alone would hardly give it and the conditions agree on
its sign; a slope where noise does not explain that the conditions differ.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from compare.condition_regression import ConditionSlope, Slope, average_repeats, fit_line
from compare.findings import Mark
from compare.record_signature import RecordSignature

Array = NDArray[np.float64]
CHANCE = 0.05
CLEAR, _AGREE = 3.0, 0.8
_LIKELY = 0.15  # chance of a mean beside the scatter between conditions
_ORDER = (
    "amplitude", "rate", "axial tension", "temperature", "length", "mean tension", "speed", "inclination", "stroke",
)  # fmt: skip
WORDS = {"length": "specimen length", "rate": "rate"}


@dataclass(frozen=True)
class Group:
    """One number over the conditions of the bench."""

    value: Array
    std: Array
    conditions: Mapping[str, Array]


@dataclass(frozen=True)
class Sign:
    """A mark and how likely noise alone makes one; `told` marks are kept whatever it is, if anything fails at all."""

    mark: Mark = field(repr=False)
    chance: float
    told: bool = False


def grouped(found: Sequence[RecordSignature], name: str) -> Group | None:
    """A number averaged over repeats, with the conditions of each group."""
    own = [s for s in found if name in s.numbers]
    if not own:
        return None
    groups, value, std = average_repeats([s.group for s in own], [s.numbers[name] for s in own])
    members = [[s for s in own if s.group == g] for g in groups]
    conditions = {
        c: np.array([float(np.mean([s.conditions.get(c, np.nan) for s in member])) for member in members])
        for c in _ORDER
    }
    return Group(value, std, conditions)


def mark_of(name: str, sentence: str, value: float, std: float, computed: str, kind: str) -> Mark:
    if kind:
        name, sentence = f"{name} ({kind})", f"{kind}: {sentence}"
    return Mark(name, sentence, value, std, computed)


def average(group: Group, dof: int) -> Slope | None:
    """Mean over the conditions of the bench; chances of 1 where these do not agree on its sign."""
    lines = fit_line(group.value, group.std, np.ones((len(group.value), 1)), dof)
    if lines is None:
        return None
    clear = group.value[np.abs(group.value) > CLEAR * group.std]
    agree = np.mean(np.sign(clear) == np.sign(lines[0].value)) if len(clear) else 1.0
    return lines[0] if agree > _AGREE and lines[0].chance < _LIKELY else replace(lines[0], chance=1.0, by_noise=1.0)


def tie(s: ConditionSlope) -> str:
    """The conditions that it cannot be told from."""
    return "".join(
        f" (not to be told from {WORDS.get(name, name)}: they vary together, correlation {r:.2f})" for name, r in s.tied
    )


def beside(s: ConditionSlope) -> str:
    words = [WORDS.get(name, name) for name in s.beside]
    return f", with {' and '.join(words)} in the same regression" if words else ""

r"""Where and how a linear model fails: signatures of its residual, as sentences with numbers.

Each is one number of every record (:mod:`compare.record_signature`), averaged over repeats, and then either its mean over
all conditions of the bench or its slope over one of them (:mod:`compare.condition_regression`). A mean is a sign if noise
alone would give it in less than 5 % of campaigns, shared among all numbers that were tried (Bonferroni), and if the
conditions agree on its sign. A slope is one if noise does not explain that the conditions differ, and the slope is
significant at 5 % beside the scatter about its line. That a number does not change with a condition is told only where
something else fails, and where it is known well. Signatures explain; they do not decide.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from compare.campaign import Campaign
from compare.comparison import Comparison
from compare.condition_regression import ConditionSlope, differ, over_conditions
from compare.findings import Mark
from compare.findings_sentences import uncertain
from compare.record_signature import RecordSignature, record_signatures
from compare.residual_sign import CHANCE, WORDS, Group, Sign, average, beside, grouped, mark_of, tie
from compare.towing_marks import towing_signs

Array = NDArray[np.float64]
_KNOWN_EXPONENT = 0.2
_KNOWN_DRIFT = 0.2  # of the largest drift, from which the absence of another is told
_A_PHASE = 0.5  # distance of the exponent of the lag over rate from -1
_CLEAR_LOOP = 4.0  # std


@dataclass(frozen=True)
class _Mean:
    """What is said of the mean of a number: factor to the shown unit, unit, sentences for + and -, how computed."""

    name: str
    factor: float
    unit: str
    positive: str
    negative: str
    computed: str


_MEANS = {
    "loop": _Mean(
        "loop", 1.0, "", "load and path enclose loops, the load ahead of the path: loss factor {}",
        "load and path enclose loops that run backwards, the load behind the path: loss factor {}",
        "energy of a closed loop of the residual over 2 pi times the stored energy",
    ),
    "direction": _Mean(
        "half width of the loop", 100.0, "%", "the load is higher while the path grows: half width {} of the largest load",
        "the load is lower while the path grows: half width {} of the largest load",
        "coefficient of the sign of the motion in the residual, over the largest load of the record",
    ),
    "lag": _Mean(
        "lag", 1e3, "ms", "the load is behind the path by {}", "the load is ahead of the path by {}",
        "coefficient of minus the rate of the load in the residual (the lag to first order)",
    ),
    "even": _Mean(
        "even harmonic", 100.0, "%", "the load over the path is one-sided, stiffer where it is positive: even harmonic {}",
        "the load over the path is one-sided, stiffer where it is negative: even harmonic {}",
        "second Chebyshev polynomial of the path in the residual, over the largest load of the record",
    ),
    "odd": _Mean(
        "third harmonic", 100.0, "%", "the load over the path curves up towards both ends: third harmonic {} of the load",
        "the load over the path flattens towards both ends: third harmonic {} of the load",
        "third Chebyshev polynomial of the path in the residual, over the largest load of the record",
    ),
    "curvature": _Mean(
        "curvature", 100.0, "%", "the load over the path curves up: by {} of the largest load",
        "the load over the path flattens: by {} of the largest load",
        "second Chebyshev polynomial of the one-sided path in the residual, over the largest load of the record",
    ),
    "history": _Mean(
        "first loading", 100.0, "%", "at first loading the specimen is stiffer than later, by {}",
        "at first loading the specimen is softer than later, by {}",
        "coefficient of the path while it is at its largest so far, beside that of the motion, over the stiffness",
    ),
}  # fmt: skip


def marks(comparison: Comparison, campaign: Campaign) -> tuple[Mark, ...]:
    """Signatures of the residual of the calibrated linear model on the set *calibrate*.

    Parameters
    ----------
    comparison : Comparison
        Of the base model.
    campaign : Campaign
        Only its experiments are looked at.

    Returns
    -------
    tuple of Mark
        What noise does not explain, least likely by noise first, then what clearly does not change although something fails; empty
        where nothing fails.
    """
    ids = {e.id for e in campaign.of_set("calibrate")}
    found = [s for s in record_signatures(comparison) if s.fit.experiment.id in ids]
    kinds = list(dict.fromkeys(s.fit.experiment.kind for s in found))
    signs: list[Sign] = []
    for kind in kinds:
        own = [s for s in found if s.fit.experiment.kind == kind]
        dof = comparison.noise.of(own[0].fit.experiment, own[0].fit.channel).contrasts
        label = kind if len(kinds) > 1 else ""
        signs += towing_signs(own, comparison, dof, label) if kind == "towing" else _of_kind(own, dof, label)
    tried = sum(not s.told for s in signs)
    sure = [s for s in signs if not s.told and s.chance < CHANCE / max(tried, 1)]
    if not sure:
        return ()
    sure.sort(key=lambda s: s.chance)
    return tuple(s.mark for s in [*sure, *(s for s in signs if s.told)])


def _of_kind(found: Sequence[RecordSignature], dof: int, kind: str) -> list[Sign]:
    loads = [s for s in found if "stiffness" in s.numbers]
    signs = _drift(grouped(loads, "stiffness"), dof, kind) if loads else []
    means = {name: _mean(found, name, dof, kind) for name in _MEANS}
    if means["loop"] is not None:  # which says the same of closed paths
        del means["direction"]
    signs += [sign for sign in means.values() if sign is not None]
    over_rate = _lag_exponent(loads, dof, kind)
    if (
        over_rate and abs(over_rate[0].mark.value + 1) < _A_PHASE
    ):  # the loop of a solid: the mean of such times says nothing
        signs = [s for s in signs if not s.mark.name.startswith("lag")]
    signs += _loop_exponents(loads, dof, kind) + over_rate
    for channel in dict.fromkeys(s.fit.channel for s in found):
        signs += _of_channel([s for s in found if s.fit.channel == channel], channel, dof, kind)
    return signs


def _drift(group: Group | None, dof: int, kind: str) -> list[Sign]:
    """Apparent stiffness over every condition that varies, in percent per doubling or per 10 K."""
    if group is None:
        return []
    slopes = over_conditions(group.value, group.std, group.conditions, dof)
    by_noise = differ(group.value, group.std, dof)
    largest = max((abs(s.slope.value) for s in slopes if s.slope.chance < CHANCE), default=0.0)
    signs = []
    for s in slopes:
        value, std = 100 * s.slope.value, 100 * s.slope.std
        per = "% per 10 K" if s.condition == "temperature" else "% per doubling"
        number = f"{uncertain(value, std, per)}{tie(s)}"
        word = WORDS.get(s.condition, s.condition)
        computed = (
            "slope of the stiffness fitted to each experiment alone, over the common one"
            f"{beside(s)}; std widened by the scatter over {len(group.value)} conditions"
        )
        verb = "rises" if value > 0 else "falls"
        name = f"stiffness over {word}"
        sentence = f"apparent stiffness {verb} with {word}: {number}"
        chance = by_noise if s.slope.chance < CHANCE else 1.0
        signs.append(Sign(mark_of(name, sentence, value, std, computed, kind), chance))
        if s.slope.chance > CHANCE and s.slope.std < _KNOWN_DRIFT * largest and not s.tied:
            sentence = f"apparent stiffness does not depend on {word}: {number}"
            signs.append(Sign(mark_of(name, sentence, value, std, computed, kind), 1.0, told=True))
    return signs


def _mean(found: Sequence[RecordSignature], name: str, dof: int, kind: str) -> Sign | None:
    group, how = grouped(found, name), _MEANS[name]
    slope = None if group is None else average(group, dof)
    if slope is None:
        return None
    value, std = how.factor * slope.value, how.factor * slope.std
    words = how.positive if value > 0 else how.negative
    shown = abs(value) if name not in ("loop", "even") else value
    mark = mark_of(how.name, words.format(uncertain(shown, std, how.unit)), value, std, how.computed, kind)
    return Sign(mark, slope.by_noise)


def _loop_exponents(found: Sequence[RecordSignature], dof: int, kind: str) -> list[Sign]:
    """Power of the loop energy in amplitude, rate and tension, where the loops stand clear of the noise."""
    group = grouped(found, "loop")
    if group is None:
        return []
    sign = np.sign(np.median(group.value))
    clear = sign * group.value > _CLEAR_LOOP * group.std
    if clear.sum() < 3 or clear.sum() < 0.6 * len(clear):
        return []
    conditions = {name: v[clear] for name, v in group.conditions.items() if name != "temperature"}
    energy = np.log2(sign * group.value[clear]) + 2 * np.log2(conditions["amplitude"])
    std = group.std[clear] / (sign * group.value[clear]) / np.log(2)
    signs = []
    for s in over_conditions(energy, std, conditions, dof):
        if s.slope.std > _KNOWN_EXPONENT * (1 if s.condition != "amplitude" else 2):
            continue
        signs.append(Sign(_exponent_mark(s, kind), 1.0, told=True))
    return signs


def _exponent_mark(s: ConditionSlope, kind: str) -> Mark:
    word = WORDS.get(s.condition, s.condition)
    number = f"exponent {uncertain(s.slope.value, s.slope.std)}"
    if s.slope.chance > CHANCE:
        sentence = f"loop energy does not depend on {word}: {number}"
    elif s.condition == "amplitude":
        sentence = f"loop energy grows with amplitude: {number} (2 for every linear damping)"
    else:
        sentence = f"loop energy {'grows' if s.slope.value > 0 else 'falls'} with {word}: {number}"
    computed = f"slope of the logarithm of the loop energy over that of the {word}{beside(s)}"
    return mark_of(f"loop energy over {word}", sentence + tie(s), s.slope.value, s.slope.std, computed, kind)


def _lag_exponent(found: Sequence[RecordSignature], dof: int, kind: str) -> list[Sign]:
    """Whether the lag is a time (exponent 0) or a phase (exponent -1)."""
    group = grouped(found, "lag")
    if group is None:
        return []
    sign = np.sign(np.median(group.value))
    clear = sign * group.value > _CLEAR_LOOP * group.std
    if clear.sum() < 3 or clear.sum() < 0.6 * len(clear):
        return []
    size = sign * group.value[clear]
    conditions = {name: group.conditions[name][clear] for name in ("amplitude", "rate")}
    slopes = over_conditions(np.log2(size), group.std[clear] / size / np.log(2), conditions, dof)
    for s in slopes:
        if s.condition == "rate" and s.slope.std < _KNOWN_EXPONENT:
            value, who = s.slope.value, "lag" if sign > 0 else "lead"
            number = f"exponent {uncertain(value, s.slope.std)}{tie(s)}"
            if abs(value) < max(3 * s.slope.std, 0.1):
                sentence = f"the {who} of the load is the same time at all rates: {number}"
            elif abs(value + 1) < max(3 * s.slope.std, 0.1):
                sentence = f"the {who} of the load is the same phase at all rates, not the same time: {number}"
            else:
                sentence = f"the {who} of the load changes with rate: {number}"
            computed = f"slope of the logarithm of the {who} [s] over that of the rate{beside(s)}"
            return [Sign(mark_of("lag over rate", sentence, value, s.slope.std, computed, kind), 1.0, told=True)]
    return []


def _of_channel(found: Sequence[RecordSignature], channel: str, dof: int, kind: str) -> list[Sign]:
    """Offset and trend of a channel in its own unit, and its answer to the path where the model has none."""
    unit = found[0].fit.unit
    said = {
        "offset": (f"{channel} is off zero by {{}}", unit, "coefficient of a constant in the residual, beside the stiffness"),
        "trend": (f"{channel} drifts by {{}}", f"{unit}/s", "coefficient of time in the residual, beside the stiffness"),
        "cross": (
            f"{channel} moves with the path beside what the model gives: {{}} at the largest path", unit,
            "coefficient of the path in the residual, over the largest path of the record",
        ),
    }  # fmt: skip
    signs = []
    for name, (words, shown, computed) in said.items():
        group = grouped(found, name)
        slope = None if group is None else average(group, dof)
        if slope is None:
            continue
        sentence = words.format(uncertain(slope.value, slope.std, shown))
        mark = mark_of(f"{name} of {channel}", sentence, slope.value, slope.std, computed, kind)
        signs.append(Sign(mark, slope.by_noise))
    return signs

"""Signs in the residual of towing records: what comes after reversals, goes with speed, tension or inclination, ripples or drifts.

The numbers of each record are those of :mod:`compare.towing_signature`; the rule by which one counts is that of
:mod:`compare.localisation`. Every channel speaks for itself: what the bend or the sensor at the towed end does is not seen inside.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from compare.comparison import Comparison
from compare.condition_regression import Slope, differ, fit_line, over_conditions
from compare.findings_sentences import uncertain
from compare.record_signature import RecordSignature, towing_paths
from compare.residual_sign import CHANCE, CLEAR, Group, Sign, average, beside, grouped, mark_of, tie
from compare.towing_signature import AFTER, travel_ripple

_STEEP = math.radians(10.0)
_PERCENT = f"{100 * AFTER:g} %"
_MEANS = {
    "reversal": (
        "after reversals", "N", f"after a reversal the {{channel}} stays behind the model over the first {_PERCENT} of the stroke: {{}}",
        f"after a reversal the {{channel}} is ahead of the model over the first {_PERCENT} of the stroke: {{}}",
        f"coefficient of the sense of the motion over the first {_PERCENT} of the stroke after a reversal, beside that of the whole motion",
    ),
    "speed": (
        "speed", "N s/m", "the {channel} grows with the speed of the drive beside the model: {}",
        "the {channel} falls with the speed of the drive beside the model: {}",
        "coefficient of the told speed in the residual, beside its sense",
    ),
    "offset": (
        "offset", "N", "the {channel} is higher than the model by {}, moving or not",
        "the {channel} is lower than the model by {}, moving or not",
        "coefficient of a constant in the residual, beside the sense of the motion",
    ),
    "trend": (
        "drift", "N/s", "the {channel} drifts up by {}", "the {channel} drifts down by {}",
        "coefficient of time in the residual, beside the sense of the motion",
    ),
}  # fmt: skip


def towing_signs(found: Sequence[RecordSignature], comparison: Comparison, dof: int, kind: str) -> list[Sign]:
    """Signs of every channel.

    Parameters
    ----------
    found : sequence of RecordSignature
        Of towing records.
    comparison : Comparison
        Of the base model.
    dof : int
        From how many values the noise is known.
    kind : str
        Put before every sentence where the campaign has other kinds as well, else empty.
    """
    signs: list[Sign] = []
    for channel in dict.fromkeys(s.fit.channel for s in found):
        own = [s for s in found if s.fit.channel == channel]
        means = [_mean(own, name, channel, dof, kind) for name in _MEANS]
        signs += [s for s in means if s is not None]
        signs += _resistance(grouped(own, "sense"), channel, dof, kind)
        signs += _incline(grouped(own, "offset"), channel, dof, kind)
        signs += _ripple(own, channel, comparison, kind)
    return signs


def _mean(found: Sequence[RecordSignature], name: str, channel: str, dof: int, kind: str) -> Sign | None:
    group = grouped(found, name)
    slope = None if group is None else _agreed(group, dof)
    if slope is None:
        return None
    word, unit, up, down, computed = _MEANS[name]
    behind = slope.value < 0 if name == "reversal" else slope.value > 0
    sentence = (up if behind else down).format(uncertain(abs(slope.value), slope.std, unit), channel=channel)
    return Sign(mark_of(f"{word} ({channel})", sentence, slope.value, slope.std, computed, kind), slope.by_noise)


def _agreed(group: Group, dof: int) -> Slope | None:
    """Mean over the conditions, also where it varies by up to its own size, if those clear of the noise agree on its sign."""
    slope = average(group, dof)
    clear = group.value[np.abs(group.value) > CLEAR * group.std]
    if slope is None or not clear.size or (np.sign(clear) != np.sign(slope.value)).any():
        return slope
    lines = fit_line(group.value, group.std, np.ones((len(group.value), 1)), dof)
    return lines[0] if lines is not None and abs(lines[0].value) > lines[0].std else slope


def _resistance(group: Group | None, channel: str, dof: int, kind: str) -> list[Sign]:
    """Force against the motion that the calibrated friction leaves, over mean tension and speed."""
    if group is None:
        return []
    signs, by_noise = [], differ(group.value, group.std, dof)
    conditions = {name: group.conditions[name] for name in ("mean tension", "speed")}
    for s in over_conditions(group.value, group.std, conditions, dof):
        number = f"{uncertain(s.slope.value, s.slope.std, 'N per doubling')}{tie(s)}"
        verb = "rises" if s.slope.value > 0 else "falls"
        sentence = f"{channel}: resistance to the motion {verb} with {s.condition} beside the model: {number}"
        computed = (
            f"slope of the coefficient of the sense of the motion over the {s.condition}{beside(s)}; std widened by the scatter over "
            f"{len(group.value)} conditions"
        )
        name = f"resistance over {s.condition} ({channel})"
        chance = by_noise if s.slope.chance < CHANCE else 1.0
        signs.append(Sign(mark_of(name, sentence, s.slope.value, s.slope.std, computed, kind), chance))
    return signs


def _incline(group: Group | None, channel: str, dof: int, kind: str) -> list[Sign]:
    """Offset over the sine of the inclination."""
    if group is None or not np.isfinite(group.conditions["inclination"]).all():
        return []
    sine = np.sin(group.conditions["inclination"])
    if np.ptp(sine) < 0.02:
        return []
    lines = fit_line(group.value, group.std, np.column_stack([sine, np.ones(len(sine))]), dof)
    if lines is None:
        return []
    value, std = lines[0].value * math.sin(_STEEP), lines[0].std * math.sin(_STEEP)
    verb = "rises" if value > 0 else "falls"
    sentence = (
        f"the {channel} {verb} with the inclination beside the model: {uncertain(value, std, 'N')} for 10 degrees"
    )
    computed = "slope of the offset of each condition over the sine of its inclination"
    chance = differ(group.value, group.std, dof) if lines[0].chance < CHANCE else 1.0
    return [Sign(mark_of(f"inclination ({channel})", sentence, value, std, computed, kind), chance)]


def _ripple(found: Sequence[RecordSignature], channel: str, comparison: Comparison, kind: str) -> list[Sign]:
    assert comparison.model.towing is not None
    records = towing_paths(comparison, [s.fit for s in found])
    r = travel_ripple(records, comparison.model.towing.presliding)
    if r is None or r.amplitude <= 0:
        return []
    sentence = (
        f"the {channel} ripples over the travel with a period of {r.period:.3g} m: {uncertain(r.amplitude, r.std, 'N')}"
    )
    computed = (
        "largest fall of the square residual by a sine and a cosine of the told position, all records together, against the "
        "median over the periods; root mean square amplitude less what noise alone gives"
    )
    return [Sign(mark_of(f"ripple ({channel})", sentence, r.amplitude, r.std, computed, kind), r.chance)]

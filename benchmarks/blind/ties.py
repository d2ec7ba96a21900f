"""Which effects a design cannot tell apart, and which it cannot show at all, by construction."""

from __future__ import annotations

import numpy as np

from benchmarks.blind.bench import Array, Bench
from benchmarks.blind.designs import varies

_BY_LENGTH = ("end-load-introduction", "rig-compliance")
_HYSTERESIS = ("interlayer-friction", "plasticity")


def untestable(effect: str, bench: Bench, clock: bool, second_channel: bool) -> bool:
    """Whether the design leaves the effect no way to differ from another linear stiffness."""
    if effect in _BY_LENGTH and bench.kind != "bending":
        return not varies(bench, "length")
    if effect == "thermal-softening":
        return not varies(bench, "temperature")
    if effect == "tension-stiffening":
        return bench.kind == "tension" or not varies(bench, "tension")
    if effect in ("viscous-damping", "viscoelasticity", "sensor-drift", "sensor-lag"):
        return not clock
    if effect == "tension-torsion-coupling":
        return not second_channel
    if effect == "direction-asymmetry":
        return bench.kind == "tension"
    return False


def _tied_covariates(bench: Bench, design: str) -> tuple[str, ...]:
    if design != "tied":
        return ()
    if bench.kind == "bending" or (bench.kind == "torsion" and varies(bench, "tension")):
        return ("thermal-softening", "tension-stiffening")
    return ("thermal-softening", *_BY_LENGTH)


def twins(effect: str, bench: Bench, design: str) -> tuple[str, ...]:
    """The set that is the right answer instead of the single name, or () where the name alone is.

    In one-sided tension the grip rises and falls with the strain itself, so that slip and yield differ little: the set
    is right and so is the name. The other sets are ties, see :func:`exactly_tied`.
    """
    tied = _tied_covariates(bench, design)
    if effect in tied:
        return tied
    if effect in _BY_LENGTH:
        return _BY_LENGTH
    one_length = bench.kind == "tension" and not varies(bench, "length")
    if effect in (*_HYSTERESIS, "grip-slip") and one_length:
        return (*_HYSTERESIS, "grip-slip")
    if effect in ("slack", "backlash") and one_length:
        return ("slack", "backlash")
    if effect in _HYSTERESIS and (bench.kind == "tension" or not varies(bench, "tension")):
        return _HYSTERESIS
    return ()


def exactly_tied(effect: str, bench: Bench, design: str) -> bool:
    """Whether no data of this design could ever tell the effect from its twins, so that a single name is a guess."""
    found = twins(effect, bench, design)
    return bool(found) and not (bench.kind == "tension" and effect in (*_HYSTERESIS, "grip-slip", "slack", "backlash"))


def looks_like_a_condition(bench: Bench, load: Array, most: float = 0.65) -> bool:
    """Whether the apparent stiffness of the fitted conditions happens to follow temperature, tension, length or rate.

    With six conditions a stiffness that has another cause may by chance fall with temperature, say, in all of them; a
    campaign of that kind has no right answer, and is drawn anew.
    """
    rows, x = bench.fitted_rows, bench.strain * bench.mask
    weight = np.sum(x**2, axis=1)
    slope = np.sum(load * x, axis=1) / weight

    def correlation(a: Array, b: Array) -> float:
        w = weight[rows] / weight[rows].sum()
        u, v = (c[rows] - np.sum(w * c[rows]) for c in (a, b))
        return float(np.sum(w * u * v) / np.sqrt(np.sum(w * u**2) * np.sum(w * v**2) + 1e-30))

    if np.ptp(slope[rows]) < 0.01 * abs(slope.mean()):
        return False
    rising = (-bench.temperature, bench.tension, bench.length, bench.frequency)
    for condition in rising:
        levels = np.unique(condition[rows])
        shapes = [condition, np.sign(condition) * np.sqrt(np.abs(condition)), -1 / np.fmax(np.abs(condition), 1e-9)]
        shapes += [(condition >= level).astype(float) for level in levels[1:]]
        if len(levels) > 1 and max(correlation(slope, np.asarray(s, dtype=float)) for s in shapes) > most:
            return True
    return False

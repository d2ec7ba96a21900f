"""Suggest and do: the towing experiment that `explain` proposes is made by the generator and added to the campaign.

The control is a random experiment of the same cost, as :mod:`compare.next_towing` counts it: 1 for an inclination and 1 for
a tail tension beyond what was tested, 0.5 for another speed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from benchmarks.blind_towing.generator import Condition, TowingCampaign
from benchmarks.blind_towing.motion import to_and_fro

SPEED, SLOPE, TAIL = "speed [m/s]", "inclination [deg]", "tail tension [N]"
_STEEPER, _SLOWER, _FASTER = 8.0, 0.25, 2.0


def done(made: TowingCampaign, conditions: Mapping[str, float]) -> TowingCampaign:
    """The campaign with one more condition to calibrate, given as in experiments.csv."""
    v, slope, tail = (conditions[k] for k in (SPEED, SLOPE, TAIL))
    motion = to_and_fro(v, made.case.duration)
    return made.also(Condition(motion, math.radians(slope), tail, v))


def at_random(rng: np.random.Generator, made: TowingCampaign, conditions: Mapping[str, float]) -> dict[str, float]:
    """An experiment of the same cost as the proposed one.

    As many of inclination and tail tension as there go beyond what was tested, drawn at random, by up to 8 degrees and up to the
    double; the others are drawn within what was tested. The speed is one that was driven, or if the proposed one is not, any from a
    quarter to the double of the largest.
    """
    slopes = [round(math.degrees(c.slope), 6) for c in made.conditions]
    tails = [c.tail for c in made.conditions]
    speeds = [c.speed for c in made.conditions]
    beyond = [conditions[SLOPE] > max(slopes) + 1e-6, conditions[TAIL] > 1.001 * max(tails)]
    moved = [beyond[i] for i in rng.permutation(2)]
    slope = max(slopes) + _STEEPER * rng.uniform(0.2, 1.0) if moved[0] else rng.uniform(min(slopes), max(slopes))
    tail = max(tails) * rng.uniform(1.2, 2.0) if moved[1] else rng.uniform(min(tails), max(tails))
    if min(abs(conditions[SPEED] / v - 1) for v in speeds) < 0.02:
        speed = rng.choice(speeds)
    else:
        speed = max(speeds) * np.exp(rng.uniform(math.log(_SLOWER), math.log(_FASTER)))
    return {SPEED: round(float(speed), 4), SLOPE: round(float(slope), 3), TAIL: round(float(tail), 1)}

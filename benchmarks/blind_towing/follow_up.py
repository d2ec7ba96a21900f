"""Suggest and do: the towing experiment that `explain` proposes is made by the generator and added to the campaign."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from benchmarks.blind_towing.generator import Condition, TowingCampaign
from benchmarks.blind_towing.motion import to_and_fro


def done(made: TowingCampaign, conditions: Mapping[str, float]) -> TowingCampaign:
    """The campaign with one more condition to calibrate, given as in experiments.csv."""
    v, slope, tail = (conditions[k] for k in ("speed [m/s]", "inclination [deg]", "tail tension [N]"))
    motion = to_and_fro(v, made.case.duration)
    return made.also(Condition(motion, math.radians(slope), tail, v))


def at_random(rng: np.random.Generator, made: TowingCampaign, conditions: Mapping[str, float]) -> dict[str, float]:
    """An experiment of the same cost as the proposed one, which changes one thing: here the tail tension, at a speed that was driven."""
    speed = float(rng.choice([c.speed for c in made.conditions]))
    slope = math.degrees(made.conditions[0].slope)
    return {
        "speed [m/s]": speed,
        "inclination [deg]": slope,
        "tail tension [N]": 2 * max(c.tail for c in made.conditions),
    }

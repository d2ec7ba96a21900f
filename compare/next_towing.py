"""Towing experiments within reach, from which the one is chosen that separates rivals (:mod:`compare.next_experiment`).

The record with the longest travel is done again at another speed, inclination and tail tension; where no record turns back,
also with the way back behind it.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from compare.bench_design import Block
from compare.bench_path import LedPath
from compare.experiment import Channel, Experiment, Record
from compare.next_experiment import Proposal
from compare.towing_design import TowingRecord, towing_record
from compare.towing_setup import towing_path
from effects.towed_cable import largest_speed, turns_back

_SPEEDS = (1.0, 0.25, 2.0)
_STEEPER = math.radians(8.0)
_FASTEST = 1.5  # m/s: what a cable handler may be asked for


def towing_proposals(block: Block) -> Iterator[Proposal]:
    """Speeds, inclinations and tail tensions that were driven, and one step beyond; the conditions as in experiments.csv."""
    records = [r for r in block.records if isinstance(r, TowingRecord)]
    template = max(records, key=lambda r: float(np.ptp(r.led.path.strain)))
    setup = template.response.setup
    slopes = sorted({r.experiment.conditions.get("inclination", setup.inclination or 0.0) for r in records})
    tails = sorted({r.experiment.conditions.get("tail tension", setup.tail_tension or 0.0) for r in records})
    returns = (False,) if any(turns_back(r.led.path) for r in records) else (False, True)
    fastest = largest_speed(template.led.path)
    choices = itertools.product(
        [s for s in _SPEEDS if s * fastest <= max(_FASTEST, fastest)],
        sorted({slopes[0], slopes[-1], slopes[-1] + _STEEPER}),
        sorted({tails[0], tails[-1], 2 * tails[-1]}),
        returns,
    )
    for faster, slope, tail, back in choices:
        cost = 0.5 * (faster != 1) + float(slope > slopes[-1]) + float(tail > tails[-1]) + 0.5 * back
        yield _proposal(template, faster, slope, tail, back, cost)


def _proposal(template: TowingRecord, faster: float, slope: float, tail: float, back: bool, cost: float) -> Proposal:
    old = template.experiment
    path = template.led.path
    assert path.time is not None
    time, position = path.time / faster, path.strain
    if back:
        time = np.concatenate([time, time[-1] + time[-1] - time[-2::-1]])
        position = np.concatenate([position, position[-2::-1]])
    speed = faster * largest_speed(path)
    words = f"a largest speed of {speed:.3g} m/s, inclination {math.degrees(slope):.3g} deg, tail tension {tail:.4g} N"
    conditions = {
        "speed [m/s]": float(f"{speed:.3g}"),
        "inclination [deg]": round(math.degrees(slope), 6),
        "tail tension [N]": round(tail, 6),
    }
    channels = {
        name: replace(c, values=np.zeros(len(time)))
        for name, c in old.record.channels.items()
        if name in old.record.measured
    }
    channels["position"] = Channel("position", "m", position)
    experiment = Experiment(
        id=f"proposed: {words}{', there and back' if back else ''}",
        kind="towing", file="proposal", specimen=old.specimen, set="calibrate",
        conditions={**old.conditions, "inclination": slope, "tail tension": tail, "speed": speed},
        table=Record(time, "position", old.record.measured, channels),
    )  # fmt: skip
    new = towing_path(experiment, template.response.setup)
    led = LedPath(replace(new, largest=path.largest))
    record = towing_record(experiment, led, template.response, template.readings)
    return Proposal(new, conditions, words + (", there and back" if back else ""), cost, record)

"""A curve in a scenario file: times and speeds or displacements, with its status and source.

``{ time = ["0 s", "2 s"], speed = ["0 m/min", "6 m/min"], status = "deduced", source = "log of the shearer" }``; `displacement` in
place of `speed` for a table of ways. What is between the rows is in :mod:`beam.motion_curve`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from pydantic import BeforeValidator

from beam.motion_curve import MotionCurve
from beam.scenario_entry import STATUSES, Entry
from geometry.errors import SpecError
from geometry.units import read_quantity

UNITS = {"speed": "m/s", "displacement": "m"}
KEYS = ("time", *UNITS, "status", "source")


@dataclass(frozen=True)
class CurveEntry(Entry):
    """An entry whose `value` is the largest of a table; `motion` is the motion after it."""

    motion: MotionCurve | None = None


def read_curve(raw: object) -> Entry:
    """Entry from the table in a file.

    Raises
    ------
    SpecError
        With the reason, without the place (the caller knows it).

    Examples
    --------
    >>> raw = {"time": ["0 s", "2 s"], "speed": ["0 m/s", "0.1 m/s"], "status": "deduced", "source": "log"}
    >>> read_curve(raw).value
    0.1
    """
    if isinstance(raw, CurveEntry):
        return raw
    if isinstance(raw, dict) and set(raw) == {"value", "status", "source"}:  # set for one run
        raw = (
            {**raw["value"], "status": raw["status"], "source": raw["source"]}
            if isinstance(raw["value"], dict)
            else None
        )
    if not isinstance(raw, dict):
        raise SpecError(
            'write it as a table: { time = ["0 s", "2 s"], speed = ["0 m/s", "0.1 m/s"], status = ..., source = ... }.'
        )
    unknown = sorted(set(raw) - set(KEYS))
    kinds = [kind for kind in UNITS if kind in raw]
    if unknown or len(kinds) != 1:
        what = f"unknown key {unknown[0]!r}" if unknown else "it needs either speed or displacement"
        raise SpecError(f"{what}; a curve has the keys time, speed or displacement, status and source.")
    for key in ("time", "status", "source"):
        if not raw.get(key):
            raise SpecError(f"the key {key!r} is missing; a curve states time, {kinds[0]}, status and source.")
    if raw["status"] not in STATUSES:
        raise SpecError(f"status {raw['status']!r} is not one of {', '.join(STATUSES)}.")
    kind, unit = kinds[0], UNITS[kinds[0]]
    if not all(isinstance(raw[key], list) for key in ("time", kind)):
        raise SpecError(f"time and {kind} of a curve are lists of the same length.")
    times = tuple(read_quantity(x, "s", "time") for x in raw["time"])
    values = tuple(read_quantity(x, unit, kind) for x in raw[kind])
    motion = MotionCurve(times, values, kind)
    text = f"curve of {kind} with {len(times)} rows"
    return CurveEntry(float(np.max(values)), unit, text, raw["status"], str(raw["source"]), None, motion)


tabulated = BeforeValidator(read_curve)

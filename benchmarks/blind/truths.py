"""All truths by name: those of the contract's bench list, and those outside every library."""

from __future__ import annotations

from benchmarks.blind import (
    truths_elastic,
    truths_hysteresis,
    truths_outside,
    truths_rate,
    truths_sensor,
    truths_specimen,
)
from benchmarks.blind.truth import Truth

LIBRARY: dict[str, type[Truth]] = {
    t.effect: t
    for module in (truths_hysteresis, truths_rate, truths_elastic, truths_specimen, truths_sensor)
    for t in module.TRUTHS
}
OUTSIDE: dict[str, type[Truth]] = {t.effect: t for t in truths_outside.TRUTHS}
ALL = {**LIBRARY, **OUTSIDE}

"""Traffic lights of the page of `helicable explain`: what is good, what to mind, what fails, and the word for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from compare.findings import Findings, SetError
from compare.findings_sentences import VERDICTS

_AT_THE_FLOOR, _NEAR_THE_FLOOR = 1.1, 1.5


@dataclass(frozen=True)
class Light:
    """A traffic light that needs no colour: circle, triangle or square, and a word."""

    level: Literal["good", "mind", "bad"]
    word: str


def error_light(error: float | None) -> Light:
    """Light of an error over the noise floor."""
    if error is None:
        return Light("mind", "not compared")
    if error <= _AT_THE_FLOOR:
        return Light("good", "at the noise floor")
    return Light("mind", "near the floor") if error <= _NEAR_THE_FLOOR else Light("bad", f"{error:.3g} x the floor")


def verdict_light(findings: Findings) -> Light:
    """Light of the verdict."""
    if findings.verdict in ("none", "identified"):
        return Light("mind", "noise assumed") if findings.noise_assumed else Light("good", VERDICTS[findings.verdict])
    return Light("bad" if findings.verdict == "unknown" else "mind", VERDICTS[findings.verdict])


def held_out_light(errors: Mapping[str, SetError]) -> Light:
    """Light of the proof on data that were not fitted."""
    words = [errors[name].confirmed for name in ("sealed", "validate") if name in errors]
    if False in words:
        return Light("bad", "not confirmed")
    if True in words:
        return Light("good", "confirmed")
    if any(e.ratio is not None for e in errors.values()):
        return Light("mind", "too few to confirm")
    return Light("mind", "nothing to confirm" if words else "no held-out data")

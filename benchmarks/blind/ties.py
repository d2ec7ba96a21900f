"""Which effects a design cannot tell apart, and which it cannot show at all, by construction."""

from __future__ import annotations

from benchmarks.blind.bench import Bench
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
    """The set that is the right answer instead of the single name, or () where the name alone is."""
    tied = _tied_covariates(bench, design)
    if effect in tied:
        return tied
    if effect in _BY_LENGTH:
        return _BY_LENGTH
    if effect in _HYSTERESIS and bench.kind != "tension" and not varies(bench, "tension"):
        return _HYSTERESIS
    if not varies(bench, "length") and bench.kind in ("tension", "torsion"):
        if effect in ("slack", "backlash") and bench.kind == "tension":
            return ("slack", "backlash")
        if effect == "grip-slip":
            return ("grip-slip", "plasticity") + (("interlayer-friction",) if not varies(bench, "tension") else ())
    return ()

"""From a seed to a case: every second one is a null, the others go round the effects, pairs, ties and outsiders.

Tuning seeds and score seeds are two ranges without a common number.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchmarks.blind.noise import KINDS
from benchmarks.blind.truths import LIBRARY, OUTSIDE

TUNING = range(0, 1_000_000)
SCORE = range(1_000_000, 2_000_000)
RANGES = {"tuning": TUNING, "score": SCORE}
STRENGTHS = (0.01, 0.02, 0.05, 0.10)
SIZES = (0.005, 0.01, 0.02, 0.05)
PAIRS = (
    ("interlayer-friction", "viscous-damping"), ("interlayer-friction", "stiffening"),
    ("interlayer-friction", "thermal-softening"), ("interlayer-friction", "sensor-offset"),
    ("interlayer-friction", "tension-stiffening"), ("viscoelasticity", "stiffening"), ("plasticity", "slack"),
    ("slack", "thermal-softening"), ("viscoelasticity", "sensor-drift"), ("stiffening", "sensor-lag"),
    ("direction-asymmetry", "thermal-softening"), ("cyclic-softening", "sensor-offset"), ("backlash", "viscoelasticity"),
    ("tension-torsion-coupling", "slack"), ("grip-slip", "viscous-damping"), ("thermal-softening", "stiffening"),
)  # fmt: skip
"""Two effects that a rich design separates."""
_TIES = (
    ("interlayer-friction", "one-tension"), ("end-load-introduction", "rich"), ("rig-compliance", "rich"),
    ("plasticity", "one-tension"), ("thermal-softening", "tied"), ("interlayer-friction", "amplitude-only"),
    ("rig-compliance", "amplitude-rate"), ("slack", "one-length"), ("end-load-introduction", "one-temperature"),
    ("plasticity", "amplitude-only"), ("tension-stiffening", "tied"), ("backlash", "one-length"), ("grip-slip", "one-length"),
    ("interlayer-friction", "rich"), ("plasticity", "rich"),
)  # fmt: skip
_UNTESTABLE = (
    ("thermal-softening", "one-temperature"), ("tension-stiffening", "one-tension"), ("rig-compliance", "one-length"),
    ("end-load-introduction", "amplitude-only"), ("thermal-softening", "amplitude-only"),
)  # fmt: skip
_SLOTS = ("single",) * 10 + ("tie",) * 3 + ("outside",) * 3 + ("pair",) * 3 + ("untestable",)
_SINGLE = tuple(name for name in LIBRARY if name not in ("end-load-introduction", "rig-compliance"))
_RATE_FREE = (
    "interlayer-friction", "plasticity", "stiffening", "slack", "cyclic-softening", "direction-asymmetry", "backlash",
    "thermal-softening", "tension-stiffening", "sensor-offset", "grip-slip",
)  # fmt: skip
_UNDER_LOAD = (
    "stiffening",
    "viscoelasticity",
    "plasticity",
    "thermal-softening",
    "sensor-offset",
    "interlayer-friction",
)
_IN_SHEAR = ("interlayer-friction", "plasticity", "stiffening", "sensor-offset", "viscoelasticity")
_DESIGN_SHARES = (("rich", 0.55), ("amplitude-only", 0.14), ("amplitude-rate", 0.14), ("one-temperature", 0.05),
                  ("no-clock", 0.06), ("load-controlled", 0.06))  # fmt: skip


@dataclass(frozen=True)
class Case:
    """What to make: `group` is null, single, tie, outside, pair or untestable; None means drawn at random."""

    seed: int
    group: str
    effects: tuple[str, ...]
    design: str | None
    noise: str
    size: float
    strength: float
    kind: str | None = None
    variants: tuple[str | None, ...] = ()
    two_kinds: bool | None = None

    def but(self, **changes: Any) -> Case:
        """The same case with some things set by hand."""
        if "effects" in changes and "group" not in changes:
            names = tuple(changes["effects"])
            outside = any(name in OUTSIDE for name in names)
            changes["group"] = "null" if not names else "outside" if outside else "pair" if len(names) > 1 else "single"
            changes.setdefault("variants", ())
        return replace(self, **changes)


def case_of(seed: int) -> Case:
    """The case of a seed.

    Raises
    ------
    ValueError
        If the seed is in neither range.
    """
    base = next((r.start for r in RANGES.values() if seed in r), None)
    if base is None:
        raise ValueError(f"seed {seed} is in neither range: tuning {TUNING}, score {SCORE}.")
    rng = np.random.default_rng([977, seed])
    p = seed - base
    half = p // 2
    noise = KINDS[half % len(KINDS)] if p % 2 == 0 else str(rng.choice(KINDS))
    size = SIZES[(half // len(KINDS)) % 4] if p % 2 == 0 else float(rng.choice(SIZES))
    strength = float(rng.choice(STRENGTHS))
    if p % 2 == 0:
        return Case(seed, "null", (), _any_design(rng), noise, size, 0.0)
    slot, lap = half % len(_SLOTS), half // len(_SLOTS)
    group = _SLOTS[slot]
    k = lap * _SLOTS.count(group) + slot - _SLOTS.index(group)
    if group == "single":
        return Case(seed, group, (_SINGLE[k % len(_SINGLE)],), None, noise, size, strength)
    if group == "tie":
        effect, design = _TIES[k % len(_TIES)]
        return Case(seed, group, (effect,), design, noise, size, strength, two_kinds=False)
    if group == "untestable":
        effect, design = _UNTESTABLE[k % len(_UNTESTABLE)]
        variants = ("linear",) if effect == "rig-compliance" else ()  # a hardening frame shows at one length, too
        return Case(seed, group, (effect,), design, noise, size, strength, variants=variants, two_kinds=False)
    if group == "outside":
        return Case(
            seed, group, (list(OUTSIDE)[k % len(OUTSIDE)],), "rich", noise, size, max(strength, 0.05), two_kinds=False
        )
    size = min(size, 0.02)
    return Case(
        seed, group, PAIRS[k % len(PAIRS)], "rich", noise, size, float(rng.choice([0.05, 0.10])), two_kinds=False
    )


def _any_design(rng: np.random.Generator) -> str:
    names, shares = zip(*_DESIGN_SHARES, strict=True)
    return str(rng.choice(names, p=np.array(shares) / sum(shares)))


def possible_kinds(effects: tuple[str, ...], design: str) -> list[str]:
    """Kinds of experiment in which all the effects can act under that design."""
    kinds = ["tension", "torsion", "bending"]
    for name in effects:
        kinds = [k for k in kinds if k in {**LIBRARY, **OUTSIDE}[name].kinds]
    if design == "one-tension" or (design == "tied" and "tension-stiffening" in effects):
        kinds = [k for k in kinds if k != "tension"]
    if design == "one-length":
        kinds = [k for k in kinds if k != "bending"]
    if "direction-asymmetry" in effects:
        kinds = [k for k in kinds if k != "tension"]
    return kinds


def draw_design(rng: np.random.Generator, effects: tuple[str, ...]) -> str:
    """A design in which a single effect can act at all."""
    while True:
        design = _any_design(rng)
        if design == "no-clock" and not set(effects) <= set(_RATE_FREE):
            continue
        if design == "load-controlled" and not set(effects) <= set(_UNDER_LOAD):
            continue
        return design


def may_shear(effects: tuple[str, ...], design: str) -> bool:
    """Whether the case can be a cantilever test instead."""
    return set(effects) <= set(_IN_SHEAR) and design in ("rich", "amplitude-only", "amplitude-rate")

"""Makes one hidden-effect towing campaign from a seed: a folder, and a label that never goes there.

>>> from benchmarks.blind_towing.generator import Case, label, make
>>> make(Case(7), "out/towing-7")                                                  # doctest: +SKIP
>>> label(Case(7, ("added-load",)))["effects"]                                       # doctest: +SKIP
['added-load']
"""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.blind.noise import Noise
from benchmarks.blind_towing.folder import write_folder
from benchmarks.blind_towing.motion import Motion, to_and_fro
from benchmarks.blind_towing.rivals import rivals, twins
from benchmarks.blind_towing.towed_line import Line, rest_tension, tow
from benchmarks.blind_towing.truths import LIBRARY, OUTSIDE, Hidden, Truth, combined, draw

Array = NDArray[np.float64]
PAIRS = (
    ("trough-friction-stribeck", "viscous-drag"), ("added-load", "polygon-effect"), ("roller-resistance", "sensor-drift"),
    ("trough-friction-stribeck", "added-load"), ("viscous-drag", "clamp-backlash"),
)  # fmt: skip
NOISES = ("white", "ar", "heavy-tail", "scatter")
_SLOTS = ("single",) * 6 + ("null",) * 3 + ("outside", "pair")
_STEP = 2e-3  # s: the largest time step of the line


@dataclass(frozen=True)
class Condition:
    """One experiment: drive, inclination [rad], tail tension [N], nominal speed [m/s] and set."""

    motion: Motion = field(repr=False)
    slope: float
    tail: float
    speed: float
    purpose: str = "calibrate"


@dataclass(frozen=True)
class Case:
    """A campaign to be made; what is left out is drawn from the seed.

    `share` is the part of the tension (rms, without tail tension and weight) that no friction coefficient can absorb; `inside` says
    whether a second tension is read at a station of the cable.
    """

    seed: int
    effects: tuple[str, ...] | None = None
    variants: tuple[str, ...] = ()
    share: float | None = None
    noise: str | None = None
    noise_size: float | None = None
    conditions: tuple[tuple[float, float, float, str], ...] | None = None
    samples: int = 181
    duration: float = 18.0
    inside: bool = True


class TowingCampaign:
    """All that is true of one case; what is dear is worked out once."""

    def __init__(self, case: Case) -> None:
        self.case = case
        rng = np.random.default_rng([90210, case.seed])
        self.line = Line(
            length=round(float(rng.uniform(25, 60)), 1),
            EA=round(float(rng.uniform(2.5e5, 6e5)), -3),
            mass=round(float(rng.uniform(3.5, 6.0)), 2),
            friction=float(rng.uniform(0.25, 0.45)),
            damping_ratio=0.1,
            presliding=round(float(rng.uniform(2e-4, 4e-4)), 5),
        )
        group = _SLOTS[case.seed % len(_SLOTS)]
        self.names = case.effects if case.effects is not None else _drawn_names(rng, case.seed, group)
        self.group = _group_of(self.names)
        self.noise_kind = case.noise or str(rng.choice(NOISES))
        size = case.noise_size or float(rng.choice([0.005, 0.01, 0.02]))
        scatter = (0.004, 0.004) if self.noise_kind == "scatter" else (0.0, 0.0)
        self.noise = Noise(self.noise_kind, size, *scatter)
        self.share = case.share or float(rng.choice([0.03, 0.06, 0.12]))
        self.t = np.round(np.linspace(0.0, case.duration, case.samples), 9)
        station = round(self.line.length * float(rng.uniform(0.3, 0.7)))
        self.stations = (station,) if case.inside else ()
        self.conditions = tuple(self._conditions(rng))
        variants = (*case.variants, *[None] * len(self.names))
        drawn = [draw(rng, name, variants[i]) for i, name in enumerate(self.names)]
        self.nominal = float(rng.uniform(0.85, 1.15))
        self.truths = [self._of_share(one) for one in drawn]

    def _conditions(self, rng: np.random.Generator) -> list[Condition]:
        plan = self.case.conditions or _plan(rng)
        return [Condition(to_and_fro(v, self.case.duration), math.radians(i), N, v, p) for v, i, N, p in plan]

    def clean(self, hidden: Hidden, friction: float | None = None, conditions: tuple[Condition, ...] = ()) -> Array:
        """Readings without noise (records, channels, samples)."""
        line = self.line if friction is None else replace(self.line, friction=friction)
        return self.towed(line, hidden, conditions or self.conditions)

    def towed(self, line: Line, hidden: Hidden, conditions: Sequence[Condition], step: float = _STEP) -> Array:
        """The same for another line, in time steps of at most `step` [s]."""
        substeps = math.ceil((self.t[1] - self.t[0]) / step)
        y = tow(line, [hidden.drive(c.motion) for c in conditions], [c.slope for c in conditions],
                [c.tail for c in conditions], hidden.trough, self.t, self.stations, substeps)  # fmt: skip
        return np.array([hidden.reading(self.t, c.motion(self.t)[0], r) for c, r in zip(conditions, y, strict=True)])

    @cached_property
    def plain(self) -> tuple[Array, Array]:
        """Readings with nothing hidden, and their derivative with respect to the friction coefficient."""
        mu = self.line.friction
        y = self.clean(Hidden())
        return y, (self.clean(Hidden(), 1.02 * mu) - y) / (0.02 * mu)

    def also(self, *conditions: Condition) -> TowingCampaign:
        """The same line with the same truth and further experiments."""
        more = copy.copy(self)
        for kept in ("plain", "at_rest", "readings"):
            more.__dict__.pop(kept, None)
        more.conditions = (*self.conditions, *conditions)
        return more

    @property
    def unit(self) -> Array:
        """Rms of the tension that motion makes, per channel (channels,), records that are open."""
        return np.sqrt(np.mean((self.plain[0] - self.at_rest)[self.open_rows] ** 2, axis=(0, 2)))

    @cached_property
    def at_rest(self) -> Array:
        at = np.array([0.0, *self.stations])
        return np.array([rest_tension(self.line, 0.0, c.slope, c.tail, at) for c in self.conditions])[:, :, None]

    @property
    def open_rows(self) -> NDArray[np.bool_]:
        return np.array([c.purpose != "sealed" for c in self.conditions])

    def _left(self, y: Array) -> float:
        """Part of the tension that no friction coefficient absorbs."""
        rows, (base, slope) = self.open_rows, self.plain
        e, g = ((x[rows] / self.unit[:, None]).ravel() for x in (y - base, slope))
        return float(np.sqrt(np.mean((e - g * (g @ e) / (g @ g)) ** 2)))

    def _of_share(self, truth: Truth) -> Truth:
        for _ in range(3):
            found = self._left(self.clean(truth.hidden(self.line)))
            if abs(found / self.share - 1) < 0.1:
                break
            truth = truth.of_size(float(np.clip(truth.size * self.share / found, 0.1 * truth.size, 4.0)))
        return truth

    @cached_property
    def hidden(self) -> Hidden:
        return combined([one.hidden(self.line) for one in self.truths])

    @cached_property
    def readings(self) -> Array:
        return self.clean(self.hidden) if self.truths else self.plain[0]

    def distance(self) -> float:
        """From the best line without the truth, in units of the noise; records to calibrate and their repeats."""
        base, slope = self.plain
        pieces = []
        for r, condition in enumerate(self.conditions):
            if condition.purpose == "calibrate":
                for k, rms in enumerate(self.unit):
                    clean = self.readings[r, k] - self.at_rest[r, k]
                    columns = np.column_stack([slope[r, k], self.readings[r, k] - base[r, k]])
                    pieces.append(self.noise.whiten(columns, clean, float(rms)))
        g, e = np.vstack(pieces).T
        return float(np.sqrt(2) * np.linalg.norm(e - g * (g @ e) / (g @ g)))

    def noisy(self, rng: np.random.Generator, clean: Array, at_rest: Array) -> Array:
        """One record (channels, samples) as the sensors give it."""
        return np.array(
            [y + self.noise.draw(rng, y - r, float(s)) for y, r, s in zip(clean, at_rest, self.unit, strict=True)]
        )


def _drawn_names(rng: np.random.Generator, seed: int, group: str) -> tuple[str, ...]:
    turn = seed // len(_SLOTS)
    if group == "pair":
        return PAIRS[turn % len(PAIRS)]
    if group == "single":
        place = turn * _SLOTS.count("single") + seed % len(_SLOTS)
        return (list(LIBRARY)[place % len(LIBRARY)],)
    return (list(OUTSIDE)[turn % len(OUTSIDE)],) if group == "outside" else ()


def _group_of(names: tuple[str, ...]) -> str:
    if not names:
        return "null"
    if set(names) & set(OUTSIDE):
        return "outside"
    return "single" if len(names) == 1 else "pair"


def _plan(rng: np.random.Generator) -> tuple[tuple[float, float, float, str], ...]:
    """Four conditions to calibrate, one to validate, one sealed: speed m/s, inclination deg, tail tension N, set."""
    tail = round(float(rng.uniform(800, 1200)), -1)
    steep = float(rng.choice([8, 10, 12]))
    rows = [(0.1, 0, tail), (0.3, steep, tail), (0.6, 0, 1.5 * tail), (0.12, steep, 1.5 * tail)]
    rest = [(0.45, steep / 2, tail, "validate"), (0.85, 15.0, tail, "sealed")]
    return (*((float(v), float(i), float(N), "calibrate") for v, i, N in rows), *rest)


def label_of(made: TowingCampaign, library: Sequence[str] = ()) -> dict[str, Any]:
    """What is true of a campaign, for the score only; the keys that :mod:`benchmarks.blind.judge` asks for.

    `library` names the effects that may be rivals of the truth; all by default. `apart` is the distance of the nearest of them,
    `twins` are those that are closer than :data:`benchmarks.blind.judge.CLOSE` (:mod:`benchmarks.blind_towing.rivals`).
    """
    D = made.distance() if made.truths else 0.0
    near = rivals(made, library) if made.group == "single" else {}
    rival = min(near, key=lambda name: near[name], default="")
    count = 2 * sum(c.purpose == "calibrate" for c in made.conditions) * made.case.samples * (1 + len(made.stations))
    return {
        "seed": made.case.seed, "group": made.group, "effects": list(made.names), "kind": "towing",
        "variants": [t.variant for t in made.truths], "sizes": [round(t.size, 4) for t in made.truths],
        "design": "rich" if made.case.conditions is None else "given", "noise": made.noise_kind, "size": made.noise.size,
        "strength": made.share, "D": round(D, 2), "D_alone": [round(D, 2)] * len(made.truths),
        "F0": round(1 + D**2 / count, 3), "untestable": [], "twins": twins(near), "tied": [], "rival": rival,
        "apart": round(min(D, near.get(rival, math.inf)), 2) if made.truths else math.inf,
    }  # fmt: skip


def label(case: Case, library: Sequence[str] = ()) -> dict[str, Any]:
    """The label of a case."""
    return label_of(TowingCampaign(case), library)


def records_of(made: TowingCampaign, rng: np.random.Generator) -> list[tuple[Condition, Array]]:
    """Every condition twice, condition after condition: told motion and noisy readings."""
    out = []
    for r, condition in enumerate(made.conditions):
        out += [(condition, made.noisy(rng, made.readings[r], made.at_rest[r])) for _ in range(2)]
    return out


def make(case: Case | TowingCampaign, folder: str | Path) -> Path:
    """Write the campaign of a case; nothing in the folder tells the truth."""
    made = case if isinstance(case, TowingCampaign) else TowingCampaign(case)
    rng = np.random.default_rng([555, made.case.seed])
    nominal = made.nominal * made.line.friction
    path = Path(folder)
    write_folder(path, made.line, nominal, made.t, made.stations, records_of(made, rng))
    return path

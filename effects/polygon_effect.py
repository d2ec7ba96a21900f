r"""Speed ripple of a round-link chain on its sprocket, at the frequency at which pockets pass.

.. math::  v_\text{true} = v\,\Bigl[1 + \sum_m (A_m \cos m\theta - B_m \sin m\theta)\Bigr], \qquad \theta = 2\pi x/\lambda

x is the told travel and lambda the travel from pocket to pocket, so that the frequency is v/lambda. A chain on z pockets runs
between R and R cos(pi/z), a ripple of about pi^2/(4 z^2) to either side, whose second harmonic is a quarter of the first
(:mod:`beam.polygon_effect` has the series). Plain form: one harmonic; richer: two, each free in size and phase. The told
position does not know of it. In a scenario of the rod the chain drives the trolley: x is the trolley's travel (:mod:`beam.speed_ripple`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from beam.speed_ripple import rippled
from effects.effect import Array, BenchPath, Effect, Form, Parameter, Starts
from effects.sensor_drift import needs_clock
from effects.towed_cable import TowedCable
from effects.towed_scenario import TowedScenario, needs_trolley, si
from geometry.errors import SpecError

_SHORTEST, _LONGEST, _MOST = 0.04, 0.4, 60


def _harmonics(strength: Sequence[float]) -> list[tuple[float, float]]:
    return [(float(A), float(B)) for A, B in zip(strength[::2], strength[1::2], strict=True)]


def _act(cable: TowedCable, strength: Sequence[float], pitch: float) -> TowedCable:
    parts = _harmonics(strength)
    speed = float(np.abs(np.diff(cable.position) / np.diff(cable.time)).max())

    def drive(t: Array, motion: Array) -> Array:
        return rippled(motion, pitch, parts)

    if speed == 0 or not any(strength):
        return cable
    return cable.driven(drive, pitch / (speed * len(parts)))


def _trolley(towed: TowedScenario, strength: Sequence[float], pitch: float) -> TowedScenario:
    needs_trolley(towed.scenario, "which a chain could drive")
    if towed.scenario.drive.ripple_travel is not None:
        raise SpecError("the scenario has a drive.ripple_travel already; leave it out, or the effect")
    parts = _harmonics(strength)
    keys = ("ripple_cosine", "ripple_sine", "ripple_cosine_2", "ripple_sine_2")
    values: dict[str, object] = {f"drive__{key}": float(v) for key, v in zip(keys, strength, strict=False)}
    size = ", ".join(f"{100 * math.hypot(A, B):.3g} %" for A, B in parts)
    return towed.changed(
        f"polygon-effect: drive.ripple_cosine, ..._sine: the trolley's speed ripples by {size} once every {1e3 * pitch:.4g} mm of its way",
        drive__ripple_travel=si(pitch, "m"),
        **values,
    )


def _pitches(paths: Sequence[BenchPath]) -> Array:
    """Evenly spaced in 1/travel, half a ripple of the longest record apart, at most so many."""
    longest = max((float(np.ptp(p.strain)) for p in paths), default=0.0)
    m = int(np.clip(2 * longest * (1 / _SHORTEST - 1 / _LONGEST), 6, _MOST))
    return np.sort(1 / np.linspace(1 / _LONGEST, 1 / _SHORTEST, m))


_STARTS: Starts = _pitches


def _part(name: str, meaning: str) -> Parameter:
    return Parameter(
        name, "1", meaning, low=-np.inf, plausible=(-0.2, 0.2),
        source="pi^2/(4 z^2) for 4 to 12 pockets: 2 to 15 %",
    )  # fmt: skip


_SHAPE = (
    Parameter(
        "pocket travel", "m", "travel from pocket to pocket", low=1e-3, plausible=(0.03, 0.6),
        source="round-link chains of ISO 610, pitch 50 to 152 mm, one or two pitches a pocket", starts=_STARTS,
    ),
)  # fmt: skip
_FIRST = (_part("cosine part", "ripple in phase with the start"), _part("sine part", "ripple a quarter later"))
_SECOND = (
    _part("second cosine part", "ripple twice a pocket, in phase with the start"),
    _part("second sine part", "ripple twice a pocket, a quarter later"),
)

EFFECT = Effect(
    name="polygon-effect",
    kind="physics",
    title="speed ripple of the round-link chain at pocket-passing frequency",
    equation="v_true = v (1 + A cos(2 pi x/lambda) - B sin(2 pi x/lambda))",
    source="chain drives, e.g. Fuglede & Thomsen, Mech. Mach. Theory 100 (2016) 56",
    needs="a clock, samples at least four times as often as pockets pass in the slower records, and two speeds",
    signature="a ripple of the tension whose period is a length of travel, not a time; strongest where it meets a mode of the cable",
    kinds=("towing",),
    forms=(
        Form("one harmonic", "chain", _act, shape=_SHAPE, strength=_FIRST, scenario=_trolley),
        Form("two harmonics", "chain", _act, shape=_SHAPE, strength=(*_FIRST, *_SECOND), scenario=_trolley),
    ),
    why_untestable=needs_clock,
)  # fmt: skip

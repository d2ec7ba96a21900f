r"""The bend at the trolley costs a tension proportional to the tension: bearing friction, and the work of bending.

.. math::  T_\text{read} = T\,(1 + c\,\sigma)

sigma is +1 while the cable is pulled and -1 while it is let down, mobilised over the travel of the trough's friction; richer,
the sign of the speed. c = exp(mu theta) - 1 of a capstan (Euler 1762), or the loss of a roller. What is read inside the
cable, before the bend, does not know of it. In a scenario of the rod the roller becomes a drum that does not turn, whose friction
ln(1 + c)/theta over the wrap theta costs a flexible cable the same part.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

from effects.effect import BenchPath, Effect, Form, Parameter
from effects.towed_cable import TowedCable, turns_back
from effects.towed_scenario import TowedScenario, needs_trolley
from geometry.errors import SpecError


def _act(smooth: bool) -> Callable[..., TowedCable]:
    def act(cable: TowedCable, strength: Sequence[float]) -> TowedCable:
        return replace(cable, bend=float(strength[0]), smooth_bend=smooth)

    return act


def wrap_angle(towed: TowedScenario) -> float:
    """Angle of the cable round the roller at the start [rad]."""
    return float(sum(-curvature * length for length, curvature in towed.scenario.pieces if curvature < 0))


def _capstan(towed: TowedScenario, strength: Sequence[float]) -> TowedScenario:
    needs_trolley(towed.scenario, "and no roller that the cable goes round")
    roller, loss = towed.scenario.roller, float(strength[0])
    if roller.inertia is not None or roller.surface_speed is not None:
        what = "is driven" if roller.inertia is None else "turns with the cable"
        raise SpecError(
            f"the roller {what}, so that it is no capstan: leave out roller.inertia and roller.surface_speed"
        )
    before = 0.0 if roller.friction is None else roller.friction.value
    friction = before + math.log1p(loss) / wrap_angle(towed)
    return towed.changed(
        f"roller-resistance: roller.friction {before:.3g} -> {friction:.3g}, a capstan round "
        f"{math.degrees(wrap_angle(towed)):.0f} deg that costs {100 * loss:.3g} % of the tension",
        roller__friction=friction,
    )


def _why_untestable(paths: Sequence[BenchPath]) -> str | None:
    return (
        None if any(turns_back(p) for p in paths) else "the towed end never turns back, so that the loss has one sign"
    )


_LOSS = (
    Parameter(
        "loss", "1", "part of the tension that the bend costs", plausible=(0.002, 0.6),
        source="rope sheaves: 1 to 2 % with roller bearings, 3 to 5 % with plain ones; a rail with friction 0.2 to 0.3 up to 0.6",
    ),
)  # fmt: skip

EFFECT = Effect(
    name="roller-resistance",
    kind="physics",
    title="the bend at the trolley costs a tension proportional to the tension",
    equation="T_read = T (1 + c sigma), sigma = +1 pulled, -1 let down",
    source="capstan and rope sheaves, e.g. Feyrer, Wire Ropes, 2nd ed. 2015, ch. 2 and 3",
    needs="reversals, and at least two tail tensions or a second station to tell it from friction on the trough",
    signature="a jump at every reversal in proportion to the tension itself: larger with the tail tension, unseen inside the cable",
    kinds=("towing",),
    forms=(
        Form("mobilised by travel", "chain", _act(True), strength=_LOSS, scenario=_capstan),
        Form("sign of the speed", "chain", _act(False), strength=_LOSS, scenario=_capstan),
    ),
    why_untestable=_why_untestable,
)

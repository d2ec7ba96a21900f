r"""The bend at the trolley costs a tension proportional to the tension: bearing friction, and the work of bending.

.. math::  T_\text{read} = T\,(1 + c\,\sigma)

sigma is +1 while the cable is pulled and -1 while it is let down, mobilised over the travel of the trough's friction; richer,
the sign of the speed. c = exp(mu theta) - 1 of a capstan (Euler 1762), or the loss of a roller. What is read inside the
cable, before the bend, does not know of it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from effects.effect import BenchPath, Effect, Form, Parameter
from effects.towed_cable import TowedCable, turns_back


def _act(smooth: bool) -> Callable[..., TowedCable]:
    def act(cable: TowedCable, strength: Sequence[float]) -> TowedCable:
        return replace(cable, bend=float(strength[0]), smooth_bend=smooth)

    return act


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
        Form("mobilised by travel", "chain", _act(True), strength=_LOSS),
        Form("sign of the speed", "chain", _act(False), strength=_LOSS),
    ),
    why_untestable=_why_untestable,
)

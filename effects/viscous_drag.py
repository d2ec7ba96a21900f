r"""Resistance of the trough proportional to the sliding speed, all along the cable.

.. math::  f = -c\,v \quad [\mathrm{N/m}]

Source: a Newtonian film (mud, wet coal fines) under the cable, c = viscosity * wetted width / film thickness; e.g. Batchelor,
An Introduction to Fluid Dynamics, 1967, sec. 4.2 (plane Couette flow).
"""

from __future__ import annotations

from collections.abc import Sequence

from effects.effect import Effect, Form, Parameter
from effects.towed_cable import TowedCable
from effects.towed_scenario import TowedScenario, si


def _act(cable: TowedCable, strength: Sequence[float]) -> TowedCable:
    return cable.with_chain(drag=float(strength[0]))


def _trough(towed: TowedScenario, strength: Sequence[float]) -> TowedScenario:
    entry = towed.scenario.contact.drag
    drag = float(strength[0]) + (0.0 if entry is None else entry.value)
    return towed.changed(f"viscous-drag: contact.drag {drag:.4g} N s/m^2", contact__drag=si(drag, "N s/m^2"))


EFFECT = Effect(
    name="viscous-drag",
    kind="physics",
    title="resistance of the trough proportional to speed",
    equation="f = -c v per length",
    source="plane Couette flow, Batchelor, An Introduction to Fluid Dynamics, 1967, sec. 4.2",
    needs="at least two speeds",
    signature="the tension is higher the faster the cable is pulled, lower the faster it is let down; nothing at rest",
    kinds=("towing",),
    forms=(
        Form(
            "linear", "chain", _act, scenario=_trough,
            strength=(
                Parameter(
                    "drag", "N s/m^2", "resistance per length and speed", plausible=(0.05, 100.0),
                    source="slurry of 0.1 to 10 Pa s, 20 mm wide, under a film of 1 to 5 mm, up to thick mud",
                ),
            ),
        ),
    ),
)  # fmt: skip

r"""The trolley does not run at exactly half the speed: the true travel of the towed end is not the told one.

.. math::  p_\text{true} = (1 + e)\, p

Source: kinematics of a 2 : 1 reeving; a worn drum or a wrong gear constant scales the travel. In a scenario
of the rod it is the error of the trolley's ratio, beside one that is there.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from effects.effect import Array, Effect, Form, Parameter
from effects.towed_cable import TowedCable
from effects.towed_scenario import TowedScenario, needs_trolley


def _act(cable: TowedCable, strength: Sequence[float]) -> TowedCable:
    e = float(strength[0])

    def drive(t: Array, motion: Array) -> Array:
        return (1 + e) * motion

    return cable.driven(drive) if e else cable


def _trolley(towed: TowedScenario, strength: Sequence[float]) -> TowedScenario:
    needs_trolley(towed.scenario, "whose ratio could be wrong")
    entry = towed.scenario.drive.trolley_error
    error = (1.0 if entry is None else 1.0 + entry.value) * (1.0 + float(strength[0])) - 1.0
    ratio = towed.scenario.drive.trolley_ratio.value * (1 + error)
    return towed.changed(
        f"trolley-ratio-error: drive.trolley_error {error:+.4g}, the trolley runs at {ratio:.4g} of the shearer's speed",
        drive__trolley_error=error,
    )


EFFECT = Effect(
    name="trolley-ratio-error",
    kind="rig",
    title="the trolley does not run at exactly half the speed",
    equation="p_true = (1 + e) p",
    source="kinematics of a 2 : 1 reeving",
    needs="fast starts and stops: only inertia, damping and presliding see how far the end went",
    signature="every wave of the tension after a start, stop or reversal is too large or too small by the same part",
    kinds=("towing",),
    forms=(
        Form(
            "constant", "chain", _act, scenario=_trolley,
            strength=(
                Parameter(
                    "ratio error", "1", "true over told travel, less one", low=-np.inf, plausible=(-0.25, 0.25),
                    source="a wrong gear or drum constant: a few per cent, rarely above 20 %",
                ),
            ),
        ),
    ),
)  # fmt: skip

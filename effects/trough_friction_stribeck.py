r"""Friction on the trough that falls with sliding speed.

.. math::  \mu(v) = \mu + \Delta\mu\, e^{-(|v|/v_s)^p}

mu is the coefficient at high speed, that which is calibrated; Delta mu the excess at rest, v_s the speed at which it goes.
Plain form p = 1 (Tustin 1947; Bo & Pavelescu, Wear 82 (1982) 277), richer p = 2 (Armstrong-Helouvry et al., Automatica
30 (1994) 1083), and with a longer tail Delta mu / (1 + (v/v_s)^2) (Hess & Soom, J. Tribol. 112 (1990) 147). Every point of
the cable slides at its own speed, in the chain as in a scenario of the rod.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from effects.effect import BenchPath, Effect, Form, Parameter
from effects.towed_cable import TowedCable, largest_speed, of_speed
from effects.towed_scenario import TowedScenario, si
from geometry.errors import SpecError


def _law(power: float) -> Callable[..., TowedCable]:
    def act(cable: TowedCable, strength: Sequence[float], fall_speed: float) -> TowedCable:
        return cable.with_chain(fall=float(strength[0]), fall_speed=fall_speed, fall_power=power)

    return act


def _trough(power: float) -> Callable[..., TowedScenario]:
    def act(towed: TowedScenario, strength: Sequence[float], fall_speed: float) -> TowedScenario:
        if towed.scenario.contact.friction_fall is not None:
            raise SpecError("the scenario has a contact.friction_fall already; leave it out, or the effect")
        fall, nominal = float(strength[0]), towed.scenario.contact.friction.value
        fast = towed.calibrated.get("friction coefficient", nominal)
        told = "" if fast == nominal else f"; contact.friction {nominal:.3g} -> {fast:.3g}, calibrated beside it"
        return towed.changed(
            f"trough-friction-stribeck: contact.friction_fall {fall:.3g} over {fall_speed:.3g} m/s{told}",
            contact__friction=fast,
            contact__friction_fall=fall,
            contact__fall_speed=si(fall_speed, "m/s"),
            contact__fall_power=power,
        )

    return act


def _why_untestable(paths: Sequence[BenchPath]) -> str | None:
    if all(largest_speed(p) == 0 for p in paths):
        return "the towed end does not move in any record"
    return None


_SHAPE = (
    Parameter(
        "fall speed", "m/s", "speed at which the excess has fallen to 1/e (rational: to a half)", low=1e-6, plausible=(1e-3, 3.0),
        source="rubber and polymers on steel: millimetres to metres per second (Persson, Sliding Friction, 2000)",
        starts=of_speed(0.03, 1.0, 6),
    ),
)  # fmt: skip
_STRENGTH = (
    Parameter(
        "fall", "1", "friction coefficient at rest less that at high speed", plausible=(0.005, 0.6),
        source="dry and wet rubber on steel: static less kinetic friction up to about 0.5 (Persson, Sliding Friction, 2000)",
    ),
)  # fmt: skip

EFFECT = Effect(
    name="trough-friction-stribeck",
    kind="physics",
    title="friction on the trough falls with sliding speed",
    equation="mu(v) = mu + fall exp(-(|v|/v_s)^p), or mu + fall / (1 + (v/v_s)^2)",
    source="Bo & Pavelescu, Wear 82 (1982) 277; Hess & Soom, J. Tribol. 112 (1990) 147; "
    "Armstrong-Helouvry et al., Automatica 30 (1994) 1083",
    needs="at least two speeds, or slow and fast phases in a record",
    signature="more friction where the cable is slow: a peak at breaking away, and a gap between slow and fast records",
    kinds=("towing",),
    forms=(
        Form("exponential", "chain", _law(1.0), shape=_SHAPE, strength=_STRENGTH, scenario=_trough(1.0)),
        Form("Gaussian", "chain", _law(2.0), shape=_SHAPE, strength=_STRENGTH, scenario=_trough(2.0)),
        Form("rational", "chain", _law(0.0), shape=_SHAPE, strength=_STRENGTH, scenario=_trough(0.0)),
    ),
    why_untestable=_why_untestable,
)

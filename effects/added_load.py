r"""Coal or clamps on the cable: more mass per length than nominal.

.. math::  m(s) = m + \Delta m\ [s_1 < s < s_2]

It weighs on the trough (friction), pulls down it (weight) and has to be accelerated. Plain form all along the cable, richer
between two stations from the towed end. On a level trough at a steady speed it is friction and nothing else. In a scenario of
the rod it is mass of the clamps; a load on a part has no place there, as that rod has one mass per length.
"""

from __future__ import annotations

from collections.abc import Sequence

from effects.effect import Effect, Form, Parameter
from effects.towed_cable import TowedCable, of_cable
from effects.towed_scenario import TowedScenario, si
from geometry.errors import SpecError


def _all(cable: TowedCable, strength: Sequence[float]) -> TowedCable:
    return _part(cable, strength, 0.0, cable.chain.length)


def _part(cable: TowedCable, strength: Sequence[float], begin: float, end: float) -> TowedCable:
    length = cable.chain.length
    low, high = sorted((min(max(begin, 0.0), length), min(max(end, 0.0), length)))
    return cable.with_chain(added=(*cable.chain.added, (float(strength[0]), low, high)))


def _clamps(towed: TowedScenario, strength: Sequence[float]) -> TowedScenario:
    before = towed.scenario.cable.clamp_mass_per_length.value
    mass = before + float(strength[0])
    return towed.changed(
        f"added-load: cable.clamp_mass_per_length {before:.4g} -> {mass:.4g} kg/m",
        cable__clamp_mass_per_length=si(mass, "kg/m"),
    )


def _loaded(towed: TowedScenario, strength: Sequence[float], begin: float, end: float) -> TowedScenario:
    length = towed.scenario.cable.length.value
    low, high = sorted((begin, end))
    if low <= 0 and high >= length:
        return _clamps(towed, strength)
    raise SpecError(
        f"the load lies from {low:.3g} to {high:.3g} m, the cable of the scenario has one mass all along its {length:g} m; "
        f"spread over all of it it would also weigh on what lies still"
    )


def _station(name: str, meaning: str, *shares: float) -> Parameter:
    source = "any place of the cable; compare with what lies on it"
    return Parameter(name, "m", meaning, source=source, starts=of_cable(*shares))


_LOAD = Parameter(
    "added mass", "kg/m", "mass per length beside the nominal one", plausible=(0.02, 30.0),
    source="clamps and coal in a cable handler: up to a few times the mass of the cable",
)  # fmt: skip

EFFECT = Effect(
    name="added-load",
    kind="physics",
    title="coal or clamps on the cable: more mass per length than nominal",
    equation="m(s) = m + added mass between two stations",
    source="weight and inertia of a rider mass, Newton's second law",
    needs="at least two inclinations, or fast starts: on one level trough it is friction; a second station to find the place",
    signature="the tension at rest is too high on an incline in proportion to sin(inclination), and friction and inertia with it",
    kinds=("towing",),
    forms=(
        Form("all along", "chain", _all, strength=(_LOAD,), scenario=_clamps),
        Form(
            "on a part", "chain", _part, strength=(_LOAD,), scenario=_loaded,
            shape=(
                _station("begin", "where the load begins, from the towed end", 0.0, 0.15, 0.3, 0.45, 0.6, 0.75),
                _station("end", "where the load ends, from the towed end", 0.25, 0.4, 0.55, 0.7, 0.85, 1.0),
            ),
        ),
    ),
)  # fmt: skip

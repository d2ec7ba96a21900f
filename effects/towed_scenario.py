"""What an effect of towing changes in a scenario of the rod: the run at the face with what a towing campaign has shown.

As :mod:`effects.towed_cable` is the record that an effect changes when it is explained, a :class:`TowedScenario` is the scenario
that it changes when it is carried on, by the callable ``scenario(towed, strength, *shape)`` of its form. A change is an entry of the
scenario and a sentence; where the scenario has no such part the callable raises a :class:`geometry.errors.SpecError` that says so.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from beam.scenario import Scenario
from effects.effect import ActiveEffect
from geometry.errors import SpecError

OUTSIDE = {
    "section": "acts in the section, where this form cannot be stepped, or not in tests of this kind",
    "cross": "acts in the section, where this form cannot be stepped, or not in tests of this kind",
    "fixture": "acts between the rig and the section of a specimen",
    "filter": "acts in a sensor",
    "bias": "acts in a sensor",
}
"""Where an effect acts that changes no scenario, by its stage."""


@dataclass(frozen=True)
class TowedScenario:
    """A scenario before it is run, and what effects have changed in it.

    Attributes
    ----------
    scenario : Scenario
    calibrated : mapping of str to float
        What was calibrated beside the effects, SI, by name, such as ``friction coefficient``.
    notes : tuple of str
        A sentence on every change.
    """

    scenario: Scenario
    calibrated: Mapping[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def changed(self, note: str, **values: object) -> TowedScenario:
        """The same with other entries, by the keys of :meth:`beam.scenario.Scenario.changed`, and the sentence that says so.

        Raises
        ------
        SpecError
            If the scenario cannot be true with them.
        """
        return replace(self, scenario=self.scenario.changed(**values), notes=(*self.notes, note))


def si(value: float, unit: str) -> str:
    """A number with its SI unit, as scenarios read it.

    Examples
    --------
    >>> si(6.5, "kg/m")
    '6.5 kg/m'
    """
    return f"{float(value)!r} {unit}"


def needs_trolley(scenario: Scenario, what: str) -> None:
    """Refuse a scenario without a trolley.

    Raises
    ------
    SpecError
        With `what` the effect acts on.
    """
    if scenario.towing != "intelligent":
        raise SpecError(f'towing = "{scenario.towing}" has no trolley, {what}')


def changed_by(
    scenario: Scenario, active: Sequence[ActiveEffect], calibrated: Mapping[str, float] | None = None
) -> tuple[TowedScenario, tuple[ActiveEffect, ...], tuple[str, ...]]:
    """The scenario with the effects that can act in it, which these are, and a sentence on every other one.

    Examples
    --------
    >>> from beam import read_scenario
    >>> from effects import find
    >>> error = ActiveEffect(find("trolley-ratio-error"), find("trolley-ratio-error").forms[0], "towing", strength=(0.02,))
    >>> towed, acting, aside = changed_by(read_scenario("intelligent-horizontal"), [error])
    >>> round(float(towed.scenario.trolley(9.0)[1][0]) / float(towed.scenario.pull(9.0)[1][0]), 6), len(acting), aside
    (0.51, 1, ())
    """
    towed, acting, aside = TowedScenario(scenario, dict(calibrated or {})), [], []
    for one in active:
        form, name = one.form, f"{one.effect.name} ({one.kind})"
        if form.scenario is None or one.kind != "towing":
            aside.append(f"{name}: it {OUTSIDE.get(form.stage, 'says nothing on a scenario')}")
            continue
        try:
            towed = form.scenario(towed, one.strength, *one.shape)
            acting.append(one)
        except SpecError as error:
            aside.append(f"{name}: {error}")
    return towed, tuple(acting), tuple(aside)

"""`--effects` of `helicable tow`: what `helicable explain` found, put into the section of the rod and into the scenario."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from beam.scenario import Scenario
from effects.effect import ActiveEffect
from effects.effect_record import read_effects
from effects.rod_law import STRAINS_OF
from effects.towed_scenario import changed_by
from geometry.errors import SpecError

EffectsOption = Annotated[
    list[Path] | None,
    typer.Option(
        "--effects",
        metavar="FILE",
        help="JSON of `helicable explain`: its section effects act in the rod, its towing effects in the scenario. "
        "May be given twice, for a bench and a face.",
    ),
]


@dataclass(frozen=True)
class FoundEffects:
    """What was found, by where it can act in a towing run.

    Attributes
    ----------
    section : tuple of ActiveEffect
        Laws of the section, which the rod steps.
    others : tuple of ActiveEffect
        All others; the scenario says which of them can act in it.
    calibrated : dict of str to float
        What was calibrated beside the effects of towing, SI.
    source : str
        The files.
    """

    section: tuple[ActiveEffect, ...]
    others: tuple[ActiveEffect, ...]
    calibrated: dict[str, float]
    source: str

    def into(self, scenario: Scenario) -> ScenarioWithEffects:
        """The scenario with all that can act.

        Raises
        ------
        SpecError
            If nothing can, with the reason for every effect.
        """
        towed, acting, aside = changed_by(scenario, self.others, self.calibrated)
        if not self.section and not acting:
            why = f" ({'; '.join(aside)})" if aside else ""
            raise SpecError(
                f"{self.source}: none of the effects that were found{why} acts in the rod or in this scenario."
            )
        return ScenarioWithEffects(towed.scenario, self.section, (*self.section, *acting), towed.notes, aside)


@dataclass(frozen=True)
class ScenarioWithEffects:
    """A scenario with effects: the section laws beside it, all that act, a sentence on every change and on what is left aside."""

    scenario: Scenario
    section: tuple[ActiveEffect, ...]
    acting: tuple[ActiveEffect, ...]
    notes: tuple[str, ...]
    aside: tuple[str, ...]


def found_effects(files: Sequence[Path]) -> FoundEffects:
    """The effects in the JSON files of `helicable explain`.

    Raises
    ------
    SpecError
        If a file is no such JSON, or an effect of the same kind of experiment stands in two files.
    """
    section: list[ActiveEffect] = []
    others: list[ActiveEffect] = []
    calibrated: dict[str, float] = {}
    seen: dict[tuple[str, str, str | None], Path] = {}
    for file in files:
        found = read_effects(file)
        for one in found:
            key = (one.effect.name, one.kind, one.channel)
            if seen.setdefault(key, file) != file:
                raise SpecError(f"{file}: {one.effect.name} ({one.kind}) stands in {seen[key]} too; give one of them.")
            in_section = one.form.advance is not None and one.kind in STRAINS_OF
            (section if in_section else others).append(one)
        if any(one.kind == "towing" for one in found):
            calibrated |= _calibrated(file)
    return FoundEffects(tuple(section), tuple(others), calibrated, ", ".join(map(str, files)))


def _calibrated(file: Path) -> dict[str, float]:
    values = json.loads(file.read_text(encoding="utf-8")).get("calibrated_with_effects")
    if not isinstance(values, dict):
        return {}
    return {
        name: float(entry["value"])
        for name, entry in values.items()
        if isinstance(entry, dict) and isinstance(entry.get("value"), (int, float))
    }

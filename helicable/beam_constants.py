"""Which constants feed the rod: `published`, `cell` (the long-cable section of this project) or a file.

A file is what `helicable homogenize CABLE --json FILE` wrote: the 6x6 ``section.C`` and ``area``.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from beam import Scenario, published_section
from geometry import Cable, read_cable
from geometry.errors import SpecError
from helicable.screen import progress
from homogenize import SectionStiffness, homogenize_cable


@dataclass(frozen=True)
class BeamConstants:
    """Section of the rod and the sentence that says where it comes from."""

    name: str
    section: SectionStiffness
    sentence: str


def beam_constants(scenario: Scenario, cable: str, cell: SectionStiffness | None = None) -> BeamConstants:
    """The section that the scenario asks for; `cable` is what `cell` homogenizes, unless its section is given.

    Raises
    ------
    SpecError
        If the scenario's constants are neither published, cell nor a readable file.
    """
    name = scenario.constants
    if name == "published":
        entries = scenario.entries()
        moduli = {key: entries[f"published_constants.{key}"].text for key in ("E", "G_yoz", "G_xoz")}
        listed = ", ".join(f"{key} {text}" for key, text in moduli.items())
        return BeamConstants(name, published_section(scenario), f"published for a finite specimen: {listed}")
    if name == "cell":
        if cell is None:
            with progress("homogenizing") as tell:
                cell = homogenize_cable(read_cable(cable), progress=tell).section
        note = _mismatch(scenario, read_cable(cable))
        return BeamConstants(name, cell, f"cell: long cable {cable}, all parts bonded, averaged over the pitch{note}")
    return BeamConstants(name, _from_file(Path(name)), f"from the file {name}")


def _mismatch(scenario: Scenario, cable: Cable) -> str:
    """What the scenario keeps for itself when its cable is another one."""
    mass, diameter = scenario.cable.mass_per_length.value, scenario.cable.diameter.value
    if abs(mass / cable.mass_per_length - 1) < 0.02 and abs(diameter / cable.outer_diameter - 1) < 0.02:
        return ""
    return (
        f". The scenario's own {mass:.3g} kg/m and {1e3 * diameter:.3g} mm are kept, although {cable.name} has "
        f"{cable.mass_per_length:.3g} kg/m and {1e3 * cable.outer_diameter:.3g} mm: edit the scenario file"
    )


def _from_file(path: Path) -> SectionStiffness:
    if not path.is_file():
        raise SpecError(
            f'constants "{path}" are not known: use published, cell, or a file written by helicable homogenize --json.'
        )
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
        C, area = np.array(record["section"]["C"], dtype=float), float(record["area"])
    except (OSError, UnicodeDecodeError, json.JSONDecodeError) as error:
        raise SpecError(f"{path} is not a JSON file that can be read: {error}.") from None
    except (KeyError, TypeError, ValueError):
        C, area = np.full((6, 6), np.nan), 0.0
    if not np.isfinite(C).all():
        raise SpecError(
            f"{path} does not hold a complete 6x6 section.C and an area (a cell that was not asked for bending leaves entries empty); "
            "write it with helicable homogenize CABLE --json."
        )
    return SectionStiffness(C, area)

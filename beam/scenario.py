"""A towing scenario: the numbers of a TOML file, checked, each with its status and source.

Single entries are read in :mod:`beam.scenario_entry`, the tables are in :mod:`beam.scenario_tables`; what cannot be true, such
as a roller that runs off its strand, is refused by :mod:`beam.scenario_fault`. Here is what follows from the numbers.
"""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field, model_validator

from beam.motion_reciprocating import ReciprocatingStroke
from beam.scenario_entry import Entry, Part
from beam.scenario_fault import first_fault
from beam.scenario_tables import (
    Cable,
    Clamps,
    Contact,
    Disturbance,
    Drive,
    Layout,
    Machine,
    PublishedConstants,
    PublishedResults,
    Roller,
    TimeSpan,
    Walls,
)
from beam.surface import Travel
from beam.towing_drive import shearer_motion, trolley_motion, with_play
from beam.towing_path import Pieces, bend_pieces
from geometry.errors import SpecError
from homogenize.section_stiffness import SectionInertia, SectionStiffness


class Scenario(Part):
    """A checked scenario; every number is an :class:`Entry`.

    `towing` is ``"intelligent"`` (a trolley's roller holds the bend), ``"conventional"`` (the bend is free) or
    ``"bending-machine"`` (a plate pulls the cable to and fro over a fixed arch). With the table `clamps` the clamps are a
    chain of bodies; ``chain = "smeared"`` makes them mass on the cable again.
    `constants` says which section stiffness the user wants: ``"published"``, ``"cell"`` or the path of a file; whoever
    calls :func:`beam.tow` resolves it and passes the section. `element` is ``"rod"``, with shear and torsion, or
    ``"ancf-cable"``, without (:mod:`beam.ancf_cable`).
    """

    schema_: Literal[1] = Field(alias="schema")
    name: str
    title: str
    constants: str
    element: Literal["rod", "ancf-cable"] = "rod"
    towing: Literal["intelligent", "conventional", "bending-machine"] = "intelligent"
    chain: Literal["clamps", "smeared"] = "clamps"
    published_constants: PublishedConstants
    cable: Cable
    layout: Layout
    drive: Drive
    contact: Contact
    roller: Roller = Roller()
    time: TimeSpan
    clamps: Clamps | None = None
    walls: Walls | None = None
    disturbance: Disturbance | None = None
    machine: Machine | None = None
    published_results: PublishedResults = PublishedResults()

    @model_validator(mode="after")
    def _can_be_true(self) -> Scenario:
        fault = first_fault(self)
        if fault:
            raise SpecError(fault)
        return self

    @property
    def has_clamps(self) -> bool:
        """True if the clamps are bodies."""
        return self.clamps is not None and self.chain == "clamps"

    @property
    def deck_height(self) -> float:
        """Height of the upper strand above the lower one [m]."""
        height = self.layout.deck_height
        return 2 * self.layout.bend_radius.value if height is None else height.value

    @property
    def pieces(self) -> Pieces:
        """Lower strand, bend, upper strand as (length [m], curvature [1/m])."""
        bend = bend_pieces(self.layout.bend_radius.value, self.deck_height)
        return [(self.lower_strand, 0.0), *bend, (self.layout.upper_strand.value, 0.0)]

    @property
    def bend_length(self) -> float:
        """Length of cable on the bend [m]."""
        return float(sum(length for length, _ in bend_pieces(self.layout.bend_radius.value, self.deck_height)))

    @property
    def lower_strand(self) -> float:
        """Length of the lower strand at the start [m]."""
        return self.cable.length.value - self.layout.upper_strand.value - self.bend_length

    @property
    def roller_start(self) -> float:
        """x of the roller's axis at the start [m]: taut at the lower strand's end, nearer by half of the slack."""
        return -self.lower_strand + 0.5 * self.layout.slack.value

    @property
    def elements(self) -> int:
        """Number of elements."""
        return int(self.cable.elements.value)

    @property
    def pull(self) -> Travel:
        """Motion of the towed end: that of the shearer, or of the plate, behind its play."""
        drive, machine = self.drive, self.machine
        if machine is not None:
            ramp = drive.ramp_end.value - drive.ramp_start.value
            strokes = ReciprocatingStroke(
                machine.stroke.value, drive.speed.value, ramp, machine.pause.value, drive.ramp_start.value
            )
            return with_play(self, strokes)
        return with_play(self, shearer_motion(self))

    @property
    def trolley(self) -> Travel:
        """Motion of the roller; without a roller, of the place of the bend."""
        return trolley_motion(self)

    @property
    def cable_inertia(self) -> SectionInertia:
        """Inertia of the cable without clamps, its mass spread over its circle."""
        return SectionInertia.solid_circle(self.cable.mass_per_length.value, self.cable.diameter.value)

    def entries(self) -> dict[str, Entry]:
        """All entries by key, such as ``"cable.length"``, in the order of the file."""
        found: dict[str, Entry] = {}
        for part in type(self).model_fields:
            section = getattr(self, part)
            if isinstance(section, Part):
                for key in type(section).model_fields:
                    entry = getattr(section, key)
                    if entry is not None:
                        found[f"{part}.{key}"] = entry
        return found

    def changed(self, **values: object) -> Scenario:
        """The same scenario with other values, checked again: ``changed(cable__elements=100, time__duration="2 s")``.

        Raises
        ------
        SpecError
            If a key is unknown or the changed scenario cannot be true.
        """
        from beam.scenario_file import check

        raw: dict[str, Any] = {"schema": 1, "name": self.name, "title": self.title, "constants": self.constants}
        raw |= {"element": self.element, "towing": self.towing, "chain": self.chain}
        for key, entry in self.entries().items():
            part, name = key.split(".")
            raw.setdefault(part, {})[name] = entry
        for key, value in values.items():
            part, _, name = key.partition("__")
            if not name:
                raw[part] = value
                continue
            given = {"value": value, "status": "chosen", "source": "set for this run"}
            raw.setdefault(part, {})[name] = given
        return check(raw, self.name)


def published_section(scenario: Scenario) -> SectionStiffness:
    """Section stiffness from the published moduli on the cable's diameter (shear factor 0.9)."""
    constants = scenario.published_constants
    return SectionStiffness.solid_circle(
        E=constants.E.value,
        G_yoz=constants.G_yoz.value,
        G_xoz=constants.G_xoz.value,
        diameter=scenario.cable.diameter.value,
    )

"""A towing scenario: the numbers of a TOML file, checked, each with its status and source.

Single entries are read in :mod:`beam.scenario_entry`; here is what belongs together and what cannot be true, such as a
roller that runs off its strand. Every fault becomes one sentence that names the key.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from beam.motion import SpeedRamp
from beam.scenario_entry import Entry, quantity
from geometry.errors import SpecError
from homogenize.section_stiffness import SectionInertia, SectionStiffness


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", arbitrary_types_allowed=True)


class PublishedConstants(_Part):
    """Moduli of the equivalent solid circle."""

    E: Annotated[Entry, quantity("Pa", 1e3, 1e13)]
    G_yoz: Annotated[Entry, quantity("Pa", 1e3, 1e13)]
    G_xoz: Annotated[Entry, quantity("Pa", 1e3, 1e13)]


class Cable(_Part):
    """The rod: size, mass, mesh, damping."""

    diameter: Annotated[Entry, quantity("m", 1e-3, 1.0)]
    mass_per_length: Annotated[Entry, quantity("kg/m", 1e-3, 1e3)]
    clamp_mass_per_length: Annotated[Entry, quantity("kg/m", 0.0, 1e3)]
    length: Annotated[Entry, quantity("m", 0.1, 1e4)]
    elements: Annotated[Entry, quantity("1", 8, 20000)]
    damping_time_axial: Annotated[Entry, quantity("s", 0.0, 1.0)]
    damping_time_bending: Annotated[Entry, quantity("s", 0.0, 1.0)]


class Layout(_Part):
    """Where the cable lies at the start."""

    bend_radius: Annotated[Entry, quantity("m", 0.01, 100.0)]
    upper_strand: Annotated[Entry, quantity("m", 0.0, 1e4)]
    slack: Annotated[Entry, quantity("m", -0.5, 1.0)]
    inclination: Annotated[Entry, quantity("rad", -np.pi / 3, np.pi / 3)]


class Drive(_Part):
    """Shearer and trolley."""

    speed: Annotated[Entry, quantity("m/s", 1e-4, 10.0)]
    trolley_ratio: Annotated[Entry, quantity("1", 0.0, 1.0)]
    ramp_start: Annotated[Entry, quantity("s", 0.0, 1e3)]
    ramp_end: Annotated[Entry, quantity("s", 1e-3, 1e3)]


class Contact(_Part):
    """Trough and roller."""

    friction: Annotated[Entry, quantity("1", 0.0, 2.0)]
    stiffness: Annotated[Entry, quantity("N/m^2", 1e3, 1e10)]
    roller_stiffness: Annotated[Entry, quantity("N/m^2", 1e3, 1e10)]
    damping_time: Annotated[Entry, quantity("s", 0.0, 1.0)]


class Roller(_Part):
    """How the roller turns; with nothing given it turns freely without inertia, bearing friction or friction on the cable.

    With `friction` alone it is a drum that does not turn; with `inertia`, and `bearing_moment`, the cable turns it; with
    `surface_speed` it is driven, positive if its top runs towards the shearer, with the ramp of the drive.
    """

    friction: Annotated[Entry, quantity("1", 0.0, 2.0)] | None = None
    inertia: Annotated[Entry, quantity("kg m^2", 1e-6, 1e6)] | None = None
    bearing_moment: Annotated[Entry, quantity("N m", 0.0, 1e6)] | None = None
    surface_speed: Annotated[Entry, quantity("m/s", -10.0, 10.0)] | None = None


class TimeSpan(_Part):
    """Length of the run, output interval, largest step."""

    duration: Annotated[Entry, quantity("s", 1e-2, 1e5)]
    frame: Annotated[Entry, quantity("s", 1e-3, 1e3)]
    largest_step: Annotated[Entry, quantity("s", 1e-5, 0.1)]


class PublishedResults(_Part):
    """What the source reports; shown, never used."""

    node_54_Fx_plateau: Annotated[Entry, quantity("N", -1e6, 1e6)] | None = None
    node_220_Fy_plateau: Annotated[Entry, quantity("N", -1e6, 1e6)] | None = None
    node_370_Fx_max: Annotated[Entry, quantity("N", -1e6, 1e6)] | None = None
    bushing_3_amplitude: Annotated[Entry, quantity("N", 0, 1e6)] | None = None


class Scenario(_Part):
    """A checked scenario; every number is an :class:`Entry`.

    `constants` says which section stiffness the user wants: ``"published"``, ``"cell"`` or the path of a file; whoever
    calls :func:`beam.tow` resolves it and passes the section. `element` is ``"rod"``, with shear and torsion, or
    ``"ancf-cable"``, without (:mod:`beam.ancf_cable`).
    """

    schema_: Literal[1] = Field(alias="schema")
    name: str
    title: str
    constants: str
    element: Literal["rod", "ancf-cable"] = "rod"
    published_constants: PublishedConstants
    cable: Cable
    layout: Layout
    drive: Drive
    contact: Contact
    roller: Roller = Roller()
    time: TimeSpan
    published_results: PublishedResults = PublishedResults()

    @model_validator(mode="after")
    def _can_be_true(self) -> Scenario:
        for check in (self._time_fault, self._shape_fault, self._stroke_fault, self._mesh_fault, self._roller_fault):
            fault = check()
            if fault:
                raise SpecError(fault)
        return self

    def _shape_fault(self) -> str:
        length, upper, arc = self.cable.length.value, self.layout.upper_strand.value, self.bend_length
        if self.lower_strand <= 0 or upper <= 0:
            return (
                f"an upper strand of {upper:g} m and a bend of {arc:.3f} m leave {self.lower_strand:.3f} m of the {length:g} m "
                f"long cable for the lower strand: shorten layout.upper_strand or lengthen cable.length."
            )
        return ""

    def _stroke_fault(self) -> str:
        stroke = float(self.pull(self.time.duration.value)[0][0])
        travel = self.drive.trolley_ratio.value * stroke
        if stroke > self.cable.length.value:
            return (
                f"the stroke of {stroke:.2f} m is longer than the cable of {self.cable.length.value:g} m: "
                f"shorten time.duration or lower drive.speed."
            )
        if travel >= self.lower_strand:
            return (
                f"the roller travels {travel:.2f} m and runs off the lower strand of {self.lower_strand:.2f} m: "
                f"shorten time.duration or layout.upper_strand, or lower drive.speed."
            )
        return ""

    def _mesh_fault(self) -> str:
        count = self.cable.elements.value
        if count != int(count):
            return f"cable.elements is {count:g}; it must be a whole number."
        on_bend = self.bend_length * count / self.cable.length.value
        if on_bend < 5:
            needed = int(np.ceil(5 * self.cable.length.value / self.bend_length))
            return f"{count:g} elements put {on_bend:.1f} on the bend, too few to bend round it: use at least {needed}."
        return ""

    def _roller_fault(self) -> str:
        roller = self.roller
        if roller.friction is None and (roller.inertia or roller.bearing_moment or roller.surface_speed):
            return "a roller with inertia, bearing moment or surface speed turns with the cable or turns it: add roller.friction."
        if roller.inertia is not None and roller.surface_speed is not None:
            return "a roller is either driven (roller.surface_speed) or turned by the cable (roller.inertia), not both."
        if roller.bearing_moment is not None and roller.inertia is None:
            return "a roller with a bearing moment turns freely otherwise: add roller.inertia."
        return ""

    def _time_fault(self) -> str:
        if self.drive.ramp_end.value <= self.drive.ramp_start.value:
            return "drive.ramp_end must be later than drive.ramp_start."
        if self.time.largest_step.value > self.time.frame.value or self.time.frame.value > self.time.duration.value:
            return "time.largest_step must not exceed time.frame, nor time.frame the duration."
        return ""

    @property
    def bend_length(self) -> float:
        """Length of cable on the half circle [m]."""
        return float(np.pi * self.layout.bend_radius.value)

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
    def pull(self) -> SpeedRamp:
        """Motion of the shearer."""
        return SpeedRamp(self.drive.speed.value, self.drive.ramp_start.value, self.drive.ramp_end.value)

    @property
    def trolley(self) -> SpeedRamp:
        """Motion of the roller."""
        pull = self.pull
        return SpeedRamp(pull.speed, pull.start, pull.end, ratio=self.drive.trolley_ratio.value)

    @property
    def cable_inertia(self) -> SectionInertia:
        """Inertia of the cable without clamps, its mass spread over its circle."""
        return SectionInertia.solid_circle(self.cable.mass_per_length.value, self.cable.diameter.value)

    def entries(self) -> dict[str, Entry]:
        """All entries by key, such as ``"cable.length"``, in the order of the file."""
        found: dict[str, Entry] = {}
        for part in type(self).model_fields:
            section = getattr(self, part)
            if isinstance(section, _Part):
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
        raw["element"] = self.element
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

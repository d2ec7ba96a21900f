"""What may stand in a cable file (TOML), as pydantic models; used by cable_file.py only.

A number is written with its unit and its mark::

    insulation_wall = { value = "2.2 mm", status = "assumed", range = ["1.8 mm", "2.8 mm"], source = "..." }
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Discriminator, Field, Tag

from geometry.cable import MarkedNumber
from geometry.errors import SpecError
from geometry.units import read_quantity

STATUSES = ("published", "deduced", "assumed", "computed")
PLACE = "\N{PLACE OF INTEREST SIGN}"
"""Stands in a message for the key, which pydantic knows and the validator does not."""


def _marked(unit: str, low: float, high: float, strict: bool) -> BeforeValidator:
    def read(raw: Any) -> MarkedNumber:
        value, status, source, limits = _mark(raw, unit)
        number = read_quantity(value, unit, PLACE)
        bounds = [read_quantity(limit, unit, f"{PLACE}.range") for limit in limits] or [None, None]
        for checked in [number, *(b for b in bounds if b is not None)]:
            if not (low < checked < high if strict else low <= checked <= high):
                kind = "positive" if (low, high) == (0, math.inf) else f"between {low:g} and {high:g}"
                raise SpecError(f"{PLACE}: {value!r} is not possible here; it must be {kind}.")
        if bounds[0] is not None and bounds[1] is not None and not bounds[0] <= number <= bounds[1]:
            raise SpecError(f"{PLACE}: the value {value!r} lies outside its own range {limits[0]!r} to {limits[1]!r}.")
        return MarkedNumber("", number, unit, status, source, *bounds)

    return BeforeValidator(read)


def _counts(raw: Any) -> MarkedNumber:
    value, status, source, limits = _mark(raw, "count", example="[1, 6]")
    if limits:
        raise SpecError(f"{PLACE}: a count has no range; name the other counts that are possible in the source.")
    counts = value if isinstance(value, list) else [value]
    if not counts or not all(isinstance(n, int) and not isinstance(n, bool) and 1 <= n <= 5000 for n in counts):
        raise SpecError(
            f"{PLACE}: {value!r} is not a count; it must be a whole number from 1 to 5000, or a list of them."
        )
    return MarkedNumber("", tuple(counts), "1", status, source)


def _mark(raw: Any, unit: str, example: str | None = None) -> tuple[Any, str, str, list[Any]]:
    """Split the table of a number into value, status, source, range."""
    example = example or ('"1"' if unit == "1" else f'"1 {unit}"')
    form = f'{{ value = {example}, status = "published", source = "..." }}'
    if isinstance(raw, MarkedNumber):
        raise SpecError(f"{PLACE}: already read.")
    if not isinstance(raw, dict):
        raise SpecError(
            f"{PLACE}: {raw!r} has no mark; write {form}, so that everyone sees where the number comes from."
        )
    unknown = sorted(set(raw) - {"value", "status", "source", "range"})
    if unknown:
        raise SpecError(
            f'{PLACE}: the key "{unknown[0]}" is not known here; a number has value, status, source and range.'
        )
    if "value" not in raw:
        raise SpecError(f"{PLACE}: the value is missing; write {form}.")
    status, source = raw.get("status"), raw.get("source")
    if status not in STATUSES:
        raise SpecError(f"{PLACE}: the status must be one of {', '.join(STATUSES)}, found {status!r}.")
    if not isinstance(source, str) or not source.strip():
        raise SpecError(f"{PLACE}: the source is missing; say in a few words where the number comes from.")
    limits = raw.get("range", [])
    if not isinstance(limits, list) or len(limits) not in (0, 2):
        raise SpecError(f"{PLACE}.range: expected two values such as [{example}, {example}], found {limits!r}.")
    if status == "assumed" and not limits and unit != "count":
        raise SpecError(
            f"{PLACE}: an assumed number needs a range that it may be swept over, such as range = [{example}, {example}]."
        )
    return raw["value"], status, source, limits


Length = Annotated[MarkedNumber, _marked("m", 0, math.inf, True)]
Stress = Annotated[MarkedNumber, _marked("Pa", 0, math.inf, True)]
Density = Annotated[MarkedNumber, _marked("kg/m^3", 0, math.inf, True)]
MassPerLength = Annotated[MarkedNumber, _marked("kg/m", 0, math.inf, True)]
Angle = Annotated[MarkedNumber, _marked("rad", -7, 7, False)]
Poisson = Annotated[MarkedNumber, _marked("1", -1, 0.5, True)]
Fill = Annotated[MarkedNumber, _marked("1", 0, 1, False)]
LayFactor = Annotated[MarkedNumber, _marked("1", 1, 2, False)]
Counts = Annotated[MarkedNumber, BeforeValidator(_counts)]
Name = Annotated[str, Field(min_length=1, max_length=60, pattern=r"^[^\x00-\x1f]*$")]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", arbitrary_types_allowed=True)


class MaterialTable(_Table):
    """[materials.NAME]"""

    E: Stress
    nu: Poisson
    density: Density


class StrandTable(_Table):
    """[strands.NAME]: concentric strand of round wires; E and nu of the strand as a cylinder."""

    wire_diameter: Length
    layers: Counts
    lay: Length | None = None
    hand: Literal["Z", "S"] = "Z"
    wire_density: Density
    E: Stress
    nu: Poisson
    lay_factor: LayFactor | None = None


class StrandedTable(_Table):
    """[conductors.NAME] of strands."""

    strand: Name
    layers: Counts
    lay: Length | None = None
    hand: Literal["Z", "S"] = "Z"
    diameter: Length | None = None
    flat_width: Length | None = None
    voids: Name | None = None


class CylinderTable(_Table):
    """[conductors.NAME] as one cylinder of wires at a given fill; E and nu of that cylinder."""

    wires: Counts
    wire_diameter: Length
    wire_density: Density
    fill: Fill
    diameter: Length | None = None
    E: Stress
    nu: Poisson
    lay_factor: LayFactor | None = None


def _make_up(raw: Any) -> str:
    return "strands" if isinstance(raw, dict) and "strand" in raw else "cylinder"


ConductorTable = Annotated[
    Annotated[StrandedTable, Tag("strands")] | Annotated[CylinderTable, Tag("cylinder")], Discriminator(_make_up)
]


class CoreTable(_Table):
    """[cores.NAME]: a conductor, bare or with insulation, and a screen on the insulation."""

    conductor: Name
    insulation_wall: Length | None = None
    insulation_material: Name | None = None
    screen_wall: Length | None = None
    screen_material: Name | None = None


class CentreTable(_Table):
    """[centre]: a straight conductor on the axis, with an optional cover."""

    conductor: Name
    cover_wall: Length | None = None
    cover_material: Name | None = None


class LayUpTable(_Table):
    """[lay-up]: the cores in their order round the axis."""

    cores: list[Name] = Field(default_factory=list, max_length=60)
    lay: Length | None = None
    hand: Literal["Z", "S"] = "Z"
    phase: Angle | None = None
    pitch_circle_radius: Length | None = None


class IntersticesTable(_Table):
    """[interstices]: `fill` scales modulus and density of the material."""

    material: Name
    fill: Fill | None = None


class WallTable(_Table):
    """[wrap] and [sheath]"""

    wall: Length
    material: Name


class RingTable(_Table):
    """[[layers]], a ring about the axis."""

    kind: Literal["bedding", "tape", "wrap", "sheath"]
    name: Name | None = None
    wall: Length
    material: Name


class WiresTable(_Table):
    """[[layers]], round wires laid side by side."""

    kind: Literal["armour", "wires"]
    name: Name | None = None
    wires: Counts
    wire_diameter: Length
    material: Name
    lay: Length | None = None
    hand: Literal["Z", "S"] = "Z"
    phase: Angle | None = None
    radius: Length | None = None
    filler: Name | None = None


def _layer_kind(raw: Any) -> str:
    return "laid" if isinstance(raw, dict) and raw.get("kind") in ("armour", "wires") else "ring"


LayerTable = Annotated[
    Annotated[RingTable, Tag("ring")] | Annotated[WiresTable, Tag("laid")], Discriminator(_layer_kind)
]


class DataSheetTable(_Table):
    """[data-sheet]: what a sheet says; the range of a number is the tolerance of the sheet."""

    outer_diameter: Length | None = None
    mass_per_length: MassPerLength | None = None
    source: Annotated[str, Field(min_length=1, max_length=300)]


def _word(*allowed: str) -> BeforeValidator:
    def read(raw: Any) -> str:
        if not isinstance(raw, str) or raw.strip().partition(":")[0].strip() not in allowed:
            raise SpecError(f"{PLACE}: {raw!r} is not known; choose one of {', '.join(allowed)}.")
        return raw.strip()

    return BeforeValidator(read)


class SpecimenTable(_Table):
    """[specimen]: the finite specimen of a test; the ends in the words of `helicable specimen`."""

    length: Length
    phase: Angle | None = None
    loaded: Annotated[str, _word("uniform", "traction", "plate", "grip")] = "uniform"
    held: Annotated[str, _word("fixed", "grip")] = "fixed"
    interface: Annotated[str, Field(min_length=1, max_length=300)] = "bonded"


class CableTable(_Table):
    """The whole file."""

    name: Name
    title: Annotated[str, Field(min_length=1, max_length=300)]
    notes: list[str] = Field(default_factory=list)
    materials: dict[str, MaterialTable] = Field(default_factory=dict)
    strands: dict[str, StrandTable] = Field(default_factory=dict)
    conductors: dict[str, ConductorTable]
    cores: dict[str, CoreTable] = Field(default_factory=dict)
    centre: CentreTable | None = None
    lay_up: LayUpTable = Field(alias="lay-up", default_factory=LayUpTable)
    interstices: IntersticesTable | None = None
    layers: list[LayerTable] = Field(default_factory=list, max_length=40)
    wrap: WallTable | None = None
    sheath: WallTable | None = None
    data_sheet: DataSheetTable | None = Field(alias="data-sheet", default=None)
    specimen: SpecimenTable | None = None

"""The numbers of a cable as rows for the screen and for reports: derived ones, the mass by part, and every mark."""

from __future__ import annotations

import math
from typing import NamedTuple

from geometry.cable import Cable, MarkedNumber, lay_words
from geometry.clearance import neighbour_gap
from geometry.data_sheet import data_sheet_rows
from geometry.wire_layer import lay_of, wire_layers

UNITS = {
    "m": (1e3, "mm"),
    "Pa": (1e-6, "MPa"),
    "kg/m^3": (1.0, "kg/m^3"),
    "rad": (180 / math.pi, "deg"),
    "1": (1.0, ""),
    "kg/m": (1.0, "kg/m"),
}


class Row(NamedTuple):
    """One line of a table: `group`, `name`, `value` in SI (None for text), `shown` (number as text), `unit` of `shown`,
    `status` and `source` (a formula for computed values)."""

    group: str
    name: str
    value: float | None
    shown: str
    unit: str
    status: str
    source: str


def describe(cable: Cable) -> list[Row]:
    """Everything derived from the cable file, in the order of a data sheet."""
    return [*_whole(cable), *_sheet(cable), *_lay(cable), *_wire_layers(cable), *_conductors(cable), *_masses(cable)]


def marked_rows(cable: Cable) -> list[Row]:
    """Every number of the cable file with status, range and source."""
    return [_marked(number) for number in cable.numbers]


def _whole(cable: Cable) -> list[Row]:
    J = cable.rotary_inertia
    return [
        _computed("cable", "outer diameter", cable.outer_diameter, "m", "over all parts"),
        _computed("cable", "section area", cable.area, "m^2", "pi D^2 / 4"),
        _computed("cable", "mass per length", cable.mass_per_length, "kg/m", "sum of density x area, lays included"),
        _computed(
            "cable", "mean density", cable.mass_per_length / cable.area, "kg/m^3", "mass per length / section area"
        ),
        _computed("cable", "rotary inertia J_x", J.J_x, "kg m", "sum of density x integral of y^2"),
        _computed("cable", "rotary inertia J_y", J.J_y, "kg m", "sum of density x integral of x^2"),
        _computed("cable", "rotary inertia J_z", J.J_z, "kg m", "J_x + J_y"),
    ]


def _sheet(cable: Cable) -> list[Row]:
    rows = []
    for line in data_sheet_rows(cable):
        rows += [
            _computed("data sheet", line.name, line.stated, line.unit, cable.data_sheet_source),
            Row(
                "data sheet",
                "computed less sheet",
                line.difference,
                f"{line.percent + 0.0:+.2f}",
                "%",
                "computed",
                line.verdict,
            ),
        ]
    return rows


def _wire_layers(cable: Cable) -> list[Row]:
    rows = []
    for name, wires in wire_layers(cable).items():
        first = wires[0]
        gap = neighbour_gap(len(wires), first.centre_radius, 2 * first.outer_radius, lay_of(first))
        lay = lay_words(first.twist_rate)
        rows += [
            Row(name, "wires", float(len(wires)), f"{len(wires)} x {2e3 * first.outer_radius:.4g}", "mm", "given", ""),
            _computed(name, "pitch circle radius", first.centre_radius, "m", "rests on what is below, or as stated"),
            Row(name, "lay", lay_of(first), lay, "", "given", "Z right-handed, S left-handed"),
            _computed(name, "lay angle", first.lay_angle, "rad", "atan(2 pi r / lay)"),
        ]
        if len(wires) > 1:
            rows.append(_computed(name, "gap between neighbours", gap, "m", "along the lay"))
    return rows


def _lay(cable: Cable) -> list[Row]:
    if not any(part.centre_radius > 0 and part.layer is None for part in cable.parts):
        return []
    rows = [
        _computed(
            "lay-up", "pitch circle radius", cable.pitch_circle_radius, "m", "cores rest on the centre or on each other"
        ),
        _computed("lay-up", "laid-up diameter", 2 * cable.laid_up_radius, "m", "2 (pitch circle radius + core radius)"),
    ]
    if cable.lay is not None:
        rows += [
            Row("lay-up", "cabling lay", cable.lay, f"{1e3 * cable.lay:.4g}", "mm", "given", f"hand {cable.hand}"),
            _computed("lay-up", "lay ratio", cable.lay_ratio or 0.0, "1", "lay / laid-up diameter"),
            _computed("lay-up", "lay angle on the pitch circle", cable.lay_angle, "rad", "atan(2 pi r / lay)"),
        ]
    return rows


def _conductors(cable: Cable) -> list[Row]:
    rows = []
    for conductor in cable.conductors.values():
        group = f"{conductor.name} conductor"
        if conductor.strand is not None:
            strand = conductor.strand
            rows += [
                _computed(group, "strand diameter", strand.diameter, "m", "concentric layers of round wires"),
                _computed(group, "strand fill", strand.fill, "1", "wires d^2 / D^2"),
                _computed(group, "strand density", strand.density, "kg/m^3", "fill x density of the wire"),
                _computed(
                    group,
                    "strand lay factor",
                    strand.lay_factor,
                    "1",
                    f"from the lay alone {strand.computed_lay_factor:.4f}",
                ),
            ]
        rows += [
            _computed(group, "diameter", conductor.diameter, "m", "over the strands or wires"),
            _computed(group, "metal area", conductor.metal_area, "m^2", "normal sections of the wires"),
            _computed(group, "fill", conductor.fill, "1", "metal area / cylinder area"),
            _computed(
                group, "density with lay", conductor.density, "kg/m^3", "fill x density of the wire x lay factor"
            ),
            _computed(
                group, "E as a cylinder", conductor.E, "Pa", "E_strand A_strand (sum of cos^3 lay angle) / A_cylinder"
            ),
        ]
        if conductor.lay is not None:
            rows.append(
                _computed(
                    group, "lay angle of the outer strands", conductor.strand_lay_angle, "rad", "atan(2 pi r / lay)"
                )
            )
    return rows


def _masses(cable: Cable) -> list[Row]:
    total: dict[str, float] = {}
    for part in cable.parts:
        total[part.kind] = total.get(part.kind, 0.0) + part.mass_per_length
    return [
        _computed("mass per length", kind, mass, "kg/m", f"{100 * mass / cable.mass_per_length:.1f} %")
        for kind, mass in total.items()
    ]


def _computed(group: str, name: str, value: float, unit: str, source: str) -> Row:
    value = float(value)
    factor, shown_unit = UNITS.get(unit, (1.0, unit))
    if unit == "m^2":
        factor, shown_unit = 1e6, "mm^2"
    return Row(group, name, value, f"{factor * value:.5g}", shown_unit, "computed", source)


def _marked(number: MarkedNumber) -> Row:
    if isinstance(number.value, tuple):
        return Row("cable file", number.key, None, " + ".join(map(str, number.value)), "", number.status, number.source)
    factor, unit = UNITS[number.unit]
    shown = f"{factor * number.value:.6g}"
    if number.low is not None and number.high is not None:
        shown += f" ({factor * number.low:.6g} .. {factor * number.high:.6g})"
    return Row("cable file", number.key, number.value, shown, unit, number.status, number.source)

"""`helicable show`: a cable with what is derived from its file, what is assumed, and its pictures."""

from __future__ import annotations

from typing import Any

import numpy as np

from geometry import Cable, MarkedNumber, clearances, draw_cross_section, draw_cutaway, read_cable
from helicable.options import CableArgument, JsonOption, OutOption
from helicable.screen import folder, progress, say, table, write_json

SHOWN_UNITS = {
    "m": ("mm", 1e3),
    "Pa": ("MPa", 1e-6),
    "kg/m^3": ("kg/m3", 1.0),
    "1": ("", 1.0),
    "rad": ("deg", 180 / np.pi),
}


def show(cable: CableArgument, json: JsonOption = None, out: OutOption = None) -> None:
    """Show a cable: derived sizes, masses, lay angles, and which numbers are assumed.

    Example: `helicable show mcpt-1.9-3.3-3x35 --out pictures`
    """
    made = read_cable(cable)
    say(f"[bold]{made.name}[/bold]: {made.title}\n")
    table("Derived", ("quantity", "value"), derived_rows(made))
    if made.conductors:
        table(
            "Conductors as cylinders",
            ("conductor", "make-up", "diameter mm", "fill", "lay", "E GPa", "density kg/m3"),
            conductor_rows(made),
            right=(2, 3, 5, 6),
        )
    table("Parts", ("part", "from mm", "to mm", "material", "g/m"), part_rows(made), right=(1, 2, 4))
    table("Clearances", ("between", "gap mm"), clearance_rows(made), right=(1,))
    table("Numbers of the file", ("number", "value", "range", "status", "source"), number_rows(made.numbers))
    for note in made.notes:
        say(f"[dim]{note}[/dim]")
    write_json(json, cable_record(made))
    if out is not None:
        with progress("drawing") as tell:
            tell(0.1, "cross-section")
            draw_cross_section(made, folder(out) / "cross-section.png")
            tell(0.4, "cable cut open")
            draw_cutaway(made, out / "cutaway.png")
        say(f"written: {out / 'cross-section.png'}, {out / 'cutaway.png'}")


def derived_rows(cable: Cable) -> list[tuple[str, str]]:
    """Quantity and value."""
    rows = [
        ("outer diameter", f"{1e3 * cable.outer_diameter:.2f} mm"),
        ("section area", f"{1e6 * cable.area:.0f} mm2"),
        ("mass per length", f"{cable.mass_per_length:.3f} kg/m"),
        ("mean density", f"{cable.mass_per_length / cable.area:.0f} kg/m3"),
        ("laid-up diameter", f"{2e3 * cable.laid_up_radius:.2f} mm"),
        ("pitch circle of the cores", f"{2e3 * cable.pitch_circle_radius:.2f} mm diameter"),
    ]
    if cable.lay is None:
        return [*rows, ("cabling lay", "none: straight cores")]
    hand = "right-handed (Z)" if cable.hand == "Z" else "left-handed (S)"
    ratio = cable.lay_ratio or float("nan")
    rows.append(("cabling lay", f"{1e3 * cable.lay:.1f} mm, {hand}, {ratio:.2f} x laid-up diameter"))
    rows.append(("lay angle on the pitch circle", f"{np.degrees(cable.lay_angle):.2f} deg"))
    return rows


def conductor_rows(cable: Cable) -> list[tuple[str, ...]]:
    """One row for each strand and conductor."""
    rows: list[tuple[str, ...]] = []
    strands = {c.strand.name: c.strand for c in cable.conductors.values() if c.strand is not None}
    for s in strands.values():
        make_up = f"{sum(s.layers)} wires {1e3 * s.wire_diameter:.2f} mm ({' + '.join(map(str, s.layers))})"
        lay = "straight" if s.lay is None else f"{1e3 * s.lay:.0f} mm {s.hand}"
        rows.append(
            (
                f"strand {s.name}",
                make_up,
                f"{1e3 * s.diameter:.3f}",
                f"{s.fill:.4f}",
                lay,
                f"{s.E / 1e9:.1f}",
                f"{s.density:.0f}",
            )
        )
    for c in cable.conductors.values():
        make_up = f"{' + '.join(map(str, c.layers))} strands" if c.strand is not None else "one cylinder"
        lay = "straight" if c.lay is None else f"{1e3 * c.lay:.0f} mm {c.hand}"
        rows.append(
            (
                f"conductor {c.name}",
                make_up,
                f"{1e3 * c.diameter:.3f}",
                f"{c.metal_area / (np.pi * c.diameter**2 / 4):.4f}",
                lay,
                f"{c.E / 1e9:.1f}",
                f"{c.density_without_lay:.0f}",
            )
        )
    return rows


def part_rows(cable: Cable) -> list[tuple[str, ...]]:
    """One row for each part, from the centre outwards."""
    return [
        (
            p.name,
            f"{1e3 * p.inner_radius:.3f}",
            f"{1e3 * p.outer_radius:.3f}",
            p.material.name,
            f"{1e3 * p.mass_per_length:.1f}",
        )
        for p in cable.parts
    ]


def clearance_rows(cable: Cable) -> list[tuple[str, str]]:
    """Neighbours and the gap between them along the lay."""
    return [(f"{c.first} - {c.second}", f"{1e3 * c.gap:+.3f}") for c in clearances(cable)]


def number_rows(numbers: tuple[MarkedNumber, ...]) -> list[tuple[str, ...]]:
    """Every number of the file with its mark, assumed ones first."""
    order = {"assumed": 0, "deduced": 1, "computed": 2, "published": 3}
    return [
        (n.key, _shown(n.value, n.unit), _range(n), n.status, n.source)
        for n in sorted(numbers, key=lambda n: order.get(n.status, 9))
    ]


def _shown(value: Any, unit: str) -> str:
    if isinstance(value, tuple):
        return " + ".join(map(str, value))
    name, factor = SHOWN_UNITS.get(unit, (unit, 1.0))
    return f"{value * factor:.5g} {name}".strip()


def _range(number: MarkedNumber) -> str:
    if number.low is None or number.high is None:
        return ""
    return f"{_shown(number.low, number.unit)} .. {_shown(number.high, number.unit)}"


def cable_record(cable: Cable) -> dict[str, Any]:
    """The JSON of `helicable show`."""
    return {
        "schema": 1,
        "cable": cable.name,
        "title": cable.title,
        "outer_diameter": cable.outer_diameter,
        "area": cable.area,
        "mass_per_length": cable.mass_per_length,
        "lay": cable.lay,
        "hand": cable.hand,
        "lay_angle": cable.lay_angle,
        "parts": [
            {
                "name": p.name,
                "kind": p.kind,
                "inner_radius": p.inner_radius,
                "outer_radius": p.outer_radius,
                "centre_radius": p.centre_radius,
                "phase": p.phase,
                "material": p.material.name,
                "E": p.material.E,
                "nu": p.material.nu,
                "density": p.material.density,
                "area": p.area,
                "mass_per_length": p.mass_per_length,
            }
            for p in cable.parts
        ],
        "numbers": [n._asdict() for n in cable.numbers],
        "notes": list(cable.notes),
    }

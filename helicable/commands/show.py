"""`helicable show`: a cable with what is derived from its file, what is assumed, and its pictures."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from geometry import Cable, Member, clearances, describe, draw_cross_section, draw_cutaway, marked_rows, read_cable
from helicable.options import CableArgument, JsonOption, OutOption
from helicable.screen import folder, progress, say, table, write_json

LAYERS = ("interstices", "wrap", "sheath")
"""Kinds of parts that lie about the axis outside the cores."""


def show(
    cable: CableArgument,
    sources: Annotated[
        bool, typer.Option("--sources", help="Every number of the file, with status and source.")
    ] = False,
    json: JsonOption = None,
    out: OutOption = None,
) -> None:
    """Show a cable: derived sizes, masses, lay angles, and which numbers are assumed.

    Example: `helicable show mcpt-1.9-3.3-3x35 --out pictures`
    """
    made = read_cable(cable)
    say(f"[bold]{made.name}[/bold]: {made.title}\n")
    table("Derived", ("", "quantity", "value"), [r[:3] for r in derived_rows(made)], right=(2,))
    table("Parts", ("part", "from mm", "to mm", "material", "g/m"), part_rows(made), right=(1, 2, 4))
    table("Clearances along the lay", ("between", "gap mm"), clearance_rows(made), right=(1,))
    rows = number_rows(made)
    if sources:
        table("Numbers of the file", ("number", "value", "status", "source"), rows)
    else:
        assumed = [r[:2] for r in rows if r[2] == "assumed"]
        table(f"Assumed, with the range to sweep ({len(assumed)} of {len(rows)} numbers)", ("number", "value"), assumed)
        say("All numbers with their sources: --sources\n")
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


def derived_rows(cable: Cable) -> list[tuple[str, ...]]:
    """Group, quantity, value with unit, and how it is derived; the group is named once."""
    rows, last = [], ""
    for r in describe(cable):
        rows.append(("" if r.group == last else r.group, r.name, f"{r.shown} {r.unit}".strip(), r.source))
        last = r.group
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
    """Neighbours (less than a core's radius apart) and the gap between them along the lay, smallest first."""
    outer = {p.member: p for p in cable.parts if p.kind not in LAYERS}  # the last part of a member is its outermost
    members = [Member(name, p.centre_radius, p.phase, p.outer_radius) for name, p in outer.items()]
    near = 0.9 * max(p.outer_radius for p in outer.values())
    found = [c for c in clearances(members, cable.lay) if c.gap < near]
    return [(f"{c.first} - {c.second}", f"{1e3 * c.gap + 0.0:.3f}") for c in found]


def number_rows(cable: Cable) -> list[tuple[str, ...]]:
    """Every number of the file with its mark, assumed ones first."""
    order = {"assumed": 0, "deduced": 1, "computed": 2, "published": 3}
    rows = sorted(marked_rows(cable), key=lambda r: order.get(r.status, 9))
    return [(r.name, f"{r.shown} {r.unit}".strip(), r.status, r.source) for r in rows]


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

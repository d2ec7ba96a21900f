"""`helicable show`: a cable with what is derived from its file, what is assumed, and its pictures."""

from __future__ import annotations

import math
import re
from collections import Counter
from dataclasses import asdict
from typing import Annotated, Any

import typer

from geometry import Cable, data_sheet_rows, describe, draw_cross_section, draw_cutaway, marked_rows, read_cable
from geometry.wire_layer import neighbour_clearances, wire_layers
from helicable.options import CableArgument, JsonOption, OutOption
from helicable.screen import folder, progress, say, table, write_json

MOST_ROWS = 12
"""Clearances that are listed one by one."""


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
    table("Derived", ("", "quantity", "value"), [r[:3] for r in derived_rows(made, sheet=False)], right=(2,))
    if made.data_sheet:
        heads = ("", "computed", "data sheet", "difference", "range of the sheet")
        table(f"Beside the data sheet ({made.data_sheet_source})", heads, sheet_rows(made), right=(1, 2, 3))
    heads = ("part", "from mm", "to mm", "off the axis mm", "material", "g/m")
    table("Parts", heads, part_rows(made), right=(1, 2, 3, 5))
    gaps = clearance_rows(made)
    if gaps:
        table("Clearances along the lay", ("between", "gap mm"), gaps, right=(1,))
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


def derived_rows(cable: Cable, sheet: bool = True) -> list[tuple[str, ...]]:
    """Group, quantity, value with unit, and how it is derived; the group is named once. `sheet`: with the data sheet."""
    rows, last = [], ""
    for r in describe(cable):
        if r.group == "data sheet" and not sheet:
            continue
        rows.append(("" if r.group == last else r.group, r.name, f"{r.shown} {r.unit}".strip(), r.source))
        last = r.group
    return rows


def sheet_rows(cable: Cable) -> list[tuple[str, ...]]:
    """Computed, stated, difference, and whether the computed value lies in the range of the data sheet."""
    rows = []
    for r in data_sheet_rows(cable):
        factor, unit = (1e3, "mm") if r.unit == "m" else (1.0, r.unit)
        values = (f"{factor * r.computed:.2f} {unit}", f"{factor * r.stated:.2f} {unit}", f"{r.percent:+.1f} %")
        rows.append((r.name, *values, r.verdict))
    return rows


def part_rows(cable: Cable) -> list[tuple[str, ...]]:
    """One row for each part, from the centre outwards; the wires of a layer share one."""
    layers = wire_layers(cable)
    rows = []
    for p in cable.parts:
        wires = layers.get(p.layer or "", (p,))
        if p is not wires[0]:
            continue
        name = p.name if p.layer is None else f"{p.layer}: {len(wires)} wire{'s' if len(wires) > 1 else ''}"
        ends = f"{1e3 * p.inner_radius:.3f}", f"{1e3 * p.outer_radius:.3f}"
        mass = sum(wire.mass_per_length for wire in wires)
        rows.append((name, *ends, f"{1e3 * p.centre_radius:.3f}", p.material.name, f"{1e3 * mass:.1f}"))
    return rows


def clearance_rows(cable: Cable) -> list[tuple[str, str]]:
    """Neighbours and the gap between them along the lay, smallest first; pairs that are alike share a row in long lists."""
    found = neighbour_clearances(cable)
    names = [f"{c.first} - {c.second}" for c in found]
    gaps = [f"{round(1e3 * c.gap, 3) + 0.0:.3f}" for c in found]
    rows = list(zip(names, gaps, strict=True))
    if len(rows) <= MOST_ROWS:
        return rows
    alike = Counter((re.sub(r" \d+(?= |$)", "", name), gap) for name, gap in rows)
    return [(name if count == 1 else f"{name} ({count} times)", gap) for (name, gap), count in alike.items()]


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
        "lays": [2 * math.pi / rate if rate else None for rate in cable.lays],
        "data_sheet": [
            {**r._asdict(), "difference": r.difference, "inside": r.inside, "source": cable.data_sheet_source}
            for r in data_sheet_rows(cable)
        ],
        "clearances": [asdict(c) for c in neighbour_clearances(cable)],
        "parts": [
            {
                "name": p.name,
                "kind": p.kind,
                "inner_radius": p.inner_radius,
                "outer_radius": p.outer_radius,
                "centre_radius": p.centre_radius,
                "phase": p.phase,
                "twist_rate": p.twist_rate,
                "conductor": p.conductor,
                "layer": p.layer,
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

"""The two-stage route on the screen and as JSON."""

from __future__ import annotations

from typing import Any

from helicable.screen import engineering, say, table
from homogenize import ORDER
from homogenize.two_stage import Stage, TwoStage

HEADS = ("stage", "", "E", "EA, twist blocked", "EA, ends free", "coupling", "GJ", "EI")


def stage_row(stage: Stage) -> tuple[str, ...]:
    """A stage as a row of `HEADS`."""
    found = ((stage.EA_blocked_twist, "N"), (stage.EA_free_twist, "N"), (stage.coupling, "N m"))
    found += ((stage.GJ, "N m2"), (stage.EI, "N m2"))
    values = ("" if value is None else engineering(value, unit) for value, unit in found)
    return (stage.name, stage.what, engineering(stage.E, "Pa"), *values)


def show_two_stage(result: TwoStage) -> None:
    """Print every stage, and the difference to single cylinders."""
    table(
        f"{result.cable.name}: two-stage route, strands {result.strands}, conductors {result.interface} in their insulation",
        HEADS,
        [stage_row(stage) for stage in result.stages],
        right=(2, 3, 4, 5, 6, 7),
    )
    s, single = result.section, result.single_cylinder
    ratios = (
        ("EA, twist blocked", s.EA_blocked_twist / single.EA_blocked_twist),
        ("EA, ends free", s.EA_free_twist / single.EA_free_twist),
        ("GJ", s.GJ / single.GJ),
        ("EI", s.EI_x / single.EI_x),
    )
    say("Over single cylinders: " + ", ".join(f"{name} {100 * (ratio - 1):+.1f} %" for name, ratio in ratios) + ".")
    say(f"{result.cell.field.unknowns} unknowns, {len(result.mesh.cells)} elements in the section of the cable")


def two_stage_record(result: TwoStage, head: dict[str, Any], seconds: float) -> dict[str, Any]:
    """The JSON of `helicable homogenize --method two-stage`: the keys of the other methods, and every stage."""
    s = result.section
    names = ("EA_blocked_twist", "EA_free_twist", "GJ", "coupling", "EI_x", "EI_y", "GA_x", "GA_y")
    stages = [
        {
            "name": stage.name,
            "what": stage.what,
            "area": stage.area,
            "E_blocked_twist": stage.E,
            "EA_blocked_twist": stage.EA_blocked_twist,
            "EA_free_twist": stage.EA_free_twist,
            "coupling": stage.coupling,
            "GJ": stage.GJ,
            "EI": stage.EI,
        }
        for stage in result.stages
    ]
    return {
        **head,
        "section": {"order": list(ORDER), "C": s.C, **{name: getattr(s, name) for name in names}},
        "E_blocked_twist": s.E_blocked_twist,
        "E_free_twist": s.E_free_twist,
        "G_yoz": None,
        "G_xoz": None,
        "bounds": {"EA_lower": None, "EA_upper": None},
        "stages": stages,
        "mesh": {"unknowns": result.cell.field.unknowns, "elements": len(result.mesh.cells)},
        "method": "two-stage",
        "interface": result.interface,
        "strands": result.strands,
        "seconds": seconds,
        "notes": [
            "G_yoz, G_xoz and bounds come from --method helical; EI is an upper estimate by correcting the equivalent cylinders"
        ],
    }

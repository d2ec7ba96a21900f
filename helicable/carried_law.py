"""A law of the section that a bench has found, carried into the bend of a towing campaign: the options and what they do."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from compare import BenchModel
from compare.comparison import Comparison
from effects.effect import ActiveEffect
from effects.effect_record import read_effects
from geometry.errors import SpecError
from geometry.units import read_quantity
from helicable.screen import say

CarryOption = Annotated[
    Path | None,
    typer.Option(
        "--carry",
        metavar="FILE",
        help="JSON of `helicable explain` on a bending campaign: its section effects act at the bend of the towed end, unchanged.",
    ),
]
BendRadiusOption = Annotated[
    str | None, typer.Option("--bend-radius", metavar="LENGTH", help='Radius of that bend, such as "0.25 m".')
]


def carry_into(model: BenchModel, carry: Path | None, bend_radius: str | None) -> BenchModel:
    """The model with the carried laws at the bend; as it is without the options.

    Raises
    ------
    SpecError
        If only one option is given, the campaign has no towing, or the file no law in bending.
    """
    if carry is None and bend_radius is None:
        return model
    if carry is None or bend_radius is None:
        missing, given = (
            ("--bend-radius LENGTH", "--carry") if bend_radius is None else ("--carry FILE", "--bend-radius")
        )
        raise SpecError(
            f"{given} needs {missing} beside it: what is lost at a bend takes a law of the section and a radius."
        )
    if model.towing is None:
        raise SpecError("--carry: this campaign has no towing experiment, in which a bend could act.")
    radius = read_quantity(bend_radius, "m", "--bend-radius")
    if not radius > 0:
        raise SpecError(f"--bend-radius: a radius is positive, found {bend_radius}.")
    laws, EI = bending_laws(carry)
    return replace(model, towing=model.towing.carrying(laws, EI, radius))


def change_of_carrying(without: Comparison, carried: Comparison) -> dict[str, Any]:
    """What the carried law changes: error of every set before and after calibration, and the tension of every record."""
    towing = carried.nominal.towing
    assert towing is not None and towing.bend is not None
    names = ", ".join(dict.fromkeys(a.effect.name for a in towing.bend.laws))
    rows = []
    for words, before in (("nominal friction", True), ("friction calibrated", False)):
        for name in ("calibrate", "validate", "sealed"):
            a, b = (c.relative_error(name, before=before) for c in (without, carried))
            if a is not None and b is not None:
                rows.append({"what": f"error, {words}, {name}", "without": a, "with": b, "unit": "noise floors"})
    values = [c.calibration.values["friction coefficient"].value for c in (without, carried)]
    rows.append({"what": "friction coefficient", "without": values[0], "with": values[1], "unit": "1"})
    changes = {}
    for a, b in zip(without.fits, carried.fits, strict=True):
        rise = b.nominal - a.nominal
        changes[f"{b.experiment.id}, {b.channel}"] = float(np.abs(rise).max()) if rise.size else 0.0
        if b.channel == "tension" and b.experiment.repeat_of is None:
            swing = [float(np.ptp(f.nominal)) for f in (a, b)]
            rows.append(
                {"what": f"swing of the tension, {b.experiment.id}", "without": swing[0], "with": swing[1], "unit": "N"}
            )
    return {
        "title": f"{names} carried from the bench", "rows": rows, "largest_change": changes,
        "law": towing.bend.record(), "work": {f"{T:g} N": towing.bend.work(T) for T in (500.0, 1000.0, 2000.0)},
    }  # fmt: skip


def bending_laws(file: Path) -> tuple[Sequence[ActiveEffect], float]:
    """Laws of the section in bending that `helicable explain` found, and the EI [N m^2] that was calibrated with them.

    Raises
    ------
    SpecError
        If the file is no such JSON, or says nothing on bending.
    """
    found = read_effects(file)
    laws = tuple(a for a in found if a.kind == "bending" and a.form.stage == "section" and a.form.advance is not None)
    aside = [f"{a.effect.name} ({a.kind})" for a in found if a not in laws]
    if not laws:
        names = f" ({', '.join(aside)})" if aside else ""
        raise SpecError(f"{file}: none of the effects that were found{names} acts in the section in bending.")
    calibrated = json.loads(file.read_text(encoding="utf-8")).get("calibrated_with_effects") or {}
    EI = calibrated.get("EI", {}).get("value")
    if EI is None:
        raise SpecError(
            f"{file}: no EI was calibrated there (calibrated_with_effects), which the laws multiply; explain again."
        )
    if aside:
        say(f"left aside, because they are no laws of the section in bending: {', '.join(aside)}.")
    return laws, float(EI)

"""`helicable effects`: the library of effects, and one of them in full."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from effects import Effect, Form, Parameter, find, library, library_notes, plot_signature
from helicable.options import JsonOption
from helicable.screen import console, folder, plain, say, sheet, table, write_json

_MANY = 3  # columns of one law beyond which they share a line
_WIDE = 150  # characters of a terminal


def effects(
    name: Annotated[str | None, typer.Argument(metavar="[NAME]", help="One effect in full; all without it.")] = None,
    json: JsonOption = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Draw the expected signature into this folder.")
    ] = None,
) -> None:
    """List the effects that can be found in measurements, or show one with its equation, parameters and signature.

    Example: `helicable effects interlayer-friction --out pictures`
    """
    chosen = library() if name is None else (find(name),)
    if name is None:
        _list(chosen)
    else:
        _show(chosen[0])
    for note in library_notes():
        say(plain(f"- {note}"))
    write_json(json, {"schema": 1, "effects": [effect_record(e) for e in chosen], "notes": list(library_notes())})
    if out is not None:
        pictures = [plot_signature(e, folder(out)) for e in chosen]
        say("written: " + ", ".join(str(p) for p in pictures))


def effect_record(effect: Effect) -> dict[str, Any]:
    """An effect for machines; bounds that are infinite are null."""
    texts = ("name", "kind", "title", "equation", "source", "needs", "signature")
    return {
        **{key: getattr(effect, key) for key in texts},
        "experiments": list(effect.kinds),
        "forms": [
            {
                "name": form.name,
                "stage": form.stage,
                "runs_in_a_rod": form.advance is not None,
                "shape": [_parameter_record(p, effect) for p in form.shape],
                "strength": [_parameter_record(p, effect) for p in form.strength],
            }
            for form in effect.forms
        ],
    }


def _parameter_record(parameter: Parameter, effect: Effect) -> dict[str, Any]:
    def finite(*values: float) -> list[float | None]:
        return [v if math.isfinite(v) else None for v in values]

    return {
        "name": parameter.name,
        "unit": {kind: parameter.unit_for(kind) for kind in effect.kinds},
        "meaning": parameter.meaning,
        "bounds": finite(parameter.low, parameter.high),
        "plausible": finite(*parameter.plausible),
        "source": parameter.source,
    }


def _list(chosen: Sequence[Effect]) -> None:
    """One line each; the data that an effect needs where the terminal is wide enough for them."""
    columns, rows = ("name", "kind", "what it is"), [(e.name, e.kind, _sentence(e.title)) for e in chosen]
    if console.width >= _WIDE:
        columns = (*columns, "data it needs")
        rows = [(*row, e.needs) for row, e in zip(rows, chosen, strict=True)]
    table("Effects that can be found in measurements", columns, rows)
    say("`helicable effects NAME` shows its equation, its parameters, the data it needs and what it looks like.")


def _show(effect: Effect) -> None:
    say(f"[bold]{effect.name}[/bold] ({effect.kind}): {plain(effect.title)}\n")
    lines = (
        ("equation", effect.equation),
        ("source", effect.source),
        ("acts in", ", ".join(effect.kinds)),
        ("needs", _sentence(effect.needs)),
        ("look for", _sentence(effect.signature)),
    )
    sheet("The law", lines)
    for i, form in enumerate(effect.forms):
        rank = "Plain form" if i == 0 else "Richer form"
        rows = [row for group in _groups(form) for row in _parameter_rows(group, effect)]
        say("")
        sheet(f"{rank}: {form.name}", rows)


def _groups(form: Form) -> list[list[Parameter]]:
    """The parameters of a form; many strengths that differ in nothing but name and meaning share a group."""
    groups = [[p] for p in form.shape]
    for _, alike in itertools.groupby(form.strength, key=lambda p: (p.unit, p.low, p.high, p.plausible, p.source)):
        found = list(alike)
        groups += [found] if len(found) > _MANY else [[p] for p in found]
    return groups


def _parameter_rows(group: list[Parameter], effect: Effect) -> list[tuple[str, str]]:
    first, last = group[0], group[-1]
    more = f" ({len(group)} of them, to {last.name})" if len(group) > 1 else ""
    bounds, plausible = _range(first.low, first.high), _range(*first.plausible)
    ranges = f"Bounds: {bounds}; plausible: {plausible}; source: {first.source or 'none'}"
    return [(first.name, f"{_sentence(first.meaning)}{more}; unit {_unit(first, effect)}"), ("", ranges)]


def _unit(parameter: Parameter, effect: Effect) -> str:
    """Unit of a parameter, by kind of experiment where they differ."""
    units = {kind: parameter.unit_for(kind) for kind in effect.kinds}
    if len(set(units.values())) == 1:
        return next(iter(units.values()))
    return ", ".join(f"{unit} ({kind})" for kind, unit in units.items())


def _range(low: float, high: float) -> str:
    if math.isinf(low) and math.isinf(high):
        return "none"
    if math.isinf(high):
        return f"from {low:g}"
    return f"{low:g} to {high:g}"


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]

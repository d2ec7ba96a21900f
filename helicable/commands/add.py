"""`helicable add`: switch effects on by hand, recalibrate everything, and show the error before and after."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from compare import Comparison, plot_comparison
from compare import compare as compare_with
from compare.findings_record import parameter_record
from compare.findings_sentences import uncertain
from compare.kinds import SETS
from helicable.bench_campaign import bench_model, read_bench_campaign
from helicable.commands.explain import chosen_effects
from helicable.options import CampaignArgument, JsonOption, OutOption
from helicable.screen import folder, progress, sheet, table, write_json

Effects = Annotated[list[str], typer.Argument(metavar="EFFECT...", help="Names of effects (see `helicable effects`).")]


def add(campaign: CampaignArgument, effects: Effects, json: JsonOption = None, out: OutOption = None) -> None:
    """Add effects by hand, recalibrate everything, and show the error before and after.

    Example: `helicable add my-campaign interlayer-friction sensor-lag`
    """
    read, notes = read_bench_campaign(campaign, "add")
    names = tuple(effect.name for effect in chosen_effects(",".join(effects)))
    model = bench_model(read)
    with progress("the linear model") as tell:
        before = compare_with(model, read, progress=tell)
    with progress(f"with {', '.join(names)}") as tell:
        after = compare_with(model.add(names), read, progress=tell)
    record = add_record(names, before, after)
    record["notes"] = [*notes, *record["notes"]]
    show_addition(record)
    write_json(json, record)
    if out is not None:
        pictures = plot_comparison(after, folder(out))
        write_json(out / "add.json", record)
        sheet("", [("Written", ", ".join(str(p) for p in (*pictures, out / "add.json")))])


def add_record(names: tuple[str, ...], before: Comparison, after: Comparison) -> dict[str, Any]:
    """JSON of ``helicable add``: errors per set before and after, and everything that was calibrated, SI."""
    first, second = before.record(), after.record()
    error: dict[str, Any] = {"unit": first["error"]["unit"]}
    for name in SETS:
        a, b = first["error"][name], second["error"][name]
        error[name] = None if a is None or b is None else {"before": a["after"], "after": b["after"], "floor": 1.0}
    return {
        "schema": 1,
        "campaign": before.campaign.title,
        "effects": list(names),
        "error": error,
        "calibrated": {"before": first["calibrated"], "after": second["calibrated"]},
        "parameters": {name: parameter_record(p) for name, p in after.calibration.parameters.items()},
        "where": second["where"],
        "notes": list(dict.fromkeys([*first["notes"], *second["notes"]])),
    }


def show_addition(record: dict[str, Any]) -> None:
    """Print the errors before and after, and the parameters."""
    sheet(record["campaign"], [("added", ", ".join(record["effects"]))])
    rows = [(n, *(_short(e[k]) for k in ("before", "after", "floor"))) for n in SETS if (e := record["error"][n])]
    table("Error over the noise floor", ("set", "before", "after", "floor"), rows, right=(1, 2, 3))
    stiffness = record["calibrated"]
    found = [
        (name, *(uncertain(v["value"], v["std"]) for v in (stiffness["before"].get(name, v), v)), v["unit"])
        for name, v in stiffness["after"].items()
    ]
    table("Calibrated stiffness", ("", "before", "after", "unit"), found, right=(1, 2))
    values = [
        (name, uncertain(p["value"], p["std"], p["unit"]), p["meaning"]) for name, p in record["parameters"].items()
    ]
    table("Parameters of the effects", ("parameter", "value", "meaning"), values, right=(1,))
    sheet("Notes", [("-", note) for note in record["notes"]])


def _short(value: float | None) -> str:
    return "-" if value is None else f"{value:.3g}"

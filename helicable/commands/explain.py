"""`helicable explain`: where the model fails, which effect is missing, and whether the error falls on data left out."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from compare.findings import Findings
from compare.fit_store import FILE
from effects import Effect, find
from geometry.errors import InputError
from helicable.bench_campaign import bench_model, read_bench_campaign
from helicable.carried_law import BendRadiusOption, CarryOption, carry_into
from helicable.explain_screen import show_findings
from helicable.options import CampaignArgument, JsonOption, OutOption
from helicable.rod_correction import FullRod, rod_correction, show_correction
from helicable.screen import folder, progress, sheet, write_json

if TYPE_CHECKING:
    from compare.output_space_mapping import RodCorrection

OpenSealed = Annotated[
    bool,
    typer.Option(
        "--open-sealed", help="Open the sealed experiments once, after the model is fixed, and judge it there."
    ),
]
Names = Annotated[
    str | None, typer.Option("--effects", metavar="A,B", help="Try these effects only (see `helicable effects`).")
]


def explain(
    campaign: CampaignArgument,
    json: JsonOption = None,
    out: OutOption = None,
    open_sealed: OpenSealed = False,
    effects: Names = None,
    full_rod: FullRod = False,
    carry: CarryOption = None,
    bend_radius: BendRadiusOption = None,
) -> None:
    """Find the physics that the linear model misses, and prove it on data that it did not fit.

    With --out every finished fit is kept in the folder: the same command goes on from there after a kill.

    Example: `helicable explain my-campaign --out report`
    """
    read, notes = read_bench_campaign(campaign, "explain")
    from compare.explain import explain as explain_campaign
    from compare.explain import open_and_validate

    model = carry_into(bench_model(read), carry, bend_radius)
    library = None if effects is None else chosen_effects(effects)
    with progress("explaining") as tell:
        kept = None if out is None else folder(out) / FILE
        findings = explain_campaign(model, read, progress=tell, library=library, store=kept)
    correction, said = rod_correction(findings.after) if full_rod else (None, ())
    notes = (*notes, *said)
    if open_sealed:
        if read.of_set("sealed"):
            with progress("opening the sealed experiments"):
                findings = open_and_validate(findings, read)
        else:
            notes = (*notes, "--open-sealed: the campaign has no sealed experiments.")
    show_findings(findings, notes)
    if correction is not None:
        show_correction(correction)
    write_findings(findings, json, out, notes, correction)


def chosen_effects(names: str) -> tuple[Effect, ...]:
    """Effects of the library by name, comma-separated.

    Raises
    ------
    SpecError, InputError
        If a name is not in the library; if there is none.
    """
    wanted = [name.strip() for name in names.split(",") if name.strip()]
    if not wanted:
        raise InputError("--effects names no effect; give one or several, separated by commas.")
    return tuple(find(name) for name in dict.fromkeys(wanted))


def write_findings(
    findings: Findings,
    json: Path | None,
    out: Path | None,
    notes: tuple[str, ...] = (),
    correction: RodCorrection | None = None,
) -> None:
    """JSON, and with `out` the page, its pictures and the same JSON."""
    record = findings.record()
    record["notes"] = [*notes, *record["notes"]]
    if correction is not None:
        record["full_rod"] = correction.record()
    write_json(json, record)
    if out is None:
        return
    from helicable.explain_report import write_report

    folder(out)
    with progress("drawing the report"):
        page = write_report(findings, out, notes, correction)
    write_json(out / "explain.json", record)
    sheet("", [("Report", str(page)), ("JSON", str(out / "explain.json"))])

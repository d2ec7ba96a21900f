"""`helicable demo`: the whole chain on the real cable, then a missing effect is found, with one page that shows it."""

from __future__ import annotations

import csv
import time
from pathlib import Path
from typing import Annotated

import typer

from beam import TowingRun
from compare.findings import Findings
from compare.findings_sentences import first_screen
from geometry import Cable, GeometryError, draw_cross_section, draw_cutaway, draw_mesh, read_cable
from helicable.beam_constants import BeamConstants
from helicable.bench_campaign import bench_model, read_bench_campaign
from helicable.commands.homogenize import constant_rows, homogenization_record, show_constants
from helicable.commands.show import clearance_rows, derived_rows, number_rows
from helicable.commands.tow import (
    REFERENCE_CABLE,
    draw_run,
    published_rows,
    run_rows,
    show_run,
    towing_json,
    towing_run,
)
from helicable.explain_screen import show_findings
from helicable.options import JsonOption
from helicable.published import modulus_rows
from helicable.report import Figure, Report, Section, Table
from helicable.screen import engineering, folder, progress, say, write_json
from homogenize import Homogenization, PeriodicCell, homogenize_cable, slice_stiffness

SCENARIO = "intelligent-horizontal"
SLICE_SIZE = 3.0e-3
SLICES_PER_PITCH = 96
HIDDEN_EFFECT = Path(__file__).resolve().parents[2] / "data" / "campaigns" / "example-hidden-effect"


def demo(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the report.")] = Path("out/demo"),
    cable: Annotated[
        str, typer.Option("--cable", metavar="CABLE", help="A built-in cable or a TOML file.")
    ] = REFERENCE_CABLE,
    json: JsonOption = None,
) -> None:
    """Run the whole chain on the real cable: drawing, mesh, cell, section, towing run, missing effect of a synthetic campaign.

    Example: `helicable demo --out out/demo`
    """
    start = time.perf_counter()
    folder(out)
    made = read_cable(cable)
    say(f"[bold]{made.name}[/bold]: {made.title}\n")
    drawn = _draw_cable(made, out)
    with progress("2D helical cell") as tell:
        result = homogenize_cable(made, progress=tell)
    with progress("the same with sliding conductors") as tell:
        sliding = homogenize_cable(made, interface="frictionless", progress=tell)
    draw_mesh(result.mesh, out / "mesh.png")
    show_constants(result)
    with progress("3D periodic slice, as a check") as tell:
        slice_result = slice_stiffness(made, size=SLICE_SIZE, slices_per_pitch=SLICES_PER_PITCH, progress=tell)
    run, used = towing_run(SCENARIO, "published", cable, chain="smeared")
    show_run(run, used)
    stiff, stiff_used = towing_run(SCENARIO, "cell", cable, result.section, chain="smeared")
    show_run(stiff, stiff_used)
    run.write(out / "run.nc")
    pictures = draw_run(run, out)
    explained = _explain(out / "explain")
    _write_constants(result, out)
    section, towing = homogenization_record(result), {**towing_json(run, used), "run": "run.nc"}
    write_json(out / "section.json", section)
    write_json(out / "tow.json", towing)
    sections = (
        _cable_section(made, drawn),
        _cell_section(result, sliding, slice_result, out),
        _published_section(result, run, stiff),
        _towing_section(run, used, stiff, pictures),
        *([] if explained is None else [_effect_section(*explained)]),
    )
    if explained is not None:
        write_json(out / "explain.json", explained[0].record())
    page = Report(
        f"{made.name}: from the drawing to the towing run",
        f"{made.title}. Every step of the chain in the order of the data; assumed numbers are marked and have a range.",
        _facts(result, run),
        sections,
    ).write(out / "report.html")
    files = sorted(path.name for path in out.iterdir())
    write_json(json, {"schema": 1, "folder": str(out), "files": files, "homogenize": section, "tow": towing})
    say(f"\n[bold]Report: {page}[/bold] ({time.perf_counter() - start:.0f} s)")


def _draw_cable(cable: Cable, out: Path) -> list[Figure]:
    """Both pictures; where nothing can be rendered in 3D the demo says so and goes on."""
    figures = []
    with progress("drawing the cable") as tell:
        tell(0.1, "cross-section")
        draw_cross_section(cable, out / "cross-section.png")
        figures.append(Figure(out / "cross-section.png", "Cross-section at z = 0, every part named"))
        tell(0.4, "cable cut open")
        try:
            draw_cutaway(cable, out / "cutaway.png")
            figures.append(Figure(out / "cutaway.png", "The helical geometry cut open"))
        except GeometryError as error:
            say(f"[yellow]no picture of the cable cut open:[/yellow] {error}")
    return figures


def _explain(out: Path) -> tuple[Findings, dict[str, Path]] | None:
    """What is missing in the campaign that ships; None where only the packages are installed, without the data."""
    if not HIDDEN_EFFECT.is_dir():
        say("[yellow]the example campaign is not installed; no effect is looked for.[/yellow]")
        return None
    from compare.explain import explain, open_and_validate
    from compare.findings_plot import plot_findings

    campaign = read_bench_campaign(HIDDEN_EFFECT, "explain")[0]
    with progress("explaining the example campaign") as tell:
        findings = explain(bench_model(campaign), campaign, progress=tell)
    findings = open_and_validate(findings, campaign)
    show_findings(findings)
    return findings, plot_findings(findings, out)


def _write_constants(result: Homogenization, out: Path) -> None:
    with (out / "constants.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("quantity", "value", "definition"))
        writer.writerows(constant_rows(result))


def _facts(result: Homogenization, run: TowingRun) -> list[tuple[str, str]]:
    cable = result.cable
    return [
        ("outer diameter", f"{1e3 * cable.outer_diameter:.1f} mm"),
        ("mass", f"{cable.mass_per_length:.2f} kg/m"),
        ("E of a long cable, twist blocked", engineering(result.average.E_blocked_twist, "Pa")),
        ("E of a long cable, ends free", engineering(result.average.E_free_twist, "Pa")),
        ("pull force, steady (published constants)", f"{run.record()['pull_force_plateau']:.0f} N"),
    ]


def _cable_section(cable: Cable, figures: list[Figure]) -> Section:
    tables = [
        Table("Derived from the cable file", ("", "quantity", "value", "how"), derived_rows(cable), right=(2,)),
        Table("Clearances along the lay", ("between", "gap mm"), clearance_rows(cable), right=(1,)),
        Table("Numbers of the file", ("number", "value", "status", "source"), number_rows(cable), right=(1,)),
    ]
    return Section("The cable", "\n\n".join(cable.notes), figures, tables)


def _cell_section(result: Homogenization, sliding: Homogenization, cell: PeriodicCell, out: Path) -> Section:
    s = result.section
    text = (
        "In a frame that turns with the cable the fields do not depend on z, so that tension and torsion are one real problem on "
        "the cross-section, bending and shear one complex problem. Bonded is the stiffest a cable can be in tension, "
        "torsion and bending; sliding conductors make it softer, sliding cores (not modelled) would make it softer still.\n\n"
        "A cable whose lay has one hand has no single E: with the twist blocked it is stiffer than with ends that may rotate."
    )
    pairs = [
        ("EA, twist blocked [MN]", s.EA_blocked_twist / 1e6, cell.stiffness[0, 0] / 1e6),
        ("coupling [kN m]", s.coupling / 1e3, cell.stiffness[0, 1] / 1e3),
        ("GJ [N m2]", s.GJ, cell.stiffness[1, 1]),
    ]
    agreement = [(name, f"{a:.3f}", f"{b:.3f}", f"{100 * (b / a - 1):+.2f}") for name, a, b in pairs]
    C = [[f"{value:.4g}" if abs(value) > 1e-9 * abs(s.C).max() else "0" for value in row] for row in s.C]
    order = ("gamma_x", "gamma_y", "epsilon", "kappa_x", "kappa_y", "tau")
    rows = [(name, *row) for name, row in zip(order, C, strict=True)]
    tables = [
        Table(
            "Constants of the long cable",
            ("quantity", "all parts bonded", "conductors sliding", "definition"),
            [(a[0], a[1], b[1], a[2]) for a, b in zip(constant_rows(result), constant_rows(sliding), strict=True)],
            right=(1, 2),
        ),
        Table(
            "6x6 section stiffness, bonded, averaged over the pitch (N, N m, N m2)",
            ("", *order),
            rows,
            right=tuple(range(1, 7)),
        ),
        Table(
            "Tension and torsion, bonded, by a 3D periodic slice",
            ("quantity", "2D cell", f"3D slice, {cell.unknowns} unknowns", "difference %"),
            agreement,
            right=(1, 2, 3),
            note="The 3D slice is coarse here; tests show that both agree as the mesh is refined.",
        ),
        Table(
            "Checks on this result",
            ("", "check", "found"),
            [("holds" if c.holds else "FAILS", c.name, c.sentence) for c in result.checks],
        ),
    ]
    return Section(
        "From the mesh to the section", text, [Figure(out / "mesh.png", "Mesh of the cross-section")], tables
    )


def _published_section(result: Homogenization, run: TowingRun, other: TowingRun) -> Section:
    text = (
        "The published moduli come from a finite specimen with one end fixed and the force on the other (Ge et al., PLoS ONE 18(2) "
        "e0281136, 2023). They are shown beside the long-cable values and are not a target for them: for a long cable the "
        "conductors share the strain, and the straight earth conductor alone sets a lower bound."
    )
    moduli = [
        (r.quantity, f"{r.published / 1e6:.0f} MPa", engineering(r.computed, "Pa"), f"{r.ratio:.3g}", r.why)
        for r in modulus_rows(result)
    ]
    columns = ("quantity", "published", "computed", "ratio", "why they differ")
    forces = ("quantity", "published", "computed, published constants", "computed, cell constants", "why they differ")
    tables = [
        *([Table("Moduli", columns, moduli, right=(1, 2, 3))] if moduli else []),
        Table("Forces of the towing run", forces, published_rows(run, other), right=(1, 2, 3)),
    ]
    return Section("Published and computed", text, (), tables)


def _towing_section(run: TowingRun, used: BeamConstants, other: TowingRun, pictures: list[Path]) -> Section:
    captions = {
        "cable": "The cable at four times, tension as colour",
        "node-forces": "Section forces at the published nodes",
        "pull-force": "Pull force beside the incline formulas",
        "forces": "Forces at the published nodes in three directions, in the layout of the source",
        "courses": "Displacements, bushing 3, contact 35 and the incline formulas, in the layout of the source",
        "energies": "Where the work of the drives goes",
    }
    figures = [Figure(p, captions[p.stem.removeprefix("towing-")]) for p in pictures]
    a, b = run_rows(run), run_rows(other)
    rows = [(name, x, y) for (name, x), (_, y) in zip(a, b, strict=True)]
    numbers = [(key, entry.text, entry.status, entry.source) for key, entry in run.scenario.entries().items()]
    text = (
        f"{run.scenario.title}. The curves use the constants {used.sentence}; the table shows the same run with the long-cable "
        "constants beside them. Which constants feed the rod is the user's choice: helicable tow --constants published | cell | FILE."
    )
    tables = [
        Table("The run with either set of constants", ("", "published constants", "cell constants"), rows),
        Table("Numbers of the scenario", ("number", "value", "status", "source"), numbers),
    ]
    return Section("The towing run", text, figures, tables)


def _effect_section(findings: Findings, pictures: dict[str, Path]) -> Section:
    text = (
        "A synthetic campaign that ships with helicable: bending tests under axial tension with something hidden in them. The linear "
        "section is calibrated, the noise is taken from the repeats, every effect of the library is tried, and what is accepted has "
        "to predict experiments that nothing was fitted to; the sealed ones were opened after the model was fixed.\n\n"
        "What is true stands in data/campaigns/truth.md; the search never sees it. `helicable explain CAMPAIGN --out DIR` makes the "
        "full page for your own measurements."
    )
    captions = {
        "record-1": "The record with the largest misfit, before and after",
        "ranking": "Evidence and share of the excess of every effect that was tried",
        "errors": "Error over the noise floor before and after, beside repairs that name nothing",
    }
    figures = [Figure(pictures[name], caption) for name, caption in captions.items() if name in pictures]
    tables = [Table("In five sentences", ("", "found"), first_screen(findings))]
    return Section("The missing effect", text, figures, tables)

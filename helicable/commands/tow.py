"""`helicable tow`: run a towing scenario with the rod."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import typer

from beam import TowingRun, accurate_settings, builtin_scenarios, read_scenario
from beam import tow as run_towing
from beam.bending_history import bending_history
from beam.fatigue_history import fatigue_history
from beam.scenario import Scenario
from beam.towing_comparison import comparison
from beam.towing_record import write_contact_table
from effects.rod_law import RodLaw
from geometry.errors import ConvergenceError, SpecError
from helicable.beam_constants import BeamConstants, beam_constants
from helicable.found_effects import EffectsOption, ScenarioWithEffects, found_effects
from helicable.options import JsonOption
from helicable.screen import folder, progress, say, table, write_json
from homogenize import SectionStiffness

REFERENCE_CABLE = "mcpt-1.9-3.3-3x35"


def tow(
    scenario: Annotated[
        str | None, typer.Argument(metavar="SCENARIO", help="A built-in scenario or a TOML file.")
    ] = None,
    constants: Annotated[
        str | None, typer.Option(metavar="NAME", help="`published`, `cell`, or a JSON file of `helicable homogenize`.")
    ] = None,
    cable: Annotated[str, typer.Option(metavar="CABLE", help="Cable that `cell` homogenizes.")] = REFERENCE_CABLE,
    element: Annotated[
        Literal["rod", "ancf-cable"] | None,
        typer.Option(help="`rod` (shear and torsion) or `ancf-cable` (neither, faster)."),
    ] = None,
    chain: Annotated[
        Literal["clamps", "smeared"] | None,
        typer.Option(help="`clamps`: a chain of bodies; `smeared`: mass on the cable, faster."),
    ] = None,
    show_list: Annotated[bool, typer.Option("--list", help="List the built-in scenarios.")] = False,
    json: JsonOption = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Write run.nc, curves and pictures here.")
    ] = None,
    effects: EffectsOption = None,
    accurate: Annotated[
        bool,
        typer.Option(
            "--accurate", help="Half the step, iterated nearly to round-off: energy closed to 1e-6 of the work."
        ),
    ] = False,
    animate: Annotated[
        bool,
        typer.Option("--animate", help="With --out: animation (GIF; MP4 where ffmpeg is) and an interactive page."),
    ] = False,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the run in DIR/run.nc that was ended from outside.")
    ] = False,
) -> None:
    """Run a towing scenario: static start, contact, friction, forces along the cable.

    Example: `helicable tow intelligent-horizontal --constants published --out towing`
    """
    if show_list:
        table(
            "Built-in scenarios",
            ("name", "title"),
            [(s.name, s.title) for s in map(read_scenario, builtin_scenarios())],
        )
        return
    if scenario is None:
        raise SpecError("no scenario was named: try helicable tow intelligent-horizontal, or helicable tow --list.")
    if resume and out is None:
        raise SpecError("--resume needs --out DIR, the folder in which the run was being written.")
    if animate and out is None:
        raise SpecError("--animate needs --out DIR, the folder that the animation is written to.")
    file = None if out is None else folder(out) / "run.nc"
    found = None
    if effects:
        found = found_effects(effects).into(chosen_scenario(scenario, constants, element, chain))
        show_effects(found)
    run, used = towing_run(
        scenario,
        constants,
        cable,
        element=element,
        chain=chain,
        file=file,
        resume=resume,
        accurate=accurate,
        found=found,
    )
    show_run(run, used)
    record = towing_json(run, used)
    if found is not None:
        without, _ = towing_run(scenario, constants, cable, element=element, chain=chain, accurate=accurate)
        record["without_effects"] = show_change(without, run, found)
        record["effects"] = {"changes": list(found.notes), "aside": list(found.aside)}
    if out is not None:
        table_file = write_contact_table(run.dataset, folder(out) / "contacts.csv")
        bending = bending_history(run.dataset).write(out / "bending.csv", run.scenario.cable.diameter.value)
        written = [run.write(folder(out) / "run.nc"), table_file, bending, *draw_run(run, out)]
        written += write_fatigue(run, out)
        if animate:
            written += animate_run(run, out)
        record["run"] = str(written[0])
        write_json(out / "tow.json", record)
        say("written: " + ", ".join(map(str, written)))
    write_json(json, record)
    if not run.outcome.completed:
        raise ConvergenceError(run.status)


def towing_run(
    scenario: str,
    constants: str | None,
    cable: str,
    cell: SectionStiffness | None = None,
    element: str | None = None,
    file: Path | None = None,
    resume: bool = False,
    chain: str | None = None,
    found: ScenarioWithEffects | None = None,
    accurate: bool = False,
) -> tuple[TowingRun, BeamConstants]:
    """Read a scenario, resolve its constants (`cell`, if given, is the section of the cable), and run it with progress.

    With a `file` the run is written there while it goes; with `resume` it goes on from what is there. With `found` effects their
    scenario is run, and their laws act in the rod.
    """
    read = chosen_scenario(scenario, constants, element, chain) if found is None else found.scenario
    used = beam_constants(read, cable, cell)
    with progress("towing") as tell:
        law = RodLaw(used.section, found.section) if found is not None and found.section else None
        settings = accurate_settings(read) if accurate else None
        run = run_towing(read, used.section, progress=tell, law=law, file=file, resume=resume, settings=settings)
    return run, used


def chosen_scenario(scenario: str, constants: str | None, element: str | None, chain: str | None) -> Scenario:
    """A scenario with what the options say; an ANCF cable has no rotations for clamps: unless `chain` says otherwise they become mass."""
    chain = chain or ("smeared" if element == "ancf-cable" else None)
    choices = {"constants": constants, "element": element, "chain": chain}
    return read_scenario(scenario).changed(**{key: value for key, value in choices.items() if value is not None})


WHY = {
    "node_54_Fx_plateau": "the pull is friction on the upper strand plus the tension that comes through the bend: clamp mass, friction, "
    "lengths and slack are not published, and the published simulation is scaled 1 : 2.5. A stiff cable without slack is held taut, so "
    "that a value near the published one confirms nothing",
    "node_220_Fy_plateau": "the force across the cable where it leaves the bend: it follows the bend radius and the bending stiffness; the "
    "clamps, which carry the bend in the real chain, enter here as mass only. The sign is that of this project's axes",
    "node_370_Fx_max": "the tension left behind the bend: it follows the slack at the start (none here) and the friction of the lower "
    "strand",
}
"""Why a run whose clamps are mass on the cable differs from the source, by the key of the published value."""


def show_effects(found: ScenarioWithEffects) -> None:
    """Print what the effects change in the scenario, and which are left aside."""
    for one in found.section:
        say(f"{one.effect.name} ({one.kind}): acts in the section of the rod.")
    for note in found.notes:
        say(f"{note}.")
    for sentence in found.aside:
        say(f"left aside: {sentence}.")


def show_change(without: TowingRun, run: TowingRun, found: ScenarioWithEffects) -> dict[str, float]:
    """Print what the effects change in the towing prediction; the numbers without them."""
    before, after = without.record(), run.record()
    keys = {"peak_tension": "peak tension", "pull_force_plateau": "pull force, steady"}
    rows = [
        (words, f"{before[key]:.1f} N", f"{after[key]:.1f} N", f"{100 * (after[key] / before[key] - 1):+.2f} %")
        for key, words in keys.items()
    ]
    names = ", ".join(dict.fromkeys(a.effect.name for a in found.acting))
    table(f"What {names} changes", ("", "without", "with", "change"), rows, right=(1, 2, 3))
    return {key: before[key] for key in keys}


FORCES = (
    (
        "node 54, Fx, mean after 6 s",
        "node_54_Fx_plateau",
        ("54", "Fx_plateau"),
        "the pull is friction on the upper strand plus the tension that comes through the bend: clamp mass, friction, lengths and slack "
        "are not published, and the published simulation is scaled 1 : 2.5. A stiff cable without slack is held taut, so that "
        "a value near the published one confirms nothing",
    ),
    (
        "node 220, Fy, mean after 6 s",
        "node_220_Fy_plateau",
        ("220", "Fy_plateau"),
        "the force across the cable where it leaves the bend: it follows the bend radius and the bending stiffness; the clamps, which "
        "carry the bend in the real chain, enter here as mass only. The sign is that of this project's axes",
    ),
    (
        "node 370, Fx, largest",
        "node_370_Fx_max",
        ("370", "Fx_max"),
        "the tension left behind the bend: it follows the slack at the start (none here) and the friction of the lower strand",
    ),
)
"""Quantity, key of the published value, key of the computed one, why they differ."""


def published_rows(*runs: TowingRun) -> list[tuple[str, ...]]:
    """Quantity, published value, the value computed in each run, and why they differ; clamps as mass on the cable."""
    found = [{row.key: row for row in comparison(run.record())} for run in runs]
    return [
        (
            found[0][key].name,
            quantity_text(found[0][key].published, "N"),
            *(quantity_text(f[key].computed, "N") for f in found),
            why,
        )
        for key, why in WHY.items()
    ]


def comparison_rows(run: TowingRun) -> list[tuple[str, str, str, str]]:
    """Quantity, published, computed, computed over published."""
    return [
        (
            row.name, quantity_text(row.published, row.unit), quantity_text(row.computed, row.unit),
            "-" if row.ratio is None else f"{row.ratio:.2f}",
        )
        for row in comparison(run.record())
    ]  # fmt: skip


def quantity_text(value: float | None, unit: str) -> str:
    """A number of the comparison as text; lengths in mm.

    Examples
    --------
    >>> quantity_text(0.054, "m"), quantity_text(None, "N")
    ('54.0 mm', '-')
    """
    if value is None:
        return "-"
    return {"m": f"{1e3 * value:.1f} mm", "s": f"{value:.2f} s"}.get(unit, f"{value:.0f} {unit}")


def run_rows(run: TowingRun) -> list[tuple[str, str]]:
    """Facts about the run."""
    r = run.record()
    return [
        ("status", r["status"]),
        ("peak tension", f"{r['peak_tension']:.1f} N"),
        ("pull force, steady", f"{r['pull_force_plateau']:.1f} N"),
        *chain_rows(r),
        ("formula (22), largest", f"{r['formula_22_peak']:.1f} N"),
        ("formula (23), largest", f"{r['formula_23_peak']:.1f} N"),
        ("energy balance error", f"{abs(r['energy_balance_error']):.1e} of the throughput"),
        ("static residual at the start", f"{r['static_residual']['force']:.1e} N"),
        *contact_rows(r),
        ("deepest penetration", f"{1e3 * r['deepest_penetration']:.3f} mm"),
        (
            "time",
            f"{r['seconds_simulated']:.2f} s simulated in {r['seconds_wall']:.1f} s, {r['elements']} elements ({r['element']})",
        ),
    ]


def chain_rows(record: dict[str, Any]) -> list[tuple[str, str]]:
    """The clamp chain, and the real tensions by the source's similarity."""
    rows = [("pull force x 2.5 (similarity)", f"{record['similarity']['pull_force_plateau']:.0f} N")]
    if record["bushing_3_amplitude"] is not None:
        rows += [
            ("clamps", f"{record['clamps']}, largest angle of a pin {np.degrees(record['pin_angle_max']):.1f} deg"),
            ("chain, largest force", f"{record['chain_force_max']:.1f} N"),
            ("bushings of pin 2 x 2.5 (similarity)", f"{record['similarity']['bushing_3_pair']:.0f} N"),
        ]
    return rows


def contact_rows(record: dict[str, Any]) -> list[tuple[str, str]]:
    """What the cable touches, at the end of the run."""
    rows = []
    for name, one in record["contacts"].items():
        slip = one["slip_share_end"]
        state = "no contact" if slip is None else f"{100 * slip:.0f} % of it slips"
        if slip is not None and one["friction_max"] == 0:
            state = "smooth"
        rows.append(
            (f"on the {name}, at the end", f"{one['normal_end']:.1f} N, friction {one['friction_end']:.1f} N, {state}")
        )
    return rows


def show_run(run: TowingRun, used: BeamConstants) -> None:
    """Print the run."""
    say(f"[bold]{run.scenario.title}[/bold]\nconstants {used.sentence}\n")
    table("Run", ("", "value"), run_rows(run), right=())
    heads = ("", "published", "computed", "ratio")
    table("Published and computed", heads, comparison_rows(run), right=(1, 2, 3))


def towing_json(run: TowingRun, used: BeamConstants) -> dict[str, Any]:
    """The JSON of `helicable tow`."""
    return {**run.record(), "constants_from": used.sentence, "run": None}


def draw_run(run: TowingRun, out: Path) -> list[Path]:
    """Curves and the picture of the cable."""
    from beam.towing_curves_plot import courses_figure, forces_figure
    from beam.towing_plot import cable_figure, energy_figure, node_force_figure, pull_force_figure

    written = []
    figures = {
        "cable": cable_figure,
        "node-forces": node_force_figure,
        "pull-force": pull_force_figure,
        "forces": forces_figure,
        "courses": courses_figure,
        "energies": energy_figure,
    }
    for name, draw in figures.items():
        written.append(out / f"towing-{name}.png")
        draw(run).savefig(written[-1], dpi=150)
    return written


def write_fatigue(run: TowingRun, out: Path) -> list[Path]:
    """Ranges and rainflow cycles of the sections as CSV, and their picture."""
    from beam.fatigue_plot import fatigue_figure

    history = fatigue_history(run.dataset)
    picture = out / "towing-fatigue.png"
    fatigue_figure(run.dataset, history).savefig(picture, dpi=150)
    return [*history.write(out, run.scenario.cable.diameter.value), picture]


def animate_run(run: TowingRun, out: Path) -> list[Path]:
    """Animation of the run, and the page that moves it in a browser."""
    from beam.towing_animation import write_animation
    from beam.towing_page import write_page

    return [
        *write_animation(run.dataset, run.scenario, out),
        write_page(run.dataset, run.scenario, out / "towing.html"),
    ]

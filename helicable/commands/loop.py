"""`helicable loop`: tension, torsion or bending to and fro, of a cable whose parts rub."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Annotated, Any

import typer

from geometry import Cable, read_cable
from geometry.errors import InputError, SpecError
from geometry.units import read_quantity
from helicable.friction_run import CONTROLS, LOADS, QUARTERS, LoopResult, Settings, run_loop
from helicable.interface_words import read_laws
from helicable.options import CableArgument, JsonOption, OutOption, SizeOption
from helicable.screen import engineering, folder, progress, say, table, write_json
from homogenize import Coulomb


def loop(
    cable: CableArgument,
    load: Annotated[str, typer.Option(help=f"`{'`, `'.join(LOADS)}`.")] = "bending",
    amplitude: Annotated[
        str | None,
        typer.Option(
            help='Largest strain: "0.002" of stretch, "0.5 rad/m" of twist, "1 1/m" of curvature; with `--control force` largest force: '
            '"2 kN", "10 N m".'
        ),
    ] = None,
    control: Annotated[
        str, typer.Option(help="What is prescribed: `strain`, or `force` (then the strain of each step is found).")
    ] = "strain",
    interface: Annotated[
        str,
        typer.Option(
            help='Pairs that rub, with commas between; other laws as in "core-filler=elastic:1e9 Pa/m"; contact that opens: '
            '"core-filler=opening", with a gap "core-filler=opening:0.05 mm", with friction "core-filler=opening:0 mm+coulomb:0.3".'
        ),
    ] = "conductor-insulation",
    friction: Annotated[
        float, typer.Option(help="Friction coefficient of the pairs without a law of their own.")
    ] = 0.3,
    grip: Annotated[str, typer.Option(help="Pressure between the parts, the same everywhere.")] = "0.1 MPa",
    tension: Annotated[
        str | None,
        typer.Option(
            help="Constant tension, torsion and bending only: its own grip, place by place, is added; parts that can open are pulled by it."
        ),
    ] = None,
    tension_grips: Annotated[
        bool,
        typer.Option("--tension-grips", help="Tension: the grip follows the tension of each step, added to --grip."),
    ] = False,
    free_twist: Annotated[
        bool, typer.Option("--free-twist", help="Tension: the ends can turn, instead of no twist.")
    ] = False,
    steps: Annotated[int, typer.Option(help="Load steps of the whole path; five quarters for one cycle.")] = 200,
    cycles: Annotated[int, typer.Option(help="Closed cycles after the first loading.")] = 1,
    harmonics: Annotated[int, typer.Option(help="Bending: odd harmonics along the pitch, on four stations each.")] = 4,
    size: SizeOption = None,
    json: JsonOption = None,
    out: OutOption = None,
) -> None:
    """Follow a loop of tension, torsion or bending of a cable whose parts rub: slopes, area, heat, damping.

    Example: `helicable loop example-three-core --load tension --amplitude 0.002 --friction 0.3 --grip "0.1 MPa" --out loop`

    A given force, ends that can turn: `helicable loop example-three-core --load tension --control force --amplitude "200 N" --free-twist`

    Parts that open: `helicable loop example-three-core --load tension --amplitude 0.002 --interface "core-filler=opening" --grip 0Pa`
    """
    if load not in LOADS:
        raise SpecError(f'--load "{load}" is not known; choose {", ".join(LOADS)}.')
    if control not in CONTROLS:
        raise SpecError(f'--control "{control}" is not known; choose {" or ".join(CONTROLS)}.')
    if amplitude is None:
        word = LOADS[load].words[CONTROLS.index(control)]
        raise SpecError(f'--amplitude is missing: the largest {word} of the loop, such as "{_example(load, control)}".')
    unit = LOADS[load].unit if control == "strain" else LOADS[load].force
    settings = Settings(
        load=load,
        amplitude=read_quantity(amplitude, unit, "--amplitude"),
        interfaces=read_laws(interface, friction=friction),
        grip=read_quantity(grip, "Pa", "--grip"),
        tension=0.0 if tension is None else read_quantity(tension, "N", "--tension"),
        steps=steps,
        cycles=cycles,
        harmonics=harmonics,
        free_twist=free_twist,
        size=None if size is None else read_quantity(size, "m", "--size"),
        control=control,
        tension_grips=tension_grips,
    )
    made = read_cable(cable)
    _check(settings, made)
    with progress(f"{load} loop") as tell:
        result = run_loop(made, settings, tell)
    show_loop(result)
    record = loop_record(result)
    write_json(json, record)
    if out is not None:
        write_json(folder(out) / "loop.json", record)
        say(f"written: {out / 'loop.json'}, {write_table(result, out / 'loop.csv')}, {_draw(result, out / 'loop.png')}")


def _example(load: str, control: str) -> str:
    if control == "force":
        return "2 kN" if load == "tension" else "5 N m"
    return {"tension": "0.002", "torsion": "0.5 rad/m", "bending": "1 1/m"}[load]


def _check(s: Settings, cable: Cable) -> None:
    """Refuse what no loop can be made of."""
    if s.control == "strain":
        _check_strain(s, cable)
    elif not s.amplitude > 0:
        raise SpecError(f"--amplitude {s.amplitude:g} {s.unit} must be above zero.")
    if not s.opens and not any(isinstance(law, Coulomb) for law in s.interfaces.laws.values()):
        raise SpecError(
            "--interface names no pair that rubs or opens; give at least one pair without a law, with coulomb:0.3, or with opening."
        )
    if s.grip < 0:
        raise SpecError(f"--grip {s.grip:g} Pa is negative; parts that rub are pressed together.")
    if s.cycles < 1 or s.steps < 2 * (1 + QUARTERS * s.cycles):
        raise SpecError(
            f"--cycles {s.cycles} and --steps {s.steps} do not fit: a loop needs at least one cycle, and two steps for each of its "
            f"{1 + QUARTERS * max(s.cycles, 1)} quarters."
        )
    if s.free_twist and s.load != "tension":
        raise SpecError(f"--free-twist belongs to --load tension, not to {s.load}.")
    if s.tension != 0 and s.load == "tension":
        raise SpecError(
            "--tension is the constant tension of a torsion or bending loop; in a tension loop give the pressure by --grip, or "
            "let it follow the tension by --tension-grips."
        )
    if s.tension_grips and (s.load != "tension" or s.opens):
        raise SpecError(
            "--tension-grips belongs to --load tension with parts that do not open; elsewhere the grip is that of a constant --tension, "
            "and parts that open find their own pressure."
        )


def _check_strain(s: Settings, cable: Cable) -> None:
    radius = cable.outer_diameter / 2
    largest = s.amplitude * (1.0 if s.load == "tension" else radius)
    if not 0 < largest < 1:
        raise SpecError(
            f"--amplitude {s.amplitude:g} makes a strain of {largest:.3g} at the surface of the cable, radius {1e3 * radius:.3g} mm; "
            "it must lie between 0 and 1 (and a linear section asks for far less than 1)."
        )


def loop_notes(result: LoopResult) -> list[str]:
    """What limits the numbers."""
    K, s = result.slopes, result.settings
    notes = [_grip_note(s), _others(s)]
    if s.tension and not s.opens:
        open_share = float(result.loop.section.surface @ (result.grip == 0) / result.loop.section.surface.sum())
        notes.append(
            f"grip of the tension: {engineering(result.mean_grip, 'Pa')} on the mean, none on {100 * open_share:.0f} % of the surface"
        )
    gap = K["bonded"] - K["frictionless"]
    if s.opens:
        notes += _opening_notes(result)
    if not result.loop.section.rubs.any():
        return notes
    if result.slid == 0:
        notes.append("nothing slid: the section stays bonded; try a larger amplitude or a smaller grip")
    elif K["bonded"] - K["first_step"] > 0.01 * gap:
        notes.append(
            "parts slid in the very first step already; more steps or a smaller amplitude show the bonded slope"
        )
    if result.slid > 0 and K["last_step"] - K["frictionless"] > 0.01 * gap:
        notes.append(f"{100 * result.slid:.0f} % of the rubbing surface slid; a larger amplitude goes on to full slip")
    return notes


def _grip_note(s: Settings) -> str:
    if s.opens:
        return "where parts can open, pressure and friction are those of each step; displacements are small: nodes that meet stay pairs"
    if s.tension_grips:
        return (
            "the grip follows the tension of each step, zero where the tension pulls the parts apart; parts do not open"
        )
    return "the grip stays as it is, along the cable and during the loop; parts do not open"


def _opening_notes(result: LoopResult) -> list[str]:
    """What the contact did."""
    if not result.loop.is_open.any():
        return ["nothing opened: the grip or the load keeps the parts together"]
    widest = int(result.largest_gap.argmax())
    node = int(result.loop.gap[widest].max(axis=0).argmax())
    first, second = result.loop.section.parts[node]
    return [f"the largest gap is between {first} and {second}"]


def _others(s: Settings) -> str:
    """What the section does beside the strain that moves."""
    given = "the force is prescribed" if s.control == "force" else "the strain is prescribed"
    if s.load == "bending":
        rest = "no tension and no torque arise"
        if s.opens:
            rest = f"the tension is {engineering(s.tension, 'N')}, the twist is held at zero"
        return f"{given}; bending about an axis that stands still; {rest}"
    if s.load == "torsion":
        pulled = s.opens and s.tension
        return f"{given}; " + ("the tension stays, the stretch follows" if pulled else "the stretch is held at zero")
    return f"{given}; " + ("the ends are free to turn: no torque" if s.free_twist else "the twist is held at zero")


def show_loop(result: LoopResult) -> None:
    """Print slopes, area and damping."""
    s, load, K = result.settings, LOADS[result.settings.load], result.slopes
    strain, force = load.words
    rows = [
        (
            "slope, bonded",
            engineering(K["bonded"], load.stiffness),
            f"{force} over {strain} while all is closed and sticks",
        ),
        ("slope of the first step", engineering(K["first_step"], load.stiffness), "of the loop"),
        ("slope of the last step", engineering(K["last_step"], load.stiffness), "before the load turns round"),
        ("slope, frictionless", engineering(K["frictionless"], load.stiffness), "when every slip is free, all closed"),
        *_open_rows(result),
        (
            f"{force} at the amplitude",
            engineering(result.peak, load.force),
            f"{strain} {result.reached:.4g} {load.unit}".removesuffix(" 1"),
        ),
        ("area of the loop", _energy(result.area), "work of a cycle per length"),
        ("heat of the loop", _energy(result.heat), "friction times slip, per length"),
        ("damping ratio", f"{result.damping_ratio:.3g}", "heat / (2 pi force strain), equivalent viscous"),
    ]
    title = f"{result.cable.name}: {s.load} loop, {s.interfaces.describe()}, {_grip_words(s)}"
    table(title, ("quantity", "value", "definition"), rows, right=(1,))
    for note in loop_notes(result):
        say(f"- {note}")
    steps, stations, nodes = (n - k for n, k in zip(result.loop.slip.shape[:3], (1, 0, 0), strict=True))
    say(
        f"{steps} steps, {nodes} rubbing nodes on {stations} stations, {result.elements} elements, {result.seconds:.1f} s"
    )


def _open_rows(result: LoopResult) -> list[tuple[str, str, str]]:
    """What the table says of contact that opens."""
    if not result.settings.opens:
        return []
    share, gap, load = result.loop.open_share, result.largest_gap, LOADS[result.settings.load]
    e = result.loop.strain[:, result.strain]
    at = [
        f"{load.words[0]} {e[i]:.4g} {load.unit}".removesuffix(" 1") for i in (int(share.argmax()), int(gap.argmax()))
    ]
    return [
        ("slope, open", engineering(result.slopes["open"], load.stiffness), "when all that can open is open"),
        ("open, at most", f"{100 * share.max():.1f} %", f"of the surface that can open, at {at[0]}"),
        ("largest gap", f"{1e3 * gap.max():.4g} mm", f"at {at[1]}"),
    ]


def _energy(value: float) -> str:
    return "0 J/m" if value < 1e-15 else f"{value:.4g} J/m"


def _grip_words(s: Settings) -> str:
    of = "tension" if s.opens else "that of"
    pulled = f" and {of} {engineering(s.tension, 'N')}" if s.tension else ""
    return f"grip {engineering(s.grip, 'Pa')}{pulled}" + (" and that of the tension" if s.tension_grips else "")


def loop_record(result: LoopResult) -> dict[str, Any]:
    """The JSON of `helicable loop`."""
    s, found, i = result.settings, result.loop, result.strain
    opened = {"open_share": found.open_share, "largest_gap": result.largest_gap} if s.opens else {}
    return {
        "schema": 1,
        "cable": result.cable.name,
        "load": s.load,
        "control": s.control,
        "interface": s.interfaces.describe(),
        "grip": s.grip,
        "tension": s.tension,
        "mean_grip": result.mean_grip,
        "amplitude": s.amplitude,
        "cycles": s.cycles,
        "free_twist": s.free_twist,
        "tension_grips": s.tension_grips,
        "units": {
            "amplitude": s.unit,
            "strain": LOADS[s.load].unit,
            "force": LOADS[s.load].force,
            "slopes": LOADS[s.load].stiffness,
            "energy": "J/m",
        },
        "slopes": result.slopes,
        "peak_force": result.peak,
        "area": result.area,
        "dissipated": result.heat,
        "damping_ratio": result.damping_ratio,
        "slid": result.slid,
        "cone_violation": found.cone_violation,
        "mesh": {
            "elements": result.elements,
            "rubbing_nodes": len(found.section.surface),
            "stations": found.slip.shape[1],
        },
        "loop": {"strain": found.strain[:, i], "force": found.force[:, i], "dissipated": found.dissipation, **opened},
        "first_step": result.lead,
        "seconds": result.seconds,
        "notes": loop_notes(result),
    }


def write_table(result: LoopResult, path: Path) -> Path:
    """The loop as CSV, a row for each step, units in the header.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    load, found = LOADS[result.settings.load], result.loop
    strain, force = load.words
    head = [f"{strain} [{load.unit}]", f"{force} [{load.force}]", "heat [J/m]"]
    columns = [found.strain[:, result.strain], found.force[:, result.strain], found.dissipation]
    if result.settings.opens:
        head += ["open share [1]", "largest gap [m]"]
        columns += [found.open_share, result.largest_gap]
    try:
        with path.open("w", newline="", encoding="utf-8") as file:
            rows = csv.writer(file, lineterminator="\n")
            rows.writerow(head)
            rows.writerows([f"{value:.9g}" for value in row] for row in zip(*columns, strict=True))
    except OSError as error:
        raise InputError(f"{path} cannot be written: {error.strerror or error}; choose another place.") from None
    return path


def _draw(result: LoopResult, path: Path) -> Path:
    from homogenize.friction_loop_plot import draw_friction_loop

    s = result.settings
    return draw_friction_loop(
        result.loop,
        path,
        strain=result.strain,
        start=result.start,
        first=result.lead,
        title=f"{result.cable.name}: {s.load} loop",
        note=f"{s.interfaces.describe()}, {_grip_words(s)}; heat {_energy(result.heat)} a cycle, damping ratio {result.damping_ratio:.2g}",
    )

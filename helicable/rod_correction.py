"""`--full-rod` of `helicable explain` and `compare`: the chain corrected by the full rod, on the screen and on the page."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from compare.comparison import Comparison
from compare.findings_sentences import uncertain
from geometry.errors import ConvergenceError, InputError
from helicable.explain_panels import Panel
from helicable.report import Figure, Table
from helicable.screen import progress, sheet, table
from helicable.traffic_light import Light

if TYPE_CHECKING:
    from compare.output_space_mapping import RodCorrection

FullRod = Annotated[
    bool,
    typer.Option(
        "--full-rod",
        help="Run every distinctly led towing record once in the full rod at what was found, and fit again with the difference.",
    ),
]
_COMPUTED = (
    ("difference", "Tension of the full rod less that of the axial chain, both at the parameters of the last round."),
    ("noise floors", "Over the root mean square that the noise of the record alone is expected to have."),
    (
        "corrected",
        "Least squares of friction coefficient and strengths with the difference added to the chain, less the same least "
        "squares without it; added to what was found. A second round follows where one moves by more than 0.1 sigma.",
    ),
)
_SMALL = 0.5  # noise floors, rms, from which the difference is worth a look


def rod_correction(comparison: Comparison) -> tuple[RodCorrection | None, tuple[str, ...]]:
    """What the full rod says about a fit, or None and a sentence why it says nothing."""
    from compare.output_space_mapping import corrected_by_rod

    try:
        with progress("running the full rod") as tell:
            return corrected_by_rod(comparison, progress=tell), ()
    except (ConvergenceError, InputError) as error:
        return None, (f"--full-rod: {error}",)


def show_correction(correction: RodCorrection) -> None:
    """Print the sentence, the parameters and what is to be known about it."""
    sheet("Corrected by the full rod", [("", correction.sentence), ("", _errors(correction))])
    table("", _PARAMETER_COLUMNS, _parameters(correction), right=(1, 2, 3))
    table("Full rod less chain", _RECORD_COLUMNS, _records(correction), right=(2, 3, 4, 5))
    sheet("", [("-", note) for note in correction.notes])


def correction_panel(correction: RodCorrection, folder: Path) -> Panel:
    """The panel of the page, with its picture."""
    from compare.output_space_plot import plot_correction

    picture = plot_correction(correction, folder / "full-rod.png")
    worst = max(r.in_floors for r in correction.records)
    light = Light("good", "the chain is enough") if worst < _SMALL else Light("mind", f"{worst:.2g} noise floors apart")
    if any(abs(p.sigmas) > 1 for p in correction.parameters):
        light = Light("mind", "parameters move")
    return Panel(
        "Corrected by the full rod",
        "\n\n".join([correction.sentence, _errors(correction), *correction.notes]),
        [Figure(picture, "Tension of the full rod less that of the chain, over the noise floor of each channel")],
        [
            Table("Parameters", _PARAMETER_COLUMNS, _parameters(correction), right=(1, 2, 3)),
            Table("Differences (SI units)", _RECORD_COLUMNS, _records(correction), right=(2, 3, 4, 5)),
        ],
        light,
        _COMPUTED,
    )


_PARAMETER_COLUMNS = ("parameter", "with the chain", "corrected", "moved [sigma]")
_RECORD_COLUMNS = ("records", "channel", "largest", "rms", "noise floor", "rms [floors]")


def _parameters(correction: RodCorrection) -> list[tuple[str, ...]]:
    return [
        (p.name, uncertain(p.before, p.std, p.unit), uncertain(p.after, p.std, p.unit), f"{p.sigmas:+.2f}")
        for p in correction.parameters
    ]


def _records(correction: RodCorrection) -> list[tuple[str, ...]]:
    return [
        (", ".join(r.experiments), r.channel, *(f"{v:.3g}" for v in (r.largest, r.rms, r.floor, r.in_floors)))
        for r in correction.records
    ]


def _errors(correction: RodCorrection) -> str:
    words = [f"{name} {chain:.3g} -> {corrected:.3g}" for name, (chain, corrected) in correction.errors.items()]
    return f"Error over the noise floor, chain -> corrected: {', '.join(words)}."

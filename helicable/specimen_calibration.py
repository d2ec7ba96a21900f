"""A cable file and targets to a calibrated specimen: the search with its cheap and its full model, and the new cable file."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from compare.evaluation_store import EvaluationStore
from compare.input_calibration import InputCalibration, calibrate_inputs
from compare.target_file import INTERFACE, InputParameter
from geometry.cable_change import ChangedNumber, changed_cable_text
from helicable.calibration_case import CalibrationCase, changes, full_model, is_interface, written
from helicable.specimen_surrogate import SpecimenSurrogate, start_of

Progress = Callable[[float, str], None]


def calibrate_case(
    case: CalibrationCase,
    store: EvaluationStore,
    most_runs: int = 8,
    starts: int = 24,
    progress: Progress | None = None,
    snapshots: Path | None = None,
) -> tuple[InputCalibration, SpecimenSurrogate]:
    """Calibrate; snapshots, kept in a folder if one is named, take the first third of the progress."""
    tell = progress or (lambda fraction, sentence: None)
    cheap = SpecimenSurrogate(case, lambda f, s: tell(f / 3, s), folder=snapshots)
    found = calibrate_inputs(
        case.file.targets,
        case.file.parameters,
        cheap,
        full_model(case),
        store=store,
        identity=case.identity,
        refine=cheap.refine,
        recentre=cheap.recentre,
        most_runs=most_runs,
        starts=starts,
        first=start_of(case.file.parameters),
        progress=lambda f, s: tell((1 + 2 * f) / 3, s),
    )
    return found, cheap


def calibrated_text(case: CalibrationCase, found: InputCalibration, name: str) -> str:
    """The cable file with the calibrated values; every changed number says what it was calibrated to."""
    errors = dict(zip(found.identifiability.names, found.identifiability.standard_error, strict=True))
    names = ", ".join(t.name for t in found.targets)

    def source(p: InputParameter) -> str:
        spread = f"{100 * errors[p.name]:.0f} %" if p.logarithmic else f"{errors[p.name]:.2g} {p.unit}"
        edge = ", at the end of its range" if p.name in found.identifiability.at_bound else ""
        return f"calibrated to {names} of {case.file.title.replace(chr(34), '')}, +- {spread} (one sigma){edge}; range: {p.reason}"

    text = _with_specimen(case, changed_cable_text(case.text, changes(case, found.best.inputs, source)), found, source)
    note = f"Calibrated to {names} of {case.file.title}. What is sloppy is not measured: see the report of the calibration."
    lines = text.split("\n")
    for i, line in enumerate(lines):
        if line.startswith("name ="):
            lines[i] = f'name = "{name}"'
        if line.startswith("notes = ["):
            lines.insert(i + 1, f'    "{note}",')
            break
    return "\n".join(lines)


def _with_specimen(
    case: CalibrationCase, text: str, found: InputCalibration, source: Callable[[InputParameter], str]
) -> str:
    """The text with its table [specimen]: calibrated length and phase, the ends and the interface of the model."""
    numbers = {
        p.moves[0]: ChangedNumber(
            written(found.best.inputs[p.name], p.unit),
            "computed",
            source(p),
            (written(p.low, p.unit), written(p.high, p.unit)),
        )
        for p in found.parameters
        if p.moves in (("length",), ("phase",))
    }
    laws = [
        f"{move.removeprefix(INTERFACE)}=elastic:{written(found.best.inputs[p.name], p.unit)}"
        for p in found.parameters
        if is_interface(p)
        for move in p.moves
    ]
    interface = f'interface = "{", ".join(laws) or "bonded"}"'
    if "[specimen]" in text:
        text = changed_cable_text(text, {f"specimen.{key}": number for key, number in numbers.items()})
        return re.sub(r'^interface = ".*"', interface, text, flags=re.MULTILINE) if laws else text
    entries = "\n".join(f"{key} = {number.text}" for key, number in numbers.items())
    return text.rstrip("\n") + f'\n\n[specimen]\n{entries}\nloaded = "uniform"\nheld = "fixed"\n{interface}\n'

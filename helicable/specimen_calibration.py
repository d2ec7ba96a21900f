"""A cable file and targets to a calibrated specimen: which parts a parameter moves, the cheap and the full model, the new file.

The cheap model is a reduced basis on few layers and the section mesh at the start of the search; the full model meshes the changed cable
anew and solves it on the mesh of :func:`homogenize.specimen.specimen_mesh.specimen_mesh` with graded layers.
"""

from __future__ import annotations

import hashlib
import math
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from compare.evaluation_store import EvaluationStore
from compare.input_calibration import InputCalibration, calibrate_inputs
from compare.multi_start import sobol_starts
from compare.target_file import InputParameter, TargetFile
from geometry import Cable, CrossSectionMesh, read_cable
from geometry.cable_change import ChangedNumber, changed_cable_text
from geometry.cable_file import cable_files
from geometry.errors import SpecError
from homogenize.specimen import AxialGrading, Specimen, solve_specimen
from homogenize.specimen.reduced_basis import ReducedBasis, ReducedPlace, grow
from homogenize.specimen.snapshot_store import SnapshotStore
from homogenize.specimen.specimen_mesh import specimen_mesh
from homogenize.specimen.unit_response import UNIT_LOADS, UnitResponse, unit_response

Progress = Callable[[float, str], None]
TENSION, SHEAR = 2000.0, 500.0
"""Forces of the published load cases [N]."""
COARSE_GRADING = AxialGrading(end_size=0.1, largest=1.0, growth=4.0)
_SEEN = 1e-4
_STEP = 0.2
"""Of the range of a dimension."""
_SPREAD = 0.2
"""Share of the ranges, about the start, where snapshots are offered."""
_TOLERANCE, _COARSE_TOLERANCE = 1e-3, 3e-3


@dataclass(frozen=True)
class CalibrationCase:
    """A cable file's `name` and `text`, the targets, the element `size` [m] of the full model (None for its own), snapshots, and the
    element size [m] of the cheap model (None for that of the full one)."""

    name: str
    text: str
    file: TargetFile
    size: float | None = None
    snapshots: int = 10
    coarse: float | None = None

    @property
    def identity(self) -> dict[str, str]:
        """What decides a full run beside its inputs."""
        moved = ";".join(f"{p.name}={'+'.join(p.moves)}" for p in self.file.parameters)
        return {
            "cable": hashlib.sha256(self.text.encode()).hexdigest(),
            "size": "own" if self.size is None else f"{self.size:.6g}",
            "moves": moved,
            "model": "bonded specimen, traction all over the end, 1",
        }


def read_case(
    cable: str, file: TargetFile, size: float | None = None, snapshots: int = 10, coarse: float | None = None
) -> CalibrationCase:
    """The case of a built-in cable or a cable file.

    Raises
    ------
    SpecError
        If the cable cannot be read or a parameter moves what it does not have.
    """
    read_cable(cable)  # says what is wrong with it
    path = cable_files().get(cable, Path(cable))
    text = path.read_text(encoding="utf-8")
    case = CalibrationCase(path.stem, text, file, size, snapshots, coarse)
    cable_at(case, {p.name: p.low for p in file.parameters})
    if not any(p.moves == ("length",) for p in file.parameters):
        raise SpecError('the targets move no "length"; a specimen needs one: give it a range as narrow as it is known.')
    return case


def written(value: float, unit: str) -> str:
    """A value as it stands in a cable file.

    >>> written(7.1e7, "Pa"), written(0.2341, "m")
    ('71 MPa', '234.1 mm')
    """
    if unit == "Pa":
        return f"{value / 1e9:.7g} GPa" if value >= 1e9 else f"{value / 1e6:.7g} MPa"
    return f"{1e3 * value:.7g} mm" if unit == "m" else f"{value:.5g} {unit}"


def changes(
    case: CalibrationCase, values: Mapping[str, float], source: Callable[[InputParameter], str]
) -> dict[str, ChangedNumber]:
    """The numbers of the cable file that the values change."""
    found = {}
    for p in case.file.parameters:
        if p.moves in (("length",), ("phase",)):
            continue
        number = ChangedNumber(
            written(values[p.name], p.unit), "computed", source(p), (written(p.low, p.unit), written(p.high, p.unit))
        )
        for key in p.moves:
            found[key] = number
    return found


def cable_at(case: CalibrationCase, values: Mapping[str, float]) -> Cable:
    """The cable with its numbers changed, read as any other."""
    text = changed_cable_text(case.text, changes(case, values, lambda p: "tried by a calibration"))
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / f"{case.name}.toml"
        path.write_text(text, encoding="utf-8")
        return read_cable(path)


def _outputs(
    case: CalibrationCase, response: UnitResponse, values: Mapping[str, float], twist_rate: float
) -> dict[str, float]:
    phase = _of(case, "phase", values, 0.0)
    return response.outputs(TENSION, SHEAR, phase + twist_rate * response.length)


def _of(case: CalibrationCase, move: str, values: Mapping[str, float], other: float) -> float:
    return next((values[p.name] for p in case.file.parameters if p.moves == (move,)), other)


def full_model(
    case: CalibrationCase, progress: Progress | None = None
) -> Callable[[Mapping[str, float]], dict[str, float]]:
    """Outputs of the specimen at full resolution."""

    def run(values: Mapping[str, float]) -> dict[str, float]:
        cable = cable_at(case, values)
        mesh = specimen_mesh(cable, case.size)
        length = _of(case, "length", values, math.nan)
        specimen = Specimen(length, phase=-mesh.twist_rate * length)
        solution = solve_specimen(specimen, mesh, UNIT_LOADS, tolerance=_TOLERANCE, progress=progress)
        return _outputs(case, unit_response(solution), values, mesh.twist_rate)

    return run


def start_of(parameters: Sequence[InputParameter]) -> NDArray[np.float64]:
    """Where the search begins, in its coordinates: the start of each parameter, or the middle of its range."""
    found = [sum(p.bounds) / 2 for p in parameters]
    for i, p in enumerate(parameters):
        if p.start is not None:
            found[i] = math.log(p.start) if p.logarithmic else p.start
    return np.array(found)


class CheapModel:
    """Reduced basis of the specimen for moduli by groups of regions, lay and length; dimensions by a power law.

    A dimension changes the mesh, so that it is stepped once by a part of its range at the base place: the slope of the logarithm of each
    output is its part in the cheap model. Finished solutions are kept in `folder`, if there is one, and found again.
    """

    def __init__(
        self, case: CalibrationCase, progress: Progress | None = None, seed: int = 0, folder: Path | None = None
    ) -> None:
        self.case = case
        tell = progress or (lambda fraction, sentence: None)
        low, high = np.array([p.bounds for p in case.file.parameters]).T
        middle = start_of(case.file.parameters)
        self.base = {p.name: p.value(float(x)) for p, x in zip(case.file.parameters, middle, strict=True)}
        self.mesh_size = case.size if case.coarse is None else case.coarse
        self.moduli = [p for p in case.file.parameters if all(m.endswith(".E") for m in p.moves)]
        self.dimensions = [p for p in case.file.parameters if _is_dimension(p)]
        self._refuse_others()
        mesh = specimen_mesh(cable_at(case, self.base), self.mesh_size)
        self.hand = math.copysign(1.0, mesh.twist_rate)
        groups = self._groups(mesh)
        specimen = Specimen(self.base_length, grading=COARSE_GRADING)
        identity = {**case.identity, "coarse": f"{self.mesh_size}", "base": str(sorted(self.base.items()))}
        store = None if folder is None else SnapshotStore(folder, identity)
        self.basis = ReducedBasis(mesh, groups, specimen, tolerance=_COARSE_TOLERANCE, store=store)
        offered = middle + _SPREAD * (sobol_starts(low, high, case.snapshots + 4, seed) - middle)
        offered[0] = middle
        places = [
            self.place({p.name: p.value(float(v)) for p, v in zip(case.file.parameters, x, strict=True)})
            for x in offered
        ]
        share = case.snapshots / (case.snapshots + len(self.dimensions))
        self.residuals = grow(self.basis, places, case.snapshots, lambda f, s: tell(share * f, s))
        self.stepped: list[tuple[float, UnitResponse]] = []
        for i, p in enumerate(self.dimensions):
            tell(share + (1 - share) * i / len(self.dimensions), f"a step of {p.name}")
            self.stepped.append(self._step(p, store))

    @property
    def base_length(self) -> float:
        """Length at the middle of the ranges [m]."""
        return _of(self.case, "length", self.base, math.nan)

    def _refuse_others(self) -> None:
        for p in self.case.file.parameters:
            if not (_is_dimension(p) or p in self.moduli or p.moves in (("length",), ("phase",), ("lay-up.lay",))):
                raise SpecError(
                    f'the parameter "{p.name}" moves {", ".join(p.moves)} together; moduli (keys that end in .E), the lay, the length, '
                    "the phase and dimensions need a parameter each."
                )

    def _groups(self, mesh: CrossSectionMesh) -> list[int]:
        """The parameter that moves each region's modulus, seen by moving every one by a part of its own; -1 for none."""
        moved = {**self.base, **{p.name: self.base[p.name] * (1 + _SEEN * (g + 1)) for g, p in enumerate(self.moduli)}}
        regions = specimen_mesh(cable_at(self.case, moved), self.mesh_size).regions
        ratios = [r.material.E / q.material.E - 1 for r, q in zip(regions, mesh.regions, strict=True)]  # pyright: ignore[reportAttributeAccessIssue]
        return [round(ratio / _SEEN) - 1 for ratio in ratios]

    def _step(self, p: InputParameter, store: SnapshotStore | None) -> tuple[float, UnitResponse]:
        """Step in the coordinate of the search towards the farther end, and the response there."""
        at = math.log(self.base[p.name]) if p.logarithmic else self.base[p.name]
        low, high = p.bounds
        step = _STEP * (high - low) * (1 if high - at > at - low else -1)
        values = {**self.base, p.name: p.value(at + step)}
        key = {"stepped": p.name, "to": f"{values[p.name]:.9g}"}
        kept = None if store is None else store.response(key)
        if kept is None:
            mesh = specimen_mesh(cable_at(self.case, values), self.mesh_size)
            specimen = replace(self.basis.specimen, phase=-mesh.twist_rate * self.base_length)
            kept = unit_response(solve_specimen(specimen, mesh, UNIT_LOADS, tolerance=_COARSE_TOLERANCE))
            if store is not None:
                store.keep_response(key, kept)
        return step, kept

    def place(self, values: Mapping[str, float]) -> ReducedPlace:
        """Where the basis is asked; moduli of a group go with the value."""
        factors = tuple(values[p.name] / self.base[p.name] for p in self.moduli)
        lay = _of(self.case, "lay-up.lay", values, math.nan)
        rate = self.basis_rate if math.isnan(lay) else self.hand * 2 * math.pi / lay
        return ReducedPlace(factors or (), rate, _of(self.case, "length", values, math.nan))

    @property
    def basis_rate(self) -> float:
        """Twist rate of the cable file [rad/m]."""
        return self.basis.mesh.twist_rate

    def __call__(self, values: Mapping[str, float]) -> dict[str, float]:
        place = self.place(values)
        found = _outputs(self.case, self.basis.evaluate(place), values, place.twist_rate)
        if self.stepped:
            at_base = {
                **self.base,
                **{p.name: values[p.name] for p in self.case.file.parameters if p.moves == ("phase",)},
            }
            base_place = self.place(at_base)
            base = _outputs(self.case, self._base_response, at_base, base_place.twist_rate)
            for p, (step, response) in zip(self.dimensions, self.stepped, strict=True):
                there = _outputs(self.case, response, at_base, base_place.twist_rate)
                moved = (
                    math.log(values[p.name] / self.base[p.name])
                    if p.logarithmic
                    else values[p.name] - self.base[p.name]
                )
                for name, value in there.items():
                    found[name] *= (value / base[name]) ** (moved / step)
        return found

    @cached_property
    def _base_response(self) -> UnitResponse:
        return self.basis.evaluate(self.place(self.base))


def _is_dimension(p: InputParameter) -> bool:
    return p.unit == "m" and not {"length", "lay-up.lay"} & set(p.moves)


def calibrate_case(
    case: CalibrationCase,
    store: EvaluationStore,
    most_runs: int = 5,
    starts: int = 24,
    progress: Progress | None = None,
    snapshots: Path | None = None,
) -> tuple[InputCalibration, CheapModel]:
    """Calibrate; snapshots, kept in a folder if one is named, take the first half of the progress."""
    tell = progress or (lambda fraction, sentence: None)
    cheap = CheapModel(case, lambda f, s: tell(0.5 * f, s), folder=snapshots)
    found = calibrate_inputs(
        case.file.targets,
        case.file.parameters,
        cheap,
        full_model(case),
        store=store,
        identity=case.identity,
        most_runs=most_runs,
        starts=starts,
        first=start_of(case.file.parameters),
        progress=lambda f, s: tell(0.5 + 0.5 * f, s),
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
    if "[specimen]" in text:
        return changed_cable_text(text, {f"specimen.{key}": number for key, number in numbers.items()})
    entries = "\n".join(f"{key} = {number.text}" for key, number in numbers.items())
    return text.rstrip("\n") + f'\n\n[specimen]\n{entries}\nloaded = "uniform"\nheld = "fixed"\ninterface = "bonded"\n'

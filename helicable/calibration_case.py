"""What a calibration of a specimen moves: a cable file, the targets, and the full model of the changed cable.

The full model meshes the changed cable anew and solves it on :func:`homogenize.specimen.specimen_mesh.specimen_mesh` with graded layers.
"""

from __future__ import annotations

import hashlib
import math
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from compare.target_file import INTERFACE, InputParameter, TargetFile
from geometry import Cable, read_cable
from geometry.cable_change import ChangedNumber, changed_cable_text
from geometry.cable_file import cable_files
from geometry.errors import SpecError
from homogenize import Elastic, Interfaces
from homogenize.specimen import Specimen, solve_specimen
from homogenize.specimen.specimen_mesh import specimen_mesh
from homogenize.specimen.unit_response import UNIT_LOADS, UnitResponse, unit_response

Progress = Callable[[float, str], None]
TENSION, SHEAR = 2000.0, 500.0
"""Forces of the published load cases [N]."""
_TOLERANCE = 1e-3


@dataclass(frozen=True)
class CalibrationCase:
    """A cable file's `name` and `text`, the targets, the element `size` [m] of the full model (None for its own), snapshots, and the
    element size [m] of the cheap model (None for its own)."""

    name: str
    text: str
    file: TargetFile
    size: float | None = None
    snapshots: int = 12
    coarse: float | None = None

    @property
    def identity(self) -> dict[str, str]:
        """What decides a full run beside its inputs."""
        moved = ";".join(f"{p.name}={'+'.join(p.moves)}" for p in self.file.parameters)
        return {
            "cable": hashlib.sha256(self.text.encode()).hexdigest(),
            "size": "own" if self.size is None else f"{self.size:.6g}",
            "moves": moved,
            "model": "traction all over the end, 2",
        }


def read_case(
    cable: str, file: TargetFile, size: float | None = None, snapshots: int = 12, coarse: float | None = None
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
    low = {p.name: p.low for p in file.parameters}
    changed = cable_at(case, low)
    if (interfaces := interfaces_at(case, low)) != "bonded":
        interfaces.separated(specimen_mesh(changed, size))  # says what does not touch
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
        if p.moves in (("length",), ("phase",)) or is_interface(p):
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


def is_interface(p: InputParameter) -> bool:
    """Whether a parameter is the stiffness of interfaces."""
    return all(move.startswith(INTERFACE) for move in p.moves)


def interfaces_at(
    case: CalibrationCase, values: Mapping[str, float], only: InputParameter | None = None
) -> Interfaces | Literal["bonded"]:
    """The interfaces whose stiffness the parameters, or `only` one of them, move; the others are bonded."""
    laws = {
        move.removeprefix(INTERFACE): Elastic(values[p.name])
        for p in case.file.parameters
        if is_interface(p) and only in (None, p)
        for move in p.moves
    }
    return Interfaces(laws) if laws else "bonded"


def outputs_of(
    case: CalibrationCase, response: UnitResponse, values: Mapping[str, float], twist_rate: float
) -> dict[str, float]:
    """Outputs at the published forces; the phase among `values` turns the section."""
    phase = value_of(case, "phase", values, 0.0)
    return response.outputs(TENSION, SHEAR, phase + twist_rate * response.length)


def value_of(case: CalibrationCase, move: str, values: Mapping[str, float], other: float) -> float:
    """The value that moves a key of the case, or `other` where none does."""
    return next((values[p.name] for p in case.file.parameters if p.moves == (move,)), other)


def full_model(
    case: CalibrationCase, progress: Progress | None = None
) -> Callable[[Mapping[str, float]], dict[str, float]]:
    """Outputs of the specimen at full resolution."""

    def run(values: Mapping[str, float]) -> dict[str, float]:
        cable = cable_at(case, values)
        mesh = specimen_mesh(cable, case.size)
        length = value_of(case, "length", values, math.nan)
        specimen = Specimen(length, phase=-mesh.twist_rate * length, interface=interfaces_at(case, values))
        solution = solve_specimen(specimen, mesh, UNIT_LOADS, tolerance=_TOLERANCE, progress=progress)
        return outputs_of(case, unit_response(solution), values, mesh.twist_rate)

    return run

"""The targets of a calibration and the inputs that may move: a TOML file, read strictly.

A target is a published or measured number with its relative standard error and the load case it comes from; a parameter is
an input of the model with the range inside which it is plausible, where the range is from, and what it moves::

    [[targets]]
    name = "E"                      # an output of the model
    value = "142 MPa"
    error = 0.03                    # relative, one sigma
    load = "tension 2000 N"
    source = "..."

    [[parameters]]
    name = "sheath"
    moves = ["materials.chloroprene sheath.E"]   # keys of the cable file, or "length", "phase", "interface.core-filler"
    range = ["3 MPa", "12 MPa"]
    status = "assumed"
    reason = "..."
"""

from __future__ import annotations

import math
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from compare.text_file import decode, read_bytes, suggestion
from geometry.errors import SpecError
from geometry.units import read_quantity

UNITS = {"E": "Pa", "G_yoz": "Pa", "G_xoz": "Pa", "u_z": "m", "u_x": "m", "u_y": "m"}
"""Outputs of the specimen model that may be targets, with their SI units."""
STATUSES = ("published", "deduced", "assumed", "computed")
_TARGET_KEYS = {"name", "value", "error", "load", "source"}
_PARAMETER_KEYS = {"name", "moves", "range", "start", "status", "reason"}


@dataclass(frozen=True)
class Target:
    """A number to be met: SI `value`, its relative standard `error`, the `load` case it comes from, its `source`."""

    name: str
    value: float
    unit: str
    error: float
    load: str
    source: str


@dataclass(frozen=True)
class InputParameter:
    """An input that may move.

    Attributes
    ----------
    name : str
    moves : tuple of str
        Keys of the cable file that take the value together, or ``length``, ``phase`` of the specimen, or the tangential stiffness
        per area of interfaces, ``interface.`` and the two sides as in :class:`homogenize.interface_choice.Interfaces`.
    low, high : float
        Range, SI.
    start : float or None
        Where the model stands before the calibration, SI; None where the cable file says it.
    unit, status, reason : str
        SI unit; mark of the range; why it is this wide.
    logarithmic : bool
        Whether the search goes along ln of the value: both ends of the range positive.
    """

    name: str
    moves: tuple[str, ...]
    low: float
    high: float
    unit: str
    status: str
    reason: str
    start: float | None = None

    @property
    def logarithmic(self) -> bool:
        """Whether the search goes along the logarithm."""
        return self.low > 0

    @property
    def bounds(self) -> tuple[float, float]:
        """Ends of the range as the search sees them."""
        return (math.log(self.low), math.log(self.high)) if self.logarithmic else (self.low, self.high)

    def value(self, x: float) -> float:
        """SI value of a coordinate of the search, never outside the range."""
        return min(max(math.exp(x) if self.logarithmic else x, self.low), self.high)


@dataclass(frozen=True)
class TargetFile:
    """Targets and parameters of a calibration, with the title of the file."""

    title: str
    targets: tuple[Target, ...]
    parameters: tuple[InputParameter, ...]


def target_files() -> dict[str, Path]:
    """Target files that come with helicable, by name."""
    here = Path(__file__).resolve().parent
    folders = [here / "targets", here.parent / "data" / "targets"]
    return {path.stem: path for folder in folders if folder.is_dir() for path in sorted(folder.glob("*.toml"))}


def read_targets(name_or_path: str | Path) -> TargetFile:
    """Read a target file by its built-in name or its path.

    Raises
    ------
    SpecError
        One sentence with file, entry and key for whatever cannot be used.

    Examples
    --------
    >>> [t.name for t in read_targets("published").targets]
    ['E', 'G_yoz', 'G_xoz', 'u_z', 'u_x', 'u_y']
    """
    path = target_files().get(str(name_or_path), Path(name_or_path))
    file = path.name
    try:
        raw = tomllib.loads(decode(read_bytes(path, file), file))
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise SpecError(f"{file}: this is not valid TOML: {error}; check quotes, brackets and commas there.") from None
    _known_keys(raw, {"title", "targets", "parameters"}, file)
    targets = tuple(_target(entry, f"{file}, target {i}") for i, entry in enumerate(_entries(raw, "targets", file), 1))
    parameters = tuple(
        _parameter(entry, f"{file}, parameter {i}") for i, entry in enumerate(_entries(raw, "parameters", file), 1)
    )
    for kind, names in (("target", [t.name for t in targets]), ("parameter", [p.name for p in parameters])):
        for name in names:
            if names.count(name) > 1:
                raise SpecError(f'{file}: the {kind} "{name}" stands there {names.count(name)} times; keep one.')
    moved = [key for p in parameters for key in p.moves]
    for key in moved:
        if moved.count(key) > 1:
            raise SpecError(f'{file}: "{key}" is moved by {moved.count(key)} parameters; keep one.')
    return TargetFile(str(raw.get("title", path.stem)), targets, parameters)


def _entries(raw: dict[str, Any], key: str, file: str) -> list[Any]:
    found = raw.get(key)
    if not isinstance(found, list) or not found:
        raise SpecError(f"{file}: there are no [[{key}]]; a calibration needs at least one.")
    return found


def _known_keys(entry: Any, known: set[str], where: str) -> None:
    if not isinstance(entry, dict):
        raise SpecError(f"{where}: expected a table, found {entry!r}.")
    for key in entry:
        if key not in known:
            raise SpecError(f'{where}: the key "{key}" is not known here; {suggestion(key, sorted(known))}')


def _text(entry: dict[str, Any], key: str, where: str) -> str:
    value = entry.get(key)
    if not isinstance(value, str) or not value.strip():
        raise SpecError(f"{where}: {key} is missing; write it as text.")
    return value


def _target(entry: Any, where: str) -> Target:
    _known_keys(entry, _TARGET_KEYS, where)
    name = _text(entry, "name", where)
    if name not in UNITS:
        raise SpecError(f'{where}: the model has no output "{name}"; {suggestion(name, UNITS)}')
    value = read_quantity(entry.get("value"), UNITS[name], f"{where}, {name}")
    if value <= 0:
        raise SpecError(
            f"{where}, {name}: {entry['value']!r} is not positive; a misfit of logarithms needs positive targets."
        )
    error = entry.get("error", 0.05)
    if isinstance(error, bool) or not isinstance(error, int | float) or not 0 < error < 1:
        raise SpecError(
            f"{where}, {name}: error is {error!r}; it is a relative standard error between 0 and 1, such as 0.03."
        )
    return Target(name, value, UNITS[name], float(error), _text(entry, "load", where), _text(entry, "source", where))


INTERFACE = "interface."
"""Begins what moves the stiffness of an interface."""


def _unit(moves: list[str]) -> str:
    if moves == ["phase"]:
        return "rad"
    if all(m.startswith(INTERFACE) for m in moves):
        return "Pa/m"
    return "Pa" if all(m.endswith(".E") for m in moves) else "m"


def _parameter(entry: Any, where: str) -> InputParameter:
    _known_keys(entry, _PARAMETER_KEYS, where)
    name = _text(entry, "name", where)
    where = f"{where}, {name}"
    moves = entry.get("moves")
    if not isinstance(moves, list) or not moves or not all(isinstance(m, str) and m for m in moves):
        raise SpecError(
            f'{where}: moves is missing; list keys of the cable file, such as ["materials.screen.E"], or "length".'
        )
    unit = _unit(moves)
    limits = entry.get("range")
    if not isinstance(limits, list) or len(limits) != 2:
        raise SpecError(f'{where}: range is missing; write two values such as ["3 MPa", "12 MPa"].')
    low, high = (read_quantity(limit, unit, f"{where}, range") for limit in limits)
    if not low < high:
        raise SpecError(
            f"{where}: the range {limits[0]!r} to {limits[1]!r} is empty; the first value must be the smaller one."
        )
    if unit != "rad" and low <= 0:
        raise SpecError(f"{where}: the range starts at {limits[0]!r}; it must be positive.")
    start = None if "start" not in entry else read_quantity(entry["start"], unit, f"{where}, start")
    if start is not None and not low <= start <= high:
        raise SpecError(f"{where}: the start {entry['start']!r} lies outside the range {limits[0]!r} to {limits[1]!r}.")
    status = entry.get("status")
    if status not in STATUSES:
        raise SpecError(f"{where}: the status must be one of {', '.join(STATUSES)}, found {status!r}.")
    return InputParameter(name, tuple(moves), low, high, unit, status, _text(entry, "reason", where), start)

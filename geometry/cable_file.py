"""Read a cable file: from TOML text to a Cable, or one sentence that says what is wrong and where.

Built-in cables live in data/cables/ of the source tree, which an installed package carries as geometry/cables/.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from geometry.cable import Cable
from geometry.cable_assembly import assembled
from geometry.cable_schema import PLACE, CableTable
from geometry.errors import InputError, SpecError

LARGEST_FILE = 1_000_000


@dataclass(frozen=True)
class BuiltinCable:
    """Line of the list of built-in cables; diameter [m], mass per length [kg/m]."""

    name: str
    title: str
    outer_diameter: float
    mass_per_length: float


def cable_files() -> dict[str, Path]:
    """Built-in cable files by name."""
    here = Path(__file__).resolve().parent
    folders = [here / "cables", here.parent / "data" / "cables"]
    return {path.stem: path for folder in folders if folder.is_dir() for path in sorted(folder.glob("*.toml"))}


def builtin_cables() -> list[BuiltinCable]:
    """All built-in cables, by name."""
    cables = [read_cable(path) for _, path in sorted(cable_files().items())]
    return [BuiltinCable(c.name, c.title, c.outer_diameter, c.mass_per_length) for c in cables]


def read_cable(name_or_path: str | Path) -> Cable:
    """Read a cable by its built-in name or from a file.

    Parameters
    ----------
    name_or_path : str or Path
        A built-in name such as "mcpt-1.9-3.3-3x35", or the path of a TOML file.

    Raises
    ------
    SpecError
        If there is no such cable, or the file cannot be understood; the message names file and key.
    GeometryError
        If the parts of the cable do not fit.

    Examples
    --------
    >>> cable = read_cable("mcpt-1.9-3.3-3x35")
    >>> round(1e3 * cable.outer_diameter, 1), round(cable.mass_per_length, 2)
    (51.6, 4.05)
    """
    path = cable_files().get(str(name_or_path), Path(name_or_path))
    table = _validated(_parsed(path), path.name)
    try:
        return assembled(table)
    except InputError as error:
        raise type(error)(f"{path.name}: {error}") from None


def _parsed(path: Path) -> dict[str, Any]:
    try:
        if not path.is_file():
            known = ", ".join(sorted(cable_files()))
            raise SpecError(
                f'there is no cable "{path}": it is neither a built-in cable ({known}) nor a file; '
                "try one of these names, or the path of a cable file that ends in .toml."
            )
        if path.stat().st_size > LARGEST_FILE:
            raise SpecError(f"{path.name}: the file is larger than {LARGEST_FILE // 1000} kB, which no cable file is.")
        text = path.read_bytes().decode("utf-8")
    except UnicodeDecodeError:
        raise SpecError(f"{path.name}: the file is not text in UTF-8; save it as UTF-8.") from None
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise SpecError(f'the cable file "{path}" cannot be read: {error}.') from None
    try:
        return tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise SpecError(
            f"{path.name}: this is not valid TOML: {error}; check quotes, brackets and commas there."
        ) from None


def _validated(raw: dict[str, Any], file: str) -> CableTable:
    try:
        return CableTable.model_validate(raw)
    except ValidationError as error:
        sentences = [_sentence(problem) for problem in error.errors(include_url=False)]
        others = len(sentences) - 1
        more = f" (and {others} more problem{'s' if others > 1 else ''})" if others else ""
        raise SpecError(f"{file}: {sentences[0]}{more}") from None


def _sentence(problem: Any) -> str:
    """One pydantic problem as a sentence that starts with the key; entries of lists are counted from 1."""
    steps = problem["loc"]
    loc = [step for i, step in enumerate(steps) if not (i == 2 and step in ("strands", "cylinder", "ring", "laid"))]
    key = ".".join(str(step + 1 if isinstance(step, int) else step) for step in loc)
    match problem["type"]:
        case "value_error":
            return str(problem["ctx"]["error"]).replace(PLACE, key)
        case "missing":
            return f"{key}: this entry is missing; add it."
        case "extra_forbidden":
            return f"{key}: this key is not known here; remove it or check its spelling."
        case "literal_error":
            return f"{key}: {problem['input']!r} is not possible; expected {problem['ctx']['expected']}."
        case "model_type" | "dict_type" | "model_attributes_type":
            return f"{key}: expected a table, found {problem['input']!r}."
    return f"{key}: {problem['input']!r} is not possible: {problem['msg'][:1].lower()}{problem['msg'][1:]}."

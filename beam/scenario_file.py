"""Reading scenario files, and finding the built-in ones, with every fault as a sentence: file, key, what, what to try."""

from __future__ import annotations

import difflib
import tomllib
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from beam.scenario import Scenario
from geometry.errors import SpecError

_INSTALLED = Path(__file__).parent / "scenarios"
_SOURCE_TREE = Path(__file__).parent.parent / "data" / "scenarios"


def builtin_scenarios() -> list[str]:
    """Names of the scenarios that come with helicable."""
    return sorted(path.stem for path in _folder().glob("*.toml"))


def read_scenario(name_or_path: str | Path) -> Scenario:
    """A built-in scenario by its name, or one from a TOML file.

    Raises
    ------
    SpecError
        If there is no such scenario, or the file cannot be read, understood or be true.

    Examples
    --------
    >>> read_scenario("intelligent-horizontal").elements
    400
    """
    text = str(name_or_path)
    path = Path(name_or_path)
    if path.suffix != ".toml" and text in builtin_scenarios():
        path = _folder() / f"{text}.toml"
    elif not path.is_file():
        known = ", ".join(builtin_scenarios())
        raise SpecError(f"there is no scenario {text!r}: give the path of a .toml file, or one of {known}.")
    try:
        raw = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise SpecError(f"{path.name}: this is not valid TOML: {error}.") from None
    except (OSError, UnicodeDecodeError) as error:
        raise SpecError(f"{path.name}: the file cannot be read: {error}.") from None
    return check(raw, path.name)


def check(raw: dict[str, Any], file: str) -> Scenario:
    """Scenario from the parsed file, or a :class:`SpecError` with one line for every fault."""
    try:
        return Scenario.model_validate(raw)
    except ValidationError as error:
        faults = [f"{file}: {_sentence(fault)}" for fault in error.errors()]
        raise SpecError("\n".join(faults)) from None


def _folder() -> Path:
    return _INSTALLED if any(_INSTALLED.glob("*.toml")) else _SOURCE_TREE


def _sentence(fault: Any) -> str:
    place = [str(x) for x in fault["loc"]]
    key = ".".join(place)
    if fault["type"] == "missing":
        return f"the key {key} is missing; add it with value, status and source."
    if fault["type"] == "extra_forbidden":
        close = difflib.get_close_matches(place[-1], _keys(place[:-1]), n=1)
        hint = f"did you mean {close[0]}?" if close else f"known keys there are {', '.join(_keys(place[:-1]))}."
        return f"unknown key {key}; {hint}"
    message = fault["msg"].removeprefix("Value error, ")
    return f"{key}: {message}" if key else message


def _keys(place: list[str]) -> list[str]:
    model: type[BaseModel] = Scenario
    for name in place:
        found = model.model_fields.get(name)
        kinds = [found.annotation, *get_args(found.annotation)] if found else []
        parts = [kind for kind in kinds if isinstance(kind, type) and issubclass(kind, BaseModel)]
        if not parts:
            return []
        model = parts[0]
    return [field.alias or name for name, field in model.model_fields.items()]

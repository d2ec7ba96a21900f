"""An axis of a sweep: one entry of a scenario, or the choice of the constants, and the values it takes."""

from __future__ import annotations

import difflib
import re
from dataclasses import dataclass

from beam.scenario import Scenario
from geometry.errors import SpecError
from geometry.units import conversion, read_quantity

CONSTANTS = "constants"

_NUMBER = re.compile(r"^([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*)$")


@dataclass(frozen=True)
class Axis:
    """Values of one entry.

    Attributes
    ----------
    key : str
        Of the scenario, such as ``"layout.inclination"``, or ``"constants"``.
    texts : tuple of str
        Values as a scenario takes them, with unit.
    unit : str
        In which `numbers` are shown; empty for names.
    numbers : tuple of float
        Values in `unit`; their positions for names.
    """

    key: str
    texts: tuple[str, ...]
    unit: str = ""
    numbers: tuple[float, ...] = ()

    @property
    def name(self) -> str:
        """The key without its table."""
        return self.key.rpartition(".")[2]

    @property
    def label(self) -> str:
        """Name and unit."""
        return f"{self.name} [{self.unit}]" if self.unit not in ("", "1") else self.name


def sweepable(scenario: Scenario) -> dict[str, str]:
    """What can be swept: short name -> key of the scenario; ``constants`` is among them.

    Examples
    --------
    >>> from beam import read_scenario
    >>> sweepable(read_scenario("intelligent-horizontal"))["inclination"]
    'layout.inclination'
    """
    keys = [key for key in scenario.entries() if not key.startswith("published_results.")]
    return {CONSTANTS: CONSTANTS} | {key.rpartition(".")[2]: key for key in keys}


def read_axis(text: str, scenario: Scenario) -> Axis:
    """Axis from ``NAME=VALUES``, the values divided by commas; a unit behind the last counts for all that have none.

    Raises
    ------
    SpecError
        If the name is not known, a value cannot be read or computed, or one stands there twice.

    Examples
    --------
    >>> from beam import read_scenario
    >>> read_axis("inclination=0, 10, 35 deg", read_scenario("intelligent-horizontal")).texts
    ('0 deg', '10 deg', '35 deg')
    """
    name, sign, values = (part.strip() for part in text.partition("="))
    known = sweepable(scenario)
    key = name if name in known.values() else known.get(name)
    if not sign or not values:
        raise SpecError(f'"{text}" is no axis of a sweep; write NAME=VALUES, such as inclination="0,10,20 deg".')
    if key is None:
        close = difflib.get_close_matches(name, known, n=1)
        hint = f"did you mean {close[0]}? " if close else ""
        raise SpecError(f'"{name}" cannot be swept; {hint}What can be swept: {", ".join(known)}.')
    parts = tuple(part.strip().strip("\"'") for part in values.split(","))
    if "" in parts:
        raise SpecError(f'{name}: a value is missing in "{values}"; write values divided by commas.')
    axis = (
        Axis(key, parts, "", tuple(map(float, range(len(parts)))))
        if key == CONSTANTS
        else _numbers(key, parts, scenario)
    )
    twice = [x for i, x in enumerate(axis.texts) if axis.numbers[i] in axis.numbers[:i] or x in axis.texts[:i]]
    if twice:
        raise SpecError(f'{name}: the value "{twice[0]}" stands there twice.')
    return axis


def read_axes(texts: list[str], scenario: Scenario) -> list[Axis]:
    """All axes of a sweep; see :func:`read_axis`."""
    axes = [read_axis(text, scenario) for text in texts]
    names = [axis.name for axis in axes]
    twice = [name for i, name in enumerate(names) if name in names[:i]]
    if twice:
        raise SpecError(f"{twice[0]} is swept twice; put all its values into one --over.")
    return axes


def _numbers(key: str, parts: tuple[str, ...], scenario: Scenario) -> Axis:
    si = scenario.entries()[key].unit
    for part in parts:
        if not _NUMBER.match(part):
            read_quantity(part, si, key)  # says what is wrong
    units = [match.group(2) if (match := _NUMBER.match(part)) else "" for part in parts]
    unit = units[-1]
    if si != "1" and not unit:
        raise SpecError(
            f'{key}: "{parts[-1]}" has no unit; write it behind the last value, such as "{parts[-1]} {si}".'
        )
    texts = tuple(part if own or not unit else f"{part} {unit}" for part, own in zip(parts, units, strict=True))
    factor, offset = conversion(unit or "1", si, key)
    numbers = []
    for text in texts:
        number = (read_quantity(text, si, key) - offset) / factor
        _require_computable(key, text, scenario)
        numbers.append(float(f"{number:.12g}"))
    return Axis(key, texts, unit or "1", tuple(numbers))


def _require_computable(key: str, text: str, scenario: Scenario) -> None:
    """Refuse a value that this entry can never have; one that only clashes with others is left to its runs."""
    try:
        scenario.changed(**{key.replace(".", "__"): text})
    except SpecError as error:
        if f": {key}: " in str(error):
            raise SpecError(str(error)) from None

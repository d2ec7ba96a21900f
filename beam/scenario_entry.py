"""One number of a scenario file, with its unit, its status and its source.

An entry is a table ``{ value = "16 m", status = "assumed", range = ["12 m", "40 m"], source = "..." }``. The status is
``published``, ``deduced`` or ``assumed`` (then with the range to sweep); a value that was set for one run only is ``chosen``.
"""

from __future__ import annotations

from dataclasses import dataclass

from pydantic import BaseModel, BeforeValidator, ConfigDict

from geometry.errors import SpecError
from geometry.units import read_quantity

STATUSES = ("published", "deduced", "assumed", "chosen")
ENTRY_KEYS = ("value", "status", "source", "range")


class Part(BaseModel):
    """A table of a scenario file: entries by name, no others."""

    model_config = ConfigDict(frozen=True, extra="forbid", arbitrary_types_allowed=True)


@dataclass(frozen=True)
class Entry:
    """One number of a scenario: `value` in SI, as it was written, and where it comes from."""

    value: float
    unit: str
    text: str
    status: str
    source: str
    range: tuple[float, float] | None = None


def read_entry(raw: object, unit: str, low: float, high: float) -> Entry:
    """Entry from the table in a file; its value must lie in [low, high] and in its own range.

    Raises
    ------
    SpecError
        With the reason, without the place (the caller knows it).

    Examples
    --------
    >>> read_entry({"value": "16 m", "status": "published", "source": "drawing"}, "m", 0, 100).value
    16.0
    """
    if isinstance(raw, Entry):
        return raw
    if not isinstance(raw, dict):
        raise SpecError('write it as a table: { value = "1 m", status = "assumed", range = [...], source = "..." }.')
    unknown = sorted(set(raw) - set(ENTRY_KEYS))
    if unknown:
        raise SpecError(f"unknown key {unknown[0]!r}; an entry has the keys {', '.join(ENTRY_KEYS)}.")
    for key in ("value", "status", "source"):
        if key not in raw:
            raise SpecError(f"the key {key!r} is missing; every entry states value, status and source.")
    status, source = raw["status"], raw["source"]
    if status not in STATUSES:
        raise SpecError(f"status {status!r} is not one of {', '.join(STATUSES)}.")
    if not isinstance(source, str) or not source.strip():
        raise SpecError("the source is empty; say where the number comes from.")
    value = read_quantity(raw["value"], unit, "value")
    bounds = _read_range(raw.get("range"), unit, status)
    if not low <= value <= high:
        named = "" if unit == "1" else f" {unit}"
        raise SpecError(f"{raw['value']} is outside what can be computed, {low:g} to {high:g}{named}.")
    if bounds is not None and not bounds[0] <= value <= bounds[1]:
        raise SpecError(f"{raw['value']} lies outside its own range {raw['range'][0]} to {raw['range'][1]}.")
    return Entry(value, unit, str(raw["value"]), status, source, bounds)


def _read_range(raw: object, unit: str, status: str) -> tuple[float, float] | None:
    if raw is None:
        if status == "assumed":
            raise SpecError('an assumed value needs the range to sweep, such as range = ["1 m", "2 m"].')
        return None
    if not isinstance(raw, list) or len(raw) != 2:
        raise SpecError("a range has two ends.")
    low, high = (read_quantity(x, unit, "range") for x in raw)
    if low > high:
        raise SpecError(f"the range {raw[0]} to {raw[1]} is upside down.")
    return low, high


def quantity(unit: str, low: float, high: float) -> BeforeValidator:
    """Reader of an entry in `unit`, between `low` and `high`."""
    return BeforeValidator(lambda raw: read_entry(raw, unit, low, high))

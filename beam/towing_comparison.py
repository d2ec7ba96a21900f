"""Computed beside published: one row for every number that the source reports for a working condition."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

Record = dict[str, Any]


@dataclass(frozen=True)
class Row:
    """A published number and the computed one, both SI; `ratio` is None where one of them is missing."""

    name: str
    key: str
    unit: str
    published: float | None
    computed: float | None

    @property
    def ratio(self) -> float | None:
        """Computed over published."""
        if self.computed is None or not self.published:
            return None
        return self.computed / self.published


def _node(number: str, component: str) -> Callable[[Record], float | None]:
    return lambda record: record["nodes"][number][component]


def _contact(key: str) -> Callable[[Record], float | None]:
    return lambda record: record["contact_35"] and record["contact_35"][key]


QUANTITIES: tuple[tuple[str, str, str, Callable[[Record], float | None]], ...] = (
    ("node 54, Fx, mean after 6 s", "node_54_Fx_plateau", "N", _node("54", "Fx_plateau")),
    ("node 220, Fy, mean after 6 s", "node_220_Fy_plateau", "N", _node("220", "Fy_plateau")),
    ("node 370, Fx, largest", "node_370_Fx_max", "N", _node("370", "Fx_max")),
    ("bushing 3, amplitude", "bushing_3_amplitude", "N", lambda record: record["bushing_3_amplitude"]),
    ("contact 35 begins", "contact_35_start", "s", _contact("begins")),
    ("contact 35 is largest", "contact_35_maximum_at", "s", _contact("max_at")),
    ("sideways, largest", "lateral_displacement_max", "m", lambda record: record["lateral_displacement_max"]),
)
"""Quantity, key of the published value, unit, and where the computed one stands in the record of a run."""


def comparison(record: Record) -> list[Row]:
    """Rows of a run's record, see :func:`beam.towing_record.towing_record`; no published value where the source has none."""
    return [Row(name, key, unit, record["published"].get(key), read(record)) for name, key, unit, read in QUANTITIES]

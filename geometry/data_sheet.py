"""The computed cable beside its data sheet: difference, and whether it lies in the range that the sheet allows."""

from __future__ import annotations

from typing import NamedTuple

from geometry.cable import Cable

NAMES = {"outer_diameter": "outer diameter", "mass_per_length": "mass per length"}


class DataSheetRow(NamedTuple):
    """A quantity of the sheet in SI `unit`: `computed`, `stated`, and the range `low` to `high` (None if the sheet has none)."""

    name: str
    unit: str
    computed: float
    stated: float
    low: float | None
    high: float | None

    @property
    def difference(self) -> float:
        """Computed less stated, in `unit`; 0 where they differ by round-off only."""
        difference = self.computed - self.stated
        return 0.0 if abs(difference) < 1e-12 * self.stated else difference

    @property
    def percent(self) -> float:
        """Difference in per cent of the stated value."""
        return 100 * self.difference / self.stated

    @property
    def inside(self) -> bool | None:
        """Whether the computed value lies in the range; None if the sheet has none."""
        if self.low is None or self.high is None:
            return None
        return self.low <= self.computed <= self.high

    @property
    def verdict(self) -> str:
        """The range and whether the computed value lies in it, in words."""
        if self.low is None or self.high is None:
            return "the sheet states no range"
        factor, unit = (1e3, "mm") if self.unit == "m" else (1.0, self.unit)
        where = "inside" if self.inside else "OUTSIDE"
        return f"{where} {factor * self.low:.5g} .. {factor * self.high:.5g} {unit}"


def data_sheet_rows(cable: Cable) -> list[DataSheetRow]:
    """What the data sheet of the cable file states, beside the computed value; empty without a sheet.

    Examples
    --------
    >>> from geometry.cable_file import read_cable
    >>> [(row.name, round(row.percent, 1), row.verdict) for row in data_sheet_rows(read_cable("mcpt-1.9-3.3-3x35"))]
    [('outer diameter', 4.1, 'inside 47.2 .. 51.9 mm')]
    """
    rows = []
    for key, number in cable.data_sheet.items():
        assert isinstance(number.value, float)
        rows.append(DataSheetRow(NAMES[key], number.unit, getattr(cable, key), number.value, number.low, number.high))
    return rows

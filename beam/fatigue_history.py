r"""What tires a cable in a run: ranges and rainflow cycles of curvature and tension, section by section.

With the curvature kappa in the plane of the bend and the tension N, each averaged over an element, the ranges are max - min over
the run, and the rim of a cable of the diameter d is strained by d times half the range of the curvature. The cycles are counted by the
rainflow method, in which a small cycle interrupts a larger one without spoiling it. The range of one cycle that tires as all of
them do, where life falls with the power m of the range (S. S. Manson's and Basquin's laws, damages added after Miner), is

.. math:: \Delta_{eq} = \Bigl( \sum_i n_i \Delta_i^m \Bigr)^{1/m} .

Source: ASTM E1049-85, section 5.4.4; counted by the library rainflow. Which m a cable has is a matter of tests.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.errors import InputError

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

SMALLEST = 0.01
"""Share of the run's largest range below which a cycle is not counted."""


@dataclass(frozen=True)
class CycleCount:
    """Rainflow cycles of one course: `range`, `mean`, and `count` (0.5 or 1) of each, (k,)."""

    range: Array
    mean: Array
    count: Array

    @property
    def total(self) -> float:
        """Number of cycles."""
        return float(self.count.sum())

    def equivalent_range(self, exponent: float) -> float:
        """Range of the one cycle that tires as much, for the exponent m of the life."""
        if not self.range.size:
            return 0.0
        top = float(self.range.max())
        return top * float((self.count * (self.range / top) ** exponent).sum()) ** (1.0 / exponent)


def count_cycles(course: ArrayLike, smallest: float = 0.0) -> CycleCount:
    """Rainflow cycles of a course (time,) whose range is larger than `smallest`.

    Examples
    --------
    >>> cycles = count_cycles([0.0, 2.0, 1.0, 3.0, 0.0])
    >>> cycles.range.tolist(), cycles.count.tolist()
    ([1.0, 3.0, 3.0], [1.0, 0.5, 0.5])
    """
    import rainflow

    found = [cycle[:3] for cycle in rainflow.extract_cycles(np.asarray(course, dtype=float)) if cycle[0] > smallest]
    columns = np.array(found, dtype=float).reshape(-1, 3).T
    return CycleCount(columns[0], columns[1], columns[2])


@dataclass(frozen=True)
class FatigueHistory:
    """Of every element, from the supply: arc length of its middle `s` [m], curvature [1/m] and tension [N] (time, element).

    `bending_cycles` and `tension_cycles` are their rainflow cycles, one count an element.
    """

    time: Array
    s: Array
    curvature: Array
    tension: Array
    bending_cycles: Sequence[CycleCount]
    tension_cycles: Sequence[CycleCount]

    @property
    def curvature_range(self) -> Array:
        """Range of the curvature of every element [1/m]."""
        return np.ptp(self.curvature, axis=0)

    @property
    def tension_range(self) -> Array:
        """Range of the tension of every element [N]."""
        return np.ptp(self.tension, axis=0)

    def write(self, folder: str | Path, diameter: float, exponent: float = 5.0) -> list[Path]:
        """``fatigue-sections.csv``, one row an element, and ``fatigue-cycles.csv``, one row a cycle; `diameter` [m] for the rim.

        Raises
        ------
        InputError
            If the files cannot be written.
        """
        sections, cycles = Path(folder) / "fatigue-sections.csv", Path(folder) / "fatigue-cycles.csv"
        m = f"m = {exponent:g}"
        head = [
            "element", "s [m]", "curvature range [1/m]", "strain range at the rim [1]", "tension range [N]", "bending cycles",
            "tension cycles", f"equivalent curvature range, {m} [1/m]", f"equivalent tension range, {m} [N]",
        ]  # fmt: skip
        _write(sections, head, self._section_rows(diameter, exponent))
        _write(cycles, ["element", "s [m]", "quantity", "range", "mean", "count"], self._cycle_rows())
        return [sections, cycles]

    def _section_rows(self, diameter: float, exponent: float) -> Iterable[list[object]]:
        for e, (bend, pull) in enumerate(zip(self.bending_cycles, self.tension_cycles, strict=True)):
            kappa = float(self.curvature_range[e])
            numbers = [self.s[e], kappa, 0.5 * diameter * kappa, self.tension_range[e], bend.total, pull.total]
            numbers += [bend.equivalent_range(exponent), pull.equivalent_range(exponent)]
            yield [e, *(f"{x:.6g}" for x in numbers)]

    def _cycle_rows(self) -> Iterable[list[object]]:
        for quantity, counts in (("curvature [1/m]", self.bending_cycles), ("tension [N]", self.tension_cycles)):
            for e, one in enumerate(counts):
                for row in zip(one.range, one.mean, one.count, strict=True):
                    yield [e, f"{self.s[e]:.6g}", quantity, *(f"{x:.6g}" for x in row)]


def fatigue_history(data: xarray.Dataset) -> FatigueHistory:
    """Ranges and cycles of the sections of a run, see :attr:`beam.TowingRun.dataset`."""
    curvature = np.asarray(data["gauss_strain"].sel(strain="kappa_3").values, dtype=float).mean(axis=2)
    tension = np.asarray(data["gauss_force"].sel(strain="Gamma_1").values, dtype=float).mean(axis=2)
    least = [SMALLEST * float(np.ptp(course, axis=0).max()) for course in (curvature, tension)]
    counts = [
        [count_cycles(one, low) for one in course.T] for course, low in zip((curvature, tension), least, strict=True)
    ]
    return FatigueHistory(data["time"].values, data["s_gauss"].values.mean(axis=1), curvature, tension, *counts)


def _write(path: Path, head: list[str], rows: Iterable[list[object]]) -> None:
    try:
        with path.open("w", newline="", encoding="utf-8") as file:
            table = csv.writer(file)
            table.writerow(head)
            table.writerows(rows)
    except OSError as error:
        raise InputError(f"{path}: the fatigue history cannot be written there: {error}.") from None

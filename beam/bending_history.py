r"""Bending of every section of the cable over a run: curvature range and number of bends.

A section is bent once when its curvature rises from below a quarter to above three quarters of the run's largest curvature,
and again only after it has fallen below the quarter: what a bending test counts. With the signed curvature kappa in the plane of
the bend, averaged over an element,

.. math:: \Delta\kappa = \max_t \kappa - \min_t \kappa, \qquad \Delta\varepsilon = \tfrac12 d\,\Delta\kappa

are its ranges of curvature and of strain at the rim of a cable of the diameter d.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from geometry.errors import InputError

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

LOW, HIGH = 0.25, 0.75
"""Shares of the largest curvature between which a bend begins and ends."""


@dataclass(frozen=True)
class BendingHistory:
    """Of every element, from the supply: arc length of its middle `s` [m], curvature (time, element) [1/m], bends (element,)."""

    time: Array
    s: Array
    curvature: Array
    bends: NDArray[np.int64]

    @property
    def range(self) -> Array:
        """Range of the curvature of every element [1/m]."""
        return self.curvature.max(axis=0) - self.curvature.min(axis=0)

    def write(self, path: str | Path, diameter: float) -> Path:
        """CSV with one row an element; `diameter` [m] for the strain at the rim.

        Raises
        ------
        InputError
            If the file cannot be written.
        """
        path = Path(path)
        largest = np.abs(self.curvature).max(axis=0)
        try:
            with path.open("w", newline="", encoding="utf-8") as file:
                table = csv.writer(file)
                table.writerow(
                    [
                        "element",
                        "s [m]",
                        "largest curvature [1/m]",
                        "curvature range [1/m]",
                        "strain range at the rim [1]",
                        "bends",
                    ]
                )
                for e, s in enumerate(self.s):
                    row = (s, largest[e], self.range[e], 0.5 * diameter * self.range[e])
                    table.writerow([e, *(f"{x:.6g}" for x in row), int(self.bends[e])])
        except OSError as error:
            raise InputError(f"{path}: the bending history cannot be written there: {error}.") from None
        return path


def bending_history(data: xarray.Dataset) -> BendingHistory:
    """Bending of the sections of a run, see :attr:`beam.TowingRun.dataset`."""
    curvature = np.asarray(data["gauss_strain"].sel(strain="kappa_3").values, dtype=float).mean(axis=2)
    largest = float(np.abs(curvature).max())
    bends = np.array([count_bends(np.abs(one), largest) for one in curvature.T], dtype=np.int64)
    return BendingHistory(data["time"].values, data["s_gauss"].values.mean(axis=1), curvature, bends)


def count_bends(size: Array, largest: float) -> int:
    """How often the curvature `size` (time,) [1/m] rises from below :data:`LOW` to above :data:`HIGH` of `largest`.

    Examples
    --------
    >>> count_bends(np.array([0.0, 1.0, 0.6, 1.0, 0.1, 0.9]), 1.0)
    2
    """
    bent, count = bool(size[0] > LOW * largest), 0
    for x in size:
        if not bent and x > HIGH * largest:
            bent, count = True, count + 1
        elif bent and x < LOW * largest:
            bent = False
    return count

"""One experiment of a campaign: what was done, under which conditions, and what was recorded (SI units).

Measured numbers are called *record*; numbers that a model made are never put into these types.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from geometry.errors import InputError


@dataclass(frozen=True)
class Channel:
    """One recorded column: SI unit and read-only values of shape (n,)."""

    name: str
    unit: str
    values: NDArray[np.float64] = field(repr=False)


@dataclass(frozen=True)
class Record:
    """The table of one experiment.

    Attributes
    ----------
    time : (n,) array or None
        Strictly increasing instants [s]; None for a loop without a clock.
    prescribed : str
        Name of the channel that the rig imposed.
    measured : tuple of str
        Names of the channels that answered.
    channels : mapping of str to Channel
        Prescribed and measured channels by name, SI.
    """

    time: NDArray[np.float64] | None = field(repr=False)
    prescribed: str
    measured: tuple[str, ...]
    channels: Mapping[str, Channel]

    def __len__(self) -> int:
        return len(self.channels[self.prescribed].values)

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self.channels[name].values


@dataclass(frozen=True)
class Experiment:
    """One row of experiments.csv with its table.

    Attributes
    ----------
    id, kind, file, specimen : str
        As in the list; `specimen` is empty where it was not recorded.
    set : str
        ``calibrate``, ``validate`` or ``sealed``.
    conditions : mapping of str to float
        SI (temperature in K, angles in rad); a condition that was not recorded is absent.
    repeat_of, continues : str or None
        Ids of the experiment that this one repeats, or goes on from.
    direction : str or None
        ``x+``, ``x-``, ``y+`` or ``y-``: the plane of a shear or bending test.
    control : str or None
        The load, where the load was prescribed instead of the path.
    sha256 : str
        Of the bytes of the table, also of one that was not opened.
    table : Record or None
        None while the experiment is sealed; use :attr:`record`, which says so.
    """

    id: str
    kind: str
    file: str
    specimen: str
    set: str
    conditions: Mapping[str, float]
    repeat_of: str | None = None
    continues: str | None = None
    direction: str | None = None
    control: str | None = None
    sha256: str = ""
    table: Record | None = field(default=None, repr=False)

    @property
    def is_open(self) -> bool:
        """Whether the table has been read; a sealed one has not, until the campaign is opened on request."""
        return self.table is not None

    @property
    def record(self) -> Record:
        """What was recorded.

        Raises
        ------
        InputError
            If the experiment is sealed and was not opened.
        """
        if self.table is None:
            raise InputError(
                f"experiment {self.id} is sealed: its table {self.file} is read only after the explicit open_sealed()."
            )
        return self.table

    @property
    def length(self) -> float:
        """Specimen length [m]."""
        if "specimen length" not in self.conditions:
            raise InputError(f'experiment {self.id} needs its specimen length: fill the column "specimen length [m]".')
        return self.conditions["specimen length"]

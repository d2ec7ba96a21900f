r"""A NetCDF file that grows by one record at a time and can be read after any interruption.

The classic format with 64-bit offsets suits this: header, fixed data, then one block of bytes per record, and the number of
records at byte four of the header. A record is written first and counted afterwards, so that a file whose writer was killed
ends with the last whole record. Nothing is kept in memory, and reading maps the file.

Source: The NetCDF classic format specification, UCAR/Unidata (versions CDF-1 and CDF-2).
"""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from geometry.errors import InputError

if TYPE_CHECKING:
    import xarray

RECORD = "time"
"""The dimension that grows."""
COUNT_AT = 4
"""Byte of the header where the number of records stands."""


class RecordFile:
    """Open for appending; made by :meth:`create` or :meth:`reopen`.

    Attributes
    ----------
    records : int
        Whole records in the file.
    """

    def __init__(self, path: Path, layout: np.dtype[Any], begin: int, records: int) -> None:
        self.path, self.layout, self.begin, self.records = path, layout, begin, records

    @classmethod
    def create(cls, path: str | Path, empty: xarray.Dataset) -> RecordFile:
        """Start the file: `empty` has everything but the records, with a dimension ``time`` of length zero.

        All variables over ``time`` must be real numbers. Text attributes that shall change later need their final length.

        Raises
        ------
        InputError
            If the file cannot be written.
        """
        path = Path(path)
        part = path.with_name(path.name + ".part")
        try:
            header, layout = _header(empty)
            part.write_bytes(header)
            part.replace(path)
        except OSError as error:
            raise InputError(f"{path}: the run cannot be written there: {error}.") from None
        return cls(path, layout, len(header), 0)

    @classmethod
    def reopen(cls, path: str | Path, empty: xarray.Dataset, records: int) -> RecordFile:
        """Go on after the first `records` records of a file that was created with `empty`; later ones are dropped.

        Raises
        ------
        InputError
            If the file cannot be read, is another one, or has fewer records.
        """
        path = Path(path)
        header, layout = _header(empty)
        try:
            with path.open("rb") as file:
                start = file.read(len(header))
        except OSError as error:
            raise InputError(f"{path}: the run cannot be read from there: {error}.") from None
        if len(start) != len(header) or start[:COUNT_AT] != header[:COUNT_AT]:
            raise InputError(f"{path} is not the file of a run that was being written.")
        there = int.from_bytes(start[COUNT_AT : COUNT_AT + 4], "big")
        if there < records:
            raise InputError(f"{path} holds {there} instants of the run; {records} are needed to go on.")
        found = cls(path, layout, len(header), records)
        with path.open("r+b") as file:
            found._write_count(file)
            file.truncate(found.begin + records * layout.itemsize)
        return found

    def append(self, values: Mapping[str, Any]) -> None:
        """Add one record; `values` holds every variable over time.

        Raises
        ------
        InputError
            If it cannot be written, for instance because the disk is full; the records before it stay.
        """
        row = np.zeros((), self.layout)
        for name in self.layout.names or ():
            row[name] = values[name]
        try:
            with self.path.open("r+b") as file:
                file.seek(self.begin + self.records * self.layout.itemsize)
                file.write(row.tobytes())
                file.flush()
                self.records += 1
                self._write_count(file)
        except OSError as error:
            raise InputError(f"{self.path}: the run cannot be written on: {error}.") from None

    def restate(self, empty: xarray.Dataset) -> None:
        """Replace the header by the one of `empty`, which differs from the first in attributes of the same length only."""
        header, _ = _header(empty)
        if len(header) != self.begin:
            raise InputError(f"{self.path}: the new header has {len(header)} bytes, the old one {self.begin}.")
        header = header[:COUNT_AT] + self.records.to_bytes(4, "big") + header[COUNT_AT + 4 :]
        try:
            with self.path.open("r+b") as file:
                file.write(header)
        except OSError as error:
            raise InputError(f"{self.path}: the run cannot be written on: {error}.") from None

    def read(self, name: str) -> NDArray[Any]:
        """All records of a variable, (records, ...), big-endian; mapped from the file."""
        shape = (self.records,)
        table = np.memmap(self.path, self.layout, "r", offset=self.begin, shape=shape)
        return table[name]

    def _write_count(self, file: Any) -> None:
        file.seek(COUNT_AT)
        file.write(self.records.to_bytes(4, "big"))


def _header(empty: xarray.Dataset) -> tuple[bytes, np.dtype[Any]]:
    """Header and fixed data of a file without records, and the type of a record.

    The writer learns the size of a record from the first one; so one is written, and cut off again.
    """
    from scipy.io import netcdf_file

    grown = {
        name: (x.dims, np.zeros((1, *x.shape[1:])), x.attrs) for name, x in empty.variables.items() if RECORD in x.dims
    }
    one = (
        empty.drop_vars(list(grown))
        .assign({k: v for k, v in grown.items() if k != RECORD})
        .assign_coords({RECORD: grown[RECORD]})
    )
    made = bytes(one.to_netcdf(None, engine="scipy", format="NETCDF3_64BIT", unlimited_dims=[RECORD]))
    with netcdf_file(BytesIO(made), "r", mmap=False) as file:
        names = [(str(name), v.shape[1:]) for name, v in file.variables.items() if v.isrec]
    layout = np.dtype([(name, np.dtype(">f8"), shape) for name, shape in names])
    return made[:COUNT_AT] + bytes(4) + made[COUNT_AT + 4 : len(made) - layout.itemsize], layout

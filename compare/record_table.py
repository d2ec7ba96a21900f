"""The table of one experiment: a header ``name [unit]`` and rows of finite numbers, read strictly into SI.

pandas is imported here and nowhere else. A table that is not a clean rectangle of finite numbers is walked through once
more, cell by cell, only to name the row and column of its first defect.
"""

from __future__ import annotations

import csv
import io
import warnings
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from compare.experiment import Channel, Record
from compare.kinds import KINDS, PATHS_OF_A_LENGTH, Kind, Quantity, allowed_channels, channel_quantity, station
from compare.text_file import LARGEST, decode, number_defect, parse_column, separator_hint, split_header, suggestion
from geometry.errors import SpecError
from geometry.units import conversion, si_unit


def read_record(raw: bytes, name: str, kind: str, control: str | None, conditions: Mapping[str, float]) -> Record:
    """The record in the bytes of a table.

    Parameters
    ----------
    raw : bytes
        The file's content.
    name : str
        The file's name, as it shall appear in messages.
    kind : str
        Kind of the experiment, which fixes the channels.
    control : str or None
        The load, where the load was prescribed.
    conditions : mapping of str to float
        Conditions of the experiment in SI; an extension, rotation or deflection needs the specimen length.

    Raises
    ------
    SpecError
        One sentence with file, row and column for whatever is not understood.
    """
    head, _, body = decode(raw, name).partition("\n")
    cells = split_header(head, name)
    columns = [_column(cell, KINDS[kind], name, head) for cell in cells]
    names = [quantity.name for quantity, _ in columns]
    _refuse_twins(names, cells, name)
    prescribed, measured = _roles(names, KINDS[kind], control, name)
    if (
        path := next(n for n in names if n in KINDS[kind].paths)
    ) in PATHS_OF_A_LENGTH and "specimen length" not in conditions:
        raise SpecError(
            f'{name}, column "{path}": it needs the "specimen length [m]" of this experiment, '
            "which experiments.csv leaves empty."
        )
    values = _numbers(body, cells, name)
    channels = {}
    for (quantity, unit), cell, column in zip(columns, cells, values.T, strict=True):
        factor, offset = conversion(unit, quantity.unit, f'{name}, row 1, column "{cell}"')
        si = factor * column + offset
        _require_sane_size(si, quantity.unit, cell, name)
        si.setflags(write=False)
        channels[quantity.name] = Channel(quantity.name, quantity.unit, si)
    time = channels.pop("time").values if "time" in channels else None
    if time is not None:
        _require_running_forwards(time, values[:, names.index("time")], cells[names.index("time")], name)
    return Record(time, prescribed, measured, channels)


def _column(cell: str, kind: Kind, file: str, head: str) -> tuple[Quantity, str]:
    where = f'{file}, row 1, column "{cell}"'
    name, unit = parse_column(cell)
    known = allowed_channels(kind)
    if unit is None:
        hint = separator_hint(head)
        raise SpecError(
            f'{where}: every column needs its unit in brackets, such as "{kind.load} [{_unit_of(kind.load)}]".{hint}'
        )
    quantity = channel_quantity(name)
    if quantity is None or not (name in known or (kind.stations and station(name) is not None)):
        raise SpecError(f"{where}: a {kind.name} experiment has no channel of this name; {suggestion(name, known)}")
    if unit == "":
        raise SpecError(f"{where}: the brackets hold no unit; write [-] for a pure number.")
    found = si_unit(unit, where)
    if found not in quantity.accepts:
        conversion(unit, quantity.unit, where)  # says which dimensions differ
        raise SpecError(
            f"{where}: the unit [{unit}] is one of [{found}]; expected one that converts to [{quantity.unit}]."
        )
    return quantity, unit


def _unit_of(channel: str) -> str:
    quantity = channel_quantity(channel)
    return quantity.unit if quantity else "-"


def _refuse_twins(names: list[str], cells: list[str], file: str) -> None:
    for i, name in enumerate(names):
        if name in names[:i]:
            raise SpecError(
                f'{file}, row 1: "{cells[names.index(name)]}" and "{cells[i]}" are two columns for {name}; keep one.'
            )


def _roles(names: list[str], kind: Kind, control: str | None, file: str) -> tuple[str, tuple[str, ...]]:
    """The prescribed channel and the measured ones; a sentence for a missing or a surplus column."""
    paths = [name for name in names if name in kind.paths]
    if len(paths) > 1:
        raise SpecError(
            f"{file}, row 1: {' and '.join(paths)} both give the path of a {kind.name} "
            "experiment; keep the one that was recorded."
        )
    if not paths:
        wanted = " or ".join(f'"{p} [{_unit_of(p)}]"' for p in kind.paths)
        raise SpecError(f"{file}, row 1: the column {wanted} of a {kind.name} experiment is missing.")
    if kind.load not in names:
        raise SpecError(
            f'{file}, row 1: the column "{kind.load} [{_unit_of(kind.load)}]" of a {kind.name} experiment is missing.'
        )
    if control is not None and control not in (paths[0], kind.load):
        raise SpecError(
            f'{file}, row 1: experiments.csv names "{control}" as the control, but this table '
            f"prescribes {paths[0]} or {kind.load}."
        )
    prescribed = control or paths[0]
    return prescribed, tuple(name for name in names if name not in ("time", prescribed))


def _numbers(body: str, cells: list[str], file: str) -> NDArray[np.float64]:
    """Rows of finite numbers, shape (n, columns)."""
    import pandas

    if not body:
        raise SpecError(f"{file}: there is a header but no row of numbers.")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", pandas.errors.ParserWarning)  # rows longer than the header
            frame = pandas.read_csv(
                io.StringIO(body),
                header=None,
                names=list(range(len(cells))),
                index_col=False,
                dtype=np.float64,
                na_filter=False,
                skip_blank_lines=False,
                quoting=csv.QUOTE_NONE,
                float_precision="round_trip",
            )
        values = frame.to_numpy()
        failure = ""
    except (ValueError, OverflowError, pandas.errors.ParserWarning) as error:  # ParserError is a ValueError
        values, failure = np.full((1, len(cells)), np.nan), str(error)
    rectangular = body.count(",") == (len(cells) - 1) * len(values) and body.count("\n") + 1 == len(values)
    if failure or not rectangular or not np.isfinite(values).all():
        _blame(body, cells, file)
        raise SpecError(f"{file}: the rows cannot be read as numbers ({failure or 'ragged rows'}).")
    if len(values) < 3:
        raise SpecError(f"{file}: {len(values)} row(s) of numbers are not a record; it takes at least 3.")
    return np.ascontiguousarray(values)


def _blame(body: str, cells: list[str], file: str) -> None:
    """Raise the sentence for the first defect of the rows, if there is one."""
    for row, line in enumerate(body.split("\n"), start=2):
        found = line.split(",")
        if not line.strip():
            raise SpecError(f"{file}, row {row}: the row is blank.")
        if len(found) != len(cells):
            hint = separator_hint(line) if len(cells) > 1 else ""
            raise SpecError(f"{file}, row {row}: {len(found)} cell(s), but the header has {len(cells)} columns.{hint}")
        for cell, column in zip(found, cells, strict=True):
            if problem := _defect(cell.strip()):
                raise SpecError(f'{file}, row {row}, column "{column}": {problem}.')


def _defect(cell: str) -> str:
    problem = number_defect(cell) if cell else "the cell is empty"
    return f"{problem}; leave the whole row out where a channel was not recorded" if problem else ""


def _require_sane_size(si: NDArray[np.float64], unit: str, column: str, file: str) -> None:
    large = np.flatnonzero(np.abs(si) > LARGEST)
    if large.size:
        raise SpecError(
            f'{file}, row {large[0] + 2}, column "{column}": {si[large[0]]:.3g} {unit} is beyond {LARGEST:g}, whose '
            "square no computer can sum; check the unit and the value."
        )


def _require_running_forwards(time: NDArray[np.float64], written: NDArray[np.float64], column: str, file: str) -> None:
    late = np.flatnonzero(np.diff(time) <= 0)
    if late.size:
        i = int(late[0])
        verb = "runs backwards" if time[i + 1] < time[i] else "stands still"
        raise SpecError(
            f'{file}, row {i + 3}, column "{column}": time {verb}, from {written[i]:.10g} to '
            f"{written[i + 1]:.10g}; it must increase in every row."
        )

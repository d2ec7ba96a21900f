"""A campaign folder out of arrays, and the tables of the data sets, read by the names of their columns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geometry.errors import SpecError

Array = NDArray[np.float64]
_COLUMNS = ("id", "kind", "file", "specimen", "repeat_of", "set")


def read_table(path: Path, columns: Sequence[str]) -> Array:
    """The named columns of a CSV file with a header, shape (n, columns).

    Raises
    ------
    SpecError
        If the file is not there or has other columns.
    """
    if not path.is_file():
        raise SpecError(f"{path}: there is no such file; give the folder that holds the data sets.")
    head = path.read_text(encoding="utf-8").splitlines()[0].split(",")
    if head[: len(columns)] != list(columns):
        raise SpecError(f"{path}, row 1: the columns are {', '.join(head)}; expected {', '.join(columns)}.")
    return np.loadtxt(path, delimiter=",", skiprows=1, usecols=range(len(columns)))


def write_campaign(
    folder: Path, toml: str, rows: Sequence[Mapping[str, str]], tables: Mapping[str, Mapping[str, Array]]
) -> Path:
    """Write campaign.toml, experiments.csv and one table per experiment.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    toml : str
        Content of campaign.toml.
    rows : sequence of mappings
        Cells of experiments.csv by column; ``file`` follows from ``id``, what is absent stays empty.
    tables : mapping of str to mapping
        By id the columns ``name [unit]`` of the table.
    """
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "campaign.toml").write_text(toml, encoding="utf-8")
    columns = list(dict.fromkeys([*_COLUMNS, *(c for row in rows for c in row)]))
    lines = [",".join(columns)]
    for row in rows:
        cells = {"file": f"{row['id']}.csv", **row}
        lines.append(",".join(cells.get(c, "") for c in columns))
    (folder / "experiments.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    for id, table in tables.items():
        values = np.column_stack(list(table.values()))
        body = "\n".join(",".join(f"{v:.12g}" for v in row) for row in values)
        (folder / f"{id}.csv").write_text(f"{','.join(table)}\n{body}\n", encoding="utf-8")
    return folder


def monotonic_campaign(
    folder: Path, toml: str, row: Mapping[str, str], table: Mapping[str, Array], pieces: int
) -> Path:
    """Write one monotonic curve as `pieces` experiments of the set calibrate, each going on where the last one ended.

    A single record could not be left out of its own fit; its pieces can.
    """
    rows, tables, n = [], {}, len(next(iter(table.values())))
    for i, part in enumerate(np.array_split(np.arange(n), pieces)):
        id = f"part{i + 1}"
        rows.append({**row, "id": id, "set": "calibrate", "continues": "" if i == 0 else f"part{i}"})
        tables[id] = {name: values[part] for name, values in table.items()}
    return write_campaign(folder, toml, rows, tables)

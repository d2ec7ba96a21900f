"""experiments.csv: one row per experiment, read strictly; what is not understood is named with row and column."""

from __future__ import annotations

import csv
import difflib
import io
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from compare.kinds import CONDITIONS, DIRECTIONS, KINDS, SETS
from compare.text_file import decode, number_defect, parse_column, separator_hint, split_header, suggestion
from geometry.errors import SpecError
from geometry.units import conversion, si_unit

FILE = "experiments.csv"
_REQUIRED = ("id", "kind", "file", "specimen", "repeat_of", "set")
_OPTIONAL = ("direction", "continues", "control")


@dataclass(frozen=True)
class ListedExperiment:
    """One row of the list, before its table is looked at; `row` is the line in the file, `conditions` are SI."""

    row: int
    id: str
    kind: str
    file: str
    specimen: str
    set: str
    conditions: Mapping[str, float]
    repeat_of: str | None
    continues: str | None
    direction: str | None
    control: str | None


@dataclass(frozen=True)
class _Condition:
    name: str
    column: str
    factor: float
    offset: float


def read_experiment_list(raw: bytes) -> tuple[ListedExperiment, ...]:
    """All experiments of the list, in its order.

    Raises
    ------
    SpecError
        For a missing, doubled or unknown column, a cell that is not understood, a doubled id, or a reference to an
        experiment that is not there.
    """
    text = decode(raw, FILE)
    head, _, body = text.partition("\n")
    cells = split_header(head, FILE)
    _require_columns(cells, head)
    conditions = _conditions(cells)
    if not body:
        raise SpecError(f"{FILE}: there is a header but no experiment.")
    listed = []
    for row, found in _rows(body):
        if len(found) != len(cells):
            raise SpecError(f"{FILE}, row {row}: {len(found)} cell(s), but the header has {len(cells)} columns.")
        listed.append(_experiment(row, dict(zip(cells, (cell.strip() for cell in found), strict=True)), conditions))
    _check_ids(listed)
    for column in ("repeat_of", "continues"):
        _check_references(listed, column)
    return tuple(listed)


def _require_columns(cells: list[str], head: str) -> None:
    for name in _REQUIRED:
        if name not in cells:
            near = difflib.get_close_matches(name, [c for c in cells if c not in _OPTIONAL], n=1, cutoff=0.75)
            hint = f' Is "{near[0]}" meant?' if near and near[0] not in _REQUIRED else separator_hint(head)
            raise SpecError(f'{FILE}, row 1: the column "{name}" is missing.{hint}')


def _rows(body: str) -> Iterator[tuple[int, list[str]]]:
    """Cells of every row with its line in the file."""
    reader = csv.reader(io.StringIO(body))
    try:
        for found in reader:
            yield reader.line_num + 1, found
    except csv.Error as error:
        raise SpecError(f"{FILE}, row {reader.line_num + 1}: the row cannot be read ({error}).") from None


def _conditions(cells: list[str]) -> list[_Condition]:
    """The condition columns with their conversion to SI."""
    conditions: list[_Condition] = []
    for cell in cells:
        if cell in _REQUIRED or cell in _OPTIONAL:
            continue
        where = f'{FILE}, row 1, column "{cell}"'
        name, unit = parse_column(cell)
        if unit is None:
            known = [*_REQUIRED, *_OPTIONAL, *CONDITIONS]
            raise SpecError(
                f"{where}: not a known column, and not a condition with its unit, such as "
                f'"temperature [degC]"; {suggestion(cell, known)}'
            )
        if name in [c.name for c in conditions]:
            raise SpecError(f"{where}: a second column for {name}; keep one.")
        found = si_unit(unit, where)
        known_quantity = CONDITIONS.get(name)
        target = known_quantity.unit if known_quantity else found
        factor, offset = conversion(unit, target, where)
        if known_quantity and found not in (known_quantity.unit, *known_quantity.accepts):
            raise SpecError(
                f"{where}: the unit [{unit}] is one of [{found}]; expected one that converts to [{target}]."
            )
        conditions.append(_Condition(name, cell, factor, offset))
    return conditions


def _experiment(row: int, cells: Mapping[str, str], conditions: list[_Condition]) -> ListedExperiment:
    for name in ("id", "kind", "file", "set"):
        if not cells[name]:
            raise SpecError(f'{FILE}, row {row}, column "{name}": the cell is empty.')
    _require_known(row, "kind", cells["kind"], tuple(KINDS))
    _require_known(row, "set", cells["set"], SETS)
    kind = KINDS[cells["kind"]]
    direction = cells.get("direction") or None
    if direction is not None:
        _require_known(row, "direction", direction, DIRECTIONS)
        if kind.name not in ("shear", "bending"):
            raise SpecError(
                f'{FILE}, row {row}, column "direction": a {kind.name} experiment has no '
                "direction; leave the cell empty."
            )
    elif kind.name == "shear":
        raise SpecError(
            f'{FILE}, row {row}, column "direction": a shear experiment needs one of {", ".join(DIRECTIONS)}.'
        )
    control = cells.get("control") or None
    if control is not None:
        _require_known(row, "control", control, (*kind.paths, kind.load))
    return ListedExperiment(
        row=row,
        id=cells["id"],
        kind=kind.name,
        file=cells["file"],
        specimen=cells["specimen"],
        set=cells["set"],
        conditions={c.name: v for c in conditions if (v := _value(row, c, cells[c.column])) is not None},
        repeat_of=cells["repeat_of"] or None,
        continues=cells.get("continues") or None,
        direction=direction,
        control=control,
    )


def _require_known(row: int, column: str, word: str, known: tuple[str, ...]) -> None:
    if word not in known:
        raise SpecError(f'{FILE}, row {row}, column "{column}": "{word}" is not known; {suggestion(word, known)}')


def _value(row: int, condition: _Condition, cell: str) -> float | None:
    """SI value of a condition cell, None where it was not recorded."""
    if not cell:
        return None
    where = f'{FILE}, row {row}, column "{condition.column}"'
    if problem := number_defect(cell):
        raise SpecError(f"{where}: {problem}; leave the cell empty where it was not recorded.")
    value = condition.factor * float(cell) + condition.offset
    if condition.name == "specimen length" and value <= 0:
        raise SpecError(f"{where}: a specimen length must be positive, found {cell}.")
    if condition.name == "temperature" and value < 0:
        raise SpecError(f"{where}: {cell} is below absolute zero; check the unit of the column.")
    return value


def _check_ids(listed: list[ListedExperiment]) -> None:
    first: dict[str, int] = {}
    for experiment in listed:
        if experiment.id in first:
            raise SpecError(
                f'{FILE}, row {experiment.row}, column "id": "{experiment.id}" stands already in '
                f"row {first[experiment.id]}."
            )
        first[experiment.id] = experiment.row


def _check_references(listed: list[ListedExperiment], column: str) -> None:
    """A reference must name another experiment of the same kind, not in a ring, and not one that stays sealed."""
    by_id = {experiment.id: experiment for experiment in listed}
    for experiment in listed:
        target = getattr(experiment, column)
        if target is None:
            continue
        where = f'{FILE}, row {experiment.row}, column "{column}"'
        if target not in by_id:
            raise SpecError(f'{where}: there is no experiment "{target}"; {suggestion(target, by_id)}')
        other = by_id[target]
        if other.kind != experiment.kind:
            raise SpecError(
                f'{where}: "{target}" is a {other.kind} experiment and "{experiment.id}" a '
                f"{experiment.kind} experiment."
            )
        if column == "repeat_of" and (other.direction, other.control) != (experiment.direction, experiment.control):
            raise SpecError(
                f'{where}: "{target}" has another direction or control than "{experiment.id}", so it is not repeated.'
            )
        if column == "continues" and other.set == "sealed" and experiment.set != "sealed":
            raise SpecError(
                f'{where}: "{target}" is sealed, so that "{experiment.id}", which is not, cannot start where it ended.'
            )
        seen = {experiment.id}
        while target is not None:
            if target in seen:
                raise SpecError(f'{where}: following the column from "{experiment.id}" leads back to "{target}".')
            seen.add(target)
            target = getattr(by_id[target], column) if target in by_id else None

"""Bytes of a user's file to text, and the header ``name [unit]`` of a column."""

from __future__ import annotations

import csv
import difflib
import hashlib
import math
import re
from collections.abc import Iterable
from pathlib import Path

from geometry.errors import SpecError

_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
_NOT_FINITE = {"nan", "inf", "infinity"}
_MOST_NAMES = 12
LARGEST = 1e100  # of a value in SI: squares of it and their sums stay finite
_HEADER = re.compile(r"(?P<name>[^\[\]]+?)\s*\[(?P<unit>[^\[\]]*)\]")


def read_bytes(path: Path, name: str) -> bytes:
    """All bytes of a file; a sentence if it is missing, no file, unreadable or empty."""
    if not path.exists():
        raise SpecError(f"{name}: there is no such file in {path.parent}; check the name, capitals included.")
    if not path.is_file():
        raise SpecError(f"{name}: this is not a file.")
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise SpecError(f"{name}: the file cannot be read ({error.strerror}).") from None
    if not raw.strip():
        raise SpecError(f"{name}: the file is empty.")
    return raw


def digest(raw: bytes) -> str:
    """SHA-256 of the bytes, hexadecimal."""
    return hashlib.sha256(raw).hexdigest()


def decode(raw: bytes, name: str) -> str:
    """UTF-8 text with or without byte order mark, line ends made ``\\n``, white space at the end removed."""
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        row = raw[: error.start].count(b"\n") + 1
        raise SpecError(
            f"{name}, row {row}: byte {raw[error.start]:#04x} is not UTF-8 text; save the file as UTF-8."
        ) from None
    if "\0" in text:
        row = text[: text.index("\0")].count("\n") + 1
        raise SpecError(
            f"{name}, row {row}: the file holds a zero byte, so it is not plain UTF-8 text; save it as UTF-8."
        )
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    return text.rstrip()


def split_header(line: str, name: str) -> list[str]:
    """Cells of the first row, stripped; a sentence for an empty or a repeated one."""
    cells = [cell.strip() for cell in next(csv.reader([line]), [])]
    for i, cell in enumerate(cells):
        if not cell:
            raise SpecError(f"{name}, row 1, column {i + 1}: the column has no name.{_separator_hint(line)}")
        if cell in cells[:i]:
            raise SpecError(
                f'{name}, row 1: the column "{cell}" stands there twice, as column {cells.index(cell) + 1} and {i + 1}.'
            )
    return cells


def parse_column(cell: str) -> tuple[str, str | None]:
    """Name and unit of a header cell; the unit is None where no bracket stands.

    >>> parse_column("axial tension [kN]"), parse_column("id")
    (('axial tension', 'kN'), ('id', None))
    """
    match = _HEADER.fullmatch(cell)
    return (match["name"], match["unit"].strip()) if match else (cell, None)


def suggestion(word: str, known: Iterable[str]) -> str:
    """`` did you mean "bending"?`` for a near miss, the list of what is known otherwise."""
    known = list(known)
    close = difflib.get_close_matches(word, known, n=1, cutoff=0.75)
    if close and close[0] != word:
        return f'did you mean "{close[0]}"?'
    more = f" and {len(known) - _MOST_NAMES} more" if len(known) > _MOST_NAMES else ""
    return f"known are {', '.join(known[:_MOST_NAMES])}{more}."


def number_defect(cell: str) -> str:
    """What keeps a cell that is not empty from being a finite decimal number, as words; empty if nothing does.

    >>> number_defect("1.5e3"), number_defect("1,5")
    ('', '"1,5" is not a number')
    """
    if cell.lower().lstrip("+-") in _NOT_FINITE:
        return f'"{cell}" is not a finite number'
    if not _NUMBER.fullmatch(cell):
        return f'"{cell}" is not a number'
    return "" if math.isfinite(float(cell)) else f'"{cell}" is too large for a number'


def _separator_hint(line: str) -> str:
    other = {";": "semicolons", "\t": "tabs"}
    return next(
        (f" Cells seem to be separated by {word}; use commas." for mark, word in other.items() if mark in line), ""
    )


def separator_hint(line: str) -> str:
    """`` Cells seem to be separated by semicolons; use commas.`` where that is so, else nothing."""
    return _separator_hint(line) if "," not in line else ""

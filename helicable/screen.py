"""What the user sees in the terminal: progress, tables, and the sentences of success; results for machines go to JSON files."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn
from rich.table import Table
from rich.text import Text

from geometry.errors import InputError

console = Console(highlight=False)
errors = Console(stderr=True, highlight=False)

ProgressCallback = Callable[[float, str], None]


@contextmanager
def progress(title: str) -> Iterator[ProgressCallback]:
    """A progress bar for work that reports a fraction and a sentence; plain lines where there is no terminal."""
    if not errors.is_terminal:
        yield _plain_progress(title)
        return
    columns = (
        SpinnerColumn(),
        TextColumn("{task.fields[title]}"),
        BarColumn(bar_width=24),
        TimeElapsedColumn(),
        TextColumn("[dim]{task.description}"),
    )
    with Progress(*columns, console=errors, transient=True) as bar:
        task = bar.add_task("", total=1.0, title=title)
        yield lambda fraction, sentence: bar.update(task, completed=fraction, description=escape(sentence))


def _plain_progress(title: str) -> ProgressCallback:
    """A line when the work moves on by a quarter, at most one a second."""
    last = [-1.0, 0.0]

    def tell(fraction: float, sentence: str) -> None:
        now = time.monotonic()
        if fraction - last[0] >= 0.25 and now - last[1] > 1.0:
            last[:] = [fraction, now]
            errors.print(f"{title}: {100 * fraction:.0f} %, {sentence}", soft_wrap=True, markup=False)

    return tell


def table(title: str, columns: Sequence[str], rows: Sequence[Sequence[object]], *, right: Sequence[int] = ()) -> None:
    """Print a table; `right` lists the columns of numbers. Cells are text as it is, so that a unit in brackets stays."""
    made = Table(title=Text(title, style="bold"), title_justify="left", header_style="bold", box=None, pad_edge=False)
    for i, column in enumerate(columns):
        made.add_column(Text(column), justify="right" if i in right else "left", overflow="fold")
    for row in rows:
        made.add_row(*(Text(str(cell)) for cell in row))
    console.print(made)
    console.print()


def sheet(title: str, rows: Sequence[tuple[str, str]]) -> None:
    """Print a title and named paragraphs, wrapped to the terminal; an empty name goes on with the one above."""
    console.print(Text(title, style="bold"))
    made = Table.grid(padding=(0, 2, 0, 0))
    made.add_column(style="bold", no_wrap=True)
    made.add_column(overflow="fold")
    for name, text in rows:
        made.add_row(Text(name), Text(text))
    console.print(made)


def say(sentence: str) -> None:
    """Print a sentence."""
    console.print(sentence, soft_wrap=True)


def plain(text: str) -> str:
    """Text that is shown as it is, square brackets included.

    >>> plain("load = K [strain + a]")
    'load = K \\\\[strain + a]'
    """
    return escape(text)


def engineering(value: float, unit: str) -> str:
    """Four digits with an SI prefix.

    >>> engineering(5.198e6, "N"), engineering(70.396, "N m2"), engineering(0.0, "N")
    ('5.198 MN', '70.40 N m2', '0 N')
    """
    size = abs(value)
    if size == 0 or not math.isfinite(value):
        return f"{value:g} {unit}"
    factor, prefix = next((f, p) for f, p in ((1e9, "G"), (1e6, "M"), (1e3, "k"), (0.0, "")) if size >= f)
    scaled = value / (factor or 1.0)
    digits = max(0, 3 - math.floor(math.log10(abs(scaled))))
    return f"{scaled:.{min(digits, 6)}f} {prefix}{unit}"


def write_json(path: Path | None, record: Mapping[str, Any]) -> None:
    """Write a record for machines; numbers that are not finite become null, with a note that says which."""
    if path is None:
        return
    missing: list[str] = []
    clean = _finite(record, "", missing)
    if missing:
        clean.setdefault("notes", []).append("not available: " + ", ".join(missing))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(clean, indent=1) + "\n", encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path} cannot be written: {error.strerror or error}; choose another place.") from None


def folder(path: Path) -> Path:
    """Make the output folder, or say why it cannot be made."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(
            f"the folder {path} cannot be made: {error.strerror or error}; choose another place."
        ) from None
    return path


def _finite(value: Any, where: str, missing: list[str]) -> Any:
    if isinstance(value, Mapping):
        return {str(k): _finite(v, f"{where}.{k}" if where else str(k), missing) for k, v in value.items()}
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [_finite(v, where, missing) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        missing.append(where)
        return None
    return value

"""One self-contained HTML page: sections of text, pictures and tables, in the order of the data. jinja2 is imported here only."""

from __future__ import annotations

import base64
import datetime
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from geometry.errors import InputError
from helicable import __version__

MEDIA = {".png": "image/png", ".svg": "image/svg+xml", ".gif": "image/gif"}


@dataclass(frozen=True)
class Table:
    """A table: title, column heads, rows of text, and which columns are numbers."""

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[object]]
    right: Sequence[int] = ()
    note: str = ""


@dataclass(frozen=True)
class Figure:
    """A picture file and the sentence below it."""

    path: Path
    caption: str

    @property
    def source(self) -> str:
        """The picture as a data address, so that the page needs no other file."""
        data = base64.b64encode(self.path.read_bytes()).decode("ascii")
        return f"data:{MEDIA[self.path.suffix]};base64,{data}"


@dataclass(frozen=True)
class Section:
    """One step on the path of the data."""

    title: str
    text: str = ""
    figures: Sequence[Figure] = ()
    tables: Sequence[Table] = ()


@dataclass(frozen=True)
class Report:
    """A page with a headline, facts for the first glance, and sections."""

    title: str
    lead: str
    facts: Sequence[tuple[str, str]]
    sections: Sequence[Section] = field(default_factory=tuple)

    def write(self, path: Path) -> Path:
        """Write the page.

        Raises
        ------
        InputError
            If the file cannot be written.
        """
        return write_page("report.html", path, report=self)


def write_page(template: str, path: Path, **content: object) -> Path:
    """Fill one of the templates that ship, everything escaped, and write it.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    import jinja2

    loader = jinja2.PackageLoader("helicable", "templates")
    environment = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True)
    today = datetime.date.today().isoformat()
    page = environment.get_template(template).render(version=__version__, date=today, **content)
    try:
        path.write_text(page.lstrip(), encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path} cannot be written: {error.strerror or error}; choose another folder.") from None
    return path

"""One self-contained HTML page: sections of text, pictures and tables, in the order of the data. jinja2 is imported here only."""

from __future__ import annotations

import base64
import datetime
import importlib.resources
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
        import jinja2

        text = importlib.resources.files("helicable.templates").joinpath("report.html").read_text(encoding="utf-8")
        template = jinja2.Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True).from_string(text)
        page = template.render(report=self, version=__version__, date=datetime.date.today().isoformat())
        try:
            path.write_text(page, encoding="utf-8")
        except OSError as error:
            raise InputError(f"{path} cannot be written: {error.strerror or error}; choose another folder.") from None
        return path

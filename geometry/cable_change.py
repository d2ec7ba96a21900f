"""A cable file with some of its numbers changed and marked anew: text in, text out, everything else as it was.

A changed line keeps its comment; value, status, range and source are written anew, so that the file says of every changed
number where it comes from.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from geometry.errors import SpecError

_HEADER = re.compile(r"^\s*\[([^\[\]]+)\]\s*(#.*)?$")
_ENTRY = re.compile(r"^(\s*)([A-Za-z_][\w-]*)(\s*=\s*)\{(.*)\}(\s*(#.*)?)$")


@dataclass(frozen=True)
class ChangedNumber:
    """New `value` with its unit, `status`, `source` and `limits` of its range (texts such as "4 MPa"; None for no range)."""

    value: str
    status: str
    source: str
    limits: tuple[str, str] | None = None

    @property
    def text(self) -> str:
        """As it stands in a cable file."""
        limits = f', range = ["{self.limits[0]}", "{self.limits[1]}"]' if self.limits else ""
        return f'{{ value = "{self.value}", status = "{self.status}"{limits}, source = "{self.source}" }}'


def changed_cable_text(text: str, changes: Mapping[str, ChangedNumber]) -> str:
    """The text of a cable file with numbers changed.

    Parameters
    ----------
    text : str
    changes : mapping of str to ChangedNumber
        By key, table and entry with dots between and without quotation marks, such as ``materials.EPR insulation.E``.

    Raises
    ------
    SpecError
        If a key is not there, or its entry is not written on one line.

    Examples
    --------
    >>> old = '[sheath]\\nwall = { value = "6 mm", status = "published", source = "x" } # see there'
    >>> print(changed_cable_text(old, {"sheath.wall": ChangedNumber("7 mm", "computed", "y")}))
    [sheath]
    wall = { value = "7 mm", status = "computed", source = "y" } # see there
    """
    left, table, lines = dict(changes), "", []
    for line in text.split("\n"):
        header, entry = _HEADER.match(line), _ENTRY.match(line)
        if header:
            table = header[1].replace('"', "").strip()
        elif entry and (change := left.pop(f"{table}.{entry[2]}", None)) is not None:
            line = f"{entry[1]}{entry[2]}{entry[3]}{change.text}{entry[5]}"
        lines.append(line)
    if left:
        key = next(iter(left))
        raise SpecError(
            f'the cable file has no entry "{key}" on a line of its own: write table and key as they stand there, such as '
            '"materials.EPR insulation.E".'
        )
    return "\n".join(lines)

"""The ladder on paper: a JSON file of its rungs, written after each one, so that a run that was killed goes on where it stopped.

An unfinished record stands beside the finished one, ending in `.part`, and is taken up only by a run of the same inputs.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import asdict, fields
from pathlib import Path

from geometry.errors import InputError
from homogenize.specimen.ladder import Rung


def write_ladder(rungs: Sequence[Rung], path: Path, about: str) -> None:
    """Write a record whole or not at all: what it is about, and the rungs."""
    new = path.with_name(path.name + ".new")
    record = {"about": about, "rungs": [asdict(rung) for rung in rungs]}
    new.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    new.replace(path)


def read_ladder(path: Path) -> tuple[str, tuple[Rung, ...]]:
    """What a record is about, and its rungs.

    Raises
    ------
    InputError
        If the file is not a record of a ladder.
    """
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        return str(found["about"]), tuple(Rung(**rung) for rung in found["rungs"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        names = ", ".join(f.name for f in fields(Rung))
        raise InputError(
            f"{path} is not a record of a ladder ({error}); it needs about and rungs with {names}."
        ) from None


def part_of(path: Path) -> Path:
    """Where the record of a run that is not finished stands."""
    return path.with_name(path.name + ".part")


def kept_rungs(path: Path, key: str) -> tuple[Rung, ...]:
    """Rungs of the unfinished record beside `path`, if its inputs are those of `key`; none otherwise."""
    try:
        about, rungs = read_ladder(part_of(path))
    except InputError:
        return ()
    return rungs if about == key else ()


def inputs_key(*inputs: object) -> str:
    """A digest of all that a ladder is computed from, by the repr of each: numbers of the cable, specimen, laws, sizes of meshes.

    Not the nodes of a mesh, which curved elements have only to rounding.
    """
    return hashlib.sha256(repr(inputs).encode()).hexdigest()

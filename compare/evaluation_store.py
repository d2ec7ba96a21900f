"""Finished evaluations of an expensive model on disk, one line of JSON each, found again by a hash of their inputs.

A line is written, flushed and forced to the disk when an evaluation is finished; after a kill the file holds every
evaluation that had finished, and at most one torn line, which is passed over.
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from geometry.errors import InputError

log = logging.getLogger(__name__)


def input_hash(inputs: Mapping[str, Any]) -> str:
    """SHA-256 of inputs, whatever their order.

    Examples
    --------
    >>> input_hash({"a": 1.0, "b": "x"}) == input_hash({"b": "x", "a": 1.0}), len(input_hash({}))
    (True, 64)
    """
    return hashlib.sha256(json.dumps(inputs, sort_keys=True).encode()).hexdigest()


class EvaluationStore:
    """Outputs by inputs, kept in a file, or in memory only where there is none.

    Parameters
    ----------
    path : Path or None
    resume : bool
        Whether to use what the file holds already; else the file must not be there.

    Raises
    ------
    InputError
        If the file is there and `resume` was not asked, or it cannot be read or written.
    """

    def __init__(self, path: Path | None = None, resume: bool = False) -> None:
        self.path = path
        self._known: dict[str, dict[str, float]] = {}
        self.found_again = 0
        if path is None or not path.exists():
            return
        if not resume:
            raise InputError(f"{path} holds evaluations of an earlier run; go on with --resume, or remove the file.")
        try:
            lines = path.read_text(encoding="utf-8").splitlines()
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"{path} cannot be read: {error}; remove it to start anew.") from None
        for line in lines:
            try:
                entry = json.loads(line)
                self._known[entry["hash"]] = {str(k): float(v) for k, v in entry["outputs"].items()}
            except (ValueError, KeyError, TypeError, AttributeError):
                log.warning("%s: a torn line is passed over", path)

    def __len__(self) -> int:
        return len(self._known)

    def get(self, inputs: Mapping[str, Any]) -> dict[str, float] | None:
        """Outputs of inputs that were evaluated before."""
        found = self._known.get(input_hash(inputs))
        self.found_again += found is not None
        return found

    def put(self, inputs: Mapping[str, Any], outputs: Mapping[str, float]) -> None:
        """Keep a finished evaluation.

        Raises
        ------
        InputError
            If the file cannot be written.
        """
        key = input_hash(inputs)
        self._known[key] = dict(outputs)
        if self.path is None:
            return
        line = json.dumps({"hash": key, "inputs": dict(inputs), "outputs": dict(outputs)})
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            torn = self.path.exists() and not self.path.read_bytes().endswith(b"\n") and self.path.stat().st_size > 0
            with self.path.open("a", encoding="utf-8") as file:
                file.write(("\n" if torn else "") + line + "\n")
                file.flush()
                os.fsync(file.fileno())
        except OSError as error:
            raise InputError(
                f"{self.path} cannot be written: {error.strerror or error}; choose another place."
            ) from None

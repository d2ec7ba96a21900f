"""Solutions of a reduced basis on disk, found again by a hash of what decides them.

A file is written beside its place and then moved there, so that after a kill every file that has its name is whole.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from geometry.errors import InputError
from homogenize.section_field import FloatArray
from homogenize.specimen.unit_response import UnitResponse


class SnapshotStore:
    """A folder of solutions.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    identity : mapping of str to str
        What decides every solution of this store: cable, mesh, model.

    Raises
    ------
    InputError
        If the folder cannot be made, or a file not written.
    """

    def __init__(self, folder: Path, identity: Mapping[str, str]) -> None:
        self.folder, self.identity, self.found_again = folder, dict(identity), 0
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(f"{folder} cannot be made: {error.strerror or error}; choose another place.") from None

    def displacements(self, key: Mapping[str, str], shape: tuple[int, ...]) -> FloatArray | None:
        """Displacements of this shape that were kept under the key, or None."""
        kept = self._read(key)
        return None if kept is None or kept.get("U", np.empty(0)).shape != shape else kept["U"]

    def keep_displacements(self, key: Mapping[str, str], U: FloatArray) -> None:
        """Keep displacements."""
        self._write(key, {"U": U})

    def response(self, key: Mapping[str, str]) -> UnitResponse | None:
        """The response that was kept under the key, or None."""
        kept = self._read(key)
        if kept is None:
            return None
        area, length = kept["sizes"]
        return UnitResponse(float(area), float(length), kept["top"], kept["mean"], kept["tilt"])

    def keep_response(self, key: Mapping[str, str], response: UnitResponse) -> None:
        """Keep a response."""
        sizes = np.array([response.area, response.length])
        self._write(key, {"sizes": sizes, "top": response.top, "mean": response.mean, "tilt": response.tilt})

    def _path(self, key: Mapping[str, str]) -> Path:
        text = json.dumps({"identity": self.identity, "key": dict(key)}, sort_keys=True)
        return self.folder / f"{hashlib.sha256(text.encode()).hexdigest()[:32]}.npz"

    def _read(self, key: Mapping[str, str]) -> dict[str, FloatArray] | None:
        path = self._path(key)
        if not path.is_file():
            return None
        try:
            with np.load(path) as kept:
                found = {name: np.asarray(kept[name]) for name in kept.files}
        except (OSError, ValueError, KeyError):
            return None  # solved again and written anew
        self.found_again += 1
        return found

    def _write(self, key: Mapping[str, str], arrays: Mapping[str, FloatArray]) -> None:
        path = self._path(key)
        beside = path.with_suffix(".part.npz")
        try:
            np.savez(beside, **arrays)  # pyright: ignore[reportArgumentType]
            os.replace(beside, path)
        except OSError as error:
            raise InputError(f"{path} cannot be written: {error.strerror or error}; choose another place.") from None

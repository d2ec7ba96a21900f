"""Checkpoints of long runs: written to one file, read back, and gone on from bit by bit.

The file holds the arrays and plain values of :meth:`beam.generalized_alpha.Integrator.checkpoint` (also the factorised
matrix, on which the last bits of a modified Newton iteration depend). The model is not in it: build it again as it was. A
digest of its numbers, and the step settings, tell whether that was done. The format is Python's pickle: read only files that you wrote.
"""

from __future__ import annotations

import hashlib
import pickle
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from beam.generalized_alpha import Integrator
from geometry.errors import InputError


def model_digest(motion: Integrator) -> str:
    """Digest of the numbers of a run's model."""
    model = motion.model
    digest = hashlib.sha256()
    for part in (*model.arrays, model.q0, model.external, model.held, model.surface_parameters(0.0)):
        digest.update(np.ascontiguousarray(part).tobytes())
    for part in model.system.digest() if model.system is not None else ():
        digest.update(np.ascontiguousarray(part).tobytes())
    return digest.hexdigest()


def write_checkpoint(motion: Integrator, path: str | Path) -> Path:
    """Write the present state of `motion`; the file is complete or absent, also if the computer stops meanwhile.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    path = Path(path)
    part = path.with_name(path.name + ".part")
    try:
        part.write_bytes(pickle.dumps(_kept(motion)))
        part.replace(path)
    except OSError as error:
        raise InputError(f"{path}: the checkpoint cannot be written there: {error}.") from None
    return path


def _kept(motion: Integrator) -> dict[str, Any]:
    return {"digest": model_digest(motion), "settings": asdict(motion.settings), "state": motion.checkpoint()}


def read_checkpoint(motion: Integrator, path: str | Path) -> None:
    """Take `motion`, newly built from the same model and settings, to the state in the file.

    Raises
    ------
    InputError
        If the file cannot be read, or was written by a run of another model or other settings.
    """
    try:
        kept = pickle.loads(Path(path).read_bytes())
        digest, settings, state = kept["digest"], kept["settings"], kept["state"]
    except Exception as error:  # damaged bytes make pickle raise nearly anything
        raise InputError(f"{path}: no checkpoint can be read from it: {error}.") from None
    other = [
        f"{name} {settings.get(name)}, not {x}"
        for name, x in asdict(motion.settings).items()
        if settings.get(name) != x
    ]
    if other:
        raise InputError(
            f"{path}: the run was made with other step settings ({'; '.join(other)}): go on with those it was started with, "
            f"or start it again."
        )
    if digest != model_digest(motion):
        raise InputError(f"{path}: the checkpoint was written by a run of another model.")
    motion.restore(state)

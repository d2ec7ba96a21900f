"""Checkpoints of long runs: written to one file, read back, and gone on from bit by bit.

The file holds the arrays and plain values of :meth:`beam.generalized_alpha.Integrator.checkpoint` (also the factorised
matrix, on which the last bits of a modified Newton iteration depend). The model is not in it: build it again as it was. A
digest of its numbers tells whether that was done. The format is Python's pickle: read only files that you wrote.
"""

from __future__ import annotations

import hashlib
import pickle
from pathlib import Path

import numpy as np

from beam.generalized_alpha import Integrator
from geometry.errors import InputError


def model_digest(motion: Integrator) -> str:
    """Digest of the numbers of a run's model and settings."""
    model = motion.model
    digest = hashlib.sha256()
    for part in (*model.arrays, model.q0, model.external, model.held, model.surface_parameters(0.0)):
        digest.update(np.ascontiguousarray(part).tobytes())
    for part in model.system.digest() if model.system is not None else ():
        digest.update(np.ascontiguousarray(part).tobytes())
    digest.update(repr(motion.settings).encode())
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
        part.write_bytes(pickle.dumps({"digest": model_digest(motion), "state": motion.checkpoint()}))
        part.replace(path)
    except OSError as error:
        raise InputError(f"{path}: the checkpoint cannot be written there: {error}.") from None
    return path


def read_checkpoint(motion: Integrator, path: str | Path) -> None:
    """Take `motion`, newly built from the same model and settings, to the state in the file.

    Raises
    ------
    InputError
        If the file cannot be read, or was written by a run of another model or other settings.
    """
    try:
        kept = pickle.loads(Path(path).read_bytes())
        digest, state = kept["digest"], kept["state"]
    except (OSError, pickle.UnpicklingError, EOFError, KeyError, TypeError) as error:
        raise InputError(f"{path}: no checkpoint can be read from it: {error}.") from None
    if digest != model_digest(motion):
        raise InputError(f"{path}: the checkpoint was written by a run of another model or with other step settings.")
    motion.restore(state)

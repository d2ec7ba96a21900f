"""What each model of the drive leaves of the motor force: on the record of the fit, and on the one held out."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.measured.drive import LIBRARY, NAME, drive_block, inertia_and_viscosity, read_motion
from benchmarks.measured.held_out import fitted_terms, residual, rms
from compare.verdict import Outcome, decide

MODELS: dict[str, tuple[str, ...]] = {
    "M a + Fv v": (),
    "offset": ("offset",),
    "spring": ("spring",),
    "lag": ("lag",),
    "quadratic drag": ("quadratic-drag",),
    "Coulomb": ("coulomb-friction",),
    "Coulomb + offset": ("coulomb-friction", "offset"),
    "Coulomb + offset + Stribeck": ("coulomb-friction", "offset", "stribeck"),
}


@dataclass(frozen=True)
class DriveFit:
    """M [kg], F_v [N s/m], the strengths [N and the like] of the effects in their order, and rms residuals [N]."""

    model: str
    M: float
    Fv: float
    strengths: tuple[float, ...]
    fitted: float
    held_out: float


def drive_fits(data: Path) -> list[DriveFit]:
    """All models, fitted to the estimation record under the noise of its repeats and read on the pulses."""
    motion, pulses = (read_motion(data / NAME / f"{name}.npz") for name in ("estimation", "pulses"))
    base = inertia_and_viscosity(motion)
    block, other = drive_block(motion, base), drive_block(pulses, base, motion)
    effects = {effect.name: effect for effect in LIBRARY}
    fits = []
    for model, names in MODELS.items():
        if names:
            terms, x = fitted_terms(block, [(effects[n], effects[n].forms[0]) for n in names])
        else:
            terms, x = (), np.ones(2)
        M, Fv = (float(v) for v in x[:2] * base)
        strengths = tuple(float(v) for v in x[2:])
        fits.append(DriveFit(model, M, Fv, strengths, rms(residual(block, terms, x)), rms(residual(other, terms, x))))
    return fits


def drive_outcome(data: Path) -> Outcome:
    """What the search makes of the estimation record."""
    motion = read_motion(data / NAME / "estimation.npz")
    return decide((drive_block(motion, inertia_and_viscosity(motion)),), LIBRARY)

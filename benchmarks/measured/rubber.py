r"""Treloar's rubber (1944) as plain curves: three loading modes of one vulcanisate, each left out in turn.

Nominal stress of an incompressible hyperelastic solid with energy W(I1, I2),

.. math::  P = 2\,(\lambda - \lambda^{-k})\,(W_1 + f\,W_2), \qquad
           (k, f) = (2, 1/\lambda),\ (5, \lambda^2),\ (3, 1) \text{ for uniaxial, equibiaxial, pure shear}

Base: neo-Hooke, W1 = mu/2. Candidates: stiffening, in the form of Gent, W1 = mu/2 Jm / (Jm - I1 + 3), and of Yeoh,
powers of I1 - 3; Mooney-Rivlin, a constant W2; an offset of the stress. Source: Treloar, Trans. Faraday Soc. 40 (1944) 59,
doi 10.1039/TF9444000059; Gent, Rubber Chem. Technol. 69 (1996) 59; Yeoh, Rubber Chem. Technol. 66 (1993) 754.

"Strain" is here what mu multiplies in the base, lambda - lambda^-k, so that a Gent solid is a strain that runs away.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.measured.campaign_folder import read_table
from benchmarks.measured.held_out import fitted_terms, residual, rms
from benchmarks.measured.reading_error import scatter_of_neighbours
from compare.bench_design import BenchRecord, Block, Reading, Whitener
from compare.bench_path import LedPath
from compare.experiment import Experiment
from compare.noise_covariance import NoiseCovariance
from effects.effect import BenchPath, Effect, Form, Parameter, of_values

Array = NDArray[np.float64]
NAME = "treloar-1944"
MODES = ("uniaxial", "equibiaxial", "pure-shear")
KIND = "rubber"


@dataclass(frozen=True)
class RubberPath(BenchPath):
    """The path of one mode with I1 - 3 and the factor f of W2, (n,) each."""

    I1: Array = field(default_factory=lambda: np.zeros(0), repr=False)
    of_I2: Array = field(default_factory=lambda: np.zeros(0), repr=False)


def rubber_path(mode: str, stretch: Array) -> RubberPath:
    """Path of a mode at the given stretches.

    >>> path = rubber_path("uniaxial", np.array([2.0]))
    >>> float(path.strain[0]), float(path.I1[0]), float(path.of_I2[0])
    (1.75, 2.0, 0.5)
    """
    k, of_I2, I1 = {
        "uniaxial": (2, 1 / stretch, stretch**2 + 2 / stretch),
        "equibiaxial": (5, stretch**2, 2 * stretch**2 + stretch**-4.0),
        "pure-shear": (3, np.ones(len(stretch)), stretch**2 + stretch**-2.0 + 1),
    }[mode]
    return RubberPath(KIND, stretch - stretch ** float(-k), I1=I1 - 3, of_I2=of_I2)


def curves(data: Path) -> dict[str, tuple[Array, Array]]:
    """Stretch and nominal stress [Pa] by mode."""
    columns = ("stretch [-]", "nominal stress [MPa]")
    tables = {mode: read_table(data / NAME / f"{mode}.csv", columns) for mode in MODES}
    return {mode: (t[:, 0], 1e6 * t[:, 1]) for mode, t in tables.items()}


def shear_modulus(data: Path, modes: Sequence[str] = MODES) -> float:
    """mu [Pa] of the neo-Hookean solid that fits the named modes best."""
    measured = curves(data)
    strain = np.concatenate([rubber_path(m, measured[m][0]).strain for m in modes])
    return float(strain @ np.concatenate([measured[m][1] for m in modes]) / (strain @ strain))


def rubber_block(data: Path, mu: float, modes: Sequence[str] = MODES) -> Block:
    """The named modes about a neo-Hookean solid; each mode is a group of its own."""
    measured = curves(data)
    noise = float(np.sqrt(np.mean([scatter_of_neighbours(*curve) ** 2 for curve in measured.values()])))
    paths = {mode: rubber_path(mode, measured[mode][0]) for mode in modes}
    records = []
    for mode in modes:
        path, stress = paths[mode], measured[mode][1]
        signal = mu * path.strain
        covariance = NoiseCovariance(noise, assumed=True, source="scatter of neighbouring points")
        reading = Reading("stress", "load", stress, np.ones(1), mu, Whitener.of(covariance, signal), signal)
        experiment = Experiment(mode, KIND, f"{mode}.csv", "sheet", "calibrate", {})
        records.append(BenchRecord(experiment, LedPath(path), (reading,)))
    return Block(KIND, ("mu",), tuple(records), tuple((i,) for i in range(len(modes))))


def _locked(path: RubberPath, Jm: float) -> Array:
    """Gent: the strain grows without bound as I1 - 3 nears Jm; kept finite beyond it."""
    return path.strain * Jm / np.maximum(Jm - path.I1, 1e-3 * Jm)


def _powers(path: RubberPath) -> Array:
    return path.strain[:, None] * np.column_stack([path.I1 / 50, (path.I1 / 50) ** 2])


def _effect(name: str, title: str, *forms: Form) -> Effect:
    return Effect(name, "physics", title, "see the file", "see the file", "a curve", "", (KIND,), forms)


def _strength(name: str) -> Parameter:
    return Parameter(name, "1", "share of mu", low=-np.inf, plausible=(-np.inf, np.inf))


JM = Parameter(
    "Jm", "1", "I1 - 3 at which the chains are stretched out", 1.0, 1000.0, starts=of_values(*np.geomspace(30, 300, 14))
)
GENT = Form("Gent", "fixture", _locked, shape=(JM,))
YEOH = Form("Yeoh", "section", _powers, strength=(_strength("linear in I1"), _strength("square in I1")))
MOONEY = Form(
    "Mooney-Rivlin", "section", lambda path: (path.strain * path.of_I2)[:, None], strength=(_strength("W2 over W1"),)
)
OFFSET = Form("offset", "section", lambda path: np.ones((len(path.strain), 1)), strength=(_strength("offset"),))
LIBRARY = (
    _effect("stiffening", "chains of finite length", GENT, YEOH),
    _effect("mooney-rivlin", "a constant W2", MOONEY),
    _effect("offset", "a constant stress", OFFSET),
)
CANDIDATES = {
    "neo-Hooke": (),
    "Mooney-Rivlin": ((LIBRARY[1], MOONEY),),
    "Gent": ((LIBRARY[0], GENT),),
    "Yeoh": ((LIBRARY[0], YEOH),),
    "Gent + I2": ((LIBRARY[0], GENT), (LIBRARY[1], MOONEY)),
    "offset": ((LIBRARY[2], OFFSET),),
}


@dataclass(frozen=True)
class LeftOutMode:
    """Rms residual [Pa] on the two modes of the fit and on the one left out."""

    mode: str
    fitted: float
    held_out: float


def leave_one_mode_out(data: Path, chosen: Sequence[tuple[Effect, Form]]) -> list[LeftOutMode]:
    """Everything, shapes included, fitted to two modes and read on the third, for all three."""
    folds = []
    for mode in MODES:
        others = [m for m in MODES if m != mode]
        mu = shear_modulus(data, others)
        fitted, left = rubber_block(data, mu, others), rubber_block(data, mu, [mode])
        terms, x = fitted_terms(fitted, chosen)
        folds.append(LeftOutMode(mode, rms(residual(fitted, terms, x)), rms(residual(left, terms, x))))
    return folds

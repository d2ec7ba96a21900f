r"""Loops of a cable whose parts rub: the load path, and what is read from the answer.

First loading to the amplitude e, then closed cycles. Of the last cycle, per length of cable: area W = \oint F de, heat by the
slips, and the equivalent viscous damping ratio zeta = W / (4 pi W_s), W_s = F(e) e / 2 (Jacobsen, Trans. ASME 52 (1930) 169-181).
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from geometry import Cable, cross_section_mesh
from helicable.screen import ProgressCallback
from homogenize import FrictionLoop, Interfaces, axial_friction, bending_friction, friction_loop, grip_per_tension
from homogenize.section_field import FloatArray

QUARTERS = 4


@dataclass(frozen=True)
class Load:
    """What moves: number of the strain in its section, units of strain, force and stiffness, words, columns of the table."""

    strain: int
    unit: str
    stiffness: str
    force: str
    words: tuple[str, str]


LOADS = {
    "tension": Load(0, "1", "N", "N", ("stretch", "tension")),
    "torsion": Load(1, "rad/m", "N m2", "N m", ("twist", "torque")),
    "bending": Load(0, "1/m", "N m2", "N m", ("curvature", "moment")),
}


@dataclass(frozen=True)
class Settings:
    """What the user asked for, in SI."""

    load: str
    amplitude: float
    interfaces: Interfaces
    grip: float
    tension: float
    steps: int
    cycles: int
    harmonics: int
    free_twist: bool
    size: float | None


@dataclass(frozen=True)
class LoopResult:
    """A loop and what is read from it."""

    cable: Cable
    settings: Settings
    loop: FrictionLoop
    grip: FloatArray
    quarter: int
    elements: int
    seconds: float

    @property
    def strain(self) -> int:
        """Number of the strain that moves."""
        return LOADS[self.settings.load].strain

    @property
    def start(self) -> int:
        """Step at which the last cycle starts."""
        return len(self.loop.strain) - 1 - QUARTERS * self.quarter

    @property
    def slopes(self) -> dict[str, float]:
        """Bonded, in the first step, in the last step of the first loading, and without friction."""
        section, i = self.loop.section, self.strain
        return {
            "bonded": float(section.bonded[i, i]),
            "first_step": self.loop.slope(1, i),
            "last_step": self.loop.slope(self.quarter, i),
            "frictionless": float(section.frictionless[i, i]),
        }

    @property
    def peak(self) -> float:
        """Force at the start of the last cycle."""
        return float(self.loop.force[self.start, self.strain])

    @property
    def area(self) -> float:
        """Work of the last cycle per length [J/m]."""
        return self.loop.work(self.start)

    @property
    def heat(self) -> float:
        """Heat of the last cycle per length [J/m]."""
        return float(self.loop.dissipation[-1] - self.loop.dissipation[self.start])

    @property
    def damping_ratio(self) -> float:
        """Equivalent viscous damping ratio."""
        return self.heat / (2 * np.pi * self.peak * self.settings.amplitude)

    @property
    def mean_grip(self) -> float:
        """Pressure on the rubbing surface, on the mean [Pa]."""
        surface = self.loop.section.surface
        return float(self.grip @ surface / surface.sum())

    @property
    def slid(self) -> float:
        """Share of the rubbing surface that slid at least once."""
        surface = self.loop.section.surface
        ever = self.loop.sliding.any(axis=0).mean(axis=0)
        return float(ever @ surface / surface.sum())


def run_loop(cable: Cable, s: Settings, tell: ProgressCallback) -> LoopResult:
    """Mesh, condense, follow the path."""
    start = time.perf_counter()
    tell(0.0, "meshing the cross-section")
    mesh = cross_section_mesh(cable, size=s.size)
    tell(0.02, "condensing the section onto its slips")

    def condensing(fraction: float, sentence: str) -> None:
        tell(0.02 + 0.48 * fraction, sentence)

    if s.load == "bending":
        section = bending_friction(mesh, s.interfaces, s.harmonics, progress=condensing)
    else:
        section = axial_friction(mesh, s.interfaces, s.free_twist, progress=condensing)
    grip = np.full(len(section.surface), s.grip)
    if s.tension:
        grip = np.maximum(grip + s.tension * grip_per_tension(mesh, s.interfaces), 0.0)
    quarter = -(-s.steps // (1 + QUARTERS * s.cycles))
    path = np.zeros((1 + quarter * (1 + QUARTERS * s.cycles), len(section.strains)))
    corners = [0.0, 1.0, *([0.0, -1.0, 0.0, 1.0] * s.cycles)]
    path[:, LOADS[s.load].strain] = s.amplitude * np.interp(
        np.arange(len(path)) / quarter, np.arange(len(corners)), corners
    )
    found = friction_loop(section, path, grip, progress=lambda f, sentence: tell(0.5 + 0.5 * f, sentence))
    tell(1.0, "loop closed")
    return LoopResult(cable, s, found, grip, quarter, len(mesh.cells), time.perf_counter() - start)

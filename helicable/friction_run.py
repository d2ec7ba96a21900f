r"""Loops of a cable whose parts rub: the load path, and what is read from the answer.

First loading to the amplitude of a strain e, or of its force F, then closed cycles. Of the last cycle, per length of cable: area
W = \oint F de, heat by the slips, and the equivalent viscous damping ratio zeta = W / (4 pi W_s), W_s = F e / 2 with half the ranges of
F and e (Jacobsen, Trans. ASME 52 (1930) 169-181). Where parts can open a constant tension is put on in steps of its own before.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from geometry import Cable, cross_section_mesh
from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import SpecError
from helicable.screen import ProgressCallback
from homogenize import (
    FrictionLoop,
    Interfaces,
    Unilateral,
    axial_friction,
    bending_friction,
    contact_section,
    friction_loop,
    grip_per_tension,
)
from homogenize.rubbing_section import RubbingSection, free_to_turn
from homogenize.section_field import FloatArray

QUARTERS = 4
CONTROLS = ("strain", "force")
_PULL = 5
"""Steps in which a constant tension is put on."""


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
    control: str = "strain"
    tension_grips: bool = False

    @property
    def opens(self) -> bool:
        """Whether an interface can open."""
        return any(isinstance(law, Unilateral) for law in self.interfaces.laws.values())

    @property
    def unit(self) -> str:
        """Of the amplitude."""
        return LOADS[self.load].unit if self.control == "strain" else LOADS[self.load].force


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
    lead: int = 0

    @property
    def strain(self) -> int:
        """Number of the strain that moves."""
        return _column(self.loop.section, self.settings)

    @property
    def start(self) -> int:
        """Step at which the last cycle starts."""
        return len(self.loop.strain) - 1 - QUARTERS * self.quarter

    @property
    def slopes(self) -> dict[str, float]:
        """Bonded, in the first step, in the last step of the first loading, and without friction."""
        section, i = self.loop.section, self.strain
        found = {
            "bonded": float(section.bonded[i, i]),
            "first_step": self.loop.slope(self.lead + 1, i),
            "last_step": self.loop.slope(self.lead + self.quarter, i),
            "frictionless": float(section.frictionless[i, i]),
        }
        return found | ({"open": float(section.open[i, i])} if section.opens.any() else {})

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
        half = [0.5 * float(np.ptp(x[self.start :, self.strain])) for x in (self.loop.force, self.loop.strain)]
        return self.heat / (2 * np.pi * half[0] * half[1])

    @property
    def reached(self) -> float:
        """Strain at the start of the last cycle."""
        return float(self.loop.strain[self.start, self.strain])

    @property
    def largest_gap(self) -> FloatArray:
        """Largest gap of each step [m]."""
        return self.loop.gap.max(axis=(1, 2))

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

    section = _section(mesh, s, condensing)
    per_tension = grip_per_tension(mesh, s.interfaces, s.free_twist) if s.tension_grips else None
    grip = np.full(len(section.surface), s.grip)
    if s.tension and not s.opens:
        grip = np.maximum(grip + s.tension * grip_per_tension(mesh, s.interfaces), 0.0)
    path, drives, quarter, lead = _path(section, s)
    if s.control == "force":
        _check_force(section, s, cable)
    found = friction_loop(
        section, path, grip, per_tension, drives, progress=lambda f, sentence: tell(0.5 + 0.5 * f, sentence)
    )
    tell(1.0, "loop closed")
    if per_tension is not None:
        grip = found.pressure[-1, 0]
    return LoopResult(cable, s, found, grip, quarter, len(mesh.cells), time.perf_counter() - start, lead)


def _section(mesh: CrossSectionMesh, s: Settings, tell: ProgressCallback) -> RubbingSection:
    bending = s.load == "bending"
    if s.opens:
        section = contact_section(mesh, s.interfaces, s.harmonics if bending else 0, progress=tell)
        return free_to_turn(section) if s.free_twist else section
    if bending:
        return bending_friction(mesh, s.interfaces, s.harmonics, progress=tell)
    return axial_friction(mesh, s.interfaces, s.free_twist, progress=tell)


def _column(section: RubbingSection, s: Settings) -> int:
    """Number of the strain that moves: the bending about x, where there are others beside it."""
    return section.strains.index("kappa_x") if s.load == "bending" else LOADS[s.load].strain


def _path(section: RubbingSection, s: Settings) -> tuple[FloatArray, tuple[str, ...], int, int]:
    """Rows, what drives each column, steps of a quarter, and steps before the loop starts."""
    drives, column = list(section.strains), _column(section, s)
    if s.control == "force":
        moved = range(column, len(drives)) if s.load == "bending" else (column,)
        for i in moved:
            drives[i] = section.forces[i]
    pulled = s.opens and (s.load == "bending" or s.tension != 0)
    if pulled:
        drives[0] = "N"
    lead = _PULL if pulled and s.tension else 0
    quarter = -(-s.steps // (1 + QUARTERS * s.cycles))
    path = np.zeros((lead + 1 + quarter * (1 + QUARTERS * s.cycles), len(drives)))
    corners = [0.0, 1.0, *([0.0, -1.0, 0.0, 1.0] * s.cycles)]
    turns = np.interp(np.arange(len(path) - lead) / quarter, np.arange(len(corners)), corners)
    path[lead:, column] = s.amplitude * turns
    if lead:
        path[:, 0] = s.tension * np.minimum(np.arange(len(path)) / lead, 1.0)
    return path, tuple(drives), quarter, lead


def _check_force(section: RubbingSection, s: Settings, cable: Cable) -> None:
    """Refuse a force whose strain, without friction, is no small one."""
    column = _column(section, s)
    size = 1.0 if s.load == "tension" else cable.outer_diameter / 2
    largest = s.amplitude / float(section.frictionless[column, column]) * size
    if largest >= 1:
        raise SpecError(
            f"--amplitude {s.amplitude:g} {s.unit} makes a strain of {largest:.3g} where nothing rubs; it must stay below 1 (and a linear "
            "section asks for far less than 1)."
        )

r"""A towed line in Exudyn: linear finite elements with consistent mass, advanced by Exudyn's Runge-Kutta solver of order 4.

The second simulator of this folder, which makes the shipped campaigns. The towed end is node 0, whose motion p is given; the others
are the generic second-order object of Exudyn,

.. math::  M \ddot u + \beta K \dot u + K u = -M_0 \ddot p - K_0 (p + \beta \dot p) - f - c \dot u

with friction f lumped at the nodes: a spring that slides once it carries mu N (elastic-perfectly-plastic over the presliding), its
travel committed before every step. Exudyn's own bristle (CoordinateSpringDamperExt) agrees with this within 0.1 % while the line
slides, but forgets at a standstill what the bristle carried; the contract has it mobilised by travel alone.
An optional peer: `pip install exudyn`.
"""

from __future__ import annotations

import importlib.util
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.blind_towing.towed_line import GRAVITY, Drive, Line

Array = NDArray[np.float64]


def installed() -> bool:
    """True if the peer can be imported."""
    return importlib.util.find_spec("exudyn") is not None


@dataclass(frozen=True)
class Extra:
    """What is on the line beyond Coulomb friction: fall of the coefficient, its speed [m/s], drag [N s/m^2] and load [kg/m].

    mu(v) = mu + fall / (1 + (v/fall_speed)^2). Drag and load act from `stretch[0]` to `stretch[1]`, in shares of the length.
    """

    fall: float = 0.0
    fall_speed: float = 0.1
    drag: float = 0.0
    load: float = 0.0
    stretch: tuple[float, float] = (0.0, 1.0)


class _Elements:
    """Matrices of all nodes, and the length that belongs to each: its own, and what of it lies within the stretch."""

    def __init__(self, line: Line, extra: Extra, pieces: int) -> None:
        h = self.h = line.length / pieces
        low, high = (s * line.length for s in extra.stretch)
        inside = np.clip(np.arange(pieces + 1) * h, low, high)
        mass = line.mass + extra.load * np.diff(inside) / h
        self.M, self.K = np.zeros((pieces + 1,) * 2), np.zeros((pieces + 1,) * 2)
        for e in range(pieces):
            block = np.ix_((e, e + 1), (e, e + 1))
            self.M[block] += mass[e] * h / 6 * np.array([[2, 1], [1, 2]])
            self.K[block] += line.EA / h * np.array([[1, -1], [-1, 1]])
        self.mass = mass
        self.carried = self.M.sum(axis=1)
        edges = np.clip((np.arange(pieces + 2) - 0.5) * h, 0.0, line.length)
        self.loaded = np.diff(np.clip(edges, low, high))

    def weight_below(self, s: float) -> float:
        """Mass below a station [kg]."""
        ends = np.arange(len(self.mass)) * self.h
        return float(np.sum(self.mass * np.clip(ends + self.h - s, 0.0, self.h)))


class _Friction:
    """Elastic-perfectly-plastic springs of the nodes with drag beside them."""

    def __init__(self, line: Line, extra: Extra, elements: _Elements, slope: float) -> None:
        self.line, self.extra, self.drag = line, extra, extra.drag * elements.loaded
        self.weight = elements.carried * GRAVITY * math.cos(slope) / line.presliding
        self.place, self.stretch = np.zeros((2, len(self.weight)))

    def bent(self, u: Array) -> Array:
        d = self.line.presliding
        return np.minimum(np.maximum(self.stretch + (u - self.place), -d), d)

    def commit(self, u: Array) -> None:
        self.stretch, self.place = self.bent(u), u.copy()

    def __call__(self, u: Array, v: Array) -> Array:
        mu = self.line.friction
        if self.extra.fall:
            mu = mu + self.extra.fall / (1 + (v / self.extra.fall_speed) ** 2)
        return mu * self.weight * self.bent(u) + self.drag * v


def tow_exudyn(
    line: Line,
    drive: Drive,
    slope: float,
    tail: float,
    extra: Extra,
    t: Array,
    stations: Sequence[float],
    pieces: int = 20,
) -> Array:
    """Tensions (1 + stations, samples) [N] of one record; arguments as of :func:`benchmarks.blind_towing.towed_line.tow`.

    The time step is 0.8 of the largest one with which the stiffest mode, omega^2 = 12 EA/(m h^2) damped by beta, is stable
    (beta omega^2 dt < 2.78). A station is read between the middles of the two nearest elements; the towed end is the
    force that moves node 0.
    """
    import exudyn
    import exudyn.itemInterface

    items: Any = exudyn.itemInterface

    elements = _Elements(line, extra, pieces)
    M, K, beta = elements.M, elements.K, line.beta
    stiffest = 12 * line.EA / (line.mass * elements.h**2)
    each = math.ceil((t[1] - t[0]) * beta * stiffest / (0.8 * 2.78))
    half = np.arange(2 * each * (len(t) - 1) + 3) * (t[1] - t[0]) / (2 * each)
    p, pv, pa = drive(half)
    per_second = 2 * each / (t[1] - t[0])
    led, whole = -M[1, 0] * pa - K[1, 0] * (p + beta * pv), np.zeros((2, pieces + 1))
    friction, kept, done = _Friction(line, extra, elements, slope), [], [0]

    def at(now: float) -> int:
        return min(round(now * per_second), len(half) - 1)

    def force(_mbs: object, now: float, _number: int, q: Any, q_t: Any) -> Array:
        i = at(now)
        whole[0, 0], whole[1, 0], whole[0, 1:], whole[1, 1:] = p[i], pv[i], q, q_t
        out = -friction(*whole)[1:]
        out[0] += led[i]
        return out

    def before(mbs: Any, _end: float) -> bool:
        i = 2 * done[0]
        done[0] += 1
        u, v = (
            np.append(p[i], mbs.systemData.GetODE2Coordinates()),
            np.append(pv[i], mbs.systemData.GetODE2Coordinates_t()),
        )
        friction.commit(u)
        if i % (2 * each) == 0:
            w = u + beta * v
            a = np.append(pa[i], np.linalg.solve(M[1:, 1:], force(None, half[i], 0, u[1:], v[1:]) - K[1:, 1:] @ w[1:]))
            end = M[0] @ a + K[0] @ w + friction(u, v)[0]
            kept.append(np.concatenate([[end], line.EA / elements.h * (w[:-1] - w[1:])]))
        return True

    system = exudyn.SystemContainer()
    mbs = system.AddSystem()
    node = mbs.AddNode(
        items.NodeGenericODE2(
            referenceCoordinates=[0.0] * pieces, initialCoordinates=[0.0] * pieces,
            initialCoordinates_t=[0.0] * pieces, numberOfODE2Coordinates=pieces,
        )
    )  # fmt: skip
    mbs.AddObject(
        items.ObjectGenericODE2(
            nodeNumbers=[node], massMatrix=M[1:, 1:], stiffnessMatrix=K[1:, 1:], dampingMatrix=beta * K[1:, 1:],
            forceUserFunction=force,
        )
    )  # fmt: skip
    mbs.SetPreStepUserFunction(before)
    mbs.Assemble()
    settings: Any = exudyn.SimulationSettings()
    times = settings.timeIntegration
    times.numberOfSteps, times.endTime = each * (len(t) - 1) + 1, float(t[-1] + (t[1] - t[0]) / each)
    times.verboseMode = 0
    settings.solutionSettings.writeSolutionToFile = False
    settings.displayStatistics = False
    mbs.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.RK44, showHints=False)
    table = np.array(kept[-len(t) :]).T
    out = [table[0]]
    for s in stations:
        j = int(np.clip(s / elements.h - 0.5, 0, pieces - 2))
        q = s / elements.h - 0.5 - j
        out.append((1 - q) * table[1 + j] + q * table[2 + j])
    below = [GRAVITY * math.sin(slope) * elements.weight_below(s) for s in (0.0, *stations)]
    return np.array(out) + tail + np.array(below)[:, None]

r"""Time integration of M a + F(q, v, t) = 0 by the generalised-alpha method with modified Newton iteration.

.. math:: M[(1-\alpha_m) a_{n+1} + \alpha_m a_n] + (1-\alpha_f) F_{n+1} + \alpha_f F_n = 0, \\
          \alpha_m = \frac{2\rho - 1}{\rho + 1}, \quad \alpha_f = \frac{\rho}{\rho + 1}, \quad
          \gamma = \tfrac12 - \alpha_m + \alpha_f, \quad \beta = \tfrac14 (1 - \alpha_m + \alpha_f)^2.

Second order, unconditionally stable for linear problems, spectral radius rho at infinite frequency. The factorised
matrix is kept over steps and renewed where the residual falls by less than a factor of two in an iteration. A step that
does not converge is halved, never accepted. Steps are h_max / 2^k on a dyadic grid, so that output times are met exactly
and a run can be repeated bit by bit.

Source: J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371-375, doi 10.1115/1.2900803.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beam.energy_ledger import EnergyLedger
from beam.linear_solve import Factor
from beam.rod_model import Blocks, Forces, RodModel
from beam.section_memory import LONG, SectionMemory
from beam.status import Outcome, Status
from geometry.errors import SpecError

Array = NDArray[np.float64]

logger = logging.getLogger(__name__)

LEVELS = 14
"""The smallest step is h_max / 2^14."""


@dataclass(frozen=True)
class StepSettings:
    """Largest step [s], spectral radius, stopping rule |R| <= relative |R_0| + absolute [N, N m], iterations a step."""

    largest_step: float = 5e-3
    first_level: int = 4
    spectral_radius: float = 0.7
    relative: float = 1e-6
    absolute: float = 1e-3
    iterations: int = 16
    adaptive: bool = True

    def __post_init__(self) -> None:
        if not (self.largest_step > 0 and 0 <= self.spectral_radius <= 1 and 0 <= self.first_level <= LEVELS):
            raise SpecError(
                f"time steps need a positive largest step and a spectral radius from 0 to 1, "
                f"found {self.largest_step:g} s and {self.spectral_radius:g}."
            )

    @property
    def coefficients(self) -> tuple[float, float, float, float]:
        """(alpha_m, alpha_f, gamma, beta)."""
        rho = self.spectral_radius
        am, af = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
        return am, af, 0.5 - am + af, 0.25 * (1 - am + af) ** 2


@dataclass
class Counters:
    """Work that was done."""

    steps: int = 0
    iterations: int = 0
    factorisations: int = 0
    cuts: int = 0


class Integrator:
    """A model on its way through time.

    Parameters
    ----------
    model : RodModel
    q, v : (n + 1, 12) array
        Initial state; the acceleration follows from the equations of motion.
    anchors : list of array, optional
        Friction anchors, from :func:`beam.statics.equilibrium`.
    memory : SectionMemory, optional
        Of the model's section law, from there as well; if not given, the rod is taken from the stress-free shape to `q`
        and left there for a long time. A step that is not accepted leaves it as it was.
    """

    def __init__(
        self,
        model: RodModel,
        q: Array,
        v: Array | None = None,
        anchors: list[Array] | None = None,
        settings: StepSettings | None = None,
        memory: SectionMemory | None = None,
    ) -> None:
        self.model = model
        self.settings = settings or StepSettings()
        self.q = np.array(q, dtype=float)
        self.v = np.zeros_like(self.q) if v is None else np.array(v, dtype=float)
        self.a = np.zeros_like(self.q)
        self.t = 0.0
        self.counters = Counters()
        self.outcome = Outcome()
        model.prescribe(0.0, self.q, self.v, self.a)
        start = anchors
        if start is None:
            start = model.forces(0.0, self.q, self.v, model.fresh_anchors(), friction=False).moved
        self.anchors = [x.copy() for x in start]
        self.forces = model.forces(
            0.0, self.q, self.v, self.anchors, memory=memory, dt=LONG if memory is None else None
        )
        self.memory = self.forces.memory
        self.deepest: tuple[float, str] = (0.0, "")
        self._last_iterations = 0
        self._worst = ""
        self._held = np.nonzero(~model.free)
        self._factor: Factor | None = None
        self._factor_step = 0.0
        self._ticks = 0
        self._level = self.settings.first_level if self.settings.adaptive else 0
        self._easy = 0
        self._initial_acceleration()
        self.ledger = EnergyLedger(model)
        self.ledger.start(self.q, self.v, self.a, self.forces)

    @property
    def reaction(self) -> Array:
        """Force of the supports on the held unknowns, zero elsewhere, shape (n + 1, 12) [N, N m]."""
        return np.where(self.model.free, 0.0, self.forces.F + self.model.inertia(self.a))

    def advance(self, steps: int, watch: Callable[[Integrator], None] | None = None) -> bool:
        """Go on by `steps` times the largest step; False if the run had to stop, see :attr:`outcome`."""
        goal = self._ticks + steps * 2**LEVELS
        while self._ticks < goal and self.outcome.completed:
            size = 2 ** (LEVELS - self._level)
            while size > goal - self._ticks or self._ticks % size:
                size //= 2
            if self._try(size):
                self._adapt(size)
                if watch is not None:
                    watch(self)
        return self.outcome.completed

    def _adapt(self, size: int) -> None:
        if not self.settings.adaptive:
            return
        self._easy = self._easy + 1 if self._last_iterations <= 4 else 0
        if self._easy >= 6 and self._level > 0 and size == 2 ** (LEVELS - self._level):
            self._level -= 1
            self._easy = 0

    def _try(self, size: int) -> bool:
        h = self.settings.largest_step * size / 2**LEVELS
        t = (self._ticks + size) * self.settings.largest_step / 2**LEVELS
        accepted = self._newton(t, h)
        if accepted is None:
            if not self.outcome.completed:
                return False
            self.counters.cuts += 1
            self._easy = 0
            self._factor = None
            self._level = LEVELS - int(np.log2(size)) + 1
            if self._level > LEVELS:
                self.outcome = Outcome(Status.NOT_CONVERGED, f"{self._worst} at t = {self.t:.4f} s, step {h:.1e} s.")
            return False
        q, v, a, forces = accepted
        fault = self.model.rotation_fault(q)
        if fault:
            self.outcome = Outcome(Status.ROTATION_TOO_LARGE, f"{fault} Time {t:.4f} s.")
            return False
        self.q, self.v, self.a, self.t, self.forces = q, v, a, t, forces
        self.anchors, self.memory = forces.moved, forces.memory
        self._ticks += size
        self.counters.steps += 1
        if forces.penetration > self.deepest[0]:
            self.deepest = (forces.penetration, f"{forces.penetration_at}, t = {t:.3f} s")
        self.ledger.step(h, q, v, a, forces)
        return True

    def _newton(self, t: float, h: float) -> tuple[Array, Array, Array, Forces] | None:
        am, af, gamma, beta = self.settings.coefficients
        model = self.model
        a = self.a.copy()
        q = self.q + h * self.v + 0.5 * h * h * a
        v = self.v + h * a
        model.prescribe(t, q, v, a)
        old = model.inertia(am * self.a) + af * self.forces.F
        start = last = np.inf
        fresh = 0
        for k in range(self.settings.iterations):
            forces = model.forces(t, q, v, self.anchors, memory=self.memory, dt=h)
            residual = model.inertia((1 - am) * a)
            residual += (1 - af) * forces.F
            residual += old
            residual[self._held] = 0.0
            size = float(np.sqrt(np.vdot(residual, residual)))
            self.counters.iterations += 1
            if not np.isfinite(size):
                self._not_finite(residual, t)
                return None
            start = size if k == 0 else start
            if size <= self.settings.relative * start + self.settings.absolute:
                self._last_iterations = k + 1
                return q, v, a, forces
            if size > 1e6 * max(start, 1.0):
                break
            stale = self._factor is None or self._factor_step != h or (size > 0.5 * last and k - fresh >= 2)
            if stale:
                fresh = k
                self._refresh(t, h, q, v)
                if self._factor is None:
                    break
            last = size
            assert self._factor is not None
            delta = self._factor.solve(residual)
            q -= delta
            v -= gamma / (beta * h) * delta
            a -= delta / (beta * h * h)
        self._worst = self._worst_node(residual)
        return None

    def _refresh(self, t: float, h: float, q: Array, v: Array) -> None:
        am, af, gamma, beta = self.settings.coefficients
        blocks = Blocks.zeros(self.model.rod.nodes)
        self.model.forces(t, q, v, self.anchors, blocks=blocks, factor=gamma / (beta * h), memory=self.memory, dt=h)
        for part in (blocks.D, blocks.U, blocks.L):
            part *= 1 - af
        self.model.add_mass((1 - am) / (beta * h * h), blocks)
        self.model.fix(blocks)
        factor = Factor(blocks)
        self._factor = factor if factor.singular_node < 0 else None
        self._factor_step = h
        self.counters.factorisations += 1

    def _initial_acceleration(self) -> None:
        model = self.model
        blocks = Blocks.zeros(model.rod.nodes)
        model.add_mass(1.0, blocks)
        model.fix(blocks)
        right = -self.forces.F - model.inertia(self.a)
        right = np.where(model.free, right, 0.0)
        self.a = np.where(model.free, Factor(blocks).solve(right), self.a)

    def _not_finite(self, residual: Array, t: float) -> None:
        node = int(np.argwhere(~np.isfinite(residual))[0, 0])
        self.outcome = Outcome(
            Status.NOT_FINITE, f"It appeared at node {node} in the step to t = {t:.4f} s; the state before it is kept."
        )

    def _worst_node(self, residual: Array) -> str:
        node = int(np.argmax(np.abs(residual[:, 0:3]).max(axis=1)))
        worst = float(np.abs(residual[node, 0:3]).max())
        return f"The residual is largest at node {node}, {worst:.2e} N"

r"""Time integration of M(q) a + F(q, v, t) = 0 by the generalised-alpha method with modified Newton iteration.

.. math:: M[(1-\alpha_m) a_{n+1} + \alpha_m a_n] + (1-\alpha_f) F_{n+1} + \alpha_f F_n = 0, \\
          \alpha_m = \frac{2\rho - 1}{\rho + 1}, \quad \alpha_f = \frac{\rho}{\rho + 1}, \quad
          \gamma = \tfrac12 - \alpha_m + \alpha_f, \quad \beta = \tfrac14 (1 - \alpha_m + \alpha_f)^2,

written for M(q) as in :mod:`beam.newton_step`. Second order, unconditionally stable for linear problems, spectral radius rho
at infinite frequency. The factorised matrix is kept over steps and renewed where the residual falls by less than a factor of
two in an iteration. A step that does not converge is halved, never accepted. Steps are h_max / 2^k on a dyadic grid, so that
output times are met exactly and a run can be repeated bit by bit.

Every step estimates its own error in position, from the difference between the method and the third term of Taylor's series,

.. math:: e = h^2 |\beta - \tfrac16|\; \max_{nodes} |w_{n+1} - w_n| .

Its largest value and its sum, a bound for the error of the whole run where nothing amplifies it, are kept; with
:attr:`StepSettings.error` a step whose own error is larger is halved.

Sources: J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371-375, doi 10.1115/1.2900803;
O. C. Zienkiewicz, Y. M. Xie, Earthq. Eng. Struct. Dyn. 20 (1991) 871-887, doi 10.1002/eqe.4290200907 (the estimate).
"""

from __future__ import annotations

import copy
import logging
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beam.body_step import body_step
from beam.contact_state import ContactState, contact_states
from beam.energy_ledger import EnergyLedger
from beam.free_roller import FreeRollers
from beam.linear_solve import Factor
from beam.newton_step import (
    CONVERGED,
    NOT_FINITE,
    TOTALS,
    ContactArrays,
    MatrixArrays,
    Rule,
    StateArrays,
    correct,
    newton_step,
    predict,
    residual_size,
)
from beam.rod_model import Forces, RodModel
from beam.rotation_vector import turn_back
from beam.section_memory import LONG, SectionMemory
from beam.status import Outcome, Status
from geometry.errors import SpecError

Array = NDArray[np.float64]

logger = logging.getLogger(__name__)

LEVELS = 14
"""The smallest step is h_max / 2^14."""


@dataclass(frozen=True)
class StepSettings:
    """Largest step [s], spectral radius, stopping rule |R| <= relative |R_0| + absolute [N, N m], iterations a step, largest
    own error of a step [m].

    `absolute` is 3e-6 of the sum of the sizes of the constant nodal forces if not given, and at least 1e-3 N.
    """

    largest_step: float = 5e-3
    first_level: int = 4
    spectral_radius: float = 0.7
    relative: float = 1e-6
    absolute: float | None = None
    iterations: int = 16
    adaptive: bool = True
    error: float = np.inf

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


KEPT = (
    "_state", "t", "counters", "outcome", "_anchors", "_anchors_before", "memory", "deepest", "step_error", "error_sum",
    "_last_iterations", "_worst", "_ticks", "_level", "_easy", "_matrix", "_known", "_factor_step", "_factor", "_held_force",
    "rollers",
)  # fmt: skip
"""What a run consists of besides its model and settings."""


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

    Attributes
    ----------
    q, v, a : (n + 1, 12) array
        Present state; `a` is the acceleration that is in balance with the forces.
    step_error : (m, str)
        Largest own error of a step in position, and the node and time of it.
    error_sum : float
        Sum of the own errors of all steps [m].
    rollers : FreeRollers
        Angles and speeds of the rollers that the cable turns.
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
        zero = np.zeros_like(model.q0)
        v = np.zeros_like(model.q0[: model.rod.nodes]) if v is None else v
        start = (model.complete(q), model.complete(v, motion=True), zero, zero)
        self._state = StateArrays(*(np.array(x, dtype=float, order="C") for x in start))
        self._trial = StateArrays(*(np.zeros_like(x) for x in self._state))
        self.t = 0.0
        self.counters = Counters()
        self.outcome = Outcome()
        turn_back(*self._state)
        model.prescribe(0.0, self.q, self.v, self.a)
        if anchors is None:
            anchors = model.forces(0.0, self.q, self.v, model.fresh_anchors(), friction=False).moved
        self._anchors = self._anchors_before = model.join(anchors)
        self.memory = memory
        self.rollers = FreeRollers(model)
        self.deepest: tuple[float, str] = (0.0, "")
        self.step_error: tuple[float, str] = (0.0, "")
        self.error_sum = 0.0
        self._last_iterations = 0
        self._worst = ""
        self._ticks = 0
        self._level = self.settings.first_level if self.settings.adaptive else 0
        self._easy = 0
        size = 3e-6 * float(np.linalg.norm(model.external[:, 0:3], axis=1).sum())
        given = self.settings.absolute
        self._absolute = max(1e-3, size) if given is None else given
        self._make_room()
        self._initial_acceleration()
        self.ledger = EnergyLedger(model)
        self.ledger.start(self.forces)

    def _make_room(self) -> None:
        model, nodes, dof = self.model, self.model.rows, self.model.rod.dof
        blocks = model.blocks()
        pivots = np.zeros((nodes, dof), dtype=np.int64)
        self._matrix: Any = blocks.store
        if blocks.store is None:
            self._matrix = MatrixArrays(blocks.D, blocks.U, blocks.L, pivots)
        self._known, self._factor_step = False, 0.0
        self._factor: Factor | None = None
        self._F, self._R = np.zeros((nodes, dof)), np.zeros((nodes, dof))
        self._S, self._totals = np.zeros_like(model.rod.E0), np.zeros(TOTALS)
        self._moved, self._cone = np.empty_like(self._anchors), np.zeros(len(self._anchors))
        self._reports, self._nodal = np.zeros((len(model.surfaces), 7)), np.zeros((model.rod.nodes, 3))

    def checkpoint(self) -> dict[str, Any]:
        """Everything that the rest of the run depends on, as arrays and plain values; see :mod:`beam.checkpoint`."""
        kept = {name: copy.deepcopy(getattr(self, name)) for name in KEPT}
        kept["ledger"] = {name: copy.deepcopy(x) for name, x in vars(self.ledger).items() if name != "model"}
        kept["forces"] = copy.deepcopy(self._forces)
        return kept

    def restore(self, kept: dict[str, Any]) -> None:
        """Go back to a :meth:`checkpoint` of a run of the same model with the same settings.

        Raises
        ------
        SpecError
            If it belongs to a rod of another size.
        """
        if kept["_state"].q.shape != self.q.shape or kept["_anchors"].shape != self._anchors.shape:
            raise SpecError(
                f"the checkpoint is of a rod with {len(kept['_state'].q)} nodes and {len(kept['_anchors'])} contact points; "
                f"this one has {len(self.q)} and {len(self._anchors)}."
            )
        for name in KEPT:
            setattr(self, name, copy.deepcopy(kept[name]))
        for name, value in kept["ledger"].items():
            setattr(self.ledger, name, copy.deepcopy(value))
        self._forces = copy.deepcopy(kept["forces"])

    @property
    def q(self) -> Array:
        """Positions and rotations."""
        return self._state.q

    @property
    def v(self) -> Array:
        """Velocities."""
        return self._state.v

    @property
    def a(self) -> Array:
        """Accelerations."""
        return self._state.w

    @property
    def anchors(self) -> list[Array]:
        """Friction anchors, one array (n, points, 3) per surface."""
        return self.model.split(self._anchors)

    @property
    def forces(self) -> Forces:
        """Everything about the forces of the present state, inertia contained; worked out when it is asked for."""
        if self._forces is None:
            before, rollers = self.model.split(self._anchors_before), self.rollers
            self._forces = self.model.forces(self.t, self.q, self.v, before, a=self.a, turned=rollers.turned)
            rollers.book(self.model, self.t, self.q, self.v, before, rollers.state, self._forces)
        return self._forces

    @property
    def contacts(self) -> list[ContactState]:
        """Gap, normal force, friction and slip of every contact point, one entry for each surface."""
        before = self.model.split(self._anchors_before)
        return contact_states(self.model, self.t, self.q, self.v, before, self.rollers.turned)

    @property
    def reaction(self) -> Array:
        """Force of the supports on the held unknowns, zero elsewhere, shape (n + 1, 12) [N, N m]."""
        out = np.zeros_like(self._F)
        i, k = self.model.held.T
        out[i, k] = self._held_force
        return out

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
        am, af, gamma, beta = self.settings.coefficients
        one = self.settings
        rule = Rule(am, af, gamma, beta, h, one.relative, self._absolute, one.iterations)
        plain = self.model.law is None and not self.model.free_rollers
        forces = self._compiled_step(t, rule) if plain else self._interpreted_step(t, rule)
        error, node = self._own_error(h, beta) if forces is not None else (0.0, 0)
        if forces is None or error > one.error:
            if forces is not None:
                self._worst = f"The error of a step is largest at {self.model.row_name(node)}, {error:.1e} m,"
            self._cut(size, h)
            return False
        self._accept(t, size, forces)
        self.error_sum += error
        if error > self.step_error[0]:
            self.step_error = (error, f"{self.model.row_name(node)}, t = {t:.3f} s")
        self.ledger.step(h, forces)
        return True

    def _own_error(self, h: float, beta: float) -> tuple[float, int]:
        moving = self.model.moving
        change = self._trial.w[:moving, 0:3] - self._state.w[:moving, 0:3]
        squares = np.einsum("ij,ij->i", change, change)
        node = int(squares.argmax())
        return h * h * abs(beta - 1 / 6) * float(np.sqrt(squares[node])), node

    def _cut(self, size: int, h: float) -> None:
        if not self.outcome.completed:
            return
        self.counters.cuts += 1
        self._easy = 0
        self._known, self._factor = False, None
        self._level = LEVELS - int(np.log2(size)) + 1
        if self._level > LEVELS:
            self.outcome = Outcome(Status.NOT_CONVERGED, f"{self._worst} at t = {self.t:.4f} s, step {h:.1e} s.")

    def _accept(self, t: float, size: int, forces: Forces) -> None:
        self._state, self._trial = self._trial, self._state
        self.t = t
        self._forces = None
        if self.model.law is not None or self.model.free_rollers:
            self._forces, self.memory = forces, forces.memory
        self.rollers.commit()
        if self.model.system is not None:
            self.model.system.settle(*self._state[1:])
        i, k = self.model.held.T
        self._held_force = forces.F[i, k]
        self._anchors_before, self._anchors = self._anchors, self.model.join(forces.moved)
        self._ticks += size
        self.counters.steps += 1
        if turn_back(*self._state):
            self._known, self._factor = False, None
            if self.model.load is not None:
                self.ledger.shift(forces, -float(np.vdot(self.model.external, self._state.q)))
        if forces.penetration > self.deepest[0]:
            self.deepest = (forces.penetration, f"{forces.penetration_at}, t = {t:.3f} s")

    def _compiled_step(self, t: float, rule: Rule) -> Forces | None:
        model = self.model
        contact = ContactArrays(
            model.surface_parameters(t), model.first, model.xs, model.ws, self._anchors, self._moved, self._reports,
            self._nodal, self._cone,
        )  # fmt: skip
        known = self._known and self._factor_step == rule.h
        parts = Forces(self._F, self._S, [self._moved], self._nodal, self._nodal, [])
        if model.system is None:
            code, iterations, factored, self._known = newton_step(
                model.arrays, contact, model.external, model.held, model.held_values(t), self._state, self._trial,
                self._matrix, known, rule, self._F, self._S, self._R, self._totals,
            )  # fmt: skip
        else:
            code, iterations, factored, self._known = body_step(
                model, model.system, t, contact, self._state, self._trial, self._matrix, known, rule, parts, self._R,
                self._totals,
            )  # fmt: skip
        self._factor_step = rule.h
        self.counters.iterations += iterations
        self.counters.factorisations += factored
        self._last_iterations = iterations
        if code != CONVERGED:
            self._failed(code, t)
            return None
        elastic, damping, kinetic, power, potential = self._totals.tolist()
        parts.elastic, parts.potential, parts.damping_power = elastic, potential, damping
        parts.kinetic += kinetic
        parts.held_power += power
        model.add_reports(parts, self._reports)
        return parts

    def _interpreted_step(self, t: float, rule: Rule) -> Forces | None:
        """The same iteration as :func:`beam.newton_step.newton_step`, for a section law that is Python and for free rollers."""
        model, new, rollers = self.model, self._trial, self.rollers
        predict(self._state, new, rule)
        rollers.predict(rule)
        model.prescribe(t, new.q, new.v, new.w)
        start = last = np.inf
        fresh = 0
        for k in range(rule.iterations):
            forces = model.forces(
                t, new.q, new.v, self.anchors, memory=self.memory, dt=rule.h, a=new.w, turned=rollers.turned_trial
            )  # fmt: skip
            size = residual_size(forces.F, model.held, self._R)
            size = (1 - rule.af) * float(np.hypot(size, rollers.size(model, t, new, self.anchors)))
            self.counters.iterations += 1
            if not np.isfinite(size):
                self._failed(NOT_FINITE, t)
                return None
            start = size if k == 0 else start
            if size <= rule.relative * start + rule.absolute:
                self._last_iterations = k + 1
                rollers.book(model, t, new.q, new.v, self.anchors, rollers.trial, forces)
                return forces
            if size > 1e6 * max(start, 1.0):
                break
            if self._factor is None or self._factor_step != rule.h or (size > 0.5 * last and k - fresh >= 2):
                fresh = k
                self._renew(t, rule)
                if self._factor is None:
                    break
            last = size
            delta, turn = rollers.solve(self._factor.solve, self._R)
            correct(new, delta, rule)
            rollers.correct(turn, rule)
        self._failed(-1, t)
        return None

    def _renew(self, t: float, rule: Rule) -> None:
        model, new = self.model, self._trial
        blocks = model.blocks()
        speed = rule.gamma / (rule.beta * rule.h)
        acceleration = (1 - rule.am) / ((1 - rule.af) * rule.beta * rule.h**2)
        model.forces(
            t, new.q, new.v, self.anchors, blocks=blocks, factor=speed, memory=self.memory, dt=rule.h, a=new.w,
            factor_a=acceleration, turned=self.rollers.turned_trial,
        )  # fmt: skip
        model.fix(blocks)
        factor = Factor(blocks)
        self._factor = factor if factor.singular_node < 0 else None
        if self._factor is not None:
            self.rollers.border(model, t, new, self.anchors, rule)
            self.rollers.bordered(factor.solve)
        self._factor_step = rule.h
        self.counters.factorisations += 1

    def _initial_acceleration(self) -> None:
        """M(q) a = -F by Newton's method, which meets a mass matrix that turns with the section after one step."""
        model, state = self.model, self._state
        given = LONG if self.memory is None else None
        for _ in range(3):
            blocks = model.blocks()
            self._forces = model.forces(
                0.0, state.q, state.v, self.anchors, memory=self.memory, dt=given, a=state.w, blocks=blocks, factor_a=1e9
            )  # fmt: skip
            blocks.divide(1e9)
            model.fix(blocks)
            if model.system is not None:
                model.system.accelerate_joints(state.q, state.v, state.w, self._forces.F, 1e9)
            delta = np.where(model.free, Factor(blocks).solve(np.where(model.free, self._forces.F, 0.0)), 0.0)
            state.w[:] -= delta
            if model.system is not None:
                model.system.take_multipliers(delta / 1e9, state.q, state.w)
        state.a[:] = state.w
        self._forces = model.forces(
            0.0, state.q, state.v, self.anchors, memory=self.memory, dt=given, a=state.w
        )  # fmt: skip
        self.memory = self._forces.memory
        i, k = model.held.T
        self._held_force = self._forces.F[i, k]

    def _failed(self, code: int, t: float) -> None:
        R = self._R
        if code == NOT_FINITE:
            broken = np.argwhere(~np.isfinite(R))
            node = int(broken[0, 0]) if len(broken) else 0
            detail = (
                f"It appeared at {self.model.row_name(node)} in the step to t = {t:.4f} s; the state before it is kept."
            )
            self.outcome = Outcome(Status.NOT_FINITE, detail)
            return
        node = int(np.argmax(np.abs(R[:, 0:3]).max(axis=1)))
        worst = float(np.abs(R[node, 0:3]).max())
        self._worst = f"The residual is largest at {self.model.row_name(node)}{self._touching(node)}, {worst:.2e} N,"

    def _touching(self, node: int) -> str:
        """Which surfaces the elements of a node touched in the last iteration."""
        turned, q = self.rollers.turned_trial, self._trial.q
        if not np.isfinite(q).all():
            return ""
        states = contact_states(self.model, self.t, q, self._trial.v, self.anchors, turned)
        near = slice(max(node - 1, 0), node + 1)
        pairs = zip(self.model.surfaces, states, strict=True)
        names = [surface.name for surface, state in pairs if state.touching[near].any()]
        return f" (on {' and '.join(names)})" if names else ""

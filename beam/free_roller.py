r"""Rollers that the cable turns: one unknown angle each, solved together with the rod.

.. math:: I \ddot\varphi + m(q, \dot q, \varphi, \dot\varphi) + m_b(\varphi) = 0,

m the moment about the axis that the roller's friction exerts on the cable, m_b the dry friction of the bearing, an
elastic-plastic bristle of the moment M and the angle `play`: it holds exactly up to M. The moment is linear in the nodal
contact forces G of the roller, m = w(q) . G with w the velocity of the rod when it turns about the axis as a rigid body, so that
the border of the iteration matrix follows from the contact tangent K_c of this roller alone,

.. math:: \frac{\partial m}{\partial q} = -K_c^T w + G \cdot \frac{\partial w}{\partial q} .

The matrix is bordered by these rows and columns and solved by the Schur complement. In steady turning
T_2 = T_1 + M / R over the roller of radius R, whatever the friction between cable and roller, as long as it does not slip.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from beam.contact_force import contact_forces
from beam.newton_step import Rule, StateArrays
from beam.rod_model import Blocks, Forces, RodModel
from beam.surface import Cylinder, FreeTurn, turn_surface

Array = NDArray[np.float64]

NUDGE = 1e-9
"""Angle of the difference for the column of the border [rad]."""


class FreeRollers:
    """All free rollers of a model: angle, speed, algorithmic and true acceleration, (4, rollers), and their bearings.

    Attributes
    ----------
    state : (4, rollers) array
        Of the last accepted step.
    held_at : (rollers,) array
        Angles at which the bearings' bristles are unloaded [rad].
    """

    def __init__(self, model: RodModel) -> None:
        self.surfaces = list(model.free_rollers)
        turns = [s.turn for s in model.surfaces if isinstance(s, Cylinder) and isinstance(s.turn, FreeTurn)]
        self.inertia = np.array([turn.inertia for turn in turns])
        self.limit = np.array([turn.moment for turn in turns])
        self.stiffness = np.array([turn.moment / turn.play for turn in turns])
        self.state = np.zeros((4, len(turns)))
        self.trial = self.state.copy()
        self.held_at = np.zeros(len(turns))
        self.residual = np.zeros(len(turns))

    @property
    def turned(self) -> Array:
        """Angles and speeds of the present state, (rollers, 2), as :meth:`beam.rod_model.RodModel.forces` wants them."""
        return np.ascontiguousarray(self.state[:2].T)

    @property
    def turned_trial(self) -> Array:
        """The same of the step that is being tried."""
        return np.ascontiguousarray(self.trial[:2].T)

    def bearing(self, state: Array) -> tuple[Array, Array, Array]:
        """Bearing moment on the roller against its turning [N m], angle of the bristle, angle at which it is unloaded."""
        bent = state[0] - self.held_at
        moment = np.clip(self.stiffness * bent, -self.limit, self.limit)
        bent = np.divide(moment, self.stiffness, out=np.zeros_like(moment), where=self.stiffness > 0)
        return moment, bent, state[0] - bent

    def predict(self, rule: Rule) -> None:
        """Start of the iteration, as :func:`beam.newton_step.predict`."""
        angle, speed, a, w = self.state
        new_speed = speed + rule.h * a
        self.trial = np.array(
            [angle + 0.5 * rule.h * (speed + new_speed), new_speed, a, (a - rule.af * w) / (1 - rule.af)]
        )

    def size(self, model: RodModel, t: float, new: StateArrays, anchors: list[Array]) -> float:
        """Length of the residual of the rollers' equations [N m]."""
        moment = self.moments(model, t, new.q, new.v, anchors, self.trial)
        self.residual = self.inertia * self.trial[3] + moment + self.bearing(self.trial)[0]
        return float(np.linalg.norm(self.residual))

    def moments(self, model: RodModel, t: float, q: Array, v: Array, anchors: list[Array], state: Array) -> Array:
        """Moment of each roller on the cable about its axis [N m]."""
        P = model.surface_parameters(t, turned=np.ascontiguousarray(state[:2].T))
        each = (np.vdot(_arm(P[k], q), _contact(model, P[k], k, q, v, anchors)) for k in self.surfaces)
        return np.fromiter(each, float, len(self.surfaces))

    def border(self, model: RodModel, t: float, new: StateArrays, anchors: list[Array], rule: Rule) -> None:
        """Columns, rows and corner of the bordered matrix at the trial state."""
        speed = rule.gamma / (rule.beta * rule.h)
        acceleration = (1 - rule.am) / ((1 - rule.af) * rule.beta * rule.h**2)
        count = len(self.surfaces)
        self.columns, self.rows = np.zeros((2, count, *new.q.shape))
        corner = acceleration * self.inertia
        corner = corner + np.where(np.abs(self.bearing(self.trial)[0]) < self.limit, self.stiffness, 0.0)
        P = model.surface_parameters(t, turned=self.turned_trial)
        for i, k in enumerate(self.surfaces):
            arm, blocks = _arm(P[k], new.q), Blocks.zeros(model.rod.nodes, model.rod.dof)
            G = _contact(model, P[k], k, new.q, new.v, anchors, blocks, speed)
            ahead = P[k].copy()
            turn_surface(ahead, self.trial[0, i] + NUDGE, self.trial[1, i] + speed * NUDGE)
            change = (_contact(model, ahead, k, new.q, new.v, anchors) - G) / NUDGE
            self.columns[i] = np.where(model.free, -change, 0.0)
            row = -_transposed(blocks, arm)
            row[:, [0, 3]] += G[:, [1, 4]]
            row[:, [1, 4]] -= G[:, [0, 3]]
            self.rows[i] = np.where(model.free, row, 0.0)
            corner[i] += np.vdot(arm, change)
        self.corner = np.diag(corner)

    def bordered(self, solve: Callable[[Array], Array]) -> None:
        """Eliminate the rod from the rollers' equations with the factorised matrix of the rod."""
        if not self.surfaces:
            return
        self.answers = np.array([solve(column) for column in self.columns])
        self.schur = self.corner - np.einsum("ink,jnk->ij", self.rows, self.answers)

    def solve(self, solve: Callable[[Array], Array], R: Array) -> tuple[Array, Array]:
        """Newton's step of the rod and of the rollers for the residuals `R` and :attr:`residual`."""
        alone = solve(R)
        if not self.surfaces:
            return alone, np.zeros(0)
        turn = np.linalg.solve(self.schur, self.residual - np.einsum("ink,nk->i", self.rows, alone))
        return alone - np.einsum("i,ink->nk", turn, self.answers), turn

    def correct(self, turn: Array, rule: Rule) -> None:
        """Subtract Newton's step, as :func:`beam.newton_step.correct`."""
        algorithmic = 1.0 / (rule.beta * rule.h**2)
        true = (1 - rule.am) / (1 - rule.af) * algorithmic
        self.trial = self.trial - np.outer([1.0, rule.gamma / (rule.beta * rule.h), algorithmic, true], turn)

    def commit(self) -> None:
        """The trial state is accepted."""
        self.held_at = self.bearing(self.trial)[2]
        self.state = self.trial.copy()

    def book(
        self, model: RodModel, t: float, q: Array, v: Array, anchors: list[Array], state: Array, out: Forces
    ) -> None:
        """Add the rollers' energies and powers to `out`; turning them is no work of a drive."""
        moment, bent, _ = self.bearing(state)
        out.kinetic += float(0.5 * self.inertia @ state[1] ** 2)
        out.bristle += float(0.5 * self.stiffness @ bent**2)
        out.friction_power += float(moment @ state[1])
        out.surface_power -= float(self.moments(model, t, q, v, anchors, state) @ state[1])


def _arm(p: Array, q: Array) -> Array:
    """Velocity of the rod's unknowns when it turns about the cylinder's axis with 1 rad/s."""
    arm = np.zeros_like(q)
    arm[:, 0], arm[:, 1] = -(q[:, 1] - p[11]), q[:, 0] - p[10]
    arm[:, 3], arm[:, 4] = -q[:, 4], q[:, 3]
    return arm


def _contact(
    model: RodModel, p: Array, k: int, q: Array, v: Array, anchors: list[Array],
    blocks: Blocks | None = None, factor: float = 0.0,
) -> Array:  # fmt: skip
    """Contact forces of surface `k` alone on the rod's unknowns; with `blocks` also minus their derivative."""
    i, j = model.first[k], model.first[k + 1]
    own = np.ascontiguousarray(anchors[k]).reshape(-1, 3)
    F, nodal, matrix = np.zeros_like(q), np.zeros((len(q), 3)), blocks or Blocks.zeros(2, model.rod.dof)
    contact_forces(
        p[None], np.array([0, j - i]), model.xs[i:j], model.ws[i:j], q, v, model.rod.lengths, own, np.empty_like(own), F,
        nodal, nodal, np.zeros((1, 7)), np.zeros(len(own)), False, blocks is not None, factor, matrix.D, matrix.U, matrix.L,
    )  # fmt: skip
    return -F


def _transposed(blocks: Blocks, x: Array) -> Array:
    """The transposed matrix times `x`."""
    out = np.einsum("nij,ni->nj", blocks.D, x)
    out[1:] += np.einsum("nij,ni->nj", blocks.U, x[:-1])
    out[:-1] += np.einsum("nij,ni->nj", blocks.L, x[1:])
    return out

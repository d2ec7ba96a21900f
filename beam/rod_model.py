"""A rod with its loads, supports and contacts: the equations M(q) a + F(q, v, t) = 0 that statics and dynamics solve."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beam.block_sparse import fix_store
from beam.bushing import Bushing
from beam.contact_force import PARAMETERS, contact_forces
from beam.element import DOF, UNIT_MASS, unit_shapes
from beam.element_choice import add_mass, internal_force, internal_tangent
from beam.hermite import gauss_points
from beam.joint import Joint
from beam.multibody import BODY_FIELDS, Multibody
from beam.newton_step import RodArrays, fix_blocks
from beam.rigid_body import RigidBody
from beam.rod import GAUSS_W, GAUSS_X, Rod
from beam.rod_forces import Blocks, Forces
from beam.section_law import SectionLaw
from beam.section_memory import (
    LONG,
    SectionMemory,
    law_step,
    section_force_on_nodes,
    section_force_tangent,
    strains,
)
from beam.sliding_friction import FALL
from beam.support import Support
from beam.surface import FreeTurn, Surface, turn_surface
from geometry.errors import SpecError

Array = NDArray[np.float64]


@dataclass
class RodModel:
    """The mechanical problem.

    Parameters
    ----------
    rod : Rod or AncfCable
    q0 : (n + 1, 12) array
        Starting shape; held fields keep its values. Of the ANCF cable also its part (n + 1, 6), which is what is kept.
    supports : sequence of Support
    gravity : (3,) array_like
        Acceleration [m/s^2].
    load : (n + 1, 12) array, optional
        Constant nodal forces besides the weight: N on r, N m on r' and theta (for rotation about a fixed axis).
    surfaces : sequence of Plane or Cylinder
    law : SectionLaw, optional
        Section forces with internal state, added to the linear law of the rod.
    bodies, bushings, joints : sequences of RigidBody, Bushing and Joint
        See :mod:`beam.multibody`; the state then has rows for bodies and joints after those of the nodes.
    body_surfaces : sequence of Plane or Cylinder
        Touched by the points of the bodies, as `surfaces` are by the cable.
    """

    rod: Rod
    q0: Array
    supports: Sequence[Support] = ()
    gravity: ArrayLike = (0.0, 0.0, 0.0)
    load: Array | None = None
    surfaces: Sequence[Surface] = ()
    law: SectionLaw | None = None
    bodies: Sequence[RigidBody] = ()
    bushings: Sequence[Bushing] = ()
    joints: Sequence[Joint] = ()
    body_surfaces: Sequence[Surface] = ()
    free: NDArray[np.bool_] = field(init=False)
    weight: Array = field(init=False)

    def __post_init__(self) -> None:
        shape = (self.rod.nodes, DOF)
        if self.law is not None and self.rod.dof != DOF:
            raise SpecError("a section law with internal state needs the rod, whose section can twist and shear.")
        if self.q0.shape[1:] == (DOF,):
            self.q0 = self.rod.columns(self.q0)
        if self.load is not None and self.load.shape[1:] == (DOF,):
            self.load = self.rod.load_columns(self.load)
        shape = (self.rod.nodes, self.rod.dof)
        if self.q0.shape != shape or (self.load is not None and self.load.shape != shape):
            raise SpecError(f"the starting shape and the load of a rod with {shape[0]} nodes must have shape {shape}.")
        self.system = self._with_bodies()
        self.free = np.ones(shape, dtype=bool) if self.system is None else self.system.used.copy()
        for support in self.supports:
            row = self.row(support.node)
            for name in support.held:
                self.free[row, self._slots(name, row)] = False
        self.weight = self.rod.weight(np.asarray(self.gravity, dtype=float))
        if self.rod.dof != DOF and any(support.turn is not None for support in self.supports):
            raise SpecError(
                "a section of an ANCF cable cannot be turned by a support, it has no rotations: take the rod."
            )
        self._external = self.weight if self.load is None else self.weight + self.load
        if self.system is not None:
            self.weight = self.system.external(np.asarray(self.gravity, dtype=float), self.weight)
            self._external = self.system.external(np.asarray(self.gravity, dtype=float), self._external)
        self.held = np.argwhere(~self.free)
        rod = self.rod
        self.arrays = RodArrays(
            rod.lengths, GAUSS_X, GAUSS_W, unit_shapes(GAUSS_X), rod.C, rod.C_damping, bool(rod.C_damping.any()),
            rod.E0, float(rod.mass_per_length), rod.J, UNIT_MASS,
        )  # fmt: skip
        points = [gauss_points(s.points) for s in self.surfaces]
        self.first = np.concatenate([[0], np.cumsum([s.points for s in self.surfaces])]).astype(np.int64)
        self.xs = np.concatenate([np.empty(0), *(x for x, _ in points)])
        self.ws = np.concatenate([np.empty(0), *(w for _, w in points)])
        self.free_rollers = [k for k, s in enumerate(self.surfaces) if isinstance(getattr(s, "turn", None), FreeTurn)]
        self._empty = Blocks.zeros(2, self.rod.dof)
        if self.system is not None:
            self.system.check(self.free, len(self.free_rollers))

    def _with_bodies(self) -> Multibody | None:
        if not (self.bodies or self.bushings or self.joints):
            return None
        if self.rod.dof != DOF:
            raise SpecError("an ANCF cable has no rotations to which bodies could be attached: take the rod.")
        system = Multibody(self.q0, self.bodies, self.bushings, self.joints, self.body_surfaces)
        self.q0 = system.start
        return system

    @property
    def rows(self) -> int:
        """Rows of the state: nodes, bodies, joints."""
        return self.rod.nodes if self.system is None else self.system.rows

    @property
    def moving(self) -> int:
        """Rows that have a position: nodes and bodies."""
        return self.rod.nodes + len(self.bodies)

    def row(self, node: int | str) -> int:
        """Row of the state of a node (negative: from the end) or of a body."""
        if self.system is None and not isinstance(node, str):
            return node % self.rod.nodes
        if self.system is None:
            raise SpecError(f"a support refers to the body {node!r}; the model has no bodies.")
        return self.system.row(node, "a support")

    def row_name(self, row: int) -> str:
        """What a row of the state is, for messages."""
        return f"node {row}" if self.system is None else self.system.row_name(row)

    def _slots(self, name: str, row: int) -> slice | list[int]:
        if row < self.rod.nodes:
            return self.rod.slots(name, self.q0[row])
        if name not in BODY_FIELDS:
            raise SpecError(
                f"{self.row_name(row)} has no field {name!r} that could be held; choose from {', '.join(BODY_FIELDS)}."
            )
        return BODY_FIELDS[name]

    def blocks(self) -> Blocks:
        """An empty matrix with the couplings of this model."""
        if self.system is None:
            return Blocks.zeros(self.rod.nodes, self.rod.dof)
        return Blocks.of_pattern(self.system.pattern)

    def complete(self, q: Array, motion: bool = False) -> Array:
        """State (or, with `motion`, velocities) of all rows, of the nodes alone: bodies as they are at the start."""
        q = self.rod.columns(np.asarray(q, dtype=float))
        if self.system is None or len(q) != self.rod.nodes:
            return q
        rest = self.system.motion if motion else self.system.start
        return np.concatenate([q, rest[self.rod.nodes :]])

    @property
    def external(self) -> Array:
        """Constant nodal forces, weight and load, (n + 1, 12)."""
        return self._external

    def fresh_anchors(self) -> list[Array]:
        """Friction anchors before any contact, one array (n, points, 3) per surface."""
        anchors = [np.full((self.rod.lengths.size, s.points, 3), np.nan) for s in self.surfaces]
        if self.system is not None:
            anchors += [np.full((1, len(self.system.points.rows), 3), np.nan) for _ in self.body_surfaces]
        return anchors

    def fresh_memory(self) -> SectionMemory | None:
        """Memory of a rod that was never strained; None without a section law."""
        if self.law is None:
            return None
        return SectionMemory.fresh(self.law, self.rod.lengths.size, GAUSS_X.size)

    def prescribe(self, t: float, q: Array, v: Array, a: Array) -> None:
        """Set held fields to their prescribed values at time `t`, in place."""
        i, k = self.held.T
        q[i, k], v[i, k], a[i, k] = self.held_values(t).T

    def held_values(self, t: float) -> Array:
        """Position, velocity and acceleration of the unknowns `held` (k, 2) at time `t`, (k, 3)."""
        if not hasattr(self, "_at_rest"):
            self._at_rest = np.zeros((len(self.held), 3))
            self._at_rest[:, 0] = self.q0[tuple(self.held.T)]
            row = {(int(i), int(k)): j for j, (i, k) in enumerate(self.held)}
            self._driven = []
            for support in self.supports:
                node = self.row(support.node)
                for motion, slot in ((support.travel, 0), (support.turn, 6)):
                    rows = [(row[node, slot + k], k) for k in range(3) if (node, slot + k) in row]
                    if motion is not None and rows:
                        here, axes = np.array(rows).T
                        self._driven.append((motion, here, axes))
        values = self._at_rest.copy()
        for motion, here, axes in self._driven:
            u, du, ddu = motion(t)
            values[here, 0] += u[axes]
            values[here, 1] = du[axes]
            values[here, 2] = ddu[axes]
        return values

    def surface_parameters(self, t: float, friction: bool = True, turned: Array | None = None) -> Array:
        """What the contact kernel reads of the surfaces at time `t`, (surfaces, 30); `turned` (free rollers, 2) angle, speed."""
        P = np.empty((len(self.surfaces), PARAMETERS))
        for row, surface in zip(P, self.surfaces, strict=True):
            row[:] = surface.parameters(t)
        if not friction:
            P[:, 3] = P[:, FALL] = 0.0
        if turned is not None:
            for k, (angle, speed) in zip(self.free_rollers, turned, strict=True):
                turn_surface(P[k], angle, speed)
        return P

    def join(self, anchors: list[Array]) -> Array:
        """Anchors of all surfaces one after the other, (n points, 3)."""
        return np.concatenate([np.empty((0, 3)), *(x.reshape(-1, 3) for x in anchors)])

    def split(self, joined: Array) -> list[Array]:
        """The opposite of :meth:`join`, as views; also of arrays (n points,)."""
        n = self.rod.lengths.size
        pairs = zip(self.first[:-1], self.first[1:], strict=True)
        parts = [joined[n * i : n * j].reshape(n, j - i, *joined.shape[1:]) for i, j in pairs]
        if self.system is not None and self.body_surfaces:
            rest = joined[n * self.first[-1] :]
            parts += [*rest.reshape(len(self.body_surfaces), 1, -1, *joined.shape[1:])]
        return parts

    def forces(
        self, t: float, q: Array, v: Array, anchors: list[Array], friction: bool = True,
        blocks: Blocks | None = None, factor: float = 0.0,
        memory: SectionMemory | None = None, dt: float | None = LONG,
        a: Array | None = None, factor_a: float = 0.0, turned: Array | None = None,
    ) -> Forces:  # fmt: skip
        """F(q, v, t), with the accelerations `a` M(q) a + F; with `blocks`, also its dF/dq + factor dF/dv + factor_a dF/da.

        A section law goes in the time `dt` [s] from `memory` (fresh if not given) to the strains of `q`; with None, the
        forces that it has in `memory` are taken as they are. `turned` (free rollers, 2) holds their angles and speeds.
        """
        rod, nodes, n = self.arrays, self.rod.nodes, self.rod.lengths.size
        joined = self.join(anchors)
        moved, cone = np.empty_like(joined), np.zeros(len(joined))
        out = Forces(
            -self._external, np.empty((n, GAUSS_X.size, 6)), self.split(moved), np.zeros((nodes, 3)),
            np.zeros((nodes, 3)), self.split(cone),
        )  # fmt: skip
        law = (rod.C, rod.C_damping, rod.E0, rod.m, rod.J, rod.mass)
        moving = a is not None
        w = q if a is None else a
        out.elastic, out.damping_power, out.kinetic = internal_force(
            q, v, w, moving, rod.damped, rod.lengths, rod.H, rod.w, *law, out.F, out.S
        )
        matrix = self._empty
        if blocks is not None:
            matrix = blocks
            blocks.clear()
            internal_tangent(
                q, v, w, moving, factor, factor_a, rod.lengths, rod.x, rod.H, rod.w, *law, blocks.D, blocks.U, blocks.L
            )
        if self.law is not None:
            self._add_law(self.law, q, blocks, memory, dt, out)
        reports = np.zeros((len(self.surfaces), 7))
        contact_forces(
            self.surface_parameters(t, friction, turned), self.first, self.xs, self.ws, q, v, rod.lengths, joined, moved, out.F,
            out.contact, out.friction, reports, cone, True, blocks is not None, factor, matrix.D, matrix.U, matrix.L,
        )  # fmt: skip
        self.add_reports(out, reports)
        if self.system is not None:
            begin = n * int(self.first[-1])
            self.system.add_forces(t, q, v, a, joined, moved, begin, friction, blocks, factor, factor_a, out)
        out.potential = -float(np.vdot(self._external, q))
        i, k = self.held.T
        out.held_power += float(out.F[i, k] @ v[i, k])
        return out

    def _add_law(
        self,
        law: SectionLaw,
        q: Array,
        blocks: Blocks | None,
        memory: SectionMemory | None,
        dt: float | None,
        out: Forces,
    ) -> None:
        lengths = self.rod.lengths
        memory = memory or SectionMemory.fresh(law, lengths.size, GAUSS_X.size)
        step = law_step(law, memory, strains(q, lengths, GAUSS_X, self.rod.E0), dt, blocks is not None)
        S = step.memory.S
        section_force_on_nodes(q, lengths, self.arrays.H, GAUSS_W, S, out.F)
        out.S += S
        out.memory = step.memory
        out.law_work = float(np.sum(GAUSS_W * lengths[:, None] * step.work))
        if blocks is not None and step.T is not None:
            section_force_tangent(q, lengths, GAUSS_X, self.arrays.H, GAUSS_W, S, step.T, blocks.D, blocks.U, blocks.L)

    def add_reports(self, out: Forces, reports: Array) -> None:
        """Energies, powers and deepest penetration of the surfaces, from the contact kernel's `reports` (surfaces, 7)."""
        out.add_contacts(reports, self.surfaces, lambda i: f"element {i}")

    def inertia(self, a: Array, q: Array | None = None, v: Array | None = None) -> Array:
        """M(q) a with the gyroscopic moments of `v`, shape (n + 1, 12); unturned and at rest if `q` is not given."""
        rod = self.arrays
        if q is None:
            q = np.zeros_like(a)
            q[:, 3] = 1.0
        v = np.zeros_like(a) if v is None else v
        out = np.zeros_like(a)
        law = (0 * rod.C, 0 * rod.C, rod.E0, rod.m, rod.J, rod.mass)
        internal_force(q, v, a, True, False, rod.lengths, rod.H, rod.w, *law, out, np.empty_like(rod.E0))
        if self.system is not None:
            self.system.inertia(a, out)
        return out

    def add_mass(self, factor: float, blocks: Blocks) -> None:
        """Add factor M of the unturned sections to the blocks."""
        rod = self.arrays
        add_mass(factor, rod.lengths, rod.w, rod.H, rod.m, rod.J, rod.mass, blocks.D, blocks.U, blocks.L)
        if self.system is not None:
            self.system.add_mass(factor, blocks)

    def fix(self, blocks: Blocks) -> None:
        """Replace rows and columns of held unknowns by the identity."""
        if blocks.store is None or blocks.pattern is None:
            fix_blocks(self.held, blocks.D, blocks.U, blocks.L)
        else:
            at = blocks.pattern
            fix_store(self.held, blocks.store, at.in_row, at.in_row_first, at.in_column, at.in_column_first)

    def potential(self, q: Array) -> float:
        """Energy of the weight [J], zero at the origin."""
        return -float(np.sum(self.weight * q))

"""A rod with its loads, supports and contacts: the equations M a + F(q, v, t) = 0 that statics and dynamics solve."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beam.contact_force import contact_force
from beam.element import DOF, add_mass, inertia_force, internal_force, internal_tangent
from beam.hermite import gauss_points
from beam.rod import GAUSS_W, GAUSS_X, Rod
from beam.rotation_vector import LARGEST_ROTATION
from beam.section_law import SectionLaw
from beam.section_memory import (
    LONG,
    SectionMemory,
    law_step,
    section_force_on_nodes,
    section_force_tangent,
    strains,
)
from beam.surface import Surface, Travel
from geometry.errors import SpecError

Array = NDArray[np.float64]

FIELDS = {
    "r": slice(0, 3),
    "x": slice(0, 1),
    "y": slice(1, 2),
    "z": slice(2, 3),
    "r'": slice(3, 6),
    "theta": slice(6, 9),
    "theta'": slice(9, 12),
}


@dataclass(frozen=True)
class Support:
    """Node (negative: from the end) whose fields are held at their starting values; `travel` moves its position."""

    node: int
    held: tuple[str, ...] = ("r", "theta")
    travel: Travel | None = None


@dataclass
class Forces:
    """Everything that one evaluation of F yields; energies in J, powers in W.

    With a section law: the `memory` to commit if the step is accepted, and the work that the law takes up in it [J].
    """

    F: Array
    S: Array
    moved: list[Array]
    contact: Array
    friction: Array
    cones: list[Array]
    elastic: float = 0.0
    damping_power: float = 0.0
    penalty: float = 0.0
    bristle: float = 0.0
    contact_damping_power: float = 0.0
    friction_power: float = 0.0
    surface_power: float = 0.0
    penetration: float = 0.0
    penetration_at: str = ""
    memory: SectionMemory | None = None
    law_work: float = 0.0


@dataclass
class Blocks:
    """Block-tridiagonal matrix: `D` (n, 12, 12), `U` and `L` (n - 1, 12, 12)."""

    D: Array
    U: Array
    L: Array

    @classmethod
    def zeros(cls, nodes: int) -> Blocks:
        """Empty matrix of `nodes` block rows."""
        shape = (DOF, DOF)
        return cls(np.zeros((nodes, *shape)), np.zeros((nodes - 1, *shape)), np.zeros((nodes - 1, *shape)))


@dataclass
class RodModel:
    """The mechanical problem.

    Parameters
    ----------
    rod : Rod
    q0 : (n + 1, 12) array
        Starting shape; held fields keep its values.
    supports : sequence of Support
    gravity : (3,) array_like
        Acceleration [m/s^2].
    load : (n + 1, 12) array, optional
        Constant nodal forces besides the weight: N on r, N m on r' and theta (for rotation about a fixed axis).
    surfaces : sequence of Plane or Cylinder
    law : SectionLaw, optional
        Section forces with internal state, added to the linear law of the rod.
    """

    rod: Rod
    q0: Array
    supports: Sequence[Support] = ()
    gravity: ArrayLike = (0.0, 0.0, 0.0)
    load: Array | None = None
    surfaces: Sequence[Surface] = ()
    law: SectionLaw | None = None
    free: NDArray[np.bool_] = field(init=False)
    weight: Array = field(init=False)

    def __post_init__(self) -> None:
        shape = (self.rod.nodes, DOF)
        if self.q0.shape != shape or (self.load is not None and self.load.shape != shape):
            raise SpecError(f"the starting shape and the load of a rod with {shape[0]} nodes must have shape {shape}.")
        self.free = np.ones(shape, dtype=bool)
        for support in self.supports:
            for name in support.held:
                self.free[support.node, FIELDS[name]] = False
        self.weight = self.rod.weight(np.asarray(self.gravity, dtype=float))
        self._external = self.weight if self.load is None else self.weight + self.load
        self._masses = self.rod.masses
        self._points = [gauss_points(s.points) for s in self.surfaces]
        self._empty = Blocks.zeros(2)

    def fresh_anchors(self) -> list[Array]:
        """Friction anchors before any contact, one array (n, points, 3) per surface."""
        return [np.full((self.rod.lengths.size, s.points, 3), np.nan) for s in self.surfaces]

    def fresh_memory(self) -> SectionMemory | None:
        """Memory of a rod that was never strained; None without a section law."""
        if self.law is None:
            return None
        return SectionMemory.fresh(self.law, self.rod.lengths.size, GAUSS_X.size)

    def prescribe(self, t: float, q: Array, v: Array, a: Array) -> None:
        """Set held fields to their prescribed values at time `t`, in place."""
        held = ~self.free
        q[held], v[held], a[held] = self.q0[held], 0.0, 0.0
        for support in self.supports:
            if support.travel is not None:
                u, du, ddu = support.travel(t)
                q[support.node, 0:3] = self.q0[support.node, 0:3] + u
                v[support.node, 0:3], a[support.node, 0:3] = du, ddu

    def forces(
        self, t: float, q: Array, v: Array, anchors: list[Array], friction: bool = True,
        blocks: Blocks | None = None, factor: float = 0.0,
        memory: SectionMemory | None = None, dt: float | None = LONG,
    ) -> Forces:  # fmt: skip
        """F(q, v, t); with `blocks`, also dF/dq + factor dF/dv into them.

        A section law goes in the time `dt` [s] from `memory` (fresh if not given) to the strains of `q`; with None, the
        forces that it has in `memory` are taken as they are.
        """
        rod = self.rod
        nodes, n = rod.nodes, rod.lengths.size
        out = Forces(
            -self._external, np.empty((n, GAUSS_X.size, 6)), [], np.zeros((nodes, 3)), np.zeros((nodes, 3)), []
        )
        law = (rod.C, rod.C_damping, rod.E0)
        out.elastic, out.damping_power = internal_force(q, v, rod.lengths, GAUSS_X, GAUSS_W, *law, out.F, out.S)
        matrix = self._empty
        if blocks is not None:
            matrix = blocks
            for part in (blocks.D, blocks.U, blocks.L):
                part[:] = 0.0
            internal_tangent(q, v, factor, rod.lengths, GAUSS_X, GAUSS_W, *law, blocks.D, blocks.U, blocks.L)
        if self.law is not None:
            self._add_law(self.law, q, blocks, memory, dt, out)
        report = np.empty(7)
        for surface, (xs, ws), anchor in zip(self.surfaces, self._points, anchors, strict=True):
            p = surface.parameters(t)
            if not friction:
                p[3] = 0.0
            moved, cone = np.empty_like(anchor), np.empty(anchor.shape[:2])
            contact_force(
                p, q, v, rod.lengths, xs, ws, anchor, moved, out.F, out.contact, out.friction, report, cone,
                blocks is not None, factor, matrix.D, matrix.U, matrix.L,
            )  # fmt: skip
            self._add(out, report, surface.name)
            out.moved.append(moved)
            out.cones.append(cone)
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
        section_force_on_nodes(q, lengths, GAUSS_X, GAUSS_W, S, out.F)
        out.S += S
        out.memory = step.memory
        out.law_work = float(np.sum(GAUSS_W * lengths[:, None] * step.work))
        if blocks is not None and step.T is not None:
            section_force_tangent(q, lengths, GAUSS_X, GAUSS_W, S, step.T, blocks.D, blocks.U, blocks.L)

    @staticmethod
    def _add(out: Forces, report: Array, name: str) -> None:
        out.penalty += report[0]
        out.bristle += report[1]
        out.contact_damping_power += report[2]
        out.friction_power += report[3]
        out.surface_power += report[4]
        if report[5] > out.penetration:
            out.penetration = float(report[5])
            out.penetration_at = f"{name}, element {int(report[6])}"

    def inertia(self, a: Array) -> Array:
        """M a, shape (n + 1, 12)."""
        out = np.zeros_like(a)
        inertia_force(a, self._masses, self.rod.mass_per_length, self.rod.J, out)
        return out

    def add_mass(self, factor: float, blocks: Blocks) -> None:
        """Add factor M to the blocks."""
        add_mass(factor, self._masses, self.rod.mass_per_length, self.rod.J, blocks.D, blocks.U, blocks.L)

    def fix(self, blocks: Blocks) -> None:
        """Replace rows and columns of held unknowns by the identity."""
        for i, slot in np.argwhere(~self.free):
            blocks.D[i, slot, :] = 0.0
            blocks.D[i, :, slot] = 0.0
            blocks.D[i, slot, slot] = 1.0
            if i > 0:
                blocks.L[i - 1, slot, :] = 0.0
                blocks.U[i - 1, :, slot] = 0.0
            if i < blocks.U.shape[0]:
                blocks.U[i, slot, :] = 0.0
                blocks.L[i, :, slot] = 0.0

    def potential(self, q: Array) -> float:
        """Energy of the weight [J], zero at the origin."""
        return -float(np.sum(self.weight * q))

    def rotation_fault(self, q: Array) -> str:
        """A sentence naming the node whose rotation is too large, or nothing."""
        size = np.linalg.norm(q[:, 6:9], axis=1)
        worst = int(np.argmax(size))
        if size[worst] < LARGEST_ROTATION:
            return ""
        return (
            f"Node {worst} has turned by {size[worst]:.3f} rad; the limit is {LARGEST_ROTATION:.3f} rad: "
            f"start from a shape whose directions lie around zero, or shorten the run."
        )

r"""Bodies, bushings and joints of a rod model as the kernels read them, and their part of M(q) a + F(q, v, t).

The state of a model is one array with a row for every node of the rod, then one for every body (r in columns 0:3, theta in 6:9), then
one for every joint (its multipliers). Columns that a row does not use are held at zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beam.block_sparse import Pattern, pattern
from beam.body_contact import BodyPoints, body_contacts
from beam.body_forces import JointArrays, Links, bushing_forces, joint_forces
from beam.bushing import GROUND, Bushing, End
from beam.contact_force import PARAMETERS
from beam.joint import KINDS, SCALE, Joint
from beam.relative_motion import inverse_turn
from beam.rigid_body import RigidBody, body_inertia, body_inertia_tangent
from beam.rotation_vector import rotation_matrix
from beam.sliding_friction import FALL
from beam.surface import FreeTurn, Surface
from geometry.errors import SpecError

if TYPE_CHECKING:
    from beam.rod_model import Blocks, Forces

Array = NDArray[np.float64]

DOF = 12
FORCE_COLUMNS = [0, 1, 2, 6, 7, 8]
BODY_FIELDS = {
    "r": slice(0, 3), "x": slice(0, 1), "y": slice(1, 2), "z": slice(2, 3),
    "theta": slice(6, 9), "theta_x": slice(6, 7), "theta_y": slice(7, 8), "theta_z": slice(8, 9),
}  # fmt: skip


class Multibody:
    """Everything besides the rod.

    Parameters
    ----------
    nodes : (n + 1, 12) array
        The rod at the start.
    bodies, bushings, joints : sequences
    surfaces : sequence of Plane or Cylinder
        Touched by the points of the bodies.

    Attributes
    ----------
    start, motion : (rows, 12) array
        State and velocities at the start.
    used : (rows, 12) bool array
        Unknowns that exist.
    """

    def __init__(
        self,
        nodes: Array,
        bodies: Sequence[RigidBody],
        bushings: Sequence[Bushing],
        joints: Sequence[Joint],
        surfaces: Sequence[Surface],
    ) -> None:
        self.nodes, self.bodies, self.bushings, self.joints, self.surfaces = (
            len(nodes), list(bodies), list(bushings), list(joints), list(surfaces)
        )  # fmt: skip
        self.first_joint = self.nodes + len(self.bodies)
        self.rows = self.first_joint + len(self.joints)
        self._names()
        self._state(nodes)
        self.mass = np.array([body.mass for body in self.bodies], dtype=float)
        self.J = np.array([body.J for body in self.bodies], dtype=float).reshape(-1, 3, 3)
        self._points()
        self._connections()
        self._pattern()
        self._travels = {
            id(group): [(m, x.travel) for m, x in enumerate(group) if x.travel is not None]
            for group in (self.bushings, self.joints)
        }
        self.joint_links, self.bushing_links = (self._with_slots(x) for x in (self.joint_links, self.bushing_links))

    def _names(self) -> None:
        self._row = {}
        for k, body in enumerate(self.bodies):
            if body.name in self._row or body.name == GROUND:
                raise SpecError(f"two bodies are called {body.name!r}, or one has the name of the ground: rename one.")
            self._row[body.name] = self.nodes + k

    def _state(self, nodes: Array) -> None:
        self.start, self.motion = np.zeros((self.rows, DOF)), np.zeros((self.rows, DOF))
        self.start[: self.nodes] = nodes
        self.used = np.ones((self.rows, DOF), dtype=bool)
        self.used[self.nodes :] = False
        self.used[self.nodes : self.first_joint, FORCE_COLUMNS] = True
        for k, body in enumerate(self.bodies):
            i = self.nodes + k
            self.start[i, 0:3], self.start[i, 6:9] = body.position, body.rotation
            self.motion[i, 0:3] = body.velocity
            inverse_turn(self.start[i, 6:9], np.asarray(body.spin, dtype=float), 1.0, self.motion[i, 6:9])
        for k, joint in enumerate(self.joints):
            self.used[self.first_joint + k, : joint.constraints] = True

    def _points(self) -> None:
        rows, at, share = [], [], []
        for k, body in enumerate(self.bodies):
            points = body.contact_points
            rows += [self.nodes + k] * len(points)
            at += list(points)
            share += [body.contact_length / max(len(points), 1)] * len(points)
        self.points = BodyPoints(
            np.array(rows, dtype=np.int64), np.array(at, dtype=float).reshape(-1, 3), np.array(share, dtype=float)
        )
        for surface in self.surfaces:
            if isinstance(getattr(surface, "turn", None), FreeTurn):
                raise SpecError(
                    f"surface {surface.name!r} turns freely, which only the cable can drive; make it a RigidBody with bushings."
                )

    def row(self, end: End, where: str = "") -> int:
        """Row of a node or body; -1 for the ground.

        Raises
        ------
        SpecError
            If there is none.
        """
        if isinstance(end, str):
            if end == GROUND:
                return -1
            if end in self._row:
                return self._row[end]
            known = ", ".join(list(self._row)[:12]) or "none"
            raise SpecError(f"{where or 'a connection'} refers to the body {end!r}; the bodies are: {known}.")
        if not -self.nodes <= end < self.nodes:
            raise SpecError(
                f"{where or 'a connection'} refers to node {end}; the rod has the nodes 0 to {self.nodes - 1}."
            )
        return end % self.nodes

    def row_name(self, row: int) -> str:
        """What a row is, for messages."""
        if row < self.nodes:
            return f"node {row}"
        if row < self.first_joint:
            return f"body {self.bodies[row - self.nodes].name}"
        return self.joints[row - self.first_joint].label

    def check(self, free: NDArray[np.bool_], rollers: int) -> None:
        """Refuse joints that take what is held or taken already, and what bodies cannot be combined with yet.

        Raises
        ------
        SpecError
            With the number of superfluous constraints and the joints.
        """
        if rollers:
            raise SpecError(
                "a roller that the cable turns freely cannot be in one model with bodies, bushings or joints; prescribe its turning."
            )
        self._check_joints(free)

    def _check_joints(self, free: NDArray[np.bool_]) -> None:
        if not self.joints:
            return
        store = self.pattern.store()
        u, du = self.travel(0.0, self.joints)
        F, still = np.zeros((self.rows, DOF)), np.zeros((self.rows, DOF))
        joint_forces(self.joint_links, self.kinds, self.start, still, u, du, F, True, store)
        touched = sorted({int(i) for i in self.joint_links.rows.ravel() if i >= 0})
        G = np.zeros((6 * len(self.joints), 6 * len(touched)))
        for k, rows in enumerate(self.joint_links.rows.tolist()):
            for s, i in enumerate(rows):
                if i >= 0:
                    c = 6 * touched.index(i)
                    part = store[self.kinds.slots[k, s, 1]][:6][:, FORCE_COLUMNS]
                    G[6 * k : 6 * k + 6, c : c + 6] = np.where(free[i, FORCE_COLUMNS], part, 0.0)
        for k, joint in enumerate(self.joints):
            self._check_rank(G[6 * k : 6 * k + 6][: joint.constraints], joint.label, joint.constraints)
        wanted = sum(joint.constraints for joint in self.joints)
        self._check_rank(G, f"the {len(self.joints)} joints together", wanted)

    @staticmethod
    def _check_rank(G: Array, label: str, wanted: int) -> None:
        size = np.linalg.norm(G, axis=1)
        kept = G[size > 0] / size[size > 0][:, None]
        rank = int(np.linalg.matrix_rank(kept, tol=1e-6)) if len(kept) else 0
        if rank < wanted:
            raise SpecError(
                f"{label}: {wanted - rank} of {wanted} constraints are superfluous, because their unknowns are held or taken by "
                "another joint already; take a joint that leaves more free, or a bushing."
            )

    def _pose(self, row: int) -> tuple[Array, Array]:
        if row < 0:
            return np.zeros(3), np.eye(3)
        return self.start[row, 0:3], rotation_matrix(self.start[row, 6:9])

    def _connections(self) -> None:
        ends = [self._bushing_ends(bushing) for bushing in self.bushings]
        self.bushing_links = _links(ends)
        self.laws = np.array([bushing.law for bushing in self.bushings], dtype=float).reshape(-1, 6, 6)
        self.holes = np.array([bushing.round_play for bushing in self.bushings], dtype=bool)
        self.joint_links = _links([self._joint_ends(joint) for joint in self.joints])

    def _rows_of(self, connection: Bushing | Joint) -> tuple[int, int]:
        first, second = (self.row(end, connection.label) for end in (connection.first, connection.second))
        if first == second:
            raise SpecError(f"{connection.label} connects {connection.first} with itself.")
        return first, second

    def _other_point(self, row: int, other: int, point: ArrayLike) -> Array:
        """Place of the point of `other` at the start, in the axes of `row`."""
        x, R = self._pose(other)
        y, S = self._pose(row)
        return S.T @ (x + R @ np.asarray(point, dtype=float) - y)

    def _bushing_ends(self, bushing: Bushing) -> tuple[tuple[int, int], list[Array], list[Array]]:
        first, second = self._rows_of(bushing)
        p, s = bushing.first_point, bushing.second_point
        if p is None:
            p = np.zeros(3) if first >= 0 else self._other_point(first, second, np.zeros(3) if s is None else s)
        s = self._other_point(second, first, p) if s is None else s
        frame = rotation_matrix(np.asarray(bushing.axes, dtype=float))
        other = frame
        if bushing.rest == "start":
            other = self._pose(second)[1].T @ self._pose(first)[1] @ frame
        return (first, second), [np.asarray(p, dtype=float), np.asarray(s, dtype=float)], [frame, other]

    def _joint_ends(self, joint: Joint) -> tuple[tuple[int, int], list[Array], list[Array]]:
        first, second = self._rows_of(joint)
        p = self._other_point(first, second, np.zeros(3)) if joint.point is None else np.asarray(joint.point, float)
        other = self._pose(second)[1].T @ self._pose(first)[1] @ joint.frame
        return (first, second), [p, self._other_point(second, first, p)], [joint.frame, other]

    def _pattern(self) -> None:
        pairs = [(int(i), int(j)) for i, j in (*self.bushing_links.rows, *self.joint_links.rows) if min(i, j) >= 0]
        joints = range(self.first_joint, self.rows)
        for k, ends in zip(joints, self.joint_links.rows):
            pairs += [(int(i), k) for i in ends if i >= 0]
        self.pattern: Pattern = pattern(self.rows, self.nodes, pairs, last=joints)
        slot = self.pattern.slot
        slots = np.full((len(self.joints), 2, 2), -1, dtype=np.int64)
        for k, ends in zip(joints, self.joint_links.rows):
            for s, i in enumerate(ends):
                if i >= 0:
                    slots[k - self.first_joint, s] = slot[int(i), k], slot[k, int(i)]
        kinds = [KINDS[joint.kind] for joint in self.joints]
        self.kinds = JointArrays(
            np.array([kind[0] for kind in kinds], dtype=bool), np.array([kind[3] for kind in kinds], dtype=np.int64),
            np.array(joints, dtype=np.int64), slots,
        )  # fmt: skip

    def _with_slots(self, links: Links) -> Links:
        slot = self.pattern.slot
        for m, rows in enumerate(links.rows.tolist()):
            for a, i in enumerate(rows):
                for b, j in enumerate(rows):
                    links.slots[m, a, b] = slot[i, j] if min(i, j) >= 0 else -1
        return links

    def external(self, gravity: Array, rod: Array) -> Array:
        """Constant forces (rows, 12): those `rod` (n + 1, 12) on the nodes, weight and constant forces of the bodies."""
        out = np.zeros((self.rows, DOF))
        out[: self.nodes] = rod
        for k, body in enumerate(self.bodies):
            out[self.nodes + k, 0:3] = body.mass * gravity + np.asarray(body.force, dtype=float)
        return out

    def travel(self, t: float, connections: Sequence[Bushing | Joint]) -> tuple[Array, Array]:
        """Motion and speed (m, 3) of the points on the ground of the connections at time `t`."""
        u, du = np.zeros((len(connections), 3)), np.zeros((len(connections), 3))
        for m, travel in self._travels[id(connections)]:
            u[m], du[m], _ = travel(t)
        return u, du

    def surface_parameters(self, t: float, friction: bool = True) -> Array:
        """What the contact kernel reads of the surfaces that bodies touch, (surfaces, 30)."""
        P = np.empty((len(self.surfaces), PARAMETERS))
        for row, surface in zip(P, self.surfaces, strict=True):
            row[:] = surface.parameters(t)
        if not friction:
            P[:, 3] = P[:, FALL] = 0.0
        return P

    def add_forces(
        self, t: float, q: Array, v: Array, a: Array | None, anchors: Array, moved: Array, begin: int, friction: bool,
        blocks: Blocks | None, factor: float, factor_a: float, out: Forces,
    ) -> None:  # fmt: skip
        """Add everything to `out`, and the tangent to `blocks`; `anchors` of all surfaces, those of bodies from row `begin` on."""
        F, tangent = out.F, blocks is not None and blocks.store is not None
        store = blocks.store if blocks is not None and blocks.store is not None else np.zeros((1, DOF, DOF))
        if a is not None and self.bodies:
            out.kinetic += body_inertia(q, v, a, self.nodes, self.mass, self.J, F)
            if tangent:
                body_inertia_tangent(q, v, a, factor, factor_a, self.nodes, self.mass, self.J, store)
        if self.bushings:
            moving = self.travel(t, self.bushings)
            out.bushing, out.bushing_damping_power, drive = bushing_forces(
                self.bushing_links, self.laws, self.holes, q, v, *moving, F, tangent, factor, store
            )
            out.held_power += drive
        if self.joints:
            moving = self.travel(t, self.joints)
            out.held_power += joint_forces(self.joint_links, self.kinds, q, v, *moving, F, tangent, store)
        out.body_contact = np.zeros((len(self.bodies), 3))
        if self.surfaces and len(self.points.rows):
            reports = np.zeros((len(self.surfaces), 7))
            body_contacts(
                self.surface_parameters(t, friction), self.points, q, v, anchors, moved, begin, F, reports,
                out.body_contact, self.nodes, tangent, factor, store,
            )  # fmt: skip
            self.add_reports(out, reports)

    def add_reports(self, out: Forces, reports: Array) -> None:
        """Energies, powers and deepest penetration of the bodies' contacts, from `reports` (surfaces, 7)."""
        out.add_contacts(reports, self.surfaces, lambda i: f"body {self.bodies[i].name}")

    def add_mass(self, factor: float, blocks: Blocks) -> None:
        """Add factor M of the unturned bodies to the blocks."""
        for k in range(len(self.bodies)):
            i = self.nodes + k
            blocks.D[i, range(3), range(3)] += factor * self.mass[k]
            blocks.D[i, 6:9, 6:9] += factor * self.J[k]

    def inertia(self, a: Array, out: Array) -> None:
        """Add M a of the unturned bodies to `out`."""
        here = slice(self.nodes, self.first_joint)
        out[here, 0:3] += self.mass[:, None] * a[here, 0:3]
        out[here, 6:9] += np.einsum("kij,kj->ki", self.J, a[here, 6:9])

    def accelerate_joints(self, q: Array, v: Array, w: Array, F: Array, divisor: float) -> None:
        """Write s / `divisor` times the accelerations of the constraints into the joints' rows of `F`: the start of a run.

        By second differences of Phi along the motion in the first 0.1 ms, travels included.
        """
        if not self.joints:
            return
        dt, values = 1e-4, []
        for t in (-dt, 0.0, dt):
            part, there = np.zeros_like(F), q + t * v + 0.5 * t * t * w
            u, du = self.travel(max(t, 0.0), self.joints)
            joint_forces(self.joint_links, self.kinds, there, v, u, du, part, False, np.zeros((1, DOF, DOF)))
            values.append(part[self.first_joint :])
        F[self.first_joint :] = (values[0] - 2 * values[1] + values[2]) / dt**2 / divisor

    def multipliers(self, joint: int, q: Array) -> Array:
        """Multipliers (6,) of a joint [N, N m], those of displacements first; without the share s Phi that is zero in a solution."""
        count = self.joints[joint].constraints
        along = count - int(self.kinds.turns[joint])
        out = np.zeros(6)
        out[:along] = SCALE[0] * q[self.first_joint + joint, :along]
        out[along:count] = SCALE[1] * q[self.first_joint + joint, along:count]
        return out

    def take_multipliers(self, delta: Array, q: Array, w: Array) -> None:
        """Subtract `delta` from the multipliers in `q`; they have no acceleration."""
        q[self.first_joint :] -= delta[self.first_joint :]
        w[self.first_joint :] = 0.0

    def settle(self, *states: Array) -> None:
        """Forget the rates of the multipliers, which have none."""
        for state in states:
            state[self.first_joint :] = 0.0

    def digest(self) -> list[Any]:
        """Numbers that tell this system from another one."""
        return [
            self.start, self.motion, self.mass, self.J, *self.points, *self.bushing_links[:3], self.laws, self.holes,
            *self.joint_links[:3], *self.kinds[:2], self.surface_parameters(0.0),
        ]  # fmt: skip


def _links(ends: Sequence[tuple[tuple[int, int], list[Array], list[Array]]]) -> Links:
    m = len(ends)
    return Links(
        np.array([rows for rows, _, _ in ends], dtype=np.int64).reshape(m, 2),
        np.array([points for _, points, _ in ends], dtype=float).reshape(m, 2, 3),
        np.array([frames for _, _, frames in ends], dtype=float).reshape(m, 2, 3, 3),
        np.full((m, 2, 2), -1, dtype=np.int64),
    )

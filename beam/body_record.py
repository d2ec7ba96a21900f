"""What bodies, bushings and joints do at one instant: motion, displacements and forces, reactions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beam.body_forces import Links
from beam.bushing import bushing_law, bushing_motion
from beam.joint import joint_force
from beam.multibody import Multibody
from beam.relative_motion import POSE, RELATIVE, pose, relative
from beam.rod_model import RodModel
from beam.rotation_vector import rotation_matrix
from geometry.errors import InputError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class BodyMotion:
    """Of every body: position (k, 3) [m], rotation (k, 3, 3), velocity (k, 3) [m/s], spin (k, 3) [rad/s], global axes."""

    position: Array
    rotation: Array
    velocity: Array
    spin: Array


@dataclass(frozen=True)
class BushingState:
    """Of every bushing, in its frame: displacement and rate (m, 6), force (m, 6) on the second; `force_global` (m, 3).

    [m, rad], [m/s, rad/s], [N, N m]; the moment is conjugate to the rotation vector.
    """

    displacement: Array
    rate: Array
    force: Array
    force_global: Array


def body_motion(model: RodModel, q: Array, v: Array) -> BodyMotion:
    """Motion of the bodies of `model` in the state `q` with velocities `v`, both (rows, 12)."""
    here = slice(model.rod.nodes, model.moving)
    R, spin, P = rotation_matrix(q[here, 6:9]), [], np.empty(POSE)
    for x, u in zip(q[here], v[here]):
        pose(x[[0, 1, 2, 6, 7, 8]], u[[0, 1, 2, 6, 7, 8]], np.zeros(3), np.eye(3), P)
        spin.append(P[9:12].copy())
    return BodyMotion(q[here, 0:3], R, v[here, 0:3], np.array(spin).reshape(-1, 3))


def bushing_states(model: RodModel, t: float, q: Array, v: Array) -> BushingState:
    """Displacements, rates and forces of the bushings of `model` at time `t` [s], in the order in which they were given."""
    system = _system(model)
    m = len(system.bushings)
    x, rate, f, turned = np.zeros((m, 6)), np.zeros((m, 6)), np.zeros((m, 6)), np.zeros((m, 3))
    u, du = system.travel(t, system.bushings)
    for k in range(m):
        P, D = _look(system.bushing_links, k, q, v, u[k], du[k])
        bushing_motion(D, x[k], rate[k])
        bushing_law(system.laws[k], bool(system.holes[k]), x[k], rate[k], f[k])
        turned[k] = P[0, 24:33].reshape(3, 3) @ f[k, :3]
    return BushingState(x, rate, f, turned)


def joint_reactions(model: RodModel, t: float, q: Array) -> Array:
    """Force [N] and moment [N m] of every joint on its second end, at the joint, global axes (m, 6); time `t` [s]."""
    system = _system(model)
    out = np.zeros((len(system.joints), 6))
    u, du = system.travel(t, system.joints)
    phi, spread = np.empty(6), np.empty((2, 6))
    for k in range(len(system.joints)):
        P, D = _look(system.joint_links, k, q, np.zeros_like(q), u[k], du[k])
        multipliers = system.multipliers(k, q)
        f, m = np.zeros(3), np.zeros(3)
        along, turns = bool(system.kinds.along[k]), int(system.kinds.turns[k])
        joint_force(along, turns, multipliers, P[0], P[1], D, phi, f, m, spread)
        out[k, :3] = -(P[0, 24:33].reshape(3, 3) @ f)
        out[k, 3:] = -(P[1, 24:33].reshape(3, 3) @ m)
    return out


def _system(model: RodModel) -> Multibody:
    if model.system is None:
        raise InputError("the model has no bodies, bushings or joints that could be reported; give it some.")
    return model.system


def _look(links: Links, k: int, q: Array, v: Array, u: Array, du: Array) -> tuple[Array, Array]:
    """Poses of both ends and the relative motion of connection `k`."""
    P, D = np.empty((2, POSE)), np.empty(RELATIVE)
    for s, row in enumerate(links.rows[k].tolist()):
        x = np.concatenate([u, np.zeros(3)]) if row < 0 else q[row, [0, 1, 2, 6, 7, 8]]
        rate = np.concatenate([du, np.zeros(3)]) if row < 0 else v[row, [0, 1, 2, 6, 7, 8]]
        pose(x, rate, links.points[k, s], links.frames[k, s], P[s])
    relative(P[0], P[1], D)
    return P, D

"""Sums over bushings and joints: forces on nodes and bodies, their tangent by forward differences, energies and powers."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beam.bushing import bushing_force
from beam.compiled import inlined, kernel
from beam.joint import SCALE, joint_force
from beam.relative_motion import POSE, RELATIVE, pose, relative, take_end
from beam.rigid_body import STEP

Array = NDArray[np.float64]
Index = NDArray[np.int64]


class Links(NamedTuple):
    """Ends of connections: rows (m, 2), -1 for the ground; points (m, 2, 3) and frames (m, 2, 3, 3) in the axes of the ends.

    `slots` (m, 2, 2): where the blocks of the pairs of ends are in the store of the matrix, -1 for the ground.
    """

    rows: Index
    points: Array
    frames: Array
    slots: Index


class JointArrays(NamedTuple):
    """Kinds of the joints (m,), row of the multipliers (m,), slots (m, 2, 2) of (end, joint) and (joint, end)."""

    along: NDArray[np.bool_]
    turns: Index
    row: Index
    slots: Index


@kernel
def column_of(c: int) -> int:
    """Column in a row of the state of the unknown `c` of an end."""
    return c if c < 3 else c + 3


@kernel
def add_to_rows(rows: Array, out: Array, sign: float, F: Array) -> None:
    """Add sign times the forces `out` (2, 6) on the ends to their `rows` of `F`."""
    for s in range(2):
        if rows[s] >= 0:
            for i in range(6):
                F[rows[s], column_of(i)] += sign * out[s, i]


@kernel
def add_difference(slots: Array, side: int, c: int, out: Array, other: Array, sign: float, V: Array) -> None:
    """Add sign (other - out) / step to column `c` of the blocks of end `side`."""
    for s in range(2):
        if slots[s, side] >= 0:
            for i in range(6):
                V[slots[s, side], column_of(i), column_of(c)] += sign * (other[s, i] - out[s, i]) / STEP


@inlined
def take_ends(
    links: Links, m: int, q: Array, v: Array, u: Array, du: Array, x: Array, rate: Array, P: Array, D: Array
) -> None:
    """Fill ends `x`, `rate` (2, 6), poses `P` (2, POSE) and relative motion `D` of connection `m`."""
    for s in range(2):
        take_end(links.rows[m, s], q, v, u[m], du[m], x[s], rate[s])
        pose(x[s], rate[s], links.points[m, s], links.frames[m, s], P[s])
    relative(P[0], P[1], D)


@kernel
def bushing_forces(
    links: Links, laws: Array, holes: NDArray[np.bool_], q: Array, v: Array, u: Array, du: Array, F: Array,
    want_tangent: bool, factor: float, V: Array,
) -> tuple[float, float, float]:  # fmt: skip
    """Subtract the forces of all bushings from `F` and add their tangent to the store `V`.

    `u`, `du` (m, 3) are motion and speed of ends on the ground. Returns energy [J], lost power [W], power of the moved ground [W].
    """
    x, rate, P, D = np.empty((2, 6)), np.empty((2, 6)), np.empty((2, POSE)), np.empty(RELATIVE)
    out, other = np.empty((2, 6)), np.empty((2, 6))
    s, ds, f, mo = np.empty(6), np.empty(6), np.empty(6), np.empty(3)
    energy, power, drive = 0.0, 0.0, 0.0
    for m in range(links.rows.shape[0]):
        take_ends(links, m, q, v, u, du, x, rate, P, D)
        stored, lost = bushing_force(laws[m], holes[m], P[0], P[1], D, s, ds, f, mo, out)
        energy += stored
        power += lost
        add_to_rows(links.rows[m], out, -1.0, F)
        if links.rows[m, 0] < 0:
            drive -= out[0, 0] * du[m, 0] + out[0, 1] * du[m, 1] + out[0, 2] * du[m, 2]
        if not want_tangent:
            continue
        for side in range(2):
            if links.rows[m, side] < 0:
                continue
            for c in range(6):
                x[side, c] += STEP
                rate[side, c] += factor * STEP
                pose(x[side], rate[side], links.points[m, side], links.frames[m, side], P[side])
                relative(P[0], P[1], D)
                bushing_force(laws[m], holes[m], P[0], P[1], D, s, ds, f, mo, other)
                add_difference(links.slots[m], side, c, out, other, -1.0, V)
                x[side, c] -= STEP
                rate[side, c] -= factor * STEP
            pose(x[side], rate[side], links.points[m, side], links.frames[m, side], P[side])
    return energy, power, drive


@inlined
def multipliers_of(q: Array, row: int, displacements: int, count: int, out: Array) -> None:
    """Write the multipliers in N and N m of a joint, whose unknowns are them divided by s."""
    for i in range(count):
        out[i] = q[row, i] * (SCALE[0] if i < displacements else SCALE[1])


@kernel
def joint_forces(
    links: Links, kind: JointArrays, q: Array, v: Array, u: Array, du: Array, F: Array, want_tangent: bool, V: Array
) -> float:
    """Add G^T lambda to the rows of the ends and s Phi to those of the joints; the tangent to `V`. Power of the moved ground."""
    x, rate, P, D = np.empty((2, 6)), np.empty((2, 6)), np.empty((2, POSE)), np.empty(RELATIVE)
    out, other, phi, more = np.empty((2, 6)), np.empty((2, 6)), np.empty(6), np.empty(6)
    f, mo, size, drive = np.empty(3), np.empty(3), np.empty(6), 0.0
    for m in range(links.rows.shape[0]):
        displacements = 3 if kind.along[m] else 2
        count, row = displacements + kind.turns[m], kind.row[m]
        take_ends(links, m, q, v, u, du, x, rate, P, D)
        multipliers_of(q, row, displacements, count, size)
        joint_force(kind.along[m], kind.turns[m], size, P[0], P[1], D, phi, f, mo, out)
        add_to_rows(links.rows[m], out, 1.0, F)
        for i in range(count):
            F[row, i] += phi[i]
        if links.rows[m, 0] < 0:
            drive += out[0, 0] * du[m, 0] + out[0, 1] * du[m, 1] + out[0, 2] * du[m, 2]
        if not want_tangent:
            continue
        for side in range(2):
            if links.rows[m, side] < 0:
                continue
            for c in range(6):
                x[side, c] += STEP
                pose(x[side], rate[side], links.points[m, side], links.frames[m, side], P[side])
                relative(P[0], P[1], D)
                joint_force(kind.along[m], kind.turns[m], size, P[0], P[1], D, more, f, mo, other)
                add_difference(links.slots[m], side, c, out, other, 1.0, V)
                for i in range(count):
                    slope = (more[i] - phi[i]) / STEP
                    V[kind.slots[m, side, 0], column_of(c), i] += slope
                    V[kind.slots[m, side, 1], i, column_of(c)] += slope
                x[side, c] -= STEP
            pose(x[side], rate[side], links.points[m, side], links.frames[m, side], P[side])
    return drive

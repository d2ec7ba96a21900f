r"""Motions of whole parts that store no energy: which part can move freely, how, and what to pin.

Without strain and the same at every z a body can move by u = c e_z + omega e_z x r (and, without lay, by translations across z too).
A separated interface allows what leaves its normal jump zero, and, where it resists slip, the whole jump. With the outermost body at
rest, the null space of these conditions holds the free motions. For a round part in a closed hole off the axis that is one, the screw
omega = tau_0 c: the part slides along its helix. A part that is round about the axis has two: it slides along the axis and turns about it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.sparse as sp
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import MeshError
from homogenize.doubled_nodes import DoubledNodes
from homogenize.section_field import FloatArray, SectionField

_NULL = 1e-6
"""Jump, relative to the motion, below which a motion counts as free."""


@dataclass(frozen=True)
class FreeMotions:
    """Free motions of parts in a section.

    Attributes
    ----------
    sentences : one for each motion, such as "power core 1 slides along its helix"
    displacement : (3 n, motions) nodal displacement of the doubled field
    at_rest : (n,) nodes of the body that is held
    """

    sentences: tuple[str, ...]
    displacement: FloatArray
    at_rest: NDArray[np.bool_]


def body_of_nodes(cells: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """Number of the connected body that each node belongs to."""
    first = np.repeat(cells[0], len(cells) - 1)
    graph = sp.coo_array((np.ones(len(first)), (first, cells[1:].T.ravel())), shape=(count, count))
    return sp.csgraph.connected_components(graph, directed=False)[1]


def check_connected(field: SectionField, mesh: CrossSectionMesh) -> None:
    """Refuse a section with a part that touches nothing.

    Raises
    ------
    MeshError
        Naming the part that can move freely.
    """
    body = body_of_nodes(field.cells, field.nodes.shape[1])
    if body.max() == 0:
        return
    loose = {b: _name(field, mesh, field.cells, body, b) for b in range(1 + body.max())}
    outermost = body[np.argmax(np.hypot(*field.nodes))]
    names = [name for b, name in loose.items() if b != outermost]
    raise MeshError(
        f"{', '.join(names)} touches no other part and has no stiffness against the rest of the section: it can move freely in every "
        "direction; let the parts share their nodes, or fill the gap between them."
    )


def free_motions(
    field: SectionField, mesh: CrossSectionMesh, doubled: DoubledNodes, holds: NDArray[np.bool_]
) -> FreeMotions:
    """Free motions of all bodies but the outermost; `holds` (L,): whether a link resists slip."""
    count = doubled.nodes.shape[1]
    body = body_of_nodes(doubled.cells, count)
    held = int(body[np.argmax(np.hypot(*doubled.nodes))])
    rates = _rates(doubled.nodes, field.twist_rate)
    names = [_name(field, mesh, doubled.cells, body, b) for b in range(1 + body.max())]
    sentences: list[str] = []
    columns: list[FloatArray] = []
    if body.max() == 0:
        return FreeMotions((), np.zeros((3 * count, 0)), body == held)
    rows = _conditions(doubled, holds, rates, body)
    whole = _null_space(np.delete(rows, held, axis=2))
    others = [b for b in range(1 + body.max()) if b != held]
    found = np.zeros((len(others), rows.shape[1], 0))
    for i, b in enumerate(others):
        for motion in _simple_basis(_null_space(rows[:, :, [b]])[0]):
            local = np.zeros((len(others), rows.shape[1], 1))
            local[i, :, 0] = motion
            found = np.concatenate([found, local], axis=2)
            sentences.append(f"{names[b]} {_how(motion, field.twist_rate, _centre(doubled.nodes, body, b))}")
    joint = _remaining(whole, found)
    for k in range(joint.shape[2]):
        moving = [
            names[b] for i, b in enumerate(others) if np.abs(joint[i, :, k]).max() > 1e-3 * np.abs(joint[:, :, k]).max()
        ]
        sentences.append(f"{' and '.join(moving)} move together")
    found = np.concatenate([found, joint], axis=2)
    for k in range(found.shape[2]):
        u = np.zeros((count, 3))
        for i, b in enumerate(others):
            inside = body == b
            u[inside] = np.einsum("nxj,j->nx", rates[inside], found[i, :, k])
        columns.append(u.ravel())
    displacement = np.array(columns).T if columns else np.zeros((3 * count, 0))
    return FreeMotions(tuple(sentences), displacement, body == held)


def pins(motions_in_unknowns: FloatArray) -> tuple[int, ...]:
    """One unknown for each motion (unknowns, motions), chosen so that holding them stops every motion."""
    if motions_in_unknowns.shape[1] == 0:
        return ()
    factors: tuple = tuple(scipy.linalg.qr(motions_in_unknowns.T, mode="r", pivoting=True))
    order = factors[-1]
    return tuple(int(i) for i in order[: motions_in_unknowns.shape[1]])


def _rates(nodes: FloatArray, twist_rate: float) -> FloatArray:
    """Displacement (n, 3, j) of the motions without strain: e_z, turn about the axis; without lay e_x, e_y too.

    The turn is measured by the displacement at the outermost node.
    """
    X, Y = nodes / np.hypot(*nodes).max()
    zero, one = np.zeros_like(X), np.ones_like(X)
    motions = [np.stack([zero, zero, one]), np.stack([-Y, X, zero])]
    if twist_rate == 0.0:
        motions += [np.stack([one, zero, zero]), np.stack([zero, one, zero])]
    return np.moveaxis(np.array(motions), (0, 1, 2), (2, 1, 0))


def _conditions(
    doubled: DoubledNodes, holds: NDArray[np.bool_], rates: FloatArray, body: NDArray[np.int64]
) -> FloatArray:
    """Jump that every link forbids, (conditions, j, bodies), per unit of each motion of each body."""
    links, j, bodies = len(doubled.child), rates.shape[2], 1 + body.max()
    rows: FloatArray = np.zeros((3, links, j, bodies))
    at = range(links)
    for node, sign in ((doubled.child, 1.0), (doubled.parent, -1.0)):
        jump: FloatArray = np.einsum("kxl,lxj->klj", doubled.frame, rates[node])
        for l in at:
            rows[:, l, :, body[node[l]]] += sign * jump[:, l]
    forbidden = np.stack([np.ones(links, dtype=bool), holds, holds])
    return rows[forbidden]


def _null_space(rows: FloatArray) -> FloatArray:
    """Null space of conditions (conditions, j, bodies) as (bodies, j, motions)."""
    flat = np.moveaxis(rows, 2, 1).reshape(len(rows), rows.shape[1] * rows.shape[2])
    flat = flat[np.abs(flat).max(axis=1) > 0] if flat.size else flat
    _, s, vh = np.linalg.svd(flat, full_matrices=True)
    values = np.zeros(vh.shape[0])
    values[: len(s)] = s
    null = vh[values < _NULL * max(values.max(initial=0.0), 1.0)]
    return np.moveaxis(null.reshape(len(null), rows.shape[2], rows.shape[1]), 0, 2)


def _simple_basis(null: FloatArray) -> list[FloatArray]:
    """The motions (j, k) of one body as slides and turns of its own where the space contains them."""
    if null.shape[1] == 0:
        return []
    left, basis = null, []
    for c in [*np.eye(null.shape[0]), *null.T]:
        fresh = left @ (left.T @ c)
        own = bool(np.linalg.norm(null @ (null.T @ c) - c) < 1e-6)
        if len(basis) < null.shape[1] and own and np.linalg.norm(fresh) > 1e-6:
            basis.append(c if np.count_nonzero(c) == 1 else fresh)
            taken = np.linalg.qr(np.array(basis).T)[0]
            left = np.linalg.svd(null - taken @ (taken.T @ null))[0][:, : null.shape[1] - len(basis)]
    return basis


def _how(motion: FloatArray, twist_rate: float, centre: FloatArray) -> str:
    along, turn = np.abs(motion[:2]) > 1e-6 * np.abs(motion).max()
    on_axis = np.hypot(*centre) < 1e-3
    if along and not turn:
        return "slides along the cable"
    if along and twist_rate != 0.0:
        return "screws along the cable with the lay" if on_axis else "slides along its helix"
    if turn and not along:
        return "turns about the cable axis" if on_axis else "turns about its axis"
    return "moves across the cable" if not along else "slides and turns"


def _centre(nodes: FloatArray, body: NDArray[np.int64], b: int) -> FloatArray:
    """Centre of a body's bounding box over the section's radius."""
    own = nodes[:, body == b]
    return (own.max(axis=1) + own.min(axis=1)) / 2 / np.hypot(*nodes).max()


def _remaining(whole: FloatArray, found: FloatArray) -> FloatArray:
    """What is left of a space (bodies, j, k) when the motions found in it are taken out."""
    shape = whole.shape
    if whole.size == 0:
        return np.zeros((*shape[:2], 0))
    flat, taken = whole.reshape(-1, shape[2]), found.reshape(-1, found.shape[2])
    if taken.shape[1]:
        Q = np.linalg.qr(taken)[0]
        flat = flat - Q @ (Q.T @ flat)
    u, s, _ = np.linalg.svd(flat, full_matrices=False)
    u = u[:, s > 1e-6]
    return u.reshape(*shape[:2], u.shape[1])


def _name(
    field: SectionField, mesh: CrossSectionMesh, cells: NDArray[np.int64], body: NDArray[np.int64], b: int
) -> str:
    """Regions of a body in words; those of one member by the member's name."""
    regions = [mesh.regions[r] for r in np.unique(field.region_of[body[cells[0]] == b])]
    if len(regions) == 1:
        return regions[0].name
    names = list(dict.fromkeys(r.name.removesuffix(f" {r.kind}") for r in regions))
    return names[0] if len(names) == 1 else " with ".join([names[0], ", ".join(names[1:])])

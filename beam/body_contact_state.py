r"""What every contact point of the bodies does at one instant: gap, normal force, friction, stick or slip.

The same numbers as :mod:`beam.contact_state` gives of the cable. With the force f of a surface on a point and its normal n,

.. math:: N = f \cdot n, \qquad T = |f - N n|, \qquad \text{use} = T / (\mu(v) N) \le 1 ,

T without the drag, if there is one.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.body_contact import BodyPoints, body_point, sliding_velocity
from beam.compiled import kernel
from beam.contact_force import gap_and_normal
from beam.contact_state import ContactState
from beam.relative_motion import POSE, pose
from beam.rod_model import RodModel
from beam.sliding_friction import friction_coefficient

Array = NDArray[np.float64]


@kernel
def body_contact_table(p: Array, points: BodyPoints, q: Array, v: Array, anchors: Array, table: Array) -> None:
    """Write penetration (NaN outside the surface's box), normal (3 numbers), force (3), drag in it (3) and mu of every point on `p`."""
    P, frame, moved, scrap = np.empty(POSE), np.eye(3), np.empty(3), np.zeros(16)
    x, u, force = np.empty(6), np.empty(6), np.empty(3)
    for j in range(points.rows.size):
        row = points.rows[j]
        for i in range(3):
            x[i], x[3 + i], u[i], u[3 + i] = q[row, i], q[row, 6 + i], v[row, i], v[row, 6 + i]
        pose(x, u, points.at[j], frame, P)
        depth, _, n0, n1, n2 = gap_and_normal(p, P[3], P[4], P[5])
        table[j, 0] = depth if n0 != 0.0 or n1 != 0.0 or n2 != 0.0 else np.nan
        table[j, 1], table[j, 2], table[j, 3] = n0, n1, n2
        force[:] = 0.0
        body_point(p, points.share[j], P, anchors[j], moved, scrap, force)
        for i in range(3):
            table[j, 4 + i] = force[i]
        s0, s1, s2 = sliding_velocity(p, P, n0, n1, n2)
        drag = -points.share[j] * p[29] if depth > 0.0 else 0.0
        table[j, 7], table[j, 8], table[j, 9] = drag * s0, drag * s1, drag * s2
        table[j, 10] = friction_coefficient(p, np.sqrt(s0 * s0 + s1 * s1 + s2 * s2))


def body_contact_states(model: RodModel, t: float, q: Array, v: Array, anchors: list[Array]) -> list[ContactState]:
    """State of the bodies' contacts with every surface that they touch, points as (1, points); none without such surfaces.

    Parameters
    ----------
    model : RodModel
    t : float
        s.
    q, v : (rows, 12) array
    anchors : list of array
        Friction anchors of all surfaces before the step that led to this state; those of bodies stand last.
    """
    system = model.system
    if system is None or not len(system.points.rows):
        return []
    out = []
    own = anchors[len(model.surfaces) :]
    for p, anchor in zip(system.surface_parameters(t), own, strict=True):
        table = np.empty((len(system.points.rows), 11))
        body_contact_table(p, system.points, q, v, np.ascontiguousarray(anchor).reshape(-1, 3), table)
        depth, n, force = table[:, 0], table[:, 1:4], table[:, 4:7]
        normal = np.einsum("ij,ij->i", n, force)
        friction = np.linalg.norm(force - table[:, 7:10] - normal[:, None] * n, axis=1)
        limit = table[:, 10] * normal
        use = np.divide(friction, limit, out=(normal > 0).astype(float), where=limit > 0)
        out.append(ContactState(-depth[None], normal[None], friction[None], force[None], use[None]))
    return out

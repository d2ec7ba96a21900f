r"""Section forces at the nodes, in the section's own axes and in global axes.

They are known at the Gauss points, where the strains of a bent Hermite element are accurate (in between they oscillate).
Global components are n = R N and m = R M: what the part on the side of growing arc length exerts on the part before it.
A node takes the mean of n and m at the nearest Gauss point on either side, and turns it into its own axes by R^T.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.element import DOF, shape_on_one_branch
from beam.hermite import gauss_points, hermite
from beam.rotation_vector import rotation_matrix

Array = NDArray[np.float64]

GAUSS_X, _ = gauss_points(3)


def nodal_section_forces(q: Array, lengths: Array, S: Array) -> tuple[Array, Array]:
    """(local, global) section forces and moments at the nodes.

    Parameters
    ----------
    q : (n + 1, 12) array
    lengths : (n,) array
    S : (n, 3, 6) array
        (N_1, N_2, N_3, M_1, M_2, M_3) at the Gauss points.

    Returns
    -------
    local, turned : (n + 1, 6) array
        N and N m.
    """
    turned = np.empty_like(S)
    for g, x in enumerate(GAUSS_X):
        R = rotation_matrix(_interpolate_rotation(q, lengths, float(x)))
        turned[:, g, :3] = np.einsum("eij,ej->ei", R, S[:, g, :3])
        turned[:, g, 3:] = np.einsum("eij,ej->ei", R, S[:, g, 3:])
    nodal = to_nodes(turned)
    R = rotation_matrix(q[:, 6:9])
    local = np.concatenate([np.einsum("nij,ni->nj", R, nodal[:, k : k + 3]) for k in (0, 3)], axis=1)
    return local, nodal


def _interpolate_rotation(q: Array, lengths: Array, x: float) -> Array:
    N, dN = np.zeros(4), np.zeros(4)
    hermite(x, 1.0, N, dN)
    slope = lengths[:, None]
    theta, turned = q[1:, 6:9].copy(), q[1:, 9:12].copy()
    for e in np.nonzero(np.linalg.norm(q[:-1, 6:9] - theta, axis=1) > np.pi)[0]:
        ends = np.empty((2, DOF))
        shape_on_one_branch(np.ascontiguousarray(q), int(e), ends)
        theta[e], turned[e] = ends[1, 6:9], ends[1, 9:12]
    first = N[0] * q[:-1, 6:9] + N[1] * slope * q[:-1, 9:12]
    return first + N[2] * theta + N[3] * slope * turned


def to_nodes(values: Array) -> Array:
    """Nodal values (n + 1, k) of values at the Gauss points (n, 3, k): the mean of the nearest on either side."""
    nodes = np.empty((values.shape[0] + 1, values.shape[2]))
    nodes[0], nodes[-1] = values[0, 0], values[-1, -1]
    nodes[1:-1] = 0.5 * (values[:-1, -1] + values[1:, 0])
    return nodes

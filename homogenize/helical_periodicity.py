r"""Exact reduction of a slice to its helical period: u(Q x + h e_z) = Q u(x).

With top node t the image of bottom node b, :math:`u_t = Q u_b`; all unknowns follow from those of the other nodes, u = R v, and the
reduced matrix is the congruence :math:`R^T K R`. (Dropping the rows of the dependent nodes instead loses the forces that cross the
seam; a one-dimensional periodic problem shows it at once, see tests/homogenize/test_helical_periodicity.py.)
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray


def reduction(
    nodes: int, bottom: NDArray[np.int64], top: NDArray[np.int64], Q: NDArray[np.float64]
) -> tuple[sp.csr_array, NDArray[np.int64]]:
    """R, shape (d nodes, d free), and the numbers of the free nodes; d = len(Q) components a node.

    Parameters
    ----------
    nodes : number of nodes
    bottom, top : (b,) partners, u[top] = Q u[bottom]
    Q : (d, d) rotation of the period

    Examples
    --------
    >>> R, free = reduction(3, np.array([0]), np.array([2]), np.eye(1))
    >>> R.toarray().tolist(), free.tolist()
    ([[1.0, 0.0], [0.0, 1.0], [1.0, 0.0]], [0, 1])
    """
    d = len(Q)
    master = np.arange(nodes)
    master[top] = bottom
    free = np.setdiff1d(np.arange(nodes), top)
    number = np.full(nodes, -1)
    number[free] = np.arange(len(free))
    blocks = np.broadcast_to(np.eye(d), (nodes, d, d)).copy()
    blocks[top] = Q
    R = sp.bsr_array((blocks, number[master], np.arange(nodes + 1)), shape=(d * nodes, d * len(free)))
    return R.tocsr(), free

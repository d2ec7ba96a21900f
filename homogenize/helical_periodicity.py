r"""Exact reduction of a cell to its period: u(Q x + h e_z) = s Q u(x), with a factor s of modulus one.

With top node t the image of bottom node b, :math:`u_t = s Q u_b`; all unknowns follow from those of the other nodes, u = R v, and the
reduced matrix is the congruence :math:`R^H K R`. (Dropping the rows of the dependent nodes instead loses the forces that cross the
seam; a one-dimensional periodic problem shows it at once, see tests/homogenize/test_helical_periodicity.py.)
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray


def reduction(
    nodes: int, bottom: NDArray[np.int64], top: NDArray[np.int64], Q: NDArray
) -> tuple[sp.csr_array, NDArray[np.int64]]:
    """R, shape (d nodes, d free), and the numbers of the free nodes; d = len(Q) components a node.

    Parameters
    ----------
    nodes : number of nodes
    bottom, top : (b,) partners, u[top] = Q u[bottom]
    Q : (d, d) rotation of the period, with its factor

    Examples
    --------
    >>> R, free = reduction(3, np.array([0]), np.array([2]), np.eye(1))
    >>> R.toarray().tolist(), free.tolist()
    ([[1.0, 0.0], [0.0, 1.0], [1.0, 0.0]], [0, 1])
    """
    d = len(Q)
    column, free = _columns(nodes, bottom, top)
    blocks = np.broadcast_to(np.eye(d, dtype=Q.dtype), (nodes, d, d)).copy()
    blocks[top] = Q
    R = sp.bsr_array((blocks, column, np.arange(nodes + 1)), shape=(d * nodes, d * len(free)))
    return R.tocsr(), free


def reduced_matrix(K: sp.bsr_array, bottom: NDArray[np.int64], top: NDArray[np.int64], Q: NDArray) -> sp.bsr_array:
    """R^H K R block by block, for a matrix in blocks of len(Q); equal to the product, in a fraction of its memory."""
    d = len(Q)
    nodes = len(K.indptr) - 1
    column, free = _columns(nodes, bottom, top)
    rows, columns = np.repeat(np.arange(nodes), np.diff(K.indptr)), K.indices
    data = K.data.astype(np.result_type(K.dtype, Q.dtype))
    tied = np.zeros(nodes, dtype=bool)
    tied[top] = True
    data[tied[rows]] = Q.conj().T @ data[tied[rows]]
    data[tied[columns]] = data[tied[columns]] @ Q
    key = column[rows] * len(free) + column[columns]
    order = np.argsort(key, kind="stable")
    first = np.flatnonzero(np.diff(key[order], prepend=-1))
    key = key[order[first]]
    data = data[order]
    if len(first) < len(data):
        data = np.add.reduceat(data, first, axis=0)
    indptr = np.concatenate([[0], np.cumsum(np.bincount(key // len(free), minlength=len(free)))])
    return sp.bsr_array((data, key % len(free), indptr), shape=(d * len(free), d * len(free)))


def _columns(
    nodes: int, bottom: NDArray[np.int64], top: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The column of every node in the reduced problem, and the nodes that stand for the columns."""
    master = np.arange(nodes)
    master[top] = bottom
    free = np.setdiff1d(np.arange(nodes), top)
    number = np.full(nodes, -1)
    number[free] = np.arange(len(free))
    return number[master], free

r"""Direct solution of sparse systems of 12 x 12 blocks in any graph: a rod with bodies and joints beside it.

Vertices are eliminated one after the other; with the later neighbours i, j of a vertex k,

.. math:: X_{kj} = D_k^{-1} A_{kj}, \qquad A_{ij} \leftarrow A_{ij} - A_{ik} X_{kj} .

The order is that of least degree, worked out once with the list of all block operations. Multipliers of joints come after the
vertices that they join, whose blocks are regular by themselves. Row pivoting happens inside a block. A chain of bodies along a
rod costs work and storage in proportion to its length; a free body that many nodes see costs its degree.

Source: A. George, J. W. H. Liu, SIAM Rev. 31 (1989) 1-19, doi 10.1137/1031001 (minimum degree).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from beam.block_tridiagonal import factor_block, solve_block
from beam.compiled import kernel

Array = NDArray[np.float64]
Index = NDArray[np.int64]

B = 12
"""Rows of a block."""


@dataclass(frozen=True)
class Pattern:
    """Where the blocks of a matrix are, and the operations that factorise it.

    The store (slots, 12, 12) holds the diagonal blocks, those above and below it along the chain of the first `chain` vertices,
    the other couplings, and what elimination fills in. `slot` maps (row, column) to its place.
    """

    rows: int
    chain: int
    slot: dict[tuple[int, int], int]
    given: int
    order: Index
    first: Index
    near: Index
    up: Index
    low: Index
    update: Index
    update_first: Index
    in_row: Index
    in_row_first: Index
    in_column: Index
    in_column_first: Index
    slots: int = field(default=0)

    def store(self) -> Array:
        """An empty matrix."""
        return np.zeros((self.slots, B, B))


def pattern(rows: int, chain: int, couplings: Iterable[tuple[int, int]], last: Sequence[int] = ()) -> Pattern:
    """Pattern of `rows` vertices: a chain of the first ones, other `couplings` (i, j), `last` after their neighbours."""
    slot = {(i, i): i for i in range(rows)}
    for i in range(chain - 1):
        slot[i, i + 1] = rows + i
        slot[i + 1, i] = rows + chain - 1 + i
    for i, j in couplings:
        for pair in ((i, j), (j, i)):
            slot.setdefault(pair, len(slot))
    given = dict(slot)
    order, nears = _eliminate(rows, slot, set(last))
    up = [slot[k, i] for k, near in zip(order, nears) for i in near]
    low = [slot[i, k] for k, near in zip(order, nears) for i in near]
    update = [slot[i, j] for near in nears for i in near for j in near]
    sizes = np.array([len(near) for near in nears], dtype=np.int64)
    in_row: list[list[int]] = [[] for _ in range(rows)]
    in_column: list[list[int]] = [[] for _ in range(rows)]
    for (i, j), s in given.items():
        in_row[i].append(s)
        in_column[j].append(s)
    return Pattern(
        rows, chain, given, len(given), np.array(order, dtype=np.int64), _starts(sizes),
        _flat(nears), np.array(up, dtype=np.int64), np.array(low, dtype=np.int64),
        np.array(update, dtype=np.int64), _starts(sizes**2),
        _flat(in_row), _starts([len(x) for x in in_row]), _flat(in_column), _starts([len(x) for x in in_column]),
        slots=len(slot),
    )  # fmt: skip


def _flat(lists: Sequence[Sequence[int]]) -> Index:
    return np.array([x for part in lists for x in part], dtype=np.int64)


def _starts(sizes: Sequence[int] | Index) -> Index:
    return np.concatenate([[0], np.cumsum(np.asarray(sizes, dtype=np.int64))]).astype(np.int64)


def _eliminate(rows: int, slot: dict[tuple[int, int], int], last: set[int]) -> tuple[list[int], list[list[int]]]:
    """Order of least degree and the later neighbours of every vertex; adds what fills in to `slot`."""
    near: list[set[int]] = [set() for _ in range(rows)]
    for i, j in slot:
        if i != j:
            near[i].add(j)
    waits = {k: set(near[k]) - last for k in last}
    left, order, nears = set(range(rows)), [], []
    while left:
        ready = [k for k in left if not waits.get(k)]
        k = min(ready, key=lambda i: (len(near[i]), i))
        later = sorted(near[k])
        for i in later:
            near[i].discard(k)
            for j in later:
                if i != j and j not in near[i]:
                    near[i].add(j)
                    slot.setdefault((i, j), len(slot))
        for other in waits.values():
            other.discard(k)
        left.remove(k)
        order.append(k)
        nears.append(later)
    return order, nears


@kernel
def multiply(left: Array, right: Array, out: Array, sign: float) -> None:
    """Add sign left right to `out`; all (12, 12)."""
    for r in range(12):
        for k in range(12):
            factor = sign * left[r, k]
            if factor != 0.0:
                for c in range(12):
                    out[r, c] += factor * right[k, c]


@kernel
def transpose(A: Array) -> None:
    """Transpose a block in place."""
    for r in range(12):
        for c in range(r):
            A[r, c], A[c, r] = A[c, r], A[r, c]


@kernel
def factorise(V: Array, order: Index, first: Index, up: Index, low: Index, update: Index, update_first: Index) -> int:  # noqa: C901
    """Factorise the store `V` in place for :func:`sweep`, blocks transposed. Returns -1, or the singular vertex."""
    pivot, inverse, room = np.empty(12, dtype=np.int64), np.empty((12, 12)), np.empty((12, 12))
    for n in range(order.size):
        k = order[n]
        for r in range(12):
            for c in range(12):
                inverse[r, c] = 1.0 if r == c else 0.0
        if not factor_block(V[k], pivot):
            return k
        solve_block(V[k], pivot, inverse)
        for r in range(12):
            for c in range(12):
                V[k, r, c] = inverse[r, c]
        for s in range(first[n], first[n + 1]):
            room[:] = 0.0
            multiply(inverse, V[up[s]], room, 1.0)
            V[up[s]] = room
        target = update_first[n]
        for s in range(first[n], first[n + 1]):
            for z in range(first[n], first[n + 1]):
                multiply(V[low[s]], V[up[z]], V[update[target]], -1.0)
                target += 1
        transpose(V[k])
        for s in range(first[n], first[n + 1]):
            transpose(V[up[s]])
            transpose(V[low[s]])
    return -1


@kernel
def sweep(V: Array, order: Index, first: Index, near: Index, up: Index, low: Index, R: Array) -> None:  # noqa: C901
    """Replace `R` (rows, 12) by the solution; `V` from :func:`factorise`."""
    y, w = np.empty(12), np.empty(12)
    for n in range(order.size):
        k = order[n]
        for r in range(12):
            y[r] = 0.0
        for c in range(12):
            x = R[k, c]
            for r in range(12):
                y[r] += V[k, c, r] * x
        for r in range(12):
            R[k, r] = y[r]
        for s in range(first[n], first[n + 1]):
            i, z = near[s], low[s]
            for r in range(12):
                w[r] = R[i, r]
            for c in range(12):
                x = y[c]
                for r in range(12):
                    w[r] -= V[z, c, r] * x
            for r in range(12):
                R[i, r] = w[r]
    for n in range(order.size - 1, -1, -1):
        k = order[n]
        for r in range(12):
            y[r] = R[k, r]
        for s in range(first[n], first[n + 1]):
            i, z = near[s], up[s]
            for c in range(12):
                x = R[i, c]
                for r in range(12):
                    y[r] -= V[z, c, r] * x
        for r in range(12):
            R[k, r] = y[r]


@kernel
def fix_store(
    held: Index, V: Array, in_row: Index, in_row_first: Index, in_column: Index, in_column_first: Index
) -> None:
    """Replace rows and columns of the unknowns `held` (k, 2) by the identity."""
    for h in range(held.shape[0]):
        i, k = held[h, 0], held[h, 1]
        for s in range(in_row_first[i], in_row_first[i + 1]):
            for c in range(12):
                V[in_row[s], k, c] = 0.0
        for s in range(in_column_first[i], in_column_first[i + 1]):
            for r in range(12):
                V[in_column[s], r, k] = 0.0
        V[i, k, k] = 1.0


class SparseFactor:
    """Factorised store; the same interface as :class:`beam.linear_solve.Factor`."""

    def __init__(self, at: Pattern, store: Array) -> None:
        self._at, self._store = at, store
        self.singular_node = int(factorise(store, at.order, at.first, at.up, at.low, at.update, at.update_first))

    def solve(self, right: Array) -> Array:
        """Solution for `right` (rows, 12)."""
        R = np.array(right, dtype=float, order="C")
        at = self._at
        sweep(self._store, at.order, at.first, at.near, at.up, at.low, R)
        return R

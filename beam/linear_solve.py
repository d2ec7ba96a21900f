"""The factorised iteration matrix of a rod, kept over several steps of a modified Newton iteration."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.block_sparse import SparseFactor
from beam.block_tridiagonal import invert_chain, sweep_chain
from beam.rod_forces import Blocks

Array = NDArray[np.float64]


class Factor:
    """LU of a block-tridiagonal matrix, or of one with the couplings of bodies; the blocks are overwritten.

    Attributes
    ----------
    singular_node : int
        First node whose block cannot be eliminated, -1 if none.
    """

    def __init__(self, blocks: Blocks) -> None:
        self._blocks = blocks
        self._sparse = (
            SparseFactor(blocks.pattern, blocks.store) if blocks.pattern and blocks.store is not None else None
        )
        if self._sparse is not None:
            self.singular_node = self._sparse.singular_node
            return
        self._pivots = np.empty((blocks.D.shape[0], blocks.D.shape[1]), dtype=np.int64)
        self.singular_node = int(invert_chain(blocks.D, blocks.U, blocks.L, self._pivots))

    def solve(self, right: Array) -> Array:
        """Solution for `right` (n, dof)."""
        if self._sparse is not None:
            return self._sparse.solve(right)
        B = np.array(right, dtype=float, order="C")
        sweep_chain(self._blocks.D, self._blocks.U, self._blocks.L, B)
        return B

r"""The unconstrained cell as one Hermitian operator on its displacements and element pressures, fields w = (u, p).

.. math::  w^H M w = u^H A u + 2\, \mathrm{Re}\, p^H B u - p^H C p ,

real, and the energy of u where p is the pressure of u (:mod:`homogenize.element_pressure`).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.cell_mesh import SliceMesh, SweptCell
from homogenize.block_sweep import blocks
from homogenize.element_pressure import element_pressure, limited_lame
from homogenize.mean_dilatation import element_energies, stiffness_matrix


class CellOperator:
    """M of a mesh: `stiffness` is A in 3x3 blocks, `displacements` the number of components of u, `size` that of w."""

    def __init__(self, mesh: SliceMesh | SweptCell) -> None:
        self.mesh = mesh
        self.lame = limited_lame(mesh)
        self.stiffness: Any = stiffness_matrix(mesh, self.lame)
        self.pressure = element_pressure(mesh)
        self.displacements = self.stiffness.shape[0]
        self.size = self.displacements + (0 if self.pressure is None else len(self.pressure.elements))
        self._blocks = blocks(self.stiffness)

    def with_pressures(self, u: NDArray) -> NDArray:
        """Fields (m, size) without pressure of displacements (m, 3n)."""
        return np.hstack([u, np.zeros((len(u), self.size - self.displacements), dtype=u.dtype)])

    def product(self, w: NDArray) -> NDArray:
        """M w of one field."""
        u = w[: self.displacements].reshape(-1, 3)
        force = self._blocks.product(u)
        if self.pressure is None:
            return force.ravel()
        p = w[self.displacements :, None]
        force += self.pressure.transposed.product(p)
        change = self.pressure.B.product(u) - self.pressure.C.product(p)
        return np.concatenate([force.ravel(), change.ravel()])

    def products(self, fields: NDArray) -> NDArray:
        """M w of every field, (m, size)."""
        return np.array([self.product(w) for w in fields])

    def energies(self, fields: NDArray) -> NDArray:
        """Products w_i^H M_e w_j of every element, (e, m, m): they add up to w_i^H M w_j."""
        u, p = np.split(fields, [self.displacements], axis=1)
        found = element_energies(self.mesh, u, self.lame)
        if self.pressure is not None:
            found[self.pressure.elements] += self.pressure.energies(u, p)
        return found

"""What one evaluation of a rod model yields: forces, energies and powers, and the blocks of its tangent."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from beam.block_sparse import Pattern
from beam.element import DOF
from beam.section_memory import SectionMemory

if TYPE_CHECKING:
    from beam.surface import Surface

Array = NDArray[np.float64]


@dataclass
class Forces:
    """Everything that one evaluation of F yields; energies in J, powers in W.

    With a section law: the `memory` to commit if the step is accepted, and the work that the law takes up in it [J].
    With bodies: `body_contact` (bodies, 3), the contact force on each [N].
    """

    F: Array
    S: Array
    moved: list[Array]
    contact: Array
    friction: Array
    cones: list[Array]
    elastic: float = 0.0
    kinetic: float = 0.0
    potential: float = 0.0
    damping_power: float = 0.0
    held_power: float = 0.0
    penalty: float = 0.0
    bristle: float = 0.0
    contact_damping_power: float = 0.0
    friction_power: float = 0.0
    surface_power: float = 0.0
    penetration: float = 0.0
    penetration_at: str = ""
    memory: SectionMemory | None = None
    law_work: float = 0.0
    bushing: float = 0.0
    bushing_damping_power: float = 0.0
    body_contact: Array = field(default_factory=lambda: np.zeros((0, 3)))

    def add_contacts(self, reports: Array, surfaces: Sequence[Surface], place: Callable[[int], str]) -> None:
        """Energies, powers and deepest penetration of surfaces, `reports` (surfaces, 7); `place` names the last column."""
        for report, surface in zip(reports.tolist(), surfaces, strict=True):
            self.penalty += report[0]
            self.bristle += report[1]
            self.contact_damping_power += report[2]
            self.friction_power += report[3]
            self.surface_power += report[4]
            if report[5] > self.penetration:
                self.penetration = report[5]
                self.penetration_at = f"{surface.name}, {place(int(report[6]))}"


@dataclass
class Blocks:
    """Block-tridiagonal matrix: `D` (n, dof, dof), `U` and `L` (n - 1, dof, dof).

    With bodies they are views of a `store` of more blocks, whose places are those of `pattern`.
    """

    D: Array
    U: Array
    L: Array
    store: Array | None = None
    pattern: Pattern | None = None

    @classmethod
    def zeros(cls, nodes: int, dof: int = DOF) -> Blocks:
        """Empty matrix of `nodes` block rows."""
        shape = (dof, dof)
        return cls(np.zeros((nodes, *shape)), np.zeros((nodes - 1, *shape)), np.zeros((nodes - 1, *shape)))

    @classmethod
    def of_pattern(cls, at: Pattern, store: Array | None = None) -> Blocks:
        """Matrix with the couplings of a pattern, in a given store or an empty one."""
        store = at.store() if store is None else store
        rows, links = at.rows, at.chain - 1
        return cls(store[:rows], store[rows : rows + links], store[rows + links : rows + 2 * links], store, at)

    def clear(self) -> None:
        """Set everything to zero."""
        if self.store is not None:
            self.store[:] = 0.0
            return
        for part in (self.D, self.U, self.L):
            part[:] = 0.0

    def divide(self, divisor: float) -> None:
        """Divide everything by `divisor`."""
        for part in (self.D, self.U, self.L) if self.store is None else (self.store,):
            part /= divisor

"""The rod: a chain of elements with one section law, its mass, and the strains of its stress-free shape."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from beam.element import DOF, reference_strains
from beam.end_reaction import global_moment
from beam.hermite import gauss_points
from beam.section_force import nodal_section_forces
from beam.section_law import DampingTimes, rod_inertia, rod_stiffness
from geometry.errors import SpecError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

Array = NDArray[np.float64]

GAUSS_X, GAUSS_W = gauss_points(3)

FIELDS = {
    "r": slice(0, 3),
    "x": slice(0, 1),
    "y": slice(1, 2),
    "z": slice(2, 3),
    "r'": slice(3, 6),
    "theta": slice(6, 9),
    "theta'": slice(9, 12),
}


@dataclass(frozen=True)
class Rod:
    """Elements of a rod; the arrays are what the kernels read.

    Parameters
    ----------
    lengths : (n,) array
        Stress-free element lengths [m].
    C, C_damping : (6, 6) array
        Stiffness and damping in the rod's order, see :mod:`beam.section_law`.
    E0 : (n, 3, 6) array
        Strains of the stress-free shape at the Gauss points; zero for a straight rod.
    mass_per_length : float
        kg/m.
    J : (3,) array
        Rotary inertia per length about (e1, e2, e3) [kg m].
    """

    name: ClassVar[str] = "rod"
    dof: ClassVar[int] = DOF

    lengths: Array
    C: Array
    C_damping: Array
    E0: Array
    mass_per_length: float
    J: Array

    @classmethod
    def build(
        cls,
        lengths: Array,
        section: SectionStiffness,
        inertia: SectionInertia,
        damping: DampingTimes | None = None,
        stress_free: Array | None = None,
    ) -> Rod:
        """Rod of elements `lengths` [m]; `stress_free` (n + 1, 12) is its unloaded shape, straight if not given.

        Raises
        ------
        SpecError
            If a length is not positive.
        """
        lengths = np.ascontiguousarray(lengths, dtype=float)
        if lengths.ndim != 1 or lengths.size == 0 or not (np.isfinite(lengths).all() and lengths.min() > 0):
            raise SpecError("a rod needs at least one element, and every element a positive length.")
        E0 = np.zeros((lengths.size, GAUSS_X.size, 6))
        if stress_free is not None:
            reference_strains(np.ascontiguousarray(stress_free), lengths, GAUSS_X, E0)
        C, C_damping = rod_stiffness(section, damping or DampingTimes())
        return cls(lengths, C, C_damping, E0, inertia.mass_per_length, rod_inertia(inertia))

    @classmethod
    def straight(
        cls,
        length: float,
        elements: int,
        section: SectionStiffness,
        inertia: SectionInertia,
        damping: DampingTimes | None = None,
    ) -> Rod:
        """Straight rod of equal elements."""
        if elements < 1:
            raise SpecError(f"a rod needs at least one element, found {elements}.")
        return cls.build(np.full(elements, length / elements), section, inertia, damping)

    @property
    def nodes(self) -> int:
        """Number of nodes."""
        return self.lengths.size + 1

    @property
    def s(self) -> Array:
        """Arc length of the nodes in the stress-free shape [m], shape (n + 1,)."""
        return np.concatenate([[0.0], np.cumsum(self.lengths)])

    def weight(self, gravity: Array) -> Array:
        """Nodal forces of the acceleration `gravity` (3,) [m/s^2], shape (n + 1, dof)."""
        load = np.zeros((self.nodes, self.dof))
        half = 0.5 * self.mass_per_length * self.lengths[:, None] * np.asarray(gravity, dtype=float)
        bend = half * self.lengths[:, None] / 6
        load[:-1, 0:3] += half
        load[1:, 0:3] += half
        load[:-1, 3:6] += bend
        load[1:, 3:6] -= bend
        return load

    def slots(self, field: str, here: Array) -> slice | list[int]:
        """Unknowns of the field `field` at a node with the values `here` (dof,)."""
        return FIELDS[field]

    def columns(self, values: Array) -> Array:
        """This element's part of nodal values (n + 1, 12)."""
        return values

    def load_columns(self, load: Array) -> Array:
        """The same for nodal forces."""
        return load

    def sections(self, q: Array, S: Array) -> tuple[Array, Array, Array]:
        """Rotation vectors (n + 1, 3), local and global section forces (n + 1, 6), see :mod:`beam.section_force`."""
        return (q[:, 6:9], *nodal_section_forces(q, self.lengths, S))

    def strains(self, q: Array) -> Array:
        """Strains at the Gauss points minus those of the stress-free shape, section axes, (n, 3, 6)."""
        E = np.empty_like(self.E0)
        reference_strains(np.ascontiguousarray(q), self.lengths, GAUSS_X, E)
        return E - self.E0

    def moment(self, q: Array, f: Array) -> Array:
        """Moment (3,) [N m] in global axes of the generalised forces `f` (dof,) on a node with the values `q` (dof,)."""
        return global_moment(q[6:9], f[6:9])

    def in_section_axes(self, q: Array, S: Array) -> Array:
        """Section forces `S` (n, 3, 6) of the kernels in section axes."""
        return S

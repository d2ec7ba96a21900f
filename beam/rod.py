"""The rod: a chain of elements with one section law, its mass, and the strains of its stress-free shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beam.element import DOF, reference_strains
from beam.hermite import gauss_points
from beam.section_law import DampingTimes, rod_inertia, rod_stiffness
from geometry.errors import SpecError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

Array = NDArray[np.float64]

GAUSS_X, GAUSS_W = gauss_points(3)


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
        """Nodal forces of the acceleration `gravity` (3,) [m/s^2], shape (n + 1, 12)."""
        load = np.zeros((self.nodes, DOF))
        half = 0.5 * self.mass_per_length * self.lengths[:, None] * np.asarray(gravity, dtype=float)
        bend = half * self.lengths[:, None] / 6
        load[:-1, 0:3] += half
        load[1:, 0:3] += half
        load[:-1, 3:6] += bend
        load[1:, 3:6] -= bend
        return load

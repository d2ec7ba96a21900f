r"""The linear section law with Kelvin-Voigt damping, and the order of its six entries.

Section forces S = (N_1, N_2, N_3, M_1, M_2, M_3) follow the strains E = (Gamma, kappa) of the rod and their rates,

.. math:: S = C\,(E - E_0) + \sqrt{\eta}\,C\,\sqrt{\eta}\;\dot E, \qquad
          \eta = \mathrm{diag}(\eta_A, \eta_A, \eta_A, \eta_I, \eta_I, \eta_I).

For an uncoupled section this is N_i = C_i (Gamma_i + eta_A dGamma_i/dt), M_i = C_i (kappa_i + eta_I dkappa_i/dt). The
symmetric product with the roots keeps the dissipated power positive when C couples stretch and twist. eta_A and eta_I are
times in seconds; at rest they have no effect.

The rod's axes are e1 along the cable, e2 = x and e3 = y of the section, whereas :class:`SectionStiffness` has z along the
cable and the order (gamma_x, gamma_y, epsilon, kappa_x, kappa_y, tau). :func:`rod_order` is the one place that maps them.

Physics with a memory (friction between layers, plasticity, relaxation) comes as a :class:`SectionLaw`, whose forces are added
to the linear ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from geometry.errors import SpecError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

Array = NDArray[np.float64]

SECTION_OF_ROD = (2, 0, 1, 5, 3, 4)
"""Entry k of the rod's order (1: stretch, 2: shear x, 3: shear y, twist, curvature x, y) in the section's order."""


class SectionLaw(Protocol):
    """Section forces with internal state, on top of the linear law.

    Attributes
    ----------
    memory : int
        State variables per Gauss point; zeros stand for a section that was never strained.
    """

    @property
    def memory(self) -> int: ...

    def advance(
        self, E: Array, before: Array, dt: float, state: Array, tangent: bool
    ) -> tuple[Array, Array | None, Array]:
        """Take all Gauss points of a rod one step on; must not change its arguments.

        Parameters
        ----------
        E, before : (n, 6) array
            Strains in the rod's order at the end and at the start of the step, minus those of the stress-free shape.
        dt : float
            Length of the step [s].
        state : (n, memory) array
            At the start of the step.
        tangent : bool
            Whether the derivative is wanted.

        Returns
        -------
        S : (n, 6) array
            Section forces to add [N, N m].
        T : (n, 6, 6) array or None
            dS/dE.
        state : (n, memory) array
            At the end of the step.
        """
        ...


@dataclass(frozen=True)
class DampingTimes:
    """Kelvin-Voigt times [s]: `axial` for stretch and shear, `bending` for curvature and twist."""

    axial: float = 0.0
    bending: float = 0.0

    def __post_init__(self) -> None:
        if not (np.isfinite([self.axial, self.bending]).all() and min(self.axial, self.bending) >= 0):
            raise SpecError(f"damping times must be zero or positive, found {self.axial:g} s and {self.bending:g} s.")


def rod_order(C: Array) -> Array:
    """A 6x6 section stiffness in the rod's order.

    Examples
    --------
    >>> rod_order(np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])).diagonal()
    array([3., 1., 2., 6., 4., 5.])
    """
    index = np.array(SECTION_OF_ROD)
    return np.ascontiguousarray(np.asarray(C, dtype=float)[np.ix_(index, index)])


def rod_stiffness(section: SectionStiffness, damping: DampingTimes) -> tuple[Array, Array]:
    """(C, C_damping) in the rod's order, each (6, 6)."""
    C = rod_order(section.C)
    root = np.sqrt(np.repeat([damping.axial, damping.bending], 3))
    return C, root[:, None] * C * root


def rod_inertia(inertia: SectionInertia) -> Array:
    """Rotary inertia per length about (e1, e2, e3) [kg m]."""
    return np.array([inertia.J_z, inertia.J_x, inertia.J_y])

r"""The apparent modulus over the length of the specimen: an end compliance and the long cable in series.

.. math::  \frac{L}{E_{app}} = c + \frac{L}{E_\infty} .

The long cable's value from the helical cell is E_free (torque zero: the loaded end may turn). Half of it is reached at
L = c E_inf. At lengths much below that the slope is ill-conditioned: an error of 1 % in L / E moves E_inf by ten times as much.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import SpecError
from homogenize.specimen.apparent_modulus import apparent_moduli
from homogenize.specimen.gauge_length import gauge_modulus
from homogenize.specimen.load_case import LoadCase
from homogenize.specimen.specimen_solution import Specimen, solve_specimen

Progress = Callable[[float, str], None]


@dataclass(frozen=True)
class LengthLaw:
    """The fitted law.

    Attributes
    ----------
    lengths, moduli : what was fitted [m], [Pa]
    c : end compliance [m/Pa]
    E_infinite : [Pa]
    misfit : largest relative error of L / E
    """

    lengths: NDArray[np.float64]
    moduli: NDArray[np.float64]
    c: float
    E_infinite: float
    misfit: float

    def modulus(self, length: ArrayLike) -> NDArray[np.float64]:
        """E_app [Pa] of specimens of other lengths [m]."""
        L = np.asarray(length, dtype=float)
        return L / (self.c + L / self.E_infinite)

    @property
    def half_length(self) -> float:
        """Length [m] of a specimen with half the modulus of the long cable."""
        return self.c * self.E_infinite


def length_law(lengths: ArrayLike, moduli: ArrayLike) -> LengthLaw:
    """Fit the law by least squares on L / E, each value weighted by its inverse.

    Raises
    ------
    SpecError
        If there are fewer than two different positive lengths, or a modulus is not positive.

    Examples
    --------
    >>> L = np.array([0.1, 0.4, 1.6])
    >>> law = length_law(L, L / (1.3e-9 + L / 4.4e9))
    >>> round(law.c * 1e9, 6), round(law.E_infinite / 1e9, 6)
    (1.3, 4.4)
    """
    L, E = np.asarray(lengths, dtype=float), np.asarray(moduli, dtype=float)
    if L.shape != E.shape or L.ndim != 1 or len(np.unique(L)) < 2 or not ((L > 0).all() and (E > 0).all()):
        raise SpecError("the law over the length needs at least two different lengths, and positive moduli.")
    y = L / E
    A = np.column_stack([np.ones_like(L), L]) / y[:, None]
    (c, slope), *_ = np.linalg.lstsq(A, np.ones_like(y), rcond=None)
    return LengthLaw(L, E, float(c), float(1 / slope), float(np.abs((c + slope * L) / y - 1).max()))


def moduli_over_length(
    specimen: Specimen,
    mesh: CrossSectionMesh,
    lengths: Sequence[float],
    force: float = 1000.0,
    progress: Progress | None = None,
) -> tuple[LengthLaw, NDArray[np.float64]]:
    """Tension of specimens of several lengths: the fitted law, and E [Pa] over the middle fifth of each.

    Raises
    ------
    SpecError, MeshError, ConvergenceError
        As :func:`solve_specimen` and :func:`length_law`.
    """
    tell = progress or (lambda fraction, sentence: None)
    moduli, gauges = [], []
    for i, length in enumerate(lengths):
        tell(i / len(lengths), f"specimen of {1e3 * length:.4g} mm")
        solution = solve_specimen(replace(specimen, length=length), mesh, [LoadCase("tension", force)])
        moduli.append(apparent_moduli(solution)[0].modulus)
        gauges.append(gauge_modulus(solution))
    tell(1.0, "all lengths solved")
    return length_law(lengths, moduli), np.array(gauges)

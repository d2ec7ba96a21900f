r"""The loads of the three-dimensional cell, sorted by the factor that their fields take from one cell to the next.

A cable is mapped on itself by the motion of its cell, x -> Q x + H e_z, Q a turn by the angle alpha. Under a constant stretch or
twist the strain is the same in every cell. A constant moment about a fixed axis is not: seen from the cell it turns by -alpha.
The circular moments a = (1, +-i, 0) / sqrt 2 are eigenvectors, Q a = exp(-+i alpha) a, so that the displacement is

.. math::  u = u_{macro} + v, \qquad v(Q x + H e_z) = s\, Q\, v(x), \qquad s = e^{\pm i \alpha} ,

with the macroscopic field of the curvature a: one complex problem on one cell (Floquet's theorem), its conjugate needs none. When
alpha is a multiple of pi the factor is +1 or -1 and the moments about x and y are two real loads; at s = 1 they may couple with stretch and
twist.

A shear force t makes the moment vary, M' = -e_z x t. Its field gains H times the field of the moment -e_z x t in every cell (the
generalised eigenvector), which the second-order macroscopic fields, of strains that grow with z, carry.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FORCES = ("N", "M_x", "M_y", "M_z")
"""Section forces whose fields repeat from cell to cell; their strains: epsilon, kappa_x, kappa_y, tau."""
CIRCULAR = np.array([1.0, 1j, 0.0]) / np.sqrt(2)


@dataclass(frozen=True)
class LoadGroup:
    """Loads that share the factor `factor`.

    Attributes
    ----------
    names : of the section forces, for messages
    forces : (6, m) section forces (T_x, T_y, N, M_x, M_y, M_z), one column each
    shears : (6, k) shear forces that belong to them
    growth : (m, k) section forces per length that a shear force builds up, in terms of the columns of `forces`
    """

    names: tuple[str, ...]
    factor: complex
    forces: NDArray
    shears: NDArray
    growth: NDArray

    @property
    def circular(self) -> bool:
        """Complex loads stand for themselves and their conjugates."""
        return np.iscomplexobj(self.forces)


def load_groups(angle: float, bending: bool) -> tuple[LoadGroup, ...]:
    """Groups of loads of a cell that turns by `angle` [rad]; tension and torsion only without `bending`.

    Examples
    --------
    >>> [group.names for group in load_groups(2.0, True)]
    [('tension', 'torsion'), ('bending',)]
    >>> [group.names for group in load_groups(2 * np.pi, True)]
    [('tension', 'torsion', 'bending about x', 'bending about y')]
    """
    unit = np.eye(6)
    axial, names = unit[:, [2, 5]], ("tension", "torsion")
    none = LoadGroup(names, 1.0, axial, np.zeros((6, 0)), np.zeros((2, 0)))
    if not bending:
        return (none,)
    bends = ("bending about x", "bending about y")
    turning = np.array([[0.0, 1.0], [-1.0, 0.0]])  # -e_z x e_x = -e_y, -e_z x e_y = e_x
    if abs(np.sin(angle)) > 1e-9:
        moment, shear = np.zeros((2, 6, 1), dtype=complex)
        moment[3:, 0] = shear[:3, 0] = CIRCULAR
        return none, LoadGroup(("bending",), np.exp(1j * angle), moment, shear, np.array([[1j]]))
    if np.cos(angle) < 0:
        return none, LoadGroup(bends, -1.0, unit[:, 3:5], unit[:, :2], turning)
    growth = np.vstack([np.zeros((2, 2)), turning])
    return (LoadGroup(names + bends, 1.0, np.hstack([axial, unit[:, 3:5]]), unit[:, :2], growth),)


def macroscopic_fields(points: NDArray[np.float64], strains: NDArray, order: int = 1) -> NDArray:
    """Displacements (m, 3n) whose mean strains are `strains`, (6, m), constant (order 1), or growing as z times them (order 2).

    The strains gamma_x, gamma_y are not used: a uniform shear is a turn plus a field that repeats.
    """
    x, y, z = points.T[:, None]
    _, _, epsilon, kappa_x, kappa_y, tau = strains[:, :, None]
    turn = z if order == 1 else z**2 / 2
    sag = z**2 / 2 if order == 1 else z**3 / 6
    u = np.stack(
        [
            kappa_y * sag - tau * y * turn,
            -kappa_x * sag + tau * x * turn,
            (epsilon + kappa_x * y - kappa_y * x) * turn,
        ],
        axis=-1,
    )
    return u.reshape(strains.shape[1], -1)

r"""Material that is alike in all directions about an axis, the axis following the members of a helical cable.

In its own axes, 3 along the fibres, the compliance is (strains 11 22 33 23 13 12, engineering shears)

.. math::
   S = \begin{pmatrix} 1/E_T & -\nu_T/E_T & -\nu_A/E_A \\ -\nu_T/E_T & 1/E_T & -\nu_A/E_A \\ -\nu_A/E_A & -\nu_A/E_A & 1/E_A \end{pmatrix}
   \oplus \mathrm{diag}\left(\frac1{G_A}, \frac1{G_A}, \frac{2(1+\nu_T)}{E_T}\right),

nu_A the contraction across the fibres under a stress along them. At the point (X, Y) of the section the fibres have the direction

.. math::  t \propto (-\tau_0 c_Y - \omega (Y - c_Y),\; \tau_0 c_X + \omega (X - c_X),\; 1),

c the centre of the member, tau_0 the twist rate of the cable, omega the rate at which the fibres turn about the centre: omega = tau_0 for
fibres that turn with the cable, as its cores do. In the frame that turns with the cable t does not depend on z.
The stiffness there is M C M^T with Bond's matrix M of the rotation that takes the axis e_z to t (T. C. T. Ting, Anisotropic Elasticity,
Oxford 1996, section 2.4; Lekhnitskii, Theory of Elasticity of an Anisotropic Body, 1981, for the constants).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.errors import SpecError

FloatArray = NDArray[np.float64]

_PAIRS = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))  # xx yy zz yz xz xy


@dataclass(frozen=True)
class TransverseIsotropy:
    """Transversely isotropic material along helical fibres; it can stand in a region of a mesh in place of an isotropic one.

    Parameters
    ----------
    name : str
    E_axial, E_transverse, G_axial : float [Pa]
    nu_axial, nu_transverse : float
        Contraction across the fibres under a stress along them, and in the plane across them.
    density : float [kg/m^3]
    centre : (float, float)
        Centre of the member in the section [m].
    turn_rate : float or None
        omega [rad/m] of the fibres about the centre, signed; None for that of the cable.

    Raises
    ------
    SpecError
        If a modulus is not positive, or some strain would release energy.

    Examples
    --------
    >>> rope = TransverseIsotropy("rope", E_axial=60e9, E_transverse=10e9, G_axial=5e9, nu_axial=0.3, nu_transverse=0.3, density=5000.0)
    >>> rope.elasticity().shape
    (6, 6)
    """

    name: str
    E_axial: float
    E_transverse: float
    G_axial: float
    nu_axial: float
    nu_transverse: float
    density: float
    centre: tuple[float, float] = (0.0, 0.0)
    turn_rate: float | None = None

    def __post_init__(self) -> None:
        for what in ("E_axial", "E_transverse", "G_axial", "density"):
            value = getattr(self, what)
            if not (np.isfinite(value) and value > 0):
                raise SpecError(f"material {self.name}: {what} = {value:g} must be positive.")
        if not -1 < self.nu_transverse < 1:
            raise SpecError(
                f"material {self.name}: Poisson's ratio {self.nu_transverse:g} across the fibres must lie between -1 and 1."
            )
        limit = self.E_axial * (1 - self.nu_transverse) / (2 * self.E_transverse)
        if not self.nu_axial**2 < limit:
            raise SpecError(
                f"material {self.name}: Poisson's ratio {self.nu_axial:g} along the fibres must be below {limit**0.5:.3g} for these "
                "moduli, or some strain would release energy: lower it, or lower E_transverse."
            )

    @property
    def E(self) -> float:
        """Modulus along the fibres [Pa]."""
        return self.E_axial

    @property
    def G(self) -> float:
        """Shear modulus along the fibres [Pa]."""
        return self.G_axial

    def compliance(self) -> FloatArray:
        """S [1/Pa], shape (6, 6), fibres along the third axis."""
        S = np.zeros((6, 6))
        S[0, 0] = S[1, 1] = 1 / self.E_transverse
        S[2, 2] = 1 / self.E_axial
        S[0, 1] = S[1, 0] = -self.nu_transverse / self.E_transverse
        S[:2, 2] = S[2, :2] = -self.nu_axial / self.E_axial
        S[3, 3] = S[4, 4] = 1 / self.G_axial
        S[5, 5] = 2 * (1 + self.nu_transverse) / self.E_transverse
        return S

    def elasticity(self) -> FloatArray:
        """C [Pa], shape (6, 6), fibres along the third axis."""
        return np.asarray(np.linalg.inv(self.compliance()), dtype=float)

    def direction(self, X: ArrayLike, Y: ArrayLike, twist_rate: float) -> FloatArray:
        """Unit vectors (..., 3) along the fibres at points of the section, rotating components."""
        X, Y = np.asarray(X, dtype=float), np.asarray(Y, dtype=float)
        omega = twist_rate if self.turn_rate is None else self.turn_rate
        c_X, c_Y = self.centre
        t = np.stack(
            [-twist_rate * c_Y - omega * (Y - c_Y), twist_rate * c_X + omega * (X - c_X), np.ones_like(X)], axis=-1
        )
        return t / np.linalg.norm(t, axis=-1, keepdims=True)

    def elasticity_at(self, X: ArrayLike, Y: ArrayLike, twist_rate: float) -> FloatArray:
        """C [Pa], shape (..., 6, 6), at points of the section, rotating components."""
        return rotated(self.elasticity(), rotation_to(self.direction(X, Y, twist_rate)))


def rotation_to(direction: FloatArray) -> FloatArray:
    """Rotations (..., 3, 3) that take e_z to unit vectors (..., 3) by the shortest way; not for -e_z.

    Examples
    --------
    >>> rotation_to(np.array([1.0, 0.0, 0.0])) @ [0.0, 0.0, 1.0]
    array([1., 0., 0.])
    """
    x, y, z = np.moveaxis(direction, -1, 0)
    K = np.zeros((*x.shape, 3, 3))  # the cross product with e_z x t
    K[..., 0, 2], K[..., 1, 2], K[..., 2, 0], K[..., 2, 1] = x, y, -x, -y
    return np.eye(3) + K + K @ K / (1 + z)[..., None, None]


def bond_matrix(R: FloatArray) -> FloatArray:
    """M (..., 6, 6): the stress vector in axes turned by R, sigma' = M sigma, order xx yy zz yz xz xy."""
    M = np.empty((*R.shape[:-2], 6, 6))
    for row, (i, j) in enumerate(_PAIRS):
        for column, (k, l) in enumerate(_PAIRS):
            M[..., row, column] = R[..., i, k] * R[..., j, l]
            if k != l:
                M[..., row, column] += R[..., i, l] * R[..., j, k]
    return M


def rotated(C: FloatArray, R: FloatArray) -> FloatArray:
    """Stiffness (..., 6, 6) of a material with the stiffness C in its own axes after it was turned by R (..., 3, 3)."""
    M = bond_matrix(R)
    return M @ C @ np.swapaxes(M, -1, -2)

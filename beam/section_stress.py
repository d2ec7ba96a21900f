r"""Strains and stresses at a point (y, z) of the section, from the rod's strains and section forces.

The section stays plane, so that a material point at (y, z) along e2 and e3 has the strains (formula 19 of the source)

.. math:: \varepsilon = \Gamma_1 + z\kappa_2 - y\kappa_3, \quad \gamma_{12} = \Gamma_2 - z\kappa_1, \quad
          \gamma_{13} = \Gamma_3 + y\kappa_1 .

Stresses (formula 20) follow on the equivalent solid circle of radius R from the section forces, so that they balance them
whatever the 6x6 law is: normal stress and torsion after Saint-Venant,

.. math:: \sigma = \frac NA + \frac{M_2 z - M_3 y}{I}, \qquad (\tau_{12}, \tau_{13}) = \frac{M_1}{2I}(-z, y),

and for a shear force Q along y the exact flexure of the circle with Poisson's ratio nu,

.. math:: \tau_{12} = \frac{Q}{I}\frac{3+2\nu}{8(1+\nu)}\Big(R^2 - y^2 - \frac{1-2\nu}{3+2\nu}z^2\Big), \qquad
          \tau_{13} = -\frac{Q}{I}\frac{1+2\nu}{4(1+\nu)}\,y z ,

likewise along z. They are smeared over the whole circle; the stress of a single conductor is what `helicable stress` computes.

Sources: M. Ge et al., PLoS ONE 18(2) e0281136 (2023), formulas (19), (20), whose text is not open to us and was rebuilt from the
beam theory it names; S. Timoshenko, J. N. Goodier, Theory of Elasticity, 3rd ed., 1970, section 122 (flexure).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.errors import InputError

Array = NDArray[np.float64]

POISSON = 0.3
"""Of the flexure solution; from 0 to 0.5 the largest shear stress of a circle changes by 8 %."""


def point_strains(E: Array, y: ArrayLike, z: ArrayLike) -> Array:
    """(epsilon, gamma_12, gamma_13) at the point (y, z) [m].

    Parameters
    ----------
    E : (..., 6) array
        Rod strains (Gamma_1, Gamma_2, Gamma_3, kappa_1, kappa_2, kappa_3).
    y, z : array_like
        Along e2 and e3 of the section; of a shape that goes with E[..., 0].

    Returns
    -------
    (..., 3) array
    """
    y, z = np.asarray(y, dtype=float), np.asarray(z, dtype=float)
    G1, G2, G3, k1, k2, k3 = np.moveaxis(np.asarray(E, dtype=float), -1, 0)
    return np.stack(np.broadcast_arrays(G1 + z * k2 - y * k3, G2 - z * k1, G3 + y * k1), axis=-1)


def point_stresses(S: Array, y: ArrayLike, z: ArrayLike, diameter: float, poisson: float = POISSON) -> Array:
    """(sigma, tau_12, tau_13) [Pa] at the point (y, z) [m] of the solid circle.

    Parameters
    ----------
    S : (..., 6) array
        Section forces (N, Q_2, Q_3, M_1, M_2, M_3) [N, N m].
    y, z : array_like
        Along e2 and e3 of the section; of a shape that goes with S[..., 0].
    diameter : float
        Of the circle [m].
    poisson : float
        From 0 to 0.5.

    Returns
    -------
    (..., 3) array

    Raises
    ------
    InputError
        If a point lies outside the section, or Poisson's ratio outside 0 to 0.5.

    Examples
    --------
    >>> point_stresses(np.array([100.0, 0, 0, 0, 0, 0]), 0.0, 0.01, diameter=0.04).round()
    array([79577.,     0.,     0.])
    """
    y, z = np.asarray(y, dtype=float), np.asarray(z, dtype=float)
    R = 0.5 * diameter
    out = float(np.sqrt(np.max(y * y + z * z)))
    if out > R * (1 + 1e-9):
        raise InputError(
            f"a point {1e3 * out:.3g} mm from the centre lies outside the section of radius {1e3 * R:.3g} mm."
        )
    if not 0 <= poisson <= 0.5:
        raise InputError(f"Poisson's ratio is {poisson:g}; it must lie between 0 and 0.5.")
    N, Q2, Q3, M1, M2, M3 = np.moveaxis(np.asarray(S, dtype=float), -1, 0)
    A, inertia = np.pi * R**2, np.pi * R**4 / 4
    sigma = N / A + (M2 * z - M3 * y) / inertia
    own, cross = _flexure(y, z, R, poisson)
    other, _ = _flexure(z, y, R, poisson)
    tau12 = -M1 * z / (2 * inertia) + (Q2 * own + Q3 * cross) / inertia
    tau13 = M1 * y / (2 * inertia) + (Q3 * other + Q2 * cross) / inertia
    return np.stack(np.broadcast_arrays(sigma, tau12, tau13), axis=-1)


def _flexure(y: Array, z: Array, R: float, nu: float) -> tuple[Array, Array]:
    """I tau_12 / Q and I tau_13 / Q of a shear force Q along y [m^2]."""
    along = (3 + 2 * nu) / (8 * (1 + nu)) * (R * R - y * y - (1 - 2 * nu) / (3 + 2 * nu) * z * z)
    return along, -(1 + 2 * nu) / (4 * (1 + nu)) * y * z


def largest_normal_stress(S: Array, diameter: float) -> tuple[Array, Array]:
    """(largest, smallest) normal stress over the circle [Pa], both of shape S[..., 0]: N / A +- |M| / W."""
    A, W = np.pi * diameter**2 / 4, np.pi * diameter**3 / 32
    mean, bend = S[..., 0] / A, np.hypot(S[..., 4], S[..., 5]) / W
    return mean + bend, mean - bend

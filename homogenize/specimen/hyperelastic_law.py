r"""Stress and tangent at a point of a body that moves far, per displacement gradient H = F - I.

The volume strain theta is kept apart from the rest, so that an element may take a smoothed theta (:mod:`homogenize.specimen.wedge18`):

.. math::
   W = W_0(H) + \tfrac12 \lambda\, \bar\theta^2, \qquad P = \partial W_0 / \partial H + \lambda \bar\theta\, \partial\theta/\partial H .

* St Venant-Kirchhoff, any elasticity C: :math:`\theta = \mathrm{tr} E`, :math:`W_0 = \tfrac12 E : C' : E`, with
  :math:`E = \tfrac12 (F^T F - I)` and C' = C without the lambda part (all of C where the material is not isotropic; lambda is then 0).
* Neo-Hookean, compressible: :math:`\theta = \ln J`, :math:`W_0 = \tfrac12 G (F : F - 3) - G \ln J`.

Both have the same linear elasticity at rest. Bonet, Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed., 2008,
ch. 6. H is stored row by row, number 3 x + j for the derivative of u_x by direction j; Voigt order xx yy zz yz xz xy.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

PAIRS = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))
"""Directions of the Voigt components."""


@dataclass(frozen=True)
class PointState:
    """Energy and derivatives at points (p of them), the volume strain apart.

    Attributes
    ----------
    energy : (p,) W_0 [J/m^3]
    stress : (p, 9) dW_0 / dH [Pa]
    tangent : (p, 9, 9) d2W_0 / dH2 [Pa]
    theta : (p,) volume strain
    slope : (p, 9) d theta / dH
    curve : (p, 9, 9) d2 theta / dH2
    jacobian : (p,) det F
    """

    energy: FloatArray
    stress: FloatArray
    tangent: FloatArray
    theta: FloatArray
    slope: FloatArray
    curve: FloatArray
    jacobian: FloatArray

    def reshaped(self, *shape: int) -> PointState:
        """The same with the points in an array of this shape."""
        return PointState(*(value.reshape(*shape, *value.shape[1:]) for value in self.arrays()))

    def arrays(self) -> tuple[FloatArray, ...]:
        """All arrays in order."""
        return tuple(getattr(self, f.name) for f in fields(self))


def point_state(H: FloatArray, C: FloatArray, G: FloatArray, rubber: NDArray[np.bool_]) -> PointState:
    """State at points (p, 9), neo-Hookean with G (p,) where `rubber` (p,), St Venant-Kirchhoff with C' (p, 6, 6) elsewhere."""
    if not rubber.any():
        return st_venant_kirchhoff(H, C)
    soft = neo_hookean(H[rubber], G[rubber])
    if rubber.all():
        return soft
    stiff = st_venant_kirchhoff(H[~rubber], C[~rubber])
    joined = []
    for a, b in zip(soft.arrays(), stiff.arrays()):
        both = np.empty((len(H), *a.shape[1:]))
        both[rubber], both[~rubber] = a, b
        joined.append(both)
    return PointState(*joined)


def st_venant_kirchhoff(H: FloatArray, C: FloatArray) -> PointState:
    """State at points with displacement gradients H (p, 9), C' (p, 6, 6) or (6, 6)."""
    F = H.reshape(-1, 3, 3) + np.eye(3)
    h = H.reshape(-1, 3, 3)
    green = 0.5 * (h + h.transpose(0, 2, 1) + np.matmul(h.transpose(0, 2, 1), h))  # no digits lost to the unit of F
    E = np.stack([green[:, i, j] * (1 if i == j else 2) for i, j in PAIRS], axis=1)
    b = np.zeros((len(F), 6, 3, 3))  # dE / dH
    for row, (i, j) in enumerate(PAIRS):
        b[:, row, :, j] += F[:, :, i]
        if i != j:
            b[:, row, :, i] += F[:, :, j]
    b = b.reshape(-1, 6, 9)
    Cb = np.matmul(C, b)
    S = np.matmul(C, E[..., None])[..., 0]
    tangent = np.matmul(b.transpose(0, 2, 1), Cb).reshape(-1, 3, 3, 3, 3)
    second = np.empty((len(F), 3, 3))
    for row, (i, j) in enumerate(PAIRS):
        second[:, i, j] = second[:, j, i] = S[:, row]
    for x in range(3):
        tangent[:, x, :, x, :] += second
    return PointState(
        energy=0.5 * (E * S).sum(axis=1),
        stress=np.matmul(F, second).reshape(-1, 9),
        tangent=tangent.reshape(-1, 9, 9),
        theta=E[:, :3].sum(axis=1),
        slope=F.reshape(-1, 9),
        curve=np.broadcast_to(np.eye(9), (len(F), 9, 9)),
        jacobian=np.linalg.det(F),
    )


def neo_hookean(H: FloatArray, G: FloatArray) -> PointState:
    """State at points with displacement gradients H (p, 9) and shear modulus G (p,); nan where a point is turned inside out."""
    F = H.reshape(-1, 3, 3) + np.eye(3)
    J = np.linalg.det(F)
    theta = np.log(np.where(J > 0, J, np.nan))
    inverse = np.linalg.inv(np.where((J > 0)[:, None, None], F, np.eye(3)))
    slope = inverse.transpose(0, 2, 1).reshape(-1, 9)
    curve = -np.einsum("pjy,pkx->pxjyk", inverse, inverse).reshape(-1, 9, 9)
    squares = (H**2).sum(axis=1) + 2 * H[:, [0, 4, 8]].sum(axis=1)  # F : F - 3
    return PointState(
        energy=G * (0.5 * squares - theta),
        stress=G[:, None] * (F.reshape(-1, 9) - slope),
        tangent=G[:, None, None] * (np.eye(9) - curve),
        theta=theta,
        slope=slope,
        curve=curve,
        jacobian=J,
    )

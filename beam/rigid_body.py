r"""Rigid bodies: Newton's and Euler's equations in the unknowns r of the mass centre and the rotation vector theta.

.. math:: m\,\ddot r = F, \qquad T^T \left(J\dot\omega + \omega\times J\omega\right) = f_\theta, \qquad
          \omega = T\dot\theta, \quad \dot\omega = T\ddot\theta + \dot T\dot\theta ,

with omega and the inertia J in the body's own axes; a rotation vector past 1.25 pi goes to its other branch between two
steps (:mod:`beam.rotation_vector`), so that full turns work. The tangent of the turning part is a forward difference, as is
that of the rod.

Source: A. Cardona, M. Geradin, Int. J. Numer. Meth. Eng. 26 (1988) 2403-2438, doi 10.1002/nme.1620261105.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beam.compiled import inlined, kernel
from beam.rotation_vector import rotation_coefficients
from geometry.errors import SpecError

Array = NDArray[np.float64]

STEP = 1e-7
"""Step of the forward differences."""


@dataclass(frozen=True)
class RigidBody:
    """A rigid body; its position is that of its mass centre.

    Parameters
    ----------
    name : str
        By which supports, bushings and joints refer to it.
    mass : float
        [kg].
    inertia : (3, 3) or (3,) array_like
        About the mass centre, in the body's axes [kg m^2]; three numbers are its diagonal.
    position : (3,) array_like
        At the start [m].
    rotation : (3,) array_like
        Rotation vector at the start [rad].
    velocity, spin : (3,) array_like
        Velocity at the start in global axes [m/s], angular velocity in the body's axes [rad/s].
    force : (3,) array_like
        Constant force besides the weight, at the mass centre, global axes [N].
    points : (k, 3) array_like
        Points in the body's axes [m] that touch the body surfaces of the model.
    contact_length : float
        Length of cable [m] that the points together stand for: each takes its share of the contact law per length.

    Raises
    ------
    SpecError
        If mass or inertia are impossible, naming the body and the number.

    Examples
    --------
    >>> roller = RigidBody("roller", 12.0, (0.3, 0.3, 0.24), (0.0, 0.4, 0.0))
    >>> roller.J.diagonal().tolist()
    [0.3, 0.3, 0.24]
    """

    name: str
    mass: float
    inertia: ArrayLike
    position: ArrayLike
    rotation: ArrayLike = (0.0, 0.0, 0.0)
    velocity: ArrayLike = (0.0, 0.0, 0.0)
    spin: ArrayLike = (0.0, 0.0, 0.0)
    force: ArrayLike = (0.0, 0.0, 0.0)
    points: ArrayLike = ()
    contact_length: float = 0.0
    J: Array = field(init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        J = np.asarray(self.inertia, dtype=float)
        J = np.diag(J) if J.shape == (3,) else J
        object.__setattr__(self, "J", J)
        where = f"body {self.name!r}"
        if not 0 < self.mass < np.inf:
            raise SpecError(f"{where}: its mass is {self.mass:g} kg; a body needs a positive one.")
        if J.shape != (3, 3) or not np.allclose(J, J.T, rtol=1e-9, atol=0):
            raise SpecError(f"{where}: its inertia must be three numbers or a symmetric 3 x 3 matrix.")
        self._check_inertia(where, J)
        for name in ("position", "rotation", "velocity", "spin", "force"):
            value = np.asarray(getattr(self, name), dtype=float)
            if value.shape != (3,) or not np.isfinite(value).all():
                raise SpecError(f"{where}: its {name} must be three finite numbers, found {value.tolist()}.")
        points = self.contact_points
        if points.ndim != 2 or points.shape[1] != 3:
            raise SpecError(f"{where}: its contact points must have shape (k, 3), found {points.shape}.")
        if len(points) and not self.contact_length > 0:
            raise SpecError(
                f"{where} has {len(points)} contact points and a contact length of {self.contact_length:g} m; "
                "give the length of cable that they stand for."
            )

    @staticmethod
    def _check_inertia(where: str, J: Array) -> None:
        principal = np.linalg.eigvalsh(J)
        text = ", ".join(f"{x:g}" for x in principal)
        if not principal[0] > 0:
            raise SpecError(f"{where}: its principal moments of inertia are {text} kg m^2; they must be positive.")
        if principal[2] > (principal[0] + principal[1]) * (1 + 1e-9):
            raise SpecError(
                f"{where}: its principal moments of inertia are {text} kg m^2; no mass distribution has one larger than "
                "the sum of the other two."
            )

    @property
    def contact_points(self) -> Array:
        """Contact points (k, 3) in the body's axes [m]."""
        points = np.asarray(self.points, dtype=float)
        return points.reshape(0, 3) if points.size == 0 else points


@inlined
def turning_force(x: Array, v: Array, a: Array, J: Array, f: Array) -> float:
    """Write the inertia force on the rotation vector into `f` (3,); `x`, `v`, `a` (3,). Returns the energy of turning [J]."""
    p2 = x[0] * x[0] + x[1] * x[1] + x[2] * x[2]
    _, b, c, db, dc = rotation_coefficients(p2)
    t0, t1, t2, r0, r1, r2 = x[0], x[1], x[2], v[0], v[1], v[2]
    s0, s1, s2 = t1 * r2 - t2 * r1, t2 * r0 - t0 * r2, t0 * r1 - t1 * r0
    z0, z1, z2 = t1 * s2 - t2 * s1, t2 * s0 - t0 * s2, t0 * s1 - t1 * s0
    w0, w1, w2 = r0 - b * s0 + c * z0, r1 - b * s1 + c * z1, r2 - b * s2 + c * z2
    a0, a1, a2 = a[0], a[1], a[2]
    k0, k1, k2 = t1 * a2 - t2 * a1, t2 * a0 - t0 * a2, t0 * a1 - t1 * a0
    twice = 2.0 * (t0 * r0 + t1 * r1 + t2 * r2)
    bt, ct = db * twice, dc * twice
    g0 = a0 - b * k0 + c * (t1 * k2 - t2 * k1) - bt * s0 + ct * z0 + c * (r1 * s2 - r2 * s1)
    g1 = a1 - b * k1 + c * (t2 * k0 - t0 * k2) - bt * s1 + ct * z1 + c * (r2 * s0 - r0 * s2)
    g2 = a2 - b * k2 + c * (t0 * k1 - t1 * k0) - bt * s2 + ct * z2 + c * (r0 * s1 - r1 * s0)
    h0 = J[0, 0] * w0 + J[0, 1] * w1 + J[0, 2] * w2
    h1 = J[1, 0] * w0 + J[1, 1] * w1 + J[1, 2] * w2
    h2 = J[2, 0] * w0 + J[2, 1] * w1 + J[2, 2] * w2
    m0 = J[0, 0] * g0 + J[0, 1] * g1 + J[0, 2] * g2 + (w1 * h2 - w2 * h1)
    m1 = J[1, 0] * g0 + J[1, 1] * g1 + J[1, 2] * g2 + (w2 * h0 - w0 * h2)
    m2 = J[2, 0] * g0 + J[2, 1] * g1 + J[2, 2] * g2 + (w0 * h1 - w1 * h0)
    s0, s1, s2 = t1 * m2 - t2 * m1, t2 * m0 - t0 * m2, t0 * m1 - t1 * m0
    f[0] = m0 + b * s0 + c * (t1 * s2 - t2 * s1)
    f[1] = m1 + b * s1 + c * (t2 * s0 - t0 * s2)
    f[2] = m2 + b * s2 + c * (t0 * s1 - t1 * s0)
    return 0.5 * (w0 * h0 + w1 * h1 + w2 * h2)


@kernel
def turning(x: Array, v: Array, a: Array, J: Array, f: Array) -> float:
    """:func:`turning_force` as a kernel of its own."""
    return turning_force(x, v, a, J, f)


@kernel
def body_inertia(q: Array, v: Array, a: Array, begin: int, mass: Array, J: Array, F: Array) -> float:
    """Add the inertia forces of the bodies, whose rows start at `begin`, to `F`. Returns their kinetic energy [J]."""
    f, kinetic = np.empty(3), 0.0
    for k in range(mass.size):
        i = begin + k
        for c in range(3):
            F[i, c] += mass[k] * a[i, c]
            kinetic += 0.5 * mass[k] * v[i, c] * v[i, c]
        kinetic += turning(q[i, 6:9], v[i, 6:9], a[i, 6:9], J[k], f)
        for c in range(3):
            F[i, 6 + c] += f[c]
    return kinetic


@kernel
def body_inertia_tangent(
    q: Array, v: Array, a: Array, factor: float, factor_a: float, begin: int, mass: Array, J: Array, D: Array
) -> None:
    """Add d/dq + factor d/dv + factor_a d/da of :func:`body_inertia` to the diagonal blocks `D`."""
    f0, f = np.empty(3), np.empty(3)
    x, u, w = np.empty(3), np.empty(3), np.empty(3)
    for k in range(mass.size):
        i = begin + k
        turning(q[i, 6:9], v[i, 6:9], a[i, 6:9], J[k], f0)
        for c in range(3):
            D[i, c, c] += factor_a * mass[k]
            for s in range(3):
                step = STEP if s == c else 0.0
                x[s], u[s], w[s] = q[i, 6 + s] + step, v[i, 6 + s] + factor * step, a[i, 6 + s] + factor_a * step
            turning(x, u, w, J[k], f)
            for s in range(3):
                D[i, 6 + s, 6 + c] += (f[s] - f0[s]) / STEP

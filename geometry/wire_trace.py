r"""Trace of a round wire in a plane normal to the cable axis.

A tube of radius rho about a helix of radius r with turn rate tau = 2 pi / pitch (signed) is cut by z = 0. A point of the
tube belongs to a circle, polar angle phi, in the plane normal to the centre line; following the helical motion down
to z = 0 gives the exact closed curve, with beta = atan(tau r), s = sin beta, c = cos beta,

.. math::  (X, Y) = R_z(\tau \rho s \sin\phi)\,(r + \rho \cos\phi,\; \rho\, c \sin\phi) .

(The circle point lies at height rho s sin phi *below* the plane of its centre, hence the sign of the turn.) To first order
it is an ellipse with semi-axis rho / c along the tangent; a circle instead is not a round wire and loses a fifth of the
axial stiffness at 32 degrees.

Its area is exactly pi rho^2 / c: by Pappus' theorem the tube has the volume pi rho^2 per arc length, and all its sections
z = const are congruent. It needs rho < r / s^2, the radius of curvature.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.errors import GeometryError


@dataclass(frozen=True)
class WireTrace:
    """Closed curve in which a tube cuts the plane z = 0; a circle when `centre_radius` or `twist_rate` is zero.

    Parameters
    ----------
    centre_radius : r [m] of the centre-line helix
    phase : angle [rad] of its centre in the plane
    radius : rho [m] of the tube, in its own normal plane
    twist_rate : tau [rad/m], signed, positive for a right-handed lay

    Raises
    ------
    GeometryError
        If the tube is not thinner than the radius of curvature of its centre line.
    """

    centre_radius: float
    phase: float
    radius: float
    twist_rate: float

    def __post_init__(self) -> None:
        if not self.radius > 0:
            raise GeometryError(f"a round wire needs a positive radius, found {self.radius:g} m.")
        bend = self.centre_radius * self.twist_rate**2 / (1 + (self.centre_radius * self.twist_rate) ** 2)
        if self.radius * bend >= 1:
            raise GeometryError(
                f"a wire of radius {self.radius * 1e3:.3g} mm cannot be laid on a helix whose radius of curvature is "
                f"{1e3 / bend:.3g} mm: lengthen the lay of {2e3 * np.pi / abs(self.twist_rate):.4g} mm."
            )

    @property
    def lay_angle(self) -> float:
        """beta = atan(tau r) [rad], signed as the lay."""
        return float(np.arctan(self.twist_rate * self.centre_radius))

    @property
    def area(self) -> float:
        """pi rho^2 / cos beta [m^2], exact."""
        return float(np.pi * self.radius**2 / np.cos(self.lay_angle))

    def point(self, phi: ArrayLike) -> NDArray[np.float64]:
        """Points (..., 2) [m] of the trace at the polar angles phi [rad] of the wire's own normal plane.

        phi = 0 points away from the cable axis, phi = pi towards it.
        """
        phi = np.asarray(phi, dtype=float)
        s, c = np.sin(self.lay_angle), np.cos(self.lay_angle)
        turn = self.twist_rate * self.radius * s * np.sin(phi) + self.phase
        u, v = self.centre_radius + self.radius * np.cos(phi), self.radius * c * np.sin(phi)
        return np.stack([np.cos(turn) * u - np.sin(turn) * v, np.sin(turn) * u + np.cos(turn) * v], axis=-1)

    def derivative(self, phi: ArrayLike) -> NDArray[np.float64]:
        """d point / d phi, shape (..., 2) [m]."""
        phi = np.asarray(phi, dtype=float)
        s, c = np.sin(self.lay_angle), np.cos(self.lay_angle)
        rate = self.twist_rate * self.radius * s
        turn = rate * np.sin(phi) + self.phase
        u, v = self.centre_radius + self.radius * np.cos(phi), self.radius * c * np.sin(phi)
        du = -self.radius * np.sin(phi) - rate * np.cos(phi) * v
        dv = self.radius * c * np.cos(phi) + rate * np.cos(phi) * u
        return np.stack([np.cos(turn) * du - np.sin(turn) * dv, np.sin(turn) * du + np.cos(turn) * dv], axis=-1)

    def curvature(self, phi: float, step: float = 1e-4) -> float:
        """Curvature [1/m] of the curve, by differences of its slope; positive where it bulges."""
        (x, y), (u, v) = self.derivative(phi), (self.derivative(phi + step) - self.derivative(phi - step)) / (2 * step)
        return float((x * v - y * u) / np.hypot(x, y) ** 3)

    def nearest(self, points: ArrayLike) -> NDArray[np.float64]:
        """Angles phi, shape (n,), of the curve points nearest to `points` (n, 2): table search, then Newton steps."""
        points = np.atleast_2d(np.asarray(points, dtype=float))
        table = np.linspace(0, 2 * np.pi, 256, endpoint=False)
        nodes = self.point(table)
        phi = table[((points[:, None, :] - nodes) ** 2).sum(-1).argmin(1)]
        for _ in range(4):
            gap, slope = self.point(phi) - points, self.derivative(phi)
            bend = (self.derivative(phi + 1e-5) - self.derivative(phi - 1e-5)) / 2e-5
            step = (gap * slope).sum(-1) / np.maximum((slope**2).sum(-1) + (gap * bend).sum(-1), 1e-3 * self.radius**2)
            phi = phi - np.clip(step, -0.05, 0.05)
        return phi

    def moments(self, samples: int = 256) -> NDArray[np.float64]:
        """Area, first and second moments (A, Sx, Sy, Sxx, Syy, Sxy) = integral of (1, x, y, x^2, y^2, x y) dA, shape (6,).

        Green's theorem over the curve; the trapezoidal rule converges faster than any power of `samples`.
        """
        phi = np.linspace(0, 2 * np.pi, samples, endpoint=False)
        (x, y), (dx, dy) = self.point(phi).T, self.derivative(phi).T
        cross = (x * dy - y * dx) * (2 * np.pi / samples)
        weights = [0.5 * np.ones_like(x), x / 3, y / 3, x * x / 4, y * y / 4, x * y / 4]
        return np.array([(w * cross).sum() for w in weights])

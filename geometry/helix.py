r"""A helix about the z axis: the centre line of a wire, a strand or a core.

With radius r, pitch p > 0, hand h = +1 (Z, right-handed) or -1 (S, left-handed) and phase phi0::

    x = r cos(h 2 pi z / p + phi0),   y = r sin(h 2 pi z / p + phi0),   z = z,

formula (1) of Ge et al., PLoS ONE 18(2) e0281136 (2023), written over z. With the lay angle
beta = atan(2 pi r / p) the invariants are: arc length per height 1 / cos beta, curvature sin^2 beta / r,
torsion h sin beta cos beta / r (do Carmo, Differential Geometry of Curves and Surfaces, section 1.5).
The frame of parallel transport (Bishop, Amer. Math. Monthly 82 (1975) 246-251, doi 10.2307/2319846) turns
back against the torsion: e1 + i e2 = (N + i B) exp(i torsion s).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.errors import GeometryError

HANDS = {"Z": 1, "S": -1}


def lay_angle(radius: float, pitch: float | None) -> float:
    """Angle [rad] between a helix and its axis: atan(2 pi radius / pitch); zero for a straight member (pitch None).

    >>> round(float(np.degrees(lay_angle(11.625e-3, 234e-3))), 2)
    17.34
    """
    return 0.0 if pitch is None else float(np.arctan(2 * np.pi * radius / pitch))


@dataclass(frozen=True)
class Helix:
    """Helix of `radius` [m] and `pitch` [m] about z; `hand` "Z" (right) or "S" (left), `phase` [rad] at z = 0.

    A `radius` of zero is the axis itself. All functions of z broadcast: z of shape (...) gives (..., 3).

    Raises
    ------
    GeometryError
        If the radius is negative, the pitch not positive, or the hand unknown.

    Examples
    --------
    >>> core = Helix(radius=11.625e-3, pitch=234e-3)
    >>> round(core.length(0.234), 6)
    0.245135
    """

    radius: float
    pitch: float
    hand: str = "Z"
    phase: float = 0.0

    def __post_init__(self) -> None:
        if not (np.isfinite(self.radius) and self.radius >= 0):
            raise GeometryError(f"the radius of a helix must not be negative, found {self.radius:g} m.")
        if not (np.isfinite(self.pitch) and self.pitch > 0):
            raise GeometryError(
                f"the pitch of a helix must be positive, found {self.pitch:g} m; give the hand as Z or S instead of a sign."
            )
        if self.hand not in HANDS:
            raise GeometryError(f'the hand of a helix is "Z" (right) or "S" (left), found "{self.hand}".')

    @property
    def sign(self) -> int:
        """+1 for Z (right-handed), -1 for S."""
        return HANDS[self.hand]

    @property
    def turn_rate(self) -> float:
        """Angle about z per height [rad/m], signed."""
        return self.sign * 2 * np.pi / self.pitch

    @property
    def lay_angle(self) -> float:
        """beta = atan(2 pi r / p) [rad], between the helix and its axis."""
        return lay_angle(self.radius, self.pitch)

    @property
    def curvature(self) -> float:
        """sin^2 beta / r [1/m]."""
        w = 2 * np.pi / self.pitch
        return float(self.radius * w**2 / (1 + (self.radius * w) ** 2))

    @property
    def torsion(self) -> float:
        """h sin beta cos beta / r [1/m], positive for a right-handed helix."""
        w = 2 * np.pi / self.pitch
        return float(self.sign * w / (1 + (self.radius * w) ** 2))

    def lay_ratio(self, diameter: float) -> float:
        """Pitch over a stated diameter [m], usually the diameter over the layer."""
        return self.pitch / diameter

    def length(self, height: float) -> float:
        """Arc length [m] of the helix over a height [m]: height / cos beta."""
        return height / float(np.cos(self.lay_angle))

    def position(self, z: ArrayLike) -> NDArray[np.float64]:
        """Points (..., 3) [m] at heights z [m]."""
        z = np.asarray(z, dtype=float)
        angle = self.turn_rate * z + self.phase
        return np.stack([self.radius * np.cos(angle), self.radius * np.sin(angle), z], axis=-1)

    def tangent(self, z: ArrayLike) -> NDArray[np.float64]:
        """Unit tangents (..., 3), along growing z."""
        return self.frenet_frame(z)[..., 0, :]

    def frenet_frame(self, z: ArrayLike) -> NDArray[np.float64]:
        """Tangent, principal normal (towards the axis) and binormal as rows, shape (..., 3, 3)."""
        z = np.asarray(z, dtype=float)
        angle = self.turn_rate * z + self.phase
        c, s, zero = np.cos(angle), np.sin(angle), np.zeros_like(angle)
        sb, cb = self.sign * np.sin(self.lay_angle), np.cos(self.lay_angle)
        T = np.stack([-sb * s, sb * c, zero + cb], axis=-1)
        N = np.stack([-c, -s, zero], axis=-1)
        return np.stack([T, N, np.cross(T, N)], axis=-2)

    def transported_frame(self, z: ArrayLike) -> NDArray[np.float64]:
        """Tangent and the two normals e1, e2 that do not turn about it, as rows, shape (..., 3, 3).

        At z = 0, e1 = N and e2 = B. The change of e1 and e2 along the helix is along the tangent only.
        """
        z = np.asarray(z, dtype=float)
        T, N, B = np.moveaxis(self.frenet_frame(z), -2, 0)
        turn = (self.torsion * z / np.cos(self.lay_angle))[..., None]
        return np.stack([T, np.cos(turn) * N - np.sin(turn) * B, np.sin(turn) * N + np.cos(turn) * B], axis=-2)

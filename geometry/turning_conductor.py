r"""A stranded conductor in the cell of a cable: its section, swept along the core helix while it turns.

A node at the polar coordinates (rho, phi0) of the section keeps them in a frame that turns by omega w against the core's own frame at the
station w of the centre line (bent_lay.py), as the strands do. In the plane z it stands at the angle phi of Kepler's equation
(slip_ring.py), with r, beta, tau of the core helix at

.. math::  R_z(\tau (z + \rho s \sin\phi) + \mathrm{phase})\,(r + \rho\cos\phi,\; \rho\, c \sin\phi),
           \qquad s = \sin\beta,\; c = \cos\beta .
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.cable import Part
from geometry.conductor_section import ConductorSection
from geometry.errors import MeshError
from geometry.slip_ring import kepler_angle
from geometry.strand import Conductor, layer_radii


@dataclass(frozen=True)
class TurningConductor:
    """Stranded conductor in a cell.

    Attributes
    ----------
    part : the part of the cable that it is
    make_up : strands and their layers
    turn_rate : omega [rad/m]
    section : its mesh
    layer_name : the part in which its slip ring runs
    hole_radius : radius of the hole of the host, the outside of the slip ring [m]
    """

    part: Part
    make_up: Conductor
    turn_rate: float
    section: ConductorSection
    layer_name: str
    hole_radius: float

    def steps(self, height: float) -> int:
        """Nodes of the slip ring by which the conductor slips over a height [m], signed."""
        return round(self.turn_rate * height * len(self.section.ring) / (2 * np.pi))

    def nodes(self, z: NDArray[np.float64]) -> NDArray[np.float64]:
        """Nodes of the section in the planes z (n,), shape (n, nodes, 3) [m]."""
        x, y = self.section.points.T
        return self.points(np.hypot(x, y), np.arctan2(y, x), z[:, None])

    def points(self, rho: ArrayLike, angle: ArrayLike, z: ArrayLike) -> NDArray[np.float64]:
        """Points (..., 3) [m] of the section's polar coordinates (rho, angle) in the planes z; the arguments broadcast."""
        z = np.asarray(z, dtype=float)
        r, tau = self.part.centre_radius, self.part.twist_rate
        beta = np.arctan(r * tau)
        s, c = np.sin(beta), np.cos(beta)
        rho = np.asarray(rho, dtype=float)
        phi = kepler_angle(np.asarray(angle) + self.turn_rate * z, self.turn_rate * rho * s)
        turn = tau * (z + rho * s * np.sin(phi)) + self.part.phase
        u, v = r + rho * np.cos(phi), rho * c * np.sin(phi)
        x, y = np.cos(turn) * u - np.sin(turn) * v, np.sin(turn) * u + np.cos(turn) * v
        return np.stack([x, y, np.broadcast_to(z, x.shape)], axis=-1)

    def strand_areas(self, height: float) -> NDArray[np.float64]:
        r"""Exact volume over height of every strand between z = 0 and the height [m^2], in the order of the layers.

        With a the radius of the strand's centre and kappa, torsion T of the core, the arc length per w is
        \sqrt{(1 + a \kappa \cos\phi)^2 + a^2 (\omega c + T)^2} / c, formula of nested_helix.py.
        """
        strand = self.make_up.strand
        assert strand is not None
        r, tau = self.part.centre_radius, self.part.twist_rate
        beta = np.arctan(r * tau)
        s, c = np.sin(beta), np.cos(beta)
        curvature = r * tau**2 * c**2
        areas = []
        for count, a in zip(
            self.make_up.layers, layer_radii(self.make_up.layers, strand.diameter, self.part.name), strict=True
        ):
            start = 2 * np.pi * np.arange(count) / count
            ends = [kepler_angle(start + self.turn_rate * z, self.turn_rate * a * s) for z in (0.0, height)]
            w = [z + a * s * np.sin(phi) for z, phi in zip((0.0, height), ends, strict=True)]
            x, weight = np.polynomial.legendre.leggauss(64)
            station = 0.5 * (w[0] + w[1])[:, None] + 0.5 * (w[1] - w[0])[:, None] * x
            phi = start[:, None] + self.turn_rate * station
            speed = np.hypot(1 + a * curvature * np.cos(phi), a * own_turn_rate(self.part, self.turn_rate)) / c
            areas.append(np.pi * strand.diameter**2 / 4 * 0.5 * (w[1] - w[0]) * (speed @ weight) / height)
        return np.concatenate(areas)

    def partners(self, height: float) -> NDArray[np.int64]:
        """Node of the bottom face whose place each node of the section takes in the top face.

        Raises
        ------
        MeshError
            If the section does not come to lie on itself.
        """
        from scipy.spatial import KDTree  # slow to load, needed here only

        angle = self.turn_rate * height
        x, y = self.section.points.T
        image = np.column_stack([np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y])
        distance, found = KDTree(self.section.points).query(image)
        if distance.max() > 1e-9 * self.part.outer_radius or len(np.unique(found)) < len(x):
            raise MeshError(
                f"{self.part.name} turned by {np.degrees(angle):.4g} degrees does not lie on itself: {1e3 * height:.6g} mm is not a period."
            )
        return np.asarray(found, dtype=np.int64)


def own_turn_rate(part: Part, turn_rate: float) -> float:
    """Turn rate of the strands per arc length of their conductor, in its frame of parallel transport [rad/m]: 2 pi / lay, signed.

    `turn_rate` is omega per height in the frame of the core (bent_lay.py).
    """
    c = np.cos(np.arctan(part.centre_radius * part.twist_rate))
    return float(turn_rate * c + part.twist_rate * c**2)

r"""Tension and torsion of a 1 + m strand (a straight core, m helical wires on it): three classical models, and its bending.

Lay angle beta from the axis, alpha = pi/2 - beta, helix radius r = R1 + R2; xi1 and xi2 the strains of core and wires, da and dr the
changes of the helix angle and of the helix radius. Kinematics, linear, wires that touch the core only:

.. math::
   \varepsilon = \xi_1 = \xi_2 + \frac{\Delta\alpha}{\tan\alpha}, \qquad
   r\tau = \frac{\xi_2}{\tan\alpha} - \Delta\alpha - \frac{\Delta r}{r \tan\alpha}, \qquad
   \Delta r = -\nu (R_1 \xi_1 + R_2 \xi_2) .

* :func:`costello`: forces and moments of each wire from the rod equations with strain measures per deformed length; the matrix is not
symmetric
  (G. A. Costello, Theory of Wire Rope, 2nd ed. 1997, chapter 3).
* :func:`energy_consistent`: the same kinematics with curvature and twist per initial length; the matrix is the Hessian of the energy
  and symmetric.
* :func:`with_contact`: the energy model whose wires also sink into the core, by delta, under the force p per length of the line of
  contact. A flat of half-width a yields

  .. math::
     \frac{d\delta}{dp} = \frac{2 (1 - \nu^2)}{\pi E} \left(\ln\frac{4 R_1}{a} + \ln\frac{4 R_2}{a} - 2\right) ,

  slope of Hertz's approach of two cylinders (K. L. Johnson, Contact Mechanics, 1985, section 5.6) at the load that gives a. It is 1 to 2 %
  of the stiffness of a strand at 17 deg, which the other models overlook.
* `contraction = False` leaves out the radial contraction (rigid sections), the stiffest of the three.

Bending: every wire a spring of Kirchhoff's rod (Costello), or EI cos beta (Papailiou, IEEE Trans. Power Deliv. 12 (1997) 1576-1588), when
they slide; and their EA r^2 cos^3 beta / 2 on top when they stick.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Strand16:
    """A straight core of radius `core` [m] with `wires` wires of radius `wire` [m] at lay angle `beta` [rad], one material."""

    core: float
    wire: float
    beta: float
    E: float
    nu: float
    wires: int = 6

    @property
    def helix_radius(self) -> float:
        """r = R1 + R2 [m]."""
        return self.core + self.wire

    @property
    def twist_rate(self) -> float:
        """2 pi / pitch [rad/m] of a right-handed lay."""
        return float(np.tan(self.beta) / self.helix_radius)

    @property
    def EA(self) -> float:
        """E times the metal area, all wires straight [N]."""
        return float(self.E * np.pi * (self.core**2 + self.wires * self.wire**2))


def _wire_motion(strand: Strand16, contraction: bool) -> FloatArray:
    """Rows xi2, da, dr per unit (eps, tau, sinking of a wire into the core), shape (3, 3)."""
    r, tan = strand.helix_radius, 1 / np.tan(strand.beta)
    nu = strand.nu if contraction else 0.0
    # unknowns xi2, da, dr of the three kinematic equations
    A = np.array([[1.0, 1 / tan, 0.0], [1 / tan, -1.0, -1 / (r * tan)], [nu * strand.wire, 0.0, 1.0]])
    b = np.array([[1.0, 0.0, 0.0], [0.0, r, 0.0], [-nu * strand.core, 0.0, -1.0]])
    return np.linalg.solve(A, b)


def _bend_and_twist(strand: Strand16, motion: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Changes of curvature and of twist of a wire per unit (eps, tau), per deformed length."""
    _, da, dr = motion
    r, s, c = strand.helix_radius, np.cos(strand.beta), np.sin(strand.beta)  # sine and cosine of alpha
    bend = -2 * s * c * da / r - c**2 * dr / r**2
    twist = (c**2 - s**2) * da / r - s * c * dr / r**2
    return bend, twist


def costello(strand: Strand16, contraction: bool = True) -> FloatArray:
    """[[kee, ket], [kte, ktt]] of (stretch, twist per length), shape (2, 2); N, N m, N m^2; not symmetric."""
    motion = _wire_motion(strand, contraction)[:, :2]
    bend, twist = _bend_and_twist(strand, motion)
    R1, R2, r, m, E, nu = strand.core, strand.wire, strand.helix_radius, strand.wires, strand.E, strand.nu
    s, c = np.cos(strand.beta), np.sin(strand.beta)
    G_wire = E * np.pi * R2**4 / 4 * bend
    H_wire = E * np.pi * R2**4 / (4 * (1 + nu)) * twist
    shear = H_wire * c**2 / r - G_wire * s * c / r
    tension = np.pi * R2**2 * E * motion[0]
    F = m * (tension * s + shear * c) + np.pi * R1**2 * E * np.array([1.0, 0.0])
    M = m * (H_wire * s + G_wire * c + tension * r * c - shear * r * s)
    M = M + E * np.pi * R1**4 / (4 * (1 + nu)) * np.array([0.0, 1.0])
    return np.array([F, M])


def energy_consistent(strand: Strand16, contraction: bool = True) -> FloatArray:
    """The symmetric stiffness, shape (2, 2): Hessian of the energy per length, strain measures per initial length."""
    return _energy(strand, contraction)[:2, :2]


def with_contact(strand: Strand16, half_width: float) -> FloatArray:
    """The energy model with the compliance of flats of the given half-width [m] between core and wires, shape (2, 2)."""
    R1, R2 = strand.core, strand.wire
    yielding = 2 * (1 - strand.nu**2) / (np.pi * strand.E)
    yielding *= np.log(4 * R1 / half_width) + np.log(4 * R2 / half_width) - 2
    W = _energy(strand, True)
    W[2, 2] += strand.wires * np.hypot(1, strand.twist_rate * R1) / yielding  # length of the lines of contact
    return W[:2, :2] - np.outer(W[:2, 2], W[2, :2]) / W[2, 2]


def contact_force(strand: Strand16, strain: float) -> float:
    """Force per length of the line of contact between a wire and the core [N/m], the strand stretched by `strain` without twist.

    Per length of wire it is the tension times the curvature, less the shear force times the twist of the wire (Costello, chapter 3).
    """
    motion = _wire_motion(strand, True)[:, 0] * strain
    bend, twist = _bend_and_twist(strand, motion)
    E, r, R2, s, c = strand.E, strand.helix_radius, strand.wire, np.cos(strand.beta), np.sin(strand.beta)
    moment, torque = E * np.pi * R2**4 / 4 * bend, E * np.pi * R2**4 / (4 * (1 + strand.nu)) * twist
    tension, shear = E * np.pi * R2**2 * motion[0], torque * c**2 / r - moment * s * c / r
    per_wire = tension * c**2 / r - shear * s * c / r
    return float(per_wire * np.hypot(1, strand.twist_rate * r) / np.hypot(1, strand.twist_rate * strand.core))


def _energy(strand: Strand16, contraction: bool) -> FloatArray:
    """Hessian of the energy per length by (eps, tau, sinking), without what resists the sinking at the contact, shape (3, 3)."""
    motion = _wire_motion(strand, contraction)
    bend, twist = _bend_and_twist(strand, motion)
    R1, R2, r, E, nu = strand.core, strand.wire, strand.helix_radius, strand.E, strand.nu
    s, c = np.cos(strand.beta), np.sin(strand.beta)
    xi = motion[0]
    bend, twist = bend + xi * c**2 / r, twist + xi * s * c / r
    area, inertia = np.pi * R2**2, np.pi * R2**4 / 4
    wire = E * area * np.outer(xi, xi) + E * inertia * (np.outer(bend, bend) + np.outer(twist, twist) / (1 + nu))
    core = np.diag([E * np.pi * R1**2, E * np.pi * R1**4 / (4 * (1 + nu)), 0.0])
    return core + strand.wires * wire / s  # a wire is 1 / sin(alpha) as long as the strand


def free_twist(K: FloatArray) -> float:
    """Axial stiffness [N] with ends free to rotate: kee - ket kte / ktt."""
    return float(K[0, 0] - K[0, 1] * K[1, 0] / K[1, 1])


def bending_slip(strand: Strand16) -> float:
    """EI [N m^2] of wires that slide freely, each a spring (Costello)."""
    own = strand.E * np.pi / 4
    sine = np.sin(strand.beta)
    spring = 2 * np.cos(strand.beta) / (2 + strand.nu * sine**2)
    return float(own * (strand.core**4 + strand.wires * strand.wire**4 * spring))


def bending_slip_papailiou(strand: Strand16) -> float:
    """EI [N m^2] of wires that slide freely, sum of EI cos beta."""
    return float(strand.E * np.pi / 4 * (strand.core**4 + strand.wires * strand.wire**4 * np.cos(strand.beta)))


def bending_stick(strand: Strand16) -> float:
    """EI [N m^2] of wires that stick: EI_min of Papailiou plus half the sum of E A r^2 cos^3 beta."""
    area = np.pi * strand.wire**2
    extra = 0.5 * strand.wires * strand.E * area * strand.helix_radius**2 * np.cos(strand.beta) ** 3
    return bending_slip_papailiou(strand) + float(extra)


def slip_curvatures(strand: Strand16, tension: float, friction: float) -> tuple[float, float]:
    """Curvatures [1/m] at which the first point of a wire slips, and all of it has slipped (one layer, Coulomb's law)."""
    E, b = strand.E, strand.beta
    wire, core = E * np.pi * strand.wire**2, E * np.pi * strand.core**2
    force = tension * wire * np.cos(b) ** 2 / (core + strand.wires * wire * np.cos(b) ** 3)
    lever = wire * np.cos(b) ** 2 * strand.helix_radius
    grip = friction * np.sin(b)
    return float(force * grip / lever), float(force * np.expm1(grip * np.pi / 2) / lever)

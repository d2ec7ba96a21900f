r"""A core bonded into a tube, pulled: Lame's exact solution.

.. math:: u_r = B_1 r \;(r \le a), \qquad u_r = B_2 r + C_2 / r \;(a \le r \le b), \qquad \varepsilon_z = 1 ,

with u_r and sigma_rr continuous at a and sigma_rr(b) = 0: three linear equations. Where the two Poisson's ratios differ the axial
stiffness exceeds the sum of E A; a nearly incompressible core in a stiff tube shows it most.

Source: G. Lame, Lecons sur la theorie mathematique de l'elasticite, 1852; S. Timoshenko, J. N. Goodier, Theory of Elasticity.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geometry.material import Material


@dataclass(frozen=True)
class CoaxialCylinder:
    """Materials of core and tube, radii a < b [m]."""

    core: Material
    tube: Material
    a: float
    b: float

    def constants(self) -> tuple[float, float, float]:
        """B1, B2 and C2 [m^2] at unit axial strain."""
        a, b = self.a, self.b
        l1, m1, l2, m2 = self.core.lame, self.core.G, self.tube.lame, self.tube.G
        A = np.array(
            [
                [a, -a, -1 / a],
                [2 * (l1 + m1), -2 * (l2 + m2), 2 * m2 / a**2],
                [0, 2 * (l2 + m2), -2 * m2 / b**2],
            ]
        )
        B1, B2, C2 = np.linalg.solve(A, [0, l2 - l1, -l2])
        return float(B1), float(B2), float(C2)

    def EA(self) -> float:
        """Axial force per axial strain [N]."""
        B1, B2, _ = self.constants()
        core = self.core.lame * (1 + 2 * B1) + 2 * self.core.G
        tube = self.tube.lame * (1 + 2 * B2) + 2 * self.tube.G
        return float(np.pi * (self.a**2 * core + (self.b**2 - self.a**2) * tube))

    def stress(self, radius: float) -> tuple[float, float, float]:
        """sigma_rr, sigma_tt, sigma_zz [Pa] at a radius, per unit axial strain."""
        B1, B2, C2 = self.constants()
        inside = radius < self.a
        material = self.core if inside else self.tube
        B, C = (B1, 0.0) if inside else (B2, C2)
        spherical = material.lame * (1 + 2 * B)
        swing = 2 * material.G * C / radius**2
        return (
            spherical + 2 * material.G * B - swing,
            spherical + 2 * material.G * B + swing,
            spherical + 2 * material.G,
        )

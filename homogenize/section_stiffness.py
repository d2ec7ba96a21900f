"""The 6x6 stiffness of a beam section, and the moduli that are derived from it.

Section forces theta and section strains psi, z along the cable::

    (T_x, T_y, N, M_x, M_y, M_z) = C (gamma_x, gamma_y, epsilon, kappa_x, kappa_y, tau)

gamma: shear, epsilon: stretch, kappa: curvature, tau: twist per length. C in N, N m, N m^2. A cable whose lay is
one-handed couples stretch and twist (C[2, 5]), so that it has no single "EA": with the twist blocked
EA = C[2, 2], with the ends free to rotate EA = C[2, 2] - C[2, 5]^2 / C[5, 5].
The moduli E = EA / A, G = GA / A name the reference area A that they were divided by.

Source of the order and sign: the section theory of Giavotto et al., Comput. Struct. 16 (1983) 403-413,
doi 10.1016/0045-7949(83)90179-7, with z as the beam axis.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.errors import SpecError

ORDER = ("gamma_x", "gamma_y", "epsilon", "kappa_x", "kappa_y", "tau")


@dataclass(frozen=True)
class SectionStiffness:
    """Symmetric positive definite 6x6 stiffness of a beam section and the area its moduli refer to.

    Parameters
    ----------
    C : (6, 6) array
        Order (gamma_x, gamma_y, epsilon, kappa_x, kappa_y, tau); N, N m and N m^2.
    area : float
        Reference area of the moduli [m^2].

    Raises
    ------
    SpecError
        If C is not a finite symmetric positive definite 6x6 matrix, or the area is not positive.

    Examples
    --------
    >>> bar = SectionStiffness.uncoupled(EA=21e6, GA_x=7e6, GA_y=7e6, EI_x=175.0, EI_y=175.0, GJ=113.0, area=1e-4)
    >>> round(bar.E_blocked_twist / 1e9, 6)
    210.0
    """

    C: NDArray[np.float64]
    area: float

    def __post_init__(self) -> None:
        C = np.array(self.C, dtype=float)
        if C.shape != (6, 6) or not np.isfinite(C).all():
            raise SpecError(f"a section stiffness must be a finite 6x6 matrix, found shape {C.shape}.")
        if not (np.isfinite(self.area) and self.area > 0):
            raise SpecError(f"the reference area of a section must be positive, found {self.area:g} m^2.")
        scale = np.sqrt(np.abs(np.diag(C)))
        if (np.diag(C) <= 0).any():
            i = int(np.argmin(np.diag(C)))
            raise SpecError(f"the section stiffness for {ORDER[i]} is {C[i, i]:g}; it must be positive.")
        skew = np.abs((C - C.T) / np.outer(scale, scale)).max()
        if skew > 1e-6:
            raise SpecError(
                f"a section stiffness must be symmetric; the largest difference is {skew:.1e} of the diagonal."
            )
        C = 0.5 * (C + C.T)
        if np.linalg.eigvalsh(C / np.outer(scale, scale)).min() <= 0:
            raise SpecError("the section stiffness is not positive definite: some section strain would release energy.")
        C.setflags(write=False)
        object.__setattr__(self, "C", C)

    @classmethod
    def uncoupled(
        cls, *, EA: float, GA_x: float, GA_y: float, EI_x: float, EI_y: float, GJ: float, area: float
    ) -> SectionStiffness:
        """Section without couplings: C = diag(GA_x, GA_y, EA, EI_x, EI_y, GJ)."""
        return cls(np.diag([GA_x, GA_y, EA, EI_x, EI_y, GJ]).astype(float), area)

    @classmethod
    def solid_circle(
        cls, *, E: float, G_yoz: float, G_xoz: float, diameter: float, shear_factor: float = 0.9
    ) -> SectionStiffness:
        """Solid circular section of diameter [m] with given moduli [Pa], as the equivalent beam of Ge et al. (2023).

        G_yoz goes with shear along x (plane of the published +-X tests), G_xoz with shear along y; GJ uses their mean,
        because the source does not say which one enters it.
        """
        area = np.pi * diameter**2 / 4
        inertia = np.pi * diameter**4 / 64
        return cls.uncoupled(
            EA=E * area,
            GA_x=shear_factor * G_yoz * area,
            GA_y=shear_factor * G_xoz * area,
            EI_x=E * inertia,
            EI_y=E * inertia,
            GJ=(G_yoz + G_xoz) * inertia,
            area=float(area),
        )

    @property
    def compliance(self) -> NDArray[np.float64]:
        """F = C^-1, shape (6, 6)."""
        return np.asarray(np.linalg.inv(self.C), dtype=float)

    @property
    def EA_blocked_twist(self) -> float:
        """C[2, 2] [N]: axial stiffness when nothing but stretch is allowed."""
        return float(self.C[2, 2])

    @property
    def EA_free_twist(self) -> float:
        """C[2, 2] - C[2, 5]^2 / C[5, 5] [N]: axial stiffness when the ends may rotate (no torque)."""
        return float(self.C[2, 2] - self.C[2, 5] ** 2 / self.C[5, 5])

    @property
    def coupling(self) -> float:
        """C[2, 5] [N m]: torque per unit stretch, equal to the force per unit twist."""
        return float(self.C[2, 5])

    @property
    def GJ(self) -> float:
        """C[5, 5] [N m^2]: torsional stiffness at blocked stretch."""
        return float(self.C[5, 5])

    @property
    def EI_x(self) -> float:
        """1 / F[3, 3] [N m^2]: moment over curvature about x under a pure constant moment."""
        return float(1.0 / self.compliance[3, 3])

    @property
    def EI_y(self) -> float:
        """1 / F[4, 4] [N m^2]: moment over curvature about y under a pure constant moment."""
        return float(1.0 / self.compliance[4, 4])

    @property
    def GA_x(self) -> float:
        """1 / F[0, 0] [N]: shear force over shear along x, the other section forces being zero."""
        return float(1.0 / self.compliance[0, 0])

    @property
    def GA_y(self) -> float:
        """1 / F[1, 1] [N]: shear force over shear along y, the other section forces being zero."""
        return float(1.0 / self.compliance[1, 1])

    @property
    def E_blocked_twist(self) -> float:
        """EA_blocked_twist / area [Pa]."""
        return self.EA_blocked_twist / self.area

    @property
    def E_free_twist(self) -> float:
        """EA_free_twist / area [Pa]."""
        return self.EA_free_twist / self.area

    def turned(self, angle: float) -> SectionStiffness:
        """The same section after a turn by `angle` [rad] about z, in the axes that did not turn."""
        c, s = np.cos(angle), np.sin(angle)
        R = np.eye(6)
        for i in (0, 3):
            R[i : i + 2, i : i + 2] = [[c, -s], [s, c]]
        return SectionStiffness(R @ self.C @ R.T, self.area)


def pitch_average(section: SectionStiffness, stations: int = 8) -> SectionStiffness:
    """Stiffness for beam elements longer than a pitch: the **compliance** averaged over all angles of the section.

    Section forces, not strains, vary smoothly along the cable, so compliances add. The entries are harmonics of the
    angle up to the second, for which eight equal steps are exact.
    """
    F = [section.turned(2 * np.pi * k / stations).compliance for k in range(stations)]
    C = np.linalg.inv(np.mean(F, axis=0))
    return SectionStiffness(0.5 * (C + C.T), section.area)


@dataclass(frozen=True)
class SectionInertia:
    """Mass per length [kg/m] and rotary inertia per length [kg m] about x, y (bending) and z (spin)."""

    mass_per_length: float
    J_x: float
    J_y: float
    J_z: float

    def __post_init__(self) -> None:
        values: ArrayLike = (self.mass_per_length, self.J_x, self.J_y, self.J_z)
        if not (np.isfinite(values).all() and np.min(values) > 0):
            raise SpecError(f"mass per length and rotary inertia must be positive, found {values}.")

    @classmethod
    def solid_circle(cls, mass_per_length: float, diameter: float) -> SectionInertia:
        """Mass spread evenly over a circle of `diameter` [m]: J_x = J_y = m d^2 / 16, J_z = m d^2 / 8."""
        j = mass_per_length * diameter**2 / 16
        return cls(mass_per_length, j, j, 2 * j)

"""Stresses of the round section against beam theory: resultants, equilibrium, a surface free of traction, plane sections."""

import numpy as np
import pytest

from beam.section_stress import largest_normal_stress, point_strains, point_stresses
from geometry.errors import InputError

D, R = 0.04, 0.02
S = np.array([300.0, 70.0, -50.0, 2.0, 3.0, -4.0])


def disc(radial=12, around=24):
    """Quadrature of the disc, exact for the quartic integrands below: y, z, weights."""
    x, w = np.polynomial.legendre.leggauss(radial)
    r, wr = R * (x + 1) / 2, w * R / 2
    a = 2 * np.pi * np.arange(around) / around
    y, z = np.outer(r, np.cos(a)), np.outer(r, np.sin(a))
    return y.ravel(), z.ravel(), np.outer(wr * r, np.full(around, 2 * np.pi / around)).ravel()


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
def test_stresses_add_up_to_the_section_forces(poisson):
    """Integrals of sigma, tau and their moments are N, Q2, Q3, M1, M2, M3 (quadrature is exact: round-off)."""
    y, z, w = disc()
    sigma, t2, t3 = point_stresses(np.tile(S, (y.size, 1)), y, z, D, poisson).T
    found = [w @ sigma, w @ t2, w @ t3, w @ (y * t3 - z * t2), w @ (z * sigma), -w @ (y * sigma)]
    np.testing.assert_allclose(found, S, rtol=1e-12)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
def test_surface_is_free_of_traction(poisson):
    """tau . n = 0 on the rim."""
    a = np.linspace(0, 2 * np.pi, 17)
    y, z = R * np.cos(a), R * np.sin(a)
    _, t2, t3 = point_stresses(np.tile(S, (a.size, 1)), y, z, D, poisson).T
    np.testing.assert_allclose(t2 * np.cos(a) + t3 * np.sin(a), 0, rtol=0, atol=1e-9 * np.hypot(t2, t3).max())


def test_stresses_are_in_equilibrium_along_the_beam():
    """d sigma/dx + div tau = 0 with M2' = Q3 and M3' = -Q2, as shear forces of a straight unloaded beam demand."""
    h, y, z = 1e-5, 0.004, -0.007

    def at(y, z):
        return point_stresses(S, y, z, D)

    along = np.array([0.0, 0, 0, 0, S[2], -S[1]])
    growth = point_stresses(along, y, z, D)[0]
    spread = (at(y + h, z)[1] - at(y - h, z)[1] + at(y, z + h)[2] - at(y, z - h)[2]) / (2 * h)
    assert growth + spread == pytest.approx(0, abs=1e-6 * abs(growth))


def test_largest_shear_of_a_circle():
    """Timoshenko: tau at the centre is (3 + 2 nu) / (2 (1 + nu)) Q / A, 1.38 Q/A with nu = 0.3."""
    tau = point_stresses(np.array([0, 100.0, 0, 0, 0, 0]), 0.0, 0.0, D, 0.3)[1]
    assert tau * np.pi * R**2 / 100 == pytest.approx(1.38, abs=5e-3)


def test_largest_normal_stress_is_on_the_rim():
    """N/A +- |M|/W, against the points of the rim (720 of them: the cosine of a quarter of a degree is 1 - 1e-5)."""
    a = np.linspace(0, 2 * np.pi, 721)
    sigma = point_stresses(np.tile(S, (a.size, 1)), R * np.cos(a), R * np.sin(a), D)[:, 0]
    high, low = largest_normal_stress(S, D)
    assert high == pytest.approx(sigma.max(), rel=1e-5) and low == pytest.approx(sigma.min(), rel=1e-5)


def test_strains_are_those_of_a_plane_section():
    """The derivative by arc length of r + R (y e2 + z e3), seen in the section, minus that of the straight rod."""
    from beam.rotation_vector import rotation_matrix

    E = np.array([0.01, 0.02, -0.03, 0.4, -0.5, 0.6])
    y, z, h = 0.3, -0.2, 1e-6
    Rm, Rp = (
        rotation_matrix(-h * E[3:]),
        rotation_matrix(h * E[3:]),
    )  # rotation of a section at -h and +h, to second order
    centre = 2 * h * (E[:3] + np.array([1.0, 0, 0]))
    change = (centre + (Rp - Rm) @ np.array([0, y, z])) / (2 * h) - np.array([1.0, 0, 0])
    np.testing.assert_allclose(point_strains(E, y, z), change, rtol=0, atol=1e-9)


def test_points_outside_the_section_are_refused():
    """One sentence with both lengths."""
    with pytest.raises(InputError, match=r"25 mm from the centre lies outside the section of radius 20 mm"):
        point_stresses(S, 0.025, 0.0, D)
    with pytest.raises(InputError, match="Poisson"):
        point_stresses(S, 0.0, 0.0, D, poisson=0.7)

"""Straight bars: the 6x6 stiffness of BECAS, GXBeam and ANBA4 (verification cases T1) and the closed forms of Saint-Venant."""

import numpy as np
import pytest
from section_meshes import rectangle, rings

from homogenize import solve_helical_cell


def test_square_bar_has_saint_venants_constants():
    """EA = E A, EI = E a^4 / 12 exactly; GJ = 0.1405770 G a^4; shear coefficient of the energy definition."""
    a, E, nu = 0.1, 100.0, 0.2
    C = solve_helical_cell(rectangle(16, 16, a, a, (E, nu))).stiffness.C
    G = E / (2 * (1 + nu))
    np.testing.assert_allclose(np.diag(C)[2:5], [E * a**2, E * a**4 / 12, E * a**4 / 12], rtol=1e-10)
    np.testing.assert_allclose(C[5, 5], 0.1405770 * G * a**4, rtol=1e-4)  # quadratic elements, h = a/16: 2e-5
    np.testing.assert_allclose(np.diag(C)[:2], 0.34899, rtol=1e-2)  # BECAS user guide, 10 x 10 linear quads
    np.testing.assert_allclose(C - np.diag(np.diag(C)), 0, atol=1e-6)


def test_unit_square_matches_anba4():
    """ANBA4 unit test: E 1, nu 0.33: GA 0.311064, EA 1, EI 0.0833333, GJ 0.0528559."""
    C = solve_helical_cell(rectangle(12, 12, 1.0, 1.0, (1.0, 0.33))).stiffness.C
    np.testing.assert_allclose(np.diag(C), [0.311064, 0.311064, 1.0, 1 / 12, 1 / 12, 0.0528559], rtol=1e-3)


def test_two_material_square_has_the_signs_and_values_of_becas():
    """BECAS S2, E 100 for x < 0 and 10 for x > 0: couplings K35 (stretch-bending) and K26 (shear-twist) with their signs."""
    C = solve_helical_cell(rectangle(10, 10, 0.1, 0.1, (100.0, 0.2), (10.0, 0.2), split_x=0.0)).stiffness.C
    expected = {(0, 0): 0.128, (1, 1): 0.192, (2, 2): 0.550, (3, 3): 4.59e-4, (4, 4): 4.59e-4, (5, 5): 2.77e-4}
    expected |= {(1, 5): -3.93e-3, (2, 4): 1.13e-2}
    for (i, j), value in expected.items():
        assert C[i, j] == pytest.approx(value, rel=1.5e-2), (i, j)  # the source used 10 x 10 linear quads


def test_tube_matches_becas():
    """BECAS C1: tube R 0.1, t 0.01, E 100, nu 0.2 (its radius is the outer one; EA exact 0.5969)."""
    C = solve_helical_cell(rings((0.09, 0.10), (100.0, 0.2), around=48)).stiffness.C
    E, G = 100.0, 100 / 2.4
    area, inertia = np.pi * (0.1**2 - 0.09**2), np.pi * (0.1**4 - 0.09**4) / 4
    np.testing.assert_allclose(np.diag(C)[2:], [E * area, E * inertia, E * inertia, 2 * G * inertia], rtol=1e-5)
    np.testing.assert_allclose(np.diag(C)[:2], 0.1249, rtol=1e-2)


def test_thick_tube_has_the_exact_torsion():
    """R 0.3, inner 0.1, E 73 GPa, nu 0.33: EA 1.835e10, GA 4.682e9, EI 4.587e8, GJ 3.449e8 (exact)."""
    C = solve_helical_cell(rings((0.1, 0.3), (73e9, 0.33), per_ring=6, around=48)).stiffness.C
    np.testing.assert_allclose(np.diag(C), [4.682e9, 4.682e9, 1.835e10, 4.587e8, 4.587e8, 3.449e8], rtol=1e-3)

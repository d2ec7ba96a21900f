"""Lame's bonded core and tube: exact EA with Poisson mismatch, up to nu = 0.4999 without locking (verification case T3)."""

import numpy as np
import pytest

from geometry.material import Material
from homogenize.benchmark_cylinder import COAXIAL, coaxial_cylinder
from homogenize.coaxial_cylinder import CoaxialCylinder


@pytest.mark.parametrize("row", range(len(COAXIAL)))
@pytest.mark.parametrize("pitch", [np.inf, 60.0])
def test_axial_stiffness_is_lames(row, pitch):
    """EA to 2e-6 at any pitch; the printed values are reproduced by the closed form first."""
    assert not [b.sentence() for b in coaxial_cylinder(row, pitch) if not b.passed]


def test_lames_solution_obeys_its_own_equations():
    """sigma_rr is continuous at a and zero at b; the resultant of sigma_zz is EA (midpoint rule, 1e-6)."""
    bar = CoaxialCylinder(Material("core", 8.0, 0.49, 1.0), Material("tube", 80.0, 0.34, 1.0), 5.0, 10.0)
    inside, outside = bar.stress(5.0 - 1e-9)[0], bar.stress(5.0)[0]
    assert inside == pytest.approx(outside, rel=1e-8)
    assert bar.stress(10.0)[0] == pytest.approx(0.0, abs=1e-12)
    edges = np.concatenate([np.linspace(0, 5, 1001), np.linspace(5, 10, 1001)[1:]])
    middle = 0.5 * (edges[1:] + edges[:-1])
    total = sum(2 * np.pi * r * bar.stress(float(r))[2] * w for r, w in zip(middle, np.diff(edges)))
    assert total == pytest.approx(bar.EA(), rel=1e-6)

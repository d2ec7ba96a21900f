"""Many thin members in rubber: the cell goes to the ring of members as 1 / n, and to the rubber law where the ring is the surface (T12)."""

import numpy as np
import pytest

from geometry.material import Material
from homogenize.benchmark_cables import axial_stiffness
from homogenize.benchmark_rubber_ring import rubber_ring_cases, thin_members
from homogenize.rubber_filled_cable import RubberFilledCable, RubberRing


@pytest.mark.parametrize("case", rubber_ring_cases(), ids=str)
def test_thin_members(case):
    """Every row: monotone, below the ring, extra compliance halving, limit within 0.5 % (the next term, 1 / n^2)."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]


@pytest.mark.parametrize("nu", [0.3, 0.45, 0.499])
def test_rubber_without_members_is_a_bar(nu):
    """No members: E A of the whole cylinder, inner disc and outer tube joined (exact)."""
    rubber = Material("rubber", 8e6, nu, 1000.0)
    assert RubberRing(0.0, 16e-3, 0.2, rubber, 34e-3).EA() == pytest.approx(8e6 * np.pi * 34e-3**2, rel=1e-10)


@pytest.mark.parametrize("degrees", [5.0, 10.0, 17.2, 25.0])
def test_ring_lies_between_its_inside_and_even_strain(degrees):
    """Even strain is one of the fields that the ring may choose (upper bound); the rubber outside can only add (lower bound)."""
    rubber, beta = Material("rubber", 8e6, 0.45, 1000.0), np.radians(degrees)
    inside, even = (RubberFilledCable(26.8e6, 16e-3, beta, rubber, np.pi * R**2) for R in (16e-3, 34e-3))
    ring = RubberRing(26.8e6, 16e-3, beta, rubber, 34e-3)
    assert inside.EA() < ring.EA() < even.EA()
    assert inside.EA(free_twist=True) < ring.EA(free_twist=True) < even.EA(free_twist=True)


def test_members_keep_their_sum():
    """The plates carry the stated sum of E A, however many they are: exact, by the area of their polygons' curved sides."""
    ring = RubberRing(26.8e6, 16e-3, 0.2, Material("rubber", 8e6, 0.45, 1000.0), 34e-3)
    for n in (6, 24):
        mesh = thin_members(ring, n)
        straight = RubberRing(26.8e6, 16e-3, 0.0, ring.rubber, 34e-3)
        EA = axial_stiffness(thin_members(straight, n))[0]
        assert EA == pytest.approx(26.8e6 + 8e6 * np.pi * 34e-3**2, rel=5e-3)  # their own rubber, and nu's mismatch
        assert np.count_nonzero(mesh.region_of == 1) == 2 * n


@pytest.mark.parametrize("nu", [0.0, 0.45, 0.499])
def test_rubber_outside_is_a_thick_tube(nu):
    """Pressure per lateral strain: 2 (l + m) of the disc, and the thick tube's E (R^2 - r^2) / ((1 + nu) ((1 - 2 nu) r^2 + R^2)) (Lame)."""
    r, R, rubber = 16e-3, 34e-3, Material("rubber", 8e6, nu, 1000.0)
    disc = 2 * (rubber.lame + rubber.G)
    tube = 8e6 * (R**2 - r**2) / ((1 + nu) * ((1 - 2 * nu) * r**2 + R**2))
    W = RubberRing(0.0, r, 0.2, rubber, R)._hessian()
    assert W[1, 1] == pytest.approx(2 * np.pi * r**2 * (disc + tube), rel=1e-10)

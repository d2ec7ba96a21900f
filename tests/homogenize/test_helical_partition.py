"""A homogeneous cylinder does not know its lay: drawing helical regions in it changes nothing (verification case T2)."""

import numpy as np
import pytest
from section_meshes import rings

from homogenize import solve_helical_cell, volume_average
from homogenize.benchmark_cylinder import homogeneous_cylinder
from homogenize.benchmark_limits import long_pitch


@pytest.mark.parametrize("twist_rate", [0.0, 0.1, 0.5, 1.0, -1.0, 2.0])
@pytest.mark.parametrize("nu", [0.0, 0.45])
def test_stiffness_of_a_solid_circle_is_independent_of_the_pitch(twist_rate, nu):
    """EA, EI, GJ are those of the circle, the shear coefficient is 1/(7/6 + (nu/(1+nu))^2/6), no coupling."""
    assert not [b.sentence() for b in homogeneous_cylinder(twist_rate, nu) if not b.passed]


def test_volume_averages_of_one_material_are_its_moduli():
    """Formula (3) gives E and G of the material, with no shear coefficient."""
    average = volume_average(solve_helical_cell(rings((1.0,), (3.0, 0.4), around=24, twist_rate=0.7)))
    np.testing.assert_allclose([average.E_blocked_twist, average.E_free_twist], 3.0, rtol=1e-9)
    np.testing.assert_allclose([average.G_yoz, average.G_xoz], 3.0 / 2.8, rtol=1e-9)


def test_small_pitch_limit_is_the_prismatic_section():
    """tau -> 0: the helical problem with a pitch of 1e6 radii gives the straight one."""
    assert not [b.sentence() for b in long_pitch() if not b.passed]

"""The whole stiffness of a bonded four-conductor section against an independent code (2026-11), contrast 15 600 : 1."""

import numpy as np
import pytest
from four_conductor_section import four_conductor_section

from homogenize import check_cell, pitch_average, solve_helical_cell
from homogenize.benchmark_cables import FOUR_CONDUCTORS


@pytest.fixture(scope="module")
def bonded(tmp_path_factory):
    mesh = four_conductor_section(tmp_path_factory.mktemp("section"))
    return mesh, solve_helical_cell(mesh)


def test_all_constants_agree_with_the_other_code(bonded):
    """E blocked and free, EI, GJ, coupling, GA: 0.1 % (meshes differ)."""
    s = pitch_average(bonded[1].stiffness)
    found = [s.E_blocked_twist, s.E_free_twist, s.EI_x, s.GJ, s.coupling, s.GA_x]
    np.testing.assert_allclose(found, FOUR_CONDUCTORS["bonded"], rtol=1e-3)


def test_the_checks_hold(bonded):
    assert all(check.holds for check in check_cell(*bonded))

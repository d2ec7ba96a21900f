"""The rod's axes are e1 = z, e2 = x, e3 = y of the section: every stiffness and inertia must arrive at its own strain."""

import numpy as np
import pytest

from beam.section_law import SECTION_OF_ROD, DampingTimes, rod_inertia, rod_order, rod_stiffness
from geometry.errors import SpecError
from homogenize.section_stiffness import ORDER, SectionInertia, SectionStiffness


def test_each_section_entry_has_its_place_in_the_rod():
    """(gamma_x, gamma_y, epsilon, kappa_x, kappa_y, tau) -> (stretch, shear 2 = x, shear 3 = y, twist, bend x, bend y)."""
    names = [ORDER[i] for i in SECTION_OF_ROD]
    assert names == ["epsilon", "gamma_x", "gamma_y", "tau", "kappa_x", "kappa_y"]


def test_stretch_twist_coupling_stays_symmetric():
    """C[2, 5], tension per twist, becomes C[0, 3] and C[3, 0] of the rod; shear-bending pairs keep theirs."""
    C = np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    C[2, 5] = C[5, 2] = 0.7
    C[0, 4] = C[4, 0] = 0.2
    rod = rod_order(C)
    assert rod[0, 3] == rod[3, 0] == 0.7
    assert rod[1, 5] == rod[5, 1] == 0.2
    np.testing.assert_array_equal(rod, rod.T)


def test_rotary_inertia_follows_the_same_axes():
    """Spin about e1 is J_z, bending about e2 is J_x, about e3 J_y."""
    np.testing.assert_array_equal(rod_inertia(SectionInertia(1.0, 2.0, 3.0, 4.0)), [4.0, 2.0, 3.0])


def test_damping_matrix_never_releases_energy():
    """sqrt(eta) C sqrt(eta) is positive semidefinite for a coupled C, which C eta is not."""
    C = np.diag([1e5, 1e5, 5e6, 70.0, 70.0, 100.0])
    C[2, 5] = C[5, 2] = 0.9 * np.sqrt(5e6 * 100.0)
    _, damping = rod_stiffness(SectionStiffness(C, 1e-3), DampingTimes(axial=1e-4, bending=1.0))
    scale = np.sqrt(np.diag(damping))
    assert np.linalg.eigvalsh(damping / np.outer(scale, scale)).min() > 0
    np.testing.assert_allclose(damping, damping.T, rtol=1e-14)


def test_negative_damping_time_is_refused():
    """A negative damping time would feed energy."""
    with pytest.raises(SpecError, match="damping times must be zero or positive"):
        DampingTimes(axial=-1e-3)

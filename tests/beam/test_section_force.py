"""Section forces of a cantilever in space under a dead tip load P: n = P everywhere, m = (r_tip - r) x P."""

import numpy as np
import pytest

from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.rotation_vector import rotation_matrix
from beam.section_force import nodal_section_forces
from beam.shape import straight
from beam.statics import equilibrium
from homogenize.section_stiffness import SectionInertia, SectionStiffness

P = np.array([-0.5, 1.5, 2.0])


@pytest.fixture(scope="module")
def cantilever():
    section = SectionStiffness.uncoupled(EA=1e4, GA_x=5e3, GA_y=5e3, EI_x=2.0, EI_y=3.0, GJ=1.5, area=1e-3)
    rod = Rod.straight(1.0, 40, section, SectionInertia(1.0, 1e-2, 1e-2, 1e-2))
    load = np.zeros((rod.nodes, 12))
    load[-1, 0:3] = P
    result = equilibrium(RodModel(rod, straight(rod.s), [Support(0)], load=load))
    result.outcome.require_success()
    return result.q, *nodal_section_forces(result.q, rod.lengths, result.forces.S)


def test_global_force_is_the_load(cantilever):
    """A dead load passes through every section unchanged; 0.5 % of |P| is the element's error in a bend."""
    _, _, turned = cantilever
    np.testing.assert_allclose(turned[:, :3], np.tile(P, (41, 1)), rtol=0, atol=5e-3 * float(np.linalg.norm(P)))


def test_global_moment_is_the_lever(cantilever):
    """(r_tip - r) x P, to 1 % of the largest moment (the end nodes take the nearest Gauss point)."""
    q, _, turned = cantilever
    expected = np.cross(q[-1, 0:3] - q[:, 0:3], P)
    np.testing.assert_allclose(turned[:, 3:], expected, rtol=0, atol=1e-2 * np.abs(expected).max())


def test_local_components_are_turned_back(cantilever):
    """N = R^T n with the section's own rotation; the rod is bent by more than half a radian, so R is no identity."""
    q, local, turned = cantilever
    assert np.linalg.norm(q[-1, 6:9]) > 0.4
    R = rotation_matrix(q[:, 6:9])
    for part in (slice(0, 3), slice(3, 6)):
        np.testing.assert_allclose(np.einsum("nij,nj->ni", R, local[:, part]), turned[:, part], rtol=0, atol=1e-12)

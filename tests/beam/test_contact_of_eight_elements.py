"""Eight elements at once have the contact forces, anchors and energies of the law written for one point."""

import numpy as np
import pytest

from beam.contact_force import contact_forces
from beam.contact_lanes import contact_residual
from beam.rod import Rod
from beam.rod_model import RodModel
from beam.shape import straight
from beam.surface import ContactLaw, Cylinder, Plane
from homogenize.section_stiffness import SectionInertia, SectionStiffness

LAW = ContactLaw(stiffness=1e5, friction=0.4)
FALLS = ContactLaw(stiffness=1e5, friction=0.4, fall=0.3, fall_speed=0.1, fall_power=2.0, drag=50.0)
SURFACES = {
    "floor and deck": [Plane("floor", LAW), Plane("deck", LAW, (0.6, 0.8, 0.0), 0.9, low=(0.6, -np.inf, -np.inf))],
    "smooth floor": [Plane("floor", ContactLaw(stiffness=1e5))],
    "rough drum and floor": [Cylinder("drum", LAW, (0.5, -0.2, 0.0), 0.201), Plane("floor", LAW, offset=5e-4)],
    "friction that falls with speed, drag": [Plane("floor", FALLS), Cylinder("drum", FALLS, (0.5, -0.2, 0.0), 0.201)],
    "friction at rest only": [Plane("floor", ContactLaw(stiffness=1e5, fall=0.3, fall_speed=0.1, fall_power=0.0))],
    "smooth floor with drag": [Plane("floor", ContactLaw(stiffness=1e5, drag=50.0))],
}


@pytest.mark.parametrize("name", SURFACES)
def test_same_as_one_point_after_the_other(name):
    """Eleven elements, so that three lanes are empty; touching and not, sticking and slipping, with anchors and without."""
    section = SectionStiffness.uncoupled(EA=1e4, GA_x=1e4, GA_y=1e4, EI_x=2.0, EI_y=2.0, GJ=1.0, area=1e-3)
    rod = Rod.straight(1.2, 11, section, SectionInertia(1.0, 1e-2, 1e-2, 1e-2))
    model = RodModel(rod, straight(rod.s), surfaces=SURFACES[name])
    rng, n = np.random.default_rng(3), rod.lengths.size * len(model.xs)
    q = model.q0 + 1e-3 * rng.normal(size=model.q0.shape)
    v = 0.3 * rng.normal(size=q.shape)
    P = model.surface_parameters(0.0)
    P[:, 13:16] = [0.2, -0.1, 0.05]
    P[:, 23:26] = [0.3, np.cos(0.2), np.sin(0.2)]
    anchors, unused = np.full((n, 3), np.nan), np.zeros((0, 0, 0))
    given = (P, model.first, model.xs, model.ws, q, v, rod.lengths)
    for stir in (0.0, 2e-3):
        F, G, moved, later = np.zeros_like(q), np.zeros_like(q), np.zeros((n, 3)), np.zeros((n, 3))
        reports, sums, nodal = np.ones((len(P), 7)), np.ones((len(P), 7)), np.zeros((rod.nodes, 3))
        contact_residual(*given, anchors, moved, F, reports)
        contact_forces(
            *given, anchors, later, G, nodal, nodal, sums, np.zeros(n), False, False, 0.0, unused, unused, unused
        )  # fmt: skip
        touching = np.isfinite(later[:, 0])
        assert np.array_equal(np.isfinite(moved[:, 0]), touching)
        assert np.abs(G).max() > 1.0
        np.testing.assert_allclose(F, G, rtol=0, atol=1e-12 * np.abs(G).max())
        np.testing.assert_allclose(moved[touching], later[touching], rtol=0, atol=1e-14)
        np.testing.assert_allclose(reports, sums, rtol=1e-11, atol=1e-15)
        anchors = np.where(touching[:, None], later + stir * rng.normal(size=later.shape), np.nan)
        v = 0.01 * v
        given = (*given[:5], v, rod.lengths)

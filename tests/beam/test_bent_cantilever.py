"""45-degree bend of Bathe and Bolourchi, Int. J. Numer. Meth. Eng. 14 (1979) 961-986: a curved cantilever loaded out of plane.

Reference: the same kind of element, n = 32, and Exudyn 1.13.6, n = 64, which agree to 2e-3; 2026-11. The often quoted
(47.23, 15.79, 53.37) is an 8-element value and not converged.
"""

import numpy as np
import pytest

from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import strands_and_arcs
from beam.statics import equilibrium
from homogenize.section_stiffness import SectionInertia, SectionStiffness

E, R = 1e7, 100.0
SECTION = SectionStiffness.uncoupled(EA=E, GA_x=E / 2, GA_y=E / 2, EI_x=E / 12, EI_y=E / 12, GJ=E / 12, area=1.0)


def bend(elements: int) -> tuple[Rod, np.ndarray]:
    s = np.linspace(0.0, R * np.pi / 4, elements + 1)
    shape = strands_and_arcs(s, [(s[-1], 1 / R)])
    return Rod.build(np.diff(s), SECTION, SectionInertia(1.0, 1e-2, 1e-2, 2e-2), stress_free=shape), shape


@pytest.mark.parametrize(
    ("load", "tip"),
    [(300, (58.7791, 22.2448, 40.1919)), (450, (52.2386, 18.5082, 48.5029)), (600, (47.1504, 15.6848, 53.4749))],
)
def test_tip_position(load, tip):
    """n = 16 within 1e-3 of the radius-100 bend's converged tip."""
    rod, shape = bend(16)
    loads = np.zeros((rod.nodes, 12))
    loads[-1, 2] = load
    result = equilibrium(RodModel(rod, shape, [Support(0)], load=loads))
    result.outcome.require_success()
    np.testing.assert_allclose(result.q[-1, [0, 1, 2]], tip, rtol=0, atol=1e-3)


def test_curved_rod_is_free_of_stress_in_its_own_shape():
    """Reference strains make the initial curvature stress-free."""
    rod, shape = bend(4)
    model = RodModel(rod, shape, [Support(0)])
    forces = model.forces(0.0, shape, np.zeros_like(shape), [])
    assert np.abs(forces.S).max() < 1e-9 * E
    assert forces.elastic < 1e-12

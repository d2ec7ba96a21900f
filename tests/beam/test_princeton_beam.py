"""Princeton beam experiment: a blade under a tip load that bends and twists it in space.

Section and loads after Dowell, Traybar, USAAMRDL TR 75-3/4 (1975); tip displacements: rod element of the same kind in an
independent prototype, n = 32, seven digits, and Exudyn 1.13.6 (n = 128, 45 degrees), which agree to 2e-6 m; 2026-11.
"""

import numpy as np
import pytest

from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import straight
from beam.statics import equilibrium
from homogenize.section_stiffness import SectionInertia, SectionStiffness

SECTION = SectionStiffness.uncoupled(
    EA=2.842069e6, GA_x=1.084759e6, GA_y=1.084759e6, EI_x=2.428872, EI_y=36.285519, GJ=2.925744, area=3.9638e-5
)
LENGTH = 0.508

CASES = [
    (4.448, 30, (-0.0019179, -0.0047576, 0.0399599)),
    (4.448, 45, (-0.0037482, -0.0039764, 0.0560635)),
    (4.448, 60, (-0.0055277, -0.0028742, 0.0681319)),
    (8.896, 45, (-0.0144118, -0.0089792, 0.1091131)),
    (8.896, 90, (-0.0260215, 0.0, 0.1462523)),
    (13.345, 0, (-0.0003047, -0.0160612, 0.0)),
    (13.345, 30, (-0.0172589, -0.0169898, 0.1181795)),
    (13.345, 45, (-0.0304529, -0.0156211, 0.1567746)),
    (13.345, 60, (-0.0412573, -0.0119635, 0.1820038)),
    (13.345, 90, (-0.0504010, 0.0, 0.2006839)),
]


def tip_displacement(elements: int, load: float, degrees: float) -> np.ndarray:
    rod = Rod.straight(LENGTH, elements, SECTION, SectionInertia(0.1, 1e-4, 1e-4, 2e-4))
    loads = np.zeros((rod.nodes, 12))
    angle = np.radians(degrees)
    loads[-1, 0:3] = 0.0, -load * np.cos(angle), load * np.sin(angle)
    result = equilibrium(RodModel(rod, straight(rod.s), [Support(0)], load=loads))
    result.outcome.require_success()
    return result.q[-1, 0:3] - [LENGTH, 0.0, 0.0]


@pytest.mark.parametrize(("load", "degrees", "expected"), CASES)
def test_tip_displacement(load, degrees, expected):
    """n = 32 within 1e-6 m, and half of the last printed digit, of the converged displacement."""
    np.testing.assert_allclose(tip_displacement(32, load, degrees), expected, rtol=0, atol=1.05e-6)


def test_coarse_mesh():
    """n = 8 within 5e-5 m at 45 degrees and the largest load."""
    np.testing.assert_allclose(tip_displacement(8, 13.345, 45), CASES[7][2], rtol=0, atol=5e-5)

"""A limp cable that slips round a drum which does not turn: T2/T1 = exp(mu beta) (Euler, Eytelwein)."""

import numpy as np
import pytest

from beam.generalized_alpha import Integrator, StepSettings
from beam.motion import SpeedRamp
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.section_law import DampingTimes
from beam.shape import strands_and_arcs
from beam.statics import equilibrium
from beam.surface import ContactLaw, Cylinder
from homogenize.section_stiffness import SectionInertia, SectionStiffness

R, T1, STRAND = 0.2, 100.0, 0.3


@pytest.mark.parametrize("mu", [0.1, 0.3])
def test_half_turn(mu):
    """beta = pi, 40 elements on the arc; 1 %."""
    length = 2 * STRAND + np.pi * R
    EI = 2e-3
    section = SectionStiffness.uncoupled(EA=1e5, GA_x=1e4, GA_y=1e4, EI_x=EI, EI_y=EI, GJ=EI, area=1.0)
    rod = Rod.straight(length, 78, section, SectionInertia(1.0, 1e-5, 1e-5, 2e-5), DampingTimes(2e-3, 2e-2))
    start = strands_and_arcs(rod.s, [(STRAND, 0.0), (np.pi * R, -1 / R), (STRAND, 0.0)], (-R, -STRAND, 0), np.pi / 2)
    load = np.zeros((rod.nodes, 12))
    load[0, 1] = -T1
    drum = Cylinder("drum", ContactLaw(friction=mu), (0.0, 0.0, 0.0), R)
    pull = SpeedRamp(0.01, 0.0, 0.5, direction=(0.0, -1.0, 0.0))
    model = RodModel(rod, start, [Support(-1, travel=pull)], load=load, surfaces=[drum])
    rest = equilibrium(model)
    rest.outcome.require_success()
    np.testing.assert_allclose(-rest.forces.F[-1, 1], T1, rtol=1e-3)  # frictionless: T2 = T1
    motion = Integrator(model, rest.q, anchors=rest.anchors, settings=StepSettings(5e-3))
    assert motion.advance(200), str(motion.outcome)
    np.testing.assert_allclose(-motion.reaction[-1, 1] / T1, np.exp(mu * np.pi), rtol=1e-2)

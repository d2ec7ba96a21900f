"""A jerk at one end travels along the rod with the speed sqrt(EA/m)."""

import numpy as np

from beam.generalized_alpha import Integrator, StepSettings
from beam.motion import SpeedRamp
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import straight
from homogenize.section_stiffness import SectionInertia, SectionStiffness


def test_wave_speed():
    """EA 471.2 kN, m 10 kg/m: 217.07 m/s, from the half-height passage at 4 m and 12 m of a 16 m rod; 1 %."""
    EA, m = 4.712e5, 10.0
    section = SectionStiffness.uncoupled(EA=EA, GA_x=2e5, GA_y=2e5, EI_x=124.0, EI_y=124.0, GJ=86.0, area=1.0)
    rod = Rod.straight(16.0, 80, section, SectionInertia(m, 0.0026, 0.0026, 0.0052))
    jerk = SpeedRamp(speed=-0.05, start=0.0, end=4e-3)
    model = RodModel(rod, straight(rod.s), [Support(0, travel=jerk)])
    motion = Integrator(model, model.q0, settings=StepSettings(2.5e-4, adaptive=False))
    times, speeds = [], []
    while motion.t < 0.066:
        motion.advance(1)
        times.append(motion.t)
        speeds.append(motion.v[[20, 60], 0])
    passage = []
    for speed in -np.array(speeds).T:
        rise = slice(0, int(np.argmax(speed)) + 1)
        passage.append(np.interp(0.025, speed[rise], np.array(times)[rise]))
    np.testing.assert_allclose(8.0 / (passage[1] - passage[0]), np.sqrt(EA / m), rtol=1e-2)

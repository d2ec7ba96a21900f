"""The axial chain beside the full rod with contact and friction on a floor: the pull from rest to sliding, and its waves."""

import numpy as np

from beam.axial_chain import AxialChain
from beam.benchmark_friction import EA, LENGTH, MU, cable_on_floor
from beam.generalized_alpha import Integrator, StepSettings
from beam.motion import SpeedRamp
from beam.rod_model import Support
from beam.statics import equilibrium


def test_the_pull_of_the_chain_is_that_of_the_rod():
    """One end led from rest to 0.1 m/s in 0.6 s, friction mobilised to the tail: within 0.3 % of the friction, rms over the run."""
    ramp, dt = SpeedRamp(0.1, 0.0, 0.6), 4e-3
    model = cable_on_floor(20, [Support(-1, ("x", "theta"), ramp)])
    start = equilibrium(model)
    start.outcome.require_success()
    motion = Integrator(model, start.q, anchors=start.anchors, settings=StepSettings(dt))
    read: list[tuple[float, float]] = []
    assert motion.advance(200, lambda m: read.append((m.t, float(m.reaction[-1, 0]))))
    at, rod = np.array(read).T  # steps are divided where friction asks for it
    stiff = float(
        model.surfaces[0].law.friction * 98.1 / (5.0 * 1.25e6)
    )  # limit over the stiffness of the rod's bristles
    chain = AxialChain(LENGTH, EA, 10.0, MU, presliding=stiff, damping_ratio=0.0, elements=64)
    chain = AxialChain(
        LENGTH, EA, 10.0, MU, presliding=stiff, damping_ratio=2.5e-3 * chain.first_frequency, elements=64
    )
    time = dt * np.arange(201.0)
    run = chain.run(time, np.array([ramp(t)[0][0] for t in time]), substeps=2)
    limit = MU * 98.1 * LENGTH
    assert rod.max() > 1.2 * limit  # inertia and friction of the whole cable
    assert np.sqrt(np.mean((np.interp(at, time, run.tension) - rod) ** 2)) < 0.003 * limit

"""Damping takes energy from motion and never changes where the rod comes to rest."""

import numpy as np
import pytest

from beam.generalized_alpha import Integrator, StepSettings
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.section_law import DampingTimes
from beam.shape import straight
from beam.statics import equilibrium
from homogenize.section_stiffness import SectionInertia, SectionStiffness

SECTION = SectionStiffness.uncoupled(EA=5e4, GA_x=2e4, GA_y=2e4, EI_x=6.0, EI_y=6.0, GJ=4.0, area=1e-3)


def cantilever(damping: DampingTimes) -> RodModel:
    rod = Rod.straight(1.0, 8, SECTION, SectionInertia(2.0, 1e-3, 1e-3, 2e-3), damping)
    return RodModel(rod, straight(rod.s), [Support(0)], gravity=(0.0, -9.81, 0.0))


def test_motion_comes_to_rest_in_the_static_shape():
    """Released from the straight shape, damped by 250 ms, compared after 12 s with the undamped equilibrium: 1e-8 m."""
    static = equilibrium(cantilever(DampingTimes()))
    static.outcome.require_success()
    model = cantilever(DampingTimes(axial=1e-3, bending=0.25))
    motion = Integrator(model, model.q0, settings=StepSettings(1e-2, absolute=1e-9))
    assert motion.advance(1200), str(motion.outcome)
    np.testing.assert_allclose(motion.q[:, 0:3], static.q[:, 0:3], rtol=0, atol=1e-8)


def test_static_solution_does_not_know_the_damping():
    """The same static shape for damping times that differ by orders of magnitude."""
    shapes = [equilibrium(cantilever(DampingTimes(a, b))).q for a, b in ((0.0, 0.0), (0.1, 1.0))]
    np.testing.assert_allclose(shapes[0], shapes[1], rtol=0, atol=1e-12)


@pytest.mark.parametrize("times", [DampingTimes(0.0, 2e-2), DampingTimes(5e-3, 0.0)])
def test_energy_ledger_closes_with_damping(times):
    """Gravity energy released = stored + lost, to 1e-3 of the throughput; the loss only ever grows."""
    model = cantilever(times)
    motion = Integrator(model, model.q0, settings=StepSettings(1e-3, spectral_radius=0.9))
    losses: list[float] = []
    assert motion.advance(500, lambda m: losses.append(m.ledger.totals["damping_loss"]))
    assert (np.diff(losses) >= 0).all() and losses[-1] > 0
    assert abs(motion.ledger.balance_error) < 1e-3


def test_undamped_rod_keeps_its_energy():
    """Without damping and with rho = 1 the total energy is kept to 1e-3 of what was exchanged; nothing counts as lost."""
    model = cantilever(DampingTimes())
    motion = Integrator(model, model.q0, settings=StepSettings(1e-3, spectral_radius=1.0))
    assert motion.advance(500)
    assert motion.ledger.totals["damping_loss"] == 0.0
    assert abs(motion.ledger.balance_error) < 1e-3

"""A computation that cannot go on stops with a sentence that names the node and the time, and keeps what it has."""

import numpy as np
import pytest

from beam import Status, read_scenario, tow
from beam.generalized_alpha import Integrator, StepSettings
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import straight
from beam.statics import equilibrium
from beam.surface import ContactLaw, Plane
from geometry.errors import ConvergenceError, SpecError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

SECTION = SectionStiffness.uncoupled(EA=1e4, GA_x=1e4, GA_y=1e4, EI_x=2.0, EI_y=2.0, GJ=1.0, area=1e-3)
ROD = Rod.straight(1.0, 8, SECTION, SectionInertia(1.0, 1e-2, 1e-2, 1e-2))


def test_nan_in_a_load_stops_statics_and_names_the_node():
    """A force that is not a number at node 5."""
    load = np.zeros((9, 12))
    load[5, 1] = np.nan
    result = equilibrium(RodModel(ROD, straight(ROD.s), [Support(0)], load=load))
    assert result.outcome.status is Status.NOT_FINITE
    assert "Node 5" in result.outcome.detail
    with pytest.raises(ConvergenceError, match="Node 5"):
        result.outcome.require_success()


def test_nan_in_a_motion_stops_at_once_and_keeps_the_state():
    """A drive that becomes NaN at t = 0.1 s: the last good state and its time are kept."""

    def broken(t: float):
        value = np.zeros(3) if t <= 0.1 else np.full(3, np.nan)
        return value, value, value

    model = RodModel(ROD, straight(ROD.s), [Support(0), Support(-1, travel=broken)])
    motion = Integrator(model, model.q0, settings=StepSettings(1e-2, adaptive=False))
    assert not motion.advance(50)
    assert motion.outcome.status is Status.NOT_FINITE
    assert "node" in motion.outcome.detail and "0.11" in motion.outcome.detail
    assert motion.t == pytest.approx(0.1)
    assert np.isfinite(motion.q).all()


def test_step_that_does_not_converge_is_cut_never_accepted():
    """An impossible tolerance: cuts to the smallest step, then stops; time has not advanced."""
    model = RodModel(ROD, straight(ROD.s), [Support(0)], gravity=(0.0, -9.81, 0.0))
    settings = StepSettings(1e-2, relative=0.0, absolute=0.0, iterations=3)
    motion = Integrator(model, model.q0, settings=settings)
    assert not motion.advance(1)
    assert motion.outcome.status is Status.NOT_CONVERGED
    assert "node" in motion.outcome.detail and motion.counters.cuts > 5
    assert motion.t == 0.0


def test_a_cut_names_the_contact_also_without_friction():
    """A smooth floor under a cable that is dropped, and an impossible tolerance."""
    floor = Plane("ice", ContactLaw(friction=0.0), offset=1e-3)
    model = RodModel(ROD, straight(ROD.s), [], gravity=(0.0, -9.81, 0.0), surfaces=[floor])
    settings = StepSettings(1e-2, relative=0.0, absolute=0.0, iterations=3)
    motion = Integrator(model, model.q0, settings=settings)
    assert not motion.advance(1)
    assert "(on ice)" in motion.outcome.detail


def test_stopped_towing_run_keeps_its_frames():
    """The partial run is a run: dataset, record and the sentence."""
    scenario = read_scenario("intelligent-horizontal").changed(cable__elements=100, time__duration="1 s")
    run = tow(scenario, settings=StepSettings(5e-3, relative=0.0, absolute=0.0, iterations=2))
    assert not run.outcome.completed
    assert run.dataset.sizes["time"] >= 1
    assert run.record()["status"].startswith("stopped: the iteration did not converge")


def test_wrong_shape_is_a_sentence():
    """A starting shape for another number of nodes."""
    with pytest.raises(SpecError, match="must have shape"):
        RodModel(ROD, straight(np.linspace(0, 1, 5)))

"""Coulomb friction on a floor: stick-slip with its exact answer, exact stick, the friction cone."""

import numpy as np
import pytest

from beam.generalized_alpha import Integrator, StepSettings
from beam.motion import SpeedRamp
from beam.rod import GAUSS_W, Rod
from beam.rod_model import RodModel, Support
from beam.section_law import DampingTimes
from beam.shape import straight
from beam.statics import equilibrium
from beam.surface import ContactLaw, Plane
from homogenize.section_stiffness import SectionInertia, SectionStiffness

EA, WEIGHT, MU, LENGTH = 4.712e5, 98.1, 0.3, 16.0
SECTION = SectionStiffness.uncoupled(EA=EA, GA_x=2e5, GA_y=2e5, EI_x=124.4, EI_y=124.4, GJ=86.0, area=1.0)


def cable_on_floor(elements: int, supports, length: float = LENGTH, slope: float = 0.0, bristle_ratio: float = 5.0):
    rod = Rod.straight(
        length, elements, SECTION, SectionInertia(10.0, 0.0026, 0.0026, 0.0052), DampingTimes(5e-3, 2e-2)
    )
    floor = Plane("floor", ContactLaw(friction=MU, bristle_ratio=bristle_ratio))
    start = straight(rod.s)
    start[:, 1] = -WEIGHT * np.cos(slope) / 1.25e6
    gravity = 9.81 * np.array([-np.sin(slope), -np.cos(slope), 0.0])
    return RodModel(rod, start, supports, gravity=gravity, surfaces=[floor])


@pytest.fixture(scope="module")
def pulled():
    """One end pulled slowly by 5 mm; the largest |t|/(mu fn) of every step is kept."""
    u, ramp = 5e-3, 3.0
    model = cable_on_floor(64, [Support(-1, ("x", "theta"), SpeedRamp(u / 2.5, 0.0, ramp))])
    start = equilibrium(model)
    start.outcome.require_success()
    motion = Integrator(model, start.q, anchors=start.anchors, settings=StepSettings(5e-3))
    cones: list[float] = []
    assert motion.advance(800, lambda m: cones.append(float(m.forces.cones[0].max()))), str(motion.outcome)
    return motion, cones, u


def test_stick_slip_force(pulled):
    """F = sqrt(2 EA mu w u) = 372.39 N for u = 5 mm; 0.3 %."""
    motion, _, u = pulled
    assert motion.q[-1, 0] - LENGTH == pytest.approx(u, rel=1e-9)
    np.testing.assert_allclose(motion.reaction[-1, 0], np.sqrt(2 * EA * MU * WEIGHT * u), rtol=3e-3)


def test_slip_length(pulled):
    """F/(mu w) = 12.65 m of cable slip, the rest sticks; 3 %."""
    motion, _, u = pulled
    slips = motion.forces.cones[0] > 1 - 1e-9
    length = float((slips * GAUSS_W).sum()) * LENGTH / slips.shape[0]
    np.testing.assert_allclose(length, np.sqrt(2 * EA * u / (MU * WEIGHT)), rtol=3e-2)


def test_far_end_does_not_move(pulled):
    """Beyond the slip length nothing has moved."""
    motion, _, _ = pulled
    assert abs(motion.q[0, 0]) < 1e-7


def test_friction_cone_holds_at_every_step(pulled):
    """|t| <= mu f_n at every contact point and step, to round-off; some point does slip."""
    _, cones, _ = pulled
    assert max(cones) <= 1 + 1e-12
    assert max(cones) > 0.999


def test_friction_pays_for_itself(pulled):
    """Work of the pull = elastic energy + friction + small rest: the balance closes to 1e-3, friction loss is positive."""
    motion, _, u = pulled
    totals = motion.ledger.totals
    assert abs(motion.ledger.balance_error) < 1e-3
    exact = np.sqrt(2 * EA * MU * WEIGHT * u) * u * 2 / 3
    np.testing.assert_allclose(totals["drive_work"], exact, rtol=1e-2)
    np.testing.assert_allclose(totals["friction_loss"], exact / 2, rtol=3e-2)


def test_exact_stick_does_not_creep():
    """On a slope of 0.25 rad < arctan 0.3 the cable rests: no motion beyond 1e-9 m in ten seconds."""
    model = cable_on_floor(6, [], length=2.0, slope=0.25, bristle_ratio=0.5)
    motion = Integrator(model, model.q0, settings=StepSettings(5e-3, absolute=1e-7))
    assert motion.advance(600), str(motion.outcome)
    rest = motion.q[:, 0:3].copy()
    assert motion.advance(2000)
    assert np.abs(motion.q[:, 0:3] - rest).max() < 1e-9


def test_steeper_slope_slides():
    """On 0.35 rad > arctan 0.3 it slides with the acceleration g (sin - mu cos)."""
    slope, time = 0.35, 1.0
    model = cable_on_floor(6, [], length=2.0, slope=slope)
    motion = Integrator(model, model.q0, settings=StepSettings(5e-3))
    assert motion.advance(200)
    expected = -9.81 * (np.sin(slope) - MU * np.cos(slope)) * time
    np.testing.assert_allclose(motion.v[:, 0], expected, rtol=1e-2)


@pytest.mark.parametrize("slope", [0.0, 0.3, -0.2])
def test_towing_force_on_an_incline(slope):
    """Formulas (22), (23): steady towing needs m g L (mu cos + sin); 0.5 %."""
    from beam.incline_formula import towing_force_up

    model = cable_on_floor(12, [Support(-1, ("x", "theta"), SpeedRamp(0.2, 0.1, 0.9))], slope=slope, bristle_ratio=0.5)
    motion = Integrator(model, model.q0, settings=StepSettings(5e-3))
    assert motion.advance(600), str(motion.outcome)
    mean = []
    motion.advance(100, lambda m: mean.append(m.reaction[-1, 0]))
    np.testing.assert_allclose(np.mean(mean), towing_force_up(10.0 * LENGTH, slope, MU), rtol=5e-3)

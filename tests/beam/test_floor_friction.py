"""Coulomb friction on a floor: stick-slip with its exact answer, exact stick, the friction cone (cases F1, F2, D4)."""

import numpy as np
import pytest

from beam.benchmark_dynamics import incline
from beam.benchmark_friction import LENGTH, MU, WEIGHT, cable_on_floor, exact_stick, pulled_cable, stick_slip
from beam.generalized_alpha import Integrator, StepSettings


def test_stick_slip():
    """F = sqrt(2 EA mu w u) and slip length F/(mu w); nothing moves beyond it; the cone holds; friction pays for itself."""
    assert not [b.sentence() for b in stick_slip() if not b.passed]


def test_some_point_slips_and_the_end_is_where_it_was_pulled():
    """The cone is reached, and the pulled end has moved by 5 mm."""
    motion, cones = pulled_cable(5e-3)
    assert max(cones) > 0.999
    assert motion.q[-1, 0] - LENGTH == pytest.approx(5e-3, rel=1e-9)


def test_exact_stick_does_not_creep():
    """On a slope of 0.25 rad < arctan 0.3 the cable rests: no motion beyond 1e-9 m in ten seconds."""
    assert not [b.sentence() for b in exact_stick() if not b.passed]


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
    assert not [b.sentence() for b in incline(slope) if not b.passed]


def test_a_jolt_does_not_strain_the_bristle():
    """Friction is at its limit by the damping alone, the anchor stays: kt |b| < mu f_n. Dragged, it carries mu f_n exactly."""
    model = cable_on_floor(2, [], length=1.0)
    q, still = model.q0, np.zeros_like(model.q0)
    anchors = model.forces(0.0, q, still, model.fresh_anchors()).moved
    v = still.copy()
    v[:, 0] = 1.0
    jolt = model.forces(0.0, q, v, anchors)
    assert jolt.F[:, 0].sum() == pytest.approx(MU * WEIGHT, rel=1e-12)
    np.testing.assert_array_equal(jolt.moved[0], anchors[0])
    assert jolt.bristle == 0.0
    apart = q.copy()
    apart[:, 0] += 1e-2
    dragged = model.forces(0.0, apart, still, anchors)
    limit = MU * WEIGHT
    assert dragged.F[:, 0].sum() == pytest.approx(limit, rel=1e-12)
    assert dragged.bristle == pytest.approx(0.5 * limit**2 / (5.0 * 1.25e6), rel=1e-9)

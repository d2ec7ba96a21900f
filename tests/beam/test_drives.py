"""Drives of the working face: what the tables, wheels, pulleys and cylinders must do by elementary kinematics and statics."""

from __future__ import annotations

import numpy as np
import pytest

from beam import read_scenario
from beam.bodies_alone import bodies_alone
from beam.generalized_alpha import Integrator, StepSettings
from beam.hydraulic_tensioner import HydraulicTensioner
from beam.motion import SpeedRamp
from beam.motion_curve import MotionCurve
from beam.movable_pulley import MovablePulley
from beam.polygon_effect import PolygonEffect
from beam.rigid_body import RigidBody
from beam.statics import equilibrium
from beam.support import Support
from beam.transmission_error import TransmissionError
from geometry.errors import SpecError

SPEED = 0.1
STEADY = SpeedRamp(SPEED, 0.0, 1e-3)


def course(motion, times):
    """Displacement, velocity, acceleration along x, each (k,)."""
    return np.array([[x[0] for x in motion(float(t))] for t in times]).T


def check_derivatives(motion, times):
    """u, du, ddu belong together: central differences, whose error is h^2."""
    h = 1e-5
    (u0, v0, _), (u1, v1, _) = course(motion, times - h), course(motion, times + h)
    _, v, a = course(motion, times)
    assert (u1 - u0) / (2 * h) == pytest.approx(v, rel=1e-5, abs=1e-8)
    assert (v1 - v0) / (2 * h) == pytest.approx(a, rel=1e-5, abs=1e-7)


def test_polygon_effect_has_the_closed_form_ripple_mean_and_frequency():
    """v = R w cos(phi): ripple 1 - cos(pi/N) of the largest speed, mean kept, N maxima a turn of the wheel."""
    N, R = 5, 0.1
    chain = PolygonEffect(STEADY, N, R, harmonics=None)
    turn = 2 * np.pi * R * chain.mean_ratio / SPEED  # s
    t = 0.01 + np.linspace(0, turn, 2001)
    u, v, _ = course(chain, t)
    # the kink is met within half a sample: sin(pi/N) pi/2000 of the speed, 0.5 % of the ripple
    assert 1 - v.min() / v.max() == pytest.approx(1 - np.cos(np.pi / N), rel=5e-3)
    assert (u[-1] - u[0]) / turn == pytest.approx(SPEED, rel=1e-12)
    assert (np.diff(np.sign(v - SPEED)) != 0).sum() == 2 * N
    assert u[-1] - u[0] == pytest.approx(N * 2 * R * np.sin(np.pi / N), rel=1e-12)


def test_series_of_the_polygon_effect_converges_and_is_smooth():
    """The error of the speed falls like 1/M; mean and acceleration are those of the ramp where the wheel stands."""
    N, R = 6, 0.15
    t = np.linspace(0.1, 4.0, 301)
    exact = course(PolygonEffect(STEADY, N, R, None), t)[1]
    errors = [np.abs(course(PolygonEffect(STEADY, N, R, M), t)[1] - exact).max() for M in (4, 8, 16)]
    assert errors[1] < 0.6 * errors[0] and errors[2] < 0.6 * errors[1]
    smooth = PolygonEffect(SpeedRamp(SPEED, 0.0, 2.0), N, R)
    check_derivatives(smooth, np.linspace(0.01, 5.0, 60))
    jump = np.abs(np.diff(course(smooth, np.linspace(0, 5, 2501))[2])).max()
    assert jump < 0.016 * SPEED**2 / R * N**2


def test_exact_polygon_effect_jumps_by_the_engagement_of_a_link():
    """At the change of pockets the acceleration jumps by 2 R w^2 sin(pi/N)."""
    N, R = 5, 0.1
    chain = PolygonEffect(STEADY, N, R, None)
    omega = SPEED / (R * chain.mean_ratio)
    change = 0.5e-3 + np.pi / N / omega
    before, after = course(chain, [change - 1e-6, change + 1e-6])[2]
    assert after - before == pytest.approx(2 * R * omega**2 * np.sin(np.pi / N), rel=1e-4)


def test_transmission_error_ripples_once_a_tooth():
    """Amplitude e of the way, 2 pi e / p of the speed, one period a pitch."""
    wheel = TransmissionError(STEADY, amplitude=1e-3, pitch=0.125)
    t = 0.01 + np.linspace(0, 0.125 / SPEED, 2001)
    u, v, _ = course(wheel, t)
    base = course(STEADY, t)[0]
    assert np.abs(u - base).max() == pytest.approx(1e-3, rel=1e-5)
    assert 0.5 * (v.max() - v.min()) == pytest.approx(SPEED * wheel.ripple, rel=1e-5)
    assert u[-1] - u[0] == pytest.approx(0.125, rel=1e-12)
    check_derivatives(TransmissionError(SpeedRamp(SPEED, 0.0, 2.0), 1e-3, 0.125), np.linspace(0.01, 4.0, 100))


def test_movable_pulley_halves_and_an_error_makes_slack():
    """Half the way, and a slack of error times the way of the shearer."""
    pulley = MovablePulley(SpeedRamp(SPEED, 0.0, 2.0), error=-0.02)
    u, v, a = course(pulley, [1.3])[:, 0]
    assert (u, v, a) == pytest.approx(0.49 * course(pulley.base, [1.3])[:, 0], rel=1e-12)
    assert pulley.slack(11.0) == pytest.approx(-0.02 * 1.0, rel=1e-12)


@pytest.mark.parametrize(
    "curve",
    [
        MotionCurve((0.5, 1.5, 3.0, 5.0), (0.0, 0.1, 0.04, 0.08)),
        MotionCurve((0.5, 1.5, 3.0, 5.0, 6.0), (0.0, 0.05, 0.2, 0.5, 0.62), "displacement"),
    ],
    ids=["speed", "displacement"],
)
def test_tabulated_curves_are_met_and_smooth_to_the_acceleration(curve):
    """The table is met, the three courses belong together, and acceleration has no jump, not even at the table's ends."""
    u, v, _ = course(curve, curve.times)
    met = v if curve.kind == "speed" else u
    assert met == pytest.approx(np.array(curve.values), rel=1e-9, abs=1e-12)
    check_derivatives(curve, np.linspace(0.51, 5.9, 70))
    for t in curve.times:
        before, after = course(curve, [t - 1e-7, t + 1e-7])[2]
        assert after == pytest.approx(before, abs=1e-5)
    if curve.kind == "speed":
        assert course(curve, np.linspace(0, 6, 500))[1].max() <= 0.1 * (1 + 1e-12)


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: MotionCurve((0.0, 0.0), (0.0, 1.0)), "grow"),
        (lambda: MotionCurve((0.0, 1.0), (0.3, 1.0)), "at rest"),
        (lambda: PolygonEffect(STEADY, 2, 0.1), "pockets"),
        (lambda: TransmissionError(STEADY, 0.05, 0.1), "turn the motion back"),
        (lambda: HydraulicTensioner(0, 1.0, (0.0, 0.0)).bushings(), "stroke"),
    ],
)
def test_impossible_drives_are_refused_in_a_sentence(make, word):
    with pytest.raises(SpecError, match=word):
        make()


def weight_on_cylinder(load: float, damping: float = 200.0):
    """A body of 10 kg that slides along x, pushed by `load` against a tensioner of 500 N with a stroke of -0.1 to 0.3 m."""
    tensioner = HydraulicTensioner("plate", -500.0, (0.1, 0.3), damping, stop_stiffness=1e5)
    body = RigidBody("plate", 10.0, (1.0, 1.0, 1.0), (0.0, 0.0, 0.0), force=(load, 0.0, 0.0))
    return bodies_alone([body], tensioner.bushings(), supports=[Support("plate", ("y", "z", "theta"))])


def test_tensioner_stops_at_the_end_of_its_stroke():
    """Beyond the balance the stop bears what is left: x = S + (load - F) / K + edge / 2."""
    model = weight_on_cylinder(700.0)
    x = equilibrium(model).q[model.row("plate"), 0]
    assert x == pytest.approx(0.3 + 200.0 / 1e5 + 0.5e-3, rel=1e-6)


def test_tensioner_pulls_with_constant_force_within_its_stroke():
    """m a = load - F - c v: v = (load - F)/c (1 - exp(-c t/m)) until the stop."""
    model = weight_on_cylinder(540.0)
    motion = Integrator(model, model.q0, settings=StepSettings(2e-3))
    motion.advance(100)
    exact = 40.0 / 200.0 * (1 - np.exp(-200.0 * motion.t / 10.0))
    assert motion.v[model.row("plate"), 0] == pytest.approx(exact, rel=1e-3)


def test_drive_table_of_a_scenario_makes_the_motions():
    """Half the shearer's way on the mean, the ripple of the chain on the trolley only, the tooth error on both."""
    plain = read_scenario("intelligent-horizontal").changed(chain="smeared")
    more = plain.changed(
        drive__trolley_error=0.01, drive__chain_pockets=5, drive__chain_radius="80 mm",
        drive__tooth_error="0.5 mm", drive__tooth_pitch="125 mm",
    )  # fmt: skip
    t = 9.0
    ideal = float(plain.pull(t)[0][0])
    assert float(plain.trolley(t)[0][0]) == pytest.approx(0.5 * ideal, rel=1e-12)
    assert float(more.pull(t)[0][0]) == pytest.approx(ideal, abs=0.5e-3)
    assert float(more.pull(t)[0][0]) != pytest.approx(ideal, abs=1e-6)
    assert float(more.trolley(t)[0][0]) == pytest.approx(0.505 * ideal, abs=5e-3)
    curve = {"time": ["0 s", "2 s"], "speed": ["0 m/s", "0.1 m/s"]}
    table = plain.changed(drive__curve=curve)
    assert float(table.pull(5.0)[1][0]) == pytest.approx(0.1, rel=1e-12)
    assert table.changed(time__duration="8 s").entries()["drive.curve"].text == "curve of speed with 2 rows"


@pytest.mark.parametrize(
    ("values", "word"),
    [
        ({"drive__chain_pockets": 5}, "belong together"),
        ({"drive__tensioner_stroke": "1 m"}, "tensioner_force"),
        ({"drive__curve": {"time": ["0 s", "0 s"], "speed": ["0 m/s", "1 m/s"]}}, "grow"),
        (
            {"drive__curve": {"time": ["0 s", "30 s"], "speed": ["0 m/s", "4 m/s"]}, "time__duration": "20 s"},
            "runs off|longer",
        ),
    ],
)
def test_drive_table_is_refused_in_a_sentence(values, word):
    with pytest.raises(SpecError, match=word):
        read_scenario("intelligent-horizontal").changed(**values)

"""A cable dragged along a trough as an axial chain: rigid and slow limits, wave speed, weight, energy, order of convergence."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from beam.axial_chain import GRAVITY, AxialChain, led_motion
from beam.axial_chain_step import exponential
from geometry.errors import InputError

CABLE = AxialChain(length=40.0, EA=4e5, mass=4.6, friction=0.35, tail_tension=800.0, inclination=0.1, presliding=3e-4)
TIME = np.linspace(0.0, 20.0, 201)


def eased(t, start, duration, travel):
    """A move with continuous acceleration."""
    s = np.clip((t - start) / duration, 0.0, 1.0)
    return travel * s**3 * (10 - 15 * s + 6 * s**2)


def ramped(t, start, speed):
    """From rest to a constant speed within 1 s, with continuous acceleration."""
    s = np.clip(t - start, 0.0, 1.0)
    return speed * (s**3 - s**4 / 2 + np.clip(t - start - 1.0, 0.0, None))


def test_at_rest_the_tension_is_the_tail_and_the_weight_below():
    """T(s) = T_tail + m g sin(alpha) (L - s), without friction; a load from 10 to 20 m weighs where it lies."""
    loaded = replace(CABLE, added=((1.5, 10.0, 20.0),))
    run = loaded.run(TIME, np.zeros(201), stations=[15.0, 30.0])
    w = GRAVITY * math.sin(0.1)
    expected = [800 + w * (4.6 * 40 + 15), 800 + w * (4.6 * 25 + 7.5), 800 + w * 4.6 * 10]
    for T, exact in zip((run.tension, *run.at), expected, strict=True):
        np.testing.assert_allclose(T, exact, rtol=1e-12)  # statics: rounding alone


def test_steady_sliding_is_tail_weight_and_coulomb_friction():
    """At constant speed T(s) = T_tail + m g (sin + mu cos)(L - s) pulled, with - mu let down."""
    position = ramped(TIME, 0.5, 0.05) - 2 * ramped(TIME, 10.0, 0.05)
    run = CABLE.run(TIME, position, stations=[10.0, 25.0])
    friction = 0.35 * 4.6 * GRAVITY * 40 * math.cos(0.1)
    for s, T in zip((0.0, 10.0, 25.0), (run.tension, *run.at), strict=True):
        below = 4.6 * GRAVITY * (40 - s)
        for last, sign in ((99, 1), (200, -1)):
            exact = 800 + below * (math.sin(0.1) + sign * 0.35 * math.cos(0.1))
            assert T[last] == pytest.approx(exact, abs=2e-3 * friction)  # waves of the start, damped for 8 s


def test_friction_front_of_a_slow_pull():
    """The travel x slides the length l from the towed end, EA x = mu w l^2 / 2, and pulls with mu w l: T = sqrt(2 EA mu w x).

    Quasi-static sliding front of a stiff-plastic trough (presliding much shorter than the travel).
    """
    chain = replace(CABLE, inclination=0.0, presliding=1e-4, mass=46.0, friction=1.0, elements=160)
    w = 46.0 * GRAVITY
    time = np.linspace(0.0, 80.0, 401)
    travel = 0.5 * w * 25.0**2 / 4e5
    run = chain.run(time, eased(time, 0.0, 80.0, travel), stations=[5.0])
    position = eased(time, 0.0, 80.0, travel)
    pulled = run.tension - 800.0
    late = position > 0.2 * travel
    np.testing.assert_allclose(
        pulled[late], np.sqrt(2 * 4e5 * w * position[late]), rtol=0.015
    )  # 1/100 of the front is one element
    np.testing.assert_allclose(run.at[0][late] - 800.0, pulled[late] - 5.0 * w, atol=0.01 * pulled[-1])


def test_stiff_cable_is_a_rigid_body():
    """EA to infinity, no friction: T_0 = T_tail + m L a."""
    chain = replace(CABLE, EA=4e11, friction=0.0, inclination=0.0)
    t = np.linspace(0.0, 2.0, 401)
    run = chain.run(t, eased(t, 0.2, 1.5, 0.5), substeps=4)
    s = (t - 0.2) / 1.5
    a = np.where((s > 0) & (s < 1), 0.5 / 1.5**2 * (60 * s - 180 * s**2 + 120 * s**3), 0.0)
    np.testing.assert_allclose(run.tension - 800.0, 4.6 * 40 * a, atol=0.01 * 4.6 * 40 * a.max())


def test_a_pull_travels_with_the_axial_wave_speed():
    """c = sqrt(EA / m): halfway up its rise the pull reaches 30 m after 30 m / c, and is EA v / c high."""
    chain = replace(CABLE, friction=0.0, damping_ratio=0.0, inclination=0.0, elements=200)
    c = math.sqrt(4e5 / 4.6)
    t = np.linspace(0.0, 0.15, 151)
    ramp = 0.02
    v = 0.1
    speed = v * np.clip(t / ramp, 0, 1) ** 2 * (3 - 2 * np.clip(t / ramp, 0, 1))
    position = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(t))])
    run = chain.run(t, position, stations=[10.0, 30.0], substeps=4)
    crossings = [float(np.interp(0.5 * 4e5 * v / c, (T - 800.0)[:130], t[:130])) for T in run.at]
    assert (crossings[1] - crossings[0]) == pytest.approx(20.0 / c, rel=0.01)  # a step of 1/4 ms in 67 ms
    assert run.at[1][135] - 800.0 == pytest.approx(4e5 * v / c, rel=0.02)


def test_first_mode_and_its_damping():
    """After a short jerk the tension rings at omega_1 = (pi/2L) sqrt(EA/m) and decays with the damping ratio."""
    chain = replace(CABLE, friction=0.0, inclination=0.0, damping_ratio=0.05)
    t = np.linspace(0.0, 6.0, 1201)
    T = chain.run(t, eased(t, 0.0, 0.3, 0.01), substeps=4).tension - 800.0
    free = t > 2.0
    up = np.flatnonzero((T[:-1] < 0) & (T[1:] >= 0) & free[:-1])
    period = np.mean(np.diff(t[up]))
    wd = chain.first_frequency * math.sqrt(1 - 0.05**2)
    assert period == pytest.approx(2 * math.pi / wd, rel=3e-3)
    peaks = [T[a:b].max() for a, b in itertools.pairwise(up)]
    decay = -np.mean(np.diff(np.log(peaks)))
    assert decay == pytest.approx(2 * math.pi * 0.05 / math.sqrt(1 - 0.05**2), rel=0.01)


@pytest.mark.parametrize("law", [{}, {"drag": 30.0}, {"added": ((2.0, 0.0, 40.0),)}], ids=["plain", "drag", "load"])
def test_forced_vibration_of_the_damped_rod(law):
    """p = P sin(w t): n(s) = Im[-E* P k sin(k (L - s)) / cos(k L) e^{iwt}], E* = EA (1 + i w beta), k^2 = ((m + dm) w^2 - i w c) / E*.

    At the first resonance of the plain cable, where amplitude and phase are those of the damping; load and drag shift both.
    """
    chain = replace(CABLE, friction=0.0, inclination=0.0, elements=100, **law)
    w, P = chain.first_frequency, 1e-3
    t = np.linspace(0.0, 8.0, 801)
    run = chain.run(t, P * np.sin(w * t) * (1 - np.exp(-3 * t)) ** 2, stations=[10.0, 25.0], substeps=8)
    m, c = 4.6 + (2.0 if "added" in law else 0.0), law.get("drag", 0.0)
    E = 4e5 * (1 + 1j * w * chain.damping_time)
    k = np.sqrt((m * w**2 - 1j * w * c) / E)
    late = (t > 6.0) & (t < 7.5)  # the spline of the motion ends with zero acceleration
    for s, T in zip((0.0, 10.0, 25.0), (run.tension, *run.at), strict=True):
        exact = np.imag(-E * P * k * np.sin(k * (40.0 - s)) / np.cos(k * 40.0) * np.exp(1j * w * t))
        np.testing.assert_allclose(T[late] - 800.0, exact[late], atol=0.01 * np.abs(exact).max())


@pytest.mark.parametrize(
    "law",
    [
        {},
        {"drag": 3.0},
        {"fall": 0.1, "fall_speed": 0.05},
        {"fall": 0.1, "fall_speed": 0.05, "fall_power": 0.0},
        {"added": ((2.0, 5.0, 25.0),)},
    ],
)
def test_energy_is_balanced(law):
    """Work led in = kinetic + elastic + presliding + lost; what friction stores in its bristles counts as friction."""
    run = replace(CABLE, **law).run(TIME, eased(TIME, 1.0, 3.0, 0.6) - eased(TIME, 8.0, 3.0, 0.6), substeps=40)
    e = run.energies
    throughput = float(np.abs(e.friction).max() + e.damping.max() + e.kinetic.max())
    assert np.abs(e.imbalance).max() < 2e-3 * throughput  # friction at the end of a step: first order in the kinks
    assert e.friction[-1] > 0.5 * throughput
    assert (e.drag[-1] > 0) == ("drag" in law)


def test_convergence_of_order_two_in_time():
    """Without friction's kinks the error of the tension falls by four when the step is halved."""
    chain = replace(CABLE, friction=0.0, drag=2.0)
    position = eased(TIME, 1.0, 2.0, 0.6)
    exact = chain.run(TIME, position, substeps=160).tension
    error = [np.abs(chain.run(TIME, position, substeps=n).tension - exact).max() for n in (5, 10, 20)]
    assert np.log2(error[0] / error[1]) == pytest.approx(2.0, abs=0.15)
    assert np.log2(error[1] / error[2]) == pytest.approx(2.0, abs=0.15)


def test_the_chain_used_in_a_fit_is_fine_enough():
    """32 elements and 48 steps a period against 128 and 400, with friction: below 0.1 % of the tension."""
    position = eased(TIME, 1.0, 2.0, 0.6) - eased(TIME, 8.0, 2.0, 0.6)
    fine = replace(CABLE, elements=128).run(TIME, position, stations=[15.0], substeps=80)
    used = CABLE.run(TIME, position, stations=[15.0])
    for a, b in zip((used.tension, *used.at), (fine.tension, *fine.at), strict=True):
        assert np.sqrt(np.mean((a - b) ** 2)) < 1e-3 * np.sqrt(np.mean(b**2))


def test_friction_that_falls_with_speed():
    """Sliding at v, mu(v) = mu + fall exp(-v/vs): the pull is less where it is fast."""
    chain = replace(CABLE, fall=0.05, fall_speed=0.5, inclination=0.0)  # slow enough a fall to slide without stick-slip
    t = np.linspace(0.0, 12.0, 241)
    for v in (0.1, 0.5):
        run = chain.run(t, v * np.clip(t - 1.0, 0.0, 1.0) ** 2 / 2 + v * np.clip(t - 2.0, 0.0, None))
        mu = 0.35 + 0.05 * math.exp(-v / 0.5)
        assert run.tension[-1] - 800.0 == pytest.approx(mu * 4.6 * GRAVITY * 40, rel=2e-3)


def test_bad_input_is_told():
    with pytest.raises(InputError, match="station 50 m lies outside the cable"):
        CABLE.run(TIME, 0 * TIME, stations=[50.0])
    with pytest.raises(InputError, match="length must be positive"):
        replace(CABLE, length=0.0)
    with pytest.raises(InputError, match="not finite at sample 12"):
        CABLE.run(TIME, np.where(TIME > 1, np.nan, 0.0))


def test_energies_are_counted_where_they_are_asked_for():
    """The tension is the same to the last digit without them."""
    t, motion = led_motion(TIME, eased(TIME, 1.0, 3.0, 0.6), 8)
    counted, plain = (CABLE.led(t, motion, 8, tally=tally) for tally in (True, False))
    np.testing.assert_array_equal(counted.tension, plain.tension)
    assert len(counted.energies.led) == len(TIME) and len(plain.energies.led) == 0


def test_the_series_of_the_falling_friction():
    """exp(x) for |x| < 1/16 to 1e-12."""
    series = getattr(exponential, "py_func", exponential)
    for x in (-1 / 16, -0.01, 0.0, 0.03, 1 / 16):
        assert series(x) == pytest.approx(math.exp(x), rel=1e-12)


@pytest.mark.parametrize("power", [0.0, 1.0, 1.5, 2.0])
def test_falling_friction_does_not_depend_on_the_elements_that_are_kept(power):
    """At every speed of a slow ramp the pull is the integral of mu(v): within 0.5 % of the friction; power 0: the rational law."""
    chain = replace(CABLE, fall=0.05, fall_speed=0.3, fall_power=power, inclination=0.0)
    t = np.linspace(0.0, 40.0, 401)
    speed = 0.01 * np.clip(t - 1.0, 0.0, None)
    run = chain.run(t, 0.005 * np.clip(t - 1.0, 0.0, None) ** 2)
    weight = 4.6 * GRAVITY * 40
    x = speed / 0.3
    mu = 0.35 + 0.05 * (1 / (1 + x**2) if power == 0 else np.exp(-(x**power)))
    np.testing.assert_allclose(
        run.tension[100:] - 800.0, (mu * weight + 4.6 * 40 * 0.01)[100:], atol=0.005 * 0.35 * weight
    )


def test_stick_slip_of_a_fit_is_that_of_fine_steps():
    """A slow pull through falling friction: the default steps against eight times as many, 0.1 % of the swing.

    Friction with the mean speed of a step in the place of that at its end damps the oscillation numerically: 0.2 % here.
    """
    chain = replace(CABLE, fall=0.05, fall_speed=0.13, fall_power=0.0)
    t = np.linspace(0.0, 16.0, 201)
    position = eased(t, 1.0, 6.0, 0.5) - eased(t, 9.0, 6.0, 0.5)
    steps = chain.substeps(t)
    coarse, fine = (chain.run(t, position, substeps=n).tension for n in (steps, 8 * steps))
    assert np.abs(np.diff(np.sign(np.diff(fine)))).sum() > 20  # it does stick and slip
    assert np.sqrt(np.mean((coarse - fine) ** 2)) < 1e-3 * np.ptp(fine)

"""Viscous damping: loop energy pi c omega A^2, second-order rate, and a power law that scales with its exponent."""

from dataclasses import replace

import numpy as np
import pytest

from effects.effect import UNKNOWN, BenchPath
from effects.viscous_damping import EFFECT, LINEAR, POWER_LAW, STEPWISE


def sine(omega: float, amplitude: float = 0.01, n: int = 400, periods: float = 1.0) -> BenchPath:
    time = np.linspace(0.0, periods * 2 * np.pi / omega, int(n * periods) + 1)
    return BenchPath("tension", amplitude * np.sin(omega * time), time, largest=0.01)


@pytest.mark.parametrize("omega", [0.1, 2.0])
def test_loop_energy(omega):
    """pi omega A^2 per unit of stiffness times damping time; second order, so 1e-4 at 400 samples a period."""
    path = sine(omega)
    energy = np.trapezoid(LINEAR.respond(path)[:, 0], path.strain)
    np.testing.assert_allclose(energy, np.pi * omega * 0.01**2, rtol=3e-4)


def test_second_order():
    """Halving the sampling interval takes the error inside the record down to a quarter (2 % for higher orders)."""
    errors = []
    for n in (100, 200):
        path = sine(1.0, n=n)
        errors.append(np.abs(LINEAR.respond(path)[:, 0] - 0.01 * np.cos(path.time))[1:-1].max())
    np.testing.assert_allclose(errors[0] / errors[1], 4.0, rtol=0.02)


def test_no_force_at_rest_and_sign():
    """Constant strain gives nothing; growing strain a positive load."""
    time = np.linspace(0.0, 5.0, 11)
    path = BenchPath("tension", np.minimum(time, 2.0), time)
    rate = LINEAR.respond(path)[:, 0]
    np.testing.assert_allclose(rate[:4], 1.0)
    np.testing.assert_allclose(rate[5:], 0.0)


@pytest.mark.parametrize("exponent", [0.3, 1.0, 2.0])
def test_power_law(exponent):
    """Twice the rate gives 2^n times the load; it is odd; at the reference rate, largest strain per second, it is that."""
    slow, fast = sine(1.0), sine(2.0)
    one, two = (POWER_LAW.respond(p, exponent)[:, 0] for p in (slow, fast))
    np.testing.assert_allclose(two, 2.0**exponent * one, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(
        POWER_LAW.respond(slow.with_strain(-slow.strain), exponent)[:, 0], -one, rtol=1e-12, atol=1e-18
    )
    steady = BenchPath("tension", 0.01 * np.arange(4.0), np.arange(4.0), largest=0.01)
    np.testing.assert_allclose(POWER_LAW.respond(steady, exponent)[:, 0], 0.01, rtol=1e-12)


def test_central_rate_is_the_mean_of_two_steps():
    """At even samples the rate of the plain form is the mean of the steps before and after, which a rod goes through."""
    path = sine(1.0, n=60, periods=2.0)
    step, before, rates = path.time[1], np.zeros(1), []
    for strain in path.strain:
        now, _ = LINEAR.advance(np.array([strain]), before, step, UNKNOWN.strain, UNKNOWN.strain, np.zeros((1, 1)))
        rates.append(now[0, 0])
        before = np.array([strain])
    rates = np.array(rates)
    np.testing.assert_allclose(LINEAR.respond(path)[1:-1, 0], (rates[1:-1] + rates[2:]) / 2, rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(STEPWISE.respond(path)[1:, 0], rates[1:], rtol=1e-12)


def test_needs_a_clock():
    """Without time no rate: untestable, and no load."""
    path = replace(sine(1.0), time=None)
    assert "clock" in (EFFECT.why_untestable([path]) or "")
    assert EFFECT.why_untestable([path, sine(1.0)]) is None
    for form, shape in ((LINEAR, ()), (POWER_LAW, (0.5,)), (STEPWISE, ())):
        assert not form.respond(path, *shape).any()


def test_exact_for_a_parabola_at_uneven_instants():
    """Second order also where the clock is uneven: the rate of t^2 is 2 t inside the record, to rounding."""
    time = np.cumsum(np.random.default_rng(0).uniform(0.1, 1.0, size=30))
    rate = LINEAR.respond(BenchPath("tension", time**2, time))[:, 0]
    np.testing.assert_allclose(rate[1:-1], 2 * time[1:-1], rtol=1e-11)

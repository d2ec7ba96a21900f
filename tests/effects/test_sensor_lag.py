"""A sensor that comes late: first-order lag, two stages, pure delay, against their exact solutions."""

import numpy as np
import pytest

from effects.effect import BenchPath
from effects.sensor_lag import EFFECT

FIRST, SECOND, DELAY = EFFECT.forms
TIME = np.sort(np.concatenate([[0.0], np.random.default_rng(1).uniform(0, 20, 300)]))


def test_ramp_is_late_by_tau():
    """x = r t: y = r (t - tau (1 - exp(-t/tau))), on uneven samples too."""
    tau, r = 1.7, 0.3
    y = FIRST.respond(r * TIME[:, None], TIME, tau)[:, 0]
    assert y == pytest.approx(r * (TIME - tau * (1 - np.exp(-TIME / tau))), rel=1e-10, abs=1e-12)


def test_step_is_made_up_exponentially():
    """Constant after a ramp of one short step: the rest decays with exp(-t/tau)."""
    t = np.array([0.0, 1e-9, 0.5, 1.0, 3.0])
    y = FIRST.respond(np.array([0.0, 1.0, 1.0, 1.0, 1.0]), t, 0.8)
    assert y[2:] == pytest.approx(1 - np.exp(-t[2:] / 0.8), rel=1e-8)


@pytest.mark.parametrize(("tau", "tau_2"), [(0.5, 2.0), (2.0, 0.5), (1.0, 1.0), (1.0, 1.0 + 1e-7), (1e-6, 1.0)])
def test_two_stages_of_a_ramp(tau, tau_2):
    """y = r (t - (a + b) + (a^2 e^(-t/a) - b^2 e^(-t/b))/(a - b)); for a = b: r (t - 2a + (2a + t) e^(-t/a))."""
    y = SECOND.respond(TIME, TIME, tau, tau_2)
    if abs(tau - tau_2) < 1e-6:
        exact = TIME - 2 * tau + (2 * tau + TIME) * np.exp(-TIME / tau)
    else:
        decay = (tau**2 * np.exp(-TIME / tau) - tau_2**2 * np.exp(-TIME / tau_2)) / (tau - tau_2)
        exact = TIME - (tau + tau_2) + decay
    assert y == pytest.approx(exact, rel=1e-6, abs=2e-7)


def test_two_stages_are_the_lag_of_the_lag():
    """Fine samples, so that the first stage's output is nearly straight between them."""
    t = np.linspace(0, 20, 20001)
    x = np.sin(t)
    assert SECOND.respond(x, t, 0.7, 1.9) == pytest.approx(FIRST.respond(FIRST.respond(x, t, 0.7), t, 1.9), abs=1e-6)
    assert np.array_equal(SECOND.respond(x, t, 0.0, 1.9), FIRST.respond(x, t, 1.9))


def test_sine_is_damped_and_late_as_a_first_order_instrument():
    """After the transient: amplitude 1/sqrt(1 + (w tau)^2), phase atan(w tau)."""
    t, w, tau = np.linspace(0, 60, 60001), 2.0, 0.6
    y = FIRST.respond(np.sin(w * t), t, tau)[40000:]
    exact = np.sin(w * t[40000:] - np.arctan(w * tau)) / np.hypot(1, w * tau)
    assert y == pytest.approx(exact, abs=1e-6)


def test_pure_delay_moves_the_record():
    x = np.column_stack([TIME, 2 * TIME])
    expected = np.maximum(TIME - 3.0, 0.0)
    assert DELAY.respond(x, TIME, 3.0) == pytest.approx(np.column_stack([expected, 2 * expected]), rel=1e-9, abs=1e-12)


def test_every_form_is_linear_and_starts_at_rest():
    a, b = np.random.default_rng(2).normal(size=(2, len(TIME), 2))
    for form in EFFECT.forms:
        shape = [0.9, 0.4][: len(form.shape)]
        both = form.respond(2 * a - 3 * b, TIME, *shape)
        parts = 2 * form.respond(a, TIME, *shape) - 3 * form.respond(b, TIME, *shape)
        assert both == pytest.approx(parts, rel=1e-9, abs=1e-11)
        assert np.array_equal(form.respond(a, TIME, *shape)[0], a[0])
        constant = np.full((len(TIME), 1), 7.0)
        assert form.respond(constant, TIME, *shape) == pytest.approx(constant, rel=1e-12)


def test_without_lag_or_clock_the_signal_is_left_exactly_as_it_is():
    x = np.random.default_rng(3).normal(size=(len(TIME), 2))
    for form in EFFECT.forms:
        assert np.array_equal(form.respond(x, TIME, *(0.0 for _ in form.shape)), x)
        assert np.array_equal(form.respond(x, None, *(1.0 for _ in form.shape)), x)
    assert "time [s]" in str(EFFECT.why_untestable([BenchPath("tension", TIME)]))

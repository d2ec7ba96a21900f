"""The simulators of the blind towing campaigns: closed forms, each against the other, and the laws of what is hidden."""

import math

import numpy as np
import pytest

from benchmarks.blind_towing.exudyn_line import Extra, installed, tow_exudyn
from benchmarks.blind_towing.motion import to_and_fro
from benchmarks.blind_towing.towed_line import GRAVITY, Line, Trough, rest_tension, tow
from benchmarks.blind_towing.truths import lagged, mobilised, play

LINE = Line(30.0, 4e5, 5.0, 0.35)
T = np.linspace(0.0, 4.0, 41)
DRIVE = to_and_fro(0.4, 4.0)


COULOMB = Trough()


def one(trough=COULOMB, slope=0.1, drive=DRIVE, line=LINE, substeps=50):
    return tow(line, [drive], [slope], [900.0], trough, T, [12.0], substeps)[0]


def test_at_rest_the_tension_is_tail_and_weight_below():
    """T(s) = tail + m g sin(slope) (L - s); exact."""
    y = one()[:, 0]
    expected = [900 + GRAVITY * 5 * math.sin(0.1) * (30 - s) for s in (0, 12)]
    np.testing.assert_allclose(y, expected, rtol=1e-12)


def test_steady_sliding_carries_friction_of_everything_below():
    """T(s) = tail + m g (sin + mu cos) (L - s) and c v (L - s); 0.5 %: the first mode still rings, damped to exp(-4)."""
    begin, v = 0.0, 0.3

    def steady(t):
        return np.maximum(t - 0.5, 0) * v + np.where(t < 0.5, v * t**2, 0.25 * v), v * np.minimum(2 * t, 1), begin * t

    for s, y in zip((0, 12), one(Trough(drag=6.0), drive=steady)[:, -8:].mean(axis=1), strict=True):
        assert y == pytest.approx(
            900 + (30 - s) * (5 * GRAVITY * (math.sin(0.1) + 0.35 * math.cos(0.1)) + 6 * v), rel=5e-3
        )


def test_load_counts_in_weight_and_friction():
    """A load on all cells is a line of that mass with the old damping."""
    heavy = Line(30.0, 4e5, 6.0, 0.35, 0.1 * math.sqrt(6 / 5) ** -1)
    assert heavy.beta == pytest.approx(LINE.beta)
    np.testing.assert_allclose(one(Trough(load=1.0)), one(line=heavy), rtol=1e-9)
    assert rest_tension(LINE, 1.0, 0.1, 900.0, np.zeros(1)) == pytest.approx(900 + 6 * 30 * GRAVITY * math.sin(0.1))


def test_cells_converge():
    """Doubling the cells divides the error by four where the line slides; 3 leaves room for stick and slip."""
    rough, middle, fine = (one(line=Line(30.0, 4e5, 5.0, 0.35, cells=n), substeps=100) for n in (12, 24, 48))
    first, second = (np.sqrt(np.mean((a - b) ** 2)) for a, b in ((rough, middle), (middle, fine)))
    assert second < first / 3


@pytest.mark.skipif(not installed(), reason="the peer is not installed")
def test_both_simulators_agree():
    """Within 0.3 % of the swing of the tension, with friction that falls with speed: other discretisation, other integrator."""
    t = np.linspace(0.0, 2.4, 25)
    drive = to_and_fro(0.4, 4.0)
    extra = Extra(fall=0.06, fall_speed=0.15)
    peer = tow_exudyn(LINE, drive, 0.1, 900.0, extra, t, (12.0,), pieces=16)
    falls = Trough(more=lambda v, way, s: 0.06 / (1 + (v / 0.15) ** 2))
    own = tow(LINE, [drive], [0.1], [900.0], falls, t, [12.0], 50)[0]
    apart = np.sqrt(np.mean((peer - own) ** 2, axis=1))
    assert (apart < 3e-3 * np.ptp(own, axis=1)).all()
    plain = tow(LINE, [drive], [0.1], [900.0], Trough(), t, [12.0], 50)[0]
    assert np.sqrt(np.mean((plain - own) ** 2)) > 20 * apart.max()


def test_play_lag_and_turning():
    """Dead travel at a reversal only; a ramp lags by tau; the direction is mobilised over its travel."""
    p = np.concatenate([np.linspace(0, 1, 101), np.linspace(1, 0, 101)[1:]])
    followed = play(p, 0.1, 0.0)
    np.testing.assert_allclose(followed[:101], p[:101], atol=1e-12)
    np.testing.assert_allclose(followed[101:], np.minimum(1.0, p[101:] + 0.1), atol=1e-12)
    t = np.linspace(0, 5, 501)
    np.testing.assert_allclose(lagged(t, 2 * t, 0.3)[-1], 2 * (5 - 0.3), rtol=1e-6)
    z = mobilised(p, 0.02)
    assert z[0] == 0 and z[100] == pytest.approx(1, abs=1e-6) and z[-1] == pytest.approx(-1, abs=1e-6)

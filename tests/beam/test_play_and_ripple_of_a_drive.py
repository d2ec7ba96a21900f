"""Play and measured ripple of a drive: the play operator, and one motion whose speed has the given harmonics."""

import numpy as np
import pytest

from beam import read_scenario
from beam.drive_play import EDGE, DrivePlay, reversals
from beam.motion import SpeedRamp
from beam.motion_curve import MotionCurve
from beam.motion_reciprocating import ReciprocatingStroke
from beam.speed_ripple import SpeedRipple
from geometry.errors import SpecError

B = 0.02
STROKES = ReciprocatingStroke(stroke=0.3, speed=0.1, ramp=0.5, pause=0.2)
TIMES = np.linspace(0.0, 14.0, 4001)


def course(motion, times=TIMES):
    """Displacement, velocity, acceleration along x, (3, k)."""
    return np.array([[x[0] for x in motion(float(t))] for t in times]).T


def play_operator(x, begin):
    """u = x - z with |z| <= b/2, sample by sample."""
    z = np.empty(len(x))
    z[0] = 0.5 * B * begin
    for i in range(1, len(x)):
        z[i] = np.clip(z[i - 1] + x[i] - x[i - 1], -0.5 * B, 0.5 * B)
    return x - z + z[0]


@pytest.mark.parametrize("begin", [1.0, 0.0, -1.0])
def test_the_end_follows_the_play_operator_but_where_the_clamps_come_to_bear(begin):
    """Beyond the travel e = b/5 it is exact; within, the ramp is ahead by at most h(0) = 3 e/32."""
    x = course(STROKES)[0]
    u = course(DrivePlay(STROKES, B, 14.0, begin))[0]
    off = u - play_operator(x, begin)
    largest = 3 / 32 * EDGE * B
    assert 0.9 * largest < np.abs(off).max() < largest * (1 + 1e-9)  # samples of 0.35 mm miss the middle of 4 mm
    assert (np.abs(off) > 1e-12).mean() < 0.05
    assert np.ptp(u) == pytest.approx(0.3 - (0.0 if begin == 1 else 0.5 * B * (1 - begin)), abs=1e-9)


def test_the_end_moves_without_jumps_of_the_speed():
    """v = u', a = v': central differences, but at the reversals where the end is let go while the drive brakes."""
    play, h = DrivePlay(STROKES, B, 14.0), 1e-5
    t = TIMES[1:-1:7]
    t = t[np.min(np.abs(t[:, None] - np.array(reversals(STROKES, 14.0))), axis=1) > 1e-3]
    (u0, v0, _), (_, v, a), (u1, v1, _) = course(play, t - h), course(play, t), course(play, t + h)
    assert (u1 - u0) / (2 * h) == pytest.approx(v, abs=2e-6)
    assert (v1 - v0) / (2 * h) == pytest.approx(a, abs=2e-3)
    assert np.abs(np.diff(course(play)[1])).max() < 0.02  # a quarter of the speed would be a jump


def test_strokes_within_the_play_do_not_move_the_end():
    """Strokes of 15 mm in a play of 20 mm, from where it is taken up: the end stays, within the e/2 by which clamps bear early."""
    small = ReciprocatingStroke(stroke=0.015, speed=0.02, ramp=0.5, pause=0.0)
    u = course(DrivePlay(small, B, 14.0))[0]
    assert u[TIMES > 1.25] == pytest.approx(0.015, abs=0.5 * EDGE * B) and len(reversals(small, 14.0)) > 5
    assert len(reversals(SpeedRamp(0.1, 0.0, 1.0), 5.0)) == 1
    curve = MotionCurve(np.array([0.0, 1.0, 2.0]), np.array([0.0, 0.1, -0.1]))  # arrays cannot be kept by their value
    assert (
        reversals(curve, 2.0) == pytest.approx([0.0, reversals(curve, 2.0)[1]]) and 1.4 < reversals(curve, 2.0)[1] < 1.6
    )


def test_the_ripple_has_its_harmonics_and_keeps_the_mean():
    """v/v_b - 1 over a pocket has the given Fourier parts; u is where the even drive is after each pocket."""
    parts = ((0.05, 0.02), (0.01, -0.03))
    drive = SpeedRipple(SpeedRamp(0.1, 0.0, 1e-3), 0.08, parts)
    t = 0.00050 + np.arange(0.8, 1.6, 0.8 / 256)  # the ramp is behind by half its time
    u, v, _ = course(drive, t)
    spectrum = np.fft.rfft(v / 0.1 - 1) / 128
    assert spectrum[1:4] == pytest.approx([0.05 + 0.02j, 0.01 - 0.03j, 0.0], abs=1e-12)
    assert abs(spectrum[0]) < 1e-12 and u[0] == pytest.approx(0.08, abs=1e-12)


def test_what_cannot_be_is_a_sentence():
    scenario = read_scenario("intelligent-horizontal")
    for changes, words in (
        ({"drive__ripple_cosine": 0.1}, "add drive.ripple_travel"),
        (
            {"drive__ripple_travel": "0.1 m", "drive__ripple_cosine": 0.8, "drive__ripple_sine": 0.8},
            "would turn it back",
        ),
        ({"drive__play_taken_up": 0.0}, "add drive.play"),
    ):
        with pytest.raises(SpecError, match=words):
            scenario.changed(**changes)
    with pytest.raises(SpecError, match="within it"):
        DrivePlay(STROKES, B, 1.0, 2.0)
    with pytest.raises(SpecError, match="less than the speed"):
        SpeedRipple(STROKES, 0.1, ((1.0, 0.0),))

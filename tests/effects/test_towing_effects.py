"""Effects of towing on the axial chain: each against its law in a limit, and nothing of it with strengths of zero."""

import math
from dataclasses import replace

import numpy as np
import pytest

from beam.axial_chain import GRAVITY, AxialChain
from effects import find, library
from effects.stop_operator import stop
from effects.towed_cable import TowedCable

L, M, MU, TAIL = 30.0, 4.6, 0.35, 800.0
TIME = np.linspace(0.0, 12.0, 121)
CHAIN = AxialChain(L, 4e5, M, MU, TAIL, 0.0, elements=16)
TOWING = [e for e in library() if e.kinds == ("towing",)]


def ramp(speed: float) -> np.ndarray:
    """Rest, then the given speed from 2 s on."""
    t = np.clip(TIME - 1.0, 0.0, 1.0)
    return speed * (t**3 - t**4 / 2 + np.clip(TIME - 2.0, 0.0, None))


def steady(name: str, speed: float, strength=(), shape=(), chain=CHAIN, form=0, stations=()) -> list[float]:
    cable = TowedCable(chain, TIME, ramp(speed))
    return [float(T[-1]) for T in find(name).forms[form].respond(cable, strength, *shape).tensions(stations)]


@pytest.mark.parametrize(("effect", "form"), [(e, f) for e in TOWING for f in e.forms], ids=lambda v: v.name)
def test_nothing_of_an_effect_is_the_base_model_to_the_last_digit(effect, form):
    cable = TowedCable(CHAIN, TIME, ramp(0.2) - 2 * ramp(0.1))
    shape = [p.starts([]) if p.starts and form.stage == "chain" else [0.0] for p in form.shape]
    changed = form.respond(cable, (0.0,) * len(form.strength), *(float(s[0]) for s in shape))
    for a, b in zip(changed.tensions([10.0]), cable.tensions([10.0]), strict=True):
        np.testing.assert_array_equal(a, b)


def test_stribeck_at_two_speeds():
    """Steady sliding at v: T - T_tail = (mu + fall exp(-(v/vs)^p)) m g L."""
    for power, form in ((1, 0), (2, 1)):
        for v in (0.1, 0.4):
            mu = MU + 0.04 * math.exp(-((v / 0.4) ** power))
            found = steady("trough-friction-stribeck", v, (0.04,), (0.4,), form=form)[0]
            assert found - TAIL == pytest.approx(mu * M * GRAVITY * L, rel=1e-3)  # waves of the start


def test_viscous_drag_is_proportional_to_speed():
    """T - T_tail - mu m g L = c v L."""
    for v in (0.1, 0.4):
        found = steady("viscous-drag", v, (5.0,))[0] - TAIL - MU * M * GRAVITY * L
        assert found == pytest.approx(5.0 * v * L, rel=0.01)  # waves of the start


def test_added_load_rubs_weighs_and_is_told_by_a_station():
    """On an incline (sin + mu cos) g dm per length, only below the station that reads it."""
    inclined = replace(CHAIN, inclination=0.2)
    g = GRAVITY * (math.sin(0.2) + MU * math.cos(0.2))
    plain = steady("added-load", 0.2, (0.0,), chain=inclined, stations=[20.0])
    for form, shape, at_end, at_station in (
        (0, (), 30.0, 10.0),
        (1, (5.0, 12.0), 7.0, 0.0),
        (1, (15.0, 25.0), 10.0, 5.0),
    ):
        loaded = steady("added-load", 0.2, (1.2,), shape, inclined, form, [20.0])
        assert loaded[0] - plain[0] == pytest.approx(1.2 * g * at_end, rel=2e-3)
        assert loaded[1] - plain[1] == pytest.approx(1.2 * g * at_station, abs=2e-3 * 1.2 * g * L)


def test_roller_takes_its_part_of_the_tension_with_the_sign_of_the_motion():
    """T_read / T = 1 + c pulled, 1 - c let down, 1 at rest; inside the cable nothing changes."""
    cable = TowedCable(CHAIN, TIME, np.where(TIME < 6, ramp(0.2), 2 * ramp(0.2)[60] - ramp(0.2)))
    bent = find("roller-resistance").forms[0].respond(cable, (0.1,))
    (T, inside), (R, inside_too) = cable.tensions([10.0]), bent.tensions([10.0])
    np.testing.assert_array_equal(inside, inside_too)
    assert (R / T)[[0, 50, 110]] == pytest.approx([1.0, 1.1, 0.9], rel=1e-12)


def test_stop_and_play_are_complements():
    """The stop holds +-limit; p minus it follows only beyond the play."""
    p = np.array([0.0, 1.0, 3.0, 2.0, -2.0, -1.0])
    np.testing.assert_array_equal(stop(p, 1.0, 0.0), [0.0, 1.0, 1.0, 0.0, -1.0, 0.0])


def test_clamp_stands_still_while_the_play_is_crossed():
    """Centred play b: the cable moves only after b/2; taken up: at once, and after a reversal it waits for b."""
    slow = ramp(0.01)
    for form, free in ((0, 0.0), (1, 0.02)):
        cable = TowedCable(CHAIN, TIME, slow)
        T = find("clamp-backlash").forms[form].respond(cable, (), 0.04).tensions()[0]
        begins = slow[np.flatnonzero(T > TAIL + 5.0)[0]]
        assert begins == pytest.approx(free, abs=0.0015)  # a sample is 1 mm


def test_polygon_ripple_has_the_period_of_the_pockets():
    """At constant speed the ripple of the tension has the frequency v / pocket travel."""
    t = np.linspace(0.0, 40.0, 1601)
    cable = TowedCable(replace(CHAIN, friction=0.0), t, 0.1 * t - 0.1 * (1 - np.exp(-t)))
    T = find("polygon-effect").forms[0].respond(cable, (0.05, 0.0), 0.1).tensions()[0][800:]
    spectrum = np.abs(np.fft.rfft((T - T.mean()) * np.hanning(len(T))))
    frequency = np.fft.rfftfreq(len(T), t[1])[int(np.argmax(spectrum))]
    assert frequency == pytest.approx(0.1 / 0.1, abs=0.05)  # a line of the spectrum


def test_polygon_drive_is_one_motion_with_its_phase_at_the_start():
    """v = p', a = v'; the speed is (1 + A) v at a pocket's begin and (1 - B) v a quarter of it later."""
    t = np.linspace(0.0, 4.0, 4001)
    x, v, a = 0.01 * t**3, 0.03 * t**2, 0.06 * t
    (drive,) = find("polygon-effect").forms[0].respond(TowedCable(CHAIN, t, x), (0.05, 0.02), 0.1).drives
    p1, v1, a1 = drive(t, np.column_stack([x, v, a])).T
    for rate, found in ((p1, v1), (v1, a1)):
        np.testing.assert_allclose(np.gradient(rate, t)[1:-1], found[1:-1], atol=2e-3 * np.abs(found).max())
    ratio = np.interp([0.0, 0.1, 0.125, 0.15], x[1:], (v1[1:] / v[1:]))
    assert ratio == pytest.approx([1.05, 1.05, 0.98, 0.95], abs=1e-4)


def test_two_harmonics_are_one_motion_and_the_second_passes_twice_a_pocket():
    """v = p', a = v'; with the second part alone the ripple is that of half the pocket travel, with the first alone the plain form."""
    t = np.linspace(0.0, 4.0, 4001)
    motion = np.column_stack([0.01 * t**3, 0.03 * t**2, 0.06 * t])
    cable, (plain, two) = TowedCable(CHAIN, t, motion[:, 0]), find("polygon-effect").forms

    def led(form, strength, travel):
        return form.respond(cable, strength, travel).drives[0](t, motion)

    p1, v1, a1 = led(two, (0.05, 0.02, 0.01, -0.02), 0.1).T
    for rate, found in ((p1, v1), (v1, a1)):
        np.testing.assert_allclose(np.gradient(rate, t)[1:-1], found[1:-1], atol=4e-3 * np.abs(found).max())
    np.testing.assert_allclose(led(two, (0.05, 0.02, 0.0, 0.0), 0.1), led(plain, (0.05, 0.02), 0.1), atol=1e-14)
    np.testing.assert_allclose(led(two, (0.0, 0.0, 0.05, 0.02), 0.1), led(plain, (0.05, 0.02), 0.05), atol=1e-14)


def test_clamp_drive_is_one_motion():
    """Outside the play the end moves as told, b behind after a reversal; inside it stands."""
    t = np.linspace(0.0, 2.0, 401)
    x = np.where(t < 1.0, t, 2.0 - t)
    motion = np.column_stack([x, np.where(t < 1.0, 1.0, -1.0), 0 * t])
    (drive,) = find("clamp-backlash").forms[0].respond(TowedCable(CHAIN, t, x), (), 0.2).drives
    p, v, _ = drive(t, motion).T
    expected = np.where(t < 1.0, t, np.minimum(1.0, 2.2 - t))
    np.testing.assert_allclose(p, expected, atol=1e-12)
    np.testing.assert_array_equal(v[[100, 220, 300]], [1.0, 0.0, -1.0])


def test_ratio_error_scales_the_motion():
    """A linear chain answers (1 + e) times as much; a rigid one feels (1 + e) a."""
    cable = TowedCable(replace(CHAIN, friction=0.0), TIME, ramp(0.3))
    T = cable.tensions()[0] - TAIL
    R = find("trolley-ratio-error").forms[0].respond(cable, (0.1,)).tensions()[0] - TAIL
    np.testing.assert_allclose(R, 1.1 * T, atol=1e-6 * np.abs(T).max())

"""Free play in the grips: nothing is felt for half the play to either side, then the linear law, moved by that much."""

import numpy as np
import pytest

from effects.backlash import EFFECT
from effects.effect import BenchPath

SHARP, GRADUAL, UNEQUAL = EFFECT.forms
STRAIN = 0.02 * np.sin(np.linspace(0.0, 12.0, 400))


def at(length, strain=STRAIN, kind="tension"):
    return BenchPath(kind, strain, length=length, largest=0.02)


def test_dead_zone_is_half_the_play_to_either_side():
    """u = 6, 10, -8 mm with 8 mm of play over 2 m leave 2, 6 and -4 mm."""
    u = np.array([0.0, 3.0, 4.0, 6.0, 10.0, -4.0, -8.0]) * 1e-3
    expected = np.array([0.0, 0.0, 0.0, 2.0, 6.0, 0.0, -4.0]) * 1e-3
    assert SHARP.respond(at(2.0, u / 2.0), 8e-3) == pytest.approx(expected / 2.0, rel=1e-12, abs=1e-18)


def test_lost_strain_goes_with_one_over_length():
    short, long = (STRAIN - SHARP.respond(at(L), 4e-3) for L in (1.0, 4.0))
    assert np.abs(short).max() == pytest.approx(2e-3, rel=1e-12)
    assert np.abs(long).max() == pytest.approx(0.5e-3, rel=1e-12)


def test_without_a_length_the_specimen_is_one_metre_long():
    for form, shape in ((SHARP, (3e-3,)), (GRADUAL, (3e-3, 0.5)), (UNEQUAL, (3e-3, 1e-3))):
        assert np.array_equal(form.respond(at(None), *shape), form.respond(at(1.0), *shape))


def test_energy_is_not_lost():
    """Loading and unloading are one curve: the loop of a closed path encloses nothing."""
    closed = np.concatenate([np.linspace(0, 0.02, 500), np.linspace(0.02, 0, 500)])
    for form, shape in ((SHARP, (4e-3,)), (GRADUAL, (4e-3, 0.5)), (UNEQUAL, (4e-3, 1e-3))):
        load = form.respond(at(2.0, closed), *shape)
        assert load == pytest.approx(load[::-1], rel=1e-12)


def test_gradual_contact_becomes_sharp_as_the_rounding_goes_to_zero():
    """The largest difference is at the contact, half play (1 - 2^-r): about 0.69 r/2 of the play."""
    sharp = SHARP.respond(at(2.0), 8e-3)
    contact = np.array([4e-3 / 2.0])
    for rounding in (0.4, 0.1, 0.02):
        gradual = GRADUAL.respond(at(2.0), 8e-3, rounding)
        bound = 2e-3 * (1 - 2**-rounding)
        assert np.abs(gradual - sharp).max() <= bound * (1 + 1e-9)
        assert GRADUAL.respond(at(2.0, contact), 8e-3, rounding)[0] == pytest.approx(bound, rel=1e-9)


def test_gradual_contact_is_odd_and_never_against_the_path():
    rising = np.linspace(-0.02, 0.02, 801)
    for rounding in (0.05, 0.5, 2.0):
        section = GRADUAL.respond(at(2.0, rising), 8e-3, rounding)
        assert np.diff(section).min() >= -1e-15
        assert section == pytest.approx(-section[::-1], abs=1e-15)


def test_unequal_play_is_the_free_play_seen_from_another_rest():
    """A joint that rests d off the middle: the record begins at zero path, so the ways are play/2 -+ d."""
    up, down = 3e-3, 1e-3
    moved = SHARP.respond(at(1.0, STRAIN - (up - down) / 2), up + down)
    assert UNEQUAL.respond(at(1.0), up, down) == pytest.approx(moved, rel=1e-9, abs=1e-15)
    assert np.array_equal(UNEQUAL.respond(at(1.0), 2e-3, 2e-3), SHARP.respond(at(1.0), 4e-3))


def test_without_play_the_path_is_left_exactly_as_it_is():
    for form in EFFECT.forms:
        assert np.array_equal(form.respond(at(2.0), *(0.0 for _ in form.shape)), STRAIN)
    assert np.array_equal(GRADUAL.respond(at(2.0), 0.0, 0.5), STRAIN)


def test_play_is_a_length_or_an_angle():
    play = SHARP.shape[0]
    assert [play.unit_for(k) for k in EFFECT.kinds] == ["m", "rad", "rad", "m"]

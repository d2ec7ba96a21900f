"""Offset and drift: a bias that is the same in all records, and one that starts at zero with each."""

import numpy as np
import pytest

from effects.effect import BenchPath
from effects.sensor_drift import EFFECT as DRIFT
from effects.sensor_offset import EFFECT as OFFSET

TIME = np.array([5.0, 6.0, 9.0, 14.0])
PATH = BenchPath("bending", np.array([0.0, 0.1, 0.2, 0.1]), TIME, largest=0.2)
FORMS = {form.name: form for form in DRIFT.forms}


def test_offset_is_one_constant_whatever_the_record():
    assert np.array_equal(OFFSET.forms[0].respond(PATH), np.ones((4, 1)))


def test_drift_starts_at_zero_with_the_record_and_is_of_time():
    t = TIME - 5.0
    assert np.array_equal(FORMS["proportional to time"].respond(PATH)[:, 0], t)
    assert FORMS["root of time"].respond(PATH)[:, 0] ** 2 == pytest.approx(t, rel=1e-14)
    assert FORMS["bent"].respond(PATH) == pytest.approx(np.column_stack([t, t * t]), rel=1e-14)


def test_settling_drift_solves_first_order_relaxation():
    """tau db/dt = 1 - b: 63 % after tau; proportional to time at first, a jump in the limit of no time."""
    settling = FORMS["settling"].respond
    assert settling(PATH, 4.0)[2, 0] == pytest.approx(1 - np.exp(-1), rel=1e-14)
    assert settling(PATH, 1e6)[:, 0] * 1e6 == pytest.approx(TIME - 5.0, rel=1e-5)
    assert np.array_equal(settling(PATH, 0.0)[:, 0], [0, 1, 1, 1])


def test_without_a_clock_drift_is_nothing_and_says_so():
    still = BenchPath("bending", PATH.strain, largest=0.2)
    for form in DRIFT.forms:
        assert not np.any(form.respond(still, *(1.0 for _ in form.shape)))
    assert "time [s]" in str(DRIFT.why_untestable([still]))
    assert DRIFT.why_untestable([still, PATH]) is None
    assert OFFSET.why_untestable([still]) is None

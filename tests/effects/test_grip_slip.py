"""Grips that slide: exact on fresh ground, elastic on the way back, and what slid does not come back."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from effects.effect import BenchPath
from effects.grip_slip import EFFECT

FORMS = {form.name: form for form in EFFECT.forms}
BITES, SUDDEN = FORMS["bites as it slides"], FORMS["one sudden slip"]
ENDING, EITHER = FORMS["comes to an end"], FORMS["bites to either side"]
CYCLES, CREEPS = FORMS["slides in every cycle"], FORMS["creeps under load"]
L, SLIP, LIMIT = 2.0, 3.0, 0.002


def path(*corners, length=L, n=200, time=None):
    legs = [np.linspace(a, b, n, endpoint=False) for a, b in pairwise(corners)]
    strain = np.concatenate([*legs, [corners[-1]]])
    return BenchPath("tension", strain, time, length, largest=0.01)


def test_fresh_ground_is_softer_by_one_plus_slip_over_length():
    p = path(0.0, 0.01)
    seen = BITES.respond(p, SLIP, LIMIT)
    exact = np.where(p.strain < LIMIT, p.strain, LIMIT + (p.strain - LIMIT) / (1 + SLIP / L))
    assert seen == pytest.approx(exact, rel=1e-12)


def test_the_answer_does_not_depend_on_the_sampling():
    """Exact steps: a leg in one step ends where the leg in many steps ends."""
    corners = (0.0, 0.008, -0.004, 0.009, -0.01, 0.003)
    for form, shape in ((BITES, (SLIP, LIMIT)), (EITHER, (SLIP, LIMIT)), (CYCLES, (SLIP, LIMIT))):
        coarse = form.respond(path(*corners, n=1), *shape)
        fine = form.respond(path(*corners, n=500), *shape)[::500]
        if form is CYCLES:  # a leg through zero is two legs: before and after
            coarse, fine = coarse[:2], fine[:2]
        assert coarse == pytest.approx(fine, rel=1e-11)


def test_unloading_is_elastic_and_leaves_the_slip():
    """Back at zero path the specimen is pushed by the slip over the length, and a second equal cycle slides no more."""
    p = path(0.0, 0.01, 0.0, 0.01)
    seen = BITES.respond(p, SLIP, LIMIT)
    slip = SLIP / L * (seen[200] - LIMIT)
    assert p.strain[200:] - seen[200:] == pytest.approx(np.full(401, slip), rel=1e-12)


def test_measured_extension_is_never_smaller_than_the_true_one_under_load():
    p = path(0.0, 0.01, 0.003, 0.012)
    for form, shape in ((BITES, (SLIP, LIMIT)), (SUDDEN, (2e-3, LIMIT)), (ENDING, (4e-3, LIMIT, 1e-3))):
        assert (p.strain - form.respond(p, *shape)).min() >= 0


def test_slip_over_length_halves_for_twice_the_length():
    lost = [0.01 - SUDDEN.respond(path(0.0, 0.01, length=length), 2e-3, LIMIT)[-1] for length in (1.0, 2.0)]
    assert lost == pytest.approx([2e-3, 1e-3], rel=1e-12)


def test_sudden_slip_happens_once_and_stays():
    p = path(0.0, 0.01, -0.01, 0.01)
    lost = p.strain - SUDDEN.respond(p, 2e-3, LIMIT)
    assert np.array_equal(lost == 0, np.arange(len(lost)) <= np.argmax(p.strain > LIMIT) - 1)
    assert lost[lost != 0] == pytest.approx(1e-3, rel=1e-12)


def test_one_limit_for_both_sides_against_one_for_each():
    """After +1 % with slip the way back to -1 % strains the specimen more; with limits of their own it slides from the first limit."""
    p = path(0.0, 0.01, -0.01)
    common, own = BITES.respond(p, SLIP, LIMIT), EITHER.respond(p, SLIP, LIMIT)
    top = common[200]
    slip = 0.01 - top
    assert own[200] == pytest.approx(top, rel=1e-14)
    trial = 0.01 + slip  # size of the strain at -1 % if nothing slid
    assert -common[-1] == pytest.approx(top + (trial - top) / (1 + SLIP / L), rel=1e-12)
    assert -own[-1] == pytest.approx(LIMIT + (trial - LIMIT) / (1 + SLIP / L), rel=1e-12)


def test_slip_in_every_cycle_adds_up():
    """Loaded n times to a path that grows by the last slip, the grip slides by the same amount each time."""
    once = 0.01 - CYCLES.respond(path(0.0, 0.01), SLIP, LIMIT)[-1]
    p = path(0.0, 0.01, once, 0.01 + once, 2 * once, 0.01 + 2 * once)
    lost = p.strain - CYCLES.respond(p, SLIP, LIMIT)
    assert lost[[200, 600, 1000]] == pytest.approx(once * np.array([1, 2, 3]), rel=1e-12)
    again = path(0.0, 0.01, once, 0.01)
    assert 0.01 - CYCLES.respond(again, SLIP, LIMIT)[-1] == pytest.approx(once * (1 + 1 / (1 + SLIP / L)), rel=1e-12)
    assert 0.01 - BITES.respond(again, SLIP, LIMIT)[-1] == pytest.approx(once, rel=1e-12)


@pytest.mark.parametrize("width", [1e-4, 1e-3, 1e-2])
def test_slip_that_comes_to_an_end_solves_its_law(width):
    whole = 6e-3
    p = path(0.0, 0.01, 0.002, 0.012)
    seen = ENDING.respond(p, whole, LIMIT, width)

    def law(m, x):
        return m + whole / L * (1 - np.exp(-(m - LIMIT) / width)) - x

    for i in (120, 200, 600):
        assert seen[i] == pytest.approx(brentq(law, LIMIT, 0.02, args=(p.strain[i],), xtol=1e-16), rel=1e-10)
    assert p.strain[300] - seen[300] == pytest.approx(0.01 - seen[200], rel=1e-12)


def test_wide_and_narrow_ends_are_the_biting_and_the_sudden_grip():
    p = path(0.0, 0.01, 0.0)
    wide = ENDING.respond(p, SLIP * 1e3, LIMIT, 1e3)
    assert wide == pytest.approx(BITES.respond(p, SLIP, LIMIT), abs=1e-8)  # width/strain = 1e-5
    narrow = ENDING.respond(p, 2e-3, LIMIT, 1e-6)
    sudden = SUDDEN.respond(p, 2e-3, LIMIT)
    past = np.arange(len(narrow)) > 80  # the jump itself needs 1 mm more of path to be done
    assert narrow[past] == pytest.approx(sudden[past], rel=1e-9, abs=1e-15)


def test_creep_follows_its_differential_equation():
    """de/dt = dx/dt - v/L (|e| - limit)+ sign(e), to the other side and back, against an adaptive integrator."""
    speed, corners, leg = 0.4, (0.0, 0.01, 0.01, -0.008, 0.002), 10.0
    knots = leg * np.arange(len(corners))
    p = path(*corners, n=25, time=np.linspace(0, knots[-1], 25 * (len(corners) - 1) + 1))
    seen = CREEPS.respond(p, speed, LIMIT)

    def rate(t, e):
        i = min(int(t / leg), len(corners) - 2)
        return (corners[i + 1] - corners[i]) / leg - speed / L * np.sign(e) * np.maximum(np.abs(e) - LIMIT, 0)

    start, exact = np.zeros(1), [0.0]
    for a, b in pairwise(p.time):
        start = solve_ivp(rate, (a, b - 1e-9), start, rtol=1e-10, atol=1e-13).y[:, -1]
        exact.append(start[0])
    assert seen == pytest.approx(np.array(exact), abs=1e-9)
    coarse = path(*corners, n=1, time=knots)
    assert CREEPS.respond(coarse, speed, LIMIT) == pytest.approx(seen[::25], rel=1e-10)


def test_no_slip_leaves_the_path_exactly_as_it_is():
    p = path(0.0, 0.01, -0.01, 0.012, time=np.linspace(0, 60, 601))
    for form in EFFECT.forms:
        assert np.array_equal(form.respond(p, *(0.0 for _ in form.shape)), p.strain)
        assert np.array_equal(form.respond(p, 0.0, *(1e-3 for _ in form.shape[1:])), p.strain)

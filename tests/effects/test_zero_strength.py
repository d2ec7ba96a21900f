"""With nothing of an effect the linear model is left as it was, to the last digit."""

from itertools import product

import numpy as np
import pytest

from effects.effect import ActiveEffect, BenchPath
from effects.library import library

TIME = np.linspace(0.0, 30.0, 120)
STRAIN = 0.02 * np.sin(TIME) * TIME / 30.0
CASES = [pytest.param(effect, form, id=f"{effect.name}: {form.name}") for effect in library() for form in effect.forms]


def bench_paths(kind: str) -> list[BenchPath]:
    """One record with every condition, one with none: no clock, length, tension, temperature or direction."""
    known = BenchPath(kind, STRAIN, TIME, 2.0, 500 + 50 * TIME, 320.0, "x-", 0.02, 1000.0, 300.0)
    return [known, BenchPath(kind, STRAIN, largest=0.02)]


@pytest.mark.parametrize(("effect", "form"), CASES)
def test_zero_strength(effect, form):
    """Columns times zero add zero at every start of a search, also where nothing was recorded; no NaN hides in them."""
    if not form.strength or form.stage == "chain":
        pytest.skip("fixtures and filters are switched off by their shapes; towing effects have tests of their own")
    for path in bench_paths(effect.kinds[0]):
        for shape in product(*[p.starts([path]) for p in form.shape]):
            columns = form.respond(path, *shape)
            assert columns.shape == (STRAIN.size, len(form.strength))
            np.testing.assert_array_equal(STRAIN + columns @ np.zeros(len(form.strength)), STRAIN)


@pytest.mark.parametrize(("effect", "form"), CASES)
def test_zero_shape_of_fixtures(effect, form):
    """A fixture with shapes of zero hands on the strain itself, to rounding."""
    if form.stage != "fixture":
        pytest.skip("not a fixture")
    for path in bench_paths(effect.kinds[0]):
        given = form.respond(path, *np.zeros(len(form.shape)))
        np.testing.assert_allclose(given, STRAIN, rtol=0.0, atol=1e-15 * np.abs(STRAIN).max())


@pytest.mark.parametrize(("effect", "form"), CASES)
def test_neutral_and_active_at_a_point(effect, form):
    """A point of a rod feels nothing of strengths of zero; `neutral` says so."""
    if form.stage != "section":
        pytest.skip("not at a material point")
    path = bench_paths(effect.kinds[0])[0]
    shape = tuple(float(p.starts([path])[0]) for p in form.shape)
    k = len(form.strength)
    off = ActiveEffect(effect, form, effect.kinds[0], None, shape, (0.0,) * k, path)
    on = ActiveEffect(effect, form, effect.kinds[0], None, shape, (1.0,) * k, path)
    assert off.neutral and not on.neutral
    zero, felt = np.zeros(2), {}
    for active in (off, on):
        memory, before = np.zeros((2, form.memory)), zero
        for strain in (np.array([-0.01, 0.02]), np.array([-0.005, 0.01])):
            added, memory = active.advance(strain, before, 0.1, zero + 800.0, zero + 330.0, memory)
            before = strain
        felt[active is on] = added
    np.testing.assert_array_equal(felt[False], zero)
    assert np.all(np.isfinite(felt[True])) and np.any(felt[True] != 0.0)

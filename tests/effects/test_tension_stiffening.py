"""Tension stiffening: K at the typical tension, a part of it in proportion to tension, its power, or saturating."""

import numpy as np
import pytest

from effects.effect import BenchPath
from effects.tension_stiffening import EFFECT, LINEAR, POWER_LAW, SATURATING

STRAIN = np.linspace(-1.0, 1.0, 11)


def path_at(tension: float | None) -> BenchPath:
    grip = None if tension is None else np.full(STRAIN.size, tension)
    return BenchPath("bending", STRAIN, None, tension=grip, typical_tension=2000.0)


@pytest.mark.parametrize(("form", "shape"), [(LINEAR, ()), (POWER_LAW, (0.5,)), (SATURATING, (0.7,))])
def test_typical_tension_and_sign(form, shape):
    """Nothing at the typical tension or without one; stiffer above; with strength 1 nothing is left without tension."""
    np.testing.assert_allclose(form.respond(path_at(2000.0), *shape), 0.0, atol=1e-15)
    np.testing.assert_allclose(form.respond(path_at(None), *shape), 0.0, atol=1e-15)
    assert form.respond(path_at(3000.0), *shape)[-1, 0] > 0.0
    np.testing.assert_allclose(STRAIN + form.respond(path_at(0.0), *shape)[:, 0], 0.0, atol=1e-15)


def test_laws():
    """At four times the typical tension: a factor of 4, of 4^p, and of 4 (1 + s)/(4 + s)."""
    high = path_at(8000.0)
    np.testing.assert_allclose(STRAIN + LINEAR.respond(high)[:, 0], 4 * STRAIN, rtol=1e-12)
    np.testing.assert_allclose(STRAIN + POWER_LAW.respond(high, 0.5)[:, 0], 2 * STRAIN, rtol=1e-12)
    np.testing.assert_allclose(STRAIN + SATURATING.respond(high, 2.0)[:, 0], 2 * STRAIN, rtol=1e-12)


def test_kinds_and_untestable_sentence():
    """Bending and torsion only; one tension cannot show it."""
    assert EFFECT.kinds == ("torsion", "bending")
    assert EFFECT.why_untestable([path_at(1500.0)]) == "all experiments at an axial tension of 1500 N"
    assert EFFECT.why_untestable([path_at(None)]) == "no axial tension was recorded"
    assert EFFECT.why_untestable([path_at(1000.0), path_at(2000.0)]) is None

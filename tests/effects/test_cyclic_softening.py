"""Cyclic softening: the second cycle is softer than the first, the third like the second, larger strains soften more."""

import numpy as np
import pytest
from scipy.special import erf

from effects.cyclic_softening import BELOW, EFFECT, MIXED, SATURATING
from effects.effect import BenchPath


def path_of(strain: np.ndarray) -> BenchPath:
    return BenchPath("tension", strain, None, largest=0.04)


def triangle(*peaks: float, n: int = 50) -> np.ndarray:
    parts = [np.concatenate([np.linspace(0, p, n + 1)[1:], np.linspace(p, 0, n + 1)[1:]]) for p in peaks]
    return np.concatenate([[0.0], *parts])


@pytest.mark.parametrize(
    ("form", "shape"), [(SATURATING, (0.01,)), (BELOW, (0.01,)), (MIXED, ())], ids=lambda f: str(f)
)
def test_cycles(form, shape):
    """0 to 0.02, thrice: the second rise is softer than the first; the third is the second, to rounding."""
    first, second, third = np.split(form.respond(path_of(triangle(0.02, 0.02, 0.02)), *shape)[1:].sum(axis=1), 3)
    assert np.all(second[10:40] < first[10:40])
    np.testing.assert_allclose(third, second, rtol=1e-12)
    np.testing.assert_allclose(second[:49], second[50:99][::-1], rtol=1e-12)


@pytest.mark.parametrize(("form", "shape"), [(SATURATING, (0.01,)), (MIXED, ())])
def test_stiffness_never_rises(form, shape):
    """The secant stiffness falls with time, on either side: the damage remembers |strain|."""
    strain = np.cumsum(np.random.default_rng(0).normal(size=300)) * 2e-3 + 1e-5
    columns = form.respond(path_of(strain), *shape)
    secant = columns / strain[:, None]
    assert np.all(np.diff(secant, axis=0) < 1e-12)
    np.testing.assert_allclose(form.respond(path_of(-strain), *shape), -columns, rtol=1e-12)


def test_saturating_law():
    """K [1 - a (1 - exp(-m/d))], m the largest strain so far, on the way back from 0.03."""
    strain = np.array([0.0, 0.03, 0.01, -0.02])
    c = SATURATING.respond(path_of(strain), 0.02)[:, 0]
    np.testing.assert_allclose(c[1:], -strain[1:] * (1 - np.exp(-1.5)), rtol=1e-12)


def test_virgin_curve_untouched():
    """The form below the former maximum does not soften a first loading; on the way back it is that of Ogden & Roxburgh."""
    strain = triangle(0.03)
    c = BELOW.respond(path_of(strain), 0.02)[:, 0]
    assert not c[:51].any()
    back = strain[51:]
    np.testing.assert_allclose(c[51:], -back * erf((0.03**2 - back**2) / 0.02**2), rtol=1e-12, atol=1e-18)


def test_needs_a_return():
    """First loadings alone do not show it."""
    assert "comes back" in (EFFECT.why_untestable([path_of(np.linspace(0, 0.04, 9))]) or "")
    assert EFFECT.why_untestable([path_of(triangle(0.04))]) is None

"""Stiffening: odd, reversible, third harmonic of the cubic, and convex sums that take any law that only stiffens."""

import numpy as np
import pytest
from scipy.optimize import nnls

from effects.effect import BenchPath
from effects.stiffening import CONVEX, CUBIC, EFFECT, LOCKING, ODD_POWERS


def path_of(strain: np.ndarray) -> BenchPath:
    return BenchPath("tension", strain, None, largest=0.05)


def columns_of(form, strain):
    shape = [float(p.starts([path_of(strain)])[3]) for p in form.shape]
    return form.respond(path_of(strain), *shape)


def test_cubic_harmonics():
    """A sine of the largest amplitude A: 3 A/4 of the first harmonic, -A/4 of the third, no other."""
    phase = np.linspace(0.0, 2 * np.pi, 240, endpoint=False)
    c = CUBIC.respond(path_of(0.05 * np.sin(phase)))[:, 0]
    spectrum = np.fft.rfft(c) / 120
    np.testing.assert_allclose(-spectrum.imag[[1, 3]], [0.05 * 0.75, -0.05 * 0.25], rtol=1e-12)
    assert np.abs(np.delete(spectrum, [1, 3])).max() < 1e-15


@pytest.mark.parametrize("form", EFFECT.forms, ids=lambda f: f.name)
def test_odd_reversible_and_convex(form):
    """Every column is odd in the strain, is the same on the way back, and its slope grows with |strain|."""
    up = np.linspace(0.0, 0.05, 101)
    there, back = columns_of(form, up), columns_of(form, up[::-1])
    np.testing.assert_array_equal(there, back[::-1])
    np.testing.assert_array_equal(columns_of(form, -up), -there)
    assert np.diff(there, 2, axis=0).min() > -1e-15
    assert np.all(there[-1] > 0.0)


def test_unit_strength_doubles_the_secant():
    """Strength 1 of a power adds the linear load once more at the largest strain, nothing at small ones."""
    for form in (CUBIC, ODD_POWERS):
        np.testing.assert_allclose(form.respond(path_of(np.array([0.05, -0.05])))[0], 0.05, rtol=1e-14)
        assert np.abs(form.respond(path_of(np.array([0.05e-3])))).max() < 0.05e-3 * 1.1e-3


def test_locking_follows_gent():
    """x (x/L)^2 / (1 - (x/L)^2) is the load of Gent's chain beyond its linear one; it stays finite past the lock."""
    c = LOCKING.respond(path_of(np.array([0.03, 0.059, 0.07])), 0.06)[:, 0]
    np.testing.assert_allclose(0.03 + c[0], 0.03 / (1 - 0.25), rtol=1e-12)
    assert np.all(np.isfinite(c)) and np.all(np.diff(c) > 0.0)


@pytest.mark.parametrize(
    "law",
    [
        lambda y: y / (1 - (y / 1.3) ** 2),
        lambda y: np.sinh(2.0 * y),
        lambda y: np.where(np.abs(y) < 0.6, y, y + 1.5 * (y - 0.6 * np.sign(y))),
        lambda y: y + 0.8 * y**5,
    ],
    ids=["Gent", "hyperbolic sine", "two slopes", "fifth power"],
)
def test_convex_sum_covers_other_laws(law):
    """Ten knees with strengths >= 0 leave 0.5 % of the load at most."""
    y = np.linspace(-1.0, 1.0, 201)
    strain, load = 0.05 * y, law(y)
    columns = np.column_stack([strain, CONVEX.respond(path_of(strain))])
    assert nnls(columns, load)[1] < 5e-3 * np.linalg.norm(load)

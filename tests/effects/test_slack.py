"""Slack: a soft start on the positive side, the full stiffness beyond, the negative side as it was."""

import numpy as np
import pytest
from scipy.optimize import nnls

from effects.effect import BenchPath
from effects.slack import EFFECT, EXPONENTIAL, LOOSE, MIXED, QUADRATIC, SHARP, SMOOTH

TOES = [EXPONENTIAL, SHARP, QUADRATIC, SMOOTH]
SHIFT = {"exponential toe": 1.0, "dead length": 1.0, "parabolic toe": 0.5, "hyperbolic tangent toe": 1.0}


def path_of(strain: np.ndarray) -> BenchPath:
    return BenchPath("tension", strain, None, largest=0.02)


@pytest.mark.parametrize("form", TOES, ids=lambda f: f.name)
def test_start_and_shift(form):
    """The slope begins at 1 - a; far beyond the toe it is 1 and the line is shifted by a d (parabola: half of it)."""
    a, d = 0.6, 5e-4
    strain = np.array([0.0, 1e-9, 0.019, 0.02])
    load = strain + a * form.respond(path_of(strain), d)[:, 0]
    np.testing.assert_allclose(load[1] / 1e-9, 1 - a, rtol=1e-5)
    np.testing.assert_allclose((load[3] - load[2]) / 0.001, 1.0, rtol=1e-9)
    np.testing.assert_allclose(load[3], 0.02 - a * d * SHIFT[form.name], rtol=1e-9)


@pytest.mark.parametrize("form", [*TOES, MIXED], ids=lambda f: f.name)
def test_one_sided_reversible_and_only_stiffening(form):
    """Nothing on the negative side; the same on the way back; the slope never falls with the strain."""
    strain = np.linspace(-0.02, 0.02, 401)
    shape = [3e-3] * len(form.shape)
    c = form.respond(path_of(strain), *shape)
    assert not c[strain <= 0.0].any()
    np.testing.assert_array_equal(form.respond(path_of(strain[::-1]), *shape)[::-1], c)
    positive = c[200:]
    assert np.diff(positive, 2, axis=0).min() > -1e-15
    assert np.all(np.diff(positive, axis=0) <= 1e-15) and np.all(np.diff(positive, axis=0) >= -1e-4 - 1e-15)


def test_loose_negative_side():
    """Looseness 1 leaves no load under compression, and does not touch tension."""
    strain = np.array([-0.02, -0.001, 0.0, 0.01])
    c = LOOSE.respond(path_of(strain), 1e-3)
    np.testing.assert_allclose(strain + c[:, 1], [0.0, 0.0, 0.0, 0.01], atol=1e-18)
    np.testing.assert_array_equal(c[:, 0], EXPONENTIAL.respond(path_of(strain), 1e-3)[:, 0])


@pytest.mark.parametrize(
    "slope",
    [lambda y: 1 - np.exp(-y / 0.15), lambda y: np.tanh(y / 0.2) ** 2, lambda y: np.minimum(y / 0.35, 1.0)],
    ids=["exponential", "square of a tangent", "parabola"],
)
def test_mixture_covers_other_toes(slope):
    """Any slope that grows up to K: the sum of dead lengths leaves at most 1 % of the load."""
    y = np.linspace(0.0, 1.0, 1001)
    load = np.concatenate([[0.0], np.cumsum((slope(y[1:]) + slope(y[:-1])) / 2)]) * 0.02 / 1000
    strain = 0.02 * y
    columns = np.column_stack([strain, MIXED.respond(path_of(strain))])
    assert nnls(columns, load)[1] < 1e-2 * np.linalg.norm(load)


def test_needs_the_positive_side():
    """Compression only cannot show it."""
    assert EFFECT.why_untestable([path_of(np.linspace(0.0, -0.02, 5))]) is not None
    assert EFFECT.why_untestable([path_of(np.linspace(0.0, 0.02, 5))]) is None

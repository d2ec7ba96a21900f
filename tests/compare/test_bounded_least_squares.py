"""Least squares with some unknowns not below zero: the minimum of a convex quadratic over a cone, which is unique in value."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear, nnls

from compare.bounded_least_squares import solve_bounded


def solved(Z, y, positive):
    A, b = np.ascontiguousarray(Z.T @ Z)[None], np.ascontiguousarray(Z.T @ y)[None]
    x = np.empty(b.shape)
    solve_bounded(A, b, np.asarray(positive, dtype=np.bool_), x)
    return x[0]


@pytest.mark.parametrize("seed", range(40))
def test_all_positive_is_nnls(seed):
    """With every unknown bounded it is the problem of Lawson & Hanson."""
    rng = np.random.default_rng(seed)
    P = rng.integers(1, 12)
    Z, y = rng.normal(size=(30, P)) + 3 * rng.normal(size=(30, 1)), rng.normal(size=30)  # columns much alike
    np.testing.assert_allclose(solved(Z, y, [True] * P), nnls(Z, y)[0], rtol=0, atol=1e-9)  # of numbers of size 1


@pytest.mark.parametrize("seed", range(40))
def test_mixed_bounds(seed):
    """Free and bounded unknowns together, against an interior point method on the columns themselves."""
    rng = np.random.default_rng(seed)
    P = rng.integers(2, 9)
    positive = rng.random(P) < 0.6
    Z, y = rng.normal(size=(30, P)) @ rng.normal(size=(P, P)), rng.normal(size=30)
    low = np.where(positive, 0.0, -np.inf)
    found = lsq_linear(Z, y, (low, np.inf), method="bvls", tol=1e-14)
    x = solved(Z, y, positive)
    assert np.all(x[positive] >= 0)
    assert np.sum((Z @ x - y) ** 2) == pytest.approx(2 * found.cost, rel=1e-9)  # normal equations: squared condition


@pytest.mark.parametrize("seed", range(20))
def test_equal_and_empty_columns(seed):
    """Columns that are equal, opposite or zero leave x open but not the minimum; nothing is NaN."""
    rng = np.random.default_rng(seed)
    Z = rng.normal(size=(25, 4))
    Z = np.column_stack([Z, Z[:, 1], np.zeros(25), -Z[:, 2]])
    y = rng.normal(size=25)
    positive = np.array([False, True, True, True, True, True, True])
    x = solved(Z, y, positive)
    best = lsq_linear(Z, y, (np.where(positive, 0.0, -np.inf), np.inf), method="bvls", tol=1e-14)
    assert np.isfinite(x).all() and np.all(x[positive] >= 0)
    assert np.sum((Z @ x - y) ** 2) <= 2 * best.cost * (1 + 1e-6)  # the pivot of a tie is held at 1e-14 of the diagonal


def test_many_at_once():
    """A batch gives what each of its systems gives alone."""
    rng = np.random.default_rng(3)
    positive = np.array([False, True, True])
    Z, y = rng.normal(size=(50, 20, 3)), rng.normal(size=(50, 20))
    A, b = np.swapaxes(Z, 1, 2) @ Z, np.einsum("bni,bn->bi", Z, y)
    x = np.empty(b.shape)
    solve_bounded(A, b, positive, x)
    np.testing.assert_allclose(x, [solved(Zi, yi, positive) for Zi, yi in zip(Z, y)], rtol=1e-12, atol=1e-14)
    assert (x[:, 1:] == 0).any() and (x[:, 1:] > 0).any()


@pytest.mark.parametrize("seed", range(40))
def test_unknowns_that_come_and_go(seed):
    """A spectrum of decays, each nearly its neighbours: unknowns enter, turn negative as others enter, and leave again."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 3, 60)
    Z = np.exp(-t[:, None] / np.geomspace(0.1, 3.0, 7))
    y = Z[:, [1, 5]] @ [1.0, 0.7] + 0.02 * rng.normal(size=60)
    x = solved(Z, y, [True] * 7)
    assert np.all(x >= 0)
    assert np.sum((Z @ x - y) ** 2) == pytest.approx(nnls(Z, y)[1] ** 2, rel=1e-6)  # condition 1e5, squared

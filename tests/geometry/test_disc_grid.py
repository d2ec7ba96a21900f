"""Quadrilaterals inside a closed curve: counts of the patterns, symmetry, exact polynomials of the drawing, sentences."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geometry import MeshError
from geometry.disc_grid import disc_grid


def circle(count, start=0.0, uneven=0.0):
    k = np.arange(count)
    angle = start + 2 * np.pi / count * (k + uneven * np.sin(2 * np.pi * 3 * k / count))
    return np.column_stack([np.cos(angle), np.sin(angle)])


def area_of_cells(grid):
    a, b, c, d = np.moveaxis(grid.points[grid.cells], 1, 0)
    p, q = c - a, d - b
    return 0.5 * (p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0])


@pytest.mark.parametrize("rings", [1, 2, 4])
@pytest.mark.parametrize(("sectors", "count"), [(4, 8), (4, 20), (3, 12), (5, 20), (6, 12), (6, 36)])
def test_cells_and_nodes_of_the_patterns(sectors, count, rings):
    """Square: (n/4)^2, k kites: k m^2 with n = 2 k m, and n in each ring; nodes - edges + cells = 1 (Euler)."""
    grid = disc_grid(circle(count), sectors, rings)
    core = (count // 4) ** 2 if sectors == 4 else sectors * (count // (2 * sectors)) ** 2
    assert len(grid.cells) == core + rings * count
    edges = np.sort(np.concatenate([grid.cells[:, [k, (k + 1) % 4]] for k in range(4)]), axis=1)
    unique, times = np.unique(edges, axis=0, return_counts=True)
    assert len(grid.points) - len(unique) + len(grid.cells) == 1
    assert (times == 1).sum() == count
    assert area_of_cells(grid).sum() == pytest.approx(0.5 * count * np.sin(2 * np.pi / count), rel=1e-12)


@settings(max_examples=25, deadline=None)
@given(st.sampled_from([4, 3, 5, 6]), st.integers(1, 5), st.floats(0, 6), st.floats(-0.3, 0.3))
def test_uneven_boundaries_are_kept_and_filled_well(sectors, half, start, uneven):
    count = 2 * sectors * (half + (half == 1 and sectors < 6))
    boundary = circle(count, start, uneven)
    grid = disc_grid(boundary, sectors)
    np.testing.assert_array_equal(grid.points[:count], boundary)
    assert grid.quality > 0.4
    assert (area_of_cells(grid) > 0).all()


@pytest.mark.parametrize(("sectors", "count"), [(4, 20), (3, 24), (5, 20), (6, 24)])
def test_turned_by_one_sector_the_grid_is_itself(sectors, count):
    grid = disc_grid(circle(count), sectors)
    angle = 2 * np.pi / sectors
    Q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    gaps = np.linalg.norm((grid.points @ Q.T)[:, None] - grid.points[None], axis=2)
    assert gaps.min(1).max() < 1e-13
    cells = {frozenset(cell) for cell in grid.cells.tolist()}
    assert {frozenset(cell) for cell in gaps.argmin(1)[grid.cells].tolist()} == cells


def test_the_drawing_follows_an_affine_map_of_its_boundary():
    """Means of neighbours commute with affine maps; the position of the pattern is chosen anew, so compare with the map undone."""
    boundary = circle(24, 0.2)
    plain, moved = disc_grid(boundary), disc_grid(3.0 * boundary + [5.0, -2.0])
    np.testing.assert_allclose(moved.points, 3.0 * plain.points + [5.0, -2.0], rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(
    ("boundary", "sectors", "sentence"),
    [
        (circle(10), 4, "multiple of 4, found 10"),
        (circle(18), 6, "multiple of 12, found 18"),
        (circle(12)[::-1], 4, "counter-clockwise"),
        (np.zeros((0, 2)), 4, "found 0"),
        (
            np.array([[0, 0], [4, 0], [4, 4], [3.9, 0.1], [3.8, 0.1], [0.2, 0.1], [0.1, 0.1], [0, 4.0]]),
            4,
            "no regular mesh",
        ),
    ],
)
def test_boundaries_that_cannot_be_filled_are_refused(boundary, sectors, sentence):
    with pytest.raises(MeshError, match=sentence):
        disc_grid(np.reshape(boundary, (-1, 2)), sectors)

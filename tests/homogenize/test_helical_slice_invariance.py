"""The 3D periodic cell: independent of the height of the slice, and equal to the 2D cell in the limit of the mesh."""

import numpy as np
import pytest
from section_meshes import linear, rings, swept

from geometry.errors import MeshError
from homogenize import pitch_average, solve_helical_cell, solve_periodic_cell


def lay(n, nu=0.45):
    """A stiff eccentric trace in soft rubber, drawn as a ring mesh whose inner region is stiff."""
    return rings((0.4, 1.0), (100.0, 0.3), (1.0, nu), per_ring=2 * n, around=12 * n, centre=(0.3, 0.0), twist_rate=0.5)


def test_slices_of_any_height_give_the_same_stiffness():
    """1, 2 and 3 layers of equal thickness are the same helical problem."""
    section = linear(lay(1))
    values = [solve_periodic_cell(swept(section, 0.1 * k, k), tolerance=1e-11).stiffness for k in (1, 2, 3)]
    np.testing.assert_allclose(values[1], values[0], rtol=1e-7)
    np.testing.assert_allclose(values[2], values[0], rtol=1e-7)


def test_the_slice_converges_to_the_cross_section_problem():
    """EA, coupling and GJ of the 3D cell tend to those of the 2D cell at second order in the element size."""
    exact = pitch_average(solve_helical_cell(lay(4)).stiffness).C[np.ix_([2, 5], [2, 5])]
    scale = np.sqrt(np.outer(np.diag(exact), np.diag(exact)))
    error = []
    for n in (1, 2, 4):
        K = solve_periodic_cell(swept(linear(lay(n)), 0.2 / n, 1)).stiffness
        error.append(np.abs((K - exact) / scale).max())
    orders = np.log2(np.array(error[:-1]) / error[1:])
    assert error[-1] < 0.01
    assert orders[-1] > 1.6, (error, orders)


def test_end_faces_that_do_not_match_are_refused():
    """The message gives the gap."""
    good = swept(linear(lay(1)), 0.1, 1)
    bad = type(good)(**{**good.__dict__, "height": 0.11})
    with pytest.raises(MeshError, match="largest gap is"):
        solve_periodic_cell(bad)

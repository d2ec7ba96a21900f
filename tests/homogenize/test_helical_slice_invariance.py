"""The 3D periodic cell: independent of the height of the slice, and equal to the 2D cell in the limit of the mesh."""

import pytest
from section_meshes import linear, swept

from geometry.errors import MeshError
from homogenize import solve_periodic_cell
from homogenize.benchmark_slices import eccentric_rod, slice_cases


@pytest.mark.parametrize("case", slice_cases(), ids=str)
def test_slice(case):
    """One, two and three layers are one problem (1e-7); order 2 to the 2D cell; no locking at nu 0.4999; the seam keeps its forces."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]


def test_end_faces_that_do_not_match_are_refused():
    """The message gives the gap."""
    good = swept(linear(eccentric_rod(1)), 0.1, 1)
    bad = type(good)(**{**good.__dict__, "height": 0.11})
    with pytest.raises(MeshError, match="largest gap is"):
        solve_periodic_cell(bad)

"""Cables against their sources: lays that match (T9), a strand as its wires (T8), wires in rubber (T12), four conductors (two codes)."""

import pytest

from homogenize.benchmark_cables import axial_stiffness, cable_cases
from homogenize.benchmark_sections import rings
from homogenize.helical_cell import solve_helical_cell
from homogenize.section_stiffness import pitch_average


@pytest.mark.parametrize("case", cable_cases(), ids=str)
def test_whole_cables(case):
    """Every row."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]


def test_the_short_way_to_EA_is_the_long_one():
    """The z-independent problem alone gives EA, twist blocked and free, of the whole solution."""
    mesh = rings((0.4, 1.0), (100.0, 0.3), (1.0, 0.45), centre=(0.2, 0.0), twist_rate=0.8)
    section = pitch_average(solve_helical_cell(mesh).stiffness)
    assert axial_stiffness(mesh) == pytest.approx((section.EA_blocked_twist, section.EA_free_twist), rel=1e-9)

"""One helical wire is a spring: Kirchhoff's rod, with its stretch-twist coupling and sign (verification case T4)."""

import numpy as np
import pytest

from homogenize.benchmark_spring import spring_cases, wire_ratios


@pytest.mark.parametrize("case", spring_cases(), ids=str)
def test_helical_spring(case):
    """Printed table, the cell extrapolated to a thin wire, and the mirror image."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]


@pytest.mark.parametrize("beta", [20, 45, 60])
def test_the_cell_converges_to_the_rod_as_the_wire_gets_thin(beta):
    """The error falls as (a/r)^2: by 4 when the wire is half as thick, and is below 2e-3 at r/a = 20."""
    coarse, fine = (np.abs(wire_ratios(np.radians(beta), 10.0, a) - 1) for a in (1.0, 0.5))
    assert fine[[0, 2, 3]].max() < 2e-3
    assert 3.0 < coarse.max() / fine.max() < 5.0

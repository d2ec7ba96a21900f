"""Straight bars: the 6x6 stiffness of BECAS, GXBeam and ANBA4 (verification cases T1) and the closed forms of Saint-Venant."""

import pytest

from homogenize.benchmark_prismatic import prismatic_cases


@pytest.mark.parametrize("case", prismatic_cases(), ids=str)
def test_prismatic_section(case):
    """Every entry that the source prints, with its sign."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]

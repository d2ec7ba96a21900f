"""Bounds of every section, the straight limit of a long pitch, and the limits of the rubber law (case T12)."""

import pytest

from homogenize.benchmark_limits import limit_cases


@pytest.mark.parametrize("case", limit_cases(), ids=str)
def test_limits(case):
    """Every row."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]

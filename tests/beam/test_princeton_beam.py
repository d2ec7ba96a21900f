"""Princeton beam experiment: a blade under a tip load that bends and twists it in space (case R1)."""

import pytest

from beam.benchmark_statics import static_cases


@pytest.mark.parametrize("case", [c for c in static_cases() if c.name.startswith("R1")], ids=str)
def test_tip_displacement(case):
    """n = 32 within 1e-6 m, and half of the last printed digit; n = 8 within 5e-5 m."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]

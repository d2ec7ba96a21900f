"""A flexible beam that a hub spins up through seven full turns (case D2): lag of the tip and centrifugal stretch."""

import numpy as np
import pytest

from beam.benchmark_spin_up import hub, spin_up_cases, tip_in_turning_frame


@pytest.mark.parametrize("case", spin_up_cases(), ids=str)
def test_tip_of_the_turning_beam(case):
    """Within 1 % of the largest lag of another code at six times; stretch rho A w^2 L^3 / (3 EA)."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]


def test_motion_of_the_hub_is_consistent():
    """Velocity and acceleration are the derivatives of the angle (1e-6: central differences), also across the end of the ramp."""
    for t in (0.5, 7.0, 14.999, 15.001, 17.0):
        before, now, after = (hub(t + d) for d in (-1e-4, 0.0, 1e-4))
        assert now[1] == pytest.approx((after[0] - before[0]) / 2e-4, abs=1e-6)
        assert now[2] == pytest.approx((after[1] - before[1]) / 2e-4, abs=1e-6)


def test_counting_back_a_turn_changes_nothing():
    """No jump of the tip when the angles lose 2 pi: 10 ms before and after the first half turn the lag differs by its rate (1 mm)."""
    times, tips = tip_in_turning_frame(4, 1e-2, 6.5)
    passed = int(np.argmax([hub(t)[0] > np.pi for t in times]))
    assert np.abs(np.diff(tips[passed - 3 : passed + 4, 1], 2)).max() < 1e-3

"""A flexible pendulum that swings from the horizontal (case D1), and the order of the time integration (D4)."""

import pytest

from beam.benchmark_dynamics import dynamic_cases
from beam.generalized_alpha import StepSettings


@pytest.mark.parametrize("case", [c for c in dynamic_cases() if "pendulum" in c.name or "alpha" in c.name], ids=str)
def test_tip_of_two_codes_and_second_order(case):
    """Within 3e-4 m up to 0.6 s, energy closed; slope between 1.8 and 2.2."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]


def test_spectral_radius_sets_the_coefficients():
    """rho = 1 is the trapezoidal rule in disguise (beta 1/4, gamma 1/2); rho = 0 damps high frequencies at once."""
    assert StepSettings(spectral_radius=1.0).coefficients == pytest.approx((0.5, 0.5, 0.5, 0.25))
    assert StepSettings(spectral_radius=0.0).coefficients == pytest.approx((-1.0, 0.0, 1.5, 1.0))

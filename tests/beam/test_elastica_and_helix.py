"""Large deflections in closed form (case R5): Euler's elastica by elliptic integrals, a straight rod that an end moment makes a helix."""

import numpy as np
import pytest

from beam.benchmark_closed_forms import closed_form_cases, elastica_tip, helix_tip


@pytest.mark.parametrize("case", closed_form_cases(), ids=str)
def test_tip_of_the_closed_form(case):
    """Within 5e-6 of the length at 32 elements; the helix converges with order 3.5 or more."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]


def test_small_load_is_the_beam_formula():
    """w = P L^3 / (3 EI), x = L - w^2 3 / (5 L): leading terms, so 1e-4 at alpha 0.01."""
    x, w = elastica_tip(0.01)
    assert w == pytest.approx(0.01 / 3, rel=1e-4)
    assert 1 - x == pytest.approx(0.6 * w**2, rel=1e-4)


def test_helix_contains_the_circle_and_pure_twist():
    """Moment across the rod: half circle, tip at 2 / pi; along it: the tip stays."""
    np.testing.assert_allclose(helix_tip(np.array([0.0, 0.0, np.pi])), [0, 2 / np.pi, 0], atol=1e-15)
    np.testing.assert_allclose(helix_tip(np.array([2.0, 0.0, 0.0])), [1, 0, 0], atol=1e-15)

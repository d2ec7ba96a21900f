"""A heavy, limp, nearly inextensible cable between two points hangs in a catenary y = a cosh(x/a) (case R5)."""

import numpy as np

from beam.benchmark_statics import LENGTH, WEIGHT, catenary, catenary_parameter, hanging


def test_catenary():
    """Sag, horizontal force, end reaction, mirrored halves."""
    assert not [b.sentence() for b in catenary() if not b.passed]


def test_forces_at_both_supports():
    """H = w a on either side, with opposite signs; each support carries half the weight."""
    F = hanging(80)[1].forces.F
    np.testing.assert_allclose([-F[0, 0], F[-1, 0]], WEIGHT * catenary_parameter(), rtol=2e-3)
    np.testing.assert_allclose(F[[0, -1], 1], WEIGHT * LENGTH / 2, rtol=1e-6)

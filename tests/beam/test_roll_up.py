"""A cantilever under an end moment M bends into an arc of radius EI/M: order of convergence, and section forces (R3, R4)."""

import numpy as np
import pytest

from beam.benchmark_statics import roll_up_error, static_cases
from beam.hermite import hermite


@pytest.mark.parametrize("case", [c for c in static_cases() if c.name.startswith(("R3", "R4"))], ids=str)
def test_roll_up_and_pure_bend(case):
    """Tip (0, 2L/pi) with order above 4.5; M = EI/R, N and Q vanish."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]


def test_order_on_coarse_meshes():
    """Above 4.2 from n = 4 on; cubic Hermite fields converge with order 5 to 6."""
    assert np.log2(roll_up_error(4) / roll_up_error(8)) > 4.2


def test_hermite_functions_reproduce_a_cubic():
    """The shape functions carry (value, slope) of any cubic exactly."""
    length, N, dN = 0.7, np.zeros(4), np.zeros(4)
    cubic = np.polynomial.Polynomial([0.3, -1.0, 2.0, 0.8])
    nodal = [cubic(0.0), cubic.deriv()(0.0), cubic(length), cubic.deriv()(length)]
    hermite(0.37, length, N, dN)
    np.testing.assert_allclose(N @ nodal, cubic(0.37 * length), rtol=1e-13)
    np.testing.assert_allclose(dN @ nodal, cubic.deriv()(0.37 * length), rtol=1e-13)

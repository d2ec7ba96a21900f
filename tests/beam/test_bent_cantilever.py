"""45-degree bend of Bathe and Bolourchi: a curved cantilever loaded out of plane (case R2)."""

import numpy as np
import pytest

from beam.benchmark_statics import curved_cantilever, static_cases
from beam.rod_model import RodModel, Support


@pytest.mark.parametrize("case", [c for c in static_cases() if c.name.startswith("R2")], ids=str)
def test_tip_position(case):
    """n = 16 within 1e-3 of the radius-100 bend's converged tip."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]


def test_curved_rod_is_free_of_stress_in_its_own_shape():
    """Reference strains make the initial curvature stress-free."""
    rod, shape = curved_cantilever(4)
    model = RodModel(rod, shape, [Support(0)])
    forces = model.forces(0.0, shape, np.zeros_like(shape), [])
    assert np.abs(forces.S).max() < 1e-9 * 1e7
    assert forces.elastic < 1e-12

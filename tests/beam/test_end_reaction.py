"""Support reactions as moments: the power of the moment is that of the generalised force, also far from small rotations."""

import numpy as np
import pytest

from beam.end_reaction import global_moment
from beam.rotation_vector import rotation_matrix


@pytest.mark.parametrize("theta", [(0.0, 0.0, 0.0), (0.3, -0.8, 0.5), (0.0, 0.0, np.pi), (2.0, 1.0, -1.5)])
def test_moment_and_generalised_force_have_the_same_power(theta):
    """m . omega = f . d(theta)/dt with [omega] = dR/dt R^T by central differences (error 1e-9)."""
    theta, f, rate, h = np.array(theta), np.array([1.0, -2.0, 0.7]), np.array([0.4, 0.9, -0.6]), 1e-5
    spin = (rotation_matrix(theta + h * rate) - rotation_matrix(theta - h * rate)) / (2 * h) @ rotation_matrix(theta).T
    omega = np.array([spin[2, 1], spin[0, 2], spin[1, 0]])
    assert global_moment(theta, f) @ omega == pytest.approx(f @ rate, rel=1e-8)

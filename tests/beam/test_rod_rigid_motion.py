"""A rigid motion strains nothing; for a bent rod the interpolated rotation vector obeys this up to a small error."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from beam.element import reference_strains
from beam.rod import GAUSS_X
from beam.rotation_vector import rotation_coefficients, rotation_matrix
from beam.shape import straight, strands_and_arcs


def strains(q: np.ndarray, length: float) -> np.ndarray:
    E = np.zeros((len(q) - 1, 3, 6))
    reference_strains(np.ascontiguousarray(q), np.full(len(q) - 1, length), GAUSS_X, E)
    return E


def turned(q: np.ndarray, rotation: Rotation) -> np.ndarray:
    """The shape after a rigid rotation: r -> Q r, R -> Q R, the curvature kappa of the section unchanged."""
    out = q.copy()
    Q = rotation.as_matrix()
    out[:, 0:3], out[:, 3:6] = q[:, 0:3] @ Q.T, q[:, 3:6] @ Q.T
    for i, row in enumerate(q):
        kappa = tangent_map(row[6:9]) @ row[9:12]
        theta = (rotation * Rotation.from_rotvec(row[6:9])).as_rotvec()
        out[i, 6:9] = theta
        out[i, 9:12] = np.linalg.solve(tangent_map(theta), kappa)
    return out


def tangent_map(theta: np.ndarray) -> np.ndarray:
    _, b, c, _, _ = rotation_coefficients(float(theta @ theta))
    hat = np.array([[0, -theta[2], theta[1]], [theta[2], 0, -theta[0]], [-theta[1], theta[0], 0]])
    return np.eye(3) - b * hat + c * hat @ hat


@pytest.mark.parametrize("vector", [(0.4, -1.1, 0.7), (0.0, 3.0, 0.0), (1e-5, 0.0, 0.0)])
def test_straight_rod_is_exact(vector):
    """A straight rod, turned by up to 3 rad and shifted: strains at round-off."""
    q = straight(np.linspace(0.0, 2.0, 6))
    q[:, 0:3] += [3.0, -2.0, 5.0]
    assert np.abs(strains(turned(q, Rotation.from_rotvec(vector)), 0.4)).max() < 1e-12


def test_rotation_matrix_agrees_with_scipy():
    """R = exp(theta^) for small, middle and large angles."""
    vectors = np.array([[1e-9, 0, 0], [0.3, -0.2, 0.9], [3.0, 2.0, -1.0], [0.0, 0.0, 0.0]])
    np.testing.assert_allclose(rotation_matrix(vectors), Rotation.from_rotvec(vectors).as_matrix(), rtol=0, atol=1e-14)


def test_series_joins_the_closed_form():
    """The coefficients at p^2 just below and above the switch agree as far as the closed form is exact (cancellation)."""
    below, above = np.array(rotation_coefficients(1e-2 * (1 - 1e-12))), np.array(rotation_coefficients(1e-2))
    np.testing.assert_allclose(below, above, rtol=2e-10)


def objectivity_error(elements: int) -> float:
    """Largest change of strain of a quarter circle of 0.4 m by a superposed turn of 1 rad about a skew axis."""
    length = 0.4 * np.pi / 2
    q = strands_and_arcs(np.linspace(0.0, length, elements + 1), [(length, 1 / 0.4)])
    rotation = Rotation.from_rotvec(np.array([0.6, 0.64, 0.48]))
    moved = strains(turned(q, rotation), length / elements)
    return float(np.abs(moved - strains(q, length / elements))[:, :, 3:].max() * 0.4)


def test_objectivity_error_of_a_bend_is_small_and_falls():
    """Relative to the curvature 1/R: below 1e-4 at 40 mm elements, falling at least eightfold per halving."""
    coarse, middle, fine = (objectivity_error(n) for n in (4, 8, 16))
    assert fine < 1e-4
    assert coarse / middle > 6 and middle / fine > 6

"""Formulas (22) and (23) of Ge et al., PLoS ONE 18(2) e0281136 (2023)."""

import numpy as np
import pytest

from beam.incline_formula import towing_force_down, towing_force_up


def test_level_ground_knows_no_direction():
    """theta = 0: F = m (mu g + a) both ways."""
    assert towing_force_up(100.0, 0.0, 0.3, 0.5) == pytest.approx(100 * (0.3 * 9.81 + 0.5))
    assert towing_force_down(100.0, 0.0, 0.3, 0.5) == pytest.approx(100 * (0.3 * 9.81 + 0.5))


def test_sum_and_difference():
    """F_up + F_down = 2 m (mu g cos + a), F_up - F_down = 2 m g sin."""
    up, down = towing_force_up(80.0, 0.6, 0.3, 0.2), towing_force_down(80.0, 0.6, 0.3, 0.2)
    assert up + down == pytest.approx(160 * (0.3 * 9.81 * np.cos(0.6) + 0.2))
    assert up - down == pytest.approx(160 * 9.81 * np.sin(0.6))


def test_downhill_beyond_the_friction_angle_must_be_held_back():
    """F_down changes sign at tan theta = mu."""
    assert towing_force_down(1.0, np.arctan(0.3), 0.3) == pytest.approx(0.0, abs=1e-12)
    assert towing_force_down(1.0, 0.6, 0.3) < 0


def test_mass_over_time():
    """m(t) may be an array."""
    np.testing.assert_allclose(towing_force_up([1.0, 2.0], 0.1, 0.3), np.array([1, 2]) * towing_force_up(1.0, 0.1, 0.3))

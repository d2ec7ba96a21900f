"""The 6x6 as a quantity: derived constants, turning, averaging over the pitch, refusals."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geometry.errors import SpecError
from homogenize import SectionInertia, SectionStiffness, pitch_average


def coupled() -> SectionStiffness:
    A = np.random.default_rng(3).standard_normal((6, 6))
    return SectionStiffness(A @ A.T + 6 * np.eye(6), 0.5)


def test_free_twist_is_the_schur_complement_of_blocked_twist():
    """EA_free = 1 / (compliance of the pair)."""
    section = coupled()
    pair = np.linalg.inv(section.C[np.ix_([2, 5], [2, 5])])
    assert section.EA_free_twist == pytest.approx(1 / pair[0, 0], rel=1e-12)
    assert section.EA_free_twist < section.EA_blocked_twist


@settings(max_examples=20, deadline=None)
@given(st.floats(-7, 7))
def test_turning_there_and_back_changes_nothing(angle):
    section = coupled()
    np.testing.assert_allclose(section.turned(angle).turned(-angle).C, section.C, atol=1e-10)


def test_a_quarter_turn_exchanges_x_and_y():
    section = coupled().turned(np.pi / 2)
    assert section.GA_x == pytest.approx(coupled().GA_y, rel=1e-12)
    assert section.EI_y == pytest.approx(coupled().EI_x, rel=1e-12)


def test_pitch_average_is_isotropic_and_eight_stations_are_exact():
    """Entries are harmonics up to the second: 8 and 24 stations agree, and no direction is left."""
    average = pitch_average(coupled())
    np.testing.assert_allclose(average.C, pitch_average(coupled(), 24).C, atol=1e-12)
    np.testing.assert_allclose(average.turned(0.7).C, average.C, atol=1e-12)


def test_solid_circle_uses_the_published_moduli():
    """C_A, C_I of the paper's formula (15) on a circle."""
    d = 0.0516
    section = SectionStiffness.solid_circle(E=142e6, G_yoz=53e6, G_xoz=45e6, diameter=d)
    assert section.EA_blocked_twist == pytest.approx(142e6 * np.pi * d**2 / 4)
    assert section.EI_x == pytest.approx(142e6 * np.pi * d**4 / 64)
    assert pytest.approx(49e6 * np.pi * d**4 / 32) == section.GJ


@pytest.mark.parametrize(
    ("C", "words"),
    [
        (np.eye(5), "6x6"),
        (np.diag([1.0, 1, 1, 1, 1, -1]), "tau is -1"),
        (np.eye(6) + np.eye(6, k=1), "symmetric"),
        (np.ones((6, 6)), "positive definite"),
        (np.full((6, 6), np.nan), "finite"),
    ],
)
def test_an_impossible_stiffness_is_refused_with_a_sentence(C, words):
    with pytest.raises(SpecError, match=words):
        SectionStiffness(C, 1.0)


def test_inertia_of_a_circle():
    inertia = SectionInertia.solid_circle(4.0, 0.05)
    assert inertia.J_z == pytest.approx(2 * inertia.J_x) == pytest.approx(4.0 * 0.05**2 / 8)

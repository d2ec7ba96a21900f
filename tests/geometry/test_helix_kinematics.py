"""A helix has constant curvature sin^2(beta)/r and torsion sin(beta)cos(beta)/r, and obeys the Frenet equations."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geometry import GeometryError, Helix

HELICES = st.builds(
    Helix,
    radius=st.floats(1e-4, 0.05),
    pitch=st.floats(5e-3, 2.0),
    hand=st.sampled_from(["Z", "S"]),
    phase=st.floats(-3.0, 3.0),
)
FEW = settings(max_examples=20, deadline=None)


def derivative(function, z, step):
    """Fourth-order central difference."""
    return (8 * (function(z + step) - function(z - step)) - function(z + 2 * step) + function(z - 2 * step)) / (
        12 * step
    )


@FEW
@given(HELICES)
def test_arc_length_is_height_over_cosine(helix):
    """s = z / cos beta; the polygon of n chords a turn falls short by (2 pi / n)^2 / 24."""
    z = np.linspace(0, helix.pitch, 4001)
    polygon = np.linalg.norm(np.diff(helix.position(z), axis=0), axis=1).sum()
    assert polygon == pytest.approx(helix.length(helix.pitch), rel=2e-7)


@FEW
@given(HELICES)
def test_frenet_equations(helix):
    """dT/ds = K N, dN/ds = -K T + t B, dB/ds = -t N, with K = sin^2/r and t = +-sin cos/r."""
    beta, z = helix.lay_angle, 0.37 * helix.pitch
    assert helix.curvature == pytest.approx(np.sin(beta) ** 2 / helix.radius, rel=1e-9)
    assert helix.torsion == pytest.approx(helix.sign * np.sin(beta) * np.cos(beta) / helix.radius, rel=1e-9)
    change = derivative(helix.frenet_frame, z, 1e-3 * helix.pitch) * np.cos(beta)
    T, N, B = helix.frenet_frame(z)
    expected = [helix.curvature * N, -helix.curvature * T + helix.torsion * B, -helix.torsion * N]
    scale = 2 * np.pi * np.cos(beta) / helix.pitch
    np.testing.assert_allclose(change, expected, atol=1e-8 * scale, rtol=0)  # fourth-order difference at 1/1000 turn


@FEW
@given(HELICES)
def test_tangent_is_the_derivative_of_the_position(helix):
    z = 0.21 * helix.pitch
    velocity = derivative(helix.position, z, 1e-3 * helix.pitch)
    np.testing.assert_allclose(velocity * np.cos(helix.lay_angle), helix.tangent(z), atol=1e-9)


@FEW
@given(HELICES)
def test_transported_frame_does_not_turn_about_the_tangent(helix):
    """Orthonormal, right-handed, and e1' . e2 = 0 (Bishop's frame)."""
    z = np.linspace(0, 2 * helix.pitch, 17)
    frames = helix.transported_frame(z)
    np.testing.assert_allclose(frames @ frames.transpose(0, 2, 1), np.broadcast_to(np.eye(3), (17, 3, 3)), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(frames), 1.0, atol=1e-12)
    change = derivative(helix.transported_frame, z, 1e-3 * helix.pitch) * helix.pitch / (2 * np.pi)
    np.testing.assert_allclose((change[:, 1] * frames[:, 2]).sum(1), 0.0, atol=1e-8)


@FEW
@given(HELICES)
def test_left_lay_is_the_mirror_image_of_right_lay(helix):
    """Reflection y -> -y exchanges Z and S; the torsion changes sign, the curvature does not."""
    other = Helix(helix.radius, helix.pitch, "S" if helix.hand == "Z" else "Z", -helix.phase)
    z = np.linspace(0, helix.pitch, 9)
    np.testing.assert_allclose(other.position(z), helix.position(z) * [1, -1, 1], atol=1e-12)
    assert other.torsion == pytest.approx(-helix.torsion)
    assert other.curvature == pytest.approx(helix.curvature)


def test_right_hand_turns_from_x_to_y_going_up():
    assert Helix(1.0, 4.0, "Z").position(1.0) == pytest.approx([0, 1, 1], abs=1e-12)


def test_lay_ratio_is_pitch_over_diameter():
    assert Helix(0.011625, 0.234).lay_ratio(0.039) == pytest.approx(6.0)


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ((-1.0, 1.0), "radius"),
        ((1.0, 0.0), "pitch"),
        ((1.0, -2.0), "hand"),
        ((1.0, 1.0, "R"), "hand"),
        ((np.nan, 1.0), "radius"),
    ],
)
def test_impossible_helix_is_refused(arguments, word):
    with pytest.raises(GeometryError, match=word):
        Helix(*arguments)

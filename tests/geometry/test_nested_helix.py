"""A helix wound on a helix: distances, the straight and the toroidal limit, frames, order of convergence."""

import numpy as np
import pytest

from geometry import GeometryError, Helix, nested_helix
from geometry.nested_helix import CentreLine, wound_on

CORE = Helix(11.625e-3, 0.234)
ROPE = Helix(3.016e-3, 0.127)
WIRE = Helix(1.263e-3, 0.040)


def test_one_level_is_the_helix():
    z = np.linspace(0, 0.2, 7)
    line = nested_helix([CORE], z)
    np.testing.assert_allclose(line.points, CORE.position(z), atol=1e-15)
    np.testing.assert_allclose(line.s, z / np.cos(CORE.lay_angle), rtol=1e-12)


def test_wound_on_a_straight_line_it_is_a_helix_again():
    """Radius 0 for the outer level: formula (2) reduces to formula (1), up to the phase of the starting frame."""
    z = np.linspace(0, 0.1, 21)
    line = nested_helix([Helix(0.0, 1.0), ROPE], z)
    np.testing.assert_allclose(np.hypot(*line.points[:, :2].T), ROPE.radius, rtol=1e-12)
    angle = np.unwrap(np.arctan2(*line.points[:, 1::-1].T))
    np.testing.assert_allclose(np.diff(angle), 2 * np.pi * np.diff(z) / ROPE.pitch, rtol=1e-9)
    np.testing.assert_allclose(line.s, z / np.cos(ROPE.lay_angle), rtol=1e-8)


def test_member_keeps_its_distance_from_the_thicker_member():
    """Each level stays at its radius from the centre line it is wound on, and in the plane normal to it."""
    z = np.linspace(0, 0.234, 40)
    core, rope = nested_helix([CORE], z), nested_helix([CORE, ROPE], z)
    offset = rope.points - core.points
    np.testing.assert_allclose(np.linalg.norm(offset, axis=1), ROPE.radius, rtol=1e-12)
    np.testing.assert_allclose((offset * core.frames[:, 0]).sum(1), 0.0, atol=1e-15)


def test_pitch_counts_turns_in_the_transported_frame():
    """Over one pitch of arc length the member turns once against the frame that does not turn."""
    z = np.array([0.0, ROPE.pitch * np.cos(CORE.lay_angle)])
    core, rope = nested_helix([CORE], z), nested_helix([CORE, ROPE], z)
    components = np.einsum("nx,nax->na", rope.points - core.points, core.frames)
    np.testing.assert_allclose(components[0], components[1], atol=1e-12)


def test_three_levels_have_orthonormal_untwisted_frames():
    z = np.linspace(0, 0.05, 400)
    line = nested_helix([CORE, ROPE, WIRE], z)
    np.testing.assert_allclose(
        line.frames @ line.frames.transpose(0, 2, 1), np.broadcast_to(np.eye(3), (400, 3, 3)), atol=1e-9
    )
    tangent = np.gradient(line.points, line.s, axis=0)[2:-2]
    np.testing.assert_allclose(tangent, line.frames[2:-2, 0], atol=2e-4)  # second-order difference of 400 samples
    turn = (np.gradient(line.frames[:, 1], line.s, axis=0) * line.frames[:, 2]).sum(1)[2:-2]
    twist_of_radial_frame = 2 * np.pi / WIRE.pitch
    assert np.abs(turn).max() < 1e-3 * twist_of_radial_frame


def test_double_reflection_is_of_fourth_order():
    """Frames carried along a helix against the closed form: the error falls 16 times when the step is halved."""
    errors = []
    for n in (33, 65, 129):
        z = np.linspace(0, CORE.pitch, n)
        axis = CentreLine(z, np.column_stack([0 * z, 0 * z, z]), np.broadcast_to(np.eye(3)[[2, 0, 1]], (n, 3, 3)), z)
        line = wound_on(axis, CORE)
        exact = CORE.transported_frame(z)
        start = line.frames[0] @ exact[0].T
        errors.append(np.abs(line.frames[-1] - start @ exact[-1]).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders.min() > 3.7


def test_mirror_image():
    """All hands reversed: the mirror image in the plane y = 0."""
    z = np.linspace(0, 0.1, 30)
    right = nested_helix([CORE, ROPE], z).points
    left = nested_helix([Helix(CORE.radius, CORE.pitch, "S"), Helix(ROPE.radius, ROPE.pitch, "S")], z).points
    np.testing.assert_allclose(np.linalg.norm(left, axis=1), np.linalg.norm(right, axis=1), rtol=1e-9)
    np.testing.assert_allclose(left * [1, -1, 1], right, atol=1e-12)


def test_bad_requests_are_sentences():
    with pytest.raises(GeometryError, match="at least one level"):
        nested_helix([], [0, 1])
    with pytest.raises(GeometryError, match="increasing"):
        nested_helix([CORE], [0.0, 0.0])
    with pytest.raises(GeometryError, match="lengthen the lay"):
        nested_helix([Helix(0.01, 0.01), Helix(0.02, 0.1)], np.linspace(0, 0.1, 9))

"""A frame with a right angle in space, struck at its elbow (case D3): large rotations of a rod that is bent when unloaded."""

import numpy as np

from beam.benchmark_right_angle import CORNER, LEG, frame_shape, right_angle_frame, swinging_frame


def test_the_unloaded_frame():
    """The axes of its legs meet at (10, 0), the legs end at (10, 10); it turns by a right angle over the corner."""
    lengths, q = frame_shape(8)
    np.testing.assert_allclose(q[-1, :3], [LEG, LEG, 0.0], rtol=1e-6)
    assert lengths.sum() < 2 * LEG and q[-1, 8] == np.pi / 2
    np.testing.assert_allclose(np.linalg.norm(q[:, 3:6], axis=1), 1.0, rtol=1e-12)


def test_elbow_and_tip():
    """Against another code, 0.02 m to 15 s."""
    assert not [b.sentence() for b in right_angle_frame(15.0) if not b.passed]


def test_the_rounding_of_the_corner_changes_little():
    """At 4 s the difference between corners of 0.2 and 0.1 m is twice that between 0.1 and 0.05 m."""
    one, two, three = (swinging_frame(8, c, 4.0)[0][4.0] for c in (4 * CORNER, 2 * CORNER, CORNER))
    np.testing.assert_allclose((one - two) / (two - three), 2.0, rtol=0.1)

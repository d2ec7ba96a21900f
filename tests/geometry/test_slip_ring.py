"""Slip ring: a cylinder that turns inside a tube that stands still, joined without a gap, an overlap or a hanging diagonal.

Every face is shared by two cells or lies on the true boundary; the volume is that of the prism between the two polygons that turn
against each other; opposite hands are mirror images; Kepler's equation is solved.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geometry import MeshError
from geometry.mesh_quality import block_quality, block_sizes
from geometry.slip_ring import kepler_angle, pairing, slip_ring

FACES = {
    "hexahedra": [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]],
    "pyramids": [[0, 3, 2, 1], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
    "tetrahedra": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
}
KIND = {"hexahedra": "hexahedron", "pyramids": "pyramid", "tetrahedra": "tetra"}


def ring_mesh(steps, layers, N=12, inner=1.0, outer=1.5):
    """Points of all planes and of the middles, and the ring; cells about as high as they are thick."""
    height = 0.4 * layers
    k = np.arange(layers + 1)[:, None]
    turn = 2 * np.pi * (np.arange(N) + steps * k / layers) / N
    still = np.broadcast_to(2 * np.pi * np.arange(N) / N, turn.shape)
    z = np.broadcast_to(height * k / layers, turn.shape)
    planes = np.concatenate(
        [
            np.stack([radius * np.cos(a), radius * np.sin(a), z], axis=-1)
            for radius, a in ((inner, turn), (outer, still))
        ],
        axis=1,
    )
    number = 2 * N * k + np.arange(2 * N)
    ring = slip_ring(number[:, :N], number[:, N:], steps, number.size)
    points = planes.reshape(-1, 3)
    return np.concatenate([points, points[ring.divided].mean(axis=1)]), ring, number


def face_counts(ring):
    """How often every face occurs, by its sorted nodes."""
    counts = {}
    for kind, faces in FACES.items():
        cells = getattr(ring, kind)
        for face in faces:
            for nodes in np.sort(cells[:, face], axis=1).tolist():
                counts[tuple(nodes)] = counts.get(tuple(nodes), 0) + 1
    return counts


@settings(max_examples=25, deadline=None)
@given(steps=st.integers(-7, 7), extra=st.integers(1, 12), N=st.sampled_from([6, 8, 12]))
def test_every_face_is_shared_or_on_the_boundary(steps, extra, N):
    """All boundary faces are quadrilaterals: 2 N per layer on the two circles and N on each end face."""
    layers = abs(steps) + extra
    _, ring, number = ring_mesh(steps, layers, N)
    counts = face_counts(ring)
    assert set(counts.values()) <= {1, 2}
    once = {face for face, count in counts.items() if count == 1}
    assert len(once) == 2 * N * layers + 2 * N
    expected = set()
    for k in range(layers):
        for circle in (0, N):
            for i in range(N):
                pair = [number[k, circle + i], number[k, circle + (i + 1) % N]]
                expected.add(tuple(sorted(int(a) for a in [*pair, *(np.array(pair) + 2 * N)])))
    assert expected <= once
    ends = once - expected
    assert {len(face) for face in ends} == {4}


@settings(max_examples=25, deadline=None)
@given(steps=st.integers(-7, 7), m=st.integers(2, 7))
def test_no_cell_is_inside_out_and_none_is_lost(steps, m):
    """The volume is that between the polygons that turn; by the divergence theorem it depends on the boundary faces only."""
    layers = max(1, abs(steps)) * m
    points, ring, _ = ring_mesh(steps, layers)
    total = 0.0
    for name, kind in KIND.items():
        cells = getattr(ring, name)
        if len(cells):
            assert block_quality(points, cells, kind).min() > 0.1
            total += block_sizes(points, cells, kind).sum()
    N, height = 12, 0.4 * layers
    turn = 2 * np.pi * steps / N / layers

    def between(radius, angle):
        """Volume of a bilinear sweep of a polygon that turns by `angle`: its area is A (1 - 2 t (1 - t) (1 - cos angle))."""
        area = 0.5 * N * radius**2 * np.sin(2 * np.pi / N)
        return area * (1 - (1 - np.cos(angle)) / 3)

    assert total == pytest.approx(height * (between(1.5, 0.0) - between(1.0, turn)), rel=1e-12)


@settings(max_examples=20, deadline=None)
@given(steps=st.integers(1, 6), extra=st.integers(1, 10))
def test_opposite_hands_are_mirror_images(steps, extra):
    """Kinds, volumes and quality of the cells agree, and the mirrored nodes are the same points."""
    a, left, _ = ring_mesh(steps, steps + extra)
    b, right, _ = ring_mesh(-steps, steps + extra)
    for name, kind in KIND.items():
        p, q = getattr(left, name), getattr(right, name)
        assert len(p) == len(q)
        if len(p):
            np.testing.assert_allclose(np.sort(block_sizes(a, p, kind)), np.sort(block_sizes(b, q, kind)), rtol=1e-9)
    key = lambda x: x[np.lexsort(np.round(x, 9).T)]  # noqa: E731
    np.testing.assert_allclose(key(a * [1, -1, 1]), key(b), atol=1e-9)


def test_the_shear_is_half_an_index_at_most():
    """At mid-height of every layer, whatever the ratio of layers to steps; the ends have the pairs of the end faces."""
    for steps in (-9, -2, 1, 5, 8):
        for layers in range(abs(steps) + 1, 40):
            n = pairing(steps, layers)
            sigma = steps * (np.arange(layers) + 0.5) / layers
            assert np.abs(sigma - n).max() <= 0.5 + 1e-12
            assert (n[0], n[-1]) == (0, steps)
            np.testing.assert_array_equal(pairing(-steps, layers), -n)


def test_too_few_layers_are_refused():
    with pytest.raises(MeshError, match="take at least 6"):
        pairing(5, 5)


@given(theta=st.floats(-20, 20), e=st.floats(-0.8, 0.8))
def test_keplers_equation(theta, e):
    """phi - e sin(phi) returns theta; the solution grows with theta."""
    phi = float(kepler_angle(theta, e))
    assert phi - e * np.sin(phi) == pytest.approx(theta, abs=1e-12)
    assert float(kepler_angle(theta + 0.01, e)) > phi


def test_strands_that_turn_faster_than_the_plane_are_refused():
    with pytest.raises(MeshError, match="lengthen their lay"):
        kepler_angle(1.0, 0.95)

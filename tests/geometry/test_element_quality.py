"""Sizes and scaled Jacobians of elements whose values are known."""

import numpy as np
import pytest

from geometry import CrossSectionMesh, Material, Region, SliceMesh, element_sizes, scaled_jacobian

REGION = (Region("all", "sheath", Material("x", 1.0, 0.3, 1.0), np.nan),)


def flat(points, kind):
    points = np.array(points, dtype=float)
    return CrossSectionMesh(points, np.arange(len(points))[None], kind, np.zeros(1, int), REGION, 0.0)


def solid(points, kind):
    points = np.array(points, dtype=float)
    empty = np.zeros(0, dtype=int)
    return SliceMesh(points, np.arange(len(points))[None], kind, np.zeros(1, int), REGION, 0.0, 1.0, empty, empty)


TRIANGLE = [(0, 0), (1, 0), (0.5, np.sqrt(3) / 2)]
SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


def lifted(points):
    return [(*p, 0.0) for p in points] + [(*p, 1.0) for p in points]


@pytest.mark.parametrize(
    ("mesh", "size"),
    [
        (flat(TRIANGLE, "triangle"), np.sqrt(3) / 4),
        (flat(SQUARE, "quad"), 1.0),
        (solid(lifted(TRIANGLE), "wedge"), np.sqrt(3) / 4),
        (solid(lifted(SQUARE), "hexahedron"), 1.0),
    ],
)
def test_regular_elements_are_perfect(mesh, size):
    assert scaled_jacobian(mesh)[0] == pytest.approx(1.0, rel=1e-12)
    assert element_sizes(mesh)[0] == pytest.approx(size, rel=1e-12)


def test_rhombus_has_the_sine_of_its_angle():
    a = np.radians(35)
    mesh = flat([(0, 0), (1, 0), (1 + np.cos(a), np.sin(a)), (np.cos(a), np.sin(a))], "quad")
    assert scaled_jacobian(mesh)[0] == pytest.approx(np.sin(a))
    assert element_sizes(mesh)[0] == pytest.approx(np.sin(a))


def test_inside_out_is_negative():
    assert scaled_jacobian(flat(SQUARE[::-1], "quad"))[0] == pytest.approx(-1.0)
    assert element_sizes(flat(TRIANGLE[::-1], "triangle"))[0] < 0
    assert scaled_jacobian(solid(lifted(SQUARE)[4:] + lifted(SQUARE)[:4], "hexahedron"))[0] == pytest.approx(-1.0)


def test_curved_triangle_has_its_parabolic_segment():
    """One side bulged by h: area grows by (2/3) h x length (Archimedes)."""
    nodes = [(0, 0), (1, 0), (0, 1), (0.5, -0.1), (0.5, 0.5), (0, 0.5)]
    assert element_sizes(flat(nodes, "triangle6"))[0] == pytest.approx(0.5 + 2 / 3 * 0.1, rel=1e-12)


def test_curved_quadrilateral_has_its_parabolic_segment():
    nodes = [(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1.2), (1, 0), (0, 1), (-1, 0), (0, -0.1)]
    assert element_sizes(flat(nodes, "quad9"))[0] == pytest.approx(4 + 2 / 3 * 0.2 * 2, rel=1e-12)


def test_twisted_hexahedron_against_a_dense_sum():
    """Trilinear map integrated with many midpoints; the three-point rule is exact for it."""
    top = [(0.3, -0.1), (1.1, 0.2), (0.8, 1.3), (-0.2, 0.9)]
    points = np.array([(*p, 0.0) for p in SQUARE] + [(*p, 1.2) for p in top])
    t = (np.arange(40) + 0.5) / 40
    total, d = 0.0, 1e-6

    def position(x, y, z):
        w = [(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y]
        return sum(w[k] * ((1 - z) * points[k] + z * points[k + 4]) for k in range(4))

    for x in t[::4]:
        for y in t[::4]:
            for z in t[::4]:
                J = [
                    (position(*(np.array([x, y, z]) + d * e)) - position(*(np.array([x, y, z]) - d * e))) / (2 * d)
                    for e in np.eye(3)
                ]
                total += np.linalg.det(J) / 1000
    assert element_sizes(solid(points, "hexahedron"))[0] == pytest.approx(total, rel=2e-2)

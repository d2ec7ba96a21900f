"""Sizes and scaled Jacobians of elements whose values are known."""

import numpy as np
import pytest

from geometry import (
    CellBlock,
    CrossSectionMesh,
    GeometryError,
    Material,
    MeshError,
    Region,
    SweptCell,
    element_sizes,
    region_sizes,
    scaled_jacobian,
)
from geometry.cell_face import FACES
from geometry.mesh_quality import block_quality, block_sizes, quality_histogram, share_below
from geometry.quality_picture import POOR, draw_quality

REGION = (Region("all", "sheath", Material("x", 1.0, 0.3, 1.0), np.nan),)


def flat(points, kind):
    points = np.array(points, dtype=float)
    return CrossSectionMesh(points, np.arange(len(points))[None], kind, np.zeros(1, int), REGION, 0.0)


def solid(points, kind):
    points = np.array(points, dtype=float)
    empty = np.zeros(0, dtype=int)
    block = CellBlock(kind, np.arange(len(points))[None], np.zeros(1, int))
    return SweptCell(points, (block,), REGION, 0.0, 1.0, empty, empty)


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
        (solid([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, np.sqrt(0.5))], "pyramid"), np.sqrt(0.5) / 3),
        (
            solid([(0, 0, 0), (1, 0, 0), (0.5, np.sqrt(3) / 2, 0), (0.5, np.sqrt(3) / 6, np.sqrt(2 / 3))], "tetra"),
            np.sqrt(2) / 12,
        ),
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


def test_corner_of_a_cube_as_a_tetrahedron():
    """det 1; the longest edges meet at a far corner: 1 sqrt(2) sqrt(2), so 1/2 times sqrt 2."""
    mesh = solid([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], "tetra")
    assert scaled_jacobian(mesh)[0] == pytest.approx(np.sqrt(0.5))
    assert element_sizes(mesh)[0] == pytest.approx(1 / 6)


def test_pyramid_that_is_a_sixth_of_a_cube():
    """Height 1/2 over the unit square: det 1/2 over an edge of sqrt(3)/2, so sqrt(2/3). A tower counts as 1, not more."""
    mesh = solid([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 0.5)], "pyramid")
    assert scaled_jacobian(mesh)[0] == pytest.approx(np.sqrt(2 / 3))
    assert element_sizes(mesh)[0] == pytest.approx(1 / 6, rel=1e-14)
    assert scaled_jacobian(solid([*mesh.points[:4], (0.5, 0.5, 9.0)], "pyramid"))[0] == 1.0
    assert scaled_jacobian(solid([*mesh.points[:4], (0.5, 0.5, -0.5)], "pyramid"))[0] == pytest.approx(-np.sqrt(2 / 3))


def test_pyramid_on_a_warped_base_fills_what_its_neighbour_leaves():
    """A hexahedron cut into six pyramids has the same volume although its faces are bilinear and not plane."""
    points = np.array([*lifted(SQUARE), (0.45, 0.55, 0.6)]) + 0.15 * np.sin(np.arange(27)).reshape(9, 3)
    whole = element_sizes(solid(points[:8], "hexahedron"))[0]
    inward = [[*face[::-1], 8] for face in FACES["hexahedron"]]
    parts = [element_sizes(solid(points[nodes], "pyramid"))[0] for nodes in inward]
    assert sum(parts) == pytest.approx(whole, rel=1e-13)
    split = sum(block_sizes(points, np.array([[a, b, c, 8], [a, c, d, 8]]), "tetra").sum() for a, b, c, d, _ in inward)
    assert abs(split / whole - 1) > 1e-3  # plane triangles would not do


def blocks_of_two_kinds():
    points = np.array([*lifted(SQUARE), (0.5, 0.5, 1.5), (0.5, 0.5, 0.9)])
    blocks = (
        CellBlock("hexahedron", np.array([[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 0, 1, 2, 3]]), np.array([0, 0])),
        CellBlock("pyramid", np.array([[4, 5, 6, 7, 8]]), np.array([0])),
    )
    empty = np.zeros(0, dtype=int)
    return SweptCell(points, blocks, REGION, 0.0, 1.0, empty, empty)


def test_several_kinds_come_block_after_block():
    mesh = blocks_of_two_kinds()
    np.testing.assert_allclose(scaled_jacobian(mesh), [1.0, -1.0, np.sqrt(2 / 3)])
    np.testing.assert_allclose(element_sizes(mesh), [1.0, -1.0, 1 / 6])
    assert region_sizes(mesh)[0] == pytest.approx(1 / 6)
    np.testing.assert_array_equal(
        block_quality(mesh.points, mesh.blocks[1].cells, "pyramid"), scaled_jacobian(mesh)[2:]
    )


def test_histogram_counts_every_element_once():
    counts, edges = quality_histogram(blocks_of_two_kinds(), 4)
    np.testing.assert_array_equal(edges, [-1, 0, 0.25, 0.5, 0.75, 1])
    np.testing.assert_array_equal(counts, [1, 0, 0, 0, 2])
    assert share_below(blocks_of_two_kinds(), 0.9) == pytest.approx(2 / 3)
    assert share_below(np.array([0.1, 0.2, 0.3])) == pytest.approx(1 / 3)
    with pytest.raises(MeshError, match="bin"):
        quality_histogram(blocks_of_two_kinds(), 0)


def test_large_meshes_are_taken_in_parts(monkeypatch):
    from geometry import mesh_quality

    points = np.array(lifted(SQUARE))
    cells = np.arange(8)[None].repeat(7, axis=0)
    monkeypatch.setattr(mesh_quality, "AT_ONCE", 3)
    np.testing.assert_allclose(block_sizes(points, cells, "hexahedron"), np.ones(7))
    np.testing.assert_allclose(block_quality(points, cells, "hexahedron"), np.ones(7))


def test_a_collapsed_element_has_no_quality():
    assert scaled_jacobian(flat([(0, 0), (0, 0), (1, 1), (0, 1)], "quad"))[0] == 0.0


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


def test_the_histogram_is_drawn(tmp_path):
    """Bars of poor elements have a colour of their own, which a perfect mesh does not show."""
    import matplotlib.image
    from matplotlib.colors import to_rgb

    def poor(mesh, name):
        image = matplotlib.image.imread(draw_quality(mesh, tmp_path / name, dpi=50))[..., :3]
        return (np.abs(image - to_rgb(POOR)).max(axis=-1) < 0.02).sum()

    assert poor(solid(lifted(SQUARE), "hexahedron"), "cube.png") == 0
    assert poor(blocks_of_two_kinds(), "deep/two.png") > 20
    with pytest.raises(GeometryError, match=r"\.png"):
        draw_quality(blocks_of_two_kinds(), tmp_path / "quality.xyz")

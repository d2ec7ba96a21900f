"""Interfaces are the faces that two regions share; parted along them, each side hangs together and nothing else opens."""

from dataclasses import replace

import numpy as np
import pytest

from geometry import (
    CellBlock,
    Material,
    MeshError,
    Region,
    SliceMesh,
    SweptCell,
    cross_section_mesh,
    helical_slice,
    read_cable,
)
from geometry.cell_face import FACES
from geometry.doubled_nodes import double_nodes
from geometry.interface import CHOICES, face_normals, interfaces, select_interfaces
from geometry.mesh_quality import block_sizes, region_sizes

MATERIAL = Material("x", 1.0, 0.3, 1.0)
NONE = np.zeros(0, dtype=np.int64)


def regions(*kinds):
    return tuple(Region(f"{kind} {k}", kind, MATERIAL, np.nan) for k, kind in enumerate(kinds))


def bricks(shape, region_at, kinds, periodic=False):
    """Unit cubes on a grid; `region_at(x, y, z)` of the middle, negative for a void."""
    nx, ny, nz = shape
    number = np.arange((nx + 1) * (ny + 1) * (nz + 1)).reshape(nz + 1, ny + 1, nx + 1)
    z, y, x = np.indices(number.shape)
    points = np.column_stack([x.ravel(), y.ravel(), z.ravel()]).astype(float)
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    cells, region = [], []
    for k, j, i in np.ndindex(nz, ny, nx):
        r = region_at(i + 0.5, j + 0.5, k + 0.5)
        if r >= 0:
            cells.append([number[k + c, j + b, i + a] for c in (0, 1) for a, b in square])
            region.append(r)
    used, cells = np.unique(np.array(cells), return_inverse=True)
    row = np.full(number.size, -1)
    row[used] = np.arange(len(used))
    ends = [row[number[k].ravel()] for k in (0, -1)]
    bottom, top = (end[(ends[0] >= 0) & (ends[1] >= 0)] for end in ends) if periodic else (NONE, NONE)
    block = CellBlock("hexahedron", cells.reshape(-1, 8), np.array(region))
    return SweptCell(points[used], (block,), regions(*kinds), 0.0, float(nz), bottom, top)


def bodies(mesh):
    """How many parts hang together through common nodes, the end faces not glued."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    n = len(mesh.points)
    pairs = np.vstack(
        [np.column_stack([np.repeat(b.cells[:, 0], b.cells.shape[1]), b.cells.ravel()]) for b in mesh.blocks]
    )
    return connected_components(coo_array((np.ones(len(pairs)), tuple(pairs.T)), shape=(n, n)), directed=False)[0]


def glued(doubled):
    """The cells with the numbers that their nodes had before."""
    return [doubled.original[block.cells] for block in doubled.mesh.blocks]


def check(mesh, doubled):
    """What holds for every parted mesh."""
    for before, after in zip(mesh.blocks, glued(doubled), strict=True):
        np.testing.assert_array_equal(after, before.cells)
    np.testing.assert_array_equal(doubled.mesh.points, mesh.points[doubled.original])
    np.testing.assert_allclose(region_sizes(doubled.mesh), region_sizes(mesh), rtol=1e-12)
    for pair in doubled.pairs:
        places = doubled.mesh.points
        np.testing.assert_array_equal(places[pair.side_a], places[pair.side_b])
        np.testing.assert_array_equal(doubled.original[pair.side_a], pair.interface.faces)
        np.testing.assert_allclose(np.linalg.norm(pair.normals, axis=1), 1.0, rtol=1e-12)
        for side, cells in ((pair.side_a, pair.interface.cells[:, 0]), (pair.side_b, pair.interface.cells[:, 1])):
            table = np.vstack([np.pad(b.cells, ((0, 0), (0, 8 - b.cells.shape[1]))) for b in doubled.mesh.blocks])
            assert all(set(face) <= set(table[cell]) for face, cell in zip(side, cells))
    if len(mesh.bottom):
        assert doubled.mesh.matching_gap() < 1e-12


@pytest.mark.parametrize("kind", FACES)
def test_faces_close_around_their_cell(kind):
    """The vector areas of a closed surface add to nothing, and its flux of x is three times the volume: normals look outwards."""
    places = {
        "hexahedron": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
        "wedge": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)],
        "pyramid": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.4, 0.3, 1)],
        "tetra": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.2, 0.1, 1)],
    }
    points = np.array(places[kind], dtype=float) @ np.array([[1, 0.2, 0.1], [0, 1.1, 0.3], [-0.1, 0, 0.9]])
    corners = points[[[k if k >= 0 else face[2] for k in face] for face in FACES[kind]]]
    vectors = 0.5 * np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    np.testing.assert_allclose(vectors.sum(axis=0), 0.0, atol=1e-14)
    flux = (corners[:, 0] * vectors).sum() / 3  # the faces are plane
    assert flux == pytest.approx(block_sizes(points, np.arange(len(points))[None], kind)[0], rel=1e-12)


def test_two_blocks():
    mesh = bricks((4, 2, 3), lambda x, y, z: int(x > 2), ("strand", "insulation"))
    (found,) = interfaces(mesh)
    assert (found.name, found.kinds, found.regions) == ("strand 0 | insulation 1", ("strand", "insulation"), (0, 1))
    assert found.faces.shape == (6, 4)
    assert found.area == pytest.approx(6.0, rel=1e-14)
    np.testing.assert_allclose(face_normals(mesh.points, found.faces), np.tile([1.0, 0, 0], (6, 1)), atol=1e-15)
    doubled = double_nodes(mesh, (found,))
    check(mesh, doubled)
    assert len(doubled.mesh.points) == len(mesh.points) + 3 * 4
    assert bodies(doubled.mesh) == 2
    np.testing.assert_array_equal(doubled.pairs[0].normals, face_normals(mesh.points, found.faces))


def test_moving_one_side_leaves_the_other_where_it_is():
    mesh = bricks((4, 2, 3), lambda x, y, z: int(x > 2), ("strand", "insulation"))
    doubled = double_nodes(mesh, interfaces(mesh))
    (block,) = doubled.mesh.blocks
    moved = doubled.mesh.points.copy()
    moved[np.unique(block.cells[block.region_of == 1])] += [0.5, 0.25, 0.0]
    opened = replace(doubled.mesh, points=moved)
    np.testing.assert_array_equal(
        moved[block.cells[block.region_of == 0]], mesh.points[mesh.blocks[0].cells[block.region_of == 0]]
    )
    np.testing.assert_allclose(region_sizes(opened), region_sizes(mesh), rtol=1e-12)
    (pair,) = doubled.pairs
    gap = np.einsum("fkx,fx->fk", moved[pair.side_b] - moved[pair.side_a], pair.normals)
    np.testing.assert_allclose(gap, 0.5, rtol=1e-12)


def test_a_tee_opens_along_its_stem_and_stays_whole_along_its_bar():
    """Regions 0 and 1 side by side on 2: the node line under their joint gets 2 nodes if only the stem opens, 3 if all do."""
    mesh = bricks((4, 2, 1), lambda x, y, z: 2 if y < 1 else int(x > 2), ("strand", "strand", "insulation"))
    found = interfaces(mesh)
    assert [i.name for i in found] == ["strand 0 | strand 1", "strand 0 | insulation 2", "strand 1 | insulation 2"]
    stem = double_nodes(mesh, select_interfaces(found, "strand-strand"))
    check(mesh, stem)
    assert (
        len(stem.mesh.points) - len(mesh.points) == 2
    )  # the line on the bar does not open: both sides hang on region 2
    (pair,) = stem.pairs
    rim = doubled_places(mesh, pair.side_a == pair.side_b, pair.side_a)
    np.testing.assert_array_equal(rim[:, 1], 1.0)
    bar = double_nodes(mesh, select_interfaces(found, "conductor-insulation"))
    check(mesh, bar)
    assert bodies(bar.mesh) == 2
    everything = double_nodes(mesh, found)
    check(mesh, everything)
    assert bodies(everything.mesh) == 3
    copies = np.bincount(everything.original)
    np.testing.assert_array_equal(copies[(mesh.points[:, 0] == 2) & (mesh.points[:, 1] == 1)], 3)
    np.testing.assert_array_equal(np.unique(copies), [1, 2, 3])


def doubled_places(mesh, mask, nodes):
    return mesh.points[np.unique(nodes[mask])]


@pytest.mark.parametrize(("chosen", "copies"), [((0,), 1), ((1,), 1), ((0, 1), 2), ((0, 2), 2), ((0, 1, 2), 3)])
def test_three_regions_that_meet_in_a_line(chosen, copies):
    """One interface alone ends at the line and cannot open it; two part one region from the others; three part all."""
    mesh = bricks((2, 2, 2), lambda x, y, z: 0 if y < 1 else (1 if x < 1 else 2), ("a", "b", "c"))
    found = interfaces(mesh)
    doubled = double_nodes(mesh, [found[k] for k in chosen])
    check(mesh, doubled)
    line = (mesh.points[:, 0] == 1) & (mesh.points[:, 1] == 1)
    np.testing.assert_array_equal(np.bincount(doubled.original)[line], copies)


def test_nothing_chosen_changes_nothing():
    mesh = bricks((2, 2, 2), lambda x, y, z: int(x > 1), ("a", "b"), periodic=True)
    doubled = double_nodes(mesh, ())
    np.testing.assert_array_equal(doubled.mesh.blocks[0].cells, mesh.blocks[0].cells)
    np.testing.assert_array_equal(doubled.mesh.bottom, mesh.bottom)
    assert doubled.pairs == () and len(doubled.original) == len(mesh.points)


def four_bars(layers):
    """Four bars of 2 x 2 cubes whose end faces match after a quarter turn: bar k on the bottom is bar k + 1 on the top."""

    def quarter(x, y, z):
        return [[0, 1], [3, 2]][int(y > 2)][int(x > 2)]

    mesh = bricks((4, 4, layers), quarter, ("strand",) * 4)
    points = mesh.points - [2.0, 2.0, 0.0]
    below, above = (np.flatnonzero(points[:, 2] == z) for z in (0, layers))
    turned = points[below] @ np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1.0]]) + [0, 0, layers]
    top = above[((points[above][None] - turned[:, None]) ** 2).sum(-1).argmin(axis=1)]
    mesh = replace(mesh, points=points, bottom=below, top=top, twist_rate=np.pi / 2 / layers)
    assert mesh.matching_gap() < 1e-12
    return mesh


@pytest.mark.parametrize("layers", [1, 2, 3])
def test_a_strand_that_goes_on_as_its_neighbour(layers):
    """Every bar stays one body, and its end nodes find their partners on its neighbour."""
    mesh = four_bars(layers)
    doubled = double_nodes(mesh, interfaces(mesh))
    check(mesh, doubled)
    assert bodies(doubled.mesh) == 4
    axis = np.flatnonzero((doubled.mesh.points[:, :2] == 0).all(axis=1))
    assert len(axis) == 4 * (layers + 1)
    region = np.full(len(doubled.mesh.points), -1)
    (block,) = doubled.mesh.blocks
    region[block.cells] = block.region_of[:, None]
    assert (
        len(doubled.mesh.bottom) == 4 * 9 and len(set(doubled.mesh.bottom)) == 36
    )  # every strand has its 3 x 3 end nodes
    np.testing.assert_array_equal(region[doubled.mesh.top], (region[doubled.mesh.bottom] + 1) % 4)


def test_an_interface_that_ends_at_the_end_faces():
    """Bars 0 and 1 alone are parted; above and below they go on as bars that are not: nothing opens on the end faces.

    Of the 3 nodes of each inner plane the one on the axis stays whole, 0 and 1 are joined round it by 2 and 3.
    """
    mesh = four_bars(3)
    doubled = double_nodes(mesh, select_interfaces(interfaces(mesh), "strand 0 | strand 1"))
    check(mesh, doubled)
    np.testing.assert_array_equal(np.sort(mesh.points[doubled.original[len(mesh.points) :], 2]), [1, 1, 2, 2])
    pairs = [set(zip(m.bottom.tolist(), m.top.tolist())) for m in (mesh, doubled.mesh)]
    assert pairs[0] == pairs[1]


def test_an_interface_that_ends_at_a_void():
    """Two bars that touch on a patch beside an empty hole: the patch opens up to the hole, where the sides are free already."""
    mesh = bricks(
        (4, 3, 2), lambda x, y, z: -1 if 1 < x < 3 and y > 2 else int(x > 2), ("strand", "strand"), periodic=True
    )
    (found,) = interfaces(mesh)
    doubled = double_nodes(mesh, (found,))
    check(mesh, doubled)
    assert bodies(doubled.mesh) == 2
    assert (doubled.pairs[0].side_a != doubled.pairs[0].side_b).all()


def test_words_of_cable_making_choose():
    mesh = bricks((4, 2, 1), lambda x, y, z: 2 if y < 1 else int(x > 2), ("strand", "strand", "insulation"))
    found = interfaces(mesh)

    def names(*words):
        return [i.name for i in select_interfaces(found, *words)]

    assert names("strand-strand") == names("strand 0 | strand 1") == ["strand 0 | strand 1"]
    assert (
        names("conductor-insulation")
        == names("insulation-strand")
        == names("strand|insulation")
        == names("* | insulation 2")
    )
    assert names("strand * | *", "strand-strand") == [i.name for i in found]
    with pytest.raises(MeshError, match=r'"core-filler"; there are strand\|insulation, strand\|strand'):
        select_interfaces(found, "core-filler")


def test_overlapping_cells_are_refused():
    mesh = bricks((2, 1, 1), lambda x, y, z: int(x > 1), ("a", "b"))
    (block,) = mesh.blocks
    third = replace(block, cells=np.vstack([block.cells, block.cells[1:]]), region_of=np.array([0, 1, 0]))
    with pytest.raises(MeshError, match="three cells share one face"):
        interfaces(replace(mesh, blocks=(third,)))


@pytest.fixture(scope="module")
def cable():
    return read_cable("mcpt-1.9-3.3-3x35")


@pytest.fixture(scope="module", params=["triangle", "quad"])
def cell(cable, request) -> SliceMesh:
    return helical_slice(cross_section_mesh(cable, 4e-3, request.param), 0.015, 4)


def test_interface_of_a_laid_conductor_has_the_area_of_its_tube(cable, cell):
    """A tube of radius rho has 2 pi rho of surface per arc length (Pappus), the arc is height / cos beta; the facets lose 0.2 %."""
    found = {i.name: i for i in interfaces(cell)}
    part = cable.part("power core 1 conductor")
    exact = 2 * np.pi * part.outer_radius * cell.height / np.cos(part.outer_trace.lay_angle)
    assert found["power core 1 conductor | power core 1 insulation"].area == pytest.approx(exact, rel=4e-3)


def test_every_choice_that_the_cable_has(cell):
    found = interfaces(cell)
    absent = {"strand-strand", "core-core", "core-sheath", "filler-sheath"}
    for word in set(CHOICES) - absent:
        assert select_interfaces(found, word), word
    assert len(select_interfaces(found, "conductor-insulation")) == 5
    assert len(select_interfaces(found, "centre-core")) == 4


def test_conductors_parted_from_their_insulation(cell):
    """Surfaces that surround a conductor are tubes: Euler's number 0, rims at the two ends only, none of the nodes shared."""
    chosen = select_interfaces(interfaces(cell), "conductor-insulation")
    doubled = double_nodes(cell, chosen)
    check(cell, doubled)
    assert bodies(doubled.mesh) == 6
    for pair in doubled.pairs:
        assert not set(pair.side_a.ravel()) & set(pair.side_b.ravel())
        edges = np.sort(np.vstack([pair.side_a[:, [k, (k + 1) % 4]] for k in range(4)]), axis=1)
        edges, count = np.unique(edges, axis=0, return_counts=True)
        assert len(np.unique(pair.side_a)) - len(edges) + len(pair.side_a) == 0
        assert set(count) == {1, 2}
        ends = doubled.mesh.points[edges[count == 1], 2]
        assert np.isin(ends, [0.0, cell.height]).all() and (ends[:, 0] == ends[:, 1]).all()
        np.testing.assert_allclose(pair.areas.sum(), pair.interface.area, rtol=1e-12)
    extra = len(doubled.mesh.points) - len(cell.points)
    assert extra == sum(len(np.unique(pair.side_a)) for pair in doubled.pairs)
    assert len(doubled.mesh.bottom) - len(cell.bottom) == extra // 5  # of five planes of nodes


def test_everything_parted(cell):
    """Every region hangs together for itself; the filler is four pockets, the rest one body each."""
    doubled = double_nodes(cell, interfaces(cell))
    check(cell, doubled)
    assert bodies(doubled.mesh) == len(cell.regions) + 3
    node_regions = np.unique(
        np.column_stack([doubled.mesh.cells.ravel(), np.repeat(cell.region_of, cell.cells.shape[1])]), axis=0
    )
    assert len(node_regions) == len(doubled.mesh.points)


def test_pyramids_and_tetrahedra_part_too():
    """A cube of six pyramids, one of them two tetrahedra, beside a cube of the region of one tetrahedron.

    Their interface is a square and three triangles: two of sides 1, sqrt(3)/2, sqrt(3)/2 and one of sqrt(2), sqrt(3)/2, sqrt(3)/2.
    """
    cube = bricks((2, 1, 1), lambda x, y, z: int(x > 1), ("a", "b"))
    left, right = cube.blocks[0].cells
    points = np.vstack([cube.points, cube.points[left].mean(axis=0)])
    apex = len(cube.points)
    sides = [left[list(face)][::-1] for face in FACES["hexahedron"]]  # seen from inside
    blocks = (
        CellBlock("hexahedron", right[None], np.array([1])),
        CellBlock("pyramid", np.array([[*side, apex] for side in sides[1:]]), np.zeros(5, dtype=np.int64)),
        CellBlock("tetra", np.array([[*sides[0][[0, 1, 2]], apex], [*sides[0][[0, 2, 3]], apex]]), np.array([0, 1])),
    )
    mesh = SweptCell(points, blocks, regions("a", "b"), 0.0, 1.0, NONE, NONE)
    np.testing.assert_allclose(region_sizes(mesh), [11 / 12, 13 / 12], rtol=1e-12)
    (found,) = interfaces(mesh)
    assert found.faces.shape == (4, 4)
    assert found.area == pytest.approx(1 + 2 * np.sqrt(0.5) / 2 + np.sqrt(2) * 0.5 / 2, rel=1e-12)
    doubled = double_nodes(mesh, (found,))
    check(mesh, doubled)
    assert bodies(doubled.mesh) == 3

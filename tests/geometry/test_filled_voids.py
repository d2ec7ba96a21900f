"""Voids between strands filled on request: no gap, no overlap, nothing moved, and the mass of what is filled in."""

import numpy as np
import pytest

from geometry import SpecError, cable_files, read_cable
from geometry.conductor_section import conductor_section
from geometry.errors import MeshError
from geometry.mesh_quality import block_quality, block_sizes, region_sizes, scaled_jacobian
from geometry.nested_cell import nested_cell
from geometry.strand_void import best_triangles, fill_voids, void_outlines

CASES = {
    "1+6": ((1, 6), 1.5e-3, 4.5e-3, 2 * np.pi / 0.127, 48),
    "1+6 fine": ((1, 6), 1.5e-3, 4.5e-3, -2 * np.pi / 0.127, 96),
    "3 straight": ((3,), 1.5e-3, 1.5e-3 * (1 + 2 / np.sqrt(3)), 0.0, 36),
    "1+6+12": ((1, 6, 12), 1e-3, 5e-3, 2 * np.pi / 0.1, 96),
}
TEXT = cable_files()["mcpt-1.9-3.3-3x35"].read_text(encoding="utf-8")


@pytest.fixture(scope="module", params=CASES)
def section(request):
    return conductor_section(*CASES[request.param], filled=True)


def test_strands_and_voids_make_the_circle(section):
    """Areas add up to the ring's polygon, which has the area of its circle (exact)."""
    areas = (
        block_sizes(section.points, section.cells, "quad"),
        block_sizes(section.points, section.void_cells, "triangle"),
    )
    assert min(areas[1]) > 0
    assert sum(map(np.sum, areas)) == pytest.approx(np.pi * section.conductor_radius**2, rel=1e-12)


def test_filling_is_conforming(section):
    """Every edge has two cells, but those of the ring, which have one: no hanging node, no gap."""
    edges = np.concatenate(
        [section.cells[:, [k, (k + 1) % 4]] for k in range(4)]
        + [section.void_cells[:, [k, (k + 1) % 3]] for k in range(3)]
    )
    unique, count = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    assert set(count) == {1, 2}
    ring = section.ring
    assert {tuple(e) for e in unique[count == 1].tolist()} == {
        tuple(sorted(e)) for e in zip(ring, np.roll(ring, -1), strict=True)
    }


def test_filling_repeats_with_the_strands(section):
    """Turned by 2 pi / fold the triangles lie on triangles, so that the end faces of a cell match as faces."""
    a = 2 * np.pi / section.fold
    turned = section.points @ np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]])
    image = np.linalg.norm(turned[:, None] - section.points[None], axis=2).argmin(1)
    before = {frozenset(t) for t in section.void_cells.tolist()}
    assert {frozenset(t) for t in image[section.void_cells].tolist()} == before


@pytest.mark.parametrize("name", CASES)
def test_filling_moves_nothing_and_is_well_shaped(name):
    """The strands' nodes and cells are those of the empty section; a node on the axis may follow them."""
    empty, filled = (conductor_section(*CASES[name], filled=yes) for yes in (False, True))
    assert len(empty.void_cells) == 0
    np.testing.assert_array_equal(filled.points[: len(empty.points)], empty.points)
    np.testing.assert_array_equal(filled.cells, empty.cells)
    assert block_quality(filled.points, filled.void_cells, "triangle").min() > 0.2


def test_number_of_voids_is_eulers():
    """1 + 6: six between the centre and two neighbours, six at the ring. 3 straight: one in the middle, three at the ring."""
    for name, voids in (("1+6", 12), ("3 straight", 4)):
        section = conductor_section(*CASES[name])
        assert len(void_outlines(section.points, section.cells, section.ring)) == voids


@pytest.mark.parametrize("n", [3, 5, 8, 21])
def test_polygon_is_cut_in_n_less_two(n):
    angle = 2 * np.pi * np.arange(n) / n
    polygon = np.column_stack([np.cos(angle), np.sin(angle) * (1 + 0.3 * np.cos(angle))])
    cut = best_triangles(polygon)
    assert len(cut) == n - 2
    x, y = polygon.T
    area = 0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()
    assert block_sizes(polygon, cut, "triangle").sum() == pytest.approx(area, rel=1e-12)


def test_crossed_outline_is_told():
    with pytest.raises(MeshError, match="crosses itself"):
        best_triangles(np.array([[0, 0], [1, 1], [1, 0], [0, 1.0]]))


def test_strands_that_do_not_repeat_are_told():
    section = conductor_section(*CASES["1+6"])
    with pytest.raises(MeshError, match="do not repeat 5 times"):
        fill_voids(section.points, section.cells, section.ring, 5)


def with_voids(folder, material):
    path = folder / "mine.toml"
    path.write_text(TEXT.replace("[conductors.power]\n", f"[conductors.power]\nvoids = {material}\n"), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def filled(tmp_path_factory):
    """The reference cable with rubber between its power strands, and its cell."""
    cable = read_cable(with_voids(tmp_path_factory.mktemp("filled"), '"bedding rubber"'))
    return cable, nested_cell(cable, size=2.5e-3)


def test_cell_of_the_reference_cable_with_filled_power_conductors(filled):
    """Wedges between the strands; volumes of strands stay, those of the voids are what is left of the conductor; end faces match."""
    empty, cell = nested_cell(read_cable("mcpt-1.9-3.3-3x35"), size=2.5e-3), filled[1]
    assert cell.count("wedge") > 0 and empty.count("wedge") == 0
    assert cell.count("hexahedron") == empty.count("hexahedron")
    assert cell.matching_gap() < 1e-12
    assert scaled_jacobian(cell).min() >= 0.99 * scaled_jacobian(empty).min()
    volume = dict(zip((r.name for r in cell.regions), region_sizes(cell), strict=True))
    before = dict(zip((r.name for r in empty.regions), region_sizes(empty), strict=True))
    assert {name: volume[name] for name in before} == pytest.approx(before, rel=1e-12)
    assert set(volume) - set(before) == {f"power core {k} voids" for k in (1, 2, 3)}
    for region in cell.regions:
        if region.name.endswith("voids"):
            assert (region.kind, region.material.name) == ("interstices", "bedding rubber")
            assert volume[region.name] == pytest.approx(
                region.closed_form_area * cell.height, rel=0.01
            )  # straight edges


def test_mass_is_that_of_the_filled_space(filled):
    """Mass per length grows by density times void area, taken from the regions of the cell (lay of the strands: 1e-3)."""
    plain, (cable, cell) = read_cable("mcpt-1.9-3.3-3x35"), filled
    rubber = cable.conductors["power"].voids
    area = sum(r.closed_form_area for r in cell.regions if r.name.endswith("voids"))
    assert cable.mass_per_length - plain.mass_per_length == pytest.approx(rubber.density * area, rel=5e-3)


@pytest.mark.parametrize(
    ("material", "sentence"),
    [
        ('"tar"', r'conductors.power.voids: there is no "tar" in \[materials\]'),
        ("3", "conductors.power.voids: 3 is not possible"),
    ],
)
def test_bad_materials(tmp_path, material, sentence):
    with pytest.raises(SpecError, match=sentence):
        read_cable(with_voids(tmp_path, material))

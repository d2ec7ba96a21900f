"""The slice: end faces match under the helical motion, volumes are area x height, lay and hand are respected."""

import numpy as np
import pytest

from geometry import (
    MeshError,
    cross_section_mesh,
    helical_slice,
    read_cable,
    region_sizes,
    scaled_jacobian,
    slice_of_size,
    slice_record,
)


@pytest.fixture(scope="module")
def cable():
    return read_cable("mcpt-1.9-3.3-3x35")


@pytest.fixture(scope="module", params=["triangle", "quad"])
def section(cable, request):
    return cross_section_mesh(cable, 4e-3, request.param)


def test_end_faces_match_node_for_node(section):
    mesh = helical_slice(section, 0.234 / 8, 4)
    assert mesh.matching_gap() < 1e-15
    np.testing.assert_array_equal(mesh.points[mesh.bottom, 2], 0.0)
    np.testing.assert_allclose(mesh.points[mesh.top, 2], mesh.height, rtol=1e-15)
    assert mesh.cell_kind == {"triangle": "wedge", "quad": "hexahedron"}[section.cell_kind]


def test_a_wrong_twist_does_not_match(section):
    """The gap is that of a point on the surface turned by the error: the test above can fail."""
    from dataclasses import replace

    mesh = replace(helical_slice(section, 0.02, 2), twist_rate=1.01 * section.twist_rate)
    assert mesh.matching_gap() == pytest.approx(0.0258 * 0.01 * section.twist_rate * 0.02, rel=1e-3)


def test_volumes_are_area_times_height(section):
    """Trilinear elements of turn a per layer lose about a^2/6 of the area between layers; to zero with the square of a."""
    losses = []
    for layers in (2, 4, 8):
        mesh = helical_slice(section, 0.234 / 16, layers)
        losses.append(1 - region_sizes(mesh) / (region_sizes(section) * mesh.height))
    losses = np.array(losses)
    turn = 2 * np.pi / 16 / 8
    assert np.abs(losses[-1]).max() < turn**2 / 5
    np.testing.assert_allclose(np.log2(losses[:-1] / losses[1:]), 2.0, atol=0.1)


def test_elements_are_not_inside_out(section):
    assert scaled_jacobian(helical_slice(section, 0.234 / 8, 4)).min() > 0.1


def test_straight_cable_is_a_prism(section):
    from dataclasses import replace

    mesh = helical_slice(replace(section, twist_rate=0.0), 0.01, 1)
    np.testing.assert_array_equal(mesh.points[mesh.top, :2], mesh.points[mesh.bottom, :2])
    np.testing.assert_allclose(region_sizes(mesh), 0.01 * region_sizes(section), rtol=1e-12)


def test_region_numbers_follow_the_layers(section):
    mesh = helical_slice(section, 0.01, 3)
    np.testing.assert_array_equal(mesh.region_of.reshape(3, -1), np.tile(section.region_of, (3, 1)))


@pytest.mark.parametrize(
    ("height", "layers", "word"),
    [
        (0.0, 1, "height"),
        (np.nan, 1, "height"),
        (0.01, 0, "layers"),
        (0.01, 1.5, "layers"),
        (0.234, 2, "30|at least 12"),
        (0.01, 10**8, "elements"),
    ],
)
def test_impossible_slices(section, height, layers, word):
    with pytest.raises(MeshError, match=word):
        helical_slice(section, height, layers)


def test_second_order_sections_are_refused(cable):
    with pytest.raises(MeshError, match="triangle"):
        helical_slice(cross_section_mesh(cable, 6e-3), 0.01, 1)


@pytest.mark.parametrize("asked", [5000, 60_000])
def test_slice_of_at_least_so_many_elements(cable, asked):
    said = []
    mesh = slice_of_size(cable, asked, progress=lambda fraction, sentence: said.append((fraction, sentence)))
    record = slice_record(cable, mesh, seconds=1.5)
    assert asked <= record["elements"] == record["hexes"] == len(mesh.cells)
    assert record["prisms"] == record["tets"] == 0 and record["matched_faces"] is True
    assert record["schema"] == 1 and record["cable"] == cable.name and record["seconds"] == 1.5
    assert record["min_scaled_jacobian"] > 0.1
    assert all(0 <= fraction <= 1 for fraction, _ in said) and said
    for name, region in record["regions"].items():
        assert region["volume"] == pytest.approx(region["closed_form"], rel=0.02), name
        assert region["closed_form"] == pytest.approx(cable.part(name).area * mesh.height)


def test_slice_of_wedges(cable):
    record = slice_record(cable, slice_of_size(cable, 3000, height=0.005, cell_kind="wedge"), 0.0)
    assert record["prisms"] == record["elements"] >= 3000 and record["hexes"] == 0


@pytest.mark.parametrize(
    ("elements", "word"), [(0, "whole number"), (-5, "whole number"), (1.5, "whole number"), (10**9, "GB of memory")]
)
def test_absurd_numbers_of_elements(cable, elements, word):
    with pytest.raises(MeshError, match=word):
        slice_of_size(cable, elements)


def test_absurd_kind_and_height(cable):
    with pytest.raises(MeshError, match="hexahedron or wedge"):
        slice_of_size(cable, 1000, cell_kind="tetra")
    with pytest.raises(MeshError, match="height"):
        slice_of_size(cable, 1000, height=-1.0)

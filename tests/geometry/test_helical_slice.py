"""The slice: end faces match under the helical motion, volumes are area x height, lay and hand are respected."""

import json

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
from geometry.common_period import cell_of
from geometry.doubled_nodes import double_nodes
from geometry.interface import interfaces, select_interfaces


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
    radius = np.hypot(*section.points.T).max()  # corners of the area-true polygon lie a little outside 25.8 mm
    assert radius == pytest.approx(0.0258, rel=3e-3)
    assert mesh.matching_gap() == pytest.approx(radius * 0.01 * section.twist_rate * 0.02, rel=1e-4)


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
        limit = (
            5e-3 if cable.part(name).kind in ("cover", "wrap") else 2.5e-3
        )  # closures of contacts add 0.4 % to these two
        assert region["volume"] == pytest.approx(region["closed_form"], rel=limit), name
        assert region["closed_form"] == pytest.approx(cable.part(name).area * mesh.height)


def test_the_record_tells_quality_and_interfaces(cable):
    mesh = slice_of_size(cable, 5000)
    record = slice_record(cable, mesh, 0.0)
    quality = scaled_jacobian(mesh)
    assert sum(record["quality"]["histogram"]) == record["elements"]
    assert len(record["quality"]["edges"]) == len(record["quality"]["histogram"]) + 1
    assert record["quality"]["below_0.2"] == (quality < 0.2).mean()
    assert record["pyramids"] == 0 and record["separated"] == {} and "lays" not in record
    found = interfaces(mesh)
    assert set(record["interfaces"]) == {"-".join(i.kinds) for i in found}
    assert sum(record["interfaces"].values()) == pytest.approx(sum(i.area for i in found))
    json.dumps(record, allow_nan=False)
    parted = slice_record(cable, double_nodes(mesh, select_interfaces(found, "conductor-insulation")), 0.0)
    assert parted["interfaces"] == pytest.approx(record["interfaces"])
    assert set(parted["separated"]) == {"conductor-insulation", "conductor-cover"}
    assert parted["nodes"] > record["nodes"] and parted["regions"] == record["regions"]


def test_the_record_lists_the_lays_of_a_common_period(cable):
    period = cell_of(cable)
    lays = slice_record(cable, slice_of_size(cable, 1000), 0.0, period)["lays"]
    assert [lay["name"] for lay in lays] == [layer.name for layer in period.layers] != []
    for lay, layer in zip(lays, period.layers):
        assert (lay["lay"], lay["nominal_lay"], lay["turns"]) == (layer.lay, layer.nominal.lay, layer.turns)
        assert (
            lay["change"] == pytest.approx(lay["lay_angle"] - lay["nominal_lay_angle"], abs=1e-9) or lay["lay"] is None
        )
    json.dumps(lays, allow_nan=False)


def test_layers_turn_by_five_degrees_at_most(cable):
    """An eighth of the lay is 45 degrees: nine layers, however few elements are asked for."""
    mesh = slice_of_size(cable, 1)
    assert len(np.unique(np.round(mesh.points[:, 2], 9))) == 10


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

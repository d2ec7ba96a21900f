"""What is written to a file can be read back: points, cells, region names and volumes."""

import meshio
import numpy as np
import pytest

from geometry import (
    CellBlock,
    GeometryError,
    Material,
    MeshError,
    Region,
    SweptCell,
    cross_section_mesh,
    helical_slice,
    read_cable,
    write_mesh,
    write_solids,
)
from geometry.doubled_nodes import double_nodes
from geometry.interface import interfaces


@pytest.fixture(scope="module")
def cable():
    return read_cable("mcpt-1.9-3.3-3x35")


@pytest.fixture(scope="module")
def section(cable):
    return cross_section_mesh(cable, 6e-3, "triangle")


@pytest.fixture(scope="module")
def meshes(section, cable):
    return [
        section,
        helical_slice(section, 0.01, 1),
        cross_section_mesh(cable, 6e-3, "triangle6"),
        helical_slice(cross_section_mesh(cable, 6e-3, "quad"), 0.01, 1),
    ]


def test_vtu_holds_numbers_and_names_of_the_regions(meshes, tmp_path):
    for mesh in meshes:
        found = meshio.read(write_mesh(mesh, tmp_path / "deep" / "cell.vtu"))
        np.testing.assert_array_equal(found.cells[0].data, mesh.cells)
        assert found.cells[0].type == mesh.cell_kind
        np.testing.assert_allclose(found.points[:, : mesh.points.shape[1]], mesh.points, atol=1e-12)
        np.testing.assert_array_equal(found.cell_data["region"][0], mesh.region_of)
        for number, region in enumerate(mesh.regions):
            np.testing.assert_array_equal(found.cell_data[region.name][0], mesh.region_of == number)


def test_msh_has_named_physical_groups_that_gmsh_reads(meshes, tmp_path):
    import gmsh

    for mesh in meshes:
        path = write_mesh(mesh, tmp_path / "cell.msh")
        gmsh.initialize(interruptible=False)
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.open(str(path))
            dim = mesh.points.shape[1]
            groups = {gmsh.model.getPhysicalName(d, tag): tag for d, tag in gmsh.model.getPhysicalGroups(dim)}
            assert groups == {region.name: k + 1 for k, region in enumerate(mesh.regions)}
            counts = [
                sum(len(tags) for tags in gmsh.model.mesh.getElements(dim, entity)[1])
                for k in range(len(mesh.regions))
                for entity in gmsh.model.getEntitiesForPhysicalGroup(dim, k + 1)
            ]
            assert counts == np.bincount(mesh.region_of).tolist()
        finally:
            gmsh.finalize()


def mixed_cell():
    """A hexahedron, a pyramid on it and a tetrahedron beside that: the regions are a, b and c."""
    places = [
        (0, 0, 0),
        (1, 0, 0),
        (1, 1, 0),
        (0, 1, 0),
        (0, 0, 1),
        (1, 0, 1),
        (1, 1, 1),
        (0, 1, 1),
        (0.5, 0.5, 2),
        (2, 0.5, 2),
    ]
    blocks = (
        CellBlock("hexahedron", np.arange(8)[None], np.array([0])),
        CellBlock("pyramid", np.array([[4, 5, 6, 7, 8]]), np.array([1])),
        CellBlock("tetra", np.array([[5, 9, 6, 8]]), np.array([2])),
    )
    material = Material("x", 1.0, 0.3, 1.0)
    regions = tuple(Region(name, name, material, np.nan) for name in "abc")
    none = np.zeros(0, dtype=np.int64)
    return SweptCell(np.array(places, dtype=float), blocks, regions, 0.0, 2.0, none, none)


def read_cells(path):
    """meshio splits what was written by kind: the cells and data of each kind, in order."""
    found = meshio.read(path)
    return found, {block.type: k for k, block in enumerate(found.cells)}


@pytest.mark.parametrize("ending", [".vtu", ".msh"])
def test_a_cell_of_several_kinds_comes_back(ending, tmp_path):
    cell = mixed_cell()
    found, place = read_cells(write_mesh(cell, tmp_path / f"cell{ending}"))
    np.testing.assert_array_equal(found.points, cell.points)
    assert list(place) == ["hexahedron", "pyramid", "tetra"]
    for k, block in enumerate(cell.blocks):
        np.testing.assert_array_equal(found.cells[place[block.kind]].data, block.cells)
        tags = found.cell_data["region"][k] if ending == ".vtu" else found.cell_data["gmsh:physical"][k] - 1
        np.testing.assert_array_equal(tags, block.region_of)
    if ending == ".msh":
        assert {name: tuple(group) for name, group in found.field_data.items()} == {
            "a": (1, 3),
            "b": (2, 3),
            "c": (3, 3),
        }


def test_interfaces_are_written_as_named_surfaces(tmp_path):
    """Between hexahedron and pyramid a quadrilateral, between pyramid and tetrahedron a triangle."""
    cell = mixed_cell()
    found, place = read_cells(write_mesh(cell, tmp_path / "cell.msh", interfaces(cell)))
    assert tuple(found.field_data["a | b"]) == (4, 2) and tuple(found.field_data["b | c"]) == (5, 2)
    assert set(found.cells[place["quad"]].data[0]) == {4, 5, 6, 7}
    assert set(found.cells[place["triangle"]].data[0]) == {5, 6, 8}
    assert [found.cell_data["gmsh:physical"][place[k]].tolist() for k in ("quad", "triangle")] == [[4], [5]]
    found, place = read_cells(write_mesh(cell, tmp_path / "cell.vtu", interfaces(cell)))
    assert [found.cell_data["region"][place[k]].tolist() for k in ("hexahedron", "quad", "triangle")] == [
        [0],
        [-1],
        [-1],
    ]
    assert [found.cell_data["interface"][place[k]].tolist() for k in ("hexahedron", "quad", "triangle")] == [
        [-1],
        [0],
        [1],
    ]
    assert found.cell_data["b | c"][place["triangle"]].tolist() == [1]


def test_both_sides_of_a_parted_interface_are_written(tmp_path):
    cell = mixed_cell()
    parted = double_nodes(cell, interfaces(cell))
    found, place = read_cells(write_mesh(parted.mesh, tmp_path / "cell.msh", parted.pairs))
    assert set(found.field_data) == {"a", "b", "c", "a | b", "b | a", "b | c", "c | b"}
    here, there = found.cells[place["quad"]].data
    assert not set(here) & set(there)
    np.testing.assert_array_equal(found.points[here], found.points[there[::-1]])


def test_mesh_cannot_be_written(section, tmp_path):
    with pytest.raises(MeshError, match=r".vtu or .msh"):
        write_mesh(section, tmp_path / "cell.stl")
    (tmp_path / "file").write_text("")
    with pytest.raises(MeshError, match="cannot be written"):
        write_mesh(section, tmp_path / "file" / "cell.vtu")


@pytest.mark.parametrize("ending", [".brep", ".step"])
def test_solids_have_the_volume_of_pappus(cable, tmp_path, ending):
    """Section x length of the helix; OpenCASCADE's spline of 48 points a turn holds 5e-5."""
    path = tmp_path / f"cable{ending}"
    solids = write_solids(cable, path, 0.03, kinds=("conductor", "insulation", "sheath"))
    assert path.stat().st_size > 10_000
    assert len(solids) == 5 + 4 + 1
    for solid in solids:
        assert solid.volume == pytest.approx(solid.closed_form, rel=5e-5), solid.name
    part = cable.part("power core 1 insulation")
    closed = {s.name: s.closed_form for s in solids}[part.name]
    assert closed == pytest.approx(part.area * 0.03, rel=1e-9)


def test_solids_cannot_be_written(cable, tmp_path):
    with pytest.raises(GeometryError, match=r".step"):
        write_solids(cable, tmp_path / "cable.iges", 0.03)
    with pytest.raises(GeometryError, match="length"):
        write_solids(cable, tmp_path / "cable.step", -0.03)
    with pytest.raises(GeometryError, match="conductor, cover, insulation"):
        write_solids(cable, tmp_path / "cable.step", 0.03, kinds=("armour",))

"""What is written to a file can be read back: points, cells, region names and volumes."""

import meshio
import numpy as np
import pytest

from geometry import GeometryError, MeshError, cross_section_mesh, helical_slice, read_cable, write_mesh, write_solids


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

"""The mesh of the section: regions have their closed-form areas, share nodes, and lie on the exact curves."""

from pathlib import Path

import numpy as np
import pytest

from geometry import (
    CrossSectionMesh,
    MeshError,
    cable_files,
    cross_section_mesh,
    element_sizes,
    read_cable,
    region_sizes,
    scaled_jacobian,
)
from geometry.section_outline import section_outline

REFERENCE = "mcpt-1.9-3.3-3x35"
EXAMPLE = cable_files()["example-three-core"].read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def cable():
    return read_cable(REFERENCE)


@pytest.fixture(scope="module")
def mesh(cable) -> CrossSectionMesh:
    return cross_section_mesh(cable)


def area_errors(mesh):
    return region_sizes(mesh) / [region.closed_form_area for region in mesh.regions] - 1


def edges_of(mesh, corners):
    cells = mesh.cells[:, :corners]
    pairs = np.vstack([cells[:, [k, (k + 1) % corners]] for k in range(corners)])
    return np.sort(pairs, axis=1)


def test_every_region_has_its_area(mesh):
    """Closures move at most 0.4 % between layers (section_outline.py); everything else is exact to the curved elements."""
    errors = area_errors(mesh)
    assert np.abs(errors).max() < 5e-3
    for region, error in zip(mesh.regions, errors, strict=True):
        if region.kind in ("conductor", "insulation", "sheath"):
            assert abs(error) < 5e-5, region.name


def test_regions_are_the_parts(cable, mesh):
    assert [r.name for r in mesh.regions] == [p.name for p in cable.parts]
    assert set(mesh.region_of) == set(range(len(cable.parts)))
    assert mesh.twist_rate == cable.twist_rate


def test_regions_share_their_nodes(mesh):
    """No two nodes coincide; every edge belongs to two triangles, or to one on the outer circle only."""
    from scipy.spatial import KDTree

    assert len(KDTree(mesh.points).query_pairs(1e-9)) == 0
    edges, count = np.unique(edges_of(mesh, 3), axis=0, return_counts=True)
    assert set(count) == {1, 2}
    rim = np.unique(edges[count == 1])
    np.testing.assert_allclose(np.hypot(*mesh.points[rim].T), 0.0258, rtol=1e-9)
    assert (count == 1).sum() == len(rim)  # one closed polygon


def test_interface_nodes_lie_on_the_exact_traces(cable, mesh):
    """Corner and mid-side nodes between conductor and insulation satisfy the trace of the round wire to round-off."""
    for member in ("power core 2", "control core"):
        part = cable.part(f"{member} conductor")
        names = [r.name for r in mesh.regions]
        inside, outside = names.index(part.name), names.index(f"{member} insulation")
        shared = np.intersect1d(mesh.cells[mesh.region_of == inside], mesh.cells[mesh.region_of == outside])
        points = mesh.points[shared]
        nearest = part.outer_trace.point(part.outer_trace.nearest(points))
        assert len(shared) >= 36
        np.testing.assert_allclose(points, nearest, atol=1e-12)


def test_default_size_and_quality(mesh):
    """About 28 000 displacement unknowns with a smallest corner Jacobian above 0.1."""
    assert 15_000 < 3 * len(mesh.points) < 45_000
    assert scaled_jacobian(mesh).min() > 0.1
    assert element_sizes(mesh).min() > 0


@pytest.mark.parametrize("kind", ["triangle", "quad", "quad9"])
def test_other_elements(cable, kind):
    mesh = cross_section_mesh(cable, 3e-3, kind)
    assert mesh.cell_kind == kind
    assert scaled_jacobian(mesh).min() > (0.15 if kind.startswith("quad") else 0.1)
    assert np.abs(area_errors(mesh)).max() < 5e-3
    _edges, count = np.unique(edges_of(mesh, 3 if kind == "triangle" else 4), axis=0, return_counts=True)
    assert set(count) == {1, 2}


def test_area_of_polygons_converges_with_the_fourth_power_of_the_size(cable):
    """Inscribed polygons of n sides lose (2 pi / n)^2 / 6 of a circle; area-true ones only a term of the next even order."""
    lost = []
    for size in (2e-3, 1e-3):
        mesh = cross_section_mesh(cable, size, "triangle")
        lost.append(-area_errors(mesh)[[r.kind == "conductor" for r in mesh.regions]].mean())
    assert np.log2(lost[0] / lost[1]) == pytest.approx(4.0, abs=0.5)


def test_halving_the_size_refines_everywhere(cable):
    coarse, fine = (len(cross_section_mesh(cable, size, "triangle").cells) for size in (2e-3, 1e-3))
    assert 2.8 < fine / coarse < 5.0


def written(folder: Path, text: str):
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return read_cable(path)


THICK = """[cores.thick]
conductor = "core"
insulation_wall = { value = "1.3 mm", status = "computed", source = "test" }
insulation_material = "rubber insulation"

"""
VARIANTS = {
    "three touching cores": EXAMPLE,
    "other hand": EXAMPLE.replace('hand = "S"', 'hand = "Z"'),
    "two cores": EXAMPLE.replace('"core", "core", "core"', '"core", "core"'),
    "five cores": EXAMPLE.replace('"core", "core", "core"', '"core", "core", "core", "core", "core"').replace(
        '"90 mm"', '"130 mm"'
    ),
    "one core": EXAMPLE.replace('"core", "core", "core"', '"core"'),
    "straight": "\n".join(line for line in EXAMPLE.splitlines() if not line.startswith("lay = ")),
    "six round a centre": EXAMPLE.replace(
        "[lay-up]",
        '[conductors.middle]\nwires = { value = 120, status = "assumed", source = "test" }\n'
        'wire_diameter = { value = "0.35 mm", status = "computed", source = "test" }\n'
        'wire_density = { value = "8900 kg/m^3", status = "published", source = "copper" }\n'
        'fill = { value = 0.7, status = "computed", source = "test" }\n'
        'E = { value = "70 GPa", status = "computed", source = "test" }\nnu = { value = 0.34, status = "computed", source = "test" }\n\n'
        '[centre]\nconductor = "middle"\ncover_wall = { value = "0.5 mm", status = "computed", source = "test" }\n'
        'cover_material = "filler rubber"\n\n[lay-up]',
    )
    .replace('"core", "core", "core"', ", ".join(['"core"'] * 6))
    .replace('"90 mm"', '"140 mm"')
    .replace('"140 mm"]', '"160 mm"]'),
    "cores apart from each other": EXAMPLE.replace(
        "[lay-up]", '[lay-up]\npitch_circle_radius = { value = "4 mm", status = "computed", source = "test" }'
    ),
    "unequal cores": EXAMPLE.replace("[lay-up]", THICK + "[lay-up]").replace(
        '"core", "core", "core"', '"core", "thick", "core", "thick"'
    ),
    "no filler": EXAMPLE.replace('[interstices]\nmaterial = "filler rubber"', ""),
}


@pytest.mark.parametrize("variant", VARIANTS)
def test_other_cables(variant, tmp_path):
    """The same code meshes other lay-ups: areas, positive elements, one connected body."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    cable = written(tmp_path, VARIANTS[variant])
    mesh = cross_section_mesh(cable)
    assert np.abs(area_errors(mesh)).max() < 6e-3
    assert scaled_jacobian(mesh).min() > 0.05
    n = len(mesh.points)
    rows, columns = np.repeat(mesh.cells[:, :1], 5, axis=1).ravel(), mesh.cells[:, 1:].ravel()
    assert connected_components(coo_array((np.ones(len(rows)), (rows, columns)), shape=(n, n)), directed=False)[0] == 1


def test_closures_are_narrow_and_leave_four_pockets(cable):
    outline = section_outline(cable, neck_below=2e-3)
    assert len(outline.faces["interstices"]) == 4
    assert len([neck for neck in outline.necks if neck.gap < 1e-9]) == 8
    assert max(neck.closure for neck in outline.necks if neck.gap < 1e-9) < 0.06e-3


@pytest.mark.parametrize("size", [0.0, -1.0, np.nan, np.inf, 0.03, 1e-8])
def test_impossible_sizes(cable, size):
    with pytest.raises(MeshError, match="size"):
        cross_section_mesh(cable, size)


def test_unknown_kind(cable):
    with pytest.raises(MeshError, match="triangle6"):
        cross_section_mesh(cable, kind="tet")


def test_a_layer_too_thin_to_be_meshed_is_named(tmp_path):
    with pytest.raises(MeshError, match=r"sheath is 1e-05 mm thick.*at least"):
        cross_section_mesh(written(tmp_path, EXAMPLE.replace('"1.6 mm"', '"10 nm"').replace('"1.2 mm"', '"1 nm"')))

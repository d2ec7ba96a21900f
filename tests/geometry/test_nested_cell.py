"""The cell of a cable with strands: conforming, matched end faces, exact double helices, volumes of the closed form, mirror symmetry.

The face count is the law of a mesh without gap, overlap or hanging diagonal: every face, by its nodes, belongs to two cells or lies
on the true boundary. Volumes follow Pappus: pi rho^2 times the arc length of the double helix.
"""

import numpy as np
import pytest

from geometry import Helix, MeshError, nested_helix, read_cable
from geometry.cable_file import cable_files
from geometry.common_period import cell_of
from geometry.helical_slice import helical_slice
from geometry.mesh_quality import block_quality, region_sizes
from geometry.nested_cell import nested_cell
from geometry.nested_plan import plan_of_cell
from geometry.section_mesh import cross_section_mesh
from geometry.turning_conductor import own_turn_rate

FACES = {
    "hexahedron": [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]],
    "pyramid": [[0, 3, 2, 1], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
    "tetra": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
}
STRANDS = """
[strands.small]
wire_diameter = { value = "0.30 mm", status = "assumed", range = ["0.25 mm", "0.31 mm"], source = "test" }
layers = { value = [1, 6], status = "assumed", source = "test" }
hand = "Z"
wire_density = { value = "8900 kg/m^3", status = "published", source = "copper" }
E = { value = "80 GPa", status = "assumed", range = ["70 GPa", "90 GPa"], source = "test" }
nu = { value = 0.34, status = "assumed", range = [0.30, 0.36], source = "solid copper" }

[conductors.core]
strand = "small"
layers = { value = LAYERS, status = "assumed", source = "test" }
lay = { value = "40 mm", status = "assumed", range = ["30 mm", "50 mm"], source = "test" }
hand = "HAND"

"""


@pytest.fixture(scope="module")
def stranded(tmp_path_factory):
    """Maker of small cables: the three-core example with stranded conductors, cabling hand and strand hand given."""
    folder = tmp_path_factory.mktemp("cables")
    text = cable_files()["example-three-core"].read_text(encoding="utf-8")

    def make(cabling="S", hand="Z", layers="[1, 6]"):
        head, rest = text.split("[conductors.core]")
        rest = rest[rest.index("[cores.core]") :].replace('hand = "S"', f'hand = "{cabling}"')
        path = folder / f"{cabling}{hand}{len(layers)}.toml"
        path.write_text(head + STRANDS.replace("HAND", hand).replace("LAYERS", layers) + rest, encoding="utf-8")
        return read_cable(path)

    return make


@pytest.fixture(scope="module")
def cable(stranded):
    return stranded()


@pytest.fixture(scope="module")
def cell(cable):
    return nested_cell(cable, size=0.8e-3)


def count_faces(mesh):
    """Faces (m, 4) of all cells by sorted nodes, triangles with -1 in front, and how often each occurs."""
    found = []
    for block in mesh.blocks:
        for face in FACES[block.kind]:
            nodes = np.sort(block.cells[:, face], axis=1)
            found.append(np.pad(nodes, ((0, 0), (4 - len(face), 0)), constant_values=-1))
    return np.unique(np.concatenate(found), axis=0, return_counts=True)


def test_every_face_is_shared_or_on_the_boundary(cable, cell):
    """Faces that occur once are quadrilaterals on the outer surface, on an end face, or beside a void between the strands."""
    faces, counts = count_faces(cell)
    assert counts.max() == 2
    once = faces[counts == 1]
    assert once.min() >= 0
    z = cell.points[once][..., 2]
    end = (np.abs(z) < 1e-12).all(1) | (np.abs(z - cell.height) < 1e-12).all(1)
    radius = np.hypot(cell.points[once][..., 0], cell.points[once][..., 1])
    outer = (radius > 0.99 * cable.outer_radius).all(1)
    angle = cable.twist_rate * z
    inside = np.zeros(len(once), dtype=bool)
    for part in cable.parts:
        if part.kind == "conductor":
            x = cell.points[once][..., 0] - part.centre_radius * np.cos(part.phase + angle)
            y = cell.points[once][..., 1] - part.centre_radius * np.sin(part.phase + angle)
            inside |= (np.hypot(x, y) < 1.02 * part.outer_radius / np.cos(part.lay_angle)).all(1)
    assert (end | outer | inside).all()
    assert end.any() and outer.any() and inside.any()


def test_a_hanging_diagonal_is_seen(cell):
    """The count above can fail: one tetrahedron turned to the other diagonal leaves faces without partner."""
    block = next(b for b in cell.blocks if b.kind == "tetra")
    block.cells[0, :3], kept = np.roll(cell.blocks[0].cells[0, :3], 1), block.cells[0, :3].copy()
    faces, counts = count_faces(cell)
    block.cells[0, :3] = kept
    assert (faces[counts == 1].min(axis=1) < 0).any()


def test_the_boundary_of_all_cells_is_closed(cell):
    """Each edge of the boundary faces is walked an even number of times: no hole, no flap."""
    faces, counts = count_faces(cell)
    once = np.sort(faces[counts == 1], axis=1)
    oriented = np.concatenate([b.cells[:, face] for b in cell.blocks for face in FACES[b.kind] if len(face) == 4])
    key = {tuple(f) for f in once.tolist()}
    kept = np.array([f for f in oriented.tolist() if tuple(sorted(f)) in key])
    walks = np.concatenate([kept[:, [k, (k + 1) % 4]] for k in range(4)])
    forward, number = np.unique(walks, axis=0, return_counts=True)
    backward, again = np.unique(walks[:, ::-1], axis=0, return_counts=True)
    np.testing.assert_array_equal(forward, backward)
    np.testing.assert_array_equal(number, again)


def test_end_faces_match(cell):
    """Under the cell's motion, all of them, each once; strands go over into other strands of their conductor."""
    assert cell.matching_gap() < 1e-12
    for nodes, z in ((cell.bottom, 0.0), (cell.top, cell.height)):
        at_end = np.flatnonzero(np.abs(cell.points[:, 2] - z) < 1e-12)
        np.testing.assert_array_equal(np.sort(nodes), at_end)
    hexahedra = cell.blocks[0]
    image = np.full(len(cell.points), -1)
    image[cell.bottom] = cell.top
    bottom = hexahedra.cells[(np.abs(cell.points[hexahedra.cells[:, :4], 2]) < 1e-12).all(1)][:, :4]
    top = hexahedra.cells[(np.abs(cell.points[hexahedra.cells[:, 4:], 2] - cell.height) < 1e-12).all(1)][:, 4:]
    assert {frozenset(f) for f in image[bottom].tolist()} == {frozenset(f) for f in top.tolist()}


def test_elements_are_not_inside_out(cell):
    for block in cell.blocks:
        assert block_quality(cell.points, block.cells, block.kind).min() > 0.05


def test_volumes_are_those_of_the_closed_form(cable, cell):
    """Within 0.5 %; on halving the layers what the twist of a layer takes away falls with its square."""
    ratio = region_sizes(cell) / (cell.height * np.array([r.closed_form_area for r in cell.regions]))
    assert np.abs(ratio - 1).max() < 5e-3
    strand = np.array([r.kind == "strand" for r in cell.regions])
    lost = []
    for layers in (24, 48, 96):
        mesh = nested_cell(cable, size=0.8e-3, layers=layers)
        lost.append(region_sizes(mesh)[strand].sum() / mesh.height)
    order = np.log2((lost[1] - lost[0]) / (lost[2] - lost[1]))
    assert order == pytest.approx(2.0, abs=0.1)
    exact = sum(r.closed_form_area for r in cell.regions if r.kind == "strand")
    assert lost[2] + (lost[2] - lost[1]) / 3 == pytest.approx(exact, rel=2e-4)


def test_total_volume_is_that_of_the_cable(cable, cell):
    """All regions and the voids fill the cylinder: the voids are the circle of each conductor less its strands."""
    voids = sum(part.area for part in cable.parts if part.kind == "conductor")
    voids -= sum(r.closed_form_area for r in cell.regions if r.kind == "strand")
    assert region_sizes(cell).sum() / cell.height + voids == pytest.approx(cable.area, rel=1e-3)


def test_opposite_hands_have_equal_volumes(stranded, cable, cell):
    """S and Z: same period, same closed forms, same strands; the rubber's planar mesh may differ."""
    mirrored = nested_cell(stranded("Z", "S"), size=0.8e-3)
    assert mirrored.height == pytest.approx(cell.height, rel=1e-12)
    assert mirrored.twist_rate == -cell.twist_rate
    areas, others = (np.array([r.closed_form_area for r in m.regions]) for m in (cell, mirrored))
    strand = np.array([r.kind == "strand" for r in cell.regions])
    # strands in a mirror are counted the other way round, so that only sorted volumes compare
    np.testing.assert_allclose(np.sort(areas[strand]), np.sort(others[strand]), rtol=1e-9)
    a, b = region_sizes(cell), region_sizes(mirrored)
    np.testing.assert_allclose(np.sort(a[strand]), np.sort(b[strand]), rtol=1e-6)
    np.testing.assert_allclose(a[~strand], b[~strand], rtol=3e-3)


def test_one_hand_is_not_the_other(stranded, cell):
    """Strands of the hand of the cabling turn less against their core than those of the other hand: another period."""
    assert nested_cell(stranded("S", "S"), size=0.8e-3, lay_tolerance=0.05).height != pytest.approx(
        cell.height, rel=1e-3
    )


def test_strands_lie_on_exact_double_helices(cable):
    """Nodes on the surface of a strand keep the distance rho from the double helix, but for the flats at contacts (inside) and
    the move that makes the area true (outside); both fall with the square of the size."""
    worst = []
    for size in (0.8e-3, 0.4e-3):
        plan = plan_of_cell(cable, None, size, None, 60, None, None)
        conductor = plan.conductors[0]
        part, rate = conductor.part, conductor.turn_rate
        own = own_turn_rate(part, rate)
        place = conductor.section.strands[3]
        z = np.linspace(-0.003, plan.height + 0.003, 4001)
        core = Helix(part.centre_radius, cable.lay, cable.hand, part.phase)
        start = place.phase + np.pi + own * z[0] / np.cos(core.lay_angle)  # e1 points to the axis at z = 0
        hand = "Z" if own > 0 else "S"
        line = nested_helix([core, Helix(place.centre_radius, 2 * np.pi / abs(own), hand, start)], z).points
        cells = conductor.section.cells[conductor.section.strand_of == 3]
        edges = np.sort(cells[:, [0, 1, 1, 2, 2, 3, 3, 0]].reshape(-1, 2), axis=1)
        edges, count = np.unique(edges, axis=0, return_counts=True)
        surface = conductor.nodes(np.linspace(0, plan.height, 4))[:, np.unique(edges[count == 1])].reshape(-1, 3)
        distance = np.sqrt(((surface[:, None] - line[None]) ** 2).sum(-1).min(1))
        rho = place.radius
        worst.append(((rho - distance).max() / rho, (distance - rho).max() / rho))
    coarse, fine = np.array(worst)
    assert (coarse < [0.05, 0.10]).all()
    assert (fine < 0.3 * coarse).all()


def test_closed_form_areas_are_the_arc_lengths_of_double_helices(cable, cell):
    """Sum over the strands of a conductor, whose ends follow on each other, of pi rho^2 times the length by quadrature."""
    part = next(p for p in cable.parts if p.kind == "conductor")
    plan = plan_of_cell(cable, None, 0.8e-3, None, 60, None, None)
    own = own_turn_rate(part, plan.conductors[0].turn_rate)
    rho = plan.conductors[0].section.strands[0].radius
    core = Helix(part.centre_radius, cable.lay, cable.hand, part.phase)
    period = 2 * np.pi / abs(plan.conductors[0].turn_rate)
    levels = [core, Helix(2 * rho, 2 * np.pi / abs(own), "Z" if own > 0 else "S")]
    line = nested_helix(levels, np.linspace(0, period, 400))
    expected = np.pi * rho**2 * (6 * line.s[-1] / period + 1 / np.cos(core.lay_angle))
    areas = [r.closed_form_area for r in cell.regions if r.name.startswith("core 1 strand")]
    assert len(areas) == 7
    assert sum(areas) == pytest.approx(expected, rel=1e-6)


def test_as_many_hexahedra_as_are_asked_for(cable):
    cell = nested_cell(cable, elements=60_000)
    assert 60_000 <= cell.count("hexahedron") < 90_000


def test_straight_strands_in_three(stranded):
    """Three strands in the conductor, fold 3: regions, partners and volumes as for 1 + 6."""
    cable = stranded(layers="[3]")
    cell = nested_cell(cable, size=0.8e-3)
    assert sum(r.kind == "strand" for r in cell.regions) == 9
    assert cell.matching_gap() < 1e-12
    ratio = region_sizes(cell) / (cell.height * np.array([r.closed_form_area for r in cell.regions]))
    assert np.abs(ratio - 1).max() < 5e-3


def test_a_strand_weighs_what_it_weighs(cable, cell):
    """Mass of all strands per length of cable as of the conductors as cylinders, but for the adjusted lay."""
    mass = sum(r.material.density * r.closed_form_area for r in cell.regions if r.kind == "strand")
    whole = sum(p.mass_per_length for p in cable.parts if p.kind == "conductor")
    assert mass == pytest.approx(whole, rel=5e-3)


def test_without_strands_it_is_the_slice():
    """Hexahedra, volumes and motion of the helical slice of the same section."""
    cable = read_cable("example-three-core")
    cell = nested_cell(cable, size=1e-3, layers=12)
    plain = helical_slice(cross_section_mesh(cable, 1e-3, "quad"), cell.height, 12)
    assert [b.kind for b in cell.blocks] == ["hexahedron"]
    np.testing.assert_allclose(region_sizes(cell), region_sizes(plain), rtol=1e-12)
    assert cell.matching_gap() < 1e-12


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"height": 0.05}, "common period of its lays"),
        ({"height": -1.0}, "positive length"),
        ({"elements": 0}, "whole number"),
        ({"elements": 10**9}, "GB of memory"),
        ({"elements": 2.5}, "whole number"),
        ({"size": 0.0}, "positive length"),
        ({"size": 1e-6}, "GB of memory"),
        ({"layers": 2}, "too few for the turning"),
        ({"layers": 40, "size": 0.8e-3, "elements": 10**6}, "leave out the size"),
    ],
)
def test_bad_input_is_one_sentence(cable, arguments, message):
    with pytest.raises(MeshError, match=message) as error:
        nested_cell(cable, **arguments)
    assert "\n" not in str(error.value)


def test_the_period_may_be_repeated(cable, cell):
    period = cell_of(cable)
    assert period is not None
    twice = nested_cell(cable, size=0.8e-3, height=2 * period.height)
    assert twice.height == pytest.approx(2 * cell.height, rel=1e-12)
    assert twice.matching_gap() < 1e-12

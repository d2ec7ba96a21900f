"""Which parts slide: names, copies of nodes where parts meet, free motions and what is refused."""

import dataclasses

import numpy as np
import pytest
from four_conductor_section import four_conductor_section
from section_meshes import rings
from wire_in_rod import three_sectors, wire_in_rod

from geometry.errors import MeshError, SpecError
from homogenize import solve_helical_cell
from homogenize.coulomb_interface import Coulomb
from homogenize.doubled_nodes import doubled_nodes
from homogenize.elastic_interface import Elastic
from homogenize.interface_choice import Interfaces, sides
from homogenize.section_field import section_field
from homogenize.section_system import section_system
from homogenize.sliding_interface import Frictionless

FREE = Frictionless()


@pytest.fixture(scope="module")
def cable(tmp_path_factory):
    return four_conductor_section(tmp_path_factory.mktemp("section"), size=6e-3)


def named_pairs(mesh, name):
    law_of = Interfaces({name: FREE}).separated(mesh)
    return {frozenset((mesh.regions[a].name, mesh.regions[b].name)) for a, b in np.argwhere(law_of >= 0)}


def copies_at(mesh, doubled, point):
    return int((np.hypot(*(doubled.nodes - np.array(point)[:, None])) < 1e-9 * np.abs(mesh.points).max()).sum())


def test_names_select_the_pairs_that_touch(cable):
    """conductor-insulation takes the bare centre too; core-filler parts no core inside; members can be named one by one."""
    conductors = named_pairs(cable, "conductor-insulation")
    assert len(conductors) == 5 and frozenset(("earth conductor", "earth cover")) in conductors
    cores = named_pairs(cable, "core-filler")
    assert all(len({n.removesuffix(" insulation") for n in pair}) == 2 for pair in cores)
    assert not any(name.endswith("conductor") for pair in cores for name in pair)
    assert named_pairs(cable, "control core-interstices") < cores
    assert sides(cable)["core"].sum() == 8 and sides(cable)["centre"].sum() == 2


def test_every_part_at_a_point_has_its_own_copy():
    """Three sectors on the axis: three copies there; a cut that ends on a bonded sheath has one copy at its end, two along it."""
    mesh = three_sectors()
    field = section_field(mesh)
    cuts = Interfaces({"one-two": FREE, "two-three": FREE, "three-one": FREE})
    all_apart = Interfaces({**cuts.laws, "sheath-surroundings": FREE})
    tip, end = (0.0, 0.0), (np.cos(2 * np.pi / 3), np.sin(2 * np.pi / 3))
    doubled = doubled_nodes(field, cuts.separated(mesh))
    assert copies_at(mesh, doubled, tip) == 3 and copies_at(mesh, doubled, end) == 1
    assert copies_at(mesh, doubled, (end[0] / 2, end[1] / 2)) == 2
    doubled = doubled_nodes(field, all_apart.separated(mesh))
    assert copies_at(mesh, doubled, tip) == 3 and copies_at(mesh, doubled, end) == 3
    assert len(doubled.child) == doubled.nodes.shape[1] - field.nodes.shape[1]


def test_surfaces_add_up_to_the_interface():
    """The nodes' surfaces sum to the wire's perimeter 2 pi a per length of wire, 1 / cos(lay angle) per length of cable."""
    beta = np.radians(30.0)
    mesh = wire_in_rod(beta=beta, around=24)
    doubled = doubled_nodes(section_field(mesh), Interfaces({"conductor-insulation": FREE}).separated(mesh))
    assert doubled.surface.sum() == pytest.approx(2 * np.pi * 0.5 / np.cos(beta), rel=1e-4)
    assert (doubled.surface > 0).all()
    X, Y = doubled.nodes[:, doubled.child]
    helix = np.stack([-mesh.twist_rate * Y, mesh.twist_rate * X, np.ones_like(X)])
    assert np.abs((doubled.frame[0] * helix).sum(axis=0)).max() < 1e-12


def test_free_motions_are_named():
    """A laid wire slides along its helix; a straight one also turns; a centred one turns about the axis; a stiff interface stops all."""
    loose = Interfaces({"conductor-insulation": FREE})
    assert section_system(wire_in_rod(), loose).free_motions == ("wire conductor slides along its helix",)
    straight = section_system(wire_in_rod(straight=True), loose).free_motions
    assert straight == ("wire conductor slides along the cable", "wire conductor turns about its axis")
    centred = rings((0.5, 1.0), (1.0, 0.3), (1.0, 0.3), twist_rate=0.5)
    centred = dataclasses.replace(
        centred, regions=(centred.regions[0], dataclasses.replace(centred.regions[1], kind="sheath"))
    )
    sentences = solve_helical_cell(centred, loose).free_motions
    assert sentences == ("part 0 slides along the cable", "part 0 turns about the cable axis")
    assert section_system(wire_in_rod(), Interfaces({"conductor-insulation": Elastic(1e-3)})).free_motions == ()


def test_a_separated_mesh_of_one_material_still_balances():
    """Sectors and sheath all free: the cell solves, is softer than the bonded one, and the pins carry nothing."""
    mesh = three_sectors()
    cuts = Interfaces({"one-two": FREE, "two-three": FREE, "three-one": FREE, "sheath-surroundings": FREE})
    cell, bonded = solve_helical_cell(mesh, cuts), solve_helical_cell(mesh)
    assert cell.stiffness.GJ < bonded.stiffness.GJ and cell.stiffness.EI_x < bonded.stiffness.EI_x
    assert cell.reaction < 1e-8


def test_what_cannot_slide_is_refused(cable):
    mesh = wire_in_rod()
    with pytest.raises(MeshError, match='no part is "armour"'):
        Interfaces({"core-armour": FREE}).separated(cable)
    with pytest.raises(
        MeshError, match="names parts that do not touch: conductor touches cover, insulation, not sheath"
    ):
        Interfaces({"conductor-sheath": FREE}).separated(cable)
    with pytest.raises(MeshError, match="give them one law"):
        Interfaces({"conductor-insulation": FREE, "wire-filler": Elastic(1.0)}).separated(mesh)
    with pytest.raises(SpecError, match="depends on the history"):
        solve_helical_cell(mesh, Interfaces({"conductor-insulation": Coulomb(0.3)}))
    with pytest.raises(SpecError, match="no interface is named"):
        Interfaces({})


def test_a_part_that_touches_nothing_is_named():
    """A floating core: the tube keeps its nodes, the core has copies of its own that nothing holds."""
    mesh = rings((0.5, 1.0), (1.0, 0.3), (1.0, 0.3))
    inner = mesh.region_of == 0
    cells = mesh.cells.copy()
    shared = np.intersect1d(cells[inner], cells[~inner])
    number = np.arange(len(mesh.points))
    number[shared] = len(mesh.points) + np.arange(len(shared))
    cells[inner] = number[cells[inner]]
    loose = dataclasses.replace(mesh, points=np.concatenate([mesh.points, mesh.points[shared]]), cells=cells)
    with pytest.raises(MeshError, match=r"part 0 touches no other part .* can move freely"):
        solve_helical_cell(loose)

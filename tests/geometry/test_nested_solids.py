"""Solids of strands: pipes along double helices have the volume of Pappus, lie where the strands lie, and do not cut."""

import numpy as np
import pytest
from scipy.integrate import quad

from geometry import GeometryError, read_cable, write_solids
from geometry.gmsh_session import gmsh_session
from geometry.laid_member import laid_members, strands, whole_member, wires
from geometry.pipe_trace import pipe_trace, section_traces


@pytest.fixture(scope="module")
def cable():
    return read_cable("mcpt-1.9-3.3-3x35")


@pytest.fixture(scope="module")
def power(cable):
    part = cable.part("power core 2 conductor")
    return strands(part, cable.conductors["power"])


def test_length_of_a_double_helix_in_closed_form(power):
    """Integral of sqrt((1 + r kappa cos phi)^2 + (2 pi r / p)^2) over the core; 96 steps a turn hold 1e-9."""
    for number in (0, 1, 4):
        core, rope = power[number].levels
        rate = rope.turn_rate - core.torsion

        def speed(s, core=core, rope=rope, rate=rate):
            phi = rate * s + rope.phase - np.pi
            return np.hypot(1 + rope.radius * core.curvature * np.cos(phi), 2 * np.pi * rope.radius / rope.pitch)

        exact = quad(speed, 0, core.length(0.1), epsabs=0, epsrel=1e-12, limit=200)[0]
        assert power[number].length(0.1) == pytest.approx(exact, rel=1e-9)


def test_strands_stand_at_equal_angles_from_the_outward_direction(power):
    """At z = 0 strand i of 6 is seen from the core's centre at 2 pi i / 6, in the plane normal to the core."""
    for i, member in enumerate(power[1:]):
        core, rope = member.levels
        _, inward, binormal = core.frenet_frame(0.0)
        offset = member.centre_line(np.array([0.0, 0.01])).points[0] - core.position(0.0)
        angle = 2 * np.pi * i / 6
        np.testing.assert_allclose(
            offset, -rope.radius * (np.cos(angle) * inward + np.sin(angle) * binormal), atol=1e-15
        )


def test_strands_and_wires_do_not_depend_on_where_the_piece_begins(cable, power):
    wire = wires(power[3], cable.conductors["power"].strand)[20]
    whole = wire.centre_line(np.linspace(-0.02, 0.06, 9))
    piece = wire.centre_line(np.linspace(0.03, 0.06, 4))
    np.testing.assert_allclose(piece.points, whole.points[5:], atol=1e-9)
    whole = power[3].centre_line(np.linspace(-0.02, 0.06, 9))
    piece = power[3].centre_line(np.linspace(0.03, 0.06, 4))
    np.testing.assert_allclose(piece.points, whole.points[5:], atol=1e-12)
    np.testing.assert_allclose(piece.frames, whole.frames[5:], atol=1e-6)


def test_volume_of_every_strand_and_part(cable, tmp_path):
    """OpenCASCADE's volume against section x exact length, within 1e-4; stranded conductors are replaced by their strands."""
    solids = write_solids(cable, tmp_path / "cable.brep", 0.04, level="strand")
    names = [s.name for s in solids]
    assert sum("strand" in name for name in names) == 3 * 7 + 3
    assert "power core 1 conductor" not in names and "control core conductor" in names
    for solid in solids:
        assert solid.volume == pytest.approx(solid.closed_form, rel=1e-4), solid.name
    for part in cable.parts:
        if part.name in names:
            assert whole_member(part).volume(0.04) == pytest.approx(part.area * 0.04, rel=1e-9)


def test_layers_of_wires_keep_their_own_lay(tmp_path):
    """Wires of the sea cable: volume by their own lay angle; S and Z wires in one file."""
    cable = read_cable("sea-three-core")
    solids = write_solids(cable, tmp_path / "sea.brep", 0.02, kinds=("armour",))
    assert len(solids) == 55 + 63
    for solid in (solids[0], solids[-1]):
        part = cable.part(solid.name)
        assert solid.closed_form == pytest.approx(np.pi * 4e-6 * 0.02 / np.cos(part.lay_angle), rel=1e-9)
        assert solid.volume == pytest.approx(solid.closed_form, rel=1e-5)
    assert solids[0].closed_form != pytest.approx(solids[-1].closed_form, rel=1e-4)


def test_solids_in_the_file_clear_each_other(cable, tmp_path):
    """OpenCASCADE finds no common volume of neighbouring cores (gap 0.286 mm), and one of neighbouring strands (-0.026 mm)."""
    write_solids(cable, tmp_path / "cable.brep", 0.02, kinds=("screen",))
    write_solids(cable, tmp_path / "strands.brep", 0.02, kinds=("conductor",), level="strand")
    with gmsh_session("common") as gmsh:
        screens = gmsh.model.occ.importShapes(str(tmp_path / "cable.brep"))
        assert len(screens) == 4
        assert gmsh.model.occ.intersect(screens[:1], screens[1:2])[0] == []
    with gmsh_session("cut") as gmsh:
        found = gmsh.model.occ.importShapes(str(tmp_path / "strands.brep"))
        gmsh.model.occ.synchronize()
        for tag, member in zip(
            found, laid_members(cable, "strand", ("conductor",)), strict=True
        ):  # copies are in place
            middle = 1e3 * member.centre_line(np.linspace(0, 0.02, 41)).points.mean(0)
            np.testing.assert_allclose(gmsh.model.occ.getCenterOfMass(*tag), middle, atol=0.05, err_msg=member.name)
        second, third = found[4], found[5]  # three of the earth, then the middle one
        common = [tag for dim, tag in gmsh.model.occ.intersect([second], [third])[0] if dim == 3]
        volume = sum(gmsh.model.occ.getMass(3, tag) for tag in common)
        depth, r, length = 0.0255, 1.508, 20 / np.cos(np.radians(17.3)) / np.cos(np.radians(8.5))
        lens = (
            2 / 3 * depth * np.sqrt(2 * r * depth / 2) * 2 * 0.5 * 2
        )  # two segments of height depth / 2: 4/3 h sqrt(2 r h)
        assert volume == pytest.approx(lens * length, rel=0.15)


def test_trace_of_a_pipe_is_that_of_a_round_wire(cable, power):
    """One level: the closed form of the round wire; the area is pi rho^2 / cos beta. The curve is rho from the centre line."""
    part = cable.part("power core 3 insulation")
    points = pipe_trace(whole_member(part), np.linspace(0, 2 * np.pi, 400, endpoint=False))
    near = part.outer_trace.point(part.outer_trace.nearest(points[::40]))
    np.testing.assert_allclose(near, points[::40], atol=1e-9)
    member = power[2]
    curve = pipe_trace(member, np.linspace(0, 2 * np.pi, 12))
    line = member.centre_line(np.linspace(-0.004, 0.004, 4001)).points
    distance = np.linalg.norm(np.append(curve, np.zeros((12, 1)), axis=1)[:, None] - line, axis=2).min(1)
    np.testing.assert_allclose(distance, member.outer_radius, rtol=1e-6)


def test_traces_of_a_section_hold_every_strand_and_wire(cable):
    """Areas of the drawn polygons: parts in closed form, wires' metal within the lay factor; alike cores are turned copies."""
    traces = section_traces(cable, "wire", samples=240)
    for trace in traces:
        if trace.level == "part":
            assert trace.area == pytest.approx(cable.part(trace.name).area, rel=1e-3), trace.name
    drawn = [t for t in traces if t.name.startswith("power core 3 conductor strand")]
    assert [sum(t.level == level for t in drawn) for level in ("strand", "wire")] == [7, 7 * 27]
    metal = sum(t.area for t in drawn if t.level == "wire")
    conductor = cable.conductors["power"]
    steepest = np.cos(cable.lay_angle + conductor.strand_lay_angle)
    assert conductor.metal_area / np.cos(cable.lay_angle) * 0.98 < metal < conductor.metal_area / steepest * 1.02
    for strand in (t for t in drawn if t.level == "strand"):
        inside = [t for t in drawn if t.level == "wire" and t.name.startswith(strand.name + " ")]
        centre = strand.points.mean(0)
        assert max(np.linalg.norm(t.points - centre, axis=1).max() for t in inside) < 1.12 * 1.508e-3


def test_solids_of_an_unknown_level_or_endless_length(cable, tmp_path):
    with pytest.raises(GeometryError, match=r'"conductor" or "strand"'):
        write_solids(cable, tmp_path / "cable.step", 0.03, level="wire")
    with pytest.raises(GeometryError, match=r"choose at most \d"):
        write_solids(cable, tmp_path / "cable.step", 1e4, level="strand")
    assert len(laid_members(cable, "strand", ("conductor",))) == 25
    strand = cable.conductors["earth"].strand
    assert len(wires(laid_members(cable, "strand")[0], strand)) == 27

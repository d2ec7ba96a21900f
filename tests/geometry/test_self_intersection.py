"""Round members clear by the distance of their centre lines minus their radii; what does not clear is named before it is swept."""

from dataclasses import replace

import numpy as np
import pytest

from geometry import GeometryError, Helix, builtin_cables, nested_helix, read_cable, write_solids
from geometry.clearance import helix_distance
from geometry.laid_member import laid_members, strands
from geometry.self_intersection import centre_distance, check_self_intersection, self_intersections


@pytest.fixture(scope="module")
def cable():
    return read_cable("mcpt-1.9-3.3-3x35")


def with_parts(cable, change):
    """The cable with parts changed by name: {beginning of the name: fields}."""
    parts = [next((replace(p, **f) for n, f in change.items() if p.name.startswith(n)), p) for p in cable.parts]
    return replace(cable, parts=tuple(parts))


@pytest.mark.parametrize(
    ("lay", "r1", "r2", "angle"), [(0.234, 0.0116, 0.0116, 1.57), (0.06, 0.01, 0.01, 1.0), (0.1, 0.008, 0.003, 0.4)]
)
def test_sampled_distance_is_the_exact_one(lay, r1, r2, angle):
    """Helices of one lay: the minimum over the shift along the lay, to the fourth order of 1/96 of a turn."""
    z = np.linspace(0, 2 * lay, 200)
    a, b = (nested_helix([Helix(r, lay, "S", turn)], z) for r, turn in ((r1, 0.0), (r2, angle)))
    assert centre_distance(a, b) == pytest.approx(helix_distance(r1, r2, angle, lay), rel=1e-7)


def test_touching_helices_have_no_gap(cable):
    """Cores as thick as the distance of their centre lines touch: no overlap; 2 micrometres more is one of 2 micrometres."""
    core = cable.part("power core 1 screen")
    distance = helix_distance(core.centre_radius, core.centre_radius, np.pi / 2, cable.lay)
    wrap = {"wrap": {"inner_radius": 0.02, "outer_radius": 0.0201}, "sheath": {"inner_radius": 0.0201}}
    cover = {"earth cover": {"outer_radius": 3.5e-3}}
    for extra, depth in ((0.0, None), (1e-6, 2e-6)):
        screens = {p.name: {"outer_radius": distance / 2 + extra} for p in cable.parts if p.kind == "screen"}
        found = self_intersections(with_parts(cable, screens | wrap | cover), level="conductor")
        assert [o.depth for o in found] == ([] if depth is None else [pytest.approx(depth, rel=1e-3)] * 1)


def test_reference_cores_clear_by_286_micrometres(cable):
    """16.036 mm between centre lines, 15.75 mm thick."""
    lines = [m.centre_line(m.stations(0, 0.234)) for m in laid_members(cable, kinds=("screen",))[:2]]
    assert centre_distance(*lines) - 15.75e-3 == pytest.approx(0.286e-3, abs=1e-6)
    assert self_intersections(cable, level="conductor") == []


def test_six_strands_round_one_cut_their_neighbours(cable):
    """3.016 mm strands at lay 127 mm: 0.0250 mm on a straight conductor, about as much on the laid core; only a note."""
    part = cable.part("power core 1 conductor")
    straight = with_parts(cable, {part.name: {"centre_radius": 0.0, "twist_rate": 0.0}})
    members = strands(straight.part(part.name), cable.conductors["power"])
    rope = members[-1].levels[-1]
    exact = 2 * members[-1].outer_radius - helix_distance(rope.radius, rope.radius, np.pi / 3, rope.pitch)
    assert exact == pytest.approx(0.0250e-3, abs=1e-7)
    lines = [m.centre_line(m.stations(0, 0.127)) for m in members[1:3]]
    assert 2 * members[-1].outer_radius - centre_distance(*lines) == pytest.approx(exact, abs=1e-9)
    (note,) = check_self_intersection(cable)
    assert note.depth == pytest.approx(exact, rel=0.06) and not note.severe
    assert "0.026 mm" in note.sentence and "flattened" in note.sentence


def test_strands_round_the_middle_one_touch_it(cable):
    """The middle strand lies r from all others along any lay: the gap is zero on the bent conductor too."""
    part = cable.part("power core 2 conductor")
    members = strands(part, cable.conductors["power"])
    lines = [m.centre_line(members[-1].stations(0, 0.1)) for m in members]
    for line in lines[1:]:
        assert centre_distance(lines[0], line) == pytest.approx(2 * members[0].outer_radius, rel=1e-9)


def test_thick_strands_are_refused(cable):
    """Strands that overlap by more than 2 % of their diameter are no round strands that were flattened."""
    power = cable.conductors["power"]
    tight = replace(power, lay=power.lay / 3)
    broken = replace(cable, conductors=dict(cable.conductors) | {"power": tight})
    with pytest.raises(GeometryError, match=r"power core 1 conductor strand 2\.\d and .* overlap by 0\.2\d\d mm"):
        check_self_intersection(broken)


def test_layers_of_opposite_hand_cross(cable):
    """The distance of the centre lines is the difference of the radii, whatever the lays."""
    sea = read_cable("sea-three-core")
    outer = next(p for p in sea.parts if p.layer == "outer armour")
    moved = {p.name: {"centre_radius": outer.centre_radius - 3.9e-3} for p in sea.parts if p.layer == "inner armour"}
    found = self_intersections(with_parts(sea, moved))
    (crossing,) = [o for o in found if {o.first, o.second} <= {p.name for p in sea.parts if p.kind == "armour"}]
    assert crossing.depth == pytest.approx(0.1e-3, rel=1e-6) and crossing.severe
    assert any("bedding" in o.second for o in found)


def test_ring_that_is_too_narrow_is_named(cable):
    found = self_intersections(with_parts(cable, {"wrap": {"inner_radius": 19.4e-3}}), level="conductor")
    cut = [o for o in found if o.second == "wrap"]
    assert cut[0].depth == pytest.approx(0.1e-3, rel=1e-6) and "screen" in cut[0].first


def test_rod_thicker_than_its_bend_cuts_itself():
    """Lay angle 45 deg on a radius of 10 mm: radius of curvature 20 mm."""
    rod = read_cable("helical-rod")
    assert self_intersections(rod) == []
    (found,) = self_intersections(with_parts(rod, {"rod": {"outer_radius": 0.0201}}))
    assert found.severe and "bends more sharply" in found.sentence
    assert self_intersections(with_parts(rod, {"rod": {"outer_radius": 0.0199}})) == []


def test_cables_that_ship_hold_no_severe_overlap():
    for entry in builtin_cables():
        assert not [o.sentence for o in self_intersections(read_cable(entry.name), 0.05) if o.severe], entry.name


def test_solids_that_cut_each_other_are_not_written(cable, tmp_path):
    thick = {p.name: {"outer_radius": p.outer_radius + 0.2e-3} for p in cable.parts if p.kind == "screen"}
    with pytest.raises(GeometryError, match=r"core .* screen and .* overlap by 0\.\d+ mm"):
        write_solids(with_parts(cable, thick), tmp_path / "cable.step", 0.02)
    assert not (tmp_path / "cable.step").exists()

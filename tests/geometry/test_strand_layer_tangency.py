"""Members of one layer touch where the shortest distance of their helical centre lines is their diameter."""

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from geometry.errors import GeometryError
from geometry.helix import Helix
from geometry.strand_layer import (
    largest_count,
    lay_for_contact,
    layer_gap,
    neighbour_distance,
    solve_layer,
    tangent_diameter,
    twisting_radius,
)

FEW = settings(max_examples=15, deadline=None)
COUNTS = st.integers(2, 40)
ANGLES = st.floats(0.0, np.radians(60))


def test_six_strands_round_one_overlap_and_the_thickness_at_which_they_touch():
    """Six strands of 3.016 mm round one, lay 127 mm: overlap 0.025 mm; outer strands of 2.967 mm touch (facts of the cable)."""
    assert layer_gap(6, 3.016e-3, 3.016e-3, 0.127) == pytest.approx(-0.025e-3, abs=0.5e-6)
    assert tangent_diameter(6, 0.127, radius_below=1.508e-3) == pytest.approx(2.967e-3, abs=0.5e-6)


@FEW
@given(count=COUNTS, angle=st.floats(0.02, 1.2))
def test_distance_of_neighbours_against_a_direct_search(count, angle):
    """D is the distance from one helix to the nearest point of the next, found with Helix.position alone."""
    lay = 2 * np.pi / np.tan(angle)
    first, second = Helix(1.0, lay), Helix(1.0, lay, phase=2 * np.pi / count)
    origin = first.position(0.0)

    def distance(z):
        return np.linalg.norm(second.position(z) - origin, axis=-1)

    z = np.linspace(-lay, lay, 4001)
    start = z[distance(z).argmin()]
    found = minimize_scalar(distance, bounds=(start - lay / 1000, start + lay / 1000), options={"xatol": 1e-10 * lay})
    assert neighbour_distance(count, 1.0, lay) == pytest.approx(float(found.fun), rel=1e-8)


@pytest.mark.parametrize("count", [2, 3, 6, 17])
def test_straight_members_touch_on_the_polygon(count):
    """R = d / (2 sin(pi / n)) without lay."""
    assert twisting_radius(count, 2e-3) == pytest.approx(1e-3 / np.sin(np.pi / count), rel=1e-12)


def test_many_members_touch_as_in_the_developed_plane():
    """n d = 2 pi R cos beta for many members; the circle adds (pi / n)^2 / 6 and less."""
    angle = np.radians(25)
    for count in (50, 100, 200):
        radius = twisting_radius(count, 1e-3, lay_angle=angle)
        developed = count * 1e-3 / (2 * np.pi * np.cos(angle))
        assert 0 < radius / developed - 1 < (np.pi / count) ** 2 / 6


@FEW
@given(count=COUNTS, ratio=st.floats(1.3, 40))
def test_twisting_radius_is_where_neighbours_touch(count, ratio):
    """Zero gap at the radius, overlap just inside it; the lay and the lay angle give the same radius."""
    d, lay = 1e-3, ratio * count * 1e-3
    radius = twisting_radius(count, d, lay)
    assert layer_gap(count, d, radius, lay) == pytest.approx(0.0, abs=1e-12)
    assert layer_gap(count, d, 0.999 * radius, lay) < 0 < layer_gap(count, d, 1.001 * radius, lay)
    angle = np.arctan(2 * np.pi * radius / lay)
    assert twisting_radius(count, d, lay_angle=angle) == pytest.approx(radius, rel=1e-9)


@FEW
@given(radius=st.floats(0.6, 30), angle=ANGLES)
def test_largest_count_fits_and_one_more_does_not(radius, angle):
    lay = None if angle < 1e-3 else 2 * np.pi * radius / np.tan(angle)
    count = largest_count(1.0, radius, lay)
    assert layer_gap(count, 1.0, radius, lay) >= -1e-5
    assert layer_gap(count + 1, 1.0, radius, lay) < 0


@FEW
@given(count=st.integers(3, 40), below=st.floats(0.1, 20), ratio=st.floats(1.5, 30))
def test_tangent_members_touch_their_neighbours_and_the_layer_below(count, below, ratio):
    lay = ratio * 2 * np.pi * below
    d = tangent_diameter(count, lay, radius_below=below)
    layer = solve_layer(count=count, lay=lay, radius_below=below)
    assert layer.diameter == d
    assert layer.radius == pytest.approx(below + d / 2, rel=1e-9)
    assert layer.gap_to_neighbour == pytest.approx(0.0, abs=1e-9 * below)
    assert layer.gap_below == pytest.approx(0.0, abs=1e-9 * below)
    by_angle = solve_layer(count=count, lay_angle=layer.lay_angle, radius_below=below)
    assert by_angle.diameter == pytest.approx(d, rel=1e-9)


@FEW
@given(count=st.integers(2, 40), room=st.floats(1.001, 3.0))
def test_locking_limit_is_the_steepest_lay_without_overlap(count, room):
    """Neighbours touch at the lay found, overlap at a shorter one, clear at a longer one."""
    radius = room / (2 * np.sin(np.pi / count))
    lay = lay_for_contact(count, 1.0, radius)
    assert lay is not None
    assert layer_gap(count, 1.0, radius, lay) == pytest.approx(0.0, abs=1e-9)
    assert layer_gap(count, 1.0, radius, 0.99 * lay) < 0 < layer_gap(count, 1.0, radius, 1.01 * lay)
    locked = solve_layer(count=count, diameter=1.0, radius=radius, lay=lay).locking_angle
    assert locked == pytest.approx(np.arctan(2 * np.pi * radius / lay), rel=1e-9)


@FEW
@given(count=COUNTS, angle=ANGLES, scale=st.floats(0.1, 10))
def test_everything_scales_with_the_diameter(count, angle, scale):
    one, other = (solve_layer(count=count, diameter=d, lay_angle=angle) for d in (1.0, scale))
    assert other.radius == pytest.approx(scale * one.radius, rel=1e-9)
    assert other.lay_angle == pytest.approx(angle, abs=1e-12)
    if one.lay is not None:
        assert other.lay == pytest.approx(scale * one.lay, rel=1e-9)


def test_members_too_many_for_the_layer_below_stand_off_it():
    """Six full strands round one of the same size: they touch each other and leave a gap of 0.026 mm to the centre."""
    layer = solve_layer(count=6, diameter=3.016e-3, lay=0.127, radius_below=1.508e-3)
    assert layer.gap_to_neighbour == pytest.approx(0.0, abs=1e-9)
    assert layer.gap_below == pytest.approx(twisting_radius(6, 3.016e-3, 0.127) - 3.016e-3, rel=1e-9)
    loose = solve_layer(count=5, diameter=3.016e-3, lay=0.127, radius_below=1.508e-3)
    assert loose.gap_below == pytest.approx(0.0, abs=1e-15)
    assert loose.gap_to_neighbour > 0.4e-3
    assert solve_layer(count=1, diameter=3e-3).outer_radius == pytest.approx(1.5e-3)


def test_layers_of_the_steel_strand_are_filled_by_count():
    """Cardinal ACSR: 12, 18 and 24 wires of 3.32 mm fit on the layers below with one place to spare at most."""
    below = 1.5 * 3.34e-3
    for count, lay in ((12, 0.2166), (18, 0.3029), (24, 0.3593)):
        layer = solve_layer(diameter=3.32e-3, lay=lay, radius_below=below)
        assert count <= layer.count <= count + 1
        below = layer.outer_radius


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"count": 7, "diameter": 1.0, "radius": 1.0}, "has room for 6"),
        (
            {"count": 6, "diameter": 1.0, "radius": 1.1, "lay_angle": 0.7},
            r"locking limit of 27\.\d+ deg .* or take 5 members",
        ),
        ({"count": 6, "diameter": 1.0, "lay": 6.0}, "fit on no radius .* lengthen the lay"),
        ({"count": 6, "diameter": 1.0, "radius": 1.4, "radius_below": 1.0}, "reach 100 mm into the layer below"),
        ({"count": 6, "diameter": 1.0, "lay": 20.0, "lay_angle": 0.2}, "not by both"),
        ({"lay": 20.0, "radius": 1.0}, "count or the diameter"),
        ({"count": 6}, "twisting radius"),
        ({"count": 0, "diameter": 1.0}, "whole number"),
        ({"count": 6, "diameter": -1.0}, "diameter of a layer must be positive"),
        ({"count": 6, "diameter": 1.0, "lay": 0.0}, "lay of a layer must be positive"),
        ({"count": 6, "diameter": np.nan}, "positive"),
        ({"count": 6, "diameter": 1.0, "lay_angle": 1.6}, "89.9 deg"),
        ({"count": 2, "radius_below": 1.0}, "never touch each other"),
        ({"count": 2, "radius_below": 1.0, "lay_angle": 0.1}, "never touch each other"),
        ({"count": 1, "radius_below": 1.0}, "no neighbour"),
        ({"diameter": 1e-9, "radius": 1.0}, "check the units"),
    ],
)
def test_layers_without_a_solution_are_refused(given, words):
    with pytest.raises(GeometryError, match=words):
        solve_layer(**given)


def test_advice_of_the_locking_limit_is_good():
    """The lay and the count that the refusal names do fit, and no shorter lay does."""
    with pytest.raises(GeometryError) as refused:
        solve_layer(count=6, diameter=1e-3, radius=1.1e-3, lay_angle=0.7)
    lay, count = re.search(r"at least ([\d.]+) mm, or take (\d) members", str(refused.value)).groups()
    assert 0 <= solve_layer(count=6, diameter=1e-3, radius=1.1e-3, lay=1e-3 * float(lay)).gap_to_neighbour < 1e-6
    assert solve_layer(count=int(count), diameter=1e-3, radius=1.1e-3, lay_angle=0.7).gap_to_neighbour > 0

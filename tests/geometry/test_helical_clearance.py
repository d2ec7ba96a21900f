"""Members clear by the distance of their helical centre lines, not by the chord in the section."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geometry import GeometryError, Member, clearances, helix_distance
from geometry.clearance import check_clearance, touching_radius

FEW = settings(max_examples=20, deadline=None)
CORE = 15.75e-3
LAY = 0.234


def four_cores(pitch_radius, diameter=CORE):
    return [Member(f"core {k + 1}", pitch_radius, k * np.pi / 2, diameter / 2) for k in range(4)]


@pytest.mark.parametrize(
    ("earth_over_cover", "ratio", "gap"),
    [
        (7.5, 6, 0.286),
        (7.0, 6, -0.05),
        (6.5, 6, -0.39),
        (8.0, 6, 0.62),
        (7.5, 8, 0.46),
        (7.5, 10, 0.55),
        (7.5, 12, 0.59),
    ],
)
def test_neighbouring_cores_of_the_reference_cable(earth_over_cover, ratio, gap):
    """Hand-computed table of the reference cable at a lay of `ratio` x laid-up diameter, printed to 0.01 mm."""
    lay = ratio * (earth_over_cover + 2 * 15.75)
    r = (earth_over_cover * 1e-3 + CORE) / 2
    found = helix_distance(r, r, np.pi / 2, lay * 1e-3) - CORE
    assert 1e3 * found == pytest.approx(gap, abs=0.0052)


@FEW
@given(st.floats(1e-3, 0.03), st.floats(1e-3, 0.03), st.floats(0.1, 6.1), st.floats(0.02, 1.0))
def test_distance_is_the_minimum_over_two_sampled_curves(r1, r2, angle, lay):
    """Against brute force over points of both helices; never longer than the chord, symmetric in the two members."""
    found = helix_distance(r1, r2, angle, lay)
    z = np.linspace(-lay, lay, 20001)
    turn = 2 * np.pi * z / lay + angle
    brute = np.sqrt((r2 * np.cos(turn) - r1) ** 2 + (r2 * np.sin(turn)) ** 2 + z**2).min()
    assert found == pytest.approx(brute, abs=1e-4 * lay)
    assert found <= helix_distance(r1, r2, angle, None) + 1e-12
    assert found == pytest.approx(helix_distance(r2, r1, -angle, lay), rel=1e-6)


def test_straight_members_have_the_chord():
    assert helix_distance(0.01, 0.01, np.pi / 2, None) == pytest.approx(np.sqrt(2) * 0.01)


def test_overlap_names_the_parts_and_what_would_fit():
    """Earth of 7.0 mm: circles clear by 0.34 mm, cores overlap by 0.05 mm. The advice, followed, must fit."""

    def members(grow):
        inner = 3.5e-3 + grow / 2
        return [Member("earth", 0.0, 0.0, inner), *four_cores(inner + CORE / 2)]

    with pytest.raises(GeometryError) as caught:
        check_clearance(members(0.0), LAY, members)
    sentence = str(caught.value)
    assert (
        "core 1 and core 2" in sentence
        or "core 3 and core 4" in sentence
        or "core 1 and core 4" in sentence
        or "core 2 and core 3" in sentence
    )
    assert "overlap by 0.0" in sentence and "circles clear" in sentence
    words = sentence.split()
    grow = float(words[words.index("by", words.index("enlarge")) + 1]) * 1e-3
    lay = float(words[words.index("least") + 1]) * 1e-3
    check_clearance(members(grow), LAY)
    check_clearance(members(0.0), lay)
    with pytest.raises(GeometryError):
        check_clearance(members(grow - 2e-5), LAY)
    with pytest.raises(GeometryError):
        check_clearance(members(0.0), lay - 1e-3)


def test_touching_is_allowed():
    check_clearance([Member("a", 1e-3, 0.0, 1e-3), Member("b", 1e-3, np.pi, 1e-3)], None)


def test_next_turn_of_a_short_lay_is_seen():
    """One core whose lay is shorter than its own width along the axis cuts into itself."""
    worst = clearances([Member("core", 5e-3, 0.0, 2e-3)], 3.5e-3)[0]
    assert worst.second == "the next turn of core" and worst.gap < 0


@FEW
@given(st.integers(2, 7), st.floats(8.0, 40.0))
def test_cores_without_a_centre_move_in_until_they_touch(count, ratio):
    radius = 1e-3
    lay = ratio * 4 * radius

    def place(inner):
        return [Member(str(k), inner + radius, 2 * np.pi * k / count, radius) for k in range(count)]

    inner = touching_radius(place, lay, 0.1)
    gaps = clearances(place(inner), lay)
    assert gaps[0].gap == pytest.approx(0.0, abs=1e-8) or inner == 0.0


def test_no_fit_without_advice_that_works():
    """Straight, and the circles themselves overlap: no lay is suggested."""
    with pytest.raises(GeometryError) as caught:
        check_clearance(four_cores(5e-3), None)
    assert "lay" not in str(caught.value).split(":")[1]

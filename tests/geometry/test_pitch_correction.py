"""Strands of a conductor bent onto a core helix lie steeper at the inside; the corrected lay restores their clearance."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize
from scipy.spatial import cKDTree

from geometry.bent_lay import bent_clearance, bent_lay, lay_rate, relative_turn_rate, strand_points
from geometry.errors import GeometryError
from geometry.helix import Helix
from geometry.nested_helix import nested_helix
from geometry.strand_layer import StrandLayer, layer_gap, solve_layer

CORE = Helix(11.625e-3, 0.234)
POWER = solve_layer(count=6, lay=0.127, radius_below=1.508e-3)
SHARP = Helix(20e-3, 0.120)
HANDS = st.sampled_from("ZS")
FEW = settings(max_examples=8, deadline=None)


def closest(first, second):
    """Shortest distance of two sampled centre lines: nearest pair of samples, then the minimum of their splines."""
    a, b = (CubicSpline(line.z, line.points) for line in (first, second))
    distance, nearest = cKDTree(second.points).query(first.points)
    inner = slice(len(distance) // 6, -len(distance) // 6)  # the other strand must not end before the nearest point
    i = int(np.argmin(distance[inner])) + len(distance) // 6
    start = np.array([first.z[i], second.z[nearest[i]]])
    found = minimize(
        lambda z: 1e6 * ((a(z[0]) - b(z[1])) ** 2).sum(),
        start,
        method="Nelder-Mead",
        options={"xatol": 1e-9, "fatol": 1e-14},
    )
    return float(np.sqrt(1e-6 * found.fun))


def strands(core, lay, hand, radius, step, height):
    z = np.linspace(0, height, 3001)
    return [nested_helix([core, Helix(radius, lay, hand, phase)], z) for phase in (0.3, 0.3 + step)]


@FEW
@given(radius=st.floats(5e-3, 30e-3), pitch=st.floats(0.1, 0.6), lay=st.floats(0.05, 0.3), hand=HANDS, strand=HANDS)
def test_strand_in_the_frame_of_its_core_is_the_nested_helix(radius, pitch, lay, hand, strand):
    """Formula (2) with the transported frame, and the direction in the core's own frame that turns by omega z."""
    core, z = Helix(radius, pitch, hand, 0.4), np.linspace(0, 0.2, 41)
    nested = nested_helix([core, Helix(3e-3, lay, strand, 0.7)], z).points
    omega = relative_turn_rate(radius, core.turn_rate, lay, strand)
    points = strand_points(core, 3e-3, z / np.cos(core.lay_angle), np.pi + 0.7 + omega * z)
    np.testing.assert_allclose(points, nested, atol=1e-13)


@pytest.mark.parametrize(("core", "lay", "strand"), [(CORE, 0.127, "Z"), (SHARP, 0.06, "Z"), (SHARP, 0.06, "S")])
def test_bent_clearance_against_the_nested_helices(core, lay, strand):
    """Shortest distance of two sampled neighbours over more than one turn relative to the core."""
    height = 2.2 * 2 * np.pi / abs(relative_turn_rate(core.radius, core.turn_rate, lay, strand))
    sampled = closest(*strands(core, lay, strand, 3e-3, np.pi / 3, height))
    assert bent_clearance(core, 6, 3e-3, 3e-3, lay, strand) == pytest.approx(sampled - 3e-3, abs=2e-9)


def test_neighbours_that_just_clear_overlap_on_the_core_and_the_corrected_lay_restores_them():
    """Power conductor: 1.0 micrometre of overlap, lay 127 -> 129.6 mm; the loss is 2 kappa r2 cos(pi/6) of what the lay costs."""
    bent = bent_lay(CORE, POWER)
    assert bent.straight_clearance == pytest.approx(0.0, abs=1e-9)
    chord = layer_gap(6, POWER.diameter, POWER.radius, None)
    assert bent.bent_clearance == pytest.approx(
        -2 * CORE.curvature * POWER.radius * np.cos(np.pi / 6) * chord, rel=0.03
    )
    assert bent.corrected_clearance == pytest.approx(bent.straight_clearance, abs=1e-11)
    assert bent.corrected_lay == pytest.approx(129.6e-3, abs=0.1e-3)
    assert bent.centre_clearance == pytest.approx(0.0, abs=1e-9)


@FEW
@given(radius=st.floats(8e-3, 40e-3), pitch=st.floats(0.15, 0.6), lay=st.floats(0.05, 0.3), hand=HANDS, strand=HANDS)
def test_corrected_clearance_is_that_of_the_straight_conductor(radius, pitch, lay, hand, strand):
    layer = solve_layer(count=6, diameter=3e-3, lay=lay)
    bent = bent_lay(Helix(radius, pitch, hand), layer, strand)
    assert bent.bent_clearance < bent.straight_clearance + 1e-12
    assert bent.corrected_clearance == pytest.approx(bent.straight_clearance, abs=1e-11)
    assert bent.corrected_lay >= lay


@pytest.mark.parametrize("count", [3, 6, 9])
def test_small_bends_need_the_correction_of_the_pair_at_the_inside(count):
    """p2' / p2 - 1 = kappa r2 cos(pi / n) (1 + O(beta2^2)) for a slight bend: the rest falls to a quarter at twice the lay."""
    core, rest = Helix(5e-3, 4.0), []
    for lay in (0.1, 0.2):
        layer = solve_layer(count=count, diameter=3e-3, lay=lay)
        bent = bent_lay(core, layer)
        inside = core.curvature * layer.radius * np.cos(np.pi / count)
        rest.append((bent.corrected_lay / lay - 1) / inside - 1)
    assert 0 < rest[0] < 0.05
    assert rest[0] / rest[1] == pytest.approx(4.0, rel=0.1)


def test_no_bend_no_correction():
    """On the cable axis the clearance is that of the straight conductor and the lay stays; only the frame turns."""
    bent = bent_lay(Helix(0.0, 0.234), POWER)
    assert bent.bent_clearance == pytest.approx(bent.straight_clearance, abs=1e-12)
    assert bent.corrected_lay == POWER.lay
    assert bent.turn_rate == pytest.approx(2 * np.pi / 0.127 - 2 * np.pi / 0.234, rel=1e-12)
    assert bent.turn_rate_in_cable == pytest.approx(2 * np.pi / 0.127, rel=1e-12)


def test_straight_strands_keep_their_chord():
    """Without lay the nearest point of the neighbour lies in the same normal plane, on every core."""
    layer = replace(POWER, lay=None, lay_angle=0.0)
    bent = bent_lay(SHARP, layer)
    chord = 2 * layer.radius * np.sin(np.pi / 6) - layer.diameter
    assert bent.bent_clearance == pytest.approx(chord, abs=1e-10)
    assert bent.corrected_lay is None


@pytest.mark.parametrize("strand", ["Z", "S"])
def test_local_lay_angle(strand):
    """tan beta2 = (2 pi r2 / p2) / (1 - kappa r2 cos psi), psi from the principal normal; largest on the inside."""
    z = np.linspace(0, 0.3, 500)
    line = nested_helix([SHARP, Helix(3e-3, 0.06, strand)], z)
    T, N, _ = np.moveaxis(SHARP.frenet_frame(z), -2, 0)
    inward = ((line.points - SHARP.position(z)) * N).sum(1)  # r2 cos psi
    tangent = (line.frames[:, 0] * T).sum(1)
    expected = (2 * np.pi * 3e-3 / 0.06) / (1 - SHARP.curvature * inward)
    np.testing.assert_allclose(np.tan(np.arccos(tangent)), expected, rtol=2e-7)  # ends of the splines of nested_helix
    layer = StrandLayer(6, 2.9e-3, 3e-3, 0.06, np.arctan(2 * np.pi * 3e-3 / 0.06), 0.0)
    steepest = bent_lay(SHARP, layer, strand).steepest_lay_angle
    assert np.arctan(expected.max()) == pytest.approx(steepest, rel=1e-4)  # the samples come near the inside
    assert steepest > layer.lay_angle


@FEW
@given(radius=st.floats(0.0, 30e-3), pitch=st.floats(0.1, 0.6), lay=st.floats(0.05, 0.3), hand=HANDS, strand=HANDS)
def test_turn_rate_is_seen_in_the_frame_of_the_core(radius, pitch, lay, hand, strand):
    """Angle of the strand from the outward direction, measured on the nested helix, grows by omega per height."""
    core, z = Helix(radius, pitch, hand), np.linspace(0, 0.1, 60)
    offset = nested_helix([core, Helix(2e-3, lay, strand)], z).points - core.position(z)
    _, N, B = np.moveaxis(core.frenet_frame(z), -2, 0)
    angle = np.unwrap(np.arctan2(-(offset * B).sum(1), -(offset * N).sum(1)))
    omega = relative_turn_rate(radius, core.turn_rate, lay, strand)
    np.testing.assert_allclose(np.diff(angle), omega * np.diff(z), atol=1e-9)


def test_turns_of_the_two_frames():
    """The lay in the core's frame is longer than the lay for equal hands, shorter for opposite ones; heights agree with rates."""
    for hand, longer in (("Z", True), ("S", False)):
        bent = bent_lay(CORE, POWER, hand)
        assert (bent.lay_in_core > POWER.lay) == longer
        assert bent.lay_in_core * np.cos(CORE.lay_angle) == pytest.approx(bent.height_of_turn, rel=1e-12)
        assert abs(bent.turn_rate) * bent.height_of_turn == pytest.approx(2 * np.pi, rel=1e-12)
        assert bent.turn_rate_in_cable == pytest.approx(bent.turn_rate + CORE.turn_rate, rel=1e-12)


def test_strands_that_do_not_turn_relative_to_their_core():
    """A lay of one turn per torsion: omega = 0, and the strand at the inside stays there for good."""
    lay = 2 * np.pi / CORE.torsion
    assert relative_turn_rate(CORE.radius, CORE.turn_rate, lay, "Z") == pytest.approx(0.0, abs=1e-12 * CORE.turn_rate)
    assert relative_turn_rate(0.0, 0.0, None, "Z") == 0.0
    layer = solve_layer(count=6, diameter=3e-3, lay=lay)
    assert bent_lay(CORE, layer).bent_clearance < 0


def test_bad_requests_are_sentences():
    with pytest.raises(GeometryError, match="cannot follow a core that bends to"):
        bent_lay(Helix(3e-3, 5e-3), StrandLayer(6, 5e-3, 5e-3, 0.1, 0.3, 0.0))
    with pytest.raises(GeometryError, match="radius that is not negative"):
        relative_turn_rate(-1.0, 1.0, None, "Z")
    with pytest.raises(GeometryError, match="positive length"):
        lay_rate(-0.1, "Z")
    with pytest.raises(GeometryError, match='"Z"'):
        lay_rate(0.1, "L")

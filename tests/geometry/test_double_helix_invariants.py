"""Strand in a conductor in a cable: arc length, curvature, torsion, frames without flips, and the mirror image of all of it."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.interpolate import CubicSpline

from geometry.bent_lay import bent_lay, relative_turn_rate
from geometry.helix import Helix
from geometry.nested_helix import nested_helix
from geometry.strand_layer import solve_layer

FEW = settings(max_examples=8, deadline=None)
HANDS = st.sampled_from("ZS")
PHASES = st.floats(-3.0, 3.0)
CORES = st.builds(Helix, st.floats(5e-3, 30e-3), st.floats(0.1, 0.6), HANDS, PHASES)
STRANDS = st.builds(Helix, st.floats(1e-3, 4e-3), st.floats(0.04, 0.3), HANDS, PHASES)
WIRES = st.builds(Helix, st.floats(0.3e-3, 1.5e-3), st.floats(0.03, 0.1), HANDS, PHASES)


def mirrored(helix):
    """Image in the plane y = 0."""
    return Helix(helix.radius, helix.pitch, "S" if helix.hand == "Z" else "Z", -helix.phase)


def curvature_and_torsion(line):
    """From derivatives of the splines of the points over z, away from the ends."""
    splines = CubicSpline(line.z, line.points)
    third = CubicSpline(line.z, splines(line.z, 2)).derivative()
    z = line.z[len(line.z) // 4 : -len(line.z) // 4]
    v, a, j = splines(z, 1), splines(z, 2), third(z)
    cross = np.cross(v, a)
    square = (cross**2).sum(1)
    return np.sqrt(square) / np.linalg.norm(v, axis=1) ** 3, (cross * j).sum(1) / square


@FEW
@given(CORES, STRANDS)
def test_arc_length_of_a_double_helix(core, strand):
    """ds2/ds1 = sqrt((1 - kappa r2 cos psi)^2 + (2 pi r2 / p2)^2), psi = h2 2 pi s1/p2 - torsion s1 + phase from the normal."""
    height = 0.2
    z = np.linspace(0, height, 11)
    line = nested_helix([core, strand], z)
    rate = strand.turn_rate - core.torsion

    def speed(s):
        inside = 1 - core.curvature * strand.radius * np.cos(rate * s + strand.phase)
        return np.hypot(inside, strand.turn_rate * strand.radius)

    exact = quad(speed, 0, core.length(height), limit=400, epsabs=1e-13)[0]
    assert line.s[-1] == pytest.approx(exact, rel=1e-7)  # fourth order, 96 steps a turn


@FEW
@given(CORES, STRANDS)
def test_mean_arc_length_of_slender_strands(core, strand):
    """For r2 -> 0 at a fixed lay angle the length per length of core is 1 / cos beta2, whatever the core."""
    thin = Helix(1e-3 * strand.radius, 1e-3 * strand.pitch, strand.hand)
    line = nested_helix([core, thin], np.array([0.0, 20e-3 * strand.pitch]))
    ratio = line.s[-1] / core.length(20e-3 * strand.pitch)
    assert ratio == pytest.approx(1 / np.cos(strand.lay_angle), rel=2 * core.curvature * thin.radius + 1e-7)


@FEW
@given(STRANDS)
def test_curvature_and_torsion_on_a_straight_core(strand):
    """sin^2 beta / r and h sin beta cos beta / r, from the points of the two-level line."""
    line = nested_helix([Helix(0.0, 1.0), strand], np.linspace(0, 2 * strand.pitch, 1600))
    bend, twist = curvature_and_torsion(line)
    beta = strand.lay_angle
    np.testing.assert_allclose(bend, np.sin(beta) ** 2 / strand.radius, rtol=1e-4)  # second derivative of cubic splines
    np.testing.assert_allclose(twist, strand.sign * np.sin(beta) * np.cos(beta) / strand.radius, rtol=1e-3)


@FEW
@given(CORES)
def test_a_strand_on_the_centre_line_has_the_invariants_of_its_core(core):
    """r2 = 0: the double helix is the core helix, curvature sin^2 beta / r, torsion h sin beta cos beta / r."""
    line = nested_helix([core, Helix(0.0, 0.1)], np.linspace(0, 2 * core.pitch, 1600))
    bend, twist = curvature_and_torsion(line)
    np.testing.assert_allclose(bend, core.curvature, rtol=1e-4)
    np.testing.assert_allclose(twist, core.torsion, rtol=1e-3)


@FEW
@given(CORES, STRANDS)
def test_period_of_curvature_is_the_turn_relative_to_the_core(core, strand):
    """A double helix repeats itself under the screw motion of its core after 2 pi / omega, and so does its curvature."""
    omega = relative_turn_rate(core.radius, core.turn_rate, strand.pitch, strand.hand)
    period = 2 * np.pi / abs(omega)
    if not 0.01 < period < 2.0:
        return
    z = np.linspace(0, 0.5 * period, 30)
    points = nested_helix([core, strand], np.concatenate([z, z + period])).points
    angle = core.turn_rate * period
    Q = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    np.testing.assert_allclose(points[:30] @ Q.T + [0, 0, period], points[30:], atol=1e-10)


@FEW
@given(CORES, STRANDS, WIRES)
def test_frames_neither_flip_nor_twist(core, strand, wire):
    """Orthonormal and right-handed at every sample; the turn from one sample to the next is the bend of the tangent alone."""
    levels = [core, strand, wire]
    line = nested_helix(levels, np.linspace(0, 0.1, 1200))
    frames = line.frames
    np.testing.assert_allclose(frames @ frames.transpose(0, 2, 1), np.broadcast_to(np.eye(3), (1200, 3, 3)), atol=1e-7)
    np.testing.assert_allclose(np.linalg.det(frames), 1.0, atol=1e-7)
    bend = np.arccos(np.clip((frames[1:, 0] * frames[:-1, 0]).sum(1), -1, 1))
    for row in (1, 2):  # a flip would be an angle of up to pi, a twisted frame one of 2 pi ds / p
        turn = np.arccos(np.clip((frames[1:, row] * frames[:-1, row]).sum(1), -1, 1))
        assert (turn <= bend + 1e-4).all()
    twist = (frames[1:, 1] * frames[:-1, 2]).sum(1) / np.diff(line.s)
    assert np.abs(twist).max() < 2e-2 * 2 * np.pi / wire.pitch


@FEW
@given(CORES, STRANDS, WIRES)
def test_mirror_image_of_three_levels(core, strand, wire):
    """All hands and phases reversed: every point, tangent and length is the mirror image in the plane y = 0."""
    z = np.linspace(0, 0.1, 40)
    one, other = nested_helix([core, strand, wire], z), nested_helix([mirrored(h) for h in (core, strand, wire)], z)
    np.testing.assert_allclose(other.points * [1, -1, 1], one.points, atol=1e-10)
    np.testing.assert_allclose(other.frames[:, 0] * [1, -1, 1], one.frames[:, 0], atol=1e-7)
    np.testing.assert_allclose(other.s, one.s, rtol=1e-10)


@FEW
@given(CORES, HANDS, st.integers(3, 9), st.floats(0.06, 0.3))
def test_mirror_image_of_the_pitch_correction(core, hand, count, lay):
    """S strands on an S core clear, and are corrected, as Z strands on a Z core; the turn rates change their sign."""
    layer = solve_layer(count=count, diameter=2e-3, lay=lay)
    one = bent_lay(core, layer, hand)
    other = bent_lay(mirrored(core), layer, "S" if hand == "Z" else "Z")
    assert other.bent_clearance == pytest.approx(one.bent_clearance, abs=1e-12)
    assert other.corrected_lay == pytest.approx(one.corrected_lay, rel=1e-6)
    assert other.turn_rate == pytest.approx(-one.turn_rate, rel=1e-12)
    assert other.turn_rate_in_cable == pytest.approx(-one.turn_rate_in_cable, rel=1e-12)


def test_the_hand_of_the_strand_matters_on_a_core():
    """Z and S strands on one Z core turn at different rates, apart by 2 x 2 pi / (p2 cos beta), and are of different length."""
    core, strand = Helix(11.625e-3, 0.234), Helix(3e-3, 0.127)
    rates = [relative_turn_rate(core.radius, core.turn_rate, strand.pitch, hand) for hand in "ZS"]
    assert rates[0] - rates[1] == pytest.approx(2 * strand.turn_rate / np.cos(core.lay_angle), rel=1e-12)
    lengths = [nested_helix([core, replace(strand, hand=hand)], [0.0, 0.1]).s[-1] for hand in "ZS"]
    assert abs(lengths[0] - lengths[1]) > 1e-5

"""The trace of a round wire in z = 0: every point is at the wire's radius from the centre line; area pi rho^2 / cos beta."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geometry import GeometryError, WireTrace

FEW = settings(max_examples=15, deadline=None)


@st.composite
def traces(draw):
    r = draw(st.floats(2e-3, 20e-3))
    rho = r * draw(st.floats(0.1, 0.95))
    beta = np.radians(draw(st.floats(2.0, 40.0))) * draw(st.sampled_from([-1, 1]))
    return WireTrace(r, draw(st.floats(-3, 3)), rho, np.tan(beta) / r)


def distance_to_helix(trace, points):
    """Shortest distance from points of z = 0 to the centre-line helix, by table and parabola."""
    reach = 2 * trace.radius
    z = np.linspace(-reach, reach, 4001)
    angle = trace.twist_rate * z + trace.phase
    helix = np.column_stack([trace.centre_radius * np.cos(angle), trace.centre_radius * np.sin(angle), z])
    square = ((helix[None] - np.column_stack([points, np.zeros(len(points))])[:, None]) ** 2).sum(-1)
    k = np.clip(square.argmin(1), 1, len(z) - 2)
    a, b, c = (square[np.arange(len(points)), k + d] for d in (-1, 0, 1))
    return np.sqrt(b - (c - a) ** 2 / (8 * (a - 2 * b + c)))


@FEW
@given(traces())
def test_every_point_is_at_the_radius_from_the_centre_line(trace):
    points = trace.point(np.linspace(0, 2 * np.pi, 41))
    np.testing.assert_allclose(distance_to_helix(trace, points), trace.radius, rtol=1e-6)


def test_a_circle_and_the_wrong_sense_of_turn_are_not_the_trace():
    """The check above sees both mistakes."""
    trace = WireTrace(4.0, 0.0, 0.4, 2 * np.pi / 40)
    phi = np.linspace(0, 2 * np.pi, 41)
    circle = np.column_stack([4 + 0.4 * np.cos(phi), 0.4 * np.sin(phi)])
    assert np.ptp(distance_to_helix(trace, circle)) > 0.05
    s, c = np.sin(trace.lay_angle), np.cos(trace.lay_angle)
    turn = -trace.twist_rate * 0.4 * s * np.sin(phi)
    u, v = 4 + 0.4 * np.cos(phi), 0.4 * c * np.sin(phi)
    wrong = np.column_stack([np.cos(turn) * u - np.sin(turn) * v, np.sin(turn) * u + np.cos(turn) * v])
    assert np.ptp(distance_to_helix(trace, wrong)) > 0.05


@FEW
@given(traces())
def test_area_is_exactly_the_normal_section_over_the_cosine(trace):
    """Pappus: volume of the tube = pi rho^2 x length, and all sections are congruent. Exact, so round-off only."""
    assert trace.moments()[0] == pytest.approx(trace.area, rel=1e-10)


@FEW
@given(traces())
def test_mirror_image_for_the_other_hand(trace):
    other = WireTrace(trace.centre_radius, -trace.phase, trace.radius, -trace.twist_rate)
    phi = np.linspace(0, 6, 13)
    np.testing.assert_allclose(other.point(-phi), trace.point(phi) * [1, -1], atol=1e-15)


def test_straight_wire_gives_a_circle_and_its_moments():
    """I = pi rho^4 / 4 + A r^2 (parallel axes)."""
    r, rho = 3e-3, 1e-3
    area, _, _, sxx, syy, sxy = WireTrace(r, 0.0, rho, 0.0).moments()
    assert area == pytest.approx(np.pi * rho**2, rel=1e-12)
    assert syy == pytest.approx(np.pi * rho**4 / 4, rel=1e-10)
    assert sxx == pytest.approx(np.pi * rho**4 / 4 + area * r**2, rel=1e-10)
    assert sxy == pytest.approx(0.0, abs=1e-22)


@FEW
@given(traces(), st.floats(0, 6.28))
def test_nearest_point_of_a_point_on_the_curve_is_itself(trace, phi):
    found = trace.nearest(trace.point(phi))
    np.testing.assert_allclose(trace.point(found[0]), trace.point(phi), atol=1e-10 * trace.radius)


@FEW
@given(traces(), st.floats(0, 6.28))
def test_derivative(trace, phi):
    h = 1e-5
    difference = (trace.point(phi + h) - trace.point(phi - h)) / (2 * h)
    np.testing.assert_allclose(trace.derivative(phi), difference, atol=1e-8 * trace.centre_radius)


def test_trace_touches_inner_and_outer_circle():
    """The tube lies between the cylinders r - rho and r + rho and touches both."""
    trace = WireTrace(11.625e-3, 0.0, 7.875e-3, 2 * np.pi / 0.234)
    radii = np.hypot(*trace.point(np.linspace(0, 2 * np.pi, 721)).T)
    assert radii.min() == pytest.approx(3.75e-3, rel=1e-9)
    assert radii.max() == pytest.approx(19.5e-3, rel=1e-9)


def test_wire_thicker_than_its_bend_is_refused():
    with pytest.raises(GeometryError, match="lengthen the lay"):
        WireTrace(5e-3, 0.0, 7e-3, 2 * np.pi / 5e-3)
    with pytest.raises(GeometryError, match="positive radius"):
        WireTrace(5e-3, 0.0, 0.0, 0.0)

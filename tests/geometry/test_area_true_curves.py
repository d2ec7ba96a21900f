"""Polygons whose corners stand off the curve by kappa l^2 / 12 enclose the area of the curve."""

import numpy as np
import pytest

from geometry import cross_section_mesh, helical_slice, read_cable, region_sizes, slice_of_size
from geometry.area_true_curve import area_true_points
from geometry.wire_trace import WireTrace

CIRCLE = WireTrace(0.0, 0.0, 0.01, 0.0)
OVAL = WireTrace(0.03, 0.7, 0.01, 40.0)
"""A round wire under 50 degrees."""


def area(points):
    x, y = points.T
    return 0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()


def ring(n):
    return np.column_stack([np.arange(n), (np.arange(n) + 1) % n])


def unequal(n):
    """Angles whose steps differ by a factor of about three."""
    phi = 2 * np.pi * np.arange(n) / n
    return phi + 0.5 * np.sin(phi)


@pytest.mark.parametrize("curve", [CIRCLE, OVAL])
@pytest.mark.parametrize("angles", [unequal, lambda n: 2 * np.pi * np.arange(n) / n])
def test_area_is_lost_with_the_fourth_power_of_the_edges(curve, angles):
    """An inscribed polygon errs with the second power, the area-true one with the fourth, equal edges or not."""
    errors = []
    for n in (32, 64):
        points = curve.point(angles(n))
        errors.append([1 - area(p) / curve.area for p in (points, area_true_points(curve, points, ring(n)))])
    inscribed, true = np.log2(np.abs(errors[0]) / np.abs(errors[1]))
    assert inscribed == pytest.approx(2.0, abs=0.15)
    assert true > 3.4
    assert abs(errors[1][1]) < 0.02 * errors[1][0]


def test_circle_of_equal_edges_in_closed_form():
    """The exact factor is sqrt(a / sin a), a = 2 pi / n; the move gives 1 + (2 sin(a / 2))^2 / 12: they differ by a^4 (1/160 + 1/144)."""
    a = 2 * np.pi / 24
    points = area_true_points(CIRCLE, CIRCLE.point(a * np.arange(24)), ring(24))
    radius = np.hypot(*points.T) / 0.01
    np.testing.assert_allclose(radius, 1 + (2 * np.sin(a / 2)) ** 2 / 12, rtol=1e-9)  # curvature by differences
    np.testing.assert_allclose(
        np.sqrt(a / np.sin(a)) - radius, a**4 * (1 / 160 + 1 / 144), rtol=0.02
    )  # and terms of a^6


def test_pieces_of_a_curve_add_up():
    """A polygon with a gap: the ends move as far as their only edge asks, so that the fan of the piece is exact too."""
    phi = np.linspace(0.3, 0.3 + np.pi, 25)
    points = area_true_points(CIRCLE, CIRCLE.point(phi), ring(25)[:-1])
    fan = area(np.vstack([points, [0.0, 0.0]]))
    assert fan == pytest.approx(CIRCLE.area / 2, rel=2e-5)
    assert area(np.vstack([CIRCLE.point(phi), [0.0, 0.0]])) < CIRCLE.area / 2 * (1 - 2e-3)


def test_points_come_back_to_the_curve_first():
    rough = CIRCLE.point(2 * np.pi * np.arange(24) / 24) * (1 + 0.01 * np.cos(np.arange(24)))[:, None]
    on = CIRCLE.point(CIRCLE.nearest(rough))
    np.testing.assert_allclose(
        area_true_points(CIRCLE, rough, ring(24)), area_true_points(CIRCLE, on, ring(24)), atol=1e-12
    )
    np.testing.assert_allclose(area_true_points(CIRCLE, rough, np.zeros((0, 2))), on, atol=1e-12)


def test_moves_are_limited():
    points = CIRCLE.point(2 * np.pi * np.arange(12) / 12)
    moved = area_true_points(CIRCLE, points, ring(12), most=1e-5)
    np.testing.assert_allclose(np.hypot(*moved.T), 0.01 + 1e-5, rtol=1e-12)


@pytest.fixture(scope="module")
def cable():
    return read_cable("mcpt-1.9-3.3-3x35")


@pytest.mark.parametrize("kind", ["triangle", "quad"])
@pytest.mark.parametrize("size", [None, 4e-3])
def test_every_region_of_the_section_has_its_area(cable, kind, size):
    """Within 0.1 %, but for cover and wrap, which get the 0.4 % of the closures at the contacts (contact_closure.py)."""
    section = cross_section_mesh(cable, size, kind)
    errors = region_sizes(section) / [region.closed_form_area for region in section.regions] - 1
    for region, error in zip(section.regions, errors):
        assert abs(error) < (5e-3 if region.kind in ("cover", "wrap") else 1e-3), region.name


def test_every_region_of_a_slice_has_its_volume(cable):
    """The turn a of a layer takes a^2 / 6 off, 0.13 % at 5 degrees; nothing else is lost."""
    mesh = slice_of_size(cable, 10_000)
    errors = region_sizes(mesh) / [region.closed_form_area * mesh.height for region in mesh.regions] - 1
    assert np.abs(errors).max() < 5e-3
    lost = errors[[region.kind in ("conductor", "insulation", "screen", "sheath") for region in mesh.regions]]
    np.testing.assert_allclose(lost, -(np.radians(5) ** 2) / 6, atol=1e-4)


def test_fine_layers_lose_nothing(cable):
    section = cross_section_mesh(cable, 4e-3, "quad")
    mesh = helical_slice(section, 0.01, 10)
    np.testing.assert_allclose(region_sizes(mesh), region_sizes(section) * mesh.height, rtol=2e-4)

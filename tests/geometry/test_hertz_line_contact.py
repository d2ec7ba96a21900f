"""Hertz: the strip on which two strands touch along a line, parallel cylinders and helices of one lay."""

import numpy as np
import pytest

from geometry.errors import GeometryError
from geometry.line_contact import LineContact, hertz_half_width, line_contact
from geometry.material import Material
from geometry.wire_trace import WireTrace

STEEL = Material("steel", 200e9, 0.3, 7850.0)
RIGID = Material("rigid", 1e30, 0.3, 7850.0)


def test_steel_roller_on_a_flat_steel_plate():
    """a = 1.52 sqrt(p R / E), nu 0.3, equal materials (the classical number; 3 digits)."""
    p, R = 1e5, 10e-3
    assert hertz_half_width(p, LineContact(1 / R, 1.0), STEEL, STEEL) == pytest.approx(
        1.52 * np.sqrt(p * R / 200e9), rel=2e-3
    )


def test_peak_pressure_and_mean_pressure():
    """p0 = sqrt(p E* kappa / pi) and p = pi a p0 / 2: two ways to the same force (exact)."""
    p, kappa = 3e4, 1500.0
    a = hertz_half_width(p, LineContact(kappa, 1.0), STEEL, STEEL)
    E = 200e9 / (2 * (1 - 0.3**2))
    assert np.pi * a * np.sqrt(p * E * kappa / np.pi) / 2 == pytest.approx(p, rel=1e-12)


def test_width_grows_with_the_root_of_the_force_and_rigid_partners_halve_the_softness():
    """a ~ sqrt(p); no force, no width; a rigid partner takes half of 1 / E* away."""
    touch = LineContact(1000.0, 1.0)
    a = hertz_half_width(1e4, touch, STEEL, STEEL)
    assert hertz_half_width(4e4, touch, STEEL, STEEL) == pytest.approx(2 * a, rel=1e-12)
    assert hertz_half_width(1e4, touch, STEEL, RIGID) == pytest.approx(a / np.sqrt(2), rel=1e-12)
    assert hertz_half_width(0.0, touch, STEEL, STEEL) == 0.0


@pytest.mark.parametrize("degrees", [5.0, 12.0, 17.0, 30.0])
def test_helical_wire_on_a_core(degrees):
    """kappa = cos^2 b1 / R1 + cos^2 d / R2 - sin^2 d K / (1 - K R2): the curvatures of core and tube across their common helix,
    b1 its lay angle on the core, d its angle to the wire, K the curvature of the wire (differential geometry; 1e-5 by differences)."""
    R1, R2, beta = 1.97e-3, 1.865e-3, np.radians(degrees)
    r = R1 + R2
    tau = np.tan(beta) / r
    found = line_contact(WireTrace(0.0, 0.0, R1, tau), WireTrace(r, 0.4, R2, tau))
    on_core, K = np.arctan(tau * R1), np.sin(beta) ** 2 / r
    d = beta - on_core
    exact = np.cos(on_core) ** 2 / R1 + np.cos(d) ** 2 / R2 - np.sin(d) ** 2 * K / (1 - K * R2)
    assert found.curvature == pytest.approx(exact, rel=1e-5)
    assert found.stretch == pytest.approx(1 / np.cos(on_core), rel=1e-6)


def test_neighbours_of_a_layer_mirror_each_other():
    """The hand of the lay does not change the contact of neighbours, and a longer lay brings it to that of parallel cylinders."""
    R = 1.5e-3

    def neighbours(tau):
        return line_contact(WireTrace(2 * R, 0.0, R, tau), WireTrace(2 * R, np.pi / 3, R, tau))

    assert neighbours(49.5).curvature == pytest.approx(neighbours(-49.5).curvature, rel=1e-5)
    assert neighbours(0.0).curvature == pytest.approx(2 / R, rel=1e-6)
    assert abs(neighbours(49.5).curvature - 2 / R) > 10 * abs(neighbours(5.0).curvature - 2 / R)


@pytest.mark.parametrize("force", [-1.0, float("nan")])
def test_force_must_press(force):
    with pytest.raises(GeometryError, match="zero or more"):
        hertz_half_width(force, LineContact(1000.0, 1.0), STEEL, STEEL)


def test_hollow_gap_is_refused():
    with pytest.raises(GeometryError, match="do not touch along one line"):
        hertz_half_width(1.0, LineContact(-1.0, 1.0), STEEL, STEEL)

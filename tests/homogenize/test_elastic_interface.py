"""An elastic interface lies between frictionless and bonded, and a thin layer is one."""

import dataclasses

import numpy as np
import pytest
from section_meshes import rings, wire_trace
from wire_in_rod import wire_in_rod

from geometry.errors import ConvergenceError, SpecError
from homogenize import check_cell, pitch_average, solve_helical_cell
from homogenize.elastic_interface import Elastic
from homogenize.interface_choice import Interfaces


def elastic(mesh, k):
    return solve_helical_cell(mesh, Interfaces({"conductor-insulation": Elastic(k)}))


def test_the_limits_are_frictionless_and_bonded():
    """k_t -> 0 and k_t -> infinity, all 36 entries, with an error in proportion to k_t and 1 / k_t."""
    mesh = wire_in_rod()
    F0, F1 = (solve_helical_cell(mesh, word).stiffness.compliance for word in ("frictionless", "bonded"))
    scale = np.sqrt(np.outer(np.diag(F1), np.diag(F1)))
    soft = [np.abs((elastic(mesh, k).stiffness.compliance - F0) / scale).max() for k in (1e-8, 1e-7)]
    hard = [np.abs((elastic(mesh, k).stiffness.compliance - F1) / scale).max() for k in (1e7, 1e6)]
    assert soft[0] < 1e-4 and hard[0] < 1e-5
    assert 7 < soft[1] / soft[0] < 13 and 7 < hard[1] / hard[0] < 13


def test_a_straight_cable_bends_as_if_bonded_however_soft_the_interface():
    """Without lay a constant moment makes no slip: EI does not see k_t; without any stiffness the slip has no steady state."""
    mesh = wire_in_rod(straight=True)
    bonded = solve_helical_cell(mesh).stiffness
    for k in (1e-3, 1.0):
        assert elastic(mesh, k).stiffness.EI_x == pytest.approx(
            bonded.EI_x, rel=2e-2
        )  # the section keeps its shape less well
        assert elastic(mesh, k).stiffness.GA_x < bonded.GA_x
    with pytest.raises(ConvergenceError, match="slides along the cable without resistance"):
        solve_helical_cell(mesh, "frictionless")


def test_stiffness_rises_with_the_interface():
    """EA, GJ and EI grow with k_t, and the cell keeps its checks."""
    mesh = wire_in_rod()
    cells = [elastic(mesh, k) for k in (1e-2, 1e-1, 1.0)]
    for name in ("EA_blocked_twist", "GJ", "EI_x"):
        values = [getattr(pitch_average(cell.stiffness), name) for cell in cells]
        assert values == sorted(values) and values[0] < values[2], name
    assert all(check.holds for check in check_cell(mesh, cells[1]))


def test_twisting_a_tube_on_a_core_through_an_elastic_interface_is_bonded():
    """Straight and round, core and tube twist alike: no slip arises, and GJ is the sum of G J whatever k_t."""
    a, b = 0.5, 1.0
    mesh = rings((a, b), (10.0, 0.3), (1.0, 0.3), per_ring=2, around=24)
    mesh = dataclasses.replace(mesh, regions=(mesh.regions[0], dataclasses.replace(mesh.regions[1], kind="sheath")))
    expected = np.pi / 2 * (10.0 * a**4 + b**4 - a**4) / 2.6
    for k in (1e-3, 1.0):
        assert elastic(mesh, k).stiffness.GJ == pytest.approx(expected, rel=3e-4)  # area of the quadratic outline


def test_bending_through_an_elastic_interface_is_the_shear_beam():
    """A straight core slipping along z in a tube: under bending no slip arises along z on the axis, EI is the sum; GA is softer."""
    mesh = rings((0.5, 1.0), (10.0, 0.0), (1.0, 0.0), per_ring=2, around=24)
    mesh = dataclasses.replace(mesh, regions=(mesh.regions[0], dataclasses.replace(mesh.regions[1], kind="sheath")))
    EI = np.pi / 4 * (10.0 * 0.5**4 + 1.0 - 0.5**4)
    stiffness = [elastic(mesh, k).stiffness for k in (1e-2, 1.0)]
    for s in stiffness:
        assert s.EI_x == pytest.approx(EI, rel=3e-4)
    assert stiffness[0].GA_x < stiffness[1].GA_x


def test_a_thin_soft_layer_is_an_elastic_interface():
    """A layer of thickness h and shear modulus G between wire and rod acts as k_t = G / h:
    EA, GJ and EI within a tenth of what slip can change."""
    beta, a, h = np.radians(30.0), 0.5, 0.02
    thick = wire_in_rod(beta=beta, around=32)
    k = 0.5
    nu = 0.4999  # as good as rigid across the layer
    E = 2 * (1 + nu) * k * h
    tau = np.tan(beta) / 3.0
    trace = wire_trace(a, 3.0, tau)

    def shape(rho, phi):
        if rho <= a + h:
            return trace(rho, phi)
        x, y = trace(a + h, phi)
        along = 3.0 * np.cos(phi)
        t = -along + np.sqrt(along**2 - 9.0 + 25.0)
        s = ((rho - a - h) / (5.0 - a - h)) ** 1.5
        return (1 - s) * x + s * (3.0 + t * np.cos(phi)), (1 - s) * y + s * t * np.sin(phi)

    thin = rings((a, a + h, 5.0), (10.0, 0.3), (E, nu), (1.0, 0.3), per_ring=2, around=32, twist_rate=tau, shape=shape)
    layered = pitch_average(solve_helical_cell(thin).stiffness)
    jump = pitch_average(elastic(thick, k).stiffness)
    bonded, free = (pitch_average(solve_helical_cell(thick, word).stiffness) for word in ("bonded", "frictionless"))
    for name in ("EA_blocked_twist", "GJ", "EI_x"):
        b, f, layer, elast = (getattr(s, name) for s in (bonded, free, layered, jump))
        assert abs(layer - elast) < 0.1 * (b - f), name
        assert f + 0.1 * (b - f) < elast < b - 0.1 * (b - f), name


def test_a_negative_stiffness_is_refused():
    with pytest.raises(SpecError, match="zero or a positive number"):
        Elastic(-1.0)

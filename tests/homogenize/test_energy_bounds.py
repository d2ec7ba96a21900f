"""Bounds, reciprocity and energy balance: checks that run with every result, and that catch a wrong one."""

import dataclasses

import numpy as np
from section_meshes import rings

from homogenize import axial_bounds, check_cell, solve_helical_cell


def three_layers(twist_rate=1.5):
    return rings((0.3, 0.6, 1.0), (100.0, 0.34), (1.0, 0.49), (10.0, 0.45), twist_rate=twist_rate)


def test_all_checks_hold_on_a_sound_cell():
    mesh = three_layers()
    checks = check_cell(mesh, solve_helical_cell(mesh))
    assert [c.name for c in checks] == ["lower bound", "upper bound", "reciprocity", "energy = work", "equilibrium"]
    assert all(c.holds for c in checks), checks


def test_bounds_close_on_one_material():
    """Both bounds are E A when there is one material."""
    mesh = rings((1.0,), (5.0, 0.4))
    cell = solve_helical_cell(mesh)
    np.testing.assert_allclose(axial_bounds(mesh, cell), 5.0 * cell.field.area, rtol=1e-12)


def test_a_wrong_warping_field_is_caught():
    """Scaling the warping by 1 % breaks energy = work or reciprocity."""
    mesh = rings((0.3, 0.6, 1.0), (100.0, 0.34), (1.0, 0.49), (10.0, 0.45), centre=(0.2, 0.0), twist_rate=1.5)
    cell = solve_helical_cell(mesh)
    wrong = dataclasses.replace(cell, X=1.01 * cell.X)
    assert not all(c.holds for c in check_cell(mesh, wrong))


def test_an_axial_stiffness_below_the_straight_core_is_caught():
    """EA below E_c A_c is wrong whatever the contact law."""
    mesh = three_layers()
    cell = solve_helical_cell(mesh)
    weak = dataclasses.replace(cell, stiffness=type(cell.stiffness)(0.5 * cell.stiffness.C, cell.stiffness.area))
    assert not check_cell(mesh, weak)[0].holds

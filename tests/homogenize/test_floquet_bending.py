"""Bending and shear of the three-dimensional cell are Floquet problems: equal to the section problem, whatever the cell's height."""

import numpy as np
import pytest
from section_meshes import linear, rectangle, rings, swept

from homogenize import pitch_average, solve_helical_cell, solve_periodic_cell
from homogenize.floquet_load import load_groups, macroscopic_fields

RATE = 0.5


def lay(n, rate=RATE):
    """A stiff eccentric trace in soft rubber, drawn as a ring mesh whose inner region is stiff."""
    return rings(
        (0.4, 1.0), (100.0, 0.3), (1.0, 0.45), per_ring=2 * n, around=12 * n, centre=(0.3, 0.0), twist_rate=rate
    )


def scaled(C, reference):
    return C / np.sqrt(np.outer(np.diag(reference), np.diag(reference)))


def test_the_whole_6x6_converges_to_that_of_the_section():
    """All 36 entries, shear and its coupling to bending (T_x with M_x) included, at second order."""
    exact = pitch_average(solve_helical_cell(lay(4)).stiffness).C
    errors = []
    for n in (1, 2, 3):
        C = solve_periodic_cell(swept(linear(lay(n)), 0.2 / n, 1), bending=True).section.C
        errors.append(np.abs(scaled(C - exact, exact)).max())
    assert errors[-1] < 0.012
    assert np.log(errors[1] / errors[2]) / np.log(1.5) > 1.6, errors


@pytest.mark.parametrize("turn", [np.pi, 2 * np.pi], ids=["half a turn", "a whole turn"])
def test_cells_of_any_height_agree(turn):
    """Complex bending of a thin slice, real bending of half a pitch (factor -1), all loads together on a whole pitch (factor 1)."""
    layers = 24 if turn > 4 else 12
    section = linear(lay(1))
    thickness = turn / RATE / layers
    thin = solve_periodic_cell(swept(section, thickness, 1), bending=True, tolerance=1e-11).section.C
    tall = solve_periodic_cell(swept(section, turn / RATE, layers), bending=True, tolerance=1e-11).section.C
    np.testing.assert_allclose(
        scaled(tall, thin), scaled(thin, thin), atol=2e-3
    )  # shear: the moment varies inside a layer
    axial = np.ix_([2, 3, 4, 5], [2, 3, 4, 5])
    F, f = np.linalg.inv(tall)[axial], np.linalg.inv(thin)[axial]
    np.testing.assert_allclose(scaled(F, f), scaled(f, f), atol=1e-7)


def test_a_straight_unsymmetric_section_couples_all_loads():
    """Without lay: stretch with bending, shear with twist, as in the section problem."""
    bimaterial = ((1.0, 0.3), (4.0, 0.2))
    exact = solve_helical_cell(rectangle(12, 16, 1.0, 2.0, *bimaterial, split_x=0.0)).stiffness.C
    assert abs(scaled(exact, exact)[2, 4]) > 0.3
    errors = []
    for n in (1, 2):
        mesh = swept(rectangle(6 * n, 10 * n, 1.0, 2.0, *bimaterial, split_x=0.0), 0.1 / n, 1)
        C = solve_periodic_cell(mesh, bending=True).section.C
        errors.append(np.abs(scaled(C - exact, exact)).max())
    assert errors[1] < 0.02, errors
    assert errors[0] / errors[1] > 3, errors


def test_the_mirror_image_changes_the_sign_of_the_chiral_entries():
    """N-M_z and T_x-M_x are odd in the hand of the lay, the diagonal is even."""
    right, left = (
        solve_periodic_cell(swept(linear(lay(2, rate)), 0.1, 1), bending=True, tolerance=1e-11).section.C
        for rate in (RATE, -RATE)
    )
    np.testing.assert_allclose(np.diag(left), np.diag(right), rtol=1e-4)  # the diagonals of the wedges are not mirrored
    for i, j in ((2, 5), (0, 3), (1, 4)):
        assert abs(scaled(right, right)[i, j]) > 5e-3
        assert left[i, j] == pytest.approx(-right[i, j], rel=0.02)


@pytest.mark.parametrize("angle", [0.0, 0.8, np.pi, -1.1])
@pytest.mark.parametrize("order", [1, 2])
def test_macroscopic_fields_repeat_with_the_factor_of_their_group(angle, order):
    """The strain of the next cell is s Q (strain) Q^T, and for fields of second order that plus H times the first-order one."""
    Q = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1.0]])
    H, x = 0.7, np.array([0.3, -0.2, 0.4])
    for group in load_groups(angle, True):
        here, there = (_strain(group.forces, p, order) for p in (x, Q @ x + [0, 0, H]))
        if order == 2:
            here = here + H * _strain(group.forces, x, 1)
        np.testing.assert_allclose(there, group.factor * np.einsum("ij,mjk,lk->mil", Q, here, Q), atol=1e-9)


def _strain(loads, x, order, h=1e-5):
    """Central differences of the displacement, exact for polynomials of second degree and to 1e-11 for third."""
    steps = np.concatenate([x + h * np.eye(3), x - h * np.eye(3)])
    u = macroscopic_fields(steps, loads, order).reshape(loads.shape[1], 2, 3, 3)
    gradient = (u[:, 0] - u[:, 1]) / (2 * h)  # (m, x, component)
    return 0.5 * (gradient + gradient.transpose(0, 2, 1))

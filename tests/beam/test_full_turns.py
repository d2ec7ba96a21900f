"""Rotations past a full turn: the other branch of the rotation vector is the same rotation, and a rod does not notice it."""

import numpy as np
import pytest

from beam.element import reference_strains
from beam.rod import GAUSS_X, Rod
from beam.rod_model import Blocks, RodModel, Support
from beam.rotation_vector import (
    LARGEST_ROTATION,
    accelerate_on_branch,
    force_on_branch,
    move_on_branch,
    rotation_matrix,
    turn_back,
)
from beam.section_force import nodal_section_forces
from beam.shape import straight, strands_and_arcs
from beam.statics import equilibrium
from homogenize.section_stiffness import SectionInertia, SectionStiffness

SECTION = SectionStiffness.uncoupled(EA=1e4, GA_x=1e4, GA_y=1e4, EI_x=2.0, EI_y=2.0, GJ=1.0, area=1e-3)
INERTIA = SectionInertia(1.0, 1e-2, 1e-2, 1e-2)


def motion_of(t, h=1e-4):
    """A rotation vector as a function of time t and arc length s, its slope and the rates by differences."""

    def theta(t, s):
        return np.array([2.0 + 0.5 * t + s, 2.5 - 0.3 * t * t + 0.2 * s * t, -1.6 + 0.8 * t * s + 0.4 * s * s])

    def slope(t):
        return (theta(t, h) - theta(t, -h)) / (2 * h)

    return theta(t, 0.0), slope(t)


def test_the_other_branch_is_the_same_rotation_with_all_derivatives():
    """G and its chain rule, against central differences in time of the vector and its slope (1e-6 from the differences)."""
    h = 1e-3
    before, here, after = (motion_of(t) for t in (0.3 - h, 0.3, 0.3 + h))
    rates = [(after[k] - before[k]) / (2 * h) for k in range(2)]
    accelerations = [(after[k] - 2 * here[k] + before[k]) / h**2 for k in range(2)]

    def star(pair):
        theta, slope = pair[0].copy(), pair[1].copy()
        move_on_branch(theta, slope, np.zeros(3), np.zeros(3))
        return theta, slope

    b, m, a = star(before), star(here), star(after)
    np.testing.assert_allclose(rotation_matrix(m[0]), rotation_matrix(here[0]), rtol=0, atol=1e-14)
    theta, slope, rate, slope_rate = here[0].copy(), here[1].copy(), rates[0].copy(), rates[1].copy()
    second = [x.copy() for x in accelerations]
    accelerate_on_branch(theta, slope, rate, slope_rate, *second)
    move_on_branch(theta, slope, rate, slope_rate)
    np.testing.assert_allclose(rate, (a[0] - b[0]) / (2 * h), rtol=0, atol=2e-6)
    np.testing.assert_allclose(slope_rate, (a[1] - b[1]) / (2 * h), rtol=0, atol=2e-6)
    np.testing.assert_allclose(second[0], (a[0] - 2 * m[0] + b[0]) / h**2, rtol=0, atol=2e-5)
    np.testing.assert_allclose(second[1], (a[1] - 2 * m[1] + b[1]) / h**2, rtol=0, atol=2e-5)


def test_power_is_the_same_on_both_branches():
    """f* . theta*_dot + m* . theta*'_dot = f . theta_dot + m . theta'_dot: the force is taken back by the transposed map."""
    rng = np.random.default_rng(1)
    theta, slope = np.array([3.0, 2.0, -1.0]), rng.normal(size=3)
    rate, slope_rate, force, moment = rng.normal(size=(4, 3))
    t, s, r, q = theta.copy(), slope.copy(), rate.copy(), slope_rate.copy()
    move_on_branch(t, s, r, q)
    power = force @ r + moment @ q
    force_on_branch(theta, slope, force, moment)
    assert force @ rate + moment @ slope_rate == pytest.approx(power, rel=1e-13)


def strains(q, lengths):
    E = np.zeros((len(lengths), 3, 6))
    reference_strains(np.ascontiguousarray(q), lengths, GAUSS_X, E)
    return E


def test_plane_strains_do_not_notice_the_switch():
    """An arc that winds three times: nodes on different branches, strains to round-off; 1e-12 of the curvature."""
    s = np.linspace(0.0, 3.0, 61)
    q = strands_and_arcs(s, [(3.0, 2 * np.pi)])
    turned = q.copy()
    zero = np.zeros_like(q)
    assert turn_back(turned, zero, zero, zero) > 40
    assert np.linalg.norm(turned[:, 6:9], axis=1).max() <= LARGEST_ROTATION
    np.testing.assert_allclose(strains(turned, np.diff(s)), strains(q, np.diff(s)), rtol=0, atol=1e-11)
    S = strains(q, np.diff(s))
    local, _ = nodal_section_forces(turned, np.diff(s), S)
    np.testing.assert_allclose(local, nodal_section_forces(q, np.diff(s), S)[0], rtol=0, atol=1e-10)


def space_jump(elements):
    """Largest change of curvature by the switch of one node in the middle of a bent and twisted rod."""
    s = np.linspace(0.0, 1.0, elements + 1)
    q = straight(s)
    u = np.stack([np.sin(s), np.cos(2 * s), 1.0 + 0.3 * s], axis=1)
    du = np.stack([np.cos(s), -2 * np.sin(2 * s), 0.3 + 0 * s], axis=1)
    q[:, 6:9], q[:, 9:12] = 2.2 * u, 2.2 * du
    turned = q.copy()
    middle = slice(elements // 2, elements // 2 + 1)
    move_on_branch(turned[middle, 6:9][0], turned[middle, 9:12][0], np.zeros(3), np.zeros(3))
    return np.abs(strains(turned, np.diff(s)) - strains(q, np.diff(s)))[:, :, 3:].max()


def test_space_strains_change_by_the_error_of_interpolation():
    """Interpolation is not objective, nor is it the same on both branches: the difference falls with order 3 or better."""
    coarse, middle, fine = (space_jump(n) for n in (16, 32, 64))
    assert fine < 2e-3
    assert coarse / middle > 7 and middle / fine > 7


def test_tangent_of_an_element_on_two_branches():
    """The tangent is the derivative of the force there as well: 2e-6 of the largest entry."""
    rod = Rod.straight(0.5, 2, SECTION, INERTIA)
    model = RodModel(rod, straight(rod.s))
    q = straight(rod.s)
    rng = np.random.default_rng(5)
    q[:, 6:9] = [2.2, 2.3, -1.4]
    q += 0.05 * rng.normal(size=q.shape)
    v, a = 0.1 * rng.normal(size=q.shape), 0.1 * rng.normal(size=q.shape)
    move_on_branch(q[1, 6:9], q[1, 9:12], v[1, 6:9], v[1, 9:12])
    blocks = Blocks.zeros(3)
    model.forces(0.0, q, v, [], blocks=blocks, factor=7.0, a=a, factor_a=30.0)
    A = np.zeros((3, 12, 3, 12))
    for i in range(3):
        A[i, :, i] = blocks.D[i]
    for i in range(2):
        A[i, :, i + 1], A[i + 1, :, i] = blocks.U[i], blocks.L[i]
    expected = np.empty((36, 36))
    for k in range(36):
        d = 1e-6 * np.eye(36)[k].reshape(3, 12)
        plus = model.forces(0.0, q + d, v + 7 * d, [], a=a + 30 * d).F
        expected[:, k] = ((plus - model.forces(0.0, q - d, v - 7 * d, [], a=a - 30 * d).F) / 2e-6).ravel()
    np.testing.assert_allclose(A.reshape(36, 36), expected, rtol=0, atol=2e-6 * np.abs(expected).max())


@pytest.mark.parametrize("turns", [1, 2])
def test_cantilever_winds_up_in_full_circles(turns):
    """An end moment 2 pi EI k / L winds it into k circles: the tip comes back to the clamp, within 1 mm at 24 elements."""
    rod = Rod.straight(1.0, 24, SECTION, INERTIA)
    load = np.zeros((25, 12))
    load[-1, 8] = 2 * np.pi * turns * 2.0
    start = strands_and_arcs(rod.s, [(1.0, 0.9 * 2 * np.pi * turns)])
    result = equilibrium(RodModel(rod, start, [Support(0)], load=load))
    result.outcome.require_success()
    np.testing.assert_allclose(result.q[-1, 0:2], 0.0, rtol=0, atol=1e-3)
    np.testing.assert_allclose(result.forces.S[:, :, 5], load[-1, 8], rtol=1e-2)

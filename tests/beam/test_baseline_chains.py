"""Baselines of the comparison of methods: what chains of rigid links and of modal bodies get right and wrong, in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from beam.modal_body_chain import ModalChain, ModalMotion, clamped_free_modes, modal_equilibrium
from beam.rigid_link_chain import cantilever_of_links, pin_forces
from beam.statics import equilibrium
from homogenize.section_stiffness import SectionInertia, SectionStiffness

EI, LENGTH = 50.0, 2.0
SECTION = SectionStiffness.uncoupled(EA=3e5, GA_x=1e5, GA_y=1e5, EI_x=EI, EI_y=EI, GJ=30.0, area=2e-3)
INERTIA = SectionInertia.solid_circle(10.0, 0.05)


def test_rigid_links_turn_exactly_and_lie_on_a_circle_that_is_too_wide():
    """theta = M l / EI from link to link; the pins' radius is l / (2 sin theta/2), theta^2 / 24 more than EI / M."""
    n, M = 6, np.pi * EI / LENGTH
    model = cantilever_of_links(LENGTH, n, SECTION, INERTIA, M)
    state = equilibrium(model)
    rows = [model.row(f"link {k}") for k in range(n)]
    theta = M * LENGTH / n / EI
    assert np.diff(state.q[rows, 8]) == pytest.approx(theta, rel=1e-8)
    _, moment = pin_forces(model, 0.0, state.q, np.zeros_like(state.q))
    assert moment == pytest.approx(-M, rel=1e-8) or moment == pytest.approx(M, rel=1e-8)
    middles = state.q[rows, :2]
    chord = np.linalg.norm(np.diff(middles, axis=0), axis=1)
    assert chord == pytest.approx(LENGTH / n * np.cos(0.5 * theta), rel=1e-6)


def test_clamped_free_modes_are_orthogonal_and_free_at_the_tip():
    """Integral Y_i Y_j = l delta_ij; the first tip value is 2."""
    x, w = np.polynomial.legendre.leggauss(40)
    Y, slope = clamped_free_modes(0.75 * (x + 1), 1.5, 4)
    assert (Y * 0.75 * w) @ Y.T == pytest.approx(1.5 * np.eye(4), abs=1e-9)
    h = 1e-6
    ends = [clamped_free_modes(np.array([0.7 + d]), 1.5, 4)[0][:, 0] for d in (-h, h)]
    assert (ends[1] - ends[0]) / (2 * h) == pytest.approx(
        clamped_free_modes(np.array([0.7]), 1.5, 4)[1][:, 0], rel=1e-7
    )
    assert slope.shape == (4, 40)


@pytest.mark.parametrize("modes", [1, 3])
def test_modal_bodies_bend_by_the_share_of_their_modes_and_do_not_shorten(modes):
    """Under an end moment each turns by sum Y'(l)^2 / k, 61.3 % of M l/EI with one mode, and keeps its projection l on its frame."""
    n, M = 4, 0.5 * np.pi * EI / LENGTH
    l = LENGTH / n
    chain = ModalChain(n, l, EI, 10.0, (1e7, 1e7, 1e8), modes, end_moment=M)
    X = np.zeros((n, chain.size))
    X[:, 0] = l * np.arange(n)
    X = modal_equilibrium(chain, X, 1e-5).X
    share = float((chain.tip_slope**2 / chain.modal_stiffness).sum()) * EI / l
    assert share == pytest.approx({1: 0.6131, 3: 0.8661}[modes], abs=1e-4)
    assert np.diff(X[:, 2]) == pytest.approx(share * M * l / EI, rel=1e-5)
    sag = float((chain.tip_slope * chain.tip / chain.modal_stiffness).sum()) * M
    assert np.linalg.norm(np.diff(X[:, :2], axis=0), axis=1) == pytest.approx(np.hypot(l, sag), rel=1e-6)


def test_a_modal_body_swings_as_its_mode_and_falls_freely():
    """First natural frequency beta^2 sqrt(EI/m) of a clamped segment; a free one falls by g t^2/2."""
    far = (1e8, 1e8, 1e8)
    chain = ModalChain(1, 1.0, EI, 10.0, far, modes=1, gravity=(0.0, -1.0))
    omega = 1.8751040687**2 * np.sqrt(EI / 10.0)
    motion = ModalMotion(chain, np.zeros((1, 4)), np.zeros((1, 4)))
    motion.advance(np.pi / omega, np.pi / omega / 300, 1e-7)
    # started at rest under its weight, it comes to twice the static deflection after half a period
    static = -float((10.0 * chain.weights * chain.Y[0]).sum() / chain.modal_stiffness[0])
    assert motion.X[0, 3] == pytest.approx(2 * static, rel=0.02)  # numerical damping of gamma = 0.6
    free = ModalChain(1, 1.0, EI, 10.0, (0.0, 0.0, 0.0), modes=2, gravity=(0.0, -9.81))
    motion = ModalMotion(free, np.zeros((1, 5)), np.zeros((1, 5)))
    motion.A[0, 1] = -9.81
    motion.advance(0.04, 1e-3, 1e-7)
    assert motion.X[0, 1] == pytest.approx(-9.81 * 0.04**2 / 2, rel=1e-6)

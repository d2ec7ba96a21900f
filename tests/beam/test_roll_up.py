"""A cantilever under an end moment M bends into an arc of radius EI/M: order of convergence, and section forces."""

import numpy as np
import pytest

from beam.hermite import hermite
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import straight
from beam.statics import equilibrium
from homogenize.section_stiffness import SectionInertia, SectionStiffness

INERTIA = SectionInertia(1.0, 1e-3, 1e-3, 2e-3)


def rolled(elements: int, length: float, EA: float, GA: float, EI: float, moment: float):
    section = SectionStiffness.uncoupled(EA=EA, GA_x=GA, GA_y=GA, EI_x=EI, EI_y=EI, GJ=EI, area=1.0)
    rod = Rod.straight(length, elements, section, INERTIA)
    load = np.zeros((rod.nodes, 12))
    load[-1, 8] = moment
    result = equilibrium(RodModel(rod, straight(rod.s), [Support(0)], load=load))
    result.outcome.require_success()
    return result


def tip_error(elements: int) -> float:
    tip = rolled(elements, 1.0, 1e4, 1e4, 2.0, 2 * np.pi).q[-1, :2]
    return float(np.hypot(tip[0], tip[1] - 2 / np.pi))


def test_half_circle_with_order_above_four_and_a_half():
    """M = pi EI/L gives the tip (0, 2L/pi); cubic Hermite fields converge with order 5 to 6."""
    errors = [tip_error(n) for n in (4, 8, 16)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (orders > 4.2).all() and orders[-1] > 4.5
    assert errors[-1] < 2.5e-6  # 1.9e-6 m was found for the same element by an independent prototype


@pytest.mark.parametrize(("elements", "N_bound", "Q_bound"), [(8, 4.5, 2.0), (16, 0.5, 0.25), (32, 0.05, 0.03)])
def test_pure_bend_has_moment_only(elements, N_bound, Q_bound):
    """R = 0.4 m, EI = 124 N m2: M = 310 N m; N and Q vanish. Bounds: prototype 3.5/1.4, 0.35/0.17, 0.03/0.02 N, + 40 %."""
    EI, R = 124.0, 0.4
    S = rolled(elements, np.pi * R, 4.71e5, 3.5e3, EI, EI / R).forces.S
    assert np.abs(S[:, :, 0]).max() < N_bound
    assert np.abs(S[:, :, 1:3]).max() < Q_bound
    np.testing.assert_allclose(S[:, :, 5], EI / R, rtol=1e-2 * (8 / elements) ** 2)


def test_hermite_functions_reproduce_a_cubic():
    """The shape functions carry (value, slope) of any cubic exactly."""
    length, N, dN = 0.7, np.zeros(4), np.zeros(4)
    cubic = np.polynomial.Polynomial([0.3, -1.0, 2.0, 0.8])
    nodal = [cubic(0.0), cubic.deriv()(0.0), cubic(length), cubic.deriv()(length)]
    hermite(0.37, length, N, dN)
    np.testing.assert_allclose(N @ nodal, cubic(0.37 * length), rtol=1e-13)
    np.testing.assert_allclose(dN @ nodal, cubic.deriv()(0.37 * length), rtol=1e-13)

"""A heavy, limp, nearly inextensible cable between two points hangs in a catenary y = a cosh(x/a)."""

import numpy as np
import pytest
from scipy.optimize import brentq

from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import strands_and_arcs
from beam.statics import equilibrium
from homogenize.section_stiffness import SectionInertia, SectionStiffness

SPAN, LENGTH, WEIGHT = 8.0, 10.0, 98.1
SECTION = SectionStiffness.uncoupled(EA=1e8, GA_x=1e6, GA_y=1e6, EI_x=0.02, EI_y=0.02, GJ=0.02, area=1e-3)


def hanging(elements: int):
    """Start from the circular arc of the same length and span."""
    half = float(np.asarray(brentq(lambda x: np.sin(x) / x - SPAN / LENGTH, 0.1, 3.0)))
    rod = Rod.straight(LENGTH, elements, SECTION, SectionInertia(10.0, 1e-3, 1e-3, 2e-3))
    start = strands_and_arcs(rod.s, [(LENGTH, 2 * half / LENGTH)], angle=-half)
    model = RodModel(rod, start, [Support(0, ("r",)), Support(-1, ("r",))], gravity=(0.0, -9.81, 0.0))
    result = equilibrium(model)
    result.outcome.require_success()
    return rod, result


@pytest.fixture(scope="module")
def solution():
    return hanging(80)


@pytest.fixture(scope="module")
def parameter():
    """a from 2 a sinh(span/(2 a)) = length."""
    return float(np.asarray(brentq(lambda a: 2 * a * np.sinh(SPAN / (2 * a)) - LENGTH, 0.5, 100.0)))


def test_sag(solution, parameter):
    """Sag a (cosh(span/2a) - 1); the bending stiffness rounds the ends by sqrt(EI/H) = 8 mm, so 0.1 %."""
    _, result = solution
    sag = parameter * (np.cosh(SPAN / (2 * parameter)) - 1)
    np.testing.assert_allclose(-result.q[40, 1], sag, rtol=1e-3)


def test_horizontal_force_and_end_reaction(solution, parameter):
    """H = w a everywhere, and each support carries half the weight (exact)."""
    _, result = solution
    F = result.forces.F
    np.testing.assert_allclose([-F[0, 0], F[-1, 0]], WEIGHT * parameter, rtol=2e-3)
    np.testing.assert_allclose(F[[0, -1], 1], WEIGHT * LENGTH / 2, rtol=1e-6)


def test_halves_agree(solution):
    """The left half mirrors the right half."""
    _, result = solution
    r = result.q[:, 0:2]
    mirrored = np.column_stack([SPAN - r[::-1, 0], r[::-1, 1]])
    np.testing.assert_allclose(r, mirrored, rtol=0, atol=1e-6)

"""A flexible pendulum that swings from the horizontal: tip positions of two independent codes.

L 1.2 m, A 18 cm2, I 1.215e-8 m4, 5540 kg/m3, E 7 MPa, G = E/2.6, shear factor 5/6. Reference: prototype of the same
element, n 32, h 0.125 ms; Exudyn 1.13.6 ANCF cable (no shear), n 64, agrees to 4e-4; 2026-11.
"""

import numpy as np
import pytest

from beam.generalized_alpha import Integrator, StepSettings
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import straight
from homogenize.section_stiffness import SectionInertia, SectionStiffness

A, I, RHO, E = 0.0018, 1.215e-8, 5540.0, 7e6


def pendulum(elements: int, E: float = E) -> RodModel:
    G = E / 2.6
    section = SectionStiffness.uncoupled(
        EA=E * A, GA_x=5 / 6 * G * A, GA_y=5 / 6 * G * A, EI_x=E * I, EI_y=E * I, GJ=2 * G * I, area=A
    )
    rod = Rod.straight(1.2, elements, section, SectionInertia(RHO * A, RHO * I, RHO * I, 2 * RHO * I))
    return RodModel(rod, straight(rod.s), [Support(0, ("r",))], gravity=(0.0, -9.81, 0.0))


def swing(model: RodModel, h: float, end: float, rho: float = 0.8, tight: bool = False) -> Integrator:
    relative, absolute = (1e-12, 1e-9) if tight else (1e-6, 1e-3)
    settings = StepSettings(h, spectral_radius=rho, adaptive=False, relative=relative, absolute=absolute)
    motion = Integrator(model, model.q0, settings=settings)
    assert motion.advance(round(end / h)), str(motion.outcome)
    return motion


def test_tip_of_two_codes():
    """Within 3e-4 m up to 0.6 s."""
    model = pendulum(16)
    motion = swing(model, 2.5e-4, 0.2)
    found = [motion.q[-1, :2].copy()]
    for _ in range(2):
        motion.advance(800)
        found.append(motion.q[-1, :2].copy())
    expected = [(1.14692, -0.19654), (0.75186, -0.77957), (-0.54415, -0.96854)]
    np.testing.assert_allclose(found, expected, rtol=0, atol=3e-4)
    assert abs(motion.ledger.balance_error) < 1e-4


@pytest.mark.parametrize("rho", [0.6, 1.0])
def test_generalised_alpha_is_of_second_order(rho):
    """Error of the tip at 0.2 s against a step twenty times finer: slope between 1.8 and 2.2."""
    model = pendulum(3)
    reference = swing(model, 2.5e-5, 0.2, rho, tight=True).q[-1, :2]
    errors = [np.linalg.norm(swing(model, h, 0.2, rho, tight=True).q[-1, :2] - reference) for h in (2e-3, 1e-3, 5e-4)]
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert ((slopes > 1.8) & (slopes < 2.2)).all(), slopes


def test_spectral_radius_sets_the_coefficients():
    """rho = 1 is the trapezoidal rule in disguise (beta 1/4, gamma 1/2); rho = 0 damps high frequencies at once."""
    assert StepSettings(spectral_radius=1.0).coefficients == pytest.approx((0.5, 0.5, 0.5, 0.25))
    assert StepSettings(spectral_radius=0.0).coefficients == pytest.approx((-1.0, 0.0, 1.5, 1.0))

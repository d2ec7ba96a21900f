"""Towing round a roller against an independent prototype of the same element: pull force after 5 s.

16 m of cable, 65 mm, EA 471.2 kN, EI 124.4 N m2, 10 kg/m, half circle of 0.4 m round a frictionless roller, trough friction
0.3; the end is pulled with 0.3 m/s (ramp 0.5-1.5 s), the roller follows with 0.49 of it. Reference (2026-11): 1252.9 N with
GA 200 kN (n 200 and 400), 891.9 N with GA 3.5 kN. The reference does not state its roller's contact stiffness, on which
the force depends (1157 N at 1.25, 1242 N at 2.5, 1329 N at 12.5 MN/m2). 2.9 MN/m2 was chosen such that the first number is met;
the second one then is a test.
"""

import numpy as np
import pytest

from beam.generalized_alpha import Integrator, StepSettings
from beam.motion import SpeedRamp
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.section_law import DampingTimes
from beam.shape import strands_and_arcs
from beam.statics import equilibrium
from beam.surface import ContactLaw, Cylinder, Plane
from homogenize.section_stiffness import SectionInertia, SectionStiffness

R, LOWER = 0.4, 8.0


def towing(elements: int, GA: float, ratio: float = 0.49) -> RodModel:
    section = SectionStiffness.uncoupled(EA=4.712e5, GA_x=GA, GA_y=GA, EI_x=124.4, EI_y=124.4, GJ=86.0, area=3.318e-3)
    rod = Rod.straight(16.0, elements, section, SectionInertia(10.0, 0.0026, 0.0026, 0.0052), DampingTimes(5e-3, 2e-2))
    start = strands_and_arcs(rod.s, [(LOWER, 0.0), (np.pi * R, -1 / R), (9.0, 0.0)], angle=np.pi)
    pull, roll = SpeedRamp(0.3, 0.5, 1.5), SpeedRamp(0.3, 0.5, 1.5, ratio=ratio)
    trough = ContactLaw(friction=0.3)
    surfaces = [
        Plane("trough", trough),
        Plane("deck", trough, offset=2 * R, low=(-LOWER, R, -np.inf), box_travel=roll),
        Cylinder("roller", ContactLaw(stiffness=2.9e6), (-LOWER, R, 0.0), R, roll),
    ]
    return RodModel(rod, start, [Support(0), Support(-1, travel=pull)], gravity=(0.0, -9.81, 0.0), surfaces=surfaces)


@pytest.fixture(scope="module")
def runs():
    done = {}
    for GA in (2e5, 3.5e3):
        model = towing(100, GA)
        rest = equilibrium(model)
        rest.outcome.require_success()
        motion = Integrator(model, rest.q, anchors=rest.anchors, settings=StepSettings(5e-3))
        assert motion.advance(1000), str(motion.outcome)
        done[GA] = rest, motion
    return done


@pytest.mark.parametrize(("GA", "expected"), [(2e5, 1252.9), (3.5e3, 891.9)])
def test_pull_force_after_five_seconds(runs, GA, expected):
    """1 % at n = 100, h = 5 ms."""
    np.testing.assert_allclose(runs[GA][1].reaction[-1, 0], expected, rtol=1e-2)


def test_start_is_in_equilibrium(runs):
    """The static start found from strand, arc, strand leaves less than 1e-5 N and 1e-5 N m at every node."""
    for rest, _ in runs.values():
        assert rest.residual_force < 1e-5 and rest.residual_moment < 1e-5


def test_energy_of_the_run_is_closed(runs):
    """Stored + lost = work of shearer and roller, to 1e-3 of the throughput."""
    for _, motion in runs.values():
        assert abs(motion.ledger.balance_error) < 1e-5
        assert motion.ledger.totals["friction_loss"] > 0.3 * motion.ledger.totals["drive_work"]


def test_run_stays_in_its_plane(runs):
    """All three dimensions are computed; without a lateral cause nothing moves across."""
    for _, motion in runs.values():
        assert np.abs(motion.q[:, [2, 5, 6, 7]]).max() < 1e-9


def test_total_force_balance(runs):
    """Supports + contacts + weight = mass times acceleration of the cable, to the solver's tolerance of 1e-2 N."""
    for _, motion in runs.values():
        model = motion.model
        total = (
            motion.reaction[:, 0:3].sum(axis=0) + motion.forces.contact.sum(axis=0) + model.weight[:, 0:3].sum(axis=0)
        )
        np.testing.assert_allclose(total, model.inertia(motion.a)[:, 0:3].sum(axis=0), rtol=0, atol=0.1)

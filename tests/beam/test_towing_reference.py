"""Towing round a roller against an independent prototype of the same element (case D4): force, equilibrium, energy, balance."""

import numpy as np
import pytest

from beam.benchmark_towing import PULL, towed


@pytest.fixture(scope="module")
def runs():
    return {GA: towed(100, GA) for GA in PULL}


@pytest.mark.parametrize(("GA", "expected"), PULL.items())
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

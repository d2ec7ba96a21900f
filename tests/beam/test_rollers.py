"""Cylinders that turn: fixed drum, driven and free roller, with the tensions, the speed and the energies of theory."""

import numpy as np
import pytest

from beam.benchmark_friction import capstan
from beam.benchmark_roller import driven_roller, free_roller


def test_a_fixed_drum_holds_back():
    """Euler, Eytelwein: T2/T1 = exp(mu beta) over a quarter turn; 1 %."""
    assert not [b.sentence() for b in capstan(0.3, np.pi / 2) if not b.passed]


def test_a_driven_roller_pulls():
    """Its surface runs faster than the cable: T2/T1 = exp(-mu beta); the drive's work and the loss are those of the slip."""
    assert not [b.sentence() for b in driven_roller() if not b.passed]


@pytest.mark.parametrize("moment", [0.0, 2.0])
def test_a_free_roller_takes_its_bearing_moment(moment):
    """Steady turning with the cable's speed: T2 = T1 + M/R; without bearing friction T2 = T1."""
    assert not [b.sentence() for b in free_roller(moment) if not b.passed]

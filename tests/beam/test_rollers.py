"""Cylinders that turn: fixed drum, driven and free roller, with the tensions, the speed and the energies of theory."""

import numpy as np
import pytest

from beam import read_scenario, tow
from beam.benchmark_friction import capstan
from beam.benchmark_roller import driven_roller, free_roller
from geometry.errors import SpecError


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


SHORT = {
    "cable__length": "4 m", "cable__elements": 24, "layout__upper_strand": "1.4 m", "layout__slack": "20 mm",
    "time__duration": "0.8 s", "time__frame": "50 ms", "drive__ramp_start": "0 s", "drive__ramp_end": "0.3 s",
}  # fmt: skip


def test_rollers_of_a_scenario():
    """The trolley's roller: turned by the cable at half the shearer's speed; driven; a drum that holds the cable back."""
    base = read_scenario("intelligent-horizontal").changed(**SHORT, roller__friction="0.2")
    free = tow(base.changed(roller__inertia="0.05 kg m^2", roller__bearing_moment="1 N m"))
    assert free.outcome.completed and abs(free.balance_error) < 1e-4
    spin = free.dataset["surface_spin"].sel(surface="roller").values[-4:].mean()
    v = base.drive.speed.value / 2 / base.layout.bend_radius.value
    assert spin == pytest.approx(-v, rel=0.1)  # the short cable does not touch all round
    driven = tow(base.changed(roller__surface_speed="0.3 m/s")).dataset
    assert driven["surface_spin"].sel(surface="roller").values[-1] == pytest.approx(-1.0, rel=1e-9)
    assert driven["surface_slip"].sel(surface="roller").values[-1] == 1.0
    drum = tow(base).dataset
    pulls = [float(x["pull_force"][-1, 0]) for x in (driven, free.dataset, drum)]
    assert pulls[0] < pulls[1] < pulls[2]


def test_a_roller_that_cannot_be_is_a_sentence():
    """Inertia without friction, driven and free at once, a bearing without inertia."""
    base = read_scenario("intelligent-horizontal")
    for given, word in (
        ({"roller__inertia": "1 kg m^2"}, "add roller.friction"),
        ({"roller__friction": "0.2", "roller__inertia": "1 kg m^2", "roller__surface_speed": "1 m/s"}, "not both"),
        ({"roller__friction": "0.2", "roller__bearing_moment": "1 N m"}, "add roller.inertia"),
    ):
        with pytest.raises(SpecError, match=word):
            base.changed(**given)

"""Coupling of tension and torsion: the other load follows the strain; its arm is a length in tension, its inverse in torsion."""

import numpy as np

from effects.effect import BenchPath
from effects.tension_torsion_coupling import CURVED, EFFECT, LINEAR


def test_torque_of_a_stretched_cable():
    """EA = 1.2e6 N, a = 3 mm, strain 0.2 %: 7.2 N m, with the sign of the strain."""
    path = BenchPath("tension", np.array([0.002, -0.002]), None, largest=0.002)
    torque = 1.2e6 * LINEAR.respond(path)[:, 0] * 3e-3
    np.testing.assert_allclose(torque, [7.2, -7.2], rtol=1e-12)
    np.testing.assert_allclose(CURVED.respond(path)[0], 0.002, rtol=1e-14)


def test_acts_on_the_other_load():
    """Its stage is the cross channel, its sign is free, its unit is that of an arm."""
    assert {form.stage for form in EFFECT.forms} == {"cross"}
    strength = LINEAR.strength[0]
    assert strength.low == -np.inf
    assert (strength.unit_for("tension"), strength.unit_for("torsion")) == ("m", "1/m")

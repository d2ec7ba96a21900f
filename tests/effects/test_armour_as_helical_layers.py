"""Layers of wires of a cable file slip and stick as helical layers: each by its own lay."""

import numpy as np
import pytest

from effects.helical_layer import layers_of
from effects.layer_slip import layer_slip
from geometry import read_cable
from geometry.wire_layer import wire_layers


@pytest.mark.parametrize("name", ["spiral-strand-120", "sea-three-core"])
def test_stick_stiffness_is_that_of_every_layer(name):
    """Half the sum of n E A r^2 cos^3 over the layers of wires, each with its own angle; the cores of the sea cable sit soft."""
    cable = read_cable(name)
    expected = {
        layer: 0.5
        * len(w)
        * w[0].material.E
        * np.pi
        * (w[0].outer_radius * w[0].centre_radius) ** 2
        * np.cos(w[0].lay_angle) ** 3
        for layer, w in wire_layers(cable).items()
    }
    found = {one.name: one.stick_stiffness for one in layers_of(cable) if one.name in expected}
    assert found == pytest.approx(expected, rel=1e-12)


def test_tension_is_shared_by_all_layers():
    """EA of the spiral strand is the sum of E A cos^3, 365.8 MN for the published wires (ours lack 0.3 %)."""
    slip = layer_slip(read_cable("spiral-strand-120"), 0.3, 1e5)
    assert pytest.approx(365.8e6, rel=0.004) == slip.EA
    assert len(slip.layers) == 6


def test_outer_layers_press_on_inner_ones():
    """The innermost layer is pressed by all others and slips last at equal friction."""
    slip = layer_slip(read_cable("spiral-strand-120"), 0.3, 1e5)
    pulls = [one.pull for one in sorted(slip.layers, key=lambda one: one.layer.radius)]
    own = [
        one.layer.EA * np.cos(one.layer.lay_angle) ** 2 * 1e5 / slip.EA
        for one in sorted(slip.layers, key=lambda o: o.layer.radius)
    ]
    assert pulls[-1] == pytest.approx(own[-1]) and all(p > 2 * o for p, o in zip(pulls[:3], own[:3], strict=True))

"""Several layers of wires: Cardinal conductor that slips layer by layer (case T7), sea cables in order of magnitude (T10, T11)."""

import dataclasses

import numpy as np
import pytest

from geometry import read_cable
from homogenize.benchmark_layers import (
    CURVE,
    armoured_stiffness,
    bending_moment,
    lay_angles,
    layer_cases,
    own_bending,
    shape_error,
    stick_stiffness,
)


@pytest.mark.parametrize("case", layer_cases(), ids=str)
def test_layered_cable(case):
    """Printed sums and pieces; shape of the published curve within 10 %; EA of sea cables within a factor of 1.3."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]


def test_conductor_goes_from_stick_to_slip():
    """First slope: all layers stick; last slope: none does (1e-9: differences of a piecewise smooth curve); concave between."""
    stick, slip = own_bending(np.cos(lay_angles())) + stick_stiffness().sum(), own_bending(np.cos(lay_angles()))
    assert bending_moment(np.array([1e-4]))[0] == pytest.approx(1e-4 * stick, rel=1e-9)
    far = bending_moment(np.array([1.0, 2.0]))
    assert far[1] - far[0] == pytest.approx(slip, rel=1e-9)
    assert (np.diff(bending_moment(np.linspace(0, 0.6, 60)), 2) < 1e-9).all()


def test_shape_is_blind_to_a_factor_and_sees_a_bend():
    """A multiple has no error; a straight line through the curve's end has a large one."""
    kappa, moment = np.array(CURVE).T
    assert shape_error(3 * moment, moment) < 1e-15
    assert shape_error(kappa, moment) > 0.3


def test_radius_that_gives_way_softens_the_armour():
    """Plastics hold the radius, more or less; very soft ones let the wires straighten, which takes most of their stiffness."""
    cable = read_cable("sea-three-core")

    def plastics(factor):
        parts = tuple(
            p
            if p.kind in ("conductor", "armour")
            else dataclasses.replace(p, material=dataclasses.replace(p.material, E=factor * p.material.E))
            for p in cable.parts
        )
        return armoured_stiffness(dataclasses.replace(cable, parts=parts))

    (held, free), (soft_held, soft) = plastics(1.0), plastics(1e-6)
    assert free < held and soft_held < held
    assert soft < 0.4 * soft_held < 0.5 * free

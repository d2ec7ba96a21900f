"""A strand as a cylinder: fill, density and modulus from the layers of round wires."""

import numpy as np
import pytest

from geometry import GeometryError, Strand
from geometry.strand import layer_radii, stranded_conductor

POWER = Strand("power", 0.49e-3, (3, 9, 15), 40e-3, "Z", 8900.0, 80e9, 0.34)


def test_27_wires_give_the_published_density():
    """D = (5 + 2/sqrt 3) d, fill 27 d^2/D^2 = 0.7128, 6343 kg/m3 published; within 1 kg/m3."""
    assert POWER.diameter == pytest.approx((5 + 2 / np.sqrt(3)) * 0.49e-3, rel=1e-12)
    assert POWER.fill == pytest.approx(27 / (5 + 2 / np.sqrt(3)) ** 2, rel=1e-12)
    assert POWER.density == pytest.approx(6343, abs=1.0)


@pytest.mark.parametrize(
    ("layers", "factor"),
    [((1,), 1), ((2,), 2), ((1, 6), 3), ((1, 6, 12), 5), ((4,), 1 + np.sqrt(2)), ((3, 9), 3 + 2 / np.sqrt(3))],
)
def test_diameter_of_concentric_strands(layers, factor):
    strand = Strand("s", 1.0, layers, None, "Z", 1.0, 1.0, 0.3)
    assert strand.diameter == pytest.approx(factor, rel=1e-12)


def test_other_common_strands_do_not_fit_the_published_density():
    """12 wires (3 + 9): 6187 kg/m3."""
    assert Strand("s", 1.0, (3, 9), None, "Z", 8900.0, 1.0, 0.3).density == pytest.approx(6187, abs=1.0)


def test_lay_factor_is_the_mean_wire_length():
    assert Strand("s", 1e-3, (1, 6), 20e-3, "Z", 1.0, 1.0, 0.3).computed_lay_factor == pytest.approx(
        (1 + 6 * np.hypot(1, 2 * np.pi * 1e-3 / 20e-3)) / 7, rel=1e-12
    )


def test_rope_modulus_of_the_power_conductor():
    """(1 + 6 cos^3 8.49 deg) strands of 80 GPa over a cylinder of 9.05 mm: 60.5 GPa (three digits)."""
    rope = stranded_conductor("power", POWER, (1, 6), 127e-3, "Z", 9.05e-3)
    assert np.degrees(rope.strand_lay_angle) == pytest.approx(8.49, abs=0.005)
    assert pytest.approx(60.5e9, rel=1e-3) == rope.E
    assert rope.density_without_lay == pytest.approx(4931, abs=1)
    assert rope.metal_area == pytest.approx(35.64e-6, rel=1e-4)


def test_straight_strands_lose_nothing():
    """E A of the conductor = sum of E A of the strands."""
    rope = stranded_conductor("earth", POWER, (3,), None, "Z", 6.5e-3)
    assert rope.E * rope.area == pytest.approx(3 * POWER.E * POWER.area, rel=1e-12)
    assert pytest.approx(51.7e9, rel=1e-3) == rope.E


def test_too_many_wires_in_a_layer():
    with pytest.raises(GeometryError, match=r"layer of 7 .* room for 6"):
        layer_radii((1, 7), 1e-3, "strand x")


def test_stated_diameter_must_agree_with_the_strands():
    with pytest.raises(GeometryError, match=r"10.00 mm|10 mm"):
        stranded_conductor("power", POWER, (1, 6), 127e-3, "Z", 10e-3)

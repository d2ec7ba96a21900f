"""The stiffness of a cable lies between all interfaces sliding and all bonded; the ends of that range."""

import numpy as np
import pytest

from geometry import Helix, read_cable
from geometry.strand import Strand
from homogenize import StiffnessRange, allowed_stiffness, homogenize_cable, loose_stiffness
from homogenize.stiffness_bounds import loose_conductor, spring_bending, spring_torsion, wire_modulus


@pytest.fixture(scope="module")
def three_core():
    return read_cable("example-three-core")


@pytest.fixture(scope="module")
def ranges(three_core):
    return allowed_stiffness(three_core, size=1.5e-3)


def spring(pitch: float, nu: float, load: str) -> float:
    """Moment over curvature (or torque over twist) of one turn of a free helical wire, by Castigliano: the local twisting
    and bending moments are integrated along it. EI = 1."""
    helix = Helix(0.01, pitch, "Z")
    z = np.linspace(0, pitch, 2001)
    axis = np.array([1.0, 0.0, 0.0]) if load == "bending" else np.array([0.0, 0.0, 1.0])
    twisting = helix.tangent(z) @ axis
    energy = (1 - twisting**2) + (1 + nu) * twisting**2
    return pitch / (np.trapezoid(energy, z) * helix.length(pitch) / pitch)


@pytest.mark.parametrize("pitch", [0.03, 0.1, 1.0])
@pytest.mark.parametrize("nu", [0.0, 0.34])
def test_free_helix_against_castigliano(pitch, nu):
    """Bending and torsion of a helical wire per length of axis; 1e-6 is the trapezoidal rule."""
    beta = np.arctan(2 * np.pi * 0.01 / pitch)
    assert spring_bending(beta, nu) == pytest.approx(spring(pitch, nu, "bending"), rel=1e-6)
    assert spring_torsion(beta, nu) * 1.0 == pytest.approx(spring(pitch, nu, "torsion") * (1 + nu), rel=1e-6)


def test_wire_modulus_of_the_published_strand():
    """80 GPa on the cylinder of 27 wires is 112 GPa on the copper, a little more with the lay of 40 mm (within 5 %)."""
    straight = Strand("s", 0.49e-3, (3, 9, 15), None, "Z", 8900.0, 80e9, 0.34)
    laid = Strand("s", 0.49e-3, (3, 9, 15), 40e-3, "Z", 8900.0, 80e9, 0.34)
    assert wire_modulus(straight) == pytest.approx(112.24e9, rel=1e-3)
    assert 1.0 < wire_modulus(laid) / wire_modulus(straight) < 1.05


def test_reference_cable_comes_apart():
    """Worked by hand: wires 0.22 N m2 and rubber about 2 N m2 in bending, rubber 1.4 N m2 in torsion, earth 1.71 MN."""
    cable = read_cable("mcpt-1.9-3.3-3x35")
    loose = loose_stiffness(cable)
    wires = 3 * loose_conductor(cable.conductors["power"])[0] + loose_conductor(cable.conductors["earth"])[0]
    assert wires == pytest.approx(0.21, rel=0.05)  # 0.22 with the control wires, whose lay is not known
    assert pytest.approx(2.1, rel=0.1) == loose.EI
    assert pytest.approx(1.4, rel=0.05) == loose.GJ
    assert pytest.approx(1.714e6, rel=0.01) == loose.EA


def test_sliding_conductors_lie_inside(three_core, ranges):
    """The cell whose conductors slide has every stiffness between the ends, at blocked and at free twist."""
    section = homogenize_cable(three_core, interface="frictionless", size=1.5e-3).section
    for name, values in {
        "EA": (section.EA_free_twist, section.EA_blocked_twist),
        "GJ": (section.GJ - section.coupling**2 / section.EA_blocked_twist, section.GJ),
        "EI": (section.EI_x, section.EI_y),
    }.items():
        for value in values:
            assert ranges[name].low < value < ranges[name].high, name
            assert ranges[name].finding(value) is None


def test_bonded_cell_is_the_upper_end(three_core, ranges):
    """Given beforehand or computed, the same numbers; the largest EA is that at blocked twist."""
    cell = homogenize_cable(three_core, size=1.5e-3)
    again = allowed_stiffness(three_core, bonded=cell)
    assert again == ranges
    assert ranges["EA"].high == cell.section.EA_blocked_twist > cell.section.EA_free_twist


def test_impossible_stiffness_is_a_sentence():
    """Names value, end of the range, and factor, on either side."""
    EI = StiffnessRange("EI", "N m^2", 2.0, 70.0, "loose", "bonded")
    high, low = EI.finding(140.0), EI.finding(0.5)
    assert high is not None and "above" in high and "70 N m^2 (bonded), by a factor 2." in high
    assert low is not None and "below" in low and "2 N m^2 (loose), by a factor 4." in low
    assert EI.finding(2.0) is None and EI.finding(70.0) is None

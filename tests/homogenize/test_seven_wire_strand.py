r"""The 1 + 6 steel strand against the theory of strands (verification case T5): core 3.94 mm, wires 3.73 mm, lay angle 11.834 degrees.

With blocked wires of the rod energy of six helical wires on a core (Costello, Theory of Wire Rope, 2nd ed. 1997, ch. 3, in the form that
follows from one energy), the printed values are k_ee 1.35563e7 N, k_et 9.07499e6 N mm, k_tt 1.78604e7 N mm^2; without contraction of the
radius k_ee is 1.38499e7 N.
"""

import numpy as np
import pytest

from geometry import read_cable
from homogenize import homogenize_cable
from homogenize.stiffness_bounds import loose_stiffness

ENERGY = 1.35563e7, 9.07499e3, 17.8604  # N, N m, N m^2
RIGID = 1.38499e7


@pytest.fixture(scope="module")
def cells():
    cable = read_cable("strand-1x7-steel")
    return {kind: homogenize_cable(cable, interface=kind, size=0.6e-3) for kind in ("bonded", "frictionless")}


def test_sliding_wires_stay_in_the_band_of_strand_theory(cells):
    """Stretch between 0.985 of the energy form and 1.005 of the rigid one; coupling and torsion within 4 % (band of case T5)."""
    C = cells["frictionless"].section.C
    assert 0.985 * ENERGY[0] < C[2, 2] < 1.005 * RIGID
    np.testing.assert_allclose([C[2, 5], C[5, 5]], ENERGY[1:], rtol=0.04)
    assert abs(C[2, 5] - C[5, 2]) < 1e-6 * C[2, 5]


def test_sliding_wires_bend_one_by_one(cells):
    """EI is the sum over the wires of their own (12.648 N m^2, Costello); contact of finite width adds at most 1.5 %."""
    loose = loose_stiffness(read_cable("strand-1x7-steel"))
    assert loose.EI == pytest.approx(12.648, rel=1e-4)
    assert 1.0 < cells["frictionless"].section.EI_x / loose.EI < 1.015


def test_bonded_wires_are_stiffer_in_every_load(cells):
    """Bonding is a constraint: C of the bonded cell less C of the sliding one has no negative eigenvalue."""
    bonded, sliding = (cells[kind].phase_zero.C for kind in ("bonded", "frictionless"))
    scale = 1 / np.sqrt(np.diag(bonded))
    difference = (bonded - sliding) * np.outer(scale, scale)
    assert np.linalg.eigvalsh(difference).min() > -1e-6


def test_bonded_strand_bends_below_plane_sections(cells):
    """Upper end 97.696 N m^2, as if the sections stayed plane; the lines of contact shear a little."""
    assert 0.8 * 97.696 < cells["bonded"].section.EI_x < 97.696


def test_all_checks_hold(cells):
    """Reciprocity, energy and work, bounds, equilibrium: also where a sliding wire touches a sliding core."""
    for result in cells.values():
        assert [check.name for check in result.checks if not check.holds] == []


def test_the_rod_of_the_cable_file_is_kirchhoffs():
    """helical-rod, r / a = 10 at 45 degrees, E 210 GPa: table values times E a^2 and powers of a; the wire is 0.2 % from thin."""
    C = homogenize_cable(read_cable("helical-rod")).section.C
    E, a = 210e9, 1e-3
    expected = np.array([4.907377e-3 * E * a**2, -6.400926e-3 * E * a**3, 0.4912711 * E * a**4])
    np.testing.assert_allclose([C[2, 2], C[2, 5], C[5, 5]], expected, rtol=3e-3)

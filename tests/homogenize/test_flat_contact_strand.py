"""A wire tied to the core over a flat: no logarithm of the mesh is left, and the flat's width enters as theory says (case T5, 17 deg)."""

import numpy as np
import pytest

from homogenize.benchmark_strand import STRAIN, axial_stiffness, seven_wire
from homogenize.flat_contact_strand import flat_half_width, flat_strand_section
from homogenize.strand_theory import contact_force, energy_consistent, with_contact

STRAND = seven_wire(17.0)
WIDTH = flat_half_width(STRAND, STRAIN)


@pytest.fixture(scope="module")
def kee():
    """Of the cell by half-width and edges across half a flat."""
    cases = ((WIDTH, 1), (WIDTH, 2), (3 * WIDTH, 1))
    return {case: axial_stiffness(flat_strand_section(STRAND, *case))[0, 0] for case in cases}


def test_flat_of_fixed_width_has_a_limit(kee):
    """Halving the elements changes kee by 0.04 %; along a line of no width it was 0.3 % with every halving."""
    assert kee[WIDTH, 2] == pytest.approx(kee[WIDTH, 1], rel=6e-4)


def test_stiffness_grows_with_the_logarithm_of_the_width(kee):
    """From a to 3 a: the step of the energy model with the compliance of the flat, to 10 % (half-plane formula)."""
    step = with_contact(STRAND, 3 * WIDTH)[0, 0] - with_contact(STRAND, WIDTH)[0, 0]
    assert kee[3 * WIDTH, 1] - kee[WIDTH, 1] == pytest.approx(step, rel=0.1)


def test_hertz_width_is_outside_the_band_of_models_without_compliance(kee):
    """0.985 of the energy model is reached by flats of three times the width that Hertz gives at 0.2 % strain, not by that width."""
    edge = 0.985 * energy_consistent(STRAND)[0, 0]
    assert kee[WIDTH, 2] < edge < kee[3 * WIDTH, 1]


def test_contact_force_is_tension_over_curvature():
    """p = T sin^2 beta / r per length of wire for thin wires: their shear force is of second order in a / r."""
    for thin, allowed in ((1.0, 0.02), (0.1, 2e-4)):
        strand = seven_wire(9.2)
        strand = type(strand)(strand.core, thin * strand.wire, strand.beta, strand.E, 0.0)
        r, tau = strand.helix_radius, strand.twist_rate
        T = strand.E * np.pi * strand.wire**2 * np.cos(strand.beta) ** 2 * 1e-3
        exact = T * np.sin(strand.beta) ** 2 / r * np.hypot(1, tau * r) / np.hypot(1, tau * strand.core)
        assert contact_force(strand, 1e-3) == pytest.approx(exact, rel=allowed)


def test_flat_without_compliance_is_the_energy_model():
    """The wider the flat the stiffer; a contact that does not yield leaves the energy model (limit, 4 a = 4 sqrt(R1 R2) / e)."""
    stiff = 4 * np.sqrt(STRAND.core * STRAND.wire) / np.e * (1 - 1e-9)
    np.testing.assert_allclose(with_contact(STRAND, stiff), energy_consistent(STRAND), rtol=1e-6)
    assert with_contact(STRAND, WIDTH)[0, 0] < with_contact(STRAND, 3 * WIDTH)[0, 0] < energy_consistent(STRAND)[0, 0]

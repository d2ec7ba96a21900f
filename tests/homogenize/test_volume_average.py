"""Formula (3): mean stress over mean strain; Hill's lemma, Voigt and Reuss bounds, a quarter turn."""

import numpy as np
import pytest
from section_meshes import rings

from homogenize import pitch_average, solve_helical_cell, volume_average


@pytest.fixture(scope="module")
def composite():
    """A stiff eccentric rod in a round rubber cable, laid helically."""

    def eccentric(rho, phi):
        return 0.3 * (1 - rho) + rho * np.cos(phi), 0.1 * (1 - rho) + rho * np.sin(phi)

    mesh = rings((0.4, 1.0), (1000.0, 0.34), (3.0, 0.45), per_ring=3, around=24, twist_rate=0.8, shape=eccentric)
    return mesh, solve_helical_cell(mesh)


def test_mean_axial_stress_over_mean_strain_is_the_energy_value(composite):
    """E by formula (3) equals EA / A of the 6x6, with the twist blocked and free."""
    _, cell = composite
    average, section = volume_average(cell), pitch_average(cell.stiffness)
    assert average.E_blocked_twist == pytest.approx(section.E_blocked_twist, rel=1e-9)
    assert average.E_free_twist == pytest.approx(section.E_free_twist, rel=1e-9)


def test_mean_shear_stress_is_the_applied_one(composite):
    """<tau_xz> and <tau_yz> are the uniform stress on the sides."""
    _, cell = composite
    stress = np.einsum("eij,eqjc->eqic", cell.field.elasticity, cell.shear_strain())
    mean = np.einsum("eq,eqic->ic", cell.field.weight, stress) / cell.field.area
    np.testing.assert_allclose(mean[[4, 3]], np.eye(2), atol=1e-9)


def test_hills_lemma_over_a_pitch(composite):
    """The mean of sigma : epsilon equals the product of the means, averaged over the angles of the section."""
    _, cell = composite
    strain = cell.shear_strain()
    stress = np.einsum("eij,eqjc->eqic", cell.field.elasticity, strain)
    energy = np.einsum("eq,eqic,eqid->cd", cell.field.weight, stress, strain) / cell.field.area
    product = np.einsum("eq,eqic->ic", cell.field.weight, strain)[[4, 3]] / cell.field.area
    assert np.trace(energy) == pytest.approx(np.trace(product), rel=1e-9)


def test_shear_modulus_lies_between_reuss_and_voigt(composite):
    """Harmonic and arithmetic means of G bound the pitch-averaged value."""
    mesh, cell = composite
    fraction = np.bincount(mesh.region_of, cell.field.weight.sum(axis=1)) / cell.field.area
    G = np.array([r.material.G for r in mesh.regions])
    assert 1 / (fraction / G).sum() < volume_average(cell).G_yoz < (fraction * G).sum()


def test_a_quarter_turn_exchanges_the_two_planes(composite):
    """G_yoz at phase 90 deg is G_xoz at phase 0."""
    average = volume_average(composite[1])
    a, b = average.shear_moduli_at(0.3), average.shear_moduli_at(0.3 + np.pi / 2)
    assert a == pytest.approx(b[::-1], rel=1e-12)
    assert a[0] != pytest.approx(a[1], rel=1e-3)

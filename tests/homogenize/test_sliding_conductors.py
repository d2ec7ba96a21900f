"""Frictionless conductors: against an independent code, bounded by the bonded cable, and in the limits where the answer is known."""

import dataclasses

import numpy as np
import pytest
from four_conductor_section import four_conductor_section
from section_meshes import rings

from geometry.errors import MeshError, SpecError
from homogenize import check_cell, pitch_average, solve_helical_cell, volume_average
from homogenize.benchmark_cables import FOUR_CONDUCTORS


@pytest.fixture(scope="module")
def section_mesh(tmp_path_factory):
    return four_conductor_section(tmp_path_factory.mktemp("section"))


@pytest.fixture(scope="module")
def sliding(section_mesh):
    return solve_helical_cell(section_mesh, "frictionless")


def test_all_constants_agree_with_the_other_code(sliding):
    """E blocked and free, EI, GJ, coupling, GA: 0.15 % (meshes differ)."""
    s = pitch_average(sliding.stiffness)
    found = [s.E_blocked_twist, s.E_free_twist, s.EI_x, s.GJ, s.coupling, s.GA_x]
    np.testing.assert_allclose(found, FOUR_CONDUCTORS["frictionless"], rtol=1.5e-3)


def test_sliding_undoes_the_bending_out_of_the_plane(sliding):
    """F14 / sqrt(F11 F44) = -0.007, against 0.447 bonded."""
    F = pitch_average(sliding.stiffness).compliance
    assert F[0, 3] / np.sqrt(F[0, 0] * F[3, 3]) == pytest.approx(-0.007, abs=1e-3)


def test_the_checks_hold_and_bonded_is_stiffer(section_mesh, sliding):
    """EA, GJ and EI fall when the conductors slide; G of the mix falls too."""
    assert all(check.holds for check in check_cell(section_mesh, sliding))
    bonded = solve_helical_cell(section_mesh)
    a, b = pitch_average(bonded.stiffness), pitch_average(sliding.stiffness)
    for name in ("EA_blocked_twist", "EA_free_twist", "GJ", "EI_x"):
        assert getattr(b, name) < getattr(a, name), name
    assert volume_average(sliding).G_yoz < volume_average(bonded).G_yoz


def test_the_mean_axial_strain_inside_the_parts_misses_the_jumps(sliding):
    """E is EA / A; mean stress over the mean strain inside the parts is off by 0.8 % blocked and 3.5 % free."""
    average, section = volume_average(sliding), pitch_average(sliding.stiffness)
    assert average.E_free_twist == pytest.approx(section.E_free_twist, rel=1e-12)
    strain, stress = sliding.strain(np.eye(6)[2]), sliding.stress(np.eye(6)[2])
    inside = np.einsum("eq,eq->", sliding.field.weight, stress[..., 2]) / np.einsum(
        "eq,eq->", sliding.field.weight, strain[..., 2]
    )
    assert inside > 1.03 * average.E_free_twist


def test_hills_lemma_holds_over_a_pitch(sliding):
    """Under uniform shear the energy is mean stress times mean strain inside the parts: the jumps cancel."""
    weight, strain = sliding.field.weight / sliding.field.area, sliding.shear_strain()
    stress = np.einsum("eij,eqjc->eqic", sliding.field.elasticity, strain)
    energy = np.einsum("eq,eqic,eqic->", weight, stress, strain)
    assert energy == pytest.approx(np.trace(volume_average(sliding).shear), rel=1e-8)


def test_the_jump_has_no_normal_component(section_mesh, sliding):
    """On every doubled node the displacement per unit tension jumps along the interface only."""
    n = 1 + int(section_mesh.cells.max())
    doubled = sliding.field.nodes[:, n:]
    outer = np.array([np.argmin(np.hypot(*(sliding.field.nodes[:, :n] - p[:, None]))) for p in doubled.T])
    u = sliding.X[:, 2].reshape(-1, 3)
    jump = u[n:] - u[outer]
    x, y = doubled
    centres = 12e-3 * np.array([[1, 0], [0, 1], [-1, 0], [0, -1], [0, 0]]).T
    from_centre = doubled[:, None, :] - centres[:, :, None]
    nearest = np.argmin(np.hypot(*from_centre), axis=0)
    nX, nY = np.take_along_axis(from_centre, nearest[None, None, :], axis=1)[:, 0]
    normal = np.stack([nX, nY, section_mesh.twist_rate * (nX * y - nY * x)])
    normal /= np.linalg.norm(normal, axis=0)
    assert (
        np.abs((jump * normal.T).sum(axis=1)).max() < 2e-3 * np.linalg.norm(jump, axis=1).max()
    )  # normals of a curved mesh
    assert np.linalg.norm(jump, axis=1).max() > 0


def test_a_straight_core_that_slides_on_the_axis_changes_nothing():
    """Prismatic core and tube of one Poisson's ratio: EA, EI and GJ are the sums of E A, E I and G J, sliding or bonded."""
    core, tube, a, b = (100.0, 0.3), (1.0, 0.3), 0.5, 1.0
    mesh = rings((a, b), core, tube, per_ring=3, around=32)
    mesh = dataclasses.replace(mesh, regions=(mesh.regions[0], dataclasses.replace(mesh.regions[1], kind="sheath")))
    section = solve_helical_cell(mesh, "frictionless").stiffness
    EA = np.pi * (core[0] * a**2 + tube[0] * (b**2 - a**2))
    EI = np.pi * (core[0] * a**4 + tube[0] * (b**4 - a**4)) / 4
    np.testing.assert_allclose([section.EA_blocked_twist, section.EI_x, section.GJ], [EA, EI, 2 * EI / 2.6], rtol=1e-4)


def test_a_mesh_that_cannot_slide_is_refused():
    mesh = rings((1.0,), (1.0, 0.3))
    soft = dataclasses.replace(mesh, regions=(dataclasses.replace(mesh.regions[0], kind="sheath"),))
    with pytest.raises(MeshError, match="nothing can slide"):
        solve_helical_cell(soft, "frictionless")
    with pytest.raises(SpecError, match="bonded or frictionless"):
        solve_helical_cell(mesh, "glued")

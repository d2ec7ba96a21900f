"""Recovered stresses: they carry the applied forces, are Lame's and Navier's where those are exact, and turn with the section."""

import numpy as np
import pytest
from section_meshes import rings, strand_section

from geometry.errors import SpecError
from geometry.material import Material
from homogenize import pitch_average, solve_helical_cell
from homogenize.benchmark_strand import seven_wire
from homogenize.coaxial_cylinder import CoaxialCylinder
from homogenize.stress_recovery import recover, section_forces, turned_forces, von_mises


@pytest.fixture(scope="module")
def composite():
    """A stiff eccentric rod in a round rubber cable, laid helically."""

    def eccentric(rho, phi):
        return 0.3 * (1 - rho) + rho * np.cos(phi), 0.1 * (1 - rho) + rho * np.sin(phi)

    mesh = rings((0.4, 1.0), (1000.0, 0.34), (3.0, 0.45), per_ring=3, around=24, twist_rate=0.8, shape=eccentric)
    return mesh, solve_helical_cell(mesh)


@pytest.mark.parametrize("angle", [0.0, 0.7, 3.0])
def test_stresses_carry_the_applied_forces(composite, angle):
    """Integrals of the stress over the section are the six section forces, in axes that do not turn; 1e-8."""
    _, cell = composite
    applied = np.array([0.3, -0.2, 5.0, 0.7, 0.4, -0.6])
    stress = cell.stress(turned_forces(applied, angle))
    w, (x, y) = cell.field.weight, cell.field.position
    zz, yz, xz = stress[..., 2], stress[..., 3], stress[..., 4]
    carried = [(w * f).sum() for f in (xz, yz, zz, y * zz, -x * zz, x * yz - y * xz)]
    c, s = np.cos(angle), np.sin(angle)
    turn = np.kron(np.eye(2), np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]]))
    np.testing.assert_allclose(turn @ carried, applied, rtol=0, atol=1e-8 * np.abs(applied).max())


def test_stresses_of_core_and_tube_are_lames():
    """sigma_rr, sigma_tt and sigma_zz along a radius at unit strain, in core and tube, at a pitch of six radii; 3e-3 at h = a/5."""
    core, tube, a, b = (8.0, 0.45), (80.0, 0.3), 0.5, 1.0
    exact = CoaxialCylinder(Material("core", *core, 1.0), Material("tube", *tube, 1.0), a, b)
    mesh = rings((a, b), core, tube, per_ring=5, around=48, twist_rate=1.0)
    cell = solve_helical_cell(mesh)
    recovery = recover(cell, mesh, [0, 0, exact.EA(), 0, 0, 0])
    x, y = recovery.nodes.transpose(0, 2, 1)
    stress = recovery.stress(0.0)
    for e, k in zip(*np.nonzero((np.abs(y) < 1e-9) & (x > 0.15))):
        inside = recovery.region_of[e] == 0
        radius = x[e, k] - 1e-9 if inside and np.isclose(x[e, k], a) else x[e, k]
        rr, tt, zz = exact.stress(float(radius))
        np.testing.assert_allclose(stress[e, k, :3], [rr, tt, zz], rtol=0, atol=3e-3 * abs(zz))


def test_bent_cylinder_has_naviers_stress():
    """Peak M r / I on the surface over the pitch, for any bending plane; 2e-3 with a linear fit in curved elements."""
    M, r = 2.0, 1.0
    mesh = rings((r,), (100.0, 0.3), per_ring=5, around=48, twist_rate=0.7)
    cell = solve_helical_cell(mesh)
    for plane in (0.0, 0.4):
        row = recover(cell, mesh, [0, 0, 0, M * np.cos(plane), M * np.sin(plane), 0]).regions[0]
        peak = M * r / (np.pi / 4)
        np.testing.assert_allclose([row.axial_max, -row.axial_min, row.von_mises], peak, rtol=2e-3)
        assert np.hypot(*row.place) == pytest.approx(r, rel=1e-3)
        assert row.axial_mean == pytest.approx(0.0, abs=1e-9)
        assert row.strain_max == pytest.approx(peak / 100.0, rel=2e-3)


def test_peak_over_the_pitch_is_the_peak_of_all_angles(composite):
    """Mean plus amplitude is what 720 angles find (the table of angles misses at most 1e-5 of the swing)."""
    mesh, cell = composite
    recovery = recover(cell, mesh, [0.1, 0, 2.0, 1.0, 0.5, 0.2])
    for i, row in enumerate(recovery.regions):
        inside = recovery.region_of == i
        seen = [recovery.axial(a)[inside] for a in np.linspace(0, 2 * np.pi, 720, endpoint=False)]
        assert row.axial_max == pytest.approx(np.max(seen), rel=2e-5)
        assert row.axial_min == pytest.approx(np.min(seen), rel=2e-5)


@pytest.mark.parametrize("degrees", [9.2, 11.834])
def test_stress_along_the_wires_of_a_strand_is_that_of_the_rod_model(degrees):
    """At unit stretch without twist: E (cos^2 - sin^2 nu (R1 + R2 xi2) / r) within 3 %, the line contact (3.3 % at 17 deg).

    The core is stretched by one, up to its warping at the contacts.
    """
    strand = seven_wire(degrees)
    mesh = strand_section(strand)
    cell = solve_helical_cell(mesh)
    section = pitch_average(cell.stiffness)
    rows = recover(cell, mesh, section.C[:, 2]).regions
    s2 = np.sin(strand.beta) ** 2
    contraction = strand.nu / strand.helix_radius
    xi = (1 - s2 - s2 * contraction * strand.core) / (1 + s2 * contraction * strand.wire)
    np.testing.assert_allclose([rows[0].strain_min, rows[0].strain_max], 1.0, rtol=3e-2)
    assert 0.9 * strand.E < rows[0].axial_mean < strand.E  # the wires press on the core, which stretches for less
    for row in rows[1:]:
        assert row.axial_mean == pytest.approx(strand.E * xi, rel=0.03)
        assert 0.5 * (row.strain_min + row.strain_max) == pytest.approx(
            xi, rel=0.03
        )  # bending is opposite on both sides


def test_forces_of_a_given_bend_and_twist(composite):
    """Moments and torque from the 6x6 give back the curvature and the twist that were asked for."""
    section = pitch_average(composite[1].stiffness)
    forces = section_forces(section, tension=2.0, curvature=(0.01, -0.02), twist=0.003)
    strains = section.compliance @ forces
    np.testing.assert_allclose(strains[[3, 4, 5]], [0.01, -0.02, 0.003], rtol=1e-10)
    assert forces[2] == 2.0 and np.abs(forces[:2]).max() == 0.0


def test_mises_of_pure_shear_and_of_pressure():
    """sqrt(3) times a shear stress; nothing under pressure."""
    assert von_mises(np.array([0, 0, 0, 2.0, 0, 0])) == pytest.approx(2 * np.sqrt(3))
    assert von_mises(np.array([7.0, 7, 7, 0, 0, 0])) == 0.0


def test_forces_that_are_no_forces_are_refused(composite):
    mesh, cell = composite
    with pytest.raises(SpecError, match="six finite numbers"):
        recover(cell, mesh, [1.0, np.nan, 0, 0, 0, 0])
    with pytest.raises(SpecError, match="finite"):
        section_forces(cell.stiffness, tension=np.inf)


def test_picture_has_both_scales(composite, tmp_path):
    """Two sections and two colour bars, one for conductors and one for the rest; the file is written."""
    import dataclasses

    from homogenize.stress_picture import draw_stress

    mesh, cell = composite
    sheath = dataclasses.replace(mesh.regions[1], kind="sheath")
    recovery = recover(cell, dataclasses.replace(mesh, regions=(mesh.regions[0], sheath)), [0, 0, 2e6, 1e6, 0, 0])
    assert draw_stress(recovery, tmp_path / "stress.png", dpi=60).stat().st_size > 10_000

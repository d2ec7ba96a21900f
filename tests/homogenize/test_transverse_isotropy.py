"""Elasticity that is alike in all directions about helical fibres: rotation by Bond's matrix, and cylinders with known answers.

Bond, Proc. Phys. Soc. B 62 (1943) 164; Lekhnitskii, Theory of Elasticity of an Anisotropic Body, Mir 1981.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from section_meshes import rings

from geometry.errors import SpecError
from geometry.material import Material
from homogenize import pitch_average, solve_helical_cell
from homogenize.equivalent_cylinder import cylinder_stiffness
from homogenize.transverse_isotropy import TransverseIsotropy, bond_matrix, rotated, rotation_to

ROPE = TransverseIsotropy("rope", 10.0, 1.5, 0.7, 0.32, 0.25, 1.0)
PAIRS = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))


def turns(count, seed=1):
    return Rotation.random(count, rng=np.random.default_rng(seed)).as_matrix()


def strain_tensor(vector):
    """Symmetric tensor of engineering strains xx yy zz yz xz xy."""
    e = np.zeros((3, 3))
    for value, (i, j) in zip(vector, PAIRS, strict=True):
        e[i, j] = e[j, i] = value if i == j else value / 2
    return e


def strain_vector(e):
    return np.array([e[i, j] if i == j else 2 * e[i, j] for i, j in PAIRS])


def cylinder(material, twist_rate, per_ring=5, around=48):
    mesh = rings((1.0,), (1.0, 0.3), per_ring=per_ring, around=around, twist_rate=twist_rate)
    return replace(mesh, regions=tuple(replace(region, material=material) for region in mesh.regions))


def stretch_and_twist(C):
    return C[np.ix_([2, 5], [2, 5])]


def test_an_isotropic_material_does_not_know_its_axes():
    """With E, nu and G = E / 2(1 + nu) in all directions every rotation gives the isotropic stiffness."""
    bar = Material("bar", 3.0, 0.3, 1.0)
    same = TransverseIsotropy("same", 3.0, 3.0, bar.G, 0.3, 0.3, 1.0)
    np.testing.assert_allclose(same.elasticity(), bar.elasticity(), rtol=1e-13, atol=1e-14)
    for R in turns(5):
        np.testing.assert_allclose(rotated(same.elasticity(), R), bar.elasticity(), rtol=1e-12, atol=1e-12)


def test_rotations_compose():
    """M(R1) M(R2) = M(R1 R2), and a rotation undone leaves C."""
    R1, R2 = turns(2)
    np.testing.assert_allclose(bond_matrix(R1) @ bond_matrix(R2), bond_matrix(R1 @ R2), atol=1e-13)
    C = ROPE.elasticity()
    np.testing.assert_allclose(rotated(rotated(C, R1), R1.T), C, atol=1e-12)


def test_energy_does_not_depend_on_the_axes():
    """e : C' : e in turned axes is the energy of the strain turned back."""
    e = np.array([0.3, -0.2, 0.5, 0.4, -0.1, 0.7])
    for R in turns(5):
        back = strain_vector(R.T @ strain_tensor(e) @ R)
        assert e @ rotated(ROPE.elasticity(), R) @ e == pytest.approx(back @ ROPE.elasticity() @ back, rel=1e-12)


def test_fibres_lie_along_their_direction():
    """A stress along the fibres stretches them by 1 / E_axial and contracts across by nu_axial / E_axial."""
    t = np.array([0.36, -0.48, 0.8])
    stress = np.array([t[i] * t[j] for i, j in PAIRS])
    e = strain_tensor(np.linalg.solve(rotated(ROPE.elasticity(), rotation_to(t)), stress))
    across = np.cross(t, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    np.testing.assert_allclose(e @ t, t / ROPE.E_axial, atol=1e-14)
    assert across @ e @ across == pytest.approx(-ROPE.nu_axial / ROPE.E_axial, rel=1e-12)


def test_fibres_follow_the_helix():
    """At (0, Y) a fibre that turns with the cable points along (-tau Y, 0, 1); fibres that do not turn about their centre are parallel."""
    turning = ROPE.direction(0.0, 0.5, 0.8)
    np.testing.assert_allclose(turning / turning[2], [-0.4, 0.0, 1.0], rtol=1e-14, atol=1e-16)
    parallel = replace(ROPE, centre=(2.0, 0.0), turn_rate=0.0).direction(
        np.array([2.0, 2.3]), np.array([0.0, -0.4]), 0.8
    )
    np.testing.assert_allclose(parallel[0], parallel[1], rtol=1e-14)
    np.testing.assert_allclose(parallel[0] / parallel[0][2], [0.0, 1.6, 1.0], atol=1e-14)


@pytest.mark.parametrize("twist_rate", [0.5, -1.0])
def test_the_cell_finds_the_cylinder_of_helical_fibres(twist_rate):
    """EA, coupling and GJ of the plane cell are those of the problem in one radius, to fourth order in the element size."""
    exact = cylinder_stiffness(replace(ROPE, turn_rate=twist_rate), 1.0)
    scale = np.sqrt(np.outer(np.diag(exact), np.diag(exact)))
    errors = []
    for per_ring in (3, 6):
        C = solve_helical_cell(cylinder(ROPE, twist_rate, per_ring, 8 * per_ring)).stiffness.C
        errors.append(np.abs((stretch_and_twist(C) - exact) / scale).max())
    assert errors[1] < 3e-6  # area of the curved mesh
    assert errors[1] < 0.1 * errors[0]


def test_stiff_fibres_carry_by_their_angle():
    """E_axial alone, small angles: EA = int E cos^4, coupling = int E cos^3 sin r, GJ = int E cos^2 sin^2 r^2.

    What the soft directions add is of the order of G / E = 1e-4 and of angle^4 E / E_T = 6e-4.
    """
    fibres = TransverseIsotropy("fibres", 1.0, 1e-2, 1e-5, 0.0, 0.0, 1.0)
    tau = 0.05
    C = stretch_and_twist(solve_helical_cell(cylinder(fibres, tau)).stiffness.C)
    r = np.linspace(0, 1, 2001)
    c, s = 1 / np.hypot(1, tau * r), tau * r / np.hypot(1, tau * r)
    theory = [np.trapezoid(2 * np.pi * r * f, r) for f in (c**4, c**3 * s * r, c**2 * s**2 * r**2)]
    np.testing.assert_allclose([C[0, 0], C[0, 1]], theory[:2], rtol=1e-3)
    assert C[1, 1] == pytest.approx(theory[2] + 1e-5 * np.pi / 2, rel=0.01)


def test_the_mirror_image_changes_the_coupling_only():
    """Reversing all turns: C keeps its diagonal and changes the sign of stretch-twist."""
    left, right = (pitch_average(solve_helical_cell(cylinder(ROPE, tau, 2, 16)).stiffness).C for tau in (-0.6, 0.6))
    np.testing.assert_allclose(np.diag(left), np.diag(right), rtol=1e-4)  # the triangles are not mirrored
    assert right[2, 5] > 0.1
    assert left[2, 5] == pytest.approx(-right[2, 5], rel=1e-3)


def test_an_isotropic_equivalent_changes_nothing_in_the_cell():
    """The whole 6x6, all digits, with an isotropic material said to have fibres off the axis."""
    bar = Material("bar", 3.0, 0.3, 1.0)
    same = TransverseIsotropy("same", 3.0, 3.0, bar.G, 0.3, 0.3, 1.0, centre=(0.3, 0.1), turn_rate=5.0)
    plain, told = (solve_helical_cell(cylinder(m, 0.7, 2, 16)).stiffness.C for m in (bar, same))
    np.testing.assert_allclose(told, plain, rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"E_axial": -1.0}, "E_axial = -1 must be positive"),
        ({"G_axial": float("nan")}, "G_axial = nan must be positive"),
        ({"nu_transverse": 1.0}, "across the fibres must lie"),
        ({"nu_axial": 1.6}, "must be below 1.58"),
    ],
)
def test_impossible_constants_are_refused(change, words):
    with pytest.raises(SpecError, match=words):
        replace(ROPE, **change)

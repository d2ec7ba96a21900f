"""The cell of bricks, pyramids and tetrahedra: patch test, rigid motions, and a core that turns in vain inside its own material."""

from functools import cache

import numpy as np
import pytest
from section_meshes import regions
from turning_core import turning_core

from geometry.cell_mesh import CellBlock, SweptCell
from geometry.errors import ConvergenceError, MeshError
from homogenize import solve_periodic_cell
from homogenize.mean_dilatation import element_energies, region_volumes, stiffness_matrix

STEEL = (2.0, 0.3)


def solid_circle(E, nu, R=1.0):
    """EA, EI, GJ of a cylinder."""
    return np.pi * R**2 * E, np.pi / 4 * R**4 * E, np.pi / 4 * R**4 * E / (1 + nu)


@cache
def homogeneous(n, twist_rate):
    """The 6x6 of a cylinder of one material whose core turns."""
    return solve_periodic_cell(turning_core(n, STEEL, STEEL, twist_rate), bending=True).section


def bricks_with_bad_side() -> SweptCell:
    cell = turning_core(1, STEEL, STEEL)
    points = cell.points.copy()
    points[cell.top] += [0, 0, 2 * cell.height]
    points[cell.blocks[0].cells[0, 4:]] -= [0, 0, cell.height]
    return SweptCell(points, cell.blocks, cell.regions, 0.0, cell.height, cell.bottom, cell.top)


def test_patch():
    """A linear displacement has its exact energy, and no force on inner nodes, through hexahedra, pyramids and tetrahedra."""
    mesh = turning_core(1, (2.0, 0.49), (2.0, 0.49))
    assert {block.kind for block in mesh.blocks} == {"hexahedron", "pyramid", "tetra"}
    K = stiffness_matrix(mesh)
    A = np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6], [0.7, 0.8, 0.9]])
    u = (mesh.points @ A.T).ravel()
    strain, m = 0.5 * (A + A.T), mesh.regions[0].material
    density = m.lame * np.trace(strain) ** 2 + 2 * m.G * (strain**2).sum()
    volume = 12 / 2 * np.sin(2 * np.pi / 12) * mesh.height  # of the outer prism
    assert region_volumes(mesh).sum() == pytest.approx(volume, rel=1e-12)
    assert u @ (K @ u) == pytest.approx(density * volume, rel=1e-12)
    assert element_energies(mesh, u[None]).sum() == pytest.approx(density * volume, rel=1e-12)
    inside = (mesh.points[:, 2] > 1e-9) & (mesh.points[:, 2] < mesh.height - 1e-9)
    inside &= np.hypot(*mesh.points[:, :2].T) < 0.96
    assert inside.sum() > 100
    assert np.abs((K @ u).reshape(-1, 3)[inside]).max() < 1e-12 * m.lame


def test_rigid_motions_cost_nothing_and_the_matrix_is_symmetric():
    """Translations and small rotations are the only null vectors of a mixed mesh."""
    K = stiffness_matrix(turning_core(1, STEEL, (1.0, 0.4))).toarray()
    np.testing.assert_allclose(K, K.T, atol=1e-13 * np.abs(K).max())
    eigenvalues = np.linalg.eigvalsh(K)
    assert (np.abs(eigenvalues[:6]) < 1e-10 * eigenvalues[-1]).all()
    assert eigenvalues[6] > 1e-6 * eigenvalues[-1]


@pytest.mark.parametrize("twist_rate", [0.0, 0.7])
def test_a_core_that_turns_inside_its_own_material_is_not_felt(twist_rate):
    """EA, EI, GJ of the cylinder at second order, no coupling, whether the cell repeats straight or turned."""
    EA, EI, GJ = solid_circle(*STEEL)
    errors, couplings = [], []
    for n in (1, 2, 3):
        section = homogeneous(n, twist_rate)
        C = section.C
        errors.append(np.abs(np.array([C[2, 2] / EA, section.EI_x / EI, section.EI_y / EI, C[5, 5] / GJ]) - 1))
        scaled = C / np.sqrt(np.outer(np.diag(C), np.diag(C)))
        couplings.append(np.abs(scaled - np.eye(6)).max())
    orders = np.log(np.array(errors[1]) / errors[2]) / np.log(1.5)
    assert (errors[2] < 0.04).all(), errors
    assert (orders > 1.6).all(), (errors, orders)
    assert couplings[2] < 5e-3, couplings


def test_shear_of_a_solid_circle():
    """1 / k = 7/6 + (nu / (1 + nu))^2 / 6 by energy, GA = k G A."""
    E, nu = STEEL
    k = 1 / (7 / 6 + (nu / (1 + nu)) ** 2 / 6)
    exact = k * E / 2 / (1 + nu) * np.pi
    errors = []
    for n in (1, 2, 3):
        section = homogeneous(n, 0.0)
        errors.append(max(abs(section.GA_x / exact - 1), abs(section.GA_y / exact - 1)))
    assert errors[2] < 0.02
    assert np.log(errors[1] / errors[2]) / np.log(1.5) > 1.5, errors


def test_a_cell_turned_inside_out_is_named():
    """Region and place of the element."""
    with pytest.raises(MeshError, match=r"an element of part \d near .* is turned inside out"):
        stiffness_matrix(bricks_with_bad_side())


def test_a_kind_of_second_order_is_refused():
    """The mesh may hold it, the field does not."""
    points = np.zeros((9, 3))
    block = CellBlock("quad9", np.arange(9)[None], np.zeros(1, int))
    with pytest.raises(MeshError, match="quad9"):
        stiffness_matrix(SweptCell(points, (block,), regions(STEEL), 0.0, 1.0, np.arange(1), np.arange(1)))


def test_an_interrupted_solve_says_which_load_and_how_far():
    """Load, residual and iterations."""
    with pytest.raises(ConvergenceError, match=r"the tension problem .* residual of .* after 2 iterations"):
        solve_periodic_cell(turning_core(2, (100.0, 0.3), (1.0, 0.45)), max_iterations=2)


def test_progress_tells_assembly_hierarchy_and_loads():
    """Fractions grow from 0 to 1."""
    said = []
    solve_periodic_cell(turning_core(2, STEEL, STEEL), bending=True, progress=lambda f, s: said.append((f, s)))
    fractions = [f for f, _ in said]
    assert fractions == sorted(fractions)
    assert (fractions[0], fractions[-1]) == (0.0, 1.0)
    assert any("bending about y" in s for _, s in said)

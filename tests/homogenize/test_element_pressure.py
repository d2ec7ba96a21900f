"""Nearly incompressible elements: pressures as unknowns change nothing but what the solver feels."""

from dataclasses import replace

import numpy as np
import pytest
from section_meshes import regions
from turning_core import turning_core

from geometry.material import Material
from homogenize import element_pressure, solve_periodic_cell
from homogenize.block_product import block_product
from homogenize.cell_operator import CellOperator
from homogenize.mean_dilatation import stiffness_matrix
from homogenize.multigrid import Multigrid

RUBBER = (1.0, 0.4999)


def core_in_rubber(nu, n=2):
    """A stiff core that turns in rubber, 20 000 : 1."""
    return turning_core(n, (20000.0, 0.34), (1.0, nu), 0.7)


def stiffness(mesh):
    section = solve_periodic_cell(mesh, bending=True).section
    assert section is not None
    return section.C


def test_constant_pressure_is_exact():
    """A linear displacement with its pressure has its exact energy, and no force on inner nodes: jumps and their faces do nothing."""
    mesh = turning_core(1, RUBBER, RUBBER)
    M = CellOperator(mesh)
    A = np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6], [0.7, 0.8, 0.9]])
    m, strain = mesh.regions[0].material, 0.5 * (A + A.T)
    pressure = np.full(M.size - M.displacements, (m.lame - m.G) * np.trace(strain))
    w = np.concatenate([(mesh.points @ A.T).ravel(), pressure])
    volume = 12 / 2 * np.sin(2 * np.pi / 12) * mesh.height
    energy = (m.lame * np.trace(strain) ** 2 + 2 * m.G * (strain**2).sum()) * volume
    force = M.product(w)
    assert w @ force == pytest.approx(energy, rel=1e-10)  # 1 / (1 - 2 nu) of rounding
    assert M.energies(w[None]).sum() == pytest.approx(energy, rel=1e-10)
    inside = (mesh.points[:, 2] > 1e-9) & (mesh.points[:, 2] < mesh.height - 1e-9)
    inside &= np.hypot(*mesh.points[:, :2].T) < 0.96
    assert np.abs(force[: M.displacements].reshape(-1, 3)[inside]).max() < 1e-12 * m.lame
    assert np.abs(force[M.displacements :]).max() < 1e-12 * m.lame


def test_eliminated_pressures_are_mean_dilatation(monkeypatch):
    """Without the sum over faces, A + B^T C^-1 B is the matrix of the brick."""
    monkeypatch.setattr(element_pressure, "JUMPS", 0.0)
    mesh = turning_core(1, RUBBER, (1.0, 0.3))
    M, exact = CellOperator(mesh), stiffness_matrix(mesh).toarray()
    rng = np.random.default_rng(0)
    u = rng.standard_normal(M.displacements)
    assert M.pressure is not None
    p = M.pressure.B.product(u.reshape(-1, 3)).ravel() / M.pressure.compliance
    np.testing.assert_allclose(M.product(np.concatenate([u, p]))[: len(u)], exact @ u, atol=1e-10 * np.abs(exact).max())


def test_iterations_hardly_grow_with_poissons_ratio():
    """All loads from 0.45, without pressures, to 0.4999."""
    low, high = (np.array(solve_periodic_cell(core_in_rubber(nu), bending=True).iterations) for nu in (0.45, 0.4999))
    assert (high <= 1.5 * low + 3).all(), (low, high)


def test_the_stabilised_cell_has_the_stiffness_of_mean_dilatation(monkeypatch):
    """The 6x6 with element pressures and with the brick alone: their difference is of the size of the mesh error or below."""
    mesh = core_in_rubber(0.49)
    mixed = stiffness(mesh)
    monkeypatch.setattr(element_pressure, "COMPRESSIBLE", np.inf)
    plain = stiffness(mesh)
    np.testing.assert_allclose(np.diag(mixed), np.diag(plain), rtol=1e-3)
    d = np.sqrt(np.diag(plain))
    np.testing.assert_allclose(mixed / np.outer(d, d), plain / np.outer(d, d), atol=1e-3)


def test_the_cycle_is_hermitian_on_two_threads():
    """Sweeps of two halves and their seam: x^T M y = y^T M x to single precision, and a matrix that is solved."""
    mesh = turning_core(3, (2.0, 0.3), (1.0, 0.3))
    inner = np.setdiff1d(np.arange(len(mesh.points)), mesh.bottom)
    dofs = (3 * inner[:, None] + np.arange(3)).ravel()
    A = stiffness_matrix(mesh).tocsr()[dofs][:, dofs].tobsr((3, 3))
    grid = Multigrid(A, mesh.points[inner], np.inf)
    one, two, end = grid.levels[0].smoother.parts
    assert one < two < end  # two halves and a seam
    x, y = np.random.default_rng(1).standard_normal((2, A.shape[0]))
    assert x @ grid.precondition(y) == pytest.approx(y @ grid.precondition(x), rel=1e-4)
    found = grid.solve(x, 1e-9, 200)
    assert np.linalg.norm(A @ found.unknowns - x) < 1e-6 * np.linalg.norm(x)


def test_products_of_blocks_are_those_of_scipy():
    """On both sides of the number of rows from which two threads share the work."""
    for n in (1, 2):
        A = stiffness_matrix(turning_core(n, (2.0, 0.3), (1.0, 0.3)))
        A.sort_indices()
        found, exact = block_product(A, A).tocsr(), (A.tocsr() @ A.tocsr())
        assert abs(found - exact).max() < 1e-13 * abs(exact).max()


def test_regions_below_the_limit_keep_their_lame_constant():
    """Nothing is taken from compressible materials."""
    mesh = core_in_rubber(0.45, 1)
    assert CellOperator(mesh).pressure is None
    soft = Material("rubber", 1.0, 0.49, 1000.0)
    mesh = replace(mesh, regions=tuple(replace(r, material=soft) for r in mesh.regions))
    pressure = CellOperator(mesh).pressure
    assert pressure is not None
    assert len(pressure.elements) == sum(len(b.cells) for b in mesh.blocks)
    assert (
        regions((1.0, 0.3))[0].material.lame
        == element_pressure.limited_lame(turning_core(1, (1.0, 0.3), (1.0, 0.3)))[0]
    )

"""Patch test of the linear brick and wedge with mean dilatation."""

import numpy as np
import pytest
import skfem
from section_meshes import regions

from geometry.cell_mesh import SliceMesh
from homogenize.mean_dilatation import region_volumes, stiffness_matrix


def distorted_cube(kind: str) -> SliceMesh:
    n = 3
    if kind == "hexahedron":
        plane = skfem.MeshQuad.init_tensor(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    else:
        plane = skfem.MeshTri.init_tensor(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    m = plane.p.shape[1]
    points = np.concatenate([np.column_stack([plane.p.T, np.full(m, k / n)]) for k in range(n + 1)])
    cells = np.concatenate([np.hstack([plane.t.T + k * m, plane.t.T + (k + 1) * m]) for k in range(n)]).astype(int)
    inside = ((points > 1e-9) & (points < 1 - 1e-9)).all(axis=1)
    points[inside] += 0.05 * np.random.default_rng(1).standard_normal((inside.sum(), 3))
    return SliceMesh(
        points, cells, kind, np.zeros(len(cells), int), regions((2.0, 0.49)), 0.0, 1.0, np.array([0]), np.array([0])
    )


@pytest.mark.parametrize("kind", ["hexahedron", "wedge"])
def test_patch(kind):
    """A linear displacement has its exact energy, and no force on inner nodes, on a distorted mesh."""
    mesh = distorted_cube(kind)
    K = stiffness_matrix(mesh)
    A = np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6], [0.7, 0.8, 0.9]])
    u = (mesh.points @ A.T).ravel()
    strain = 0.5 * (A + A.T)
    m = mesh.regions[0].material
    energy = 0.5 * m.lame * np.trace(strain) ** 2 + m.G * (strain**2).sum()
    assert 0.5 * u @ (K @ u) == pytest.approx(energy, rel=1e-12)
    inside = ((mesh.points > 1e-9) & (mesh.points < 1 - 1e-9)).all(axis=1)
    assert np.abs((K @ u).reshape(-1, 3)[inside]).max() < 1e-12 * m.lame
    assert region_volumes(mesh)[0] == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("kind", ["hexahedron", "wedge"])
def test_rigid_motions_cost_nothing_and_the_matrix_is_symmetric(kind):
    """Translations and small rotations are the only null vectors of one mesh."""
    mesh = distorted_cube(kind)
    K = stiffness_matrix(mesh).toarray()
    np.testing.assert_allclose(K, K.T, atol=1e-13 * np.abs(K).max())
    eigenvalues = np.linalg.eigvalsh(K)
    assert (np.abs(eigenvalues[:6]) < 1e-10 * eigenvalues[-1]).all()
    assert eigenvalues[6] > 1e-6 * eigenvalues[-1]

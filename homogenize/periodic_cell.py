r"""Tension and torsion of a helical slice by a three-dimensional periodic cell.

For each unit section strain (stretch, twist) the displacement is the macroscopic field plus a part of helical period,
:math:`u = u_{macro} + R v`, which minimises the energy of the slice of height h:

.. math:: R^T K R\, v = -R^T K u_{macro}, \qquad C_{ij} = \tfrac1h\, u_i^T K u_j .

A slice of any height serves for tension and torsion, because they are invariant along the helix; bending is not.
The solver is conjugate gradients preconditioned by smoothed aggregation with the rigid-body modes
(Vanek, Mandel, Brezina, Computing 56 (1996) 179-196, doi 10.1007/BF02238511), by pyamg, which is imported here only.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geometry.cell_mesh import SliceMesh
from geometry.errors import ConvergenceError, MeshError
from homogenize.helical_periodicity import reduction
from homogenize.mean_dilatation import stiffness_matrix

Progress = Callable[[float, str], None]

STRENGTH_THRESHOLD = 0.1
"""Of smoothed aggregation: at a contrast of 20 000 it needs a fraction of the iterations of 0 (benchmarks/cell.py)."""

MATCHING_TOLERANCE = 1e-9
"""Largest allowed gap [m] between a top node and the image of its partner."""


@dataclass(frozen=True)
class PeriodicCell:
    """Result of the three-dimensional cell.

    Attributes
    ----------
    stiffness : (2, 2), order (epsilon, tau): [[EA, coupling], [coupling, GJ]] in N, N m, N m^2
    unknowns : free displacement components
    iterations : of conjugate gradients, per load case
    residual : relative residual reached, per load case
    displacement : (2, n, 3) total displacement per unit stretch and per unit twist [m], [m^2]
    """

    stiffness: NDArray[np.float64]
    unknowns: int
    iterations: tuple[int, int]
    residual: tuple[float, float]
    displacement: NDArray[np.float64]


def solve_periodic_cell(
    mesh: SliceMesh, *, tolerance: float = 1e-8, max_iterations: int = 2000, progress: Progress | None = None
) -> PeriodicCell:
    """Axial stiffness, coupling and torsional stiffness of a helical slice.

    Parameters
    ----------
    mesh : SliceMesh
        Slice with matching end faces.
    tolerance : float
        Relative residual at which conjugate gradients stop.
    progress : callable, optional
        Called with a fraction and a sentence.

    Returns
    -------
    PeriodicCell

    Raises
    ------
    MeshError
        If the end faces do not match; the message gives the largest gap.
    ConvergenceError
        If conjugate gradients do not reach the tolerance; the message says how far they came.
    """
    gap = mesh.matching_gap()
    if gap > MATCHING_TOLERANCE:
        raise MeshError(
            f"the end faces of the slice do not match under the helical motion: the largest gap is {1e3 * gap:.3g} mm; "
            "sweep the slice from one cross-section."
        )
    tell = progress or (lambda fraction, sentence: None)
    tell(0.0, f"assembling {len(mesh.cells)} elements")
    K = stiffness_matrix(mesh)
    angle = mesh.twist_rate * mesh.height
    Q = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    R, free = reduction(len(mesh.points), mesh.bottom, mesh.top, Q)
    macro = _macroscopic_fields(mesh.points)
    reduced = sp.bsr_array(sp.csr_array(R.T @ (K.tocsr() @ R)), blocksize=(3, 3))
    tell(0.3, f"building the multigrid hierarchy for {3 * len(free)} unknowns")
    solve = _multigrid(reduced, mesh.points[free])
    total, iterations, residuals = [], [], []
    for case, name in enumerate(("tension", "torsion")):
        tell(0.5 + 0.25 * case, f"solving {name}")
        rhs = -(R.T @ (K @ macro[case]))
        v, count, residual = solve(rhs, tolerance, max_iterations)
        if not residual <= 10 * tolerance:
            raise ConvergenceError(
                f"the {name} problem of the slice stopped at a relative residual of {residual:.1e} after {count} iterations "
                f"(wanted {tolerance:.0e}); Poisson's ratios above 0.49 make it slow: try 0.49, or a finer mesh."
            )
        total.append(macro[case] + R @ v)
        iterations.append(count)
        residuals.append(residual)
    U = np.array(total)
    C = U @ (K @ U.T) / mesh.height
    tell(1.0, "done")
    return PeriodicCell(
        0.5 * (C + C.T),
        3 * len(free),
        (iterations[0], iterations[1]),
        (residuals[0], residuals[1]),
        U.reshape(2, -1, 3),
    )


def _macroscopic_fields(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Displacements (2, 3n) of unit stretch, z e_z, and of unit twist, z e_z x r."""
    x, y, z = points.T
    zero = np.zeros_like(z)
    stretch = np.stack([zero, zero, z], axis=1)
    twist = np.stack([-y * z, x * z, zero], axis=1)
    return np.array([stretch.ravel(), twist.ravel()])


def _rigid_modes(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Six rigid-body modes (3n, 6), rotations scaled to the size of the slice."""
    centred = points - points.mean(axis=0)
    x, y, z = (centred / np.abs(centred).max()).T
    modes = np.zeros((len(points), 3, 6))
    modes[:, range(3), range(3)] = 1.0
    modes[:, 1, 3], modes[:, 2, 3] = -z, y
    modes[:, 0, 4], modes[:, 2, 4] = z, -x
    modes[:, 0, 5], modes[:, 1, 5] = -y, x
    return modes.reshape(-1, 6)


def _multigrid(K: sp.bsr_array, points: NDArray[np.float64]) -> Callable:
    """Solver by conjugate gradients with one smoothed aggregation hierarchy for all loads."""
    import pyamg

    indices, indptr = K.indices.astype(np.int32), K.indptr.astype(np.int32)
    matrix = sp.bsr_matrix((K.data, indices, indptr), shape=K.shape)
    hierarchy: Any = pyamg.smoothed_aggregation_solver(
        matrix,
        B=_rigid_modes(points),
        strength=("symmetric", {"theta": STRENGTH_THRESHOLD}),  # pyright: ignore[reportArgumentType]
        smooth=("jacobi", {"omega": 4.0 / 3.0, "weighting": "block"}),
        presmoother=("block_gauss_seidel", {"sweep": "symmetric"}),
        postsmoother=("block_gauss_seidel", {"sweep": "symmetric"}),
        max_coarse=300,
        coarse_solver="pinv",
    )

    def solve(rhs: NDArray[np.float64], tolerance: float, max_iterations: int) -> tuple[NDArray, int, float]:
        history: list[float] = []
        v = np.asarray(hierarchy.solve(rhs, tol=tolerance, maxiter=max_iterations, accel="cg", residuals=history))
        residual = float(np.linalg.norm(rhs - matrix @ v) / np.linalg.norm(rhs))
        return v, len(history) - 1, residual

    return solve

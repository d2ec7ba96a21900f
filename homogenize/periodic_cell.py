r"""The stiffness of a cable by a three-dimensional cell, of any geometry that repeats under x -> Q x + H e_z.

Stretch and twist are real problems on the cell, bending and shear a complex one: homogenize/floquet_load.py says why,
homogenize/floquet_problem.py how each is solved.

A helical slice of any height serves, because its section is the same at every height; the result is then that of
:func:`homogenize.pitch_average`. A nested cell needs its whole period. Sections are averaged along the cable, as for a beam
element longer than the period.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.cell_mesh import SliceMesh, SweptCell
from geometry.errors import MeshError
from homogenize.cell_operator import CellOperator
from homogenize.floquet_load import LoadGroup, load_groups
from homogenize.floquet_problem import SolvedGroup, solve_group
from homogenize.mean_dilatation import region_volumes
from homogenize.section_stiffness import SectionStiffness

Progress = Callable[[float, str], None]
Mesh = SliceMesh | SweptCell

MATCHING_TOLERANCE = 1e-9
"""Largest allowed gap [m] between a top node and the image of its partner."""


@dataclass(frozen=True)
class PeriodicCell:
    """Result of the three-dimensional cell.

    Attributes
    ----------
    stiffness : (2, 2), order (epsilon, tau): [[EA, coupling], [coupling, GJ]] in N, N m, N m^2, nothing else strained on average
    unknowns : free displacement components
    iterations : of GMRES, per load case: tension, torsion, then bending and shear
    residual : relative residual reached, per load case
    displacement : (2, n, 3) total displacement per unit stretch and per unit twist [m], [m^2]
    section : the whole 6x6, averaged along the cable; None if bending was not asked for
    loads : names of the load cases
    complexity : entries of all levels of the multigrid hierarchies over those of the first levels, the largest
    """

    stiffness: NDArray[np.float64]
    unknowns: int
    iterations: tuple[int, ...]
    residual: tuple[float, ...]
    displacement: NDArray[np.float64]
    section: SectionStiffness | None = None
    loads: tuple[str, ...] = ("tension", "torsion")
    complexity: float = float("nan")


def solve_periodic_cell(
    mesh: Mesh,
    *,
    bending: bool = False,
    tolerance: float = 3e-4,
    max_iterations: int = 2000,
    progress: Progress | None = None,
) -> PeriodicCell:
    """Section stiffness of a cable from one cell of it, tension and torsion, or all of the 6x6.

    Parameters
    ----------
    mesh : SliceMesh or SweptCell
        Cell with matching end faces: :func:`geometry.helical_slice`, :func:`geometry.nested_cell`.
    bending : bool
        Bending and shear as well, in `section`.
    tolerance : float
        Relative energy norm of the residual at which the iteration stops; the error of the stiffness is some 40 times its square.
        Moments that shear follows are solved to a hundredth, shear to a twentieth of it.
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
        If the iteration does not reach the tolerance; the message says for which load and how far it came.
    """
    gap = mesh.matching_gap()
    if gap > MATCHING_TOLERANCE:
        raise MeshError(
            f"the end faces of the cell do not match under its motion: the largest gap is {1e3 * gap:.3g} mm; "
            "sweep the cell from one cross-section."
        )
    tell = progress or (lambda fraction, sentence: None)
    tell(0.0, f"assembling {sum(len(block.cells) for block in mesh.blocks)} elements")
    M = CellOperator(mesh)
    angle = mesh.twist_rate * mesh.height
    groups = load_groups(angle, bending)
    solved = []
    for number, group in enumerate(groups):
        share = (0.1 + 0.9 * number / len(groups), 0.9 / len(groups))
        solved.append(
            solve_group(mesh, M, group, tolerance, max_iterations, lambda f, s, p=share: tell(p[0] + p[1] * f, s))
        )
    tell(1.0, "done")
    solutions = [s for group in solved for s in group.solutions]
    return PeriodicCell(
        stiffness=solved[0].stiffness[:2, :2].real,
        unknowns=solved[0].unknowns,
        iterations=tuple(s.iterations for s in solutions),
        residual=tuple(s.residual for s in solutions),
        displacement=solved[0].fields[:2].reshape(2, -1, 3).real,
        section=_section(mesh, groups, solved) if bending else None,
        loads=tuple(name for group in solved for name in group.names),
        complexity=max(group.complexity for group in solved),
    )


def _section(mesh: Mesh, groups: tuple[LoadGroup, ...], solved: list[SolvedGroup]) -> SectionStiffness:
    """The 6x6 whose compliance is that of all groups; a circular group stands for its conjugate as well."""
    Q, F = [], np.zeros((6, 6), dtype=complex)
    for group, found in zip(groups, solved, strict=True):
        columns = np.hstack([group.forces, group.shears])
        for basis, block in ((columns, found.compliance), (columns.conj(), found.compliance.conj()))[
            : 1 + group.circular
        ]:
            start = sum(q.shape[1] for q in Q)
            F[start : start + len(block), start : start + len(block)] = block
            Q.append(basis)
    inverse = np.linalg.inv(np.hstack(Q))
    C = np.linalg.inv((inverse.conj().T @ F @ inverse).real)
    return SectionStiffness(0.5 * (C + C.T), float(region_volumes(mesh).sum() / mesh.height))

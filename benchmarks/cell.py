"""Time and memory of the cell on the reference cable.

Three tables, each a set of ratios within one run, because seconds depend on the machine:

1. the 2D cell: both real load cases (tension, torsion) against the whole 6x6, over the element size;
2. assembly of the 3D slice: batched gradient products against the same form in scikit-fem, equal matrices;
3. smoothed aggregation on the 3D slice: strength threshold 0 against 0.1, iterations and seconds.

Run: python -m benchmarks.cell (about a minute). The last results are in benchmarks/cell.md.
"""

from __future__ import annotations

import resource
import time
from collections.abc import Callable

import numpy as np
import skfem
from skfem.helpers import ddot, eye, sym_grad, trace

from geometry import cross_section_mesh, helical_slice, read_cable
from geometry.cell_mesh import SliceMesh
from homogenize import multigrid, solve_periodic_cell
from homogenize.element_basis import _NODE_ORDER
from homogenize.helical_cell import solve_helical_cell
from homogenize.mean_dilatation import stiffness_matrix
from homogenize.section_field import section_field
from homogenize.section_problem import SectionPencil, SectionSolver, gauge_unknowns

CABLE = "mcpt-1.9-3.3-3x35"


def timed(work: Callable[[], object], repeats: int = 3) -> tuple[float, object]:
    """Smallest wall time of a few runs [s], and the last result."""
    times, result = [], None
    for _ in range(repeats):
        start = time.perf_counter()
        result = work()
        times.append(time.perf_counter() - start)
    return min(times), result


def plane_cell() -> None:
    """Table 1."""
    cable = read_cable(CABLE)
    print("\n2D helical cell of", CABLE)
    print(
        f"{'size mm':>8} {'unknowns':>9} {'mesh s':>7} {'N and Mz s':>11} {'whole 6x6 s':>12} {'ratio':>6} {'EA MN':>8}"
    )
    for size in (6e-3, 4e-3, 2e-3, 1.5e-3):
        mesh_time, mesh = timed(lambda size=size: cross_section_mesh(cable, size=size), 1)

        def real_cases(mesh=mesh):
            field = section_field(mesh)
            E0, E1, E2 = field.matrices()
            pencil = SectionPencil(E0, E1.T - E1, E1, E2, field.rigid_motion(), field.area**0.5)
            solver = SectionSolver(pencil, 0.0, gauge_unknowns(field.nodes, np.ones(field.nodes.shape[1], dtype=bool)))
            return [solver.solve(np.zeros(field.unknowns), np.eye(6)[i]) for i in (2, 5)]

        two, _ = timed(real_cases)
        six, cell = timed(lambda mesh=mesh: solve_helical_cell(mesh))
        EA = cell.stiffness.EA_blocked_twist / 1e6
        print(
            f"{1e3 * size:8.1f} {cell.field.unknowns:9d} {mesh_time:7.2f} {two:11.2f} {six:12.2f} {six / two:6.2f} {EA:8.4f}"
        )


def assembly() -> None:
    """Table 2."""
    mesh = slice_of(3e-3)
    ours, K = timed(lambda: stiffness_matrix(mesh))
    order = _NODE_ORDER["hexahedron"]
    G = np.array([r.material.G for r in mesh.regions])[mesh.region_of][:, None]
    lame = np.array([r.material.lame for r in mesh.regions])[mesh.region_of][:, None]

    def with_forms():
        hexes = skfem.MeshHex1(np.ascontiguousarray(mesh.points.T), np.ascontiguousarray(mesh.cells[:, order].T))
        basis = skfem.CellBasis(hexes, skfem.ElementVector(skfem.ElementHex1()), intorder=2)

        @skfem.BilinearForm
        def form(u, v, w):
            strain = sym_grad(u)
            return ddot(2 * w["G"] * strain + w["lame"] * eye(trace(strain), 3), sym_grad(v))

        return form.assemble(basis, G=np.broadcast_to(G, basis.dx.shape), lame=np.broadcast_to(lame, basis.dx.shape))

    theirs, _ = timed(with_forms, 1)
    print(f"\nAssembly of {len(mesh.cells)} bricks, {K.shape[0]} unknowns")
    print(f"batched products {ours:.2f} s, scikit-fem form {theirs:.2f} s, ratio {theirs / ours:.1f}")


def aggregation() -> None:
    """Table 3."""
    mesh = slice_of(3e-3)
    print(f"\nSmoothed aggregation, slice of {len(mesh.cells)} bricks, tolerance 1e-8")
    print(f"{'threshold':>9} {'iterations':>11} {'seconds':>8}")
    standard = multigrid.STRENGTH_THRESHOLD
    try:
        for theta in (0.0, 0.05, 0.1, 0.2):
            multigrid.STRENGTH_THRESHOLD = theta
            seconds, result = timed(lambda: solve_periodic_cell(mesh, tolerance=1e-8), 1)
            print(f"{theta:9.2f} {result.iterations!s:>11} {seconds:8.1f}")
    finally:
        multigrid.STRENGTH_THRESHOLD = standard


def slice_of(size: float) -> SliceMesh:
    """One layer of bricks, 1/128 of the lay high."""
    section = cross_section_mesh(read_cable(CABLE), size=size, kind="quad")
    return helical_slice(section, 2 * np.pi / abs(section.twist_rate) / 128, 1)


def main() -> None:
    """Run the three tables."""
    plane_cell()
    assembly()
    aggregation()
    print(f"\npeak memory of the process {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6:.2f} GB")


if __name__ == "__main__":
    main()

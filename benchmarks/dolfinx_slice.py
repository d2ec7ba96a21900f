"""A clamped slice in DOLFINx 0.5, run by the Python that has it: `python3 benchmarks/dolfinx_slice.py mesh.npz gamg full`.

Reads nodes, bricks and materials that helicable wrote, solves linear elasticity as DOLFINx users do and prints one line of JSON: seconds of
form and assembly, of the solution, iterations, force. Solvers: `gamg` (conjugate gradients, smoothed aggregation with the six rigid
motions, Chebyshev and Jacobi smoothing as in DOLFINx's own elasticity demo), `mumps` (LDL^T). Elements: `full` is the brick of 2 x 2 x 2
points; `mean` has one pressure for each brick besides, which is mean dilatation with the pressure kept (mumps only: the matrix is
indefinite).

It imports nothing of helicable, which another Python runs.
"""

# pyright: reportMissingImports=false, reportMissingModuleSource=false
from __future__ import annotations

import json
import sys
import time
from typing import Any

try:
    import dolfinx
    import numpy as np
    import ufl
    from dolfinx import fem, la, mesh
    from dolfinx.cpp.io import perm_vtk
    from dolfinx.fem import petsc
    from mpi4py import MPI
    from petsc4py import PETSc
except ImportError as missing:  # said by the benchmark that calls this script
    sys.exit(f"DOLFINx is not installed for this Python: {missing}")

POINTS = {"quadrature_degree": 3}
"""2 x 2 x 2 points in a brick."""
SOLVERS = {
    "gamg": {
        "ksp_type": "cg",
        "ksp_rtol": 1e-8,
        "ksp_max_it": 5000,
        "pc_type": "gamg",
        "mg_levels_ksp_type": "chebyshev",
        "mg_levels_pc_type": "jacobi",
        "mg_levels_ksp_chebyshev_esteig_steps": 20,
    },
    "mumps": {"ksp_type": "preonly", "pc_type": "cholesky", "pc_factor_mat_solver_type": "mumps"},
}


def brick_mesh(points: Any, cells: Any) -> Any:
    """The mesh of bricks in VTK's order."""
    element = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.Cell("hexahedron", geometric_dimension=3), 1))
    order = perm_vtk(mesh.CellType.hexahedron, 8)
    return mesh.create_mesh(MPI.COMM_WORLD, np.ascontiguousarray(cells[:, order]), points, element)


def of_cells(domain: Any, values: Any) -> Any:
    """A piecewise constant with one value for each brick of the file."""
    space = fem.FunctionSpace(domain, ("DG", 0))
    field = fem.Function(space)
    field.x.array[:] = values[domain.topology.original_cell_index]
    return field


def rigid_motions(space: Any) -> Any:
    """Orthonormal translations and rotations, as PETSc wants them."""
    x = space.tabulate_dof_coordinates()
    x = (x - x.mean(axis=0)) / np.abs(x - x.mean(axis=0)).max()
    modes = np.zeros((6, len(x), 3))
    for i in range(3):
        modes[i, :, i] = 1.0
        j, k = (i + 1) % 3, (i + 2) % 3
        modes[3 + i, :, j], modes[3 + i, :, k] = -x[:, k], x[:, j]
    basis = np.linalg.qr(modes.reshape(6, -1).T)[0].T
    vectors = [la.create_petsc_vector(space.dofmap.index_map, space.dofmap.index_map_bs) for _ in range(6)]
    for vector, mode in zip(vectors, basis, strict=True):
        with vector.localForm() as local:
            local.array[:] = mode
    return PETSc.NullSpace().create(vectors=vectors)


def elasticity(domain: Any, data: Any, element: str) -> tuple[Any, Any]:
    """The space of the unknowns and the bilinear form."""
    E, nu = of_cells(domain, data["E"]), of_cells(domain, data["nu"])
    mu, lame = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
    dx = ufl.Measure("dx", domain, metadata=POINTS)
    brick = ufl.VectorElement("Lagrange", domain.ufl_cell(), 1)
    if element == "full":
        space = fem.FunctionSpace(domain, brick)
        u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
        volume = lame * ufl.div(u) * ufl.div(v)
    else:
        space = fem.FunctionSpace(domain, brick * ufl.FiniteElement("DG", domain.ufl_cell(), 0))
        (u, p), (v, q) = ufl.TrialFunctions(space), ufl.TestFunctions(space)
        volume = p * ufl.div(v) + q * ufl.div(u) - p * q / lame
    return space, (2 * mu * ufl.inner(ufl.sym(ufl.grad(u)), ufl.sym(ufl.grad(v))) + volume) * dx


def clamped(space: Any, height: float, stretch: float) -> list[Any]:
    """Bottom held, top moved along z and held across; of a space with pressures, its displacements."""
    found = []
    mixed = space.num_sub_spaces == 2
    own = space.sub(0).collapse()[0] if mixed else space
    for z, shift in ((0.0, 0.0), (height, stretch * height)):
        spaces = (space.sub(0), own) if mixed else space
        dofs = fem.locate_dofs_geometrical(spaces, lambda x, z=z: np.abs(x[2] - z) < 1e-9)
        moved = fem.Function(own)
        moved.interpolate(lambda x, shift=shift: np.stack([0 * x[0], 0 * x[0], 0 * x[0] + shift]))
        found.append(fem.dirichletbc(moved, dofs, space.sub(0)) if mixed else fem.dirichletbc(moved, dofs))
    return found


def solve(data: Any, solver: str, element: str) -> dict[str, float]:
    """Assembly, solution and force of one slice."""
    domain = brick_mesh(data["points"], data["cells"])
    start = time.perf_counter(), time.process_time()
    space, energy = elasticity(domain, data, element)
    v = ufl.TestFunction(space)
    nothing = ufl.inner(fem.Constant(domain, np.zeros(v.ufl_shape)), v) * ufl.dx(domain, metadata=POINTS)
    stiffness, load = fem.form(energy), fem.form(nothing)
    held = clamped(space, float(data["height"]), float(data["stretch"]))
    K = petsc.assemble_matrix(stiffness, bcs=held)
    K.assemble()
    b = petsc.assemble_vector(load)
    petsc.apply_lifting(b, [stiffness], bcs=[held])
    petsc.set_bc(b, held)
    assembled = time.perf_counter(), time.process_time()
    if solver == "gamg":
        K.setNearNullSpace(rigid_motions(space))
    K.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    K.setOption(PETSc.Mat.Option.SPD, element == "full")
    options = PETSc.Options()
    for key, value in SOLVERS[solver].items():
        options[key] = value
    ksp = PETSc.KSP().create(domain.comm)
    ksp.setOperators(K)
    ksp.setFromOptions()
    found = fem.Function(space)
    ksp.solve(b, found.vector)
    found.x.scatter_forward()
    end = time.perf_counter(), time.process_time()
    # the work of the reaction on the moved face is twice the energy
    trial, test = energy.arguments()[::-1]
    work = fem.assemble_scalar(fem.form(ufl.replace(energy, {trial: found, test: found})))
    return {
        "assembly": assembled[0] - start[0],
        "solve": end[0] - assembled[0],
        "seconds": end[0] - start[0],
        "cpu": end[1] - start[1],
        "iterations": ksp.getIterationNumber(),
        "converged": ksp.getConvergedReason(),
        "force": float(work / (float(data["stretch"]) * float(data["height"]))),
    }


def main() -> None:
    """Compile the forms on two bricks first: users pay for that once, and it stays on the disk."""
    file, solver, element = sys.argv[1:4]
    data = dict(np.load(file))
    small = data | {name: data[name][:2] for name in ("cells", "E", "nu")}
    used, small["cells"] = np.unique(small["cells"], return_inverse=True)
    small["points"], small["cells"] = data["points"][used], small["cells"].reshape(2, 8)
    solve(small, "mumps", element)
    result: dict[str, Any] = solve(data, solver, element)
    print(json.dumps(result | {"version": dolfinx.__version__}))


if __name__ == "__main__":
    main()

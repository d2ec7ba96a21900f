"""Our three-dimensional elements and solver beside CalculiX and DOLFINx: same mesh, materials and supports, one thread each.

A slice of the reference cable's section, both end faces clamped, stretched by 1e-3; metals 80 GPa, rubbers 4 MPa. Every program is
a process of its own. Seconds of ours and of DOLFINx are those of assembly and solution, mesh in memory; those of CalculiX are of
the whole program, which also reads its deck (a second per 100 000 bricks). Relative tolerance 1e-8 for all that iterate.

The elements are not the same at any Poisson's ratio: ours is mean dilatation, the bricks of the peers are fully integrated. At
Poisson's ratio 0 all agree; else DOLFINx with a pressure for each brick is our element, and CalculiX is DOLFINx's plain brick.

Programs that are not installed are left out with a sentence. Run: python -m benchmarks.peers [layers ...] (3, 6 and 12 if not
given; half an hour). The last results are in benchmarks/peers.md.
"""

from __future__ import annotations

import json
import pickle
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from benchmarks.calculix_deck import axial_force, find_calculix
from benchmarks.timed_process import run_timed
from geometry import cross_section_mesh, helical_slice, read_cable
from geometry.cell_mesh import SliceMesh
from geometry.material import Material

CABLE = "mcpt-1.9-3.3-3x35"
STRETCH = 1e-3
SYSTEM_PYTHON = "/usr/bin/python3"
PLAN = ((3, 0.45, 3), (3, 0.0, 3), (6, 0.45, 1), (12, 0.45, 1), (3, 0.49, 1))
"""Layers, Poisson's ratio of the rubbers, runs of which the median is printed."""
HEAD = "| bricks | unknowns | nu | program | force N | to ours | iterations | wall s | CPU s | GB | wall / ours | CPU / ours |"


@dataclass(frozen=True)
class Result:
    """Force [N], seconds by clock and processor, peak memory of the process [GB], iterations (0: direct)."""

    force: float
    wall: float
    cpu: float
    memory: float
    iterations: int = 0


def slice_of(layers: int, nu: float) -> SliceMesh:
    """Layers of 1 / 96 of the lay; metals 80 GPa (0.34), rubbers 4 MPa; with nu 0 that is everybody's Poisson's ratio."""
    section = cross_section_mesh(read_cable(CABLE), size=12e-3, kind="quad")
    mesh = helical_slice(section, layers * 2 * np.pi / abs(section.twist_rate) / 96, layers)
    soft, stiff = Material("rubber", 4e6, nu, 1000.0), Material("metal", 80e9, 0.34 if nu else 0.0, 1000.0)
    regions = tuple(replace(r, material=stiff if r.material.E > 1e9 else soft) for r in mesh.regions)
    return replace(mesh, regions=regions)


def clamped_slice(mesh: SliceMesh) -> dict[str, float]:
    """The slice by our elements and solver: force, iterations, seconds."""
    from homogenize.mean_dilatation import stiffness_matrix
    from homogenize.multigrid import Multigrid

    start = time.perf_counter(), time.process_time()
    K = stiffness_matrix(mesh)
    u = np.zeros((len(mesh.points), 3))
    u[mesh.top, 2] = STRETCH * mesh.height
    free = np.setdiff1d(np.arange(len(mesh.points)), np.concatenate([mesh.bottom, mesh.top]))
    unknowns = (3 * free[:, None] + np.arange(3)).ravel()
    inner = sp.bsr_array(K.tocsr()[unknowns][:, unknowns], blocksize=(3, 3))
    found = Multigrid(inner, mesh.points[free], np.inf).solve(-(K @ u.ravel())[unknowns], 1e-8, 5000)
    u.ravel()[unknowns] = found.unknowns
    force = float((K @ u.ravel()).reshape(-1, 3)[mesh.top, 2].sum())
    wall, cpu = time.perf_counter() - start[0], time.process_time() - start[1]
    return {"force": force, "iterations": found.iterations, "seconds": wall, "cpu": cpu}


def by_process(command: list[str]) -> Result:
    """A program that prints its numbers as the last line, in JSON.

    Raises
    ------
    RuntimeError
        If it ends without them.
    """
    run = run_timed(command, Path(__file__).resolve().parents[1])
    if run.code:
        raise RuntimeError(run.output.strip()[-300:] or f"exit code {run.code}")
    said = json.loads(run.output.strip().splitlines()[-1])
    return Result(said["force"], said["seconds"], said["cpu"], run.memory, int(said["iterations"]))


def ours(mesh: SliceMesh) -> Result:
    """Our program in a process of its own."""
    with tempfile.NamedTemporaryFile(suffix=".pickle") as file:
        Path(file.name).write_bytes(pickle.dumps(mesh))
        return by_process([sys.executable, "-m", "benchmarks.peers", "--own", file.name])


def calculix(solver: str) -> Callable[[SliceMesh], Result]:
    """CalculiX with one of its solvers; empty: the one that it takes by itself."""

    def run(mesh: SliceMesh) -> Result:
        force, process = axial_force(mesh, STRETCH, solver)
        return Result(force, process.wall, process.cpu, process.memory)

    return run


def dolfinx(solver: str, element: str) -> Callable[[SliceMesh], Result]:
    """DOLFINx in the Python of the system, see benchmarks/dolfinx_slice.py."""

    def run(mesh: SliceMesh) -> Result:
        material = np.array([(r.material.E, r.material.nu) for r in mesh.regions])[mesh.region_of]
        with tempfile.NamedTemporaryFile(suffix=".npz") as file:
            np.savez(
                file.name, points=mesh.points, cells=mesh.cells, E=material[:, 0], nu=material[:, 1],
                height=mesh.height, stretch=STRETCH,
            )  # fmt: skip
            script = Path(__file__).with_name("dolfinx_slice.py")
            return by_process([SYSTEM_PYTHON, str(script), file.name, solver, element])

    return run


def median(program: Callable[[SliceMesh], Result], mesh: SliceMesh, times: int) -> Result:
    """Median of every number over several runs."""
    runs = [program(mesh) for _ in range(times)]
    middle = {name: statistics.median(getattr(r, name) for r in runs) for name in ("force", "wall", "cpu", "memory")}
    return Result(**middle, iterations=runs[0].iterations)


def programs(layers: int, nu: float) -> dict[str, Callable[[SliceMesh], Result]]:
    """What is run on a mesh: iterative ones always, direct ones where they end in minutes, the equal element on the smallest."""
    chosen: dict[str, Callable[[SliceMesh], Result]] = {"ours": ours}
    if find_calculix() is not None:
        chosen["CalculiX, its own choice"] = calculix("")
        if layers > 3:
            chosen["CalculiX, iterative Cholesky"] = calculix("ITERATIVE CHOLESKY")
    if run_timed([SYSTEM_PYTHON, "-c", "import dolfinx"]).code == 0:
        chosen["DOLFINx, gamg"] = dolfinx("gamg", "full")
        if layers <= 3 and nu:
            chosen["DOLFINx, mumps"] = dolfinx("mumps", "full")
            chosen["DOLFINx, mumps, pressures"] = dolfinx("mumps", "mean")
    return chosen


def compare(layers: int, nu: float, times: int) -> None:
    """The rows of one mesh."""
    mesh = slice_of(layers, nu)
    unknowns = 3 * (len(mesh.points) - len(mesh.bottom) - len(mesh.top))
    own: Result | None = None
    for name, program in programs(layers, nu).items():
        start = f"| {len(mesh.cells)} | {unknowns} | {nu:g} | {name} |"
        try:
            r = median(program, mesh, 1 if "mumps" in name else times)
        except RuntimeError as error:
            print(f"{start} no result: {' '.join(str(error).split())[-160:]} |", flush=True)
            continue
        own = r if name == "ours" else own
        off, wall, cpu = "-", "-", "-"
        if own is not None:
            off, wall, cpu = f"{r.force / own.force - 1:.1e}", f"{r.wall / own.wall:.2f}", f"{r.cpu / own.cpu:.2f}"
        numbers = f"{r.force:.3f} | {off} | {r.iterations or '-'} | {r.wall:.1f} | {r.cpu:.1f} | {r.memory:.2f}"
        print(f"{start} {numbers} | {wall} | {cpu} |", flush=True)


def main() -> None:
    """The rows of the plan."""
    if sys.argv[1:2] == ["--own"]:
        print(json.dumps(clamped_slice(pickle.loads(Path(sys.argv[2]).read_bytes()))))
        return
    if find_calculix() is None:
        print("ccx is not installed here; CalculiX is left out.")
    if run_timed([SYSTEM_PYTHON, "-c", "import dolfinx"]).code:
        print("DOLFINx is not installed for the system's Python; it is left out.")
    print(f"\n{HEAD}\n{'|---' * 12}|", flush=True)
    wanted = {int(word) for word in sys.argv[1:]}
    for layers, nu, times in PLAN:
        if not wanted or layers in wanted:
            compare(layers, nu, times)


if __name__ == "__main__":
    main()

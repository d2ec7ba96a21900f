"""The three-dimensional cell: time, memory and iterations against size, contrast and Poisson's ratio.

Read ratios and iterations; seconds depend on the machine and its load. Tables:

1. assembly of the reference cable's slice, time per element;
2. iterations of tension, torsion, bending and shear over the number of layers, and the time of all of them;
3. iterations over contrast and Poisson's ratio on one slice;
4. with the argument `nested`: all strands of the reference cable, 320 000 hexahedra.

Run: python -m benchmarks.cell_3d [nested]. The last results are in benchmarks/cell_3d.md; other programs on the same mesh:
benchmarks/peers.md.
"""

from __future__ import annotations

import resource
import sys
import time
from dataclasses import replace

import numpy as np

from geometry import cross_section_mesh, helical_slice, read_cable
from geometry.cell_mesh import SliceMesh
from geometry.material import Material
from homogenize import solve_periodic_cell, strand_stiffness
from homogenize.mean_dilatation import stiffness_matrix

CABLE = "mcpt-1.9-3.3-3x35"


def slice_of(layers: int, per_pitch: int = 96) -> SliceMesh:
    """Layers of bricks, each 1 / `per_pitch` of the lay high."""
    section = cross_section_mesh(read_cable(CABLE), size=12e-3, kind="quad")
    return helical_slice(section, layers * 2 * np.pi / abs(section.twist_rate) / per_pitch, layers)


def with_materials(mesh: SliceMesh, nu: float, contrast: float) -> SliceMesh:
    """Rubbers of Poisson's ratio nu, metals `contrast` times as stiff as 5 MPa."""
    soft = Material("rubber", 5e6, nu, 1000.0)
    stiff = Material("metal", 5e6 * contrast, 0.34, 1000.0)
    regions = tuple(replace(r, material=stiff if r.material.E > 1e9 else soft) for r in mesh.regions)
    return replace(mesh, regions=regions)


def assembly() -> None:
    """Table 1."""
    print("\n1. Assembly\n\n| bricks | unknowns | wall s | microseconds a brick |\n|---|---|---|---|")
    for layers in (1, 4, 12):
        mesh = slice_of(layers)
        start = time.perf_counter()
        stiffness_matrix(mesh)
        seconds = time.perf_counter() - start
        print(f"| {len(mesh.cells)} | {3 * len(mesh.points)} | {seconds:.2f} | {1e6 * seconds / len(mesh.cells):.0f} |")


def heights() -> None:
    """Table 2."""
    print(
        "\n2. All loads, default tolerance\n\n| layers | unknowns | iterations | complexity | wall s | CPU s |\n|---|---|---|---|---|---|"
    )
    for layers in (1, 2, 4):
        report(str(layers), slice_of(layers))


def contrasts() -> None:
    """Table 3."""
    print("\n3. Contrast and Poisson's ratio, one layer")
    print("\n| case | unknowns | iterations | complexity | wall s | CPU s |\n|---|---|---|---|---|---|")
    mesh = slice_of(1)
    for contrast in (1.0, 100.0, 20000.0):
        report(f"contrast {contrast:g}, nu 0.45", with_materials(mesh, 0.45, contrast))
    for nu in (0.3, 0.49, 0.499, 0.4999):
        report(f"contrast 20000, nu {nu:g}", with_materials(mesh, nu, 20000.0))


def report(name: str, mesh: SliceMesh) -> None:
    """Solve all loads and print one row."""
    wall, cpu = time.perf_counter(), time.process_time()
    cell = solve_periodic_cell(mesh, bending=True)
    counts = ", ".join(str(n) for n in cell.iterations)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    print(f"| {name} | {cell.unknowns} | {counts} | {cell.complexity:.2f} | {wall:.1f} | {cpu:.1f} |", flush=True)


def nested() -> None:
    """Table 4."""
    start = time.perf_counter(), time.process_time()
    cell = strand_stiffness(
        read_cable(CABLE), elements=320_000, bending=True, progress=lambda f, s: print(f"{f:.2f} {s}", flush=True)
    )
    print(
        f"wall {time.perf_counter() - start[0]:.0f} s, CPU {time.process_time() - start[1]:.0f} s, iterations {cell.iterations}"
    )
    print(cell.section)


def main() -> None:
    """Run the tables."""
    if "nested" in sys.argv:
        nested()
    else:
        assembly()
        heights()
        contrasts()
    print(f"\npeak memory of the process {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6:.2f} GB")


if __name__ == "__main__":
    main()

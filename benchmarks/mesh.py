"""Time and memory of meshing the reference cable strand by strand, against the number of elements.

Three tables, ratios within one run:

1. the cell of double helices, from the file to the mesh with its volumes and quality; every row in a process of its own, so that
   its peak memory is its own;
2. doubling the nodes of all interfaces between strands and round the conductors, against meshing;
3. the peer: gmsh's own tetrahedra of the same seven strands of one power core (OpenCASCADE solids, over the same height), without
   anything round them. Not the same mesh: tetrahedra of 0.6 mm; hexahedra of 0.4 mm across the strand and 2.2 mm along it.

Run: python -m benchmarks.mesh (about a minute). The last results are in benchmarks/mesh.md.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from geometry import (
    cell_of,
    double_nodes,
    interfaces,
    nested_cell,
    read_cable,
    select_interfaces,
    slice_record,
    write_solids,
)
from geometry.gmsh_session import gmsh_session

CABLE = "mcpt-1.9-3.3-3x35"
ELEMENTS = (160_000, 320_000, 640_000, 1_280_000)
STRAND_EDGE = 0.6e-3
"""Edge length of the peer's tetrahedra [m], between the width and the length of the strands' hexahedra at 320 000."""


def one_cell(elements: int) -> dict[str, Any]:
    """Record of one cell, with the seconds of its steps."""
    cable = read_cable(CABLE)
    start = time.perf_counter()
    cell = nested_cell(cable, elements=elements)
    meshed = time.perf_counter() - start
    record = slice_record(cable, cell, meshed, cell_of(cable))
    start = time.perf_counter()
    parted = double_nodes(cell, select_interfaces(interfaces(cell), "strand-strand", "conductor-insulation"))
    record["doubling"] = time.perf_counter() - start
    record["copies"] = len(parted.mesh.points) - len(cell.points)
    return record


def cells() -> None:
    """Tables 1 and 2."""
    print(f"\n{CABLE}, strand by strand over its common period")
    print(
        f"{'hexahedra':>10} {'others':>8} {'nodes':>9} {'mesh s':>7} {'us/cell':>8} {'peak GB':>8} {'worst J':>8} "
        f"{'below .2 %':>10} {'volume %':>9} {'doubling s':>11} {'copies':>8}"
    )
    for elements in ELEMENTS:
        command = [sys.executable, "-m", "benchmarks.mesh", str(elements)]
        r = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
        worst = max(abs(v["volume"] / v["closed_form"] - 1) for v in r["regions"].values())
        print(
            f"{r['hexes']:10d} {r['elements'] - r['hexes']:8d} {r['nodes']:9d} {r['seconds']:7.2f} "
            f"{1e6 * r['seconds'] / r['elements']:8.1f} {r['peak_memory'] / 1e9:8.2f} {r['min_scaled_jacobian']:8.3f} "
            f"{100 * r['quality']['below_0.2']:10.2f} {100 * worst:9.3f} {r['doubling']:11.2f} {r['copies']:8d}",
            flush=True,
        )


def peer() -> None:
    """Table 3."""
    cable = read_cable(CABLE)
    height = cell_of(cable).height  # type: ignore[union-attr]
    start = time.perf_counter()
    cell = nested_cell(cable, elements=320_000)
    ours = time.perf_counter() - start
    names = [k for k, region in enumerate(cell.regions) if region.name.startswith("power core 1 strand")]
    hexahedra = cell.blocks[0]
    strands = int(np.isin(hexahedra.region_of, names).sum())
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "strands.brep"
        start = time.perf_counter()
        write_solids(cable, path, height, ("conductor",), level="strand")
        swept = time.perf_counter() - start
        start = time.perf_counter()
        tetrahedra = _tetrahedra(path)
        theirs = time.perf_counter() - start
    print("\nseven strands of one power core, 78 mm: swept hexahedra and gmsh's tetrahedra on the solids")
    print(
        f"hexahedra {strands:8d} of {cell.count('hexahedron')} in {ours:.1f} s for the whole cable, end faces match, shared nodes"
    )
    print(
        f"tetrahedra {tetrahedra:7d} in {theirs:.1f} s (solids {swept:.1f} s) for these strands alone, apart from each other; "
        f"cells per second {cell.count('hexahedron') / ours:.0f} against {tetrahedra / theirs:.0f}: ratio "
        f"{cell.count('hexahedron') / ours / (tetrahedra / theirs):.1f}"
    )


def _tetrahedra(path: Path) -> int:
    """Number of tetrahedra that gmsh makes of the first seven solids of power core 1 in a file [mm]."""
    with gmsh_session("peer") as gmsh:
        gmsh.model.occ.importShapes(str(path))
        gmsh.model.occ.synchronize()
        volumes = [tag for _, tag in gmsh.model.getEntities(3)]
        gmsh.model.occ.remove([(3, tag) for tag in volumes[10:]] + [(3, tag) for tag in volumes[:3]], recursive=True)
        gmsh.model.occ.synchronize()
        for option in ("MeshSizeMin", "MeshSizeMax"):
            gmsh.option.setNumber(f"Mesh.{option}", 1e3 * STRAND_EDGE)
        gmsh.model.mesh.generate(3)
        return len(gmsh.model.mesh.getElementsByType(4)[0])


def main() -> None:
    """Print all tables."""
    cells()
    peer()


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(json.dumps(one_cell(int(sys.argv[1]))))
    else:
        main()

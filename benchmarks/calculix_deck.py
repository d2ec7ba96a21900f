"""A clamped slice for CalculiX: input deck, run, reaction. Peer of the three-dimensional cell, called as a separate process."""

from __future__ import annotations

import re
import shutil
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.timed_process import Process, run_timed
from geometry.cell_mesh import SliceMesh


def find_calculix() -> str | None:
    """Path of `ccx`, or None where it is not installed."""
    return shutil.which("ccx")


def deck(mesh: SliceMesh, stretch: float, solver: str = "") -> str:
    """C3D8 bricks, bottom clamped, top moved by stretch * height along z and held across; no `solver`: its own choice."""
    lines = ["*NODE"]
    lines += [f"{i + 1},{x:.12e},{y:.12e},{z:.12e}" for i, (x, y, z) in enumerate(mesh.points)]
    for number in range(len(mesh.regions)):
        own = np.flatnonzero(mesh.region_of == number)
        lines.append(f"*ELEMENT,TYPE=C3D8,ELSET=R{number}")
        lines += [f"{e + 1}," + ",".join(str(a + 1) for a in mesh.cells[e]) for e in own]
    for name, nodes in (("BOTTOM", mesh.bottom), ("TOP", mesh.top)):
        lines.append(f"*NSET,NSET={name}")
        lines += [str(a + 1) for a in nodes]
    for number, region in enumerate(mesh.regions):
        m = region.material
        lines += [f"*MATERIAL,NAME=M{number}", "*ELASTIC", f"{m.E:.10e},{m.nu:.10f}"]
        lines.append(f"*SOLID SECTION,ELSET=R{number},MATERIAL=M{number}")
    lines += [
        "*BOUNDARY",
        "BOTTOM,1,3",
        "*STEP",
        f"*STATIC,SOLVER={solver}" if solver else "*STATIC",
        "*BOUNDARY",
        "BOTTOM,1,3",
        "TOP,1,2",
    ]
    lines += [f"TOP,3,3,{stretch * mesh.height:.12e}", "*NODE PRINT,NSET=TOP,TOTALS=ONLY", "RF", "*END STEP", ""]
    return "\n".join(lines)


def axial_force(mesh: SliceMesh, stretch: float, solver: str = "") -> tuple[float, Process]:
    """Axial force [N] on the top, and how the program ran.

    Raises
    ------
    RuntimeError
        If the program gives no result; the message ends with what it printed last.
    """
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "slice.inp").write_text(deck(mesh, stretch, solver), encoding="ascii")
        run = run_timed([str(find_calculix()), "-i", "slice"], folder)
        result = Path(folder, "slice.dat")
        found = result.read_text(encoding="ascii") if result.is_file() else ""
    numbers = re.findall(r"[-+]?\d\.\d+E[-+]\d+", found)
    if len(numbers) < 3:
        raise RuntimeError(
            f"CalculiX gave no reaction (exit code {run.code}); it said last: {run.output.strip()[-300:]}"
        )
    return float(numbers[-1]), run

"""The constructed specimen of the published test: refinement of its mesh, its ends, and the processor time.

`python -m benchmarks.specimen` prints the tables of specimen.md. Circles are drawn in the plane, as the compared code had them.
"""

from __future__ import annotations

import dataclasses
import tempfile
import time
from pathlib import Path

import numpy as np

from geometry import Cable, CrossSectionMesh, cable_files, read_cable
from homogenize.specimen import AxialGrading, LoadCase, Specimen, read_end, solve_specimen
from homogenize.specimen.apparent_modulus import apparent_moduli
from homogenize.specimen.specimen_mesh import specimen_mesh

NAME, LENGTH, PITCH = "paper-specimen-3x35", 0.1823, 0.388
LOADS = (LoadCase("tension", 2000.0), LoadCase("shear", 500.0, "x"), LoadCase("shear", 500.0, "y"))
OTHER_CODE = "| another code, converged | | | 127 | 35.3 | 35.0 | 4.18 | 10.0 | 9.7 | |"
COARSE = AxialGrading(end_size=0.1, growth=4.0, largest=1.5)
FINE = AxialGrading(end_size=0.04, growth=2.0, largest=0.6)
CASES = ((8.0, COARSE), (4.5, AxialGrading()), (4.5, FINE), (3.0, FINE))
"""Element size [mm] and layers."""
ENDS = (
    "uniform",
    "traction:sheath+interstices",
    "traction:conductor",
    "plate",
    "plate:no-tilt,no-twist",
    "grip:conductor",
)


def main() -> None:
    """Print both tables."""
    cable = straight_cable()
    print(
        "| size mm | layers | unknowns | E | Gx | Gy | uz | ux | uy | CPU s |\n|---|---|---|---|---|---|---|---|---|---|"
    )
    for size, grading in CASES:
        print(row(f"{size:g}", turned(cable, size), Specimen(LENGTH, grading=grading)), flush=True)
    print(
        OTHER_CODE
        + "\n\n| loaded end | layers | unknowns | E | Gx | Gy | uz | ux | uy | CPU s |\n|---|---|---|---|---|---|---|---|---|---|"
    )
    mesh = turned(cable, 8.0)
    for words in ENDS:
        print(row(words, mesh, Specimen(LENGTH, loaded=read_end(words), grading=COARSE)), flush=True)


def straight_cable() -> Cable:
    """The shipped cable without its lay, so that wires have circles as their traces."""
    text = cable_files()[NAME].read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.startswith(("lay = ", "hand = "))]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "straight.toml"
        path.write_text("\n".join(lines), encoding="utf-8")
        return read_cable(str(path))


def turned(cable: Cable, size: float) -> CrossSectionMesh:
    """Its mesh at an element size [mm], turned along the axis."""
    return dataclasses.replace(specimen_mesh(cable, size=1e-3 * size), twist_rate=2 * np.pi / PITCH)


def row(name: str, mesh: CrossSectionMesh, specimen: Specimen) -> str:
    """One solved specimen as a line of the table."""
    start = time.process_time()
    solution = solve_specimen(specimen, mesh, LOADS)
    seconds = time.process_time() - start
    t, x, y = apparent_moduli(solution)
    moduli = " | ".join(f"{a.modulus / 1e6:.2f}" for a in (t, x, y))
    displacements = " | ".join(f"{1e3 * a.u_max:.3f}" for a in (t, x, y))
    layers = solution.operator.axial.layers
    return f"| {name} | {layers} | {solution.unknowns} | {moduli} | {displacements} | {seconds:.0f} |"


if __name__ == "__main__":
    main()

"""`helicable mesh`: the helical slice of a cable as a mesh file."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated, Any

import typer

from geometry import Cable, read_cable, slice_of_size, slice_record, write_mesh, write_solids
from helicable.options import CableArgument, JsonOption
from helicable.screen import progress, say, table, write_json

CAD_FORMATS = (".step", ".stp", ".brep")


def mesh(
    cable: CableArgument,
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE", help="Mesh file .vtu or .msh; or .step or .brep for CAD solids.")
    ] = Path("cell.vtu"),
    elements: Annotated[int, typer.Option(help="At least that many volume elements.")] = 10_000,
    json: JsonOption = None,
) -> None:
    """Mesh one helical slice of the cable with hexahedra whose end faces match node for node.

    Example: `helicable mesh mcpt-1.9-3.3-3x35 --elements 20000 --out cell.vtu`
    """
    made = read_cable(cable)
    if out.suffix.lower() in CAD_FORMATS:
        write_json(json, _solids(made, out))
        return
    start = time.perf_counter()
    with progress("meshing") as tell:
        slice_mesh = slice_of_size(made, elements, progress=tell)
        write_mesh(slice_mesh, out)
    record = slice_record(made, slice_mesh, time.perf_counter() - start)
    rows = [
        ("hexahedra", f"{record['hexes']}"),
        ("nodes", f"{record['nodes']}"),
        ("height of the slice", f"{1e3 * record['height']:.3f} mm"),
        ("smallest scaled Jacobian", f"{record['min_scaled_jacobian']:.3f}"),
        ("end faces match", "yes" if record["matched_faces"] else "NO"),
    ]
    table(f"{made.name}: helical slice", ("", "value"), rows, right=(1,))
    regions = [
        (
            name,
            f"{1e9 * r['volume']:.3f}",
            f"{1e9 * r['closed_form']:.3f}",
            f"{100 * (r['volume'] / r['closed_form'] - 1):+.2f}",
        )
        for name, r in record["regions"].items()
    ]
    table("Volumes", ("region", "mesh mm3", "closed form mm3", "difference %"), regions, right=(1, 2, 3))
    say(f"written: {out}")
    write_json(json, record)


def _solids(cable: Cable, out: Path) -> dict[str, Any]:
    """Half a lay of the cable as solids, or four diameters of a straight one; the record for machines."""
    length = 4 * cable.outer_diameter if cable.lay is None else cable.lay / 2
    with progress("sweeping solids") as tell:
        tell(0.1, f"{1e3 * length:.0f} mm of {cable.name}")
        solids = write_solids(cable, out, length)
    rows = [(s.name, f"{1e9 * s.volume:.2f}", f"{1e9 * s.closed_form:.2f}") for s in solids]
    table(
        f"{cable.name}: solids of {1e3 * length:.0f} mm", ("part", "volume mm3", "closed form mm3"), rows, right=(1, 2)
    )
    say(f"written: {out} (millimetres)")
    volumes = {s.name: {"volume": s.volume, "closed_form": s.closed_form} for s in solids}
    return {"schema": 1, "cable": cable.name, "length": length, "solids": volumes, "file": str(out)}

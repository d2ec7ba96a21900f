"""`helicable mesh`: one cell of a cable as a mesh file, or its solids for CAD."""

from __future__ import annotations

import re
import time
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from geometry import (
    Cable,
    CommonPeriod,
    DoubledMesh,
    MeshError,
    SliceMesh,
    SpecError,
    SweptCell,
    cell_of,
    double_nodes,
    draw_quality,
    draw_swept_cell,
    interfaces,
    nested_cell,
    read_cable,
    select_interfaces,
    slice_of_size,
    slice_record,
    write_mesh,
    write_solids,
)
from geometry.units import read_quantity
from helicable.options import CableArgument, JsonOption
from helicable.screen import folder, progress, say, table, write_json

CAD_FORMATS = (".step", ".stp", ".brep")
LEVELS = ("strand", "conductor")


def mesh(
    cable: CableArgument,
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE", help="Mesh file .vtu or .msh; or .step or .brep for CAD solids.")
    ] = Path("cell.vtu"),
    elements: Annotated[int, typer.Option(help="At least that many volume elements.")] = 10_000,
    level: Annotated[
        str | None,
        typer.Option(
            "--level",
            metavar="|".join(LEVELS),
            help="Strands one by one (default if the file has any), or each conductor as a cylinder.",
        ),
    ] = None,
    height: Annotated[
        str | None,
        typer.Option(
            "--height",
            metavar="LENGTH",
            help='Height of the cell, such as "20 mm"; strands need a multiple of their period.',
        ),
    ] = None,
    lay_tolerance: Annotated[
        str,
        typer.Option(
            "--lay-tolerance", metavar="ANGLE", help="Largest change of a lay angle that gives strands a common period."
        ),
    ] = "0.5 deg",
    separate: Annotated[
        str | None,
        typer.Option(
            "--separate", metavar="PAIRS", help='Double the nodes of interfaces: "strand-strand,conductor-insulation".'
        ),
    ] = None,
    flat_width: Annotated[
        str | None,
        typer.Option(
            "--flat-width",
            metavar="LENGTH",
            help='Width of the flats on which strands touch, such as "0.2 mm"; the cable file\'s, or 0.3 strand radii, if left out.',
        ),
    ] = None,
    pictures: Annotated[
        Path | None,
        typer.Option(
            "--pictures", metavar="DIR", help="Draw the cell and the quality of its elements into this folder."
        ),
    ] = None,
    json: JsonOption = None,
) -> None:
    """Mesh one cell of the cable, strand by strand, with hexahedra whose end faces match node for node.

    Example: `helicable mesh mcpt-1.9-3.3-3x35 --elements 320000 --out cell.vtu --pictures pictures`
    """
    made = read_cable(cable)
    deep = _is_deep(made, level)
    if out.suffix.lower() in CAD_FORMATS:
        write_json(json, _solids(made, out, "strand" if deep else "conductor"))
        return
    start = time.perf_counter()
    with progress("meshing") as tell:
        length = None if height is None else read_quantity(height, "m", "--height")
        period: CommonPeriod | None = None
        flat = None if flat_width is None else read_quantity(flat_width, "m", "--flat-width")
        if flat is not None and not deep:
            raise SpecError(
                "--flat-width: conductors are meshed as cylinders here, there are no strands that touch; leave it out."
            )
        if deep:
            tolerance = _angle(lay_tolerance)
            period = cell_of(made, tolerance=tolerance)
            cell: SliceMesh | SweptCell = nested_cell(
                made, elements=elements, height=length, lay_tolerance=tolerance, flat_width=flat, progress=tell
            )
        else:
            cell = slice_of_size(made, elements, length, progress=tell)
        parted = _parted(cell, separate)
        tell(0.9, f"writing {out.name}")
        write_mesh(parted.mesh if parted else cell, out, parted.pairs if parted else ())
    record = slice_record(made, parted or cell, time.perf_counter() - start, period)
    show_cell(made, record)
    say(f"written: {out}")
    write_json(json, record)
    if pictures is not None:
        with progress("drawing") as tell:
            tell(0.1, "cell cut open")
            draw_swept_cell(cell, folder(pictures) / "cell.png", made.title)
            tell(0.7, "quality of its elements")
            draw_quality(cell, pictures / "quality.png")
        say(f"written: {pictures / 'cell.png'}, {pictures / 'quality.png'}")


def _is_deep(cable: Cable, level: str | None) -> bool:
    """Whether strands are meshed one by one."""
    makes = [made for part in cable.parts if (made := cable.conductor_of(part)) is not None]
    stranded = any(made.strand is not None for made in makes)
    if level is not None and level not in LEVELS:
        raise SpecError(f'--level: "{level}" is not known; choose {" or ".join(LEVELS)}.')
    if level == "strand" and not stranded:
        raise SpecError(f"--level: no conductor of {cable.name} is described strand by strand; leave the option out.")
    return stranded and level != "conductor"


def _angle(text: str) -> float:
    """The tolerance [rad]; a bare number is refused, because it could be meant in degrees."""
    try:
        float(text)
    except ValueError:
        return read_quantity(text, "rad", "--lay-tolerance")
    raise SpecError(f'--lay-tolerance: the number {text} has no unit; write it with its unit, such as "{text} deg".')


def _parted(cell: SliceMesh | SweptCell, words: str | None) -> DoubledMesh | None:
    """The cell with doubled nodes along the interfaces that the words mean; None without words."""
    if words is None:
        return None
    wanted = [word.strip() for word in words.split(",") if word.strip()]
    if not wanted:
        raise MeshError("--separate: name at least one pair of parts, such as strand-strand.")
    return double_nodes(cell, select_interfaces(interfaces(cell), *wanted))


def show_cell(cable: Cable, record: dict[str, Any]) -> None:
    """Print what was meshed: counts, quality, lays that were adjusted, volumes, interfaces."""
    kinds = (("hexahedra", "hexes"), ("prisms", "prisms"), ("pyramids", "pyramids"), ("tetrahedra", "tets"))
    rows = [(name, f"{record[key]:,}".replace(",", " ")) for name, key in kinds if record[key]]
    rows += [
        ("nodes", f"{record['nodes']:,}".replace(",", " ")),
        ("height of the cell", f"{1e3 * record['height']:.3f} mm"),
        ("smallest scaled Jacobian", f"{record['min_scaled_jacobian']:.3f}"),
        ("elements below 0.2", f"{100 * record['quality']['below_0.2']:.2f} %"),
        ("end faces match", "yes" if record["matched_faces"] else "NO"),
        ("time, peak memory", f"{record['seconds']:.1f} s, {(record['peak_memory'] or 0) / 1e9:.2f} GB"),
    ]
    table(f"{cable.name}: cell", ("", "value"), rows, right=(1,))
    counts, edges = record["quality"]["histogram"], record["quality"]["edges"]
    table("Quality", ("scaled Jacobian", "elements", ""), _bars(counts, edges), right=(1,))
    if record.get("lays"):
        heads = ("strands of", "lay mm", "in the cell mm", "lay angle deg", "change deg")
        table("Lays that give a common period", heads, _lay_rows(record["lays"]), right=(1, 2, 3, 4))
    heads = ("region", "mesh mm3", "closed form mm3", "difference %")
    table("Volumes", heads, _volume_rows(record["regions"]), right=(1, 2, 3))
    rows = [
        (name, f"{1e6 * area:.1f}", "yes" if name in record["separated"] else "")
        for name, area in record["interfaces"].items()
    ]
    table("Interfaces", ("between", "area mm2", "nodes doubled"), rows, right=(1,))
    for sentence in dict.fromkeys(re.sub(r" core \d+ ", " core ", note) for note in record["notes"]):
        say(sentence)


def _bars(counts: list[int], edges: list[float]) -> list[tuple[str, str, str]]:
    """Histogram in text: tenths of the scaled Jacobian, bars by the share of elements."""
    lower = np.floor(10 * np.clip(np.asarray(edges[:-1]) + 1e-9, 0, 0.999)).astype(int)
    tenths = np.bincount(lower, counts, 10).astype(int)
    bar = lambda n: "#" * int(np.ceil(40 * n / max(tenths.max(), 1)))  # noqa: E731
    return [
        (f"{k / 10:.1f} - {(k + 1) / 10:.1f}", f"{n:,}".replace(",", " "), bar(n)) for k, n in enumerate(tenths) if n
    ]


def _lay_rows(lays: list[dict[str, Any]]) -> list[tuple[str, ...]]:
    def length(lay: float | None) -> str:
        return "straight" if lay is None else f"{1e3 * lay:.2f}"

    return [
        (
            lay["name"],
            length(lay["nominal_lay"]),
            length(lay["lay"]),
            f"{np.degrees(lay['lay_angle']):.3f}",
            f"{np.degrees(lay['change']):+.3f}",
        )
        for lay in lays
    ]


def _volume_rows(regions: dict[str, dict[str, float]]) -> list[tuple[str, ...]]:
    """One row for each region, the strands of a conductor in one; the difference is the largest of the group."""
    groups: dict[str, list[dict[str, float]]] = {}
    for name, volumes in regions.items():
        groups.setdefault(re.sub(r" strand \d+$", " strands", name), []).append(volumes)
    rows = []
    for name, members in groups.items():
        worst = max((v["volume"] / v["closed_form"] - 1 for v in members), key=abs)
        label = name if len(members) == 1 else f"{name} ({len(members)})"
        total, closed = (sum(v[key] for v in members) for key in ("volume", "closed_form"))
        rows.append((label, f"{1e9 * total:.2f}", f"{1e9 * closed:.2f}", f"{100 * worst:+.3f}"))
    return rows


def _solids(cable: Cable, out: Path, level: str) -> dict[str, Any]:
    """Half a lay of the cable as solids, or four diameters of a straight one; the record for machines."""
    length = 4 * cable.outer_diameter if cable.lay is None else cable.lay / 2
    with progress("sweeping solids") as tell:
        tell(0.1, f"{1e3 * length:.0f} mm of {cable.name}")
        solids = write_solids(cable, out, length, level=level)
    rows = [(s.name, f"{1e9 * s.volume:.2f}", f"{1e9 * s.closed_form:.2f}") for s in solids]
    table(
        f"{cable.name}: solids of {1e3 * length:.0f} mm", ("part", "volume mm3", "closed form mm3"), rows, right=(1, 2)
    )
    say(f"written: {out} (millimetres)")
    volumes = {s.name: {"volume": s.volume, "closed_form": s.closed_form} for s in solids}
    return {"schema": 1, "cable": cable.name, "length": length, "solids": volumes, "file": str(out)}

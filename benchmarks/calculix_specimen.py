r"""The finite specimen by CalculiX: the section mesh swept to 15-node wedges, input deck, run, apparent moduli.

The same triangles as in :mod:`homogenize.specimen`, but assembled in three dimensions, in fixed axes, with the serendipity wedge
C3D15 (no nodes in the quadrangular faces) whose edges follow the helix as parabolas. One end fixed, nodal forces of the uniform
traction on the other. The moduli are read from its nodal displacements by means of their gradient over the volume,
:math:`\langle\nabla u\rangle = \frac1V \sum_e \int \nabla N\, u`, taken here over the same wedges.

`python -m benchmarks.calculix_specimen` prints the table of calculix_specimen.md.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.calculix_deck import find_calculix
from geometry import CrossSectionMesh, read_cable
from geometry.cell_mesh import Region
from geometry.errors import MeshError, SpecError
from homogenize.benchmark_sections import rings
from homogenize.section_field import FloatArray, SectionField, section_field
from homogenize.specimen import AxialGrading, LoadCase, Specimen, solve_specimen
from homogenize.specimen.apparent_modulus import apparent_moduli
from homogenize.specimen.load_case import nodal_forces, turn
from homogenize.specimen.specimen_mesh import specimen_mesh

EDGES = ((0, 1), (1, 2), (2, 0))
"""Corners of the edges whose middles are nodes 7 to 9, and 10 to 12, of the wedge."""
LOADS = (LoadCase("tension", 2000.0), LoadCase("shear", 500.0, "x"), LoadCase("shear", 500.0, "y"))
GRADINGS = tuple(
    AxialGrading(end_size=size, growth=growth, largest=largest)
    for size, growth, largest in ((0.15, 2.0, 0.5), (0.08, 1.7, 0.35), (0.03, 1.7, 0.35))
)
"""Layers of the wedges; this package has polynomials of degree 4 on the layers that it takes by itself."""


@dataclass(frozen=True)
class SweptWedges:
    """Wedges with 15 nodes between z = 0 and z = `levels[-1]`.

    Attributes
    ----------
    points : (nodes, 3) [m], fixed axes
    cells : (wedges, 15) in the order of C3D15
    region_of : (wedges,) index in `regions`
    bottom, top : nodes of the ends; `top` in the order of the nodes of the section
    angle : by which the section stands turned at `top` [rad]
    """

    points: FloatArray
    cells: NDArray[np.int64]
    region_of: NDArray[np.int64]
    regions: tuple[Region, ...]
    bottom: NDArray[np.int64]
    top: NDArray[np.int64]
    angle: float


@dataclass(frozen=True)
class CalculixAnswer:
    """Displacements (nodes, 3, loads) [m] of a run, and its wall time [s]."""

    displacement: FloatArray
    seconds: float


def swept_wedges(mesh: CrossSectionMesh, levels: FloatArray) -> SweptWedges:
    """Sweep the quadratic triangles of a section along its helix; layers between the `levels` [m], the first at 0.

    Raises
    ------
    MeshError
        If the section is not of triangles.
    """
    field = section_field(mesh)
    if len(field.cells) != 6:
        raise MeshError("wedges are swept from triangles; mesh the cross-section with kind triangle6.")
    flat = _corners_and_middles(field)
    triangles, points = flat[:, :3], field.nodes.T
    n, corners = len(points), np.unique(triangles)
    place_of_corner = np.full(n, -1)
    place_of_corner[corners] = np.arange(len(corners))
    stride, places, cells = n + len(corners), [], []
    for k, z in enumerate(levels):
        places.append(_turned(mesh, points, z))
        if k == len(levels) - 1:
            break
        places.append(_turned(mesh, points[corners], (z + levels[k + 1]) / 2))
        low, high = k * stride, (k + 1) * stride
        upright = low + n + place_of_corner[triangles]
        parts = (low + flat[:, :3], high + flat[:, :3], low + flat[:, 3:], high + flat[:, 3:], upright)
        cells.append(np.concatenate(parts, axis=1))
    layers = len(levels) - 1
    top = layers * stride + np.arange(n)
    return SweptWedges(
        np.concatenate(places),
        np.concatenate(cells),
        np.tile(mesh.region_of, layers),
        mesh.regions,
        np.arange(n),
        top,
        mesh.twist_rate * float(levels[-1]),
    )


def _corners_and_middles(field: SectionField) -> NDArray[np.int64]:
    """(triangles, 6) corners counter-clockwise, then the middles of EDGES in their order, nearest the middle of the straight edge."""
    p, c = field.nodes.T, field.cells.T
    u, v = p[c[:, 1]] - p[c[:, 0]], p[c[:, 2]] - p[c[:, 0]]
    clockwise = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] < 0
    corners = np.where(clockwise[:, None], c[:, [0, 2, 1]], c[:, :3])
    found = [corners]
    for a, b in EDGES:
        half = (p[corners[:, a]] + p[corners[:, b]]) / 2
        distance = np.linalg.norm(p[c[:, 3:]] - half[:, None], axis=2)
        found.append(c[np.arange(len(c)), 3 + distance.argmin(axis=1)][:, None])
    return np.concatenate(found, axis=1)


def _turned(mesh: CrossSectionMesh, points: FloatArray, z: float) -> FloatArray:
    flat = np.column_stack([points, np.full(len(points), z)])
    return flat @ turn(mesh.twist_rate * z).T


def end_forces(mesh: CrossSectionMesh, wedges: SweptWedges, loads: Sequence[LoadCase]) -> FloatArray:
    """(nodes of the section, 3, loads) [N] forces of the traction on the top, fixed axes; the face is the same quadratic triangles."""
    field = section_field(mesh)
    everywhere = np.ones(len(mesh.regions), dtype=bool)
    local = [nodal_forces(load, field, everywhere, wedges.angle).reshape(-1, 3) for load in loads]
    return np.stack([f @ turn(wedges.angle).T for f in local], axis=-1)


def deck(wedges: SweptWedges, forces: FloatArray) -> str:
    """Input deck: one linear static step for each load; displacements of all nodes are printed."""
    lines = ["*NODE,NSET=ALL"]
    lines += [f"{i + 1},{x:.12e},{y:.12e},{z:.12e}" for i, (x, y, z) in enumerate(wedges.points)]
    for number, region in enumerate(wedges.regions):
        own = np.flatnonzero(wedges.region_of == number)
        if not len(own):
            continue
        lines.append(f"*ELEMENT,TYPE=C3D15,ELSET=R{number}")
        lines += [f"{e + 1}," + ",".join(str(a + 1) for a in wedges.cells[e]) for e in own]
        m = region.material
        lines += [f"*MATERIAL,NAME=M{number}", "*ELASTIC", f"{m.E:.10e},{m.nu:.10f}"]  # pyright: ignore[reportAttributeAccessIssue]
        lines.append(f"*SOLID SECTION,ELSET=R{number},MATERIAL=M{number}")
    lines.append("*NSET,NSET=BOTTOM")
    lines += [str(a + 1) for a in wedges.bottom]
    lines += ["*BOUNDARY", "BOTTOM,1,3"]
    for k in range(forces.shape[2]):
        lines += ["*STEP", "*STATIC", "*CLOAD,OP=NEW"]
        for node, force in zip(wedges.top, forces[:, :, k], strict=True):
            lines += [f"{node + 1},{x + 1},{f:.12e}" for x, f in enumerate(force) if f]
        lines += ["*NODE PRINT,NSET=ALL", "U", "*END STEP"]
    return "\n".join([*lines, ""])


def run_calculix(text: str, nodes: int) -> CalculixAnswer:
    """Run a deck that prints the displacements of `nodes` nodes in each step.

    Raises
    ------
    RuntimeError
        If the program gives no result; the message ends with what it printed last.
    """
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "specimen.inp").write_text(text, encoding="ascii")
        start = time.perf_counter()
        command = [str(find_calculix()), "-i", "specimen"]
        run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        seconds = time.perf_counter() - start
        result = Path(folder, "specimen.dat")
        rows = [line.split() for line in result.read_text(encoding="ascii").splitlines()] if result.is_file() else []
    values = np.array([[float(v) for v in row[1:]] for row in rows if len(row) == 4 and row[0].isdigit()])
    if not len(values) or len(values) % nodes:
        raise RuntimeError(f"CalculiX gave no displacements; it said last: {run.stdout.strip()[-300:]}")
    return CalculixAnswer(values.reshape(-1, nodes, 3).transpose(1, 2, 0), seconds)


def volume_and_mean_gradient(wedges: SweptWedges, displacement: FloatArray) -> tuple[float, FloatArray]:
    """Volume [m^3], and mean of du_x / dx_d over it, shape (component, direction, loads)."""
    r, s, t, weight = _wedge_points()
    slopes = np.array([_wedge_slopes(*point) for point in zip(r, s, t, strict=True)])  # (q, 3, 15)
    J = np.einsum("qdn,enx->eqdx", slopes, wedges.points[wedges.cells])
    volume = weight * np.linalg.det(J)
    N = np.linalg.solve(J, np.broadcast_to(slopes, (*J.shape[:2], 3, 15)))
    whole = np.einsum("eq,eqdn->edn", volume, N)
    total = np.einsum("edn,enxk->xdk", whole, displacement[wedges.cells])
    return float(volume.sum()), total / volume.sum()


def _wedge_points() -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Six points of a triangle (exact to degree 4) times three of Gauss."""
    a, b, wa, wb = 0.445948490915965, 0.091576213509771, 0.111690794839005, 0.054975871827661
    triangle = np.array([(x, y, w) for c, w in ((a, wa), (b, wb)) for x, y in ((c, c), (1 - 2 * c, c), (c, 1 - 2 * c))])
    line, along = np.polynomial.legendre.leggauss(3)
    r, s, w = np.repeat(triangle, 3, axis=0).T
    return r, s, np.tile(line, 6), w * np.tile(along, 6)


def _wedge_slopes(r: float, s: float, t: float) -> FloatArray:
    """(3, 15) derivatives by r, s, t of the shape functions of the serendipity wedge."""
    L, D = np.array([1 - r - s, r, s]), np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    out = np.zeros((3, 15))
    for i in range(3):
        for first, sign in ((0, -1.0), (3, 1.0)):
            out[:2, first + i] = (0.5 * (4 * L[i] - 1) * (1 + sign * t) - 0.5 * (1 - t * t)) * D[i]
            out[2, first + i] = 0.5 * L[i] * (2 * L[i] - 1) * sign + L[i] * t
            a, b = EDGES[i]
            out[:2, 6 + first + i] = 2 * (1 + sign * t) * (D[a] * L[b] + L[a] * D[b])
            out[2, 6 + first + i] = 2 * sign * L[a] * L[b]
        out[:2, 12 + i] = (1 - t * t) * D[i]
        out[2, 12 + i] = -2 * t * L[i]
    return out


def moduli_and_displacements(
    wedges: SweptWedges, answer: CalculixAnswer, loads: Sequence[LoadCase]
) -> list[tuple[float, float]]:
    """For each force: E or G [Pa] by volume averages, with <stress> = F / A by equilibrium, and the largest displacement [m]."""
    volume, gradient = volume_and_mean_gradient(wedges, answer.displacement)
    area = volume / float(wedges.points[:, 2].max())
    found = []
    for k, load in enumerate(loads):
        if not load.is_force:
            raise SpecError(f"moduli of this comparison come from forces, found the load {load.name}.")
        x = int(np.argmax(np.abs(load.direction)))
        H = gradient[:, :, k]
        strain = H[2, 2] if x == 2 else H[x, 2] + H[2, x]
        along = answer.displacement[:, :, k] @ load.direction
        found.append((load.size / area / float(strain), float(along.max())))
    return found


def by_calculix(
    mesh: CrossSectionMesh, levels: FloatArray, loads: Sequence[LoadCase]
) -> tuple[FloatArray, float, SweptWedges]:
    """(loads, 2) modulus [Pa] and largest displacement [m], wall time [s], and the wedges."""
    wedges = swept_wedges(mesh, levels)
    answer = run_calculix(deck(wedges, end_forces(mesh, wedges, loads)), len(wedges.points))
    return np.array(moduli_and_displacements(wedges, answer, loads)), answer.seconds, wedges


def eccentric_core(per_ring: int = 2, around: int = 24) -> CrossSectionMesh:
    """A conductor of radius 4.5 mm in stiff insulation and a soft sheath, all 4 mm off the axis of its helix of 150 mm pitch."""
    parts = ((62.4e9, 0.33), (68e6, 0.47), (4e6, 0.47))
    return rings(
        [4.5e-3, 7.6e-3, 12e-3],
        *parts,
        per_ring=per_ring,
        around=around,
        centre=(4e-3, 0.0),
        twist_rate=2 * np.pi / 0.15,
    )


def main(arguments: Sequence[str]) -> None:
    """Print the table: of the eccentric core, or with a cable's name of that cable (an hour and several GB)."""
    if find_calculix() is None:
        print("CalculiX (ccx) is not installed: nothing to compare.")
        return
    length = 0.1823 if arguments else 0.08
    mesh = specimen_mesh(read_cable(arguments[0])) if arguments else eccentric_core()
    diameter = 2 * float(np.hypot(*mesh.points.T).max())
    print(
        "| | layers | nodes | E MPa | G_yoz | G_xoz | u_z mm | u_x | u_y | wall s |\n|---|---|---|---|---|---|---|---|---|---|"
    )
    start = time.perf_counter()
    solution = solve_specimen(Specimen(length), mesh, LOADS)
    own = np.array([(a.modulus, a.u_max) for a in apparent_moduli(solution)])
    print(_row("this package", solution.operator.axial.layers, 0, own, time.perf_counter() - start), flush=True)
    for grading in GRADINGS:
        levels = grading.basis(length, diameter).levels
        other, seconds, wedges = by_calculix(mesh, levels, LOADS)
        print(_row("CalculiX", len(levels) - 1, len(wedges.points), other, seconds), flush=True)
        print("| difference, % | | | " + " | ".join(f"{100 * d:+.2f}" for d in (other / own - 1).T.ravel()) + " | |")


def _row(name: str, layers: int, nodes: int, values: FloatArray, seconds: float) -> str:
    numbers = [f"{m / 1e6:.2f}" for m in values[:, 0]] + [f"{1e3 * u:.3f}" for u in values[:, 1]]
    return f"| {name} | {layers} | {nodes or ''} | " + " | ".join(numbers) + f" | {seconds:.0f} |"


if __name__ == "__main__":
    main(sys.argv[1:])

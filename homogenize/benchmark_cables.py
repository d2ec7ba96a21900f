"""Whole cables: lays that match (case T9), a strand as the sum of its wires (T8), thin wires in rubber (T12), four conductors.

The cells of this file are meshed by gmsh. The four-conductor section stands as its reference stood: round cores in the plane, turned along
the axis; elements of 2 mm.

The rubber law lets the rubber strain evenly. Thin wires press into the rubber below them, which a law without places cannot know: the cell
is softer, and comes close where the rubber keeps its volume (nu near 0.5, small lay angle). With free ends the law's wires have no
stiffness of their own in bending and torsion; wires that can be meshed have one that outweighs the rubber, so that only bounds are stated.
"""

from __future__ import annotations

import dataclasses
import tempfile
from collections.abc import Iterable
from functools import partial
from pathlib import Path

import numpy as np

from geometry.cable_file import read_cable
from geometry.cell_mesh import CrossSectionMesh
from geometry.common_period import common_period
from geometry.matched_lay import LayeredLay
from geometry.material import Material
from geometry.section_mesh import cross_section_mesh
from homogenize.benchmark import Benchmark, Case, band, components
from homogenize.helical_cell import solve_helical_cell
from homogenize.rubber_filled_cable import RubberFilledCable
from homogenize.section_problem import SectionSolver
from homogenize.section_stiffness import pitch_average
from homogenize.section_system import section_system

SEA_CABLE = (
    ("cores", 17.667e-3, 9.0, 3, "Z"),
    ("inner armour", 39.467e-3, 20.1, 55, "S"),
    ("outer armour", 44.067e-3, 19.6, 63, "Z"),
)
"""Layer, radius [m], nominal lay angle [deg], members, hand: Menard, Cartraud, Marine Structures 91 (2023) 103465."""

MATCHED = {"cores": (1, 702.60, 8.978), "inner armour": (-19, 677.95, 20.091), "outer armour": (19, 776.56, 19.624)}
"""Turns k of p = n l / k, pitch [mm] and lay angle [deg] at l = 234.2 mm, to the digits printed."""

SPIRAL_LAYERS = (
    (1, 5.8, 0.0, 0.0),
    (7, 4.3, 5.05, 150.0),
    (17, 3.2, 8.80, 210.0),
    (14, 5.3, 13.05, 320.0),
    (21, 5.0, 18.20, 420.0),
    (27, 5.0, 23.20, 520.0),
    (33, 5.0, 28.20, 620.0),
)
"""Wires, diameter, radius, lay [mm]: Judge et al., Constr. Build. Mater. (2012), doi 10.1016/j.conbuildmat.2011.12.073."""

FOUR_CONDUCTORS = {
    "bonded": (6489.9e6, 4381.9e6, 98.99, 112.37, 21.57e3, 110.2e3),
    "frictionless": (6186.6e6, 4291.6e6, 78.45, 108.54, 20.10e3, 585.2e3),
}
"""E blocked, E free [Pa], EI, GJ [N m2], coupling [N m], GA [N] by interface: an independent code, 2026-11."""


def sea_cable_period() -> Iterable[Benchmark]:
    """Nominal angles to the lays that share 234.2 mm; and the search that finds that height by itself."""
    layers = [LayeredLay(n, r, 2 * np.pi * r / np.tan(np.radians(a)), hand, m) for n, r, a, m, hand in SEA_CABLE]
    name, source = "T9 period of three lays", "Menard, Cartraud 2023"
    cell, found = common_period(layers, height=0.2342), common_period(layers)
    assert cell is not None and found is not None
    for layer, (turns, pitch, angle) in MATCHED.items():
        lay = cell.layer(layer)
        yield Benchmark(name, source, f"{layer}, turns [-]", turns, lay.turns, 0.0)
        yield Benchmark(name, source, f"{layer}, pitch [mm]", pitch, 1e3 * (lay.lay or np.inf), 0.0051, scale=1.0)
        yield Benchmark(
            name, source, f"{layer}, lay angle [deg]", angle, float(np.degrees(lay.lay_angle)), 0.00051, scale=1.0
        )
    yield Benchmark(name, source, "height found from the nominal angles [mm]", 234.2, 1e3 * found.height, 1e-3)


def spiral_strand() -> Iterable[Benchmark]:
    """Sums over the published wires, and over the wires of the cable file, whose 17 thin ones are 2 % thinner."""
    name, source, E = "T8 spiral strand of 120 wires", "verification table", 188e9
    wires = [(n, np.pi * d**2 / 4, float(np.arctan2(2 * np.pi * r, p)) if p else 0.0) for n, d, r, p in SPIRAL_LAYERS]
    straight = 1e-6 * E * sum(n * A for n, A, _ in wires)
    laid = 1e-6 * E * sum(n * A * np.cos(beta) ** 3 for n, A, beta in wires)
    yield Benchmark(name, source, "sum E A of the published wires [N]", 406.8e6, straight, 0.05e6, scale=1.0)
    yield Benchmark(name, source, "sum E A cos^3 of the published wires [N]", 365.8e6, laid, 0.05e6, scale=1.0)
    parts = [p for p in read_cable("spiral-strand-120").parts if p.kind not in ("interstices", "sheath")]
    sections = [(p.material.E * np.pi * (p.outer_radius**2 - p.inner_radius**2), p.lay_angle) for p in parts]
    yield Benchmark(name, source, "wires in the cable file [-]", 120.0, float(len(parts)), 0.0)
    thinner = 17 * np.pi / 4 * 1e-6 * E * (3.2**2 - 3.13**2)  # the file's third layer: 3.13 mm wires
    cos3 = np.cos(np.arctan2(2 * np.pi * 8.80, 210.0)) ** 3
    in_file = sum(EA for EA, _ in sections), sum(EA * np.cos(beta) ** 3 for EA, beta in sections)
    names = ("sum E A of the file + its thinner wires [N]", "sum E A cos^3 of the same [N]")
    found = (in_file[0] + thinner, in_file[1] + thinner * cos3)
    yield from components(name, source, names, (406.8e6, 365.8e6), found, 0.05e6, scale=1.0)


def four_conductors(interface: str) -> Iterable[Benchmark]:
    """The whole stiffness; the meshes of the two codes differ."""
    section = pitch_average(solve_helical_cell(four_conductor_section(), interface).stiffness)
    names = ("E blocked [Pa]", "E free [Pa]", "EI [N m2]", "GJ [N m2]", "coupling [N m]", "GA [N]")
    found = (
        section.E_blocked_twist,
        section.E_free_twist,
        section.EI_x,
        section.GJ,
        section.coupling,
        section.GA_x,
    )
    tolerance = {"bonded": 1e-3, "frictionless": 1.5e-3}[interface]
    name = f"four conductors in rubber, {interface}"
    yield from components(name, "another code, 2026-11", names, FOUR_CONDUCTORS[interface], found, tolerance)
    if interface == "bonded":
        F = section.compliance
        chirality = float(F[0, 3] / np.sqrt(F[0, 0] * F[3, 3]))
        yield Benchmark(name, "another code, 2026-11", "F14 / sqrt(F11 F44) [-]", 0.447, chirality, 1e-3, scale=1.0)


def wires_in_rubber(wires: int, degrees: float) -> Iterable[Benchmark]:
    """EA of the cell beside the rubber law, for a rubber that nearly keeps its volume."""
    beta, radius, total, area = float(np.radians(degrees)), 16e-3, np.pi * 34e-3**2, 335e-6
    mesh = rubber_filled_section(wires, degrees)
    for nu in (0.49, 0.499):
        rubber = Material("rubber", 8e6, nu, 1000.0)
        regions = tuple(r if r.kind == "conductor" else dataclasses.replace(r, material=rubber) for r in mesh.regions)
        blocked, free = axial_stiffness(dataclasses.replace(mesh, regions=regions))
        law = RubberFilledCable(area * 80e9, radius, beta, rubber, float(total - area))
        name = f"T12 cell, {wires} wires in rubber, nu {nu:g}, {degrees:g} deg"
        yield Benchmark(name, "rubber law", "EA/A blocked [MPa]", law.EA() / total / 1e6, blocked / total / 1e6, 0.1)
        low, note = law.EA(free_twist=True), "wires resist bending and torsion themselves"
        yield band(
            name, "rubber law", "EA/A free [MPa]", low / total / 1e6, blocked / total / 1e6, free / total / 1e6, note
        )


def axial_stiffness(mesh: CrossSectionMesh) -> tuple[float, float]:
    """EA with blocked and with free twist [N], from the z-independent problem alone."""
    system = section_system(mesh)
    solver = SectionSolver(system.pencil, 0.0, system.gauge)
    F = np.linalg.inv(solver.schur)[np.ix_([2, 5], [2, 5])]
    return float(np.linalg.inv(F)[0, 0]), float(1 / F[0, 0])


def _entry(value: float | str) -> str:
    shown = f'"{value}"' if isinstance(value, str) else f"{value:.12g}"
    return f'{{ value = {shown}, status = "computed", source = "verification" }}'


def _rod(name: str, diameter: float, E: float) -> str:
    lines = {"wire_diameter": f"{1e3 * diameter:.12g} mm", "wire_density": "8900 kg/m^3", "E": f"{E:.12g} Pa"}
    body = "".join(f"{key} = {_entry(value)}\n" for key, value in lines.items())
    numbers = "".join(f"{key} = {_entry(value)}\n" for key, value in (("fill", 1.0), ("nu", 0.33)))
    return (
        f'[conductors.{name}]\nwires = {{ value = 1, status = "computed", source = "verification" }}\n{body}{numbers}'
    )


def _material(name: str, E: float, nu: float) -> str:
    entries = {"E": f"{E:.12g} Pa", "nu": nu, "density": "1000 kg/m^3"}
    return f"[materials.{name}]\n" + "".join(f"{key} = {_entry(value)}\n" for key, value in entries.items())


def _meshed(cable: str, size: float) -> CrossSectionMesh:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "section.toml"
        file.write_text(cable, encoding="utf-8")
        return cross_section_mesh(read_cable(file), size=size)


def four_conductor_section(pitch: float = 0.388, size: float = 2e-3) -> CrossSectionMesh:
    """OD 50 mm, four cores of radius 7.6 at 12 mm, power conductors 4.5, control conductor 3.0, bare central earth 4.2 mm.

    Conductors 62.4 GPa and 42.8 GPa, nu 0.33; insulation 68 MPa, sheath and filler 4 MPa, nu 0.47. Meshed with straight cores (circles in
    the plane), then turned along the axis.
    """
    cable = f"""name = "four-conductor-section"
title = "verification section"
{_rod("power", 9e-3, 62.4e9)}{_rod("control", 6e-3, 42.8e9)}{_rod("earth", 8.4e-3, 62.4e9)}
[cores.power]
conductor = "power"
insulation_wall = {_entry("3.1 mm")}
insulation_material = "insulation"
[cores.control]
conductor = "control"
insulation_wall = {_entry("4.6 mm")}
insulation_material = "insulation"
[centre]
conductor = "earth"
cover_wall = {_entry("0.2 mm")}
cover_material = "soft"
[lay-up]
cores = ["power", "power", "power", "control"]
[interstices]
material = "soft"
[sheath]
wall = {_entry("5.4 mm")}
material = "soft"
{_material("insulation", 68e6, 0.47)}{_material("soft", 4e6, 0.47)}"""
    return dataclasses.replace(_meshed(cable, size), twist_rate=2 * np.pi / pitch)


def rubber_filled_section(wires: int, degrees: float, size: float = 5e-3) -> CrossSectionMesh:
    """OD 68 mm, 335 mm2 of 80 GPa in `wires` round wires at 16 mm and a lay angle, in rubber of 8 MPa; nothing on the axis."""
    diameter = 2 * np.sqrt(335e-6 / wires / np.pi)
    lay = 2e3 * np.pi * 16e-3 / np.tan(np.radians(degrees))
    cable = f"""name = "wires-in-rubber"
title = "verification section"
{_rod("wire", diameter, 80e9)}
[cores.wire]
conductor = "wire"
[lay-up]
cores = [{", ".join(['"wire"'] * wires)}]
pitch_circle_radius = {_entry("16 mm")}
lay = {_entry(f"{lay:.12g} mm")}
hand = "Z"
[interstices]
material = "rubber"
[sheath]
wall = {_entry(f"{18 - 500 * diameter:.12g} mm")}
material = "rubber"
{_material("rubber", 8e6, 0.49)}"""
    return _meshed(cable, size)


def cable_cases() -> tuple[Case, ...]:
    """Period, spiral strand, four conductors bonded and sliding, wires in rubber."""
    return (
        Case("T9 period of three lays", "Menard, Cartraud 2023", sea_cable_period),
        Case("T8 spiral strand of 120 wires", "verification table", spiral_strand),
        *(
            Case(f"four conductors in rubber, {kind}", "another code, 2026-11", partial(four_conductors, kind))
            for kind in FOUR_CONDUCTORS
        ),
        Case("T12 cell, 12 wires in rubber", "rubber law", partial(wires_in_rubber, 12, 10.0)),
    )

"""A four-conductor section with circular traces, for which an independent code has printed the whole stiffness.

OD 50 mm, four cores of radius 7.6 at 12 mm, power conductors 4.5, control conductor 3.0, bare central earth 4.2 mm; conductors
62.4 GPa and 42.8 GPa, nu 0.33; insulation 68 MPa, sheath and filler 4 MPa, nu 0.47; pitch 388 mm, all bonded.
"""

import dataclasses
import pathlib

import numpy as np

from geometry import CrossSectionMesh, cross_section_mesh, read_cable


def number(value: object) -> str:
    shown = f'"{value}"' if isinstance(value, str) else value
    return f'{{ value = {shown}, status = "computed", source = "verification" }}'


def conductor(name: str, diameter: str, E: str) -> str:
    entries = {"wires": 1, "wire_diameter": diameter, "wire_density": "8900 kg/m^3", "fill": 1.0, "E": E, "nu": 0.33}
    return f"[conductors.{name}]\n" + "".join(f"{key} = {number(value)}\n" for key, value in entries.items())


def material(name: str, E: str) -> str:
    return f"[materials.{name}]\nE = {number(E)}\nnu = {number(0.47)}\ndensity = {number('1000 kg/m^3')}\n"


CABLE = f"""name = "four-conductor-section"
title = "verification section"
{conductor("power", "9 mm", "62.4 GPa")}{conductor("control", "6 mm", "42.8 GPa")}{conductor("earth", "8.4 mm", "62.4 GPa")}
[cores.power]
conductor = "power"
insulation_wall = {number("3.1 mm")}
insulation_material = "insulation"
[cores.control]
conductor = "control"
insulation_wall = {number("4.6 mm")}
insulation_material = "insulation"
[centre]
conductor = "earth"
cover_wall = {number("0.2 mm")}
cover_material = "soft"
[lay-up]
cores = ["power", "power", "power", "control"]
[interstices]
material = "soft"
[sheath]
wall = {number("5.4 mm")}
material = "soft"
{material("insulation", "68 MPa")}{material("soft", "4 MPa")}"""


def four_conductor_section(folder: pathlib.Path, pitch: float = 0.388, size: float = 2e-3) -> CrossSectionMesh:
    """Meshed with straight cores (circles in the plane), then turned along the axis, as the reference was."""
    file = folder / "section.toml"
    file.write_text(CABLE, encoding="utf-8")
    return dataclasses.replace(cross_section_mesh(read_cable(file), size=size), twist_rate=2 * np.pi / pitch)

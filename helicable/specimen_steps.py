"""`helicable specimen` in load steps: large displacements, and interfaces that open and rub."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from geometry import Cable, CrossSectionMesh
from geometry.errors import MeshError
from helicable.screen import ProgressCallback, engineering, progress, say, table
from homogenize import Interfaces
from homogenize.specimen import (
    AxialGrading,
    FrictionalContact,
    LoadCase,
    Specimen,
    coarse_section,
    contact_specimen,
    follow_specimen,
)
from homogenize.specimen.apparent_modulus import ApparentModulus
from homogenize.specimen.contact_condensation import imbalance
from homogenize.specimen.ladder import SOFT
from homogenize.specimen.load_steps import contact_modulus, equal_steps, followed_modulus
from homogenize.specimen.opening_specimen import contact_path, initial_state
from homogenize.specimen.specimen_mesh import specimen_mesh

GRADING = AxialGrading(end_size=0.24, largest=0.9, growth=4.0, degree=3)
"""Layers of a specimen in load steps: 19 stations on 182 mm of a 50 mm cable, forces in balance within a percent."""


def is_opening(interface: str | Interfaces) -> bool:
    """Whether the parts of a specimen open and rub."""
    laws = [] if isinstance(interface, str) else list(interface.laws.values())
    return any(isinstance(law, FrictionalContact) for law in laws)


def run_in_steps(
    cable: Cable, wanted: Specimen, loads: tuple[LoadCase, ...], size: float | None, steps: int
) -> tuple[tuple[ApparentModulus, ...], dict[str, Any]]:
    """Large displacements, or opening contacts: solve and print; the moduli and the record."""
    mesh, wanted = step_mesh(cable, size), replace(wanted, grading=GRADING)
    solve = large_displacement_moduli if wanted.large_displacement else opening_moduli
    with progress("specimen in load steps") as tell:
        found, notes = solve(wanted, mesh, loads, steps, tell)
    show_steps(cable, wanted, found, steps, notes)
    return found, steps_record(cable, wanted, mesh, found, loads, notes)


def step_mesh(cable: Cable, size: float | None) -> CrossSectionMesh:
    """A coarse section; that of the linear specimen where a size is given or the cable has no coarse one."""
    if size is None:
        try:
            return coarse_section(cable)
        except MeshError:
            pass
    return specimen_mesh(cable, size)


def large_displacement_moduli(
    specimen: Specimen, mesh: CrossSectionMesh, loads: tuple[LoadCase, ...], steps: int, tell: ProgressCallback
) -> tuple[tuple[ApparentModulus, ...], list[str]]:
    """Moduli of loads followed with large displacements, and what to know of them."""
    soft = [region.name for region in mesh.regions if getattr(region.material, "E", np.inf) < SOFT]
    followed = follow_specimen(specimen, mesh, loads, shares=equal_steps(steps), neo_hookean=soft, progress=tell)
    notes = [
        f"large displacements in {steps} steps; neo-Hookean {len(soft)} soft parts, St Venant-Kirchhoff the others",
        f"{followed[0].path.wedges.unknowns} unknowns, {sum(f.path.factors for f in followed)} factors",
    ]
    return tuple(followed_modulus(one, specimen.length) for one in followed), notes


def opening_moduli(
    specimen: Specimen, mesh: CrossSectionMesh, loads: tuple[LoadCase, ...], steps: int, tell: ProgressCallback
) -> tuple[tuple[ApparentModulus, ...], list[str]]:
    """Moduli of loads on parts that open and rub, each from the same initial state, and what to know of them."""
    one_sign = tuple(dict.fromkeys(replace(load, size=abs(load.size)) for load in loads))
    contacts = contact_specimen(specimen, mesh, one_sign, lambda fraction, words: tell(0.8 * fraction, words))
    start = initial_state(contacts)
    notes = [f"small displacements; {len(contacts.area)} contact points, every load from the same initial state"]
    moved = np.abs(start.face).max()
    if moved > 0:
        notes.append(f"before any load the loaded end has moved by {1e3 * moved:.3g} mm: an interference was let go")
    found, off = [], 0.0
    for i, load in enumerate(loads):
        k = one_sign.index(replace(load, size=abs(load.size)))
        shares = [float(np.sign(load.size)) * share for share in equal_steps(steps)]
        tell(0.8 + 0.2 * i / len(loads), f"{load.name}: contacts")
        path = contact_path(contacts, k, shares, start)
        found.append(contact_modulus(contacts, k, start, path))
        last = path[-1]
        off = max(off, *(float(imbalance(step.resultants, specimen.length)) for step in path))
        notes.append(
            f"{load.name}: {100 * last.open_share(contacts.area):.0f} % of the contact surface open, "
            f"{1e3 * last.dissipated:.3g} mJ rubbed away"
        )
    notes.append(f"forces and moments in balance to {100 * off:.2g} % of the load in every step")
    return tuple(found), notes


def show_steps(
    cable: Cable, specimen: Specimen, found: tuple[ApparentModulus, ...], steps: int, notes: list[str]
) -> None:
    """Print slope, R2 and displacements."""
    rows = [
        (
            a.load,
            engineering(a.modulus, "Pa"),
            f"{a.curve.R2:.4f}",
            f"{1e3 * a.u_max:.3f}",
            f"{1e3 * a.u_mean:.3f}",
            f"{a.unevenness:.2f}",
        )
        for a in found
    ]
    table(
        f"{cable.name}, {1e3 * specimen.length:.4g} mm, {steps} load steps: {specimen.loaded.describe()}",
        ("load", "slope", "R2", "u max mm", "u mean mm", "max / mean"),
        rows,
        right=(1, 2, 3, 4, 5),
    )
    for note in [*notes, *sign_notes(found)]:
        say(f"- {note}")


def sign_notes(found: tuple[ApparentModulus, ...]) -> list[str]:
    """How far loads of both signs differ."""
    by = {a.load: a for a in found}
    notes = []
    for axis in "xy":
        plus, minus = by.get(f"shear +{axis}"), by.get(f"shear -{axis}")
        if plus and minus:
            even = 0.5e3 * (plus.u_max - minus.u_max)
            notes.append(
                f"+{axis} against -{axis}: displacements differ by {200 * even / (0.5e3 * (plus.u_max + minus.u_max)):+.2f} % "
                f"(even part {even:+.3f} mm), moduli by {100 * (plus.modulus / minus.modulus - 1):+.2f} %"
            )
    return notes


def steps_record(
    cable: Cable,
    specimen: Specimen,
    mesh: CrossSectionMesh,
    found: tuple[ApparentModulus, ...],
    loads: tuple[LoadCase, ...],
    notes: list[str],
) -> dict[str, Any]:
    """The JSON of a specimen in load steps; the same names as the linear one."""
    return {
        "schema": 1,
        "cable": cable.name,
        "length": specimen.length,
        "phase": specimen.phase,
        "held": specimen.held.describe(),
        "loaded": specimen.loaded.describe(),
        "interface": specimen.interface if isinstance(specimen.interface, str) else specimen.interface.describe(),
        "large_displacement": specimen.large_displacement,
        "loads": {
            a.load: {
                "size": load.size,
                "modulus": a.modulus,
                "mean_stress": a.mean_stress,
                "mean_strain": a.mean_strain,
                "u_max": a.u_max,
                "u_mean": a.u_mean,
                "modulus_of_maximum": a.modulus_of_maximum,
                "modulus_of_mean": a.modulus_of_mean,
                "curve": {
                    "strain": a.curve.strain,
                    "stress": a.curve.stress,
                    "slope": a.curve.slope,
                    "R2": a.curve.R2,
                },
            }
            for a, load in zip(found, loads)
        },
        "mesh": {"elements": len(mesh.cells)},
        "notes": [*notes, *sign_notes(found)],
    }

"""Parts of the published specimen that open and rub, and what each does to G and to +X against -X.

`python -m benchmarks.specimen_contacts` writes benchmarks/specimen_contacts.json and .md. Small displacements, friction 0.3, layers in
balance; 2000 N along, 500 N across in +X, -X, +Y, -Y, in two steps, each from the same initial state. A case that is in the record is
not computed again: take the record away to begin anew.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from geometry import Cable, CrossSectionMesh, read_cable
from geometry.errors import ConvergenceError
from geometry.material import Material
from homogenize import Interfaces
from homogenize.specimen import (
    ContactSpecimen,
    FrictionalContact,
    Held,
    LoadCase,
    Specimen,
    coarse_section,
    contact_path,
    contact_specimen,
    initial_state,
)
from homogenize.specimen.contact_condensation import CONTACT_GRADING, imbalance
from homogenize.specimen.frictional_contact import ContactConstants
from homogenize.specimen.load_steps import contact_modulus

CABLE = str(Path(__file__).with_name("stiff-conductors-specimen.toml"))
"""The set of inputs with conductors of 80 GPa: 182.7 mm, lay 380 mm."""
RECORD = Path(__file__).with_name("specimen_contacts.json")
TABLE = Path(__file__).with_name("specimen_contacts.md")
LOADS = (LoadCase("tension", 2000.0), LoadCase("shear", 500.0, "x"), LoadCase("shear", 500.0, "y"))
SIGNED = ((0, 1.0), (1, 1.0), (1, -1.0), (2, 1.0), (2, -1.0))
SHARES = (0.5, 1.0)
STIFFNESS = 1e11
"""Of a closed contact [Pa/m], as stiff as 0.04 mm of the rubber."""
RUBBER = 4.1e6
"""Young's modulus [Pa] of filler and sheath as one: between the 3.49 MPa of the sheath and the 5.99 MPa of the filler."""
MU = 0.3
HELD = dict(friction=10.0, grip=1e9)


@dataclass(frozen=True)
class Row:
    """One case: moduli [MPa], largest displacements along the force [mm], from the parts as drawn.

    `shift_x`, `shift_y`: mean displacement of the loaded end before any load; `off`: largest imbalance of forces and moments.
    """

    E: float
    G_plus_x: float
    G_minus_x: float
    G_plus_y: float
    G_minus_y: float
    u_z: float
    u_plus_x: float
    u_minus_x: float
    u_plus_y: float
    u_minus_y: float
    shift_x: float
    shift_y: float
    open_share: float
    off: float
    seconds: float

    @property
    def ratio(self) -> float:
        """G_yoz over G_xoz, each the mean of both signs."""
        return (self.G_plus_x + self.G_minus_x) / (self.G_plus_y + self.G_minus_y)

    @property
    def even(self) -> tuple[float, float]:
        """Half the difference of the displacements of both signs, X and Y [mm]."""
        return 0.5 * (self.u_plus_x - self.u_minus_x), 0.5 * (self.u_plus_y - self.u_minus_y)


@dataclass(frozen=True)
class Group:
    """Cases that share a condensed specimen: `law` of each, constants by a function of the specimen."""

    interface: str
    cases: dict[str, Callable[[ContactSpecimen], ContactConstants]]
    change: Callable[[CrossSectionMesh], CrossSectionMesh] = lambda mesh: mesh
    gripped: tuple[str, ...] = ()


def everywhere(**law: float) -> Callable[[ContactSpecimen], ContactConstants]:
    """The same law at all points."""
    return at_member("", **law)


def at_member(member: str, **law: float) -> Callable[[ContactSpecimen], ContactConstants]:
    """Grip and gap only where a part of the member meets something; friction everywhere."""

    def constants(specimen: ContactSpecimen) -> ContactConstants:
        one = np.ones(len(specimen.area))
        here = np.array([any(side.startswith(member) for side in pair) for pair in specimen.parts], dtype=float)
        c = specimen.constants
        return ContactConstants(
            law.get("friction", MU) * one,
            law.get("grip", 0.0) * here,
            law.get("gap", 0.0) * here,
            c.normal,
            c.tangential,
        )

    return constants


def softer(member: str, kind: str, E: float) -> Callable[[CrossSectionMesh], CrossSectionMesh]:
    """The parts of a kind of one member with another Young's modulus [Pa]."""

    def change(mesh: CrossSectionMesh) -> CrossSectionMesh:
        regions = []
        for region in mesh.regions:
            if region.name == f"{member} {kind}":
                assert isinstance(region.material, Material)
                region = replace(region, material=replace(region.material, E=E))
            regions.append(region)
        return replace(mesh, regions=tuple(regions))

    return change


GROUPS = (
    Group(
        "core-filler",
        {
            "held": everywhere(**HELD),
            "no grip, no gap": everywhere(),
            "no grip, no gap, friction 0.1": everywhere(friction=0.1),
            "power core 1 in a gap of 0.2 mm": at_member("power core 1", gap=2e-4),
            **{f"interference {d} mm": everywhere(gap=-1e-3 * d) for d in (0.02, 0.05, 0.2)},
            **{f"interference {d} mm at power core 1": at_member("power core 1", gap=-1e-3 * d) for d in (0.05, 0.2)},
            **{f"grip {p} kPa": everywhere(grip=1e3 * p) for p in (50, 200, 1000)},
        },
    ),
    Group(
        "core-filler",
        {
            "soft insulation on power core 1, held": everywhere(**HELD),
            "soft insulation on power core 1, no grip": everywhere(),
            "soft insulation on power core 1, grip 200 kPa": everywhere(grip=2e5),
        },
        softer("power core 1", "insulation", 11e6),
    ),
    Group(
        "core-filler",
        {
            "soft control conductor, held": everywhere(**HELD),
            "soft control conductor, no grip": everywhere(),
            "soft control conductor, grip 200 kPa": everywhere(grip=2e5),
        },
        softer("control core", "conductor", 7e9),
    ),
    Group(
        "conductor-insulation",
        {
            "conductors: no grip, no gap": everywhere(),
            "conductors: grip 200 kPa": everywhere(grip=2e5),
            "conductors: grip 1000 kPa": everywhere(grip=1e6),
        },
    ),
    Group(
        "core-filler",
        {
            "held by the conductors at z = 0, no grip": everywhere(),
            "held by the conductors at z = 0, grip 200 kPa": everywhere(grip=2e5),
        },
        gripped=("conductor",),
    ),
)


def main() -> None:
    """Compute what is missing, write record and table."""
    rows = read_record()
    mesh = section(read_cable(CABLE))
    for group in GROUPS:
        missing = [name for name in group.cases if name not in rows]
        if not missing:
            continue
        specimen = condensed(mesh, group)
        for name in missing:
            began = time.process_time()
            try:
                rows[name] = solve_case(replace(specimen, constants=group.cases[name](specimen)), began)
            except ConvergenceError as error:  # the campaign goes on; the case is missing from the table
                print(f"{name}: {error}", flush=True)
                continue
            write_record(rows)
            print(f"{name}: {line(rows[name])}", flush=True)
    TABLE.write_text(table(rows), encoding="utf-8")


def section(cable: Cable) -> CrossSectionMesh:
    """A coarse section with the filler and the sheath as one rubber, six edges round a core: half the unknowns of that with two rubbers."""
    parts = [
        replace(part, material=replace(part.material, E=RUBBER)) if part.kind in ("interstices", "sheath") else part
        for part in cable.parts
    ]
    return coarse_section(replace(cable, parts=tuple(parts)), sides=6, size=0.3, floor=0.16)


def condensed(mesh: CrossSectionMesh, group: Group) -> ContactSpecimen:
    """The specimen of a group, with a law that its cases replace."""
    case = read_cable(CABLE).specimen
    assert case is not None
    wanted = Specimen(
        case.length,
        phase=case.phase,
        held=Held(group.gripped),
        interface=Interfaces({group.interface: FrictionalContact(MU, normal=STIFFNESS, tangential=STIFFNESS)}),
        grading=CONTACT_GRADING,
    )
    began = time.process_time()
    found = contact_specimen(wanted, group.change(mesh), LOADS)
    print(f"{group.interface}: {len(found.compliance)} jumps, {time.process_time() - began:.0f} s", flush=True)
    return found


def solve_case(specimen: ContactSpecimen, began: float) -> Row:
    """All loads from the initial state."""
    start = initial_state(specimen)
    shift = 1e3 * (specimen.face_weight @ start.face) / specimen.face_weight.sum()
    moduli, share, off = [], 0.0, 0.0
    for load, sign in SIGNED:
        path = contact_path(specimen, load, [sign * s for s in SHARES], start)
        moduli.append(contact_modulus(specimen, load, start, path))
        share = max(share, path[-1].open_share(specimen.area))
        off = max(off, float(imbalance(path[-1].resultants, specimen.specimen.length)))
    E, *G = (1e-6 * m.modulus for m in moduli)
    u_z, *u = (1e3 * m.u_max for m in moduli)
    last = float(shift[0]), float(shift[1]), share, off, time.process_time() - began
    return Row(*np.array([E, *G, u_z, *u, *last]).tolist())


def line(row: Row) -> str:
    """A case in one line."""
    even = row.even
    return (
        f"| {row.E:.1f} | {row.G_plus_x:.1f} / {row.G_minus_x:.1f} | {row.G_plus_y:.1f} / {row.G_minus_y:.1f} "
        f"| {row.ratio:.3f} | {row.u_z:.2f} | {row.u_plus_x:.2f} / {row.u_minus_x:.2f} "
        f"| {row.u_plus_y:.2f} / {row.u_minus_y:.2f} | {even[0]:+.3f} / {even[1]:+.3f} "
        f"| {100 * row.open_share:.0f} | {100 * row.off:.2f} |"
    )


def table(rows: dict[str, Row]) -> str:
    """The record as a page."""
    head = (
        f"# Contacts that open on the published specimen\n\n`{Path(CABLE).stem}`, "
        f"coarse section, friction {MU}, layers in balance. MPa, mm; "
        "both signs of a force; even: half their difference along X and Y. `python -m benchmarks.specimen_contacts`.\n\n"
        "| case | E | G_yoz +X / -X | G_xoz +Y / -Y | G ratio | u_z | u +X / -X | u +Y / -Y | even X / Y | open % | imbalance % |\n"
        f"|{'---|' * 11}\n"
        "| published | 142 | 53 | 45 | 1.178 | 4.10 | 6.95 / 7.96 | 7.71 / 7.02 | -0.505 / +0.345 | | |\n"
    )
    return head + "".join(f"| {name} {line(row)}\n" for name, row in rows.items())


def read_record() -> dict[str, Row]:
    """Cases that are computed already."""
    if not RECORD.exists():
        return {}
    return {name: Row(**row) for name, row in json.loads(RECORD.read_text(encoding="utf-8"))["cases"].items()}


def write_record(rows: dict[str, Row]) -> None:
    """Write all cases."""
    about = f"{Path(CABLE).stem}, friction {MU}; MPa, mm"
    cases = {name: asdict(row) for name, row in rows.items()}
    RECORD.write_text(json.dumps({"about": about, "cases": cases}, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    if "--table" in sys.argv:
        print(table(read_record()))
    else:
        main()

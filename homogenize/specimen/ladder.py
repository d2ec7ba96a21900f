r"""The ladder: the published specimen's numbers from the long cable up, one effect added at a time.

1. long cable, bonded, twist blocked - 2. twist released - 3. finite specimen, rigid plate - 4. load through the end-section (uniform
traction) - 5. conductors on an elastic interface - 6. cores that open and rub - 7. large displacements (bonded again).
Rungs 6 and 7 may stand on a coarser mesh, with rung 4 repeated on it.

For rungs 1 and 2 a specimen of length L is a rod of the cell's stiffness, fixed at one end:

.. math::  u_z = F L \bar F_{33}, \qquad u_x = F (L^3 \bar F_{44} / 3 + L \bar F_{11}),

E = 1 / (A F_33) (twist released) or C_33 / A (blocked), G = 1 / (A F_11) of the pitch-averaged compliance. All others are moduli by volume
averages, formula (3) of Ge et al., PLoS ONE 18(2) e0281136 (2023), and largest displacements along the force.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

from geometry.cell_mesh import CrossSectionMesh
from geometry.material import Material
from homogenize.elastic_interface import Elastic
from homogenize.helical_cell import solve_helical_cell
from homogenize.interface_choice import Interfaces
from homogenize.section_stiffness import pitch_average
from homogenize.specimen.apparent_modulus import ApparentModulus, apparent_moduli
from homogenize.specimen.axial_grading import AxialGrading
from homogenize.specimen.contact_condensation import contact_specimen
from homogenize.specimen.end_condition import Plate, Traction
from homogenize.specimen.frictional_contact import FrictionalContact
from homogenize.specimen.large_displacement_specimen import follow_specimen
from homogenize.specimen.load_case import LoadCase
from homogenize.specimen.load_steps import contact_modulus, followed_modulus
from homogenize.specimen.opening_specimen import contact_path, initial_state
from homogenize.specimen.specimen_solution import Specimen, solve_specimen

Progress = Callable[[float, str], None]

TENSION = 2000.0
SHEAR = 500.0
LOAD_STEPS = (0.25, 0.5, 0.75, 1.0)
SOFT = 1e9
"""Young's modulus [Pa] below which a part is neo-Hookean on the rung of large displacements."""
_LOADS = (LoadCase("tension", TENSION), LoadCase("shear", SHEAR, "x"), LoadCase("shear", SHEAR, "y"))


@dataclass(frozen=True)
class Rung:
    """The numbers of one step: moduli [Pa], largest displacements along the force [m], and what the step is."""

    name: str
    E: float
    G_yoz: float
    G_xoz: float
    u_z: float
    u_plus_x: float
    u_minus_x: float
    u_plus_y: float
    u_minus_y: float
    remark: str = ""

    def numbers(self) -> dict[str, float]:
        """All but name and remark."""
        return {k: v for k, v in asdict(self).items() if isinstance(v, float)}

    def misfit(self, other: Rung) -> float:
        """Root mean square of the logarithms of the ratios to another rung."""
        ratios = [np.log(a / b) for a, b in zip(self.numbers().values(), other.numbers().values())]
        return float(np.sqrt(np.mean(np.square(ratios))))


PUBLISHED = Rung("published", 142e6, 53e6, 45e6, 4.1e-3, 6.95e-3, 7.96e-3, 7.71e-3, 7.02e-3, "Ge et al. 2023")


def long_cable_rungs(mesh: CrossSectionMesh, length: float) -> tuple[Rung, Rung]:
    """A rod of the bonded cell's stiffness, twist blocked and released."""
    cell = solve_helical_cell(mesh)
    section = pitch_average(cell.stiffness)
    A, F = cell.stiffness.area, np.linalg.inv(section.C)
    x, y = (float(SHEAR * (length**3 * F[3 + k, 3 + k] / 3 + length * F[1 - k, 1 - k])) for k in (1, 0))
    G = float(1 / (A * F[0, 0])), float(1 / (A * F[1, 1]))
    found = []
    for name, EA in (("long cable, bonded", section.C[2, 2]), ("twist released", 1 / F[2, 2])):
        found.append(Rung(name, float(EA / A), *G, float(TENSION * length / EA), x, x, y, y))
    return found[0], found[1]


def linear_rung(name: str, specimen: Specimen, mesh: CrossSectionMesh, remark: str = "") -> Rung:
    """A linear specimen: both signs of a force give the same."""
    z, x, y = apparent_moduli(solve_specimen(specimen, mesh, _LOADS))
    return Rung(name, z.modulus, x.modulus, y.modulus, z.u_max, x.u_max, x.u_max, y.u_max, y.u_max, remark)


def large_displacement_rung(
    name: str,
    specimen: Specimen,
    mesh: CrossSectionMesh,
    shares: Sequence[float] = LOAD_STEPS,
    progress: Progress | None = None,
    remark: str = "",
) -> Rung:
    """Bonded, followed with large displacements; moduli are slopes of the line fitted to all shares, G the mean of both signs.

    Soft parts are neo-Hookean. The volume strain is that of the linear specimen, so that small loads have its numbers on the same mesh.
    """
    loads = [_LOADS[0], *(replace(load, size=s * load.size) for load in _LOADS[1:] for s in (1, -1))]
    soft = [r.name for r in mesh.regions if isinstance(r.material, Material) and r.material.E < SOFT]
    followed = follow_specimen(
        specimen, mesh, loads, shares=tuple(shares), volume_strain="full", neo_hookean=soft, progress=progress
    )
    return _signed_rung(name, [followed_modulus(one, specimen.length) for one in followed], remark)


def opening_rung(
    name: str,
    specimen: Specimen,
    mesh: CrossSectionMesh,
    law: FrictionalContact,
    interface: str = "core-filler",
    shares: Sequence[float] = (0.5, 1.0),
    progress: Progress | None = None,
    remark: str = "",
) -> Rung:
    """Parts that open and rub on one interface, small displacements; every load from the same initial state, G the mean of both signs."""
    contacts = contact_specimen(replace(specimen, interface=Interfaces({interface: law})), mesh, _LOADS, progress)
    start = initial_state(contacts)
    found = []
    for load, sign in ((0, 1.0), (1, 1.0), (1, -1.0), (2, 1.0), (2, -1.0)):
        path = contact_path(contacts, load, [sign * share for share in shares], start, progress)
        found.append(contact_modulus(contacts, load, start, path))
    return _signed_rung(name, found, remark)


def _signed_rung(name: str, found: Sequence[ApparentModulus], remark: str) -> Rung:
    """Of tension, +x, -x, +y, -y."""
    E, *G = (one.modulus for one in found)
    return Rung(name, E, 0.5 * (G[0] + G[1]), 0.5 * (G[2] + G[3]), *(one.u_max for one in found), remark=remark)


@dataclass(frozen=True)
class Step:
    """A rung that has not been climbed: its name, and what computes it."""

    name: str
    climb: Callable[[Progress], Rung]


def ladder_steps(
    mesh: CrossSectionMesh,
    specimen: Specimen,
    *,
    stiffness: float = 1e10,
    contact: FrictionalContact | None = None,
    large: bool = True,
    coarse: CrossSectionMesh | None = None,
    coarse_grading: AxialGrading | None = None,
) -> tuple[Step, ...]:
    """All rungs, in order.

    Parameters
    ----------
    mesh : CrossSectionMesh
    specimen : Specimen
        Length, phase and grading are taken from it.
    stiffness : of the conductors' interface [Pa/m]
    contact : law of the cores' interface on rung 6; the rung is left out if not given
    large : whether to climb rung 7
    coarse, coarse_grading : section and layers of rungs 6 and 7, which cost most; rung 4 is repeated on them, so that each effect is seen
        against the same mesh
    """
    end = replace(specimen, loaded=Traction(), interface="bonded")
    elastic = Interfaces({"conductor-insulation": Elastic(stiffness)})
    few = mesh if coarse is None else coarse
    short = end if coarse_grading is None else replace(end, grading=coarse_grading)

    def linear(name: str, wanted: Specimen, on: CrossSectionMesh = mesh, remark: str = "") -> Step:
        return Step(name, lambda tell: linear_rung(name, wanted, on, remark))

    steps = [
        Step("long cable, bonded", lambda tell: long_cable_rungs(mesh, specimen.length)[0]),
        Step("twist released", lambda tell: long_cable_rungs(mesh, specimen.length)[1]),
        linear("finite, rigid plate", replace(end, loaded=Plate())),
        linear("traction on the end-section", end),
        linear("elastic interface", replace(end, interface=elastic), remark=f"{stiffness / 1e9:g} MPa/mm"),
    ]
    if (contact is not None or large) and (coarse is not None or coarse_grading is not None):
        steps.append(linear("traction, coarse mesh", short, few, f"{len(few.cells)} triangles"))
    if contact is not None:
        name, law = "opening, rubbing cores", contact
        steps.append(Step(name, lambda tell: opening_rung(name, short, few, law, progress=tell, remark=law.describe())))
    if large:
        last = "large displacements"
        remark = f"{len(LOAD_STEPS)} load steps, bonded"
        steps.append(
            Step(last, lambda tell: large_displacement_rung(last, short, few, LOAD_STEPS, progress=tell, remark=remark))
        )
    return tuple(steps)


def ladder(
    steps: Sequence[Step],
    progress: Progress | None = None,
    *,
    kept: Sequence[Rung] = (),
    done: Callable[[Sequence[Rung]], None] | None = None,
) -> tuple[Rung, ...]:
    """Climb the steps one after another.

    Parameters
    ----------
    steps : see :func:`ladder_steps`
    progress : is told the fraction and what is being climbed
    kept : rungs of an earlier run that was stopped, which are not climbed again
    done : is handed all rungs so far after each one that was climbed, for instance to keep them
    """
    tell = progress or (lambda fraction, sentence: None)
    old, rungs = {rung.name: rung for rung in kept}, []
    for i, step in enumerate(steps):
        found = old.get(step.name)
        tell(i / len(steps), step.name if found is None else f"{step.name}: kept from before")
        if found is None:
            found = step.climb(_part(tell, i / len(steps), (i + 1) / len(steps), step.name))
            if done:
                done([*rungs, found])
        rungs.append(found)
    tell(1.0, "the ladder is climbed")
    return tuple(rungs)


def _part(tell: Progress, low: float, high: float, name: str) -> Progress:
    return lambda fraction, sentence: tell(low + (high - low) * fraction, f"{name}: {sentence}")

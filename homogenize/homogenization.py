r"""From a cable to the constants of its beam: the chain cross-section mesh -> cell -> section, in one call.

What is returned, with its definition:

* ``section``: 6x6 of a beam longer than a pitch (compliance averaged over the angles of the section, see
  :func:`homogenize.section_stiffness.pitch_average`); ``phase_zero``: the section as drawn.
* ``average``: E and G by formula (3) of Ge et al. (2023), see :mod:`homogenize.volume_average`.
* ``checks``: bounds, reciprocity, energy and equilibrium, see :mod:`homogenize.cell_checks`.

Interfaces are bonded, the stiffest a cable can be in tension, torsion and bending, or the conductors slide without friction.
Cores and screens that slide as well would make it softer still.
A long cable is 10 to 60 times stiffer than the 142 MPa that were published for a finite specimen loaded
through its end-section; the two numbers answer different questions.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from geometry import Cable, CrossSectionMesh, cross_section_mesh, helical_slice, nested_cell
from homogenize.cell_checks import Check, axial_bounds, check_cell
from homogenize.helical_cell import HelicalCell, solve_helical_cell
from homogenize.interface_choice import Interfaces
from homogenize.periodic_cell import PeriodicCell, solve_periodic_cell
from homogenize.section_stiffness import SectionStiffness, pitch_average
from homogenize.volume_average import VolumeAverage, volume_average

Progress = Callable[[float, str], None]


@dataclass(frozen=True)
class Homogenization:
    """Constants of the beam equivalent to a long cable; lengths in m, forces in N, moduli in Pa."""

    cable: Cable
    mesh: CrossSectionMesh
    cell: HelicalCell
    section: SectionStiffness
    average: VolumeAverage
    bounds: tuple[float, float]
    checks: tuple[Check, ...]
    seconds: float

    @property
    def phase_zero(self) -> SectionStiffness:
        """The 6x6 of the section as drawn, not averaged over the pitch."""
        return self.cell.stiffness


def homogenize_cable(
    cable: Cable, *, interface: str | Interfaces = "bonded", size: float | None = None, progress: Progress | None = None
) -> Homogenization:
    """Mesh the cross-section, solve the helical cell and derive the constants.

    Parameters
    ----------
    cable : Cable
        From :func:`geometry.read_cable`.
    interface : str or Interfaces
        ``"bonded"``; ``"frictionless"``: the conductors slide in what surrounds them, without opening; or
        :class:`~homogenize.interface_choice.Interfaces`, which names the parts that slide and the law of each interface.
    size : float, optional
        Element size [m], a share of the diameter if not given; elements are smaller in thin layers and gaps.
    progress : callable, optional
        Called with a fraction and a sentence.

    Returns
    -------
    Homogenization

    Raises
    ------
    SpecError, MeshError, ConvergenceError
        With a sentence that names the part or the size at fault.
    """
    tell = progress or (lambda fraction, sentence: None)
    start = time.perf_counter()
    tell(0.0, "meshing the cross-section")
    mesh = cross_section_mesh(cable, size=size)
    tell(0.3, f"solving the helical cell, {3 * len(mesh.points)} unknowns")
    cell = solve_helical_cell(mesh, interface)
    tell(0.9, "averaging and checking")
    result = Homogenization(
        cable=cable,
        mesh=mesh,
        cell=cell,
        section=pitch_average(cell.stiffness),
        average=volume_average(cell),
        bounds=axial_bounds(mesh, cell),
        checks=check_cell(mesh, cell),
        seconds=time.perf_counter() - start,
    )
    tell(1.0, "cell solved")
    return result


def slice_stiffness(
    cable: Cable,
    *,
    size: float | None = None,
    slices_per_pitch: int = 128,
    bending: bool = False,
    progress: Progress | None = None,
) -> PeriodicCell:
    """The same cable by the 3D periodic cell: one layer of hexahedra, 1 / `slices_per_pitch` of the lay high.

    Tension and torsion, or with `bending` the whole 6x6.
    The chord of the turning section makes an error of order (2 pi / slices_per_pitch)^2 / 12, 2e-4 for 128. A straight cable gets a
    slice a hundredth of its diameter high.
    """
    tell = progress or (lambda fraction, sentence: None)
    tell(0.0, "meshing the slice")
    mesh = cross_section_mesh(cable, size=size, kind="quad")
    rate = abs(mesh.twist_rate)
    height = 2 * np.pi / rate / slices_per_pitch if rate > 0 else cable.outer_diameter / 100
    return solve_periodic_cell(helical_slice(mesh, height, 1), bending=bending, progress=progress)


def strand_stiffness(
    cable: Cable,
    *,
    elements: int | None = None,
    size: float | None = None,
    bending: bool = False,
    progress: Progress | None = None,
) -> PeriodicCell:
    """The cable with all its strands, on the nested cell: strands bonded where they touch, voids between them empty.

    It has 2 10^5 hexahedra at least for the reference cable: minutes, see benchmarks/cell_3d.md.
    """
    tell = progress or (lambda fraction, sentence: None)
    mesh = nested_cell(cable, elements=elements, size=size, progress=lambda f, s: tell(0.05 * f, s))
    return solve_periodic_cell(mesh, bending=bending, progress=lambda f, s: tell(0.05 + 0.95 * f, s))

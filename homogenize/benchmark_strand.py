"""The 1 + 6 strand (cases T5, T6) in the 2D cell against the strand models, in tension, torsion and bending.

Tension and torsion: each wire is tied to the core over a flat of the half-width that Hertz gives at 0.2 % strain (0.009 to 0.016
core radii). A flat yields, the narrower the more, by the logarithm of its width; the models of strands overlook it, and a tie along
a line of no width has no limit under refinement. With it the energy model gives kee within 0.04 % (9.2 deg) to 0.4 % (17 deg) of the
cell. The band of the cell, from 0.985 of the energy model to 1.005 of the rigid one, holds with this compliance in the energy model.
Without it the cell is 0.9816 of the energy model at 17 deg, outside 0.985: flats of three times the width, so nine times the force,
would be needed to lie within.

Bending: each wire meets the core along one line, in the section one node. The frictionless wire keeps the normal component there. A bond
along a line has the same logarithm in shear and does not reach the stick limit.

Source of the sizes: Utting, Jones, Int. J. Mech. Sci. 29 (1987) 605; modulus, Poisson's ratio and pitch are typical values.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from geometry.cell_mesh import CrossSectionMesh
from homogenize.benchmark import Benchmark, Case, band, components
from homogenize.benchmark_sections import strand_contacts, strand_section
from homogenize.cell_checks import reciprocal_couplings
from homogenize.flat_contact_strand import flat_half_width, flat_strand_section
from homogenize.helical_cell import HelicalCell, solve_helical_cell
from homogenize.section_field import section_field
from homogenize.section_problem import SectionSolver
from homogenize.section_stiffness import pitch_average
from homogenize.section_system import section_system
from homogenize.strand_theory import (
    Strand16,
    bending_slip,
    bending_slip_papailiou,
    bending_stick,
    costello,
    energy_consistent,
    free_twist,
    slip_curvatures,
    with_contact,
)

MODELS = "Costello 1997; energy-consistent"
PRINTED = {
    9.2: ((1.40573e7, 7.3235e6, 6.9523e6, 1.46409e7, 1.05797e7), (1.39663e7, 7.26256e6, 1.48332e7, 1.04104e7)),
    11.834: ((1.37023e7, 9.20176e6, 8.70349e6, 1.75631e7, 9.14236e6), (1.35563e7, 9.07499e6, 1.78604e7, 8.94518e6)),
    17.0: ((1.27931e7, 1.24079e7, 1.16171e7, 2.48785e7, 6.99924e6), (1.25154e7, 1.20535e7, 2.53848e7, 6.79192e6)),
}
"""Costello kee, ket, kte, ktt, EA with free rotation, and the energy model kee, ket, ktt, EA, by lay angle; N and mm."""

LOWER_EDGE, UPPER_EDGE = 0.985, 1.005
"""Over the energy model with the compliance of the contact, and over the rigid one."""
STRAIN = 2e-3
"""At which the flats are as wide as Hertz gives."""


def seven_wire(degrees: float) -> Strand16:
    """Core 3.94 mm, wires 3.73 mm, E 188 GPa, nu 0.30; N, mm, MPa."""
    return Strand16(1.97, 1.865, float(np.radians(degrees)), 188e3, 0.30)


def closed_forms() -> Iterable[Benchmark]:
    """The models have the printed digits."""
    source, names = (
        "verification table",
        ("kee [N]", "ket [N mm]", "kte [N mm]", "ktt [N mm2]", "EA, rotation free [N]"),
    )
    for degrees, (of_costello, of_energy) in PRINTED.items():
        K, E = costello(seven_wire(degrees)), energy_consistent(seven_wire(degrees))
        found = (*K.ravel(), free_twist(K))
        yield from components(f"T5 Costello, {degrees} deg", source, names, of_costello, found, 2e-5)
        short = (names[0], names[1], names[3], names[4])
        symmetric = (E[0, 0], E[0, 1], E[1, 1], free_twist(E))
        yield from components(f"T5 energy model, {degrees} deg", source, short, of_energy, symmetric, 2e-5)


def tension_and_torsion(degrees: float) -> Iterable[Benchmark]:
    """kee, ket, ktt of the cell within the band of the models; reciprocity of the two couplings; bending."""
    strand, name = seven_wire(degrees), f"T5 cell, {degrees} deg"
    half_width = flat_half_width(strand, STRAIN)
    energy, rigid = energy_consistent(strand), energy_consistent(strand, contraction=False)
    soft = with_contact(strand, half_width)
    K = axial_stiffness(flat_strand_section(strand, half_width))
    low, high = LOWER_EDGE * soft[0, 0], UPPER_EDGE * rigid[0, 0]
    note = (
        f"half-width of the flats {1e3 * half_width:.3g} um, Hertz at {100 * STRAIN:g} % strain"  # the strand is in mm
    )
    yield band(name, "energy model with contact, rigid model", "kee [N]", low, high, K[0, 0], note)
    names, places = ("kee [N]", "ket [N mm]", "ktt [N mm2]"), ((0, 0), (0, 1), (1, 1))
    expected, found = [soft[at] for at in places], [K[at] for at in places]
    yield from components(name, "energy model with contact", names, expected, found, 0.01)
    yield Benchmark(name, "energy model", "ket [N mm]", energy[0, 1], K[0, 1], 0.04)
    yield Benchmark(name, "energy model", "ktt [N mm2]", energy[1, 1], K[1, 1], 0.04)
    cell = solve_helical_cell(strand_section(strand))
    torque, tension = reciprocal_couplings(cell)
    yield Benchmark(name, "Betti", "kte, ket from stresses [N mm]", torque, tension, 1e-6)
    yield from bending(strand, cell, name)


def axial_stiffness(mesh: CrossSectionMesh) -> np.ndarray:
    """[[kee, ket], [ket, ktt]] of a section, shear and bending free, from the z-independent problem alone."""
    system = section_system(mesh)
    solver = SectionSolver(system.pencil, 0.0, system.gauge)
    return np.linalg.inv(np.linalg.inv(solver.schur)[np.ix_([2, 5], [2, 5])])


def bending(strand: Strand16, bonded: HelicalCell, name: str) -> Iterable[Benchmark]:
    """Frictionless wires reach Costello's sum of springs; bonded ones lie between slip and stick limit."""
    slip, stick = bending_slip(strand), bending_stick(strand)
    EI = pitch_average(bonded.stiffness).EI_x
    yield Benchmark(name, "Costello, springs", "EI frictionless [N mm2]", slip, frictionless_bending(strand), 5e-4)
    yield band(name, "slip and stick limit", "EI bonded on a line [N mm2]", slip, stick, EI)


def printed_bending() -> Iterable[Benchmark]:
    """Slip and stick limits and the curvatures of slip (T 10 kN, mu 0.3) have the printed digits."""
    table = {
        9.2: (1.2804e7, 1.2764e7, 9.9990e7, 8.840e-6, 1.442e-5),
        11.834: (1.2714e7, 1.2648e7, 9.7696e7, 1.158e-5, 1.911e-5),
        17.0: (1.2474e7, 1.2344e7, 9.1743e7, 1.750e-5, 2.947e-5),
    }
    names = ("EI slip, Papailiou", "EI slip, Costello", "EI stick", "curvature at onset [1/mm]", "at full slip [1/mm]")
    for degrees, row in table.items():
        s = seven_wire(degrees)
        found = (bending_slip_papailiou(s), bending_slip(s), bending_stick(s), *slip_curvatures(s, 1e4, 0.3))
        yield from components(f"T6 bending of the strand, {degrees} deg", "verification table", names, row, found, 5e-4)


def frictionless_bending(strand: Strand16) -> float:
    """EI [N m^2] of the strand whose wires slide on the core without friction and without leaving it.

    The first harmonic of the section (fields ~ exp(i tau z)), the wires sharing with the core the radial component at their contact
    line: [K R; R^H Q0][x; y] = [0; q] for a moment q of constant size in fixed axes, and 1 / EI = q^H y.
    """
    mesh = strand_section(strand, joined=False)
    field = section_field(mesh)
    inner, outer = strand_contacts(strand, mesh.points)
    T, Z = _radial_tie(field.rigid_motion(), inner, outer)
    lam = 1j * field.twist_rate
    E0, E1, E2 = (sp.csr_array(T.T @ E @ T) for E in field.matrices())
    K = sp.csc_array(E2 + lam * (E1.T - E1) - lam**2 * E0)
    R = (E1.T @ Z) - lam * (E0 @ Z)
    X, Y = mesh.points[: int(mesh.cells[mesh.region_of == 0].max()) + 1].T  # the core's nodes come first
    middle, right, top = int(np.argmin(np.hypot(X, Y))), int(np.argmax(X)), int(np.argmax(Y))
    free = np.ones(len(Z), dtype=bool)
    free[[3 * middle, 3 * middle + 1, 3 * middle + 2, 3 * right + 1, 3 * right + 2, 3 * top + 2]] = False
    back = spla.splu(sp.csc_array(K[free][:, free])).solve(R[free])
    schur = Z.T @ (E0 @ Z) - R[free].conj().T @ back
    q = np.array([0, 0, 0, 1, 1j, 0]) / np.sqrt(2)
    return float(1 / (q.conj() @ np.linalg.solve(schur, q)).real)


def _radial_tie(Z: np.ndarray, inner: np.ndarray, outer: np.ndarray) -> tuple[sp.csr_array, np.ndarray]:
    """T and the rigid motions in the unknowns that are left: an outer node takes the radial motion of its inner partner.

    The contacts lie on the core's circle at equal angles, where the normal of the helical surface is radial.
    """
    angle = 2 * np.pi * np.arange(len(inner)) / len(inner)
    radial = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    tangential = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=1)
    T = sp.lil_array(sp.eye_array(len(Z)))
    kept = Z.copy()
    for i, o, N, a in zip(inner, outer, radial, tangential, strict=True):
        rows = slice(3 * o, 3 * o + 3)
        T[rows, rows] = np.stack([0 * N, a, [0.0, 0.0, 1.0]], axis=1)
        T[rows, 3 * i : 3 * i + 3] = np.outer(N, N)
        kept[rows] = np.stack([0 * Z[0], a @ Z[rows], Z[3 * o + 2]])
    used = np.setdiff1d(np.arange(len(Z)), 3 * outer)
    return sp.csr_array(T.tocsc()[:, used]), kept[used]


def strand_cases() -> tuple[Case, ...]:
    """Closed forms, then the cell at three lay angles."""
    return (
        Case("T5 strand models", "verification table", closed_forms),
        Case("T6 bending limits of the strand", "verification table", printed_bending),
        *(Case(f"T5 cell, {b} deg", MODELS, partial(tension_and_torsion, b)) for b in PRINTED),
    )

r"""The cylinder that stands for a rope of strands: fibres on helices, tuned to the stretch, twist and coupling of the rope.

A cylinder of radius R with the fibres of :mod:`homogenize.transverse_isotropy` turning at the rate omega, stretched by epsilon and
twisted by tau, free on its side, has e_rr = u', e_tt = u / r, e_zz = epsilon, g_tz = tau r, and no other strain (C is
symmetric about the cylinder through each point). Its energy per length

.. math::  W(\varepsilon, \tau) = \min_u \frac12 \int_0^R e^T C(r)\, e \; 2\pi r\, dr

is a quadratic problem in the radial displacement u; polynomials make it exact to round-off. The Hessian of W holds EA, coupling and GJ.

Rule of the equivalent. Three constants (E_axial, G_axial, omega) are found so that EA, coupling and GJ are those of the rope.
Across the fibres the metal counts by its share of the area f: E_transverse = f E, with the Poisson's ratios of the strand. Its bending
stiffness then follows, and is not that of the rope: a cylinder cannot have little EI at full EA, as sliding strands have.
The difference is put right at the cable (:mod:`homogenize.two_stage`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from geometry import Conductor, CrossSectionMesh, Region
from geometry.disc_grid import disc_grid
from geometry.errors import ConvergenceError
from homogenize.helical_cell import solve_helical_cell
from homogenize.section_stiffness import SectionStiffness
from homogenize.strand_section import StrandSection, quadratic_triangles, turn_rate
from homogenize.transverse_isotropy import TransverseIsotropy

DEGREE = 10
"""Of the radial displacement; the strains of a cylinder within 60 degrees of lay are smooth."""
LARGEST_MISFIT = 1e-8
"""Of EA, coupling and GJ, relative to the diagonal."""


@dataclass(frozen=True)
class EquivalentCylinder:
    """Its material, the fibres turning at `material.turn_rate` per arc length of the conductor; radius [m]; 6x6 when straight."""

    material: TransverseIsotropy
    radius: float
    stiffness: SectionStiffness


def cylinder_stiffness(material: TransverseIsotropy, radius: float) -> NDArray[np.float64]:
    """[[EA, coupling], [coupling, GJ]] in N, N m, N m^2 of a straight cylinder with helical fibres about its axis, free on its side.

    Examples
    --------
    >>> bar = TransverseIsotropy("bar", 2.5, 2.5, 1.0, 0.25, 0.25, 1.0, turn_rate=3.0)  # isotropic: the fibres do not show
    >>> np.round(cylinder_stiffness(bar, 1.0) / np.pi, 6)
    array([[ 2.5, -0. ],
           [-0. ,  0.5]])
    """
    node, weight = np.polynomial.legendre.leggauss(2 * DEGREE)
    r, w = 0.5 * radius * (node + 1), 0.5 * radius * weight
    C = material.elasticity_at(r, np.zeros_like(r), material.turn_rate or 0.0)
    C = C[:, [0, 1, 2, 3]][:, :, [0, 1, 2, 3]]  # at Y = 0: r along X, t along Y
    power = np.arange(1, DEGREE + 1)
    s = r / radius
    B = np.zeros((len(r), 4, DEGREE + 2))
    B[:, 0, :DEGREE] = power * s[:, None] ** (power - 1) / radius
    B[:, 1, :DEGREE] = s[:, None] ** (power - 1) / radius
    B[:, 2, DEGREE], B[:, 3, DEGREE + 1] = 1.0, r
    K = np.einsum("q,qia,qij,qjb->ab", 2 * np.pi * r * w, B, C, B)
    free, held = slice(0, DEGREE), slice(DEGREE, None)
    return np.asarray(K[held, held] - K[held, free] @ np.linalg.solve(K[free, free], K[free, held]))


def equivalent_cylinder(rope: StrandSection) -> EquivalentCylinder:
    """Cylinder of the conductor's diameter with the EA, coupling and GJ of its strands.

    Raises
    ------
    ConvergenceError
        If no cylinder with these constants is found.
    """
    conductor = rope.conductor
    strand = conductor.strand
    assert strand is not None
    C, radius = rope.stiffness.C, conductor.diameter / 2
    wanted = C[np.ix_([2, 5], [2, 5])]
    share = sum(conductor.layers) * strand.area / conductor.area
    start = TransverseIsotropy(
        f"{conductor.name} conductor of {rope.strands} strands",
        E_axial=float(wanted[0, 0] / conductor.area),
        E_transverse=float(min(1.0, share) * strand.E),
        G_axial=float(wanted[1, 1] / (conductor.area * radius**2 / 2)),
        nu_axial=strand.nu,
        nu_transverse=strand.nu,
        density=conductor.density,
        turn_rate=0.0,
    )
    material = _tuned(start, radius, wanted, turn_rate(conductor), conductor)
    mesh = _disc(material, radius)
    return EquivalentCylinder(material, radius, solve_helical_cell(mesh).stiffness)


def _tuned(
    start: TransverseIsotropy, radius: float, wanted: NDArray[np.float64], rate: float, conductor: Conductor
) -> TransverseIsotropy:
    """Newton's method for (log E, log G, omega); the coupling grows with omega, which starts at no turn."""
    from scipy.optimize import least_squares  # slow to load, needed here only

    scale = np.sqrt(np.outer(np.diag(wanted), np.diag(wanted)))
    unit = 1 / radius
    pairs = ([0, 0, 1], [0, 1, 1])

    def material(x: NDArray[np.float64]) -> TransverseIsotropy:
        E, G = start.E_axial * np.exp(x[0]), start.G_axial * np.exp(x[1])
        return replace(start, E_axial=float(E), G_axial=float(G), turn_rate=float(x[2] * unit))

    def misfit(x: NDArray[np.float64]) -> NDArray[np.float64]:
        return ((cylinder_stiffness(material(x), radius) - wanted) / scale)[pairs]

    if rate == 0.0 and abs(wanted[0, 1]) < 1e-6 * scale[0, 1]:  # straight strands: no coupling, no turn
        x = np.zeros(3)
    else:
        x = least_squares(
            misfit,
            np.array([0.0, -1.0, 0.5 * rate * radius]),
            x_scale=[1.0, 1.0, 0.1],
            xtol=1e-15,
            ftol=1e-15,
            gtol=1e-15,
        ).x
    worst = float(np.abs(misfit(x)).max())
    if not worst < LARGEST_MISFIT:
        raise ConvergenceError(
            f"no cylinder with helical fibres has the stretch, twist and coupling of conductor {conductor.name}: the best one misses "
            f"them by {worst:.1e}; use the conductor as one isotropic cylinder."
        )
    return material(x)


def _disc(material: TransverseIsotropy, radius: float, around: int = 32) -> CrossSectionMesh:
    """A circle about the axis; its polygon has the circle's area."""
    step = 2 * np.pi / around
    angle = step * np.arange(around)
    ring = radius * np.sqrt(step / np.sin(step)) * np.column_stack([np.cos(angle), np.sin(angle)])
    grid = disc_grid(ring)
    points, cells = quadratic_triangles(grid.points, grid.cells, np.zeros((0, 3), dtype=np.int64))
    region = Region("cylinder", "conductor", material, float(np.pi * radius**2))  # type: ignore[arg-type]
    return CrossSectionMesh(
        points, cells, "triangle6", np.zeros(len(cells), dtype=np.int64), (region,), material.turn_rate or 0.0
    )

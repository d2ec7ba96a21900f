r"""Between which values the stiffness of a cable must lie, whatever its interfaces do.

Upper end: everything bonded, no release: EA at blocked twist, GJ at blocked stretch, EI, all of the helical cell.

Lower end: every interface slides and opens without resistance, down to the single wires. Then each member bends and twists
for itself; a helical wire or core of lay angle beta adds, as a free spring (Kirchhoff's rod; per length of cable),

.. math:: EI: \frac{2\cos\beta}{2 + \nu\sin^2\beta}\,EI_{own}, \qquad
          GJ: \frac{\cos\beta}{\cos^2\beta/GJ_{own} + \sin^2\beta/EI_{own}}, \qquad EA: 0 .

EA is left to the parts that hold the axis: a straight part shares the strain at any twist and has at least E A (the bound of
:func:`homogenize.cell_checks.axial_bounds`, with sheath and wrap counted as well). A member inside a member takes both
factors. A conductor whose make-up is not known counts as nothing in bending and twist, and the filler of the interstices counts as
nothing everywhere, so that the lower end stays one.

Source: the spring of Kirchhoff's rod, A. E. H. Love, Mathematical Theory of Elasticity, chapter XIX; G. A. Costello, Theory
of Wire Rope, 2nd ed. 1997, chapter 4 (bending). The range is that of a long cable: ends that are gripped or loaded through
the sheath can take a short specimen out of it, and so can materials outside the ranges of the cable file.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from geometry import Cable, Part
from geometry.helix import lay_angle
from geometry.strand import Conductor, Strand, layer_radii
from homogenize.homogenization import Homogenization, homogenize_cable

Progress = Callable[[float, str], None]


@dataclass(frozen=True)
class StiffnessRange:
    """From `low` to `high`, SI; `low_is` and `high_is` say in words what the ends are."""

    name: str
    unit: str
    low: float
    high: float
    low_is: str
    high_is: str

    def excess(self, value: float) -> float:
        """Factor by which `value` lies outside: 1 inside, above 1 over the upper end, below 1 under the lower end.

        Examples
        --------
        >>> StiffnessRange("EI", "N m^2", 2.0, 70.0, "loose", "bonded").excess(140.0)
        2.0
        """
        return value / self.high if value > self.high else value / self.low if value < self.low else 1.0

    def finding(self, value: float) -> str | None:
        """The sentence about a calibrated `value` that the cable cannot have, or None if it can."""
        factor = self.excess(value)
        if factor == 1.0:
            return None
        side, end = ("above", self.high) if factor > 1 else ("below", self.low)
        what = self.high_is if factor > 1 else self.low_is
        times = factor if factor > 1 else 1 / factor
        return (
            f"{self.name} {value:.4g} {self.unit} lies {side} what the section of the cable allows, "
            f"{end:.4g} {self.unit} ({what}), by a factor {times:.3g}."
        )


@dataclass(frozen=True)
class LooseStiffness:
    """Stiffness per length of a cable whose members all slide on each other: EA [N], EI and GJ [N m^2]."""

    EA: float
    EI: float
    GJ: float


def spring_bending(beta: float, nu: float) -> float:
    """Bending stiffness of a free helix of lay angle `beta` [rad] over that of its straight wire.

    Examples
    --------
    >>> spring_bending(0.0, 0.3)
    1.0
    """
    return float(2 * np.cos(beta) / (2 + nu * np.sin(beta) ** 2))


def spring_torsion(beta: float, nu: float) -> float:
    """Torsional stiffness of a free helix over the one of its straight wire, with GJ = EI / (1 + nu)."""
    return float(np.cos(beta) / (np.cos(beta) ** 2 + np.sin(beta) ** 2 / (1 + nu)))


def wire_modulus(strand: Strand) -> float:
    """E of the wires [Pa] of a strand that is stated as a cylinder: E A = E_wire sum of A_wire cos^3."""
    angles = np.array([lay_angle(radius, strand.lay) for radius in strand.radii])
    wires = np.pi * strand.wire_diameter**2 / 4 * float(np.dot(strand.layers, np.cos(angles) ** 3))
    return strand.E * strand.area / wires


def loose_conductor(conductor: Conductor) -> tuple[float, float]:
    """EI and GJ [N m^2] of a straight conductor whose wires all slide; zero where its make-up is not known."""
    strand = conductor.strand
    if conductor.wires == 1:  # a solid rod
        solid = conductor.E * np.pi * conductor.diameter**4 / 64
        return float(solid), float(solid / (1 + conductor.nu))
    if strand is None:
        return 0.0, 0.0
    own = wire_modulus(strand) * np.pi * strand.wire_diameter**4 / 64
    nu = strand.nu
    in_strand = [(n, lay_angle(r, strand.lay)) for n, r in zip(strand.layers, strand.radii, strict=True)]
    radii = layer_radii(conductor.layers, strand.diameter, f"conductor {conductor.name}")
    in_rope = [(n, lay_angle(r, conductor.lay)) for n, r in zip(conductor.layers, radii, strict=True)]
    EI = sum(n * spring_bending(b, nu) for n, b in in_rope) * sum(n * spring_bending(b, nu) for n, b in in_strand) * own
    twist = sum(n * spring_torsion(b, nu) for n, b in in_rope) * sum(n * spring_torsion(b, nu) for n, b in in_strand)
    return float(EI), float(twist * own / (1 + nu))


def conductor_of(part: Part, cable: Cable) -> Conductor:
    """The make-up of a part of kind conductor."""
    return next(c for c in cable.conductors.values() if c.material.name == part.material.name)


def loose_stiffness(cable: Cable) -> LooseStiffness:
    """The lower end: see the module docstring."""
    EA = EI = GJ = 0.0
    for part in cable.parts:
        if part.kind == "interstices":
            continue
        nu = part.material.nu
        if part.kind == "conductor":
            own, twist = loose_conductor(conductor_of(part, cable))
        else:
            second = np.pi / 4 * (part.outer_radius**4 - part.inner_radius**4)
            own, twist = part.material.E * second, 2 * part.material.G * second
        beta = part.lay_angle if part.centre_radius > 0 else 0.0
        EI += own * spring_bending(beta, nu)
        GJ += twist * spring_torsion(beta, nu)
        if part.centre_radius == 0:
            EA += part.material.E * part.area
    return LooseStiffness(float(EA), float(EI), float(GJ))


def allowed_stiffness(
    cable: Cable,
    *,
    bonded: Homogenization | None = None,
    size: float | None = None,
    progress: Progress | None = None,
) -> dict[str, StiffnessRange]:
    """Ranges of EA [N], GJ and EI [N m^2] that a long piece of `cable` can have.

    Parameters
    ----------
    cable : Cable
        From :func:`geometry.read_cable`.
    bonded : Homogenization, optional
        Of the same cable with bonded interfaces, if it is there already; computed here otherwise, in seconds.
    size : float, optional
        Element size of that computation [m].
    progress : callable (fraction, sentence), optional

    Returns
    -------
    dict
        ``"EA"``, ``"GJ"``, ``"EI"``: :class:`StiffnessRange`.

    Raises
    ------
    SpecError, MeshError, ConvergenceError
        As :func:`homogenize.homogenize_cable`.
    """
    cell = bonded or homogenize_cable(cable, interface="bonded", size=size, progress=progress)
    loose = loose_stiffness(cable)
    section = cell.section
    apart = "every interface down to the wires sliding"
    return {
        "EA": StiffnessRange(
            "EA", "N", min(loose.EA, section.EA_free_twist), section.EA_blocked_twist,
            "the parts on the axis alone, any interface, twist free", "all interfaces bonded, twist blocked",
        ),
        "GJ": StiffnessRange("GJ", "N m^2", loose.GJ, section.GJ, apart, "all interfaces bonded, stretch blocked"),
        "EI": StiffnessRange(
            "EI", "N m^2", loose.EI, float(max(section.C[3, 3], section.C[4, 4])), apart, "all interfaces bonded",
        ),
    }  # fmt: skip

r"""Several layers of wires: an overhead conductor that slips layer by layer (T7), EA of armoured sea cables (T10, T11).

**Conductor.** A layer that sticks adds :math:`\tfrac12 n E A r^2 \cos^3\beta` to the bending stiffness of wires that bend for
themselves; from the outside to the inside the layers let go. A wire at the angle phi from the neutral axis slips where its stick force
:math:`EA \cos^2\beta\, \kappa r \sin\varphi` exceeds the friction that it collects from there,

.. math:: F = (t + B)(e^{\mu\varphi\sin\beta} - 1), \qquad t = EA \cos^2\beta\,\frac{T}{\sum EA\cos^3\beta}, \qquad
          B = \frac{2 r \cos\beta}{n \sin^2\beta} \sum_{outside} \frac{n_o t_o \sin\beta_o \tan\beta_o}{r_o} .

The lays differ, so that no one cell holds the conductor; without friction it is a sum that cells give: the steel core of 1 + 6 wires
and every other wire alone.

**Sea cables.** Sums over the wires hold the radius and are an upper end. The law of the rubber-filled cable (T12) with all layers lets it
go: conductors and wires are members of strain :math:`c^2\varepsilon + s^2 e_r`, all else strains evenly,

.. math:: W = \sum \frac{EA}{2 c} (c^2\varepsilon + s^2 e_r)^2
            + \sum A \Big[\frac{\lambda}{2}(\varepsilon + 2 e_r)^2 + \mu(\varepsilon^2 + 2 e_r^2)\Big] .

Sources: Papailiou, IEEE Trans. Power Deliv. 12 (1997) 1576-1588; curve of the conductor: Foti, Martinelli, J. Wind Eng. Ind. Aerodyn.
(2018), doi 10.1016/j.jweia.2018.09.005, as in github.com/rte-france/pallas-stranded-cable (measured or computed: not settled; lays
assumed); sea cables: Janocha et al., Sustainability 16 (2024) 2899; Beier et al., J. Mar. Sci. Eng. 11 (2023) 1254;
github.com/FloatingArrayDesign/FAModel.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from geometry.cable import Cable
from geometry.cable_file import read_cable
from homogenize.benchmark import Benchmark, Case, band, components
from homogenize.benchmark_sections import rings, wire_trace
from homogenize.benchmark_strand import frictionless_bending
from homogenize.helical_cell import solve_helical_cell
from homogenize.section_stiffness import pitch_average
from homogenize.stiffness_bounds import spring_bending
from homogenize.strand_theory import Strand16

FloatArray = NDArray[np.float64]

STEEL, ALUMINIUM = 3.34e-3, 3.32e-3
"""Wire diameters [m]."""
COUNT = np.array([6, 12, 18, 24])
DIAMETER = np.array([STEEL, ALUMINIUM, ALUMINIUM, ALUMINIUM])
E_WIRE = np.array([207e9, 68e9, 68e9, 68e9])
NU_WIRE = np.array([0.30, 0.33, 0.33, 0.33])
RADIUS = np.array([STEEL, *(1.5 * STEEL + ALUMINIUM * np.array([0.5, 1.5, 2.5]))])
LAY = np.array([0.2104, 0.2166, 0.3029, 0.3593])
TENSION, FRICTION = 40e3, 0.7

PRINTED_PIECES = (1891.0, 735.0, 239.0, 90.0, 30.2)
PRINTED_BREAKS = (0.01412, 0.04678, 0.1066, 0.1802)
"""EI [N m2] piece by piece and the curvatures [1/m] between them, of the verification table."""
CURVE = (
    (0.003472, 5.495), (0.01321, 22.81), (0.01668, 28.30), (0.04911, 50.84), (0.07115, 59.36), (0.1028, 66.10),
    (0.1427, 72.15), (0.1970, 76.43), (0.3048, 79.62), (0.4285, 82.81), (0.5006, 84.89),
)  # fmt: skip
"""Curvature [1/m] and moment [N m] at 40 kN: eleven of the 18 points."""

SEA = ((33, 174.5, 622.0, 26.0), (66, 184.0, 658.0, 24.7), (132, 204.0, 846.0, 25.9))
"""Voltage [kV], outer diameter [mm], EA [MN], EA / A [GPa] of three cables with 630 mm2 of copper."""
SEA_FIT = {33: (0.04944, -8.313, 567.141), 66: (0.04573, -7.689, 524.56), 132: (0.04503, -7.572, 516.55)}
"""EA [MN] as a polynomial of the outer diameter [mm], by voltage."""
ORDER = 1.3
"""Factor within which an order of magnitude is met."""


def lay_angles() -> FloatArray:
    """Of the four layers [rad]."""
    return np.arctan(2 * np.pi * RADIUS / LAY)


def axial_stiffness() -> tuple[float, FloatArray]:
    """EA of the conductor, and of one wire of each layer [N]."""
    EA = E_WIRE * np.pi / 4 * DIAMETER**2
    return float(EA[0] + np.sum(COUNT * EA * np.cos(lay_angles()) ** 3)), EA


def own_bending(share: FloatArray) -> float:
    """EI [N m2] of the wires for themselves, each layer's times its share."""
    own = E_WIRE * np.pi / 64 * DIAMETER**4
    return float(own[0] + np.sum(COUNT * own * share))


def stick_stiffness() -> FloatArray:
    """What each layer adds while it sticks [N m2]."""
    _, EA = axial_stiffness()
    return 0.5 * COUNT * EA * RADIUS**2 * np.cos(lay_angles()) ** 3


def bending_moment(curvature: FloatArray) -> FloatArray:
    """Moment [N m] of the conductor at 40 kN when it is bent for the first time to `curvature` (m,) [1/m]."""
    total, EA = axial_stiffness()
    beta = lay_angles()
    s, c = np.sin(beta), np.cos(beta)
    pull = EA * c**2 * TENSION / total
    press = COUNT * pull * s * np.tan(beta) / RADIUS
    outside = np.cumsum(press[::-1])[::-1] - press
    collected = pull + 2 * RADIUS * c / (COUNT * s**2) * outside
    phi = (np.arange(64) + 0.5) * np.pi / 128
    slips_at = (
        collected[:, None] * np.expm1(FRICTION * phi * s[:, None]) / ((EA * c**2 * RADIUS)[:, None] * np.sin(phi))
    )
    held = np.minimum(curvature[:, None, None], slips_at)  # curvature, layer, angle
    sticking = 2 * np.mean(held * np.sin(phi) ** 2, axis=2) @ stick_stiffness()
    return own_bending(np.cos(beta)) * curvature + sticking


def shape_error(model: FloatArray, reference: FloatArray) -> float:
    """Largest difference of two curves over the largest value, after the factor that brings them closest (least squares)."""
    factor = float(model @ reference / (model @ model))
    return float(np.abs(factor * model - reference).max() / np.abs(reference).max())


def conductor_theory() -> Iterable[Benchmark]:
    """Sums over the wires; pieces and shape of moment over curvature."""
    name, source, beta = "T7 Cardinal conductor", "verification table", lay_angles()
    slip, stick = own_bending(np.cos(beta)), stick_stiffness()
    yield Benchmark(name, source, "metal area [mm2]", 528.8, 1e6 * _area(), 1e-4)
    yield Benchmark(name, source, "sum E A cos^3 [MN]", 42.22, axial_stiffness()[0] / 1e6, 2e-4)
    yield Benchmark(name, "Papailiou", "EI, all layers slip [N m2]", 30.22, slip, 2e-4)
    springs = np.array([spring_bending(b, nu) for b, nu in zip(beta, NU_WIRE, strict=True)])
    yield Benchmark(name, "Costello", "EI, all layers slip [N m2]", 30.05, own_bending(springs), 2e-4)
    pieces = slip + np.concatenate([np.cumsum(stick)[::-1], [0.0]])
    names = tuple(f"EI, {k} layers slip [N m2]" for k in range(5))
    yield from components(name, source, names, PRINTED_PIECES, pieces, 2e-3)
    kappa, moment = np.array(CURVE).T
    curve = "Foti, Martinelli 2018"
    yield Benchmark(name, curve, "last slope [N m2]", 28.8, slip, 0.1)
    yield band(name, curve, "first slope, within 10 % of the range [N m2]", 0.9 * 1570, 1.1 * 1730, float(pieces[0]))
    steps = np.diff(np.concatenate([[0.0], PRINTED_BREAKS, [np.inf]]))
    inside = np.clip(kappa[:, None] - np.concatenate([[0.0], PRINTED_BREAKS]), 0.0, steps)
    error = shape_error(inside @ pieces, moment)
    yield Benchmark(name, curve, "shape of the moment, pieces", 0.1, error, 0.0, "at most")
    error = shape_error(bending_moment(kappa), moment)
    yield Benchmark(name, curve, "shape of the moment, friction", 0.1, error, 0.0, "at most")


def _area() -> float:
    return float(np.pi / 4 * (STEEL**2 + np.sum(COUNT * DIAMETER**2)))


def conductor_cells() -> Iterable[Benchmark]:
    """All layers slip: the frictionless cell of the steel core, and a cell for a wire of each aluminium layer."""
    beta = lay_angles()
    EI = frictionless_bending(Strand16(STEEL / 2, STEEL / 2, float(beta[0]), float(E_WIRE[0]), float(NU_WIRE[0])))
    for k in (1, 2, 3):
        a, tau = DIAMETER[k] / 2, 2 * np.pi / LAY[k]
        mesh = rings(
            (a,), (E_WIRE[k], NU_WIRE[k]), per_ring=3, around=32, twist_rate=tau, shape=wire_trace(a, RADIUS[k], tau)
        )
        EI += COUNT[k] * pitch_average(solve_helical_cell(mesh).stiffness).EI_x
    springs = np.array([spring_bending(b, nu) for b, nu in zip(beta, NU_WIRE, strict=True)])
    name = "T7 Cardinal conductor, cells"
    yield Benchmark(name, "Costello", "EI, all layers slip [N m2]", own_bending(springs), EI, 1e-3)
    yield Benchmark(name, "Foti, Martinelli 2018", "last slope [N m2]", 28.8, EI, 0.1)


def sea_cable_orders() -> Iterable[Benchmark]:
    """The fit and the cables it was made from; the cable of 138 armour wires as a sum over its metal."""
    for voltage, diameter, EA, modulus in SEA:
        name = f"T10 sea cable of {voltage} kV"
        fit = float(np.polyval(SEA_FIT[voltage], diameter))
        yield Benchmark(name, "Janocha et al. 2024", "EA by the fit of FAModel [MN]", EA, fit, 1e-3)
        yield Benchmark(name, "verification table", "EA / A [GPa]", modulus, 4e3 * fit / np.pi / diameter**2, 2e-3)
    armour = 138 * np.pi / 4 * 4.2e-3**2 * 200e9 * np.cos(np.radians(10.0)) ** 3
    total = (armour + 285e-6 * 95e9) / 1e6
    yield band(
        "T11 sea cable of 66 kV", "Beier et al. 2023, factor 1.3", "EA, sum over copper and armour [MN]",
        409 / ORDER, 409 * ORDER, float(total),
    )  # fmt: skip


def armoured_stiffness(cable: Cable) -> tuple[float, float]:
    """EA [N] with blocked twist, radius held and radius free, by the law of the module docstring."""
    W = np.zeros((2, 2))
    for part in cable.parts:
        m = part.material
        if part.kind in ("conductor", "armour"):
            c = np.cos(part.lay_angle if part.centre_radius > 0 else 0.0)
            strain = np.array([c**2, 1 - c**2])
            section = np.pi * (part.outer_radius**2 - part.inner_radius**2)
            W += m.E * section / c * np.outer(strain, strain)
        else:
            lame = m.E * m.nu / ((1 + m.nu) * (1 - 2 * m.nu))
            W += part.area * (lame * np.array([[1.0, 2.0], [2.0, 4.0]]) + 2 * m.G * np.diag([1.0, 2.0]))
    return float(W[0, 0]), float(W[0, 0] - W[0, 1] ** 2 / W[1, 1])


def shipped_sea_cable() -> Iterable[Benchmark]:
    """The three-core cable of 101 mm: sums of its metal as printed, and EA / A beside the three larger cables."""
    name, cable = "T10 shipped sea cable, 101 mm", read_cable("sea-three-core")
    members = {kind: [p for p in cable.parts if p.kind == kind] for kind in ("conductor", "armour")}
    for kind, printed in (("conductor", 16.0), ("armour", 259.2)):
        wires = [(p.material.E * np.pi * p.outer_radius**2, np.cos(p.lay_angle) ** 3) for p in members[kind]]
        total = sum(EA * cube for EA, cube in wires) / 1e6
        yield Benchmark(name, "verification table", f"sum E A cos^3, {kind} [MN]", printed, float(total), 5e-3)
    area = np.pi * cable.outer_radius**2
    _, free = armoured_stiffness(cable)
    low, high = 24.7 / ORDER, 26.0 * ORDER
    yield band(name, "Janocha et al. 2024, factor 1.3", "EA / A, radius free [GPa]", low, high, free / area / 1e9)


def layer_cases() -> tuple[Case, ...]:
    """T7, T10 and T11."""
    return (
        Case("T7 Cardinal conductor", "Papailiou; Foti, Martinelli 2018", conductor_theory),
        Case("T7 Cardinal conductor, cells", "Costello", conductor_cells),
        Case("T10, T11 orders of sea cables", "Janocha et al. 2024; Beier et al. 2023", sea_cable_orders),
        Case("T10 shipped sea cable", "Janocha et al. 2024", shipped_sea_cable),
    )

"""Rod at rest: Princeton beam (R1), 45-degree bend (R2), roll-up (R3), section forces in a bend (R4), catenary (R5).

Two-code references: an independent prototype of the same element and Exudyn 1.13.6, which agree to 2e-6 m (R1) and 2e-3 (R2); 2026-11.
Princeton section and loads after Dowell, Traybar, USAAMRDL TR 75-3/4 (1975); bend after Bathe, Bolourchi, Int. J. Numer. Meth. Eng. 14
(1979)
961-986, whose often quoted (47.23, 15.79, 53.37) is an 8-element value and not converged.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

import numpy as np
from scipy.optimize import brentq

from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import straight, strands_and_arcs
from beam.statics import Equilibrium, equilibrium
from homogenize.benchmark import Benchmark, Case, components
from homogenize.section_stiffness import SectionInertia, SectionStiffness

TWO_CODES = "independent prototype; Exudyn 1.13.6"

PRINCETON = SectionStiffness.uncoupled(
    EA=2.842069e6, GA_x=1.084759e6, GA_y=1.084759e6, EI_x=2.428872, EI_y=36.285519, GJ=2.925744, area=3.9638e-5
)
PRINCETON_LENGTH = 0.508
PRINCETON_CASES = (
    (4.448, 30, (-0.0019179, -0.0047576, 0.0399599)),
    (4.448, 45, (-0.0037482, -0.0039764, 0.0560635)),
    (4.448, 60, (-0.0055277, -0.0028742, 0.0681319)),
    (4.448, 90, (-0.0072591, 0.0, 0.0780773)),
    (8.896, 30, (-0.0076810, -0.0102076, 0.0795474)),
    (8.896, 45, (-0.0144118, -0.0089792, 0.1091131)),
    (8.896, 60, (-0.0204867, -0.0067420, 0.1299579)),
    (8.896, 90, (-0.0260215, 0.0, 0.1462523)),
    (13.345, 0, (-0.0003047, -0.0160612, 0.0)),
    (13.345, 30, (-0.0172589, -0.0169898, 0.1181795)),
    (13.345, 45, (-0.0304529, -0.0156211, 0.1567746)),
    (13.345, 60, (-0.0412573, -0.0119635, 0.1820038)),
    (13.345, 90, (-0.0504010, 0.0, 0.2006839)),
)
"""Load [N], its angle [deg], tip displacement [m] of n = 32, converged to seven digits."""

BEND_CASES = (
    (300, (58.7791, 22.2448, 40.1919)),
    (450, (52.2386, 18.5082, 48.5029)),
    (600, (47.1504, 15.6848, 53.4749)),
)
"""Load and tip position of the curved cantilever of radius 100."""

SPAN, LENGTH, WEIGHT = 8.0, 10.0, 98.1


def princeton_tip(elements: int, load: float, degrees: float) -> np.ndarray:
    """Tip displacement [m] of the blade under a tip load that bends and twists it in space."""
    rod = Rod.straight(PRINCETON_LENGTH, elements, PRINCETON, SectionInertia(0.1, 1e-4, 1e-4, 2e-4))
    loads = np.zeros((rod.nodes, 12))
    angle = np.radians(degrees)
    loads[-1, 0:3] = 0.0, -load * np.cos(angle), load * np.sin(angle)
    result = equilibrium(RodModel(rod, straight(rod.s), [Support(0)], load=loads))
    result.outcome.require_success()
    return result.q[-1, 0:3] - [PRINCETON_LENGTH, 0.0, 0.0]


def princeton(load: float, degrees: int, expected: tuple[float, float, float]) -> Iterable[Benchmark]:
    """n = 32 within 1e-6 m, and half of the last printed digit."""
    found = princeton_tip(32, load, degrees)
    name = f"R1 Princeton beam {load:g} N {degrees} deg"
    yield from components(name, TWO_CODES, ("tip x [m]", "tip y [m]", "tip z [m]"), expected, found, 1.05e-6, scale=1.0)


def princeton_coarse() -> Iterable[Benchmark]:
    """n = 8 within 5e-5 m."""
    load, degrees, expected = PRINCETON_CASES[10]
    found = princeton_tip(8, load, degrees)
    quantities = ("tip x [m]", "tip y [m]", "tip z [m]")
    yield from components("R1 Princeton beam, 8 elements", TWO_CODES, quantities, expected, found, 5e-5, scale=1.0)


def curved_cantilever(elements: int) -> tuple[Rod, np.ndarray]:
    """The 45-degree bend of radius 100, section 1 x 1, E 1e7, nu 0, and its shape."""
    E, R = 1e7, 100.0
    bar = SectionStiffness.uncoupled(EA=E, GA_x=E / 2, GA_y=E / 2, EI_x=E / 12, EI_y=E / 12, GJ=E / 12, area=1.0)
    s = np.linspace(0.0, R * np.pi / 4, elements + 1)
    shape = strands_and_arcs(s, [(s[-1], 1 / R)])
    return Rod.build(np.diff(s), bar, SectionInertia(1.0, 1e-2, 1e-2, 2e-2), stress_free=shape), shape


def bathe_bolourchi(load: float, tip: tuple[float, float, float]) -> Iterable[Benchmark]:
    """n = 16 within 1e-3 of the converged tip."""
    rod, shape = curved_cantilever(16)
    loads = np.zeros((rod.nodes, 12))
    loads[-1, 2] = load
    result = equilibrium(RodModel(rod, shape, [Support(0)], load=loads))
    result.outcome.require_success()
    names = ("tip x", "tip y", "tip z")
    yield from components(f"R2 45-degree bend, F {load}", TWO_CODES, names, tip, result.q[-1, :3], 1e-3, scale=1.0)


def rolled(elements: int, length: float, EA: float, GA: float, EI: float, moment: float) -> Equilibrium:
    """A cantilever under an end moment, which bends it into an arc of radius EI / M."""
    section = SectionStiffness.uncoupled(EA=EA, GA_x=GA, GA_y=GA, EI_x=EI, EI_y=EI, GJ=EI, area=1.0)
    rod = Rod.straight(length, elements, section, SectionInertia(1.0, 1e-3, 1e-3, 2e-3))
    load = np.zeros((rod.nodes, 12))
    load[-1, 8] = moment
    result = equilibrium(RodModel(rod, straight(rod.s), [Support(0)], load=load))
    result.outcome.require_success()
    return result


def roll_up_error(elements: int) -> float:
    """Distance [m] of the tip from (0, 2 L / pi) when a rod of length 1 m is rolled into a half circle."""
    tip = rolled(elements, 1.0, 1e4, 1e4, 2.0, 2 * np.pi).q[-1, :2]
    return float(np.hypot(tip[0], tip[1] - 2 / np.pi))


def roll_up() -> Iterable[Benchmark]:
    """M = pi EI / L: tip error and order of convergence."""
    errors = [roll_up_error(n) for n in (4, 8, 16)]
    order = float(np.log2(errors[1] / errors[2]))
    yield Benchmark(
        "R3 roll-up to a half circle", "exact arc", "tip error, n 16 [m]", 0.0, errors[2], 2.5e-6, scale=1.0
    )
    yield Benchmark("R3 roll-up to a half circle", "exact arc", "order, n 8 to 16", 4.5, order, 0.0, "at least")


def pure_bend(elements: int, N_bound: float, Q_bound: float) -> Iterable[Benchmark]:
    """R 0.4 m, EI 124 N m2, soft shear: the moment is 310 N m, N and Q vanish; bounds are the prototype's values plus 40 %."""
    EI, R = 124.0, 0.4
    S = rolled(elements, np.pi * R, 4.71e5, 3.5e3, EI, EI / R).forces.S
    name, source = f"R4 pure bend, n {elements}", "exact; independent prototype"
    yield Benchmark(name, source, "largest |N| [N]", N_bound, float(np.abs(S[:, :, 0]).max()), 0.0, "at most")
    yield Benchmark(name, source, "largest |Q| [N]", Q_bound, float(np.abs(S[:, :, 1:3]).max()), 0.0, "at most")
    worst = S[:, :, 5].ravel()[np.argmax(np.abs(S[:, :, 5] - EI / R))]
    yield Benchmark(name, "exact", "M [N m]", EI / R, float(worst), 1e-2 * (8 / elements) ** 2)


def hanging(elements: int, kind: type[Rod] = Rod) -> tuple[Rod, Equilibrium]:
    """A heavy, limp, nearly inextensible cable between two points, from the circular arc of the same length and span."""
    section = SectionStiffness.uncoupled(EA=1e8, GA_x=1e6, GA_y=1e6, EI_x=0.02, EI_y=0.02, GJ=0.02, area=1e-3)
    half = float(np.asarray(brentq(lambda x: np.sin(x) / x - SPAN / LENGTH, 0.1, 3.0)))
    rod = kind.straight(LENGTH, elements, section, SectionInertia(10.0, 1e-3, 1e-3, 2e-3))
    start = strands_and_arcs(rod.s, [(LENGTH, 2 * half / LENGTH)], angle=-half)
    model = RodModel(rod, start, [Support(0, ("r",)), Support(-1, ("r",))], gravity=(0.0, -9.81, 0.0))
    result = equilibrium(model)
    result.outcome.require_success()
    return rod, result


def catenary_parameter() -> float:
    """a [m] from 2 a sinh(span / (2 a)) = length."""
    return float(np.asarray(brentq(lambda a: 2 * a * np.sinh(SPAN / (2 * a)) - LENGTH, 0.5, 100.0)))


def catenary(kind: type[Rod] = Rod) -> Iterable[Benchmark]:
    """Sag a (cosh(span/2a) - 1), horizontal force w a, half the weight on each support, mirrored halves.

    The bending stiffness rounds the ends by sqrt(EI/H) = 8 mm, so that the sag is met to 0.1 %.
    """
    a = catenary_parameter()
    _, result = hanging(80, kind)
    F, name, source = result.forces.F, "R5 catenary", "y = a cosh(x/a)"
    sag = a * (np.cosh(SPAN / (2 * a)) - 1)
    yield Benchmark(name, source, "sag [m]", float(sag), float(-result.q[40, 1]), 1e-3)
    yield Benchmark(name, source, "horizontal force [N]", WEIGHT * a, float(F[-1, 0]), 2e-3)
    yield Benchmark(name, "balance", "end reaction [N]", WEIGHT * LENGTH / 2, float(F[0, 1]), 1e-6)
    r = result.q[:, 0:2]
    off = float(np.abs(r - np.column_stack([SPAN - r[::-1, 0], r[::-1, 1]])).max())
    yield Benchmark(name, "symmetry", "difference of the halves [m]", 0.0, off, 1e-6, scale=1.0)


def static_cases() -> tuple[Case, ...]:
    """R1 to R5."""
    bounds = ((8, 4.5, 2.0), (16, 0.5, 0.25), (32, 0.05, 0.03))
    return (
        *(
            Case(f"R1 Princeton beam {p:g} N {b} deg", TWO_CODES, partial(princeton, p, b, e))
            for p, b, e in PRINCETON_CASES
        ),
        Case("R1 Princeton beam, 8 elements", TWO_CODES, princeton_coarse),
        *(
            Case(f"R2 45-degree bend, F {load}", TWO_CODES, partial(bathe_bolourchi, load, tip))
            for load, tip in BEND_CASES
        ),
        Case("R3 roll-up", "exact arc", roll_up),
        *(Case(f"R4 pure bend, n {n}", "exact", partial(pure_bend, n, N, Q)) for n, N, Q in bounds),
        Case("R5 catenary", "y = a cosh(x/a)", catenary),
    )

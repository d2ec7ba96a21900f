"""The ANCF cable: pure bend, elastica, pendulum of another code; and beside the rod with a stiff shear, in the plane.

Pendulum as in :mod:`beam.benchmark_dynamics`; tips of the same kind of element in Exudyn 1.13.6 (Cable2D, n 64), 2026-11.
Elastica: R. Frisch-Fay, Flexible Bars, 1962, section 2.1.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

from beam.ancf_cable import AncfCable
from beam.benchmark_dynamics import advanced, pendulum, swing
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import straight, strands_and_arcs
from beam.statics import Equilibrium, StaticSettings, equilibrium
from homogenize.benchmark import Benchmark, Case, band, components
from homogenize.section_stiffness import SectionInertia, SectionStiffness

CABLE2D = "Exudyn 1.13.6, Cable2D"
CABLE2D_TIPS = {
    7e6: {0.2: (1.14692, -0.19660), 0.4: (0.75183, -0.77920), 0.6: (-0.54412, -0.96884)},
    0.7e6: {0.2: (1.17992, -0.19618), 0.4: (0.85285, -0.78447), 0.6: (-0.33489, -1.25156)},
}
"""Young's modulus [Pa], time [s], tip position [m]."""
TIGHT = StaticSettings(force_tolerance=1e-6, moment_tolerance=1e-6)


def limp_section(EI: float, EA: float, GA: float) -> SectionStiffness:
    """A section with one bending stiffness."""
    return SectionStiffness.uncoupled(EA=EA, GA_x=GA, GA_y=GA, EI_x=EI, EI_y=EI, GJ=EI, area=1.0)


def elastica_tip(length: float, EI: float, force: float) -> tuple[float, float]:
    """(x, deflection) [m] of the end of an inextensible cantilever under a force [N] across it, by elliptic integrals.

    With the slope phi at the end, k^2 = (1 + sin phi)/2 and sin^2(theta) = 1/(2 k^2):
    length sqrt(F/EI) = K(k) - F(theta, k).

    Examples
    --------
    >>> [round(x, 6) for x in elastica_tip(1.0, 2.0, 20.0)]
    [0.445004, 0.810609]
    """
    load = length * np.sqrt(force / EI)

    def integrals(slope: float) -> tuple[float, float]:
        m = (1 + np.sin(slope)) / 2
        theta = np.arcsin(1 / np.sqrt(2 * m))
        return float(ellipk(m) - ellipkinc(theta, m)), float(ellipe(m) - ellipeinc(theta, m))

    slope = float(np.asarray(brentq(lambda x: integrals(x)[0] - load, 1e-9, np.pi / 2 - 1e-9, xtol=1e-14)))
    x = np.sqrt(2 * np.sin(slope)) / load
    return float(length * x), float(length * (1 - 2 / load * integrals(slope)[1]))


def cantilever(kind: type[Rod], elements: int, EA: float = 1e4, GA: float = 1e7) -> Equilibrium:
    """L 1 m, EI 2 N m2 under 20 N across its end: turned there by 82 deg."""
    rod = kind.straight(1.0, elements, limp_section(2.0, EA, GA), SectionInertia(1.0, 1e-3, 1e-3, 2e-3))
    load = np.zeros((rod.nodes, 12))
    load[-1, 1] = -20.0
    result = equilibrium(RodModel(rod, straight(rod.s), [Support(0)], load=load), settings=TIGHT)
    result.outcome.require_success()
    return result


def elastica() -> Iterable[Benchmark]:
    """Euler's elastica, EA 1e7 N: the tip, and the order of convergence."""
    exact = np.array(elastica_tip(1.0, 2.0, 20.0)) * [1, -1]
    errors = [float(np.linalg.norm(cantilever(AncfCable, n, EA=1e7).q[-1, :2] - exact)) for n in (4, 8, 16)]
    name, source = "R5 elastica, ANCF cable", "elliptic integrals"
    yield Benchmark(name, source, "tip error, n 16 [m]", 0.0, errors[2], 2e-5, scale=1.0)
    for n, slope in zip((4, 8), np.log2(np.array(errors[:-1]) / errors[1:]), strict=True):
        yield band(name, "cubic interpolation", f"order, n {n} to {2 * n}", 3.4, 4.4, float(slope))


def half_circle(elements: int) -> Equilibrium:
    """The rod of case R3 under an end moment pi EI / L, started from the half circle.

    The moment is a force on the slope of the end, which it turns into (0, -M) for a slope of (-1, 0).
    """
    EI, L = 2.0, 1.0
    rod = AncfCable.straight(L, elements, limp_section(EI, 1e4, 1e4), SectionInertia(1.0, 1e-3, 1e-3, 2e-3))
    load = np.zeros((rod.nodes, 6))
    load[-1, 4] = -np.pi * EI / L
    model = RodModel(rod, strands_and_arcs(rod.s, [(L, np.pi / L)]), [Support(0)], load=load)
    result = equilibrium(model, settings=TIGHT)
    result.outcome.require_success()
    return result


def pure_bend() -> Iterable[Benchmark]:
    """Tip (0, 2 L / pi) with order 4; the tension, zero in truth, falls with order 3 at least and is small beside M/L."""
    found = [half_circle(n) for n in (4, 8, 16)]
    errors = [float(np.hypot(x.q[-1, 0], x.q[-1, 1] - 2 / np.pi)) for x in found]
    tensions = [float(np.abs(x.forces.S[:, :, 0]).max()) for x in found]
    name, source = "R3 roll-up to a half circle, ANCF cable", "exact arc"
    yield Benchmark(name, source, "tip error, n 16 [m]", 0.0, errors[2], 2.5e-5, scale=1.0)
    yield band(name, source, "order, n 8 to 16", 3.6, 4.4, float(np.log2(errors[1] / errors[2])))
    yield Benchmark(name, source, "largest |N|, n 16 [N]", 0.03, tensions[2], 0.0, "at most")
    yield Benchmark(
        name, source, "order of N, n 8 to 16", 2.8, float(np.log2(tensions[1] / tensions[2])), 0.0, "at least"
    )
    moment = float(np.abs(found[2].forces.S[:, :, 5] - 2 * np.pi).max())
    yield Benchmark(name, source, "error of M, n 16 [N m]", 0.0, moment, 2e-4, scale=1.0)


def pendulum_of_cable(E: float, tolerance: float) -> Iterable[Benchmark]:
    """n 32 against n 64 of the other code up to 0.6 s; the energy balance closes."""
    motion = swing(pendulum(32, E, AncfCable), 2.5e-4, 0.0)
    name = f"D1 flexible pendulum, ANCF cable, E {E:g} Pa"
    for time, expected in CABLE2D_TIPS[E].items():
        advanced(motion, 800)
        names = (f"tip x at {time} s [m]", f"tip y at {time} s [m]")
        yield from components(name, CABLE2D, names, expected, motion.q[-1, :2], tolerance, scale=1.0)
    error = abs(motion.ledger.balance_error)
    yield Benchmark(name, "energy", "imbalance over throughput", 2e-5, error, 0.0, "at most")


def ancf_cable_cases() -> tuple[Case, ...]:
    """The cable's own cases."""
    return (
        Case("R3 roll-up, ANCF cable", "exact arc", pure_bend),
        Case("R5 elastica, ANCF cable", "elliptic integrals", elastica),
        *(
            Case(f"D1 flexible pendulum, ANCF cable, E {E:g} Pa", CABLE2D, partial(pendulum_of_cable, E, tolerance))
            for E, tolerance in ((7e6, 5e-5), (0.7e6, 6e-4))
        ),
    )

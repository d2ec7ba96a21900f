"""Rod in motion: flexible pendulum (D1), axial wave, order of generalised-alpha, towing on an incline, energy balance (D4).

Pendulum: L 1.2 m, A 18 cm2, I 1.215e-8 m4, 5540 kg/m3, E 7 MPa, G = E/2.6, shear factor 5/6. Reference: prototype of the same
element, n 32, h 0.125 ms; Exudyn 1.13.6 ANCF cable (no shear), n 64, agrees to 4e-4; 2026-11.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

import numpy as np

from beam.benchmark_friction import cable_on_floor
from beam.generalized_alpha import Integrator, StepSettings
from beam.incline_formula import towing_force_up
from beam.motion import SpeedRamp
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import straight
from geometry.errors import ConvergenceError
from homogenize.benchmark import Benchmark, Case, band, components
from homogenize.section_stiffness import SectionInertia, SectionStiffness

PENDULUM_SOURCE = "independent prototype; Exudyn 1.13.6"
PENDULUM_TIPS = {0.2: (1.14692, -0.19654), 0.4: (0.75186, -0.77957), 0.6: (-0.54415, -0.96854)}
"""Time [s] and tip position [m]."""
SOFT_TIPS = {0.2: (1.17993, -0.19620), 0.4: (0.85285, -0.78552), 0.6: (-0.33476, -1.25051)}
"""The same for E 0.7 MPa; later its tip whips."""


def pendulum(elements: int, E: float = 7e6, kind: type[Rod] = Rod, stiffening: float = 1.0) -> RodModel:
    """The flexible pendulum, at rest in the horizontal; its shear stiffness times `stiffening`."""
    A, I, rho, G = 0.0018, 1.215e-8, 5540.0, E / 2.6
    GA = stiffening * 5 / 6 * G * A
    section = SectionStiffness.uncoupled(EA=E * A, GA_x=GA, GA_y=GA, EI_x=E * I, EI_y=E * I, GJ=2 * G * I, area=A)
    rod = kind.straight(1.2, elements, section, SectionInertia(rho * A, rho * I, rho * I, 2 * rho * I))
    return RodModel(rod, straight(rod.s), [Support(0, ("r",))], gravity=(0.0, -9.81, 0.0))


def advanced(motion: Integrator, steps: int) -> Integrator:
    """Go on by a number of steps, or say why that failed."""
    if not motion.advance(steps):
        raise ConvergenceError(str(motion.outcome))
    return motion


def swing(model: RodModel, h: float, end: float, rho: float = 0.8, tight: bool = False) -> Integrator:
    """Integrate with the fixed step h [s] up to `end` [s]."""
    relative, absolute = (1e-12, 1e-9) if tight else (1e-6, 1e-3)
    settings = StepSettings(h, spectral_radius=rho, adaptive=False, relative=relative, absolute=absolute)
    return advanced(Integrator(model, model.q0, settings=settings), round(end / h))


def flexible_pendulum(E: float = 7e6) -> Iterable[Benchmark]:
    """Tip within 3e-4 m (E 7 MPa) or 2e-3 m (0.7 MPa) up to 0.6 s; the energy balance closes."""
    stiff = E > 1e6
    motion = swing(pendulum(16 if stiff else 32, E), 2.5e-4, 0.0)
    name, allowed = "D1 flexible pendulum" + ("" if stiff else f", E {E / 1e6:g} MPa"), 3e-4 if stiff else 2e-3
    for time, expected in (PENDULUM_TIPS if stiff else SOFT_TIPS).items():
        advanced(motion, 800)
        names = (f"tip x at {time} s [m]", f"tip y at {time} s [m]")
        yield from components(name, PENDULUM_SOURCE, names, expected, motion.q[-1, :2], allowed, scale=1.0)
    error = abs(motion.ledger.balance_error)
    yield Benchmark(name, "energy", "imbalance over throughput", 1e-4, error, 0.0, "at most")


def order_of_integration(rho: float) -> Iterable[Benchmark]:
    """Error of the tip at 0.2 s against a step twenty times finer falls with the square of the step."""
    model = pendulum(3)
    reference = swing(model, 2.5e-5, 0.2, rho, tight=True).q[-1, :2]
    errors = [np.linalg.norm(swing(model, h, 0.2, rho, tight=True).q[-1, :2] - reference) for h in (2e-3, 1e-3, 5e-4)]
    for i, slope in enumerate(np.log2(np.array(errors[:-1]) / errors[1:])):
        name = f"D4 generalised-alpha, spectral radius {rho:g}"
        yield band(name, "Chung, Hulbert 1993", f"order, halving {i + 1}", 1.8, 2.2, float(slope))


def axial_wave(kind: type[Rod] = Rod) -> Iterable[Benchmark]:
    """Speed sqrt(EA / m) from the half-height passage at 4 m and 12 m of a 16 m rod."""
    EA, m = 4.712e5, 10.0
    section = SectionStiffness.uncoupled(EA=EA, GA_x=2e5, GA_y=2e5, EI_x=124.0, EI_y=124.0, GJ=86.0, area=1.0)
    rod = kind.straight(16.0, 80, section, SectionInertia(m, 0.0026, 0.0026, 0.0052))
    jerk = SpeedRamp(speed=-0.05, start=0.0, end=4e-3)
    model = RodModel(rod, straight(rod.s), [Support(0, travel=jerk)])
    motion = Integrator(model, model.q0, settings=StepSettings(2.5e-4, adaptive=False))
    times, speeds = [], []
    while motion.t < 0.066:
        advanced(motion, 1)
        times.append(motion.t)
        speeds.append(motion.v[[20, 60], 0])
    passage = []
    for speed in -np.array(speeds).T:
        rise = slice(0, int(np.argmax(speed)) + 1)
        passage.append(np.interp(0.025, speed[rise], np.array(times)[rise]))
    found = 8.0 / float(passage[1] - passage[0])
    yield Benchmark("D4 axial wave", "d'Alembert", "speed [m/s]", float(np.sqrt(EA / m)), found, 1e-2)


def incline(slope: float) -> Iterable[Benchmark]:
    """Steady towing needs m g L (mu cos + sin)."""
    model = cable_on_floor(12, [Support(-1, ("x", "theta"), SpeedRamp(0.2, 0.1, 0.9))], slope=slope, bristle_ratio=0.5)
    motion = advanced(Integrator(model, model.q0, settings=StepSettings(5e-3)), 600)
    forces: list[float] = []
    motion.advance(100, lambda m: forces.append(float(m.reaction[-1, 0])))
    name = f"D4 towing on an incline of {slope:g} rad"
    expected = float(towing_force_up(10.0 * 16.0, slope, 0.3))
    yield Benchmark(name, "Ge et al. 2023, formulas (22), (23)", "pull [N]", expected, float(np.mean(forces)), 5e-3)


def dynamic_cases() -> tuple[Case, ...]:
    """D1 and D4."""
    return (
        Case("D1 flexible pendulum", PENDULUM_SOURCE, flexible_pendulum),
        Case("D1 flexible pendulum, E 0.7 MPa", PENDULUM_SOURCE, partial(flexible_pendulum, 0.7e6)),
        *(
            Case(
                f"D4 generalised-alpha, spectral radius {r:g}", "Chung, Hulbert 1993", partial(order_of_integration, r)
            )
            for r in (0.6, 1.0)
        ),
        Case("D4 axial wave", "d'Alembert", axial_wave),
        *(Case(f"D4 incline {s:g} rad", "formulas (22), (23)", partial(incline, s)) for s in (0.0, 0.3, -0.2)),
    )

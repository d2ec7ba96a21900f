"""Rod with friction: stick-slip on a floor with its exact answer (F1), the cone, stick without creep, the capstan (F2)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from beam.generalized_alpha import Integrator, StepSettings
from beam.motion import SpeedRamp
from beam.rod import GAUSS_W, Rod
from beam.rod_model import RodModel, Support
from beam.section_law import DampingTimes
from beam.shape import straight, strands_and_arcs
from beam.statics import equilibrium
from beam.surface import ContactLaw, Cylinder, FreeTurn, Plane, Spin
from geometry.errors import ConvergenceError
from homogenize.benchmark import Benchmark, Case
from homogenize.section_stiffness import SectionInertia, SectionStiffness

Array = NDArray[np.float64]

EA, WEIGHT, MU, LENGTH = 4.712e5, 98.1, 0.3, 16.0
FLOOR_SECTION = SectionStiffness.uncoupled(EA=EA, GA_x=2e5, GA_y=2e5, EI_x=124.4, EI_y=124.4, GJ=86.0, area=1.0)

DRUM_RADIUS, DRUM_TENSION, DRUM_STRAND = 0.2, 100.0, 0.3


def cable_on_floor(
    elements: int,
    supports: Sequence[Support],
    length: float = LENGTH,
    slope: float = 0.0,
    bristle_ratio: float = 5.0,
    kind: type[Rod] = Rod,
) -> RodModel:
    """A straight cable on a floor, in contact with its weight; `slope` [rad] turns the gravity."""
    inertia = SectionInertia(10.0, 0.0026, 0.0026, 0.0052)
    rod = kind.straight(length, elements, FLOOR_SECTION, inertia, DampingTimes(5e-3, 2e-2))
    floor = Plane("floor", ContactLaw(friction=MU, bristle_ratio=bristle_ratio))
    start = straight(rod.s)
    start[:, 1] = -WEIGHT * np.cos(slope) / 1.25e6
    gravity = 9.81 * np.array([-np.sin(slope), -np.cos(slope), 0.0])
    return RodModel(rod, start, list(supports), gravity=gravity, surfaces=[floor])


def pulled_cable(u: float = 5e-3, kind: type[Rod] = Rod) -> tuple[Integrator, list[float]]:
    """One end pulled slowly by u [m]; the largest |t| / (mu f_n) of every step."""
    model = cable_on_floor(64, [Support(-1, ("x", "theta"), SpeedRamp(u / 2.5, 0.0, 3.0))], kind=kind)
    start = equilibrium(model)
    start.outcome.require_success()
    motion = Integrator(model, start.q, anchors=start.anchors, settings=StepSettings(5e-3))
    cones: list[float] = []
    if not motion.advance(800, lambda m: cones.append(float(m.forces.cones[0].max()))):
        raise ConvergenceError(str(motion.outcome))
    return motion, cones


def stick_slip(kind: type[Rod] = Rod) -> Iterable[Benchmark]:
    """F = sqrt(2 EA mu w u), slip length F / (mu w); nothing moves beyond it; half of the work is friction."""
    u, name, source = 5e-3, "F1 stick-slip on a floor, u 5 mm", "exact: Coulomb, linear cable"
    motion, cones = pulled_cable(u, kind)
    force = float(np.sqrt(2 * EA * MU * WEIGHT * u))
    slips = motion.forces.cones[0] > 1 - 1e-9
    length = float((slips * GAUSS_W).sum()) * LENGTH / slips.shape[0]
    totals = motion.ledger.totals
    yield Benchmark(name, source, "pull [N]", force, float(motion.reaction[-1, 0]), 3e-3)
    yield Benchmark(name, source, "slip length [m]", force / (MU * WEIGHT), length, 3e-2)
    yield Benchmark(name, source, "motion of the far end [m]", 0.0, float(abs(motion.q[0, 0])), 1e-7, scale=1.0)
    yield Benchmark(name, source, "work of the pull [J]", force * u * 2 / 3, totals["drive_work"], 1e-2)
    yield Benchmark(name, source, "friction loss [J]", force * u / 3, totals["friction_loss"], 3e-2)
    yield Benchmark(name, "Coulomb", "largest |t| / (mu f_n)", 1.0, max(cones), 1e-12, "at most")
    imbalance = abs(motion.ledger.balance_error)
    yield Benchmark(name, "energy", "imbalance over throughput", 1e-3, imbalance, 0.0, "at most")


def exact_stick() -> Iterable[Benchmark]:
    """On a slope of 0.25 rad < arctan 0.3 the cable rests: no motion in ten seconds."""
    model = cable_on_floor(6, [], length=2.0, slope=0.25, bristle_ratio=0.5)
    motion = Integrator(model, model.q0, settings=StepSettings(5e-3, absolute=1e-7))
    done = motion.advance(600)
    rest = motion.q[:, 0:3].copy()
    if not (done and motion.advance(2000)):
        raise ConvergenceError(str(motion.outcome))
    creep = float(np.abs(motion.q[:, 0:3] - rest).max())
    yield Benchmark("F2 stick on a slope of 0.25 rad", "Coulomb", "creep in 10 s [m]", 0.0, creep, 1e-9, scale=1.0)


def round_drum(
    mu: float, beta: float, speed: float, turn: Spin | FreeTurn | None = None, kind: type[Rod] = Rod, on_arc: int = 40
) -> tuple[RodModel, Array]:
    """A limp cable an angle beta round a drum, with T1 = 100 N at its start; the end is pulled along the direction that is
    returned, with `speed` [m/s] from 0.5 s on. The drum's surface follows the cable if it turns about -z."""
    R, strand = DRUM_RADIUS, DRUM_STRAND
    EI = 2e-3
    section = SectionStiffness.uncoupled(EA=1e5, GA_x=1e4, GA_y=1e4, EI_x=EI, EI_y=EI, GJ=EI, area=1.0)
    inertia = SectionInertia(1.0, 1e-5, 1e-5, 2e-5)
    arc = beta * R
    elements = round(on_arc * (2 * strand + arc) / arc)
    rod = kind.straight(2 * strand + arc, elements, section, inertia, DampingTimes(2e-3, 2e-2))
    start = strands_and_arcs(rod.s, [(strand, 0.0), (arc, -1 / R), (strand, 0.0)], (-R, -strand, 0), np.pi / 2)
    load = np.zeros((rod.nodes, 12))
    load[0, 1] = -DRUM_TENSION
    drum = Cylinder("drum", ContactLaw(friction=mu), (0.0, 0.0, 0.0), R, turn=turn)
    away = np.array([np.sin(beta), np.cos(beta), 0.0]).round(15)
    pull = SpeedRamp(speed, 0.0, 0.5, direction=(float(away[0]), float(away[1]), 0.0))
    return RodModel(rod, start, [Support(-1, travel=pull)], load=load, surfaces=[drum]), away


def capstan(mu: float, beta: float = np.pi, kind: type[Rod] = Rod) -> Iterable[Benchmark]:
    """An angle beta on a drum that does not turn, 40 elements on the arc: T2 / T1 = exp(mu beta)."""
    model, away = round_drum(mu, beta, 0.01, kind=kind)
    rest = equilibrium(model)
    rest.outcome.require_success()
    name, still = f"F2 capstan, mu {mu:g}, {np.degrees(beta):.0f} deg", float(rest.forces.F[-1, 0:3] @ away)
    yield Benchmark(name, "balance", "T2 without friction [N]", DRUM_TENSION, still, 1e-3)
    motion = Integrator(model, rest.q, anchors=rest.anchors, settings=StepSettings(5e-3))
    if not motion.advance(200):
        raise ConvergenceError(str(motion.outcome))
    ratio = float(motion.reaction[-1, 0:3] @ away / DRUM_TENSION)
    yield Benchmark(name, "Euler, Eytelwein", "T2 / T1", float(np.exp(mu * beta)), ratio, 1e-2)


def friction_cases() -> tuple[Case, ...]:
    """F1 and F2."""
    return (
        Case("F1 stick-slip on a floor", "exact", stick_slip),
        Case("F2 stick on a slope", "Coulomb", exact_stick),
        *(
            Case(f"F2 capstan, mu {mu:g}, {b:g} deg", "Euler, Eytelwein", partial(capstan, mu, np.radians(b)))
            for mu, b in ((0.1, 180), (0.3, 180), (0.3, 90))
        ),
    )

"""Rollers that turn: driven, and turned by the cable against the friction of the bearing; beside the fixed drum of case F2."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

import numpy as np

from beam.benchmark_friction import DRUM_RADIUS, DRUM_TENSION, round_drum
from beam.generalized_alpha import Integrator, StepSettings
from beam.motion import SpeedRamp
from beam.rod_model import RodModel
from beam.statics import equilibrium
from beam.surface import FreeTurn
from geometry.errors import ConvergenceError
from homogenize.benchmark import Benchmark, Case

QUARTER = np.pi / 2


def run_from_rest(model: RodModel, steps: int) -> Integrator:
    """Equilibrium, then `steps` of 5 ms."""
    rest = equilibrium(model)
    rest.outcome.require_success()
    motion = Integrator(model, rest.q, anchors=rest.anchors, settings=StepSettings(5e-3))
    if not motion.advance(steps):
        raise ConvergenceError(str(motion.outcome))
    return motion


def driven_roller(mu: float = 0.3, speed: float = 0.05) -> Iterable[Benchmark]:
    """The end is held, the surface runs towards it with `speed` [m/s]: T2 / T1 = exp(-mu beta), all work becomes friction."""
    ramp = SpeedRamp(-speed / DRUM_RADIUS, 0.0, 0.2)

    def turn(t: float) -> tuple[float, float, float]:
        angle, rate, growth = (float(x[0]) for x in ramp(t))
        return angle, rate, growth

    model, away = round_drum(mu, QUARTER, 0.0, turn, on_arc=20)
    motion = run_from_rest(model, 80)
    before, seconds = dict(motion.ledger.totals), 0.2
    if not motion.advance(40):
        raise ConvergenceError(str(motion.outcome))
    name = f"F2 driven roller, mu {mu:g}, 90 deg"
    pull = float(motion.reaction[-1, 0:3] @ away)
    yield Benchmark(name, "Euler, Eytelwein", "T2 / T1", float(np.exp(-mu * QUARTER)), pull / DRUM_TENSION, 1e-2)
    power = (DRUM_TENSION - pull) * speed
    work = (motion.ledger.totals["drive_work"] - before["drive_work"]) / seconds
    heat = (motion.ledger.totals["friction_loss"] - before["friction_loss"]) / seconds
    yield Benchmark(name, "balance", "power of the drive, (T1 - T2) v [W]", power, work, 1e-2)
    yield Benchmark(name, "balance", "heat of the slip, (T1 - T2) v [W]", power, heat, 1e-2)
    imbalance = abs(motion.ledger.balance_error)
    yield Benchmark(name, "energy", "imbalance over throughput", 1e-3, imbalance, 0.0, "at most")


def free_roller(moment: float, inertia: float = 0.02, speed: float = 0.05) -> Iterable[Benchmark]:
    """Steady pull: the roller turns with the cable, T2 = T1 + M / R; the bearing's heat is M times the angle."""
    model, away = round_drum(0.3, QUARTER, speed, FreeTurn(inertia, moment), on_arc=20)
    motion = run_from_rest(model, 160)
    name = f"F2 free roller, bearing {moment:g} N m"
    pull = float(motion.reaction[-1, 0:3] @ away)
    difference = pull - DRUM_TENSION
    yield Benchmark(name, "balance", "T2 - T1 = M / R [N]", moment / DRUM_RADIUS, difference, 1e-2, scale=10.0)
    angle, rate = (float(x[0]) for x in motion.rollers.state[:2])
    yield Benchmark(name, "no slip", "speed of its surface [m/s]", -speed, rate * DRUM_RADIUS, 1e-2)
    heat = motion.ledger.totals["friction_loss"]
    yield Benchmark(name, "balance", "heat of the bearing [J]", moment * abs(angle), heat, 2e-2, scale=0.25)
    imbalance = abs(motion.ledger.balance_error)
    yield Benchmark(name, "energy", "imbalance over throughput", 1e-3, imbalance, 0.0, "at most")


def roller_cases() -> tuple[Case, ...]:
    """Driven, free without and with friction in the bearing."""
    return (
        Case("F2 driven roller", "Euler, Eytelwein", driven_roller),
        *(Case(f"F2 free roller, bearing {m:g} N m", "balance", partial(free_roller, m)) for m in (0.0, 2.0)),
    )

r"""Static equilibrium F(q) = 0 by pseudo-transient continuation.

Every step solves M (q_{k+1} - q_k)/h^2 + F(q_{k+1}) = 0 with the velocity forgotten afterwards, so that the rod creeps
downhill in its energy and cannot swing. h grows while Newton's iteration is easy and is cut where it is not; for large h
the step is Newton's method on the static problem itself. A section law with internal state sees one straight step of
strain from the state in `memory` to the equilibrium, not the way there: one call is one load step. Contact is frictionless
until equilibrium is reached; then the friction is switched on, whose bristles start unloaded.

Source: C. T. Kelley, D. E. Keyes, SIAM J. Numer. Anal. 35 (1998) 508-523, doi 10.1137/S0036142996304796.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from beam.linear_solve import Factor
from beam.rod_model import Forces, RodModel
from beam.rotation_vector import turn_back
from beam.section_memory import LONG, SectionMemory
from beam.status import Outcome, Status

Array = NDArray[np.float64]

logger = logging.getLogger(__name__)

FORCE_ROWS = slice(0, 3)
MOMENT_ROWS = slice(3, 9)


@dataclass(frozen=True)
class StaticSettings:
    """Tolerances: largest residual at a node [N] and [N m]; steps: first, growth, largest, smallest [s]."""

    force_tolerance: float = 1e-5
    moment_tolerance: float = 1e-5
    first_step: float = 1e-3
    growth: float = 2.0
    largest_step: float = 1e6
    smallest_step: float = 1e-9
    most_steps: int = 400
    iterations: int = 12


@dataclass(frozen=True)
class Equilibrium:
    """A static shape `q`, its friction anchors, the residual that is left, how it ended, the state of the section law."""

    q: Array
    anchors: list[Array]
    forces: Forces
    residual_force: float
    residual_moment: float
    iterations: int
    outcome: Outcome
    memory: SectionMemory | None = None


def equilibrium(
    model: RodModel,
    q: Array | None = None,
    *,
    t: float = 0.0,
    settings: StaticSettings | None = None,
    memory: SectionMemory | None = None,
    duration: float = LONG,
) -> Equilibrium:
    """Shape of `model` at rest, with the supports where they are at time `t`.

    Parameters
    ----------
    model : RodModel
    q : (n + 1, 12) array, optional
        Where to start; the model's starting shape if not given.
    t : float
        Time at which prescribed motions are taken [s].
    memory : SectionMemory, optional
        State of the model's section law before this load step; that of a rod that was never strained if not given.
    duration : float
        Length of the load step [s], for laws that know time.

    Returns
    -------
    Equilibrium
        With the residual in N and N m, and the `memory` to hand to the next load step or to the integrator. If the
        outcome is not completed, `q` is the last shape that was reached and `memory` the one before the load step.
    """
    settings = settings or StaticSettings()
    q = (model.q0 if q is None else model.complete(q)).copy()
    rest, unused = np.zeros_like(q), np.zeros_like(q)
    model.prescribe(t, q, unused, unused)
    unused[:] = 0.0
    turn_back(q, unused, unused, unused)
    anchors = model.fresh_anchors()
    h, count = settings.first_step, 0
    outcome = Outcome(Status.NOT_CONVERGED, "The number of steps is used up.")
    forces_of = partial(model.forces, memory=memory, dt=duration)
    current = forces_of(t, q, rest, anchors, friction=False)
    previous = np.inf
    for _ in range(settings.most_steps):
        force, moment = _residual(model, current)
        if not np.isfinite(force + moment):
            outcome = Outcome(Status.NOT_FINITE, _where(model, current))
            break
        if force <= settings.force_tolerance and moment <= settings.moment_tolerance:
            outcome = Outcome()
            break
        trial, forces, used = _step(model, forces_of, t, q, anchors, h, settings)
        count += used
        if trial is None or forces is None:
            h /= 4
            if h < settings.smallest_step:
                outcome = Outcome(Status.NOT_CONVERGED, _where(model, current))
                break
            continue
        q, current, anchors = trial, forces, forces.moved
        if turn_back(q, unused, unused, unused):
            current = forces_of(t, q, rest, anchors, friction=False)
        gain = settings.growth * (10.0 if used <= 3 else 1.0)
        h = min(h * gain, settings.largest_step)
        previous = force
    logger.info("statics: %d iterations, last residual %.2e N", count, previous)
    force, moment = _residual(model, current)
    current = forces_of(t, q, rest, anchors, friction=True)
    kept = current.memory if outcome.completed else memory
    return Equilibrium(q, current.moved, current, force, moment, count, outcome, kept)


def _step(
    model: RodModel, forces_of: Callable[..., Forces], t: float, q: Array, anchors: list[Array], h: float,
    settings: StaticSettings,
) -> tuple[Array | None, Forces | None, int]:  # fmt: skip
    """One pseudo step by Newton's method; None if it does not converge."""
    trial, rest = q.copy(), np.zeros_like(q)
    start = np.inf
    for k in range(settings.iterations):
        blocks = model.blocks()
        forces = forces_of(t, trial, rest, anchors, friction=False, blocks=blocks)
        residual = np.where(model.free, forces.F + model.inertia((trial - q) / h**2), 0.0)
        size = float(np.linalg.norm(residual))
        if k == 0:
            start = max(size, settings.force_tolerance)
        if not np.isfinite(size) or size > 1e8 * start:
            return None, None, k
        if k > 0 and size <= max(1e-3 * start, 0.1 * settings.force_tolerance):
            return trial, forces, k
        model.add_mass(1 / h**2, blocks)
        model.fix(blocks)
        factor = Factor(blocks)
        if factor.singular_node >= 0:
            return None, None, k
        delta = np.where(model.free, factor.solve(residual), 0.0)
        if model.law is not None:
            delta *= _shortening(
                model, partial(forces_of, t, v=rest, anchors=anchors, friction=False), trial, delta, q, h
            )
        trial = trial - delta
    return None, None, settings.iterations


def _shortening(
    model: RodModel, forces_at: Callable[..., Forces], trial: Array, delta: Array, q: Array, h: float
) -> float:
    """Share of Newton's step at which the residual has no component along the step: a law with kinks makes it overshoot."""

    def slope(share: float) -> float:
        there = trial - share * delta
        return float(
            np.sum(delta * np.where(model.free, forces_at(q=there).F + model.inertia((there - q) / h**2), 0.0))
        )

    start, share = slope(0.0), 1.0
    low, high = (0.0, start), (1.0, slope(1.0))
    if start <= 0 or high[1] >= -0.5 * start:
        return 1.0
    for _ in range(4):
        share = low[0] + (high[0] - low[0]) * low[1] / (low[1] - high[1])
        here = slope(share)
        if abs(here) <= 0.5 * start:
            break
        low, high = ((share, here), high) if here > 0 else (low, (share, here))
    return share


def _residual(model: RodModel, forces: Forces) -> tuple[float, float]:
    R = np.abs(np.where(model.free, forces.F, 0.0))
    return float(R[:, FORCE_ROWS].max()), float(R[:, MOMENT_ROWS].max())


def _where(model: RodModel, forces: Forces) -> str:
    R = np.where(model.free, forces.F, 0.0)
    broken = np.argwhere(~np.isfinite(R))
    if broken.size:
        name = model.row_name(int(broken[0, 0]))
        return f"{name[0].upper()}{name[1:]} has a force that is not a number: check the inputs that act there."
    node = int(np.argmax(np.abs(R[:, FORCE_ROWS]).max(axis=1)))
    worst = float(np.abs(R[node, FORCE_ROWS]).max())
    return f"The residual is largest at {model.row_name(node)}, {worst:.2e} N: try a start shape closer to the supports and contacts."
